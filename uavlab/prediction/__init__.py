"""From the weather to the class of the offset: data, the models of REPARE and better ones, the Bayes limit."""

from uavlab.prediction.data import SETTINGS, Dataset, Setting, make_dataset, synthetic_weather
from uavlab.prediction.generator import (
    FEATURES,
    bayes_accuracy,
    class_probabilities,
    median_offsets,
    offset_class,
    simulate_offsets,
)
from uavlab.prediction.models import MODELS, PAPER_MODELS, compare_models, score
from uavlab.prediction.predictor import OffsetPredictor

__all__ = [
    "FEATURES",
    "MODELS",
    "PAPER_MODELS",
    "SETTINGS",
    "Dataset",
    "OffsetPredictor",
    "Setting",
    "bayes_accuracy",
    "class_probabilities",
    "compare_models",
    "make_dataset",
    "median_offsets",
    "offset_class",
    "score",
    "simulate_offsets",
    "synthetic_weather",
]
