"""Figures as small PNGs, and with words for those who don't see them, as notebooks keep them."""

from __future__ import annotations

import base64
import io
from typing import Any

from matplotlib.figure import Figure
from PIL import Image

from uavlab.plot.palette import indexed, png
from uavlab.plot.words import alt_text


class Picture(Figure):
    """A figure that brings its alternative text along into a notebook, and so into its HTML."""

    def _repr_mimebundle_(self, **_: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        buffer = io.BytesIO()
        self.savefig(buffer, format="png", bbox_inches="tight")
        picture = base64.b64encode(buffer.getvalue()).decode()
        return {"image/png": picture}, {"image/png": {"alt": alt_text(self)}}


def quantised(picture: bytes) -> bytes:
    """A PNG with a palette, or as it is where it has one or is smaller."""
    if Image.open(io.BytesIO(picture)).mode == "P":
        return picture
    palette, frames = indexed([picture])
    small = png(frames[0], palette)
    return small if len(small) < len(picture) else picture


def png_of(figure: Figure, dpi: float) -> bytes:
    """A figure as a PNG with a palette: small, and the same bytes for the same figure."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi)
    return quantised(buffer.getvalue())
