"""Figures in matplotlib: plans from above, profiles along a route, sections, charts.

Every function returns a `Figure`: the last line of a notebook's cell shows it, `figure.savefig("name.png")` writes it.
Colours are those of Okabe and Ito, or of a map that is even in lightness, so that colour-blind readers can tell them
apart. `sliders` makes one figure of many, with sliders that need no kernel.
"""

from uavlab.plot.charts import bars, convergence, front, profile
from uavlab.plot.colors import (
    BLACK,
    BLUE,
    CRASH_COLOR,
    GREEN,
    ORANGE,
    PINK,
    SEQUENTIAL,
    SKY,
    YELLOW,
    Style,
    styles,
)
from uavlab.plot.curves import corner, curve_profile
from uavlab.plot.flights import crash_rates, in_flight, safety_domain, tracks
from uavlab.plot.grids import heat_map, matrix
from uavlab.plot.maps import RISK_LABEL, expansions, field, ground_risk, layers, plan, risk, risk_norm, section
from uavlab.plot.panels import new_panels
from uavlab.plot.planes import area_map, diagram, value_map
from uavlab.plot.rows import intervals, runs
from uavlab.plot.series import lines, points
from uavlab.plot.sliders import Sliders, sliders
from uavlab.plot.station import ground_station
from uavlab.plot.style import (
    DPI,
    Drawn,
    draw_map,
    finished,
    new_figure,
)
from uavlab.plot.words import alt_text

__all__ = [
    "BLACK",
    "BLUE",
    "CRASH_COLOR",
    "DPI",
    "GREEN",
    "ORANGE",
    "PINK",
    "RISK_LABEL",
    "SEQUENTIAL",
    "SKY",
    "YELLOW",
    "Drawn",
    "Sliders",
    "Style",
    "alt_text",
    "area_map",
    "bars",
    "convergence",
    "corner",
    "crash_rates",
    "curve_profile",
    "diagram",
    "draw_map",
    "expansions",
    "field",
    "finished",
    "front",
    "ground_risk",
    "ground_station",
    "heat_map",
    "in_flight",
    "intervals",
    "layers",
    "lines",
    "matrix",
    "new_figure",
    "new_panels",
    "plan",
    "points",
    "profile",
    "risk",
    "risk_norm",
    "runs",
    "safety_domain",
    "section",
    "sliders",
    "styles",
    "tracks",
    "value_map",
]
