"""A predictor to take along: weather in, the distance to be survived out, rounded up on the safe side.

It keeps one XGBoost regression of the logarithm of the offset and the scatter of its residuals. Both give every class
its probability; the class to fly with is the one that the offset doesn't exceed with 95 %. A file of it is XGBoost's
own JSON, in which it also keeps what it was trained on: it refuses other features, and warns outside of their ranges.
"""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Iterable
from dataclasses import dataclass, replace
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.files import written_whole
from uavlab.prediction.generator import (
    FEATURES,
    checked_columns,
    class_probabilities,
    feature_table,
    missing_values,
    offset_class,
)
from uavlab.prediction.models import FOLDS, fit_log_offset
from uavlab.requirements import require

ATTRIBUTE = "uavlab_offset_predictor"
"""Under which the file keeps what XGBoost doesn't know."""

MIN_ROWS = 20
"""A quantile of 95 % is the largest of twenty."""


@dataclass(frozen=True, eq=False)
class Training:
    """What a fitted predictor knows.

    Attributes
    ----------
    booster : xgboost.Booster
        Of ln ξ.
    spread : float
        Standard deviation of the residuals of ln ξ.
    margin : float
        Their quantile, added to the prediction to round up.
    ranges : dict of name to (low, high)
        Of each feature, in its own unit.
    """

    booster: Any
    spread: float
    margin: float
    ranges: dict[str, tuple[float, float]]


