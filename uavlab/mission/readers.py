"""Missions from files of ground stations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from uavlab import checks
from uavlab.mission.model import Mission
from uavlab.mission.plan_file import fields_of_plan
from uavlab.mission.waypoint_file import fields_of_wpl


def read_plan(path: str | Path) -> Mission:
    """A mission from a `.plan` of QGroundControl, with its fence and rally points.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Mission
        Of one of another program, home's height is taken as above the sea, as the format has it; a circle of the fence
        becomes a polygon.

    Raises
    ------
    ValueError
        If `path` is not the name of a file, or the file is no plan, is damaged, or has complex items such as surveys.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    Mission.to_plan : The way there, with an example.
    read_wpl : Another format.

    References
    ----------
    QGroundControl Developer Guide, plan file format, docs.qgroundcontrol.com.

    Examples
    --------
    >>> from uavlab.mission import read_plan
    >>> read_plan("no such file.plan")
    Traceback (most recent call last):
    FileNotFoundError: [Errno 2] No such file or directory: 'no such file.plan'
    """
    path = checks.path("path", path)
    return mission_of(path, fields_of_plan(path))


def read_wpl(path: str | Path) -> Mission:
    """A mission from a file of waypoints, `QGC WPL 110`; its first line is home.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Mission
        Without fence and rally points, for which the format has no place.

    Raises
    ------
    ValueError
        If `path` is not the name of a file, or the file is none of this format or is damaged.
    FileNotFoundError
        If there is no file at `path`.

    See Also
    --------
    Mission.to_wpl : The way there, with an example.
    read_plan : Another format.

    References
    ----------
    MAVLink Developer Guide, mission plain-text file format, mavlink.io.

    Examples
    --------
    >>> from uavlab.mission import read_wpl
    >>> read_wpl("no such file.waypoints")
    Traceback (most recent call last):
    FileNotFoundError: [Errno 2] No such file or directory: 'no such file.waypoints'
    """
    path = checks.path("path", path)
    return mission_of(path, fields_of_wpl(path))


def mission_of(path: Path, fields: dict[str, Any]) -> Mission:
    """The mission that a file says; `ValueError` with its name where that makes no sense."""
    try:
        return Mission(**fields)
    except ValueError as error:
        raise ValueError(f"{path.name} has no mission that can be flown: {error!s:.300}") from error
