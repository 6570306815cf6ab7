"""What a screenshot shows, by the colours in it."""

import numpy as np
from matplotlib.colors import rgb_to_hsv, to_rgb


def share_of_hue(picture, color, *, tolerance=0.035, saturation=0.12):
    """Share of the pixels that have the hue of a colour, in light or in shade."""
    hsv = rgb_to_hsv(np.clip(picture, 0, 1))
    distance = np.abs(hsv[..., 0] - rgb_to_hsv(to_rgb(color))[0])
    return float(((np.minimum(distance, 1 - distance) < tolerance) & (hsv[..., 1] > saturation)).mean())


def shades_of_hue(picture, color, *, least=0.0005):
    """How many clearly different brightnesses of a colour fill at least a share `least` of the picture."""
    hsv = rgb_to_hsv(np.clip(picture, 0, 1))
    same = (np.abs(hsv[..., 0] - rgb_to_hsv(to_rgb(color))[0]) < 0.035) & (hsv[..., 1] > 0.12)
    counts, _ = np.histogram(hsv[..., 2][same], bins=50, range=(0, 1))
    return int((counts > least * same.size).sum())
