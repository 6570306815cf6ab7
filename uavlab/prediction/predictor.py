"""A predictor to take along: weather in, the distance to be survived out, rounded up on the safe side.

It keeps one XGBoost regression of the logarithm of the offset and the scatter of its residuals. Both give every class
its probability; the class to fly with is the one that the offset doesn't exceed with 95 %. A file of it is XGBoost's
own JSON, in which it also keeps what it was trained on: it refuses other features, and warns outside of their ranges.
"""

from __future__ import annotations

import hashlib
import json
import warnings
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.prediction.generator import (
    FEATURES,
    checked_columns,
    class_probabilities,
    feature_table,
    missing_values,
    offset_class,
)
from uavlab.prediction.models import fit_log_offset
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
        If there are no features or one is repeated, or the quantile or the number of classes is out of its range.
    """

    features: tuple[str, ...] = FEATURES
    class_count: int = 6
    quantile: float = 0.95
    training: Training | None = None

    def __post_init__(self) -> None:
        names = self.features
        if isinstance(names, str) or not names or len(set(names)) < len(names):
            raise ValueError(f"features must be a tuple of different column names, got {names!r}")
        object.__setattr__(self, "features", tuple(names))
        checks.whole("class_count", self.class_count, 2)
        if not 0.5 <= self.quantile < 1:
            raise ValueError(f"quantile must be from 0.5 to below 1, got {self.quantile!r}")

    def __repr__(self) -> str:
        state = "not fitted" if self.training is None else "fitted"
        counts = f"{len(self.features)} features, {self.class_count} classes, quantile {self.quantile:g}"
        return f"<OffsetPredictor: {counts}, {state}>"

    def fit(self, features: Any, offsets: npt.ArrayLike, *, drop_nan: bool = False) -> OffsetPredictor:
        """A predictor that has learned from these flights.

        Parameters
        ----------
        features : pandas.DataFrame
            N rows, at least 20.
        offsets : (N,) array
            ξ [m], above 0.
        drop_nan : bool
            Leave out rows with NaN or infinite values instead of refusing the table.

        Returns
        -------
        OffsetPredictor
            This one stays as it is.

        Raises
        ------
        ValueError
            If a column is missing, a row has no number, an offset isn't above 0, all offsets are equal, or there are
            too few rows.
        """
        table = checked_columns(features, self.features)
        reached = checks.numbers("offsets", offsets)
        if reached.shape != (len(table),):
            raise ValueError(f"offsets must have shape ({len(table)},), one for each row, got {reached.shape}")
        joined = table.assign(offsets=reached)
        wrong = missing_values(joined)
        if wrong and not drop_nan:
            raise ValueError(f"{wrong}; drop_nan=True leaves these rows out")
        whole = np.isfinite(joined.to_numpy()).all(axis=1)
        table, reached = table[whole], reached[whole]
        if not (reached > 0).all():
            raise ValueError(f"offsets must be above 0 [m], got {reached.min():g}")
        if len(table) < MIN_ROWS:
            raise ValueError(f"features must have at least {MIN_ROWS} whole rows, got {len(table)}")
        if np.ptp(reached) == 0:
            raise ValueError(f"offsets must differ, all are {reached[0]:g} m: there is nothing to learn")
        model, residuals = fit_log_offset(table, reached)
        ranges = {name: (float(table[name].min()), float(table[name].max())) for name in self.features}
        margin = float(np.quantile(residuals, self.quantile))
        return replace(self, training=Training(model.get_booster(), float(residuals.std()), margin, ranges))

    def predict_probabilities(self, features: Any) -> np.ndarray:
        """Probability of each class, (N, class_count); parameters and errors as for `predict_class`."""
        return class_probabilities(self.log_offset(features), self.fitted.spread, self.class_count)

    def predict_class(self, features: Any) -> np.ndarray:
        """The most probable class of the offset.

        Parameters
        ----------
        features : pandas.DataFrame or Weather
            N rows with the columns that it was trained on; more columns don't matter.

        Returns
        -------
        (N,) array of int
            1 to `class_count`.

        Raises
        ------
        ValueError
            If it isn't fitted, a column is missing, or a row has a value that is no number.

        Warns
        -----
        UserWarning
            If a value lies outside of the range it was trained on, by over 1 % of it: trees don't extrapolate.
        """
        return 1 + self.predict_probabilities(features).argmax(axis=1)

    def predict_offset(self, features: Any) -> np.ndarray:
        """Offset to be survived ξ [m], rounded up: the class that it doesn't exceed with `quantile`.

        The last class holds all that is larger: there it is a least value.
        Parameters, errors and warnings as for `predict_class`.
        """
        high = np.exp(self.log_offset(features) + self.fitted.margin)
        return offset_class(high, self.class_count).astype(float)

    def predict_sigma(self, features: Any, *, pauta: float = 3.0) -> np.ndarray:
        """Spread σ [m] of the offset's distribution (REPARE Eq. 6), rounded up: ξ / 3.

        The offset is what the strongest gust reaches, and the paper counts with 3σ for that.

        Parameters
        ----------
        features : pandas.DataFrame or Weather
        pauta : float
            Radius of the Pauta criterion in σ, above 0: 3 on one axis, 3.44 in the plane, 3.76 in space.

        Returns
        -------
        (N,) array

        Raises
        ------
        ValueError
            As `predict_class`; if `pauta` isn't above 0.
        """
        checks.positive("pauta", pauta)
        return self.predict_offset(features) / pauta

    def log_offset(self, features: Any) -> np.ndarray:
        """Predicted mean of ln ξ, (N,); parameters, errors and warnings as for `predict_class`."""
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
            If it isn't fitted, or the name doesn't end in .json.
        OSError
            If the file can't be written, as in a folder that doesn't exist.
        """
        training = self.fitted
        if not str(path).endswith(".json"):
            raise ValueError(f"path must end in .json, got {str(path)!r}")
        known = {"class_count": int(self.class_count), "quantile": float(self.quantile), "spread": training.spread,
                 "margin": training.margin, "ranges": training.ranges}  # fmt: skip
        booster = training.booster.copy()
        booster.set_attr(**{ATTRIBUTE: json.dumps(known)})
        known["fingerprint"] = fingerprint(json.loads(booster.save_raw("json")))
        booster.set_attr(**{ATTRIBUTE: json.dumps(known)})
        Path(path).write_bytes(booster.save_raw("json"))

    @classmethod
    def load(cls, path: str | PathLike[str], features: tuple[str, ...] = FEATURES) -> OffsetPredictor:
        """Read what `save` wrote.

        Parameters
        ----------
        path : str or path
        features : tuple of str
            Columns that it has to have been trained on, in this order.

        Returns
        -------
        OffsetPredictor
            It predicts exactly what the saved one did.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If it isn't such a file, was changed since, or was trained on other features.
        """
        xgboost = require("xgboost", "prediction")
        content = Path(path).read_bytes()
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
        if found != tuple(features):
            lacks = [name for name in features if name not in found]
            unknown = [name for name in found if name not in features]
            raise ValueError(
                f"{path} was trained on other features: lacks {', '.join(lacks) or 'none'}; "
                f"unknown: {', '.join(unknown) or 'none, but their order differs'}"
            )
        return loaded


def fingerprint(model: dict[str, Any]) -> str:
    """SHA-256 of a model in XGBoost's JSON, but for what `OffsetPredictor` adds to it."""
    learner = {**model["learner"], "attributes": {}}
    return hashlib.sha256(json.dumps({**model, "learner": learner}, sort_keys=True).encode()).hexdigest()
