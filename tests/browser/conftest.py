"""Screenshots that are kept."""

from pathlib import Path

import matplotlib.image
import pytest

SCREENSHOTS = Path(__file__).parent / "screenshots"


@pytest.fixture
def picture_of(record_property, request):
    """Take a screenshot of a page or an element, keep it under the test's name, and return it as (h, w, 3) floats."""
    SCREENSHOTS.mkdir(exist_ok=True)

    def take(target, suffix=""):
        path = SCREENSHOTS / f"{request.node.name}{suffix}.png"
        target.screenshot(path=path)
        record_property("screenshot", str(path))
        return matplotlib.image.imread(path)[..., :3]

    return take
