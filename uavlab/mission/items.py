"""What a mission is made of, as MAVLink has it: items with a command and a frame, polygons of a fence.

Numbers are kept as exactly as they travel: degrees to 1e-7 (a centimetre), altitudes and parameters to a thousandth. So
what is read back from a file or a vehicle equals what was written.
"""

from __future__ import annotations

import math
import struct
from typing import Any, NamedTuple

from uavlab import checks

WAYPOINT, LOITER, RETURN, LAND, TAKEOFF, CHANGE_SPEED = 16, 17, 20, 21, 22, 178
"""Commands of MAVLink (MAV_CMD)."""

INCLUDE, EXCLUDE, RALLY = 5001, 5002, 5100
"""Those of a fence's corners and of rally points."""

COMMANDS = {
    WAYPOINT: "waypoint", LOITER: "stay", RETURN: "return", LAND: "land", TAKEOFF: "take off",
    CHANGE_SPEED: "change speed",
}  # fmt: skip
"""What the table of a mission calls them."""

PLACED = (WAYPOINT, LOITER, LAND, TAKEOFF)
"""Commands that have a place."""

SEA, NO_FRAME, HOME, TERRAIN = 0, 2, 3, 10
"""Frames of MAVLink (MAV_FRAME)."""

FRAMES = {"sea": SEA, "home": HOME, "terrain": TERRAIN}
"""By what altitudes are measured from."""

ABOVE = {frame: word for word, frame in FRAMES.items()}
"""The other way round."""

DEGREES, THOUSANDTHS = 7, 3
"""Digits that are kept."""

GREATEST = 3.4e38
"""Number that 32 bits hold."""

HIGHEST = 20_000.0
"""Beyond it [m] no multirotor flies."""


class Item(NamedTuple):
    """One step of a mission, as MAVLink has it.

    Attributes
    ----------
    command : int
        MAV_CMD, such as 16 for a waypoint.
    frame : int
        MAV_FRAME: what the altitude is measured from, 0 the sea, 3 home, 10 the terrain; 2 where there is no place.
    parameters : tuple of four floats
        What they are the command says: of a waypoint seconds to hold, radius of acceptance [m], 0, and heading
        [degrees from north]; NaN for "as it is"; of a change of speed 1 (over ground), speed [m/s], −1, 0.
    latitude, longitude : float
        [degrees, WGS84], to 1e-7.
    altitude : float
        [m], to a millimetre.

    See Also
    --------
    Mission : Holds them in order.

    References
    ----------
    MAVLink Developer Guide, mission protocol and MAV_CMD, mavlink.io.

    Examples
    --------
    >>> from uavlab.mission import Item
    >>> Item(16, 3, (0.0, 2.0, 0.0, 90.0), 52.5163, 13.3777, 30.0)
    <Item: waypoint at 52.5163000°, 13.3777000°, 30.0 m above home>
    """

    command: int
    frame: int = NO_FRAME
    parameters: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    latitude: float = 0.0
    longitude: float = 0.0
    altitude: float = 0.0

    def __repr__(self) -> str:
        name = COMMANDS.get(self.command, f"command {self.command}")
        if self.command == CHANGE_SPEED:
            return f"<Item: {name} to {self.parameters[1]:g} m/s>"
        if self.command not in PLACED:
            return f"<Item: {name}>"
        above = ABOVE.get(self.frame, f"frame {self.frame}")
        held = f", hold {self.parameters[0]:g} s" if self.command == WAYPOINT and self.parameters[0] else ""
        place = f"{self.latitude:.7f}°, {self.longitude:.7f}°, {self.altitude:.1f} m above {above}"
        return f"<Item: {name} at {place}{held}>"