@dataclass(frozen=True, eq=False)
class OffsetPredictor:
    """From the weather to the class of the offset, and to σ "rounded up" (REPARE section 2.2.3).

    ln ξ = f(weather) + e: f by XGBoost, the spread and the quantile of e by cross-validation.

    Attributes
    ----------
    features : tuple of str
        Columns to use.
    class_count : int
        Classes of 1 m.
    quantile : float
        With which the offset stays below what is rounded up, 0.5 to below 1.
    training : Training, optional
        Comes from `fit` or `load`.

    Raises
    ------
    ValueError
        If `features` is empty, no tuple of names or has one twice, `class_count` is no whole number of at least 2,
        `quantile` is not from 0.5 to below 1, or `training` is none that `fit` or `load` made.

    See Also
    --------
    OffsetPredictor.fit : learns from flights.
    make_dataset : flights to learn from.
    uavlab.resilience.safe_distance : the paper's table in its place.

    References
    ----------
    T. Chen and C. Guestrin, XGBoost: A Scalable Tree Boosting System, Proceedings of the 22nd ACM SIGKDD Conference,
    2016.

    Examples
    --------
    >>> from uavlab.prediction import OffsetPredictor, make_dataset
    >>> data = make_dataset(count=200, train_count=100)
    >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
    >>> predictor
    <OffsetPredictor of wind_speed, 6 classes, quantile 0.95, fitted>
    >>> predictor.predict_offset({"wind_speed": [3.0, 8.0]})
    array([2., 6.])
    """

    features: tuple[str, ...] = FEATURES
    class_count: int = 6
    quantile: float = 0.95
    training: Training | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "features", checked_names(self.features))
        checks.set_fields(self, checks.whole, "class_count", least=2)
        checks.set_fields(self, checks.number, "quantile")
        if not 0.5 <= self.quantile < 1:
            raise ValueError(f"quantile must be from 0.5 to below 1, got {self.quantile!r}")
        if self.training is not None:
            checks.instance("training", self.training, Training)

    def __repr__(self) -> str:
        state = "not fitted" if self.training is None else "fitted"
        names = ", ".join(self.features) if len(self.features) < 4 else f"{len(self.features)} features"
        counts = f"{names}, {self.class_count} classes, quantile {self.quantile:g}"
        return f"<OffsetPredictor of {counts}, {state}>"

    def fit(
        self, features: Any, offsets: npt.ArrayLike, *, groups: npt.ArrayLike | None = None, drop_nan: bool = False
    ) -> OffsetPredictor:
        """A predictor that has learned from these flights.

        How far offsets are from their prediction is measured on flights that were left out. Flights that share more
        than their features, as those of one day do, have to be left out together: say so with `groups`, or the
        quantile is too low.

        Parameters
        ----------
        features : pandas.DataFrame
            N rows, at least 20, with the predictor's columns.
        offsets : (N,) array
            ξ [m], above 0.
        groups : (N,) array, optional
            Which flights belong together: a label for each, such as its day; at least 4 different ones. By default no
            two do.
        drop_nan : bool
            Leave out rows with NaN or infinite values instead of refusing the table.

        Returns
        -------
        OffsetPredictor
            This one stays as it is.

        Raises
        ------
        ValueError
            If `features` lacks a column or has too few rows, `offsets` are not above 0, all equal or not one for each
            row, either has a value that is no number (and `drop_nan` is False), `groups` has not a label for each row,
            or too few different ones, or `drop_nan` is not True or False.

        See Also
        --------
        OffsetPredictor.predict_offset : what it is for.
        OffsetPredictor.save : keeps what it has learned.

        Examples
        --------
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        <OffsetPredictor of wind_speed, 6 classes, quantile 0.95, fitted>
        """
        checks.flag("drop_nan", drop_nan)
        table = checked_columns(features, self.features)
        reached = checks.numbers("offsets", offsets)
        if reached.shape != (len(table),):
            raise ValueError(
                f"offsets must have shape ({len(table)},), one for each row of features, got {reached.shape}"
            )
        labels = None if groups is None else checked_groups(groups, len(table))
        joined = table.assign(offsets=reached)
        wrong = missing_values(joined)
        if wrong and not drop_nan:
            raise ValueError(f"features and offsets: {wrong}; drop_nan=True leaves these rows out")
        whole = np.isfinite(joined.to_numpy()).all(axis=1)
        table, reached = table[whole], reached[whole]
        if labels is not None:
            labels = labels[whole]
            if (different := len(np.unique(labels))) < FOLDS:
                raise ValueError(f"groups must have at least {FOLDS} different labels, got {different}")
        if not (reached > 0).all():
            raise ValueError(f"offsets must be above 0 [m], got {reached.min():g}")
        if len(table) < MIN_ROWS:
            raise ValueError(f"features must have at least {MIN_ROWS} whole rows, got {len(table)}")
        if np.ptp(reached) == 0:
            raise ValueError(f"offsets must differ, all are {reached[0]:g} m: there is nothing to learn")
        model, residuals = fit_log_offset(table, reached, labels)
        ranges = {name: (float(table[name].min()), float(table[name].max())) for name in self.features}
        margin = float(np.quantile(residuals, self.quantile))
        return replace(self, training=Training(model.get_booster(), float(residuals.std()), margin, ranges))

    def predict_probabilities(self, features: Any) -> np.ndarray:
        """Probability of each class: `class_probabilities` of the predicted ln ξ and the spread of its residuals.

        Parameters
        ----------
        features : pandas.DataFrame, mapping of arrays or numbers, or Weather
            N rows with the columns that it was trained on; more columns don't matter.

        Returns
        -------
        (N, class_count) array
            Each row adds up to 1.

        Raises
        ------
        ValueError
            If the predictor isn't fitted, or `features` lacks a column or has a value that is no number.

        Warns
        -----
        UserWarning
            If a value lies outside of the range it was trained on, by over 1 % of it: trees don't extrapolate.

        See Also
        --------
        OffsetPredictor.predict_class : the most probable one.
        class_probabilities : the formula.

        Examples
        --------
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> chances = predictor.predict_probabilities({"wind_speed": [3.0, 8.0]})
        >>> chances.shape, chances.sum(axis=1).round(6)
        ((2, 6), array([1., 1.]))
        """
        return class_probabilities(self.log_offset(features), self.fitted.spread, self.class_count)

    def predict_class(self, features: Any) -> np.ndarray:
        """The most probable class of the offset.

        Parameters
        ----------
        features : pandas.DataFrame, mapping of arrays or numbers, or Weather
            N rows with the columns that it was trained on; more columns don't matter.

        Returns
        -------
        (N,) array of int
            1 to `class_count`.

        Raises
        ------
        ValueError
            If the predictor isn't fitted, or `features` lacks a column or has a value that is no number.

        Warns
        -----
        UserWarning
            If a value lies outside of the range it was trained on, by over 1 % of it: trees don't extrapolate.

        See Also
        --------
        OffsetPredictor.predict_offset : the class to fly with, which is seldom exceeded.

        Examples
        --------
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> calm, windy = predictor.predict_class({"wind_speed": [3.0, 8.0]})
        >>> bool(calm < windy)
        True
        """
        return 1 + self.predict_probabilities(features).argmax(axis=1)

    def predict_offset(self, features: Any) -> np.ndarray:
        """Offset to be survived ξ, rounded up: the class that it doesn't exceed with `quantile`.

        ξ = ⌈exp(f(weather) + q)⌉, q the quantile of the residuals. The last class holds all that is larger: there it is
        a least value.

        Parameters
        ----------
        features : pandas.DataFrame, mapping of arrays or numbers, or Weather
            N rows with the columns that it was trained on; more columns don't matter.

        Returns
        -------
        (N,) array
            ξ [m], 1 to `class_count`.

        Raises
        ------
        ValueError
            If the predictor isn't fitted, or `features` lacks a column or has a value that is no number.

        Warns
        -----
        UserWarning
            If a value lies outside of the range it was trained on, by over 1 % of it: trees don't extrapolate.

        See Also
        --------
        OffsetPredictor.predict_sigma : the σ that belongs to it.
        uavlab.offsets.minimum_safe_distance : the distance to keep for it.

        Examples
        --------
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> bool((predictor.predict_offset(data.features) >= predictor.predict_class(data.features)).all())
        True
        """
        high = np.exp(self.log_offset(features) + self.fitted.margin)
        return offset_class(high, self.class_count).astype(float)

    def predict_sigma(self, features: Any, *, pauta: float = 3.0) -> np.ndarray:
        """Spread σ [m] of the offset's distribution (REPARE Eq. 6), rounded up: ξ / 3.

        The offset is what the strongest gust reaches, and the paper counts with 3σ for that.

        Parameters
        ----------
        features : pandas.DataFrame, mapping of arrays or numbers, or Weather
            As for `predict_class`.
        pauta : float
            Radius of the Pauta criterion in σ, above 0: 3 on one axis, 3.44 in the plane, 3.76 in space.

        Returns
        -------
        (N,) array
            σ [m].

        Raises
        ------
        ValueError
            If `pauta` is not above 0, the predictor isn't fitted, or `features` lacks a column or has a value that is
            no number.

        See Also
        --------
        OffsetPredictor.predict_offset : ξ.
        uavlab.offsets.pauta_radius : the radius in 1, 2 or 3 dimensions.

        Examples
        --------
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> predictor.predict_sigma({"wind_speed": [3.0]}).round(2)
        array([0.67])
        """
        pauta = checks.positive_number("pauta", pauta)
        return self.predict_offset(features) / pauta

    def log_offset(self, features: Any) -> np.ndarray:
        """Predicted mean of ln ξ.

        Parameters
        ----------
        features : pandas.DataFrame, mapping of arrays or numbers, or Weather
            N rows with the columns that it was trained on; more columns don't matter.

        Returns
        -------
        (N,) array
            f(weather) [log m].

        Raises
        ------
        ValueError
            If the predictor isn't fitted, or `features` lacks a column or has a value that is no number.

        Warns
        -----
        UserWarning
            If a value lies outside of the range it was trained on, by over 1 % of it: trees don't extrapolate.

        See Also
        --------
        OffsetPredictor.predict_offset : in metres, and rounded up.

        Examples
        --------
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> calm, windy = predictor.log_offset({"wind_speed": [3.0, 8.0]})
        >>> bool(calm < windy)
        True
        """
        training = self.fitted
        table = feature_table(features, self.features)
        for name, (low, high) in training.ranges.items():
            slack = 0.01 * (high - low)  # a direction of 0 is no news where 0.04 was seen
            outside = (table[name] < low - slack) | (table[name] > high + slack)
            if outside.any():
                warnings.warn(
                    f"{name} = {table[name][outside].iloc[0]:g} is outside of {low:g} to {high:g}, the range trained "
                    f"on ({outside.sum()} of {len(table)} rows): trees don't extrapolate",
                    stacklevel=3,
                )
        return training.booster.predict(require("xgboost", "prediction").DMatrix(table)).astype(float)

    @property
    def fitted(self) -> Training:
        """The training; a ValueError if there was none."""
        if self.training is None:
            raise ValueError("this predictor hasn't learned yet: use what fit(features, offsets) returns, or load")
        return self.training

    def save(self, path: str | PathLike[str]) -> None:
        """Write it as XGBoost's own JSON; `xgboost.Booster` reads the file as well.

        Parameters
        ----------
        path : str or path
            Ends in .json.

        Raises
        ------
        ValueError
            If the predictor isn't fitted, or `path` is no name of a file or doesn't end in .json.
        OSError
            If the file can't be written, as in a folder that doesn't exist.

        See Also
        --------
        OffsetPredictor.load : reads it.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> with TemporaryDirectory() as folder:
        ...     predictor.save(Path(folder, "offsets.json"))
        ...     print([file.name for file in Path(folder).iterdir()])
        ['offsets.json']
        """
        training, path = self.fitted, checks.path("path", path)
        if not str(path).endswith(".json"):
            raise ValueError(f"path must end in .json, got {str(path)!r}")
        known = {"class_count": self.class_count, "quantile": self.quantile, "spread": training.spread,
                 "margin": training.margin, "ranges": training.ranges}  # fmt: skip
        booster = training.booster.copy()
        booster.set_attr(**{ATTRIBUTE: json.dumps(known)})
        known["fingerprint"] = fingerprint(json.loads(booster.save_raw("json")))
        booster.set_attr(**{ATTRIBUTE: json.dumps(known)})
        with written_whole(path) as part:
            part.write_bytes(booster.save_raw("json"))

    @classmethod
    def load(cls, path: str | PathLike[str], features: tuple[str, ...] = FEATURES) -> OffsetPredictor:
        """Read what `save` wrote.

        Parameters
        ----------
        path : str or path
            A file of `save`.
        features : tuple of str
            Columns that it has to have been trained on, in this order.

        Returns
        -------
        OffsetPredictor
            It predicts exactly what the saved one did.

        Raises
        ------
        FileNotFoundError
            If there is no file at `path`.
        ValueError
            If `path` is no name of a file, or `features` are no different names; if the file isn't one of `save`, was
            changed since, or was trained on other columns than `features`.

        See Also
        --------
        OffsetPredictor.save : writes it.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> from uavlab.prediction import OffsetPredictor, make_dataset
        >>> data = make_dataset(count=200, train_count=100)
        >>> predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
        >>> with TemporaryDirectory() as folder:
        ...     predictor.save(f"{folder}/offsets.json")
        ...     OffsetPredictor.load(f"{folder}/offsets.json", ("wind_speed",))
        <OffsetPredictor of wind_speed, 6 classes, quantile 0.95, fitted>
        """
        path, features = checks.path("path", path), checked_names(features)
        xgboost = require("xgboost", "prediction")
        content = path.read_bytes()
        booster = xgboost.Booster()
        try:  # as plain JSON first: XGBoost ends the process on an empty file, and on some that were changed
            model = json.loads(content)
            known = json.loads(model["learner"]["attributes"][ATTRIBUTE])
            if known["fingerprint"] != fingerprint(model):
                raise ValueError("its fingerprint is another")
            booster.load_model(bytearray(content))
            ranges = {name: (float(low), float(high)) for name, (low, high) in known["ranges"].items()}
            training = Training(booster, float(known["spread"]), float(known["margin"]), ranges)
            loaded = cls(tuple(ranges), known["class_count"], known["quantile"], training)
        except (AttributeError, KeyError, TypeError, ValueError, RecursionError, xgboost.core.XGBoostError) as wrong:
            raise ValueError(f"{path} is no file that OffsetPredictor.save wrote, or was changed since") from wrong
        found = tuple(booster.feature_names or ())
        if found != features:
            lacks = [name for name in features if name not in found]
            unknown = [name for name in found if name not in features]
            raise ValueError(
                f"{path} was trained on other features: lacks {', '.join(lacks) or 'none'}; "
                f"unknown: {', '.join(unknown) or 'none, but their order differs'}"
            )
        return loaded


