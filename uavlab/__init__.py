"""uavlab: how a small UAV finds a safe route through a city, in rain and wind, over people.

The library behind the course in `notebooks/`. Each module is a chapter: `uavlab.city` holds buildings and
voxels, `uavlab.planners` finds routes, `uavlab.route` measures them, `uavlab.plot` and `uavlab.scene` draw them.
Inside, everything is in metres, seconds, kilograms, newtons and radians; x points east, y north, z up.
"""

__version__ = "0.2.0"
