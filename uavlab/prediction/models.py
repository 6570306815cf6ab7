"""Models that guess the class of an offset from the weather: the three of REPARE, and better ones.

A model is a function of a `Dataset` that returns its prediction for the rows of the test: class numbers, or for Ridge
values between them. What makes the better ones better is no tuning but what they are told: that classes have an order,
that the offset itself is known, that its scatter is log-normal, and that too low is worse than too high.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from scipy.special import stdtrit

from uavlab import checks
from uavlab.prediction.data import Dataset, Setting, known_setting, make_dataset
from uavlab.prediction.generator import bayes_accuracy, class_probabilities, offset_class
from uavlab.requirements import require
from uavlab.sweep import sweep

if TYPE_CHECKING:
    import pandas

TREES: Mapping[str, Any] = {"n_estimators": 150, "max_depth": 4, "learning_rate": 0.08, "subsample": 0.8}
"""Of the better models: smaller steps than XGBoost's own 0.3, on 80 % of the rows each."""

FIXED: Mapping[str, Any] = {"tree_method": "hist", "n_jobs": 1, "random_state": 0}
"""One thread and one seed: the same answer on each run."""

FOLDS = 4
"""Parts for cross-validation: the scatter of a model is measured where it hasn't learned."""


def ridge(data: Dataset) -> np.ndarray:
    """A plane through the class numbers, as in REPARE: not rounded, so that its R² is that of the plane."""
    model = require("sklearn.linear_model", "prediction").Ridge()
    return model.fit(data.features[data.train], data.classes[data.train]).predict(data.features[data.test])


def gaussian_nb(data: Dataset) -> np.ndarray:
    """Gaussian naive Bayes, as in REPARE: within a class the features are normal and independent."""
    model = require("sklearn.naive_bayes", "prediction").GaussianNB()
    return model.fit(data.features[data.train], data.classes[data.train]).predict(data.features[data.test])


def xgb_classifier(data: Dataset) -> np.ndarray:
    """XGBoost's classifier with its defaults, as in REPARE: classes without an order."""
    model = require("xgboost", "prediction").XGBClassifier(**FIXED)
    known, labels = np.unique(data.classes[data.train], return_inverse=True)
    return known[model.fit(data.features[data.train], labels).predict(data.features[data.test])]


def ordinal(data: Dataset) -> np.ndarray:
    """One classifier for each boundary, P(class > k): it uses the order; the most probable class wins."""
    above = []
    for k in range(1, data.class_count):
        model = require("xgboost", "prediction").XGBClassifier(**TREES, **FIXED)
        label = (data.classes[data.train] > k).astype(int)
        if label.min() == label.max():  # no or every sample lies above: nothing to learn
            above.append(np.full(data.test.sum(), float(label[0])))
        else:
            model.fit(data.features[data.train], label)
            above.append(model.predict_proba(data.features[data.test])[:, 1])
    decreasing = np.minimum.accumulate(above, axis=0)
    return 1 + np.argmax(-np.diff(decreasing, axis=0, prepend=1.0, append=0.0), axis=0)


def log_offset(data: Dataset) -> np.ndarray:
    """Regression on the logarithm of the offset, then the most probable class of a log-normal about it."""
    model, residuals = fit_log_offset(data.features[data.train], data.offsets[data.train])
    middle = model.predict(data.features[data.test])
    return 1 + class_probabilities(middle, float(residuals.std()), data.class_count).argmax(axis=1)


def quantile_class(data: Dataset, quantile: float = 0.95) -> np.ndarray:
    """The class that the offset doesn't exceed with 95 %: the same regression, plus that quantile of its residuals."""
    model, residuals = fit_log_offset(data.features[data.train], data.offsets[data.train])
    high = model.predict(data.features[data.test]) + np.quantile(residuals, quantile)
    return offset_class(np.exp(high), data.class_count)


