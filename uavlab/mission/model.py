"""A mission: what an autopilot flies, made from a route.

A route is metres on a map, an autopilot wants degrees on the Earth and altitudes above something that is said. A
mission takes off, flies few waypoints within a corridor that stays clear, and lands, stays or returns, in a fence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City, Place
from uavlab.city.bounds import bounds_of
from uavlab.city.place import ABOVE_SEA, ELLIPSOIDAL, UNKNOWN, place_of
from uavlab.mission import maps, plan_file, waypoint_file
from uavlab.mission.corridor import STOP, Corridor, floor_below, reaches
from uavlab.mission.fences import exclusions, inclusion
from uavlab.mission.items import (
    ABOVE,
    FRAMES,
    HIGHEST,
    HOME,
    LAND,
    SEA,
    TAKEOFF,
    TERRAIN,
    WAYPOINT,
    FencePolygon,
    Item,
    checked_item,
    checked_polygon,
    kept,
    longitude_on_wire,
    on_wire,
)
from uavlab.mission.making import (
    check_ceiling,
    checked_way,
    climb_to_return,
    from_home,
    ground_at_ends,
    height_to_return,
    kept_clearance,
    located,
    rally_points,
    waypoints,
)
from uavlab.route import Route, Way, promises_of
from uavlab.vehicle import UAV

ENDS = ("land", "return", "stay")
CEILING = 120.0
"""Greatest height above ground in the open category of the European Union [m] (Regulation 2019/947, UAS.OPEN.010)."""

MOST_ITEMS = 65_535
"""That MAVLink can count."""


@dataclass(frozen=True, eq=False)
class Mission:
    """What an autopilot flies.

    Attributes
    ----------
    items : tuple of Item
        In order, without home.
    home : Place
        Where it takes off: longitude, latitude [degrees, WGS84], and height [m], see `heights`.
    fence : tuple of FencePolygon
    rally : tuple of Place
        Where to land in trouble; heights are above home [m].
    speed : float
        At which it flies [m/s].
    corner_radius : float
        From how near on it turns to the next waypoint [m].
    heights : {"above sea", "ellipsoidal", "unknown"}
        What home's height is measured from.
    place : Place, optional
        Of x = y = z = 0 of the map that it was made on, heights as of home. None: that of the city's reference.
    return_height : float
        Above home, from which the straight way home is clear from anywhere on the way [m]; 0 where it isn't known.
    name : str
    notes : tuple of str
        What was assumed or left out.

    Raises
    ------
    ValueError
        If `items` is empty or holds something else, or a number in one of them is out of its range; likewise `fence`
        and `rally`; `home` or `place` is no place; `speed` or `corner_radius` is not above 0; `return_height` is
        negative; `heights` is none of the three; or `name` or one of `notes` is no text.

    See Also
    --------
    Mission.from_route : Makes one.
    read_plan, read_wpl : Read one.
    preflight : Whether it should be flown.

    References
    ----------
    MAVLink Developer Guide, mission protocol, mavlink.io.

    Examples
    --------
    >>> from uavlab.mission import Mission
    >>> from uavlab.planners import least_risk
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> campus = reference_campus()
    >>> route = least_risk(campus, *CAMPUS_FLIGHT)
    >>> mission = Mission.from_route(route, campus.city, campus.uav, home=(8.5, 47.25, 420.0))
    >>> mission
    <Mission reference campus: 20 items, 16 m/s, altitudes above home, fence of 1 polygon>
    >>> mission.items[0]
    <Item: take off at 47.2500000°, 8.5000000°, 22.5 m above home>
    """

    items: tuple[Item, ...]
    home: Place
    fence: tuple[FencePolygon, ...] = ()
    rally: tuple[Place, ...] = ()
    speed: float = 5.0
    corner_radius: float = 2.0
    heights: str = UNKNOWN
    place: Place | None = None
    return_height: float = 0.0
    name: str = "mission"
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        items = checks.several("items", self.items, Item)
        if len(items) > MOST_ITEMS:
            raise ValueError(f"items must be at most {MOST_ITEMS:,}, got {len(items):,}")
        object.__setattr__(self, "items", tuple(checked_item(f"items[{n}]", item) for n, item in enumerate(items)))
        polygons = checks.several("fence", self.fence, FencePolygon, least=0)
        object.__setattr__(self, "fence", tuple(checked_polygon(f"fence[{n}]", p) for n, p in enumerate(polygons)))
        points = checks.listed("rally", self.rally, "places")
        object.__setattr__(self, "rally", tuple(on_wire_place(f"rally[{n}]", p) for n, p in enumerate(points)))
        object.__setattr__(self, "home", on_wire_place("home", self.home))
        if self.place is not None:
            object.__setattr__(self, "place", place_of("place", self.place))
        checks.set_fields(self, checks.positive_number, "speed", "corner_radius")
        checks.set_fields(self, checks.not_negative_number, "return_height")
        checks.set_fields(self, checks.one_of, "heights", known=(ABOVE_SEA, ELLIPSOIDAL, UNKNOWN))
        checks.set_fields(self, checks.text, "name")
        notes = checks.listed("notes", self.notes, "sentences")
        object.__setattr__(self, "notes", tuple(checks.text(f"notes[{n}]", note) for n, note in enumerate(notes)))

    def __repr__(self) -> str:
        polygons = f"{len(self.fence)} polygon{'s' * (len(self.fence) != 1)}" if self.fence else "nothing"
        return (
            f"<Mission {self.name}: {len(self.items)} items, {self.speed:g} m/s, altitudes above {self.altitudes}, "
            f"fence of {polygons}>"
        )

    def __str__(self) -> str:
        lines = [repr(self)[1:-1]]
        lines += [f"  {number:3d} {repr(item)[7:-1]}" for number, item in enumerate(self.items)]
        return "\n".join([*lines, *(f"  note: {note}" for note in self.notes)])

    @property
    def altitudes(self) -> str:
        """What the altitudes of its items are measured from: "home", "sea" or "terrain"; all, if they differ."""
        found = dict.fromkeys(ABOVE[item.frame] for item in self.items if item.frame in ABOVE)
        return " and ".join(found) or "nothing"

    @classmethod
    def from_route(
        cls,
        route: Route | Way,
        city: City,
        uav: UAV,
        *,
        home: Place | Sequence[float] | None = None,
        altitudes: str = "home",
        speed: npt.ArrayLike | None = None,
        end: str = "land",
        hold: float = 0.0,
        corner_radius: float = 2.0,
        corridor: float = 1.0,
        min_clearance: float | None = None,
        ceiling: float = CEILING,
        fence_margin: float = 20.0,
        rally: Sequence[npt.ArrayLike] = (),
    ) -> Mission:
        """A mission along a route: take off, fly, and land, return or stay.

        Waypoints are left out where straight legs stay within `corridor` of the route and keep what it promises, all
        along, by exact voxel traversal. A waypoint whose corner can't be rounded by `corner_radius` without coming
        nearer is one to stop at.

        Parameters
        ----------
        route : Route or Curve
            That arrives. It begins and ends where the UAV can rise and land, straight up and down.
        city : City
            What it was planned on.
        uav : UAV
            Its diameter and speeds count.
        home : Place, or (longitude, latitude[, height above sea]), optional
            Where it takes off [degrees, m]; by default what lies below the start of the route. Of a city that doesn't
            know its place on Earth: the place of that. At most 1 km from the start.
        altitudes : {"home", "sea", "terrain"}
            What altitudes are above. "sea" needs heights above sea, of the city's file or of `home`; "terrain" needs an
            autopilot that knows the ground.
        speed : float or (N − 1,) array, optional
            Over ground [m/s], of the whole way or of each leg of the route; by default the UAV's cruise speed.
        end : {"land", "return", "stay"}
            At the goal: land there; fly home, straight at `Mission.return_height`, and land; or hover.
        hold : float
            How long it hovers at the goal first [s].
        corner_radius : float
            From how near on the autopilot turns to the next waypoint [m], above 0; 1 to 5.
        corridor : float
            How far legs may be from the route [m], above 0; 0.5 to 5.
        min_clearance : float, optional
            Least distance to obstacles [m]; by default the route's promise, and at least half the UAV's diameter.
        ceiling : float
            Greatest height above ground [m]; more is refused.
        fence_margin : float
            How far outside of the way the fence runs [m], above 0.
        rally : sequence of (3,) arrays
            Points on the map where it may land in trouble [m].

        Returns
        -------
        Mission
            Its `notes` say what was assumed.

        Raises
        ------
        ValueError
            If `route` doesn't arrive, has no length, isn't clear, is below the ground or above the `ceiling`, or begins
            or ends where no UAV can rise or land, for a wall or a no-fly zone; `end` is "return", and something hangs
            over the goal or home, a no-fly zone is on the straight way, or that is above the `ceiling`; `city` has no
            place on Earth and `home` isn't given, or `home` is no place or over 1 km from the start; `altitudes` are
            "sea" and no height above sea is known; `speed` is not above 0, above the UAV's top speed or not one for
            each leg; `end` or `altitudes` is unknown; `corner_radius`, `corridor`, `ceiling` or `fence_margin` is not
            above 0; `hold` or `min_clearance` is negative; or a point of `rally` isn't free, or is in a no-fly zone.

        See Also
        --------
        preflight : Whether it should be flown.
        Mission.path : The way on the map.
        uavlab.mavlink.upload : To a vehicle.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> route = Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> print(Mission.from_route(route, table1_city(), LIGHT_QUADROTOR, home=(4.36, 52.01), end="return"))
        Mission the city of REPARE Table 1: 6 items, 5 m/s, altitudes above home, fence of 1 polygon
            0 take off at 52.0100000°, 4.3600000°, 30.0 m above home
            1 change speed to 5 m/s
            2 waypoint at 52.0100000°, 4.3605097°, 30.0 m above home
            3 waypoint at 52.0104044°, 4.3605097°, 30.0 m above home
            4 waypoint at 52.0104044°, 4.3605097°, 65.5 m above home, hold 1 s
            5 return
          note: the height of home above the sea isn't known
        """
        way = checked_way(route, city)
        checks.instance("uav", uav, UAV)
        frame = FRAMES[checks.one_of("altitudes", altitudes, FRAMES)]
        checks.one_of("end", end, ENDS)
        hold = checks.not_negative_number("hold", hold)
        radius = checks.positive_number("corner_radius", corner_radius)
        margin = checks.positive_number("fence_margin", fence_margin)
        ceiling = checks.positive_number("ceiling", ceiling)
        check_ceiling(way, city, ceiling)
        keep = kept_clearance(way, uav, min_clearance)
        bounds = bounds_of(city, **promises_of(way, min_clearance=keep))
        legs = Corridor(city, bounds, checks.positive_number("corridor", corridor), frame == TERRAIN, ceiling)
        points, speeds = waypoints(legs, way, uav, speed)
        site, notes = located(city, home, points[0], altitudes)
        points, speeds = from_home(legs, site, points, speeds)
        below = ground_at_ends(city, uav, points, end)
        return_height = height_to_return(site, points, keep)
        climb = climb_to_return(legs, site, points, return_height, uav) if end == "return" else points[:0]
        flown = np.vstack([points, climb])
        stops = legs.stops(flown, radius)[: len(points)]
        holds = np.where(stops, STOP, 0.0)
        holds[-1] = max(holds[-1], hold)
        items = site.way(frame, points, speeds, holds, reaches(flown, radius))
        items += site.ending(end, frame, points[-1], below, climb)
        rallied = rally_points(site, rally)
        around = np.vstack([site.at, points, *[point for point, _ in rallied]])[:, :2]
        over = np.vstack([points, *[site.at] * (end == "return")])
        closed, crossed = exclusions(city, site.plan, over)
        notes += [f"the fence leaves out {name}: the way crosses it in plan" for name in crossed]
        notes += [f"it stops at {stops.sum()} corners that it can't round"] * bool(stops.any())
        return cls(
            tuple(items), site.home, (inclusion(site.plan, around, margin), *closed),
            tuple(where for _, where in rallied), float(speeds.max()), radius, site.heights, site.place, return_height,
            city.name, tuple(notes),
        )  # fmt: skip

    def place_on(self, city: City) -> Place:
        """Where on Earth x = y = 0 of the map is, by the city, or by the mission where it doesn't know."""
        checks.instance("city", city, City)
        return self.place if city.reference is None and self.place is not None else city.checked_reference()

    def home_on(self, city: City) -> np.ndarray:
        """Home on the map, (3,) [m]; on what lies there, but on the map that the mission was made on."""
        place = self.place_on(city)
        east, north = place.east_north((self.home.longitude, self.home.latitude))
        if self.place is not None and self.place[:2] == place[:2]:
            return np.array([east, north, self.home.height - self.place.height])
        return np.array([east, north, floor_below(city, np.array([east, north, city.bounds[1, 2]]))[0]])

    def path(self, city: City) -> Route:
        """The way on the map: home, the waypoints, and where it lands.

        Parameters
        ----------
        city : City
            The one that it was made on, or another map of the place.

        Returns
        -------
        Route
            With straight legs, corners not rounded; its first leg is the take-off, its last one the landing, if any.
            Of altitudes above terrain, that of the city.

        Raises
        ------
        ValueError
            If `city` is no City, or has no place on Earth and the mission was read from a file; or an item has a place
            in a frame that is none of sea, home and terrain.

        See Also
        --------
        Mission.from_route : The other way.

        Examples
        --------
        >>> from uavlab.city import table1_city
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
        >>> (mission.path(city).points.round(1) + 0.0).tolist()
        [[5.0, 5.0, 0.0], [5.0, 5.0, 30.0], [40.0, 5.0, 30.0], [40.0, 50.0, 30.0], [40.0, 50.0, 0.0]]
        """
        checks.instance("city", city, City)
        at = self.home_on(city)
        points = [at, *(self.point_of(item, city, at) for item in self.items if item.command in (TAKEOFF, WAYPOINT))]
        landing = 0
        for item in self.items:
            if item.command == LAND:
                points.append(self.point_of(item, city, at))
                landing = 1
        taken_off = int(any(item.command == TAKEOFF for item in self.items))
        return Route(np.array(points), self.name, takeoff=taken_off, landing=landing)

    def point_of(self, item: Item, city: City, at: np.ndarray) -> np.ndarray:
        """The place of an item on the map, with home at (3,) [m]."""
        place = self.place_on(city)
        plan = place.east_north((item.longitude, item.latitude))
        if item.frame == SEA:
            return np.array([*plan, item.altitude - self.home.height + at[2]])
        if item.frame == HOME:
            return np.array([*plan, item.altitude + at[2]])
        if item.frame == TERRAIN:
            ground = -float(city.height_above_ground((*plan, 0.0)))
            return np.array([*plan, item.altitude + ground])
        raise ValueError(
            f"a {item!r} has a place in frame {item.frame}, known are {SEA} (above sea), {HOME} (above home) and "
            f"{TERRAIN} (above terrain)"
        )

    def to_plan(self, path: str | Path) -> None:
        """Write a `.plan` of QGroundControl: mission, fence and rally points.

        Parameters
        ----------
        path : str or Path
            What is there is replaced.

        Raises
        ------
        ValueError
            If `path` is not the name of a file.

        See Also
        --------
        read_plan : The way back.
        Mission.to_wpl : For other ground stations.

        References
        ----------
        QGroundControl Developer Guide, plan file format, docs.qgroundcontrol.com.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from uavlab.city import Place
        >>> from uavlab.mission import Item, Mission, read_plan
        >>> mission = Mission((Item(16, 3, (0, 2, 0, 0), 47.25, 8.5, 30.0),), Place(8.5, 47.25, 420.0))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     mission.to_plan(Path(folder) / "flight.plan")
        ...     read_plan(Path(folder) / "flight.plan").items == mission.items
        True
        """
        plan_file.write_plan(self, path)

    def to_wpl(self, path: str | Path) -> None:
        """Write waypoints as text, `QGC WPL 110`, which Mission Planner, MAVProxy and others read; item 0 is home.

        Parameters
        ----------
        path : str or Path
            What is there is replaced.

        Raises
        ------
        ValueError
            If `path` is not the name of a file.

        See Also
        --------
        read_wpl : The way back.
        Mission.to_plan : With fence and rally points, for which this format has no place.

        References
        ----------
        MAVLink Developer Guide, mission plain-text file format, mavlink.io.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from uavlab.city import Place
        >>> from uavlab.mission import Item, Mission
        >>> mission = Mission((Item(16, 3, (0, 2, 0, 0), 47.25, 8.5, 30.0),), Place(8.5, 47.25, 420.0))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     mission.to_wpl(Path(folder) / "flight.waypoints")
        ...     print((Path(folder) / "flight.waypoints").read_text().expandtabs(2).rstrip())
        QGC WPL 110
        0 1 0 16  0 0 0 0 47.2500000  8.5000000 420.000 1
        1 0 3 16  0 2 0 0 47.2500000  8.5000000 30.000  1
        """
        waypoint_file.write_wpl(self, path)

    def to_kml(self, path: str | Path, city: City) -> None:
        """Write the way and the fence for Google Earth and other maps (KML 2.2).

        Parameters
        ----------
        path : str or Path
            What is there is replaced.
        city : City
            For heights above ground, where those above the sea aren't known.

        Raises
        ------
        ValueError
            If `path` is not the name of a file, or `city` is what `Mission.path` refuses.

        See Also
        --------
        Mission.to_gpx, Mission.to_geojson : For other maps.

        References
        ----------
        OGC KML 2.2, Open Geospatial Consortium, 07-147r2, 2008.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from uavlab.city import table1_city
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     mission.to_kml(Path(folder) / "flight.kml", city)
        ...     "<altitudeMode>relativeToGround</altitudeMode>" in (Path(folder) / "flight.kml").read_text()
        True
        """
        maps.write_kml(self, path, city)

    def to_gpx(self, path: str | Path, city: City) -> None:
        """Write the way for GPS receivers and maps (GPX 1.1); heights only where those above the sea are known.

        Parameters
        ----------
        path : str or Path
            What is there is replaced.
        city : City
            The one that it was made on.

        Raises
        ------
        ValueError
            If `path` is not the name of a file, or `city` is what `Mission.path` refuses.

        See Also
        --------
        Mission.to_kml, Mission.to_geojson : For other maps.

        References
        ----------
        GPX 1.1 Schema Documentation, TopoGrafix, 2004.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from uavlab.city import table1_city
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01, 3.0))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     mission.to_gpx(Path(folder) / "flight.gpx", city)
        ...     (Path(folder) / "flight.gpx").read_text().count("<ele>")
        5
        """
        maps.write_gpx(self, path, city)

    def to_geojson(self, path: str | Path, city: City) -> None:
        """Write waypoints, way and fence as GeoJSON; heights stand in the properties, with what they are above.

        Parameters
        ----------
        path : str or Path
            What is there is replaced.
        city : City
            The one that it was made on.

        Raises
        ------
        ValueError
            If `path` is not the name of a file, or `city` is what `Mission.path` refuses.

        See Also
        --------
        Mission.to_kml, Mission.to_gpx : For other maps.

        References
        ----------
        H. Butler and others, "The GeoJSON format", RFC 7946, 2016.

        Examples
        --------
        >>> import json, tempfile
        >>> from pathlib import Path
        >>> from uavlab.city import table1_city
        >>> from uavlab.mission import Mission
        >>> from uavlab.route import Route
        >>> from uavlab.vehicle import LIGHT_QUADROTOR
        >>> city, route = table1_city(), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
        >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     mission.to_geojson(Path(folder) / "flight.geojson", city)
        ...     written = json.loads((Path(folder) / "flight.geojson").read_text())
        >>> [one["geometry"]["type"] for one in written["features"]]
        ['Point', 'Point', 'Point', 'Point', 'Point', 'LineString', 'Polygon']
        """
        maps.write_geojson(self, path, city)


def on_wire_place(name: str, value: Any) -> Place:
    """A place with its numbers as they travel."""
    place = place_of(name, value)
    checks.within(f"{name}: height", place.height, -HIGHEST, HIGHEST, "m")
    return Place(longitude_on_wire(place.longitude), on_wire(place.latitude), kept(place.height))
