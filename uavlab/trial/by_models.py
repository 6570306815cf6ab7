"""What REPARE says of predictions: how often three models name the right class of offset, or one too low."""

from __future__ import annotations

from functools import cache

import numpy as np

from uavlab.prediction import FEATURES, median_offsets, offset_class
from uavlab.requirements import require
from uavlab.trial.judging import Measured
from uavlab.trial.measures import fewer, statistic_of
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import greensboro_weather


@cache
def simulated() -> tuple:
    """Real weather of a year, and simulated classes of offsets, as in chapter 03."""
    features = greensboro_weather()[list(FEATURES)]
    noise = np.exp(0.21 * np.random.default_rng(3).standard_normal(len(features)))
    return features, offset_class(median_offsets(features, LIGHT_QUADROTOR) * noise, 6)


def models() -> dict:
    linear, bayes = require("sklearn.linear_model", "prediction"), require("sklearn.naive_bayes", "prediction")
    trees = require("xgboost", "prediction").XGBClassifier(n_jobs=1, random_state=0)
    return {"Ridge": linear.Ridge(), "GaussianNB": bayes.GaussianNB(), "XGBClassifier": trees}


def predictions(size: int, seed: int) -> dict[str, Measured]:
    """Accuracy of the three models [%], which is best, and how often the class is exceeded, over splits at random.

    Splits share the year, so each interval is that of one split's test.
    """
    selection = require("sklearn.model_selection", "prediction")
    features, classes = simulated()
    right: dict[str, list] = {name: [] for name in models()}
    safe = []
    for split in range(seed, seed + size):
        learn, test = selection.train_test_split(np.arange(len(features)), test_size=0.2, random_state=split)
        for name, model in models().items():
            said = model.fit(features.iloc[learn], classes[learn] - 1).predict(features.iloc[test])
            said = 1 + np.clip(np.rint(said), 0, 5)
            right[name].append(said == classes[test])
        safe.append(said >= classes[test])
    found = {name: of_one_split(100.0 * np.array(hits)) for name, hits in right.items()}
    for other in ("GaussianNB", "Ridge"):
        ours, theirs = (np.array(right[name]) for name in ("XGBClassifier", other))
        found[f"ahead of {other}"] = fewer(theirs[0], ours[0], f"{ours.shape[1]} flights of the first split")
    return found | {"safe": of_one_split(100.0 * np.array(safe))}


def of_one_split(values: np.ndarray) -> Measured:
    """Mean over splits (S, N), and the interval of the mean of one of them: they share the year."""
    first, mean = statistic_of(values[0], ""), float(values.mean())
    sample = f"{len(values)} splits × {values.shape[1]} flights"
    return Measured(mean, mean - (first.value - first.low), mean + (first.high - first.value), sample)