def quantile_regression(data: Dataset, quantile: float = 0.95) -> np.ndarray:
    """The same class by XGBoost's quantile regression: no shape of the scatter assumed, and none measured."""
    model = require("xgboost", "prediction").XGBRegressor(
        objective="reg:quantileerror", quantile_alpha=quantile, **TREES, **FIXED
    )
    model.fit(data.features[data.train], np.log(data.offsets[data.train]))
    return offset_class(np.exp(model.predict(data.features[data.test]).astype(float)), data.class_count)


Model = Callable[[Dataset], np.ndarray]

PAPER_MODELS: Mapping[str, Model] = {"Ridge": ridge, "GaussianNB": gaussian_nb, "XGBClassifier": xgb_classifier}
MODELS: Mapping[str, Model] = {
    **PAPER_MODELS,
    "ordinal": ordinal,
    "log-offset": log_offset,
    "95 % quantile": quantile_class,
    "95 % quantile regression": quantile_regression,
}


def fit_log_offset(
    features: pandas.DataFrame, offsets: npt.ArrayLike, groups: npt.ArrayLike | None = None
) -> tuple[Any, np.ndarray]:
    """An XGBoost regression of ln ξ, and its residuals on rows that it hadn't learned from.

    Parameters
    ----------
    features : pandas.DataFrame
        N rows.
    offsets : (N,) array
        ξ [m], above 0.
    groups : (N,) array, optional
        Labels of rows that belong together, such as their day; at least 4 different ones.

    Returns
    -------
    xgboost.XGBRegressor, (N,) array
        The residuals ln ξ − prediction are from cross-validation in 4 parts, no group in two of them, so a little
        larger than the noise.
    """
    selection = require("sklearn.model_selection", "prediction")
    model = require("xgboost", "prediction").XGBRegressor(**TREES, **FIXED)
    target = np.log(np.asarray(offsets, dtype=float))
    shuffled = selection.KFold(FOLDS, shuffle=True, random_state=0)
    parts = shuffled if groups is None else selection.GroupKFold(FOLDS)
    residuals = target - selection.cross_val_predict(model, features, target, groups=groups, cv=parts)
    return model.fit(features, target), residuals


def score(data: Dataset, predicted: npt.ArrayLike) -> dict[str, float]:
    """How good a prediction for the rows of the test is.

    Parameters
    ----------
    data : Dataset
        With its rows for the test.
    predicted : array
        For each row of the test, a class or a value between classes; it is rounded for all but R².

    Returns
    -------
    dict
        `accuracy`: share of right classes. `r2`: 1 − squared errors / variance, of the class numbers.
        `under_prediction`: share of classes too low, the dangerous side. `excess`: mean of how many classes too high,
        0 where it isn't. `bayes_gap`: what the accuracy that is to be expected of these classes lacks to the Bayes
        limit; it is computed from the generator's probabilities, so it is free of the luck of the draw.

    Raises
    ------
    ValueError
        If `data` is no Dataset, or `predicted` has not as many values as there are rows for the test, or one that is
        not finite.

    See Also
    --------
    compare_models : scores of several models over several datasets.
    bayes_accuracy : the limit.

    Examples
    --------
    >>> import numpy as np
    >>> from uavlab.prediction import make_dataset, score
    >>> data = make_dataset(count=2000, train_count=1000)
    >>> careful = score(data, np.full(data.test.sum(), 6))
    >>> f"{careful['under_prediction']:.0%} too low, but {careful['excess']:.1f} classes too high on average"
    '0% too low, but 4.0 classes too high on average'
    """
    checks.instance("data", data, Dataset)
    checks.finite("predicted", predicted)
    predicted = np.asarray(predicted, dtype=float)
    true = data.classes[data.test]
    if predicted.shape != true.shape:
        raise ValueError(f"predicted must have shape {true.shape}, one for each row of the test, got {predicted.shape}")
    classes = np.clip(np.rint(predicted), 1, data.class_count).astype(int)
    known = data.log_median[data.test], data.noise, data.class_count
    expected = class_probabilities(*known)[np.arange(len(true)), classes - 1].mean()
    return {
        "accuracy": float((classes == true).mean()),
        "r2": float(require("sklearn.metrics", "prediction").r2_score(true, predicted)),
        "under_prediction": float((classes < true).mean()),
        "excess": float(np.maximum(classes - true, 0).mean()),
        "bayes_gap": bayes_accuracy(*known) - float(expected),
    }


