"""Scenes in three dimensions: the city, its routes and the UAV that flies them, in meshcat's viewer.

A scene is one self-contained page: meshcat's viewer script and the scene's commands, packed. No server runs and no
port is opened, so scenes work offline, in a notebook that was exported to HTML, and give the same bytes each
time. Each kind of thing is one merged mesh. In a notebook `show` displays the page, and beside it a still picture
for places that can't run scripts.
"""

from uavlab.requirements import require

require("meshcat", "scene")  # said here, in words, before the modules that import it

from uavlab.scene.pages import Scene, page, show  # noqa: E402

__all__ = ["Scene", "page", "show"]
