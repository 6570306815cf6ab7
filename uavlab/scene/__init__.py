"""Scenes in three dimensions: the city, its routes and the UAVs that fly them, in meshcat's viewer.

A scene is one self-contained page: meshcat's viewer script, the scene's commands and a small player, packed. No server
runs and no port is opened, so scenes work offline, in a notebook that was exported to HTML, and give the same bytes
each time. Each kind of thing is one mesh. `still` draws the same scene as a picture, without a browser; in a notebook
`show` displays the page, and keeps the picture beside it for places that can't run scripts.
"""

from uavlab.requirements import require

require("meshcat", "scene")  # said here, in words, before the modules that import it

from uavlab.scene.live import live, live_curve  # noqa: E402
from uavlab.scene.pages import Scene, page, show  # noqa: E402
from uavlab.scene.stills import still  # noqa: E402

__all__ = ["Scene", "live", "live_curve", "page", "show", "still"]