def checked_groups(groups: Any, count: int) -> np.ndarray:
    """A label for each of so many rows: numbers, dates or texts."""
    labels = np.asarray(groups)
    if labels.shape != (count,):
        raise ValueError(f"groups must have shape ({count},), a label for each row, got {labels.shape}")
    without = np.ma.is_masked(groups) or (labels != labels).any()  # NaN and NaT are unequal to themselves
    if without or labels.dtype.kind not in "biufMmUS":
        raise ValueError("groups must be numbers, dates or texts, one for each row and none missing")
    return labels


def checked_names(features: tuple[str, ...]) -> tuple[str, ...]:
    """Names of columns as a tuple, all different."""
    names = features if isinstance(features, Iterable) and not isinstance(features, str) else ()
    names = tuple(names)
    if not names or not all(isinstance(name, str) for name in names) or len(set(names)) < len(names):
        raise ValueError(f"features must be a tuple of different column names, got {features!r:.80}")
    return names


def fingerprint(model: dict[str, Any]) -> str:
    """SHA-256 of a model in XGBoost's JSON, but for what `OffsetPredictor` adds to it."""
    learner = {**model["learner"], "attributes": {}}
    return hashlib.sha256(json.dumps({**model, "learner": learner}, sort_keys=True).encode()).hexdigest()
