"""Figures in matplotlib: plans from above, profiles along a route, sections, stills of a scene.

Every function returns a `Figure`: the last line of a notebook's cell shows it, `figure.savefig("name.png")` writes it.
Colours are those of Okabe and Ito, or of a map that is even in lightness, so that colour-blind readers can tell them
apart.
"""

from uavlab.plot.charts import bars, convergence, front, profile
from uavlab.plot.curves import corner, curve_profile
from uavlab.plot.flights import (
    crash_rates,
    cross,
    in_flight,
    label_of_flight,
    named_flights,
    safety_domain,
    track,
    tracks,
)
from uavlab.plot.ground import (
    CUT_COLOR,
    LAND_COLOR,
    ZONE_COLOR,
    ground_lattice,
    ground_words,
    height_label,
    height_words,
    lattice_triangles,
    zone_label,
    zone_surface,
)
from uavlab.plot.maps import RISK_LABEL, expansions, field, ground_risk, layers, plan, risk, risk_norm, section
from uavlab.plot.stills import layer_triangles, still, subdivided, voxel_surface
from uavlab.plot.style import (
    CONVERGENCE_STYLES,
    CRASH_COLOR,
    DPI,
    ROUTE_COLORS,
    SEQUENTIAL,
    check_drawn,
    draw_map,
    finished,
    level_of,
    new_figure,
    route_colors,
    sequential_color,
)

__all__ = [
    "CONVERGENCE_STYLES",
    "CRASH_COLOR",
    "CUT_COLOR",
    "DPI",
    "LAND_COLOR",
    "RISK_LABEL",
    "ROUTE_COLORS",
    "SEQUENTIAL",
    "ZONE_COLOR",
    "bars",
    "check_drawn",
    "convergence",
    "corner",
    "crash_rates",
    "cross",
    "curve_profile",
    "draw_map",
    "expansions",
    "field",
    "finished",
    "front",
    "ground_lattice",
    "ground_risk",
    "ground_words",
    "height_label",
    "height_words",
    "in_flight",
    "label_of_flight",
    "lattice_triangles",
    "layer_triangles",
    "layers",
    "level_of",
    "named_flights",
    "new_figure",
    "plan",
    "profile",
    "risk",
    "risk_norm",
    "route_colors",
    "safety_domain",
    "section",
    "sequential_color",
    "still",
    "subdivided",
    "track",
    "tracks",
    "voxel_surface",
    "zone_label",
    "zone_surface",
]