class FencePolygon(NamedTuple):
    """One polygon of a fence, at all heights: autopilots know no others.

    Attributes
    ----------
    corners : tuple of (latitude, longitude)
        [degrees, WGS84], to 1e-7; at least three, not closed.
    inclusion : bool
        Whether to stay inside, or outside.
    name : str
        What messages call it; files don't keep it.

    See Also
    --------
    Mission : Has some as its `fence`.

    Examples
    --------
    >>> from uavlab.mission import FencePolygon
    >>> FencePolygon(((52.516, 13.377), (52.517, 13.377), (52.517, 13.379)), inclusion=True)
    <FencePolygon fence: stay inside of 3 corners>
    """

    corners: tuple[tuple[float, float], ...]
    inclusion: bool
    name: str = "fence"

    def __repr__(self) -> str:
        return (
            f"<FencePolygon {self.name}: stay {'in' if self.inclusion else 'out'}side of {len(self.corners)} corners>"
        )


def checked_item(name: str, item: Any) -> Item:
    """The item with its numbers as they travel."""
    checks.instance(name, item, Item)
    command = checks.whole(f"{name}.command", item.command, 0, 65535)
    frame = checks.whole(f"{name}.frame", item.frame, 0, 255)
    first, second, third, fourth = checked_parameters(name, item)
    latitude, longitude = checked_degrees(name, item.latitude, item.longitude)
    altitude = checks.number(f"{name}.altitude", item.altitude, checks.within, -HIGHEST, HIGHEST, "m")
    parameters = tuple(kept(value) for value in (first, second, third, fourth))
    return Item(command, frame, parameters, latitude, longitude, kept(altitude))  # type: ignore[arg-type]


def checked_parameters(name: str, item: Item) -> list[float]:
    """Four numbers; NaN is one, and says "as it is"."""
    parameters = checks.array(f"{name}.parameters", item.parameters, 4, finite=False)
    fits = ~(abs(parameters) > GREATEST)
    checks.refuse(parameters, fits, f"{name}.parameters must not be infinite, or too large for 32 bits")
    return parameters.tolist()


def checked_polygon(name: str, polygon: Any) -> FencePolygon:
    """The polygon with its corners as they travel."""
    checks.instance(name, polygon, FencePolygon)
    corners = tuple(
        checked_corner(f"{name}.corners", corner) for corner in checks.listed(name, polygon.corners, "corners")
    )
    if len(set(corners)) < 3:
        raise ValueError(f"{name} must have at least three different corners, got {len(set(corners))}")
    inclusion = checks.flag(f"{name}.inclusion", polygon.inclusion)
    return FencePolygon(corners, inclusion, checks.text(f"{name}.name", polygon.name))


def checked_corner(name: str, corner: Any) -> tuple[float, float]:
    """Latitude and longitude [degrees] as they travel."""
    return checked_degrees(name, *checks.array(name, corner, 2).tolist())


def checked_degrees(name: str, latitude: float, longitude: float) -> tuple[float, float]:
    """The same of two numbers."""
    order = "degrees (the order is latitude, longitude)"
    north = checks.number(f"{name}: latitude", latitude, checks.within, -90.0, 90.0, order)
    east = checks.number(f"{name}: longitude", longitude, checks.within, -540.0, 540.0, "degrees")
    return on_wire(north), longitude_on_wire(east)


def has_place(item: Item) -> bool:
    """Whether latitude, longitude and altitude of an item are a place."""
    return item.command in PLACED or (item.frame != NO_FRAME and bool(item.latitude or item.longitude))


def on_wire(degrees: float) -> float:
    """Degrees as they travel, in whole 1e-7; no −0."""
    return round(degrees, DEGREES) + 0.0


def longitude_on_wire(degrees: float) -> float:
    """The same within −180 to 180, without 180 itself, which is −180."""
    return on_wire((on_wire(degrees) + 180.0) % 360.0 - 180.0)


def kept(value: float) -> float:
    """A parameter or an altitude as 32 bits hold it, to a thousandth; no −0, and one NaN for all: so items compare."""
    single = struct.unpack("<f", struct.pack("<f", value))[0]
    return math.nan if math.isnan(single) else round(single, THOUSANDTHS) + 0.0