def compare_models(
    seeds: Iterable[int] = range(8),
    *,
    setting: str | Setting = "paper",
    models: Mapping[str, Model] = MODELS,
    jobs: int | None = None,
    progress: bool = True,
    each: bool = False,
) -> pandas.DataFrame:
    """Train every model on one dataset per seed, and compare.

    Parameters
    ----------
    seeds : iterable of int
        One dataset each, `make_dataset(setting, seed)`; at least 2, for an interval.
    setting : str or Setting
        As for `make_dataset`.
    models : mapping of name to function
        Each takes a `Dataset` and returns the prediction for the rows of its test.
    jobs, progress
        As for `uavlab.sweep.sweep`.
    each : bool
        One row per model and seed instead of their means.

    Returns
    -------
    pandas.DataFrame
        A row per model. For each measure of `score`, and `bayes`, the limit on the same rows, there are three columns:
        its mean over the seeds, and with `_low` and `_high` the ends of the mean's 95 % interval (Student's t).

    Raises
    ------
    ValueError
        If `seeds` are fewer than 2, no whole numbers of at least 0, or one is repeated; if `setting` is unknown,
        `models` are no functions by name, `jobs` is 0 or no whole number, or `progress` or `each` is not True or False.

    See Also
    --------
    score : the measures.
    uavlab.sweep.sweep : runs the seeds.

    Examples
    --------
    >>> from uavlab.prediction import MODELS, compare_models
    >>> models = {name: MODELS[name] for name in ("Ridge", "GaussianNB")}
    >>> table = compare_models(range(2), models=models, progress=False)
    >>> table.index.tolist()
    ['Ridge', 'GaussianNB']
    >>> bool((table.accuracy < table.bayes).all())
    True
    """
    pandas = require("pandas", "prediction")
    seeds = checks.seeds("seeds", seeds)
    if len(seeds) < 2 or len(set(seeds)) < len(seeds):  # the same data twice would narrow the interval
        raise ValueError(f"seeds must be at least 2 and all different, got {seeds}")
    setting, models = known_setting(setting), checks.by_name("models", models)
    for name, model in models.items():
        checks.function(f"models[{name!r}]", model, "model(dataset)")
    checks.flag("each", each)
    cases = [{"seed": seed, "setting": setting, "models": models} for seed in seeds]
    tables = sweep(scores_of_seed, cases, jobs=jobs, on_error="raise", progress=progress, unit="dataset")
    table = pandas.DataFrame([row for rows in tables for row in rows])
    if each:
        return table
    measures = [name for name in table.columns if name not in ("model", "seed")]
    groups = table.groupby("model", sort=False)[measures]
    mean, half = groups.mean(), groups.sem() * student_t(len(seeds))
    columns: dict[str, Any] = {}
    for name in measures:
        columns |= {name: mean[name], f"{name}_low": mean[name] - half[name], f"{name}_high": mean[name] + half[name]}
    return pandas.DataFrame(columns)


def scores_of_seed(seed: int, setting: str | Setting, models: Mapping[str, Model]) -> list[dict[str, Any]]:
    data = make_dataset(setting, seed)
    limit = bayes_accuracy(data.log_median[data.test], data.noise, data.class_count)
    rows = []
    for name, model in models.items():
        predicted = checks.numbers(f"what models[{name!r}] returns", model(data))
        rows.append({"model": name, "seed": seed, **score(data, predicted), "bayes": limit})
    return rows


def student_t(count: int, coverage: float = 0.95) -> float:
    """Half-width of the interval of a mean of `count` values, in its standard errors."""
    return float(stdtrit(count - 1, 0.5 + coverage / 2))
