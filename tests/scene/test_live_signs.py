"""The legend of a live scene: the signs that may come while a reader plays, and no others."""

import re

from uavlab import scene
from uavlab.city import table1_city

ENDS = (90, 18, 30), (50, 44, 30)


def signs(**options):
    page = scene.live(table1_city(cell=2.0), *ENDS, **options).page
    return [
        word for word in ("start", "goal", "stopped", "goal not reached", "crash") if f"<span>{word}</span>" in page
    ]


def test_signs_are_those_that_may_come():
    assert signs() == ["start", "goal"]
    assert signs(planners=["A*", "potential field"], shown=["A*"]) == ["start", "goal", "stopped"]
    assert signs(planners=["potential field"]) == ["start", "goal", "stopped"]
    assert signs(flights=5) == ["start", "goal", "crash"]


def test_a_warning_is_dark_on_its_light_ground():
    page = scene.live(table1_city(cell=2.0), *ENDS).page
    assert re.search(r"#live :is\(#wrong,#lifeless\)\{color:#222", page)  # `#legend p` is weaker
