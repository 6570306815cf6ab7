"""Figures in matplotlib: plans from above, profiles along a route, sections, stills of a scene.

Every function returns a `Figure`: the last line of a notebook's cell shows it, `figure.savefig("name.png")` writes it.
Colours are those of Okabe and Ito, or of a map that is even in lightness, so that colour-blind readers can tell them
apart. `sliders` makes one figure of many, with sliders that need no kernel.
"""

from uavlab.plot.charts import bars, convergence, front, profile
from uavlab.plot.colors import (
    BLACK,
    BLUE,
    CONVERGENCE_STYLES,
    CRASH_COLOR,
    GREEN,
    ORANGE,
    PINK,
    ROUTE_COLORS,
    SEQUENTIAL,
    SKY,
    YELLOW,
    Style,
    route_colors,
    styles,
)
from uavlab.plot.curves import corner, curve_profile
from uavlab.plot.flights import crash_rates, in_flight, safety_domain, tracks
from uavlab.plot.maps import RISK_LABEL, expansions, field, ground_risk, layers, plan, risk, risk_norm, section
from uavlab.plot.sliders import Sliders, sliders
from uavlab.plot.station import ground_station
from uavlab.plot.stills import still
from uavlab.plot.style import (
    DPI,
    Drawn,
    draw_map,
    finished,
    new_figure,
)

__all__ = [
    "BLACK",
    "BLUE",
    "CONVERGENCE_STYLES",
    "CRASH_COLOR",
    "DPI",
    "GREEN",
    "ORANGE",
    "PINK",
    "RISK_LABEL",
    "ROUTE_COLORS",
    "SEQUENTIAL",
    "SKY",
    "YELLOW",
    "Drawn",
    "Sliders",
    "Style",
    "bars",
    "convergence",
    "corner",
    "crash_rates",
    "curve_profile",
    "draw_map",
    "expansions",
    "field",
    "finished",
    "front",
    "ground_risk",
    "ground_station",
    "in_flight",
    "layers",
    "new_figure",
    "plan",
    "profile",
    "risk",
    "risk_norm",
    "route_colors",
    "safety_domain",
    "section",
    "sliders",
    "still",
    "styles",
    "tracks",
]
