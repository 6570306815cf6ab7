"""From a route to the items of a mission: where home is, which waypoints, and what the autopilot does at the end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from uavlab import checks
from uavlab.city import City, Place
from uavlab.city.place import ABOVE_SEA, ELLIPSOIDAL, UNKNOWN, place_of
from uavlab.mission.corridor import (
    STOP,
    Corridor,
    above_ground,
    check_column,
    extremes,
    floor_below,
    zone_on_way,
)
from uavlab.mission.items import (
    CHANGE_SPEED,
    HOME,
    LAND,
    LOITER,
    NO_FRAME,
    RETURN,
    SEA,
    TAKEOFF,
    WAYPOINT,
    Item,
)
from uavlab.route import Route, Way, as_route
from uavlab.spline.curve import contact_distance
from uavlab.vehicle import UAV

FARTHEST_HOME = 1000.0
"""From the start of a route [m]; home is farther only by mistake."""

OVER_GROUND = 1.0
"""What a change of speed says of ground speed."""


class Site(NamedTuple):
    """Where a mission is flown."""

    city: City
    place: Place
    """Of x = y = z = 0, heights as of home."""
    at: np.ndarray
    """Home on the map, (3,) [m]."""
    heights: str
    """What those of `place` are measured from."""

    @property
    def home(self) -> Place:
        return self.geographic(self.at)

    @property
    def plan(self) -> Place:
        """Of x = y = 0, as the city has it: metres are those at its height, whatever home's are measured from."""
        return self.place if self.city.reference is None else self.city.reference

    def geographic(self, point: np.ndarray) -> Place:
        """A point of the map on the Earth."""
        longitude, latitude = self.plan.longitude_latitude(point[:2])
        return Place(float(longitude), float(latitude), float(point[2] + self.place.height))

    def item(self, command: int, frame: int, point: np.ndarray, parameters: tuple[float, float, float, float]) -> Item:
        """An item at a point of the map, its altitude in a frame."""
        there = self.geographic(point)
        if frame == SEA:
            altitude = there.height
        elif frame == HOME:
            altitude = float(point[2] - self.at[2])
        else:
            altitude = float(self.city.height_above_ground(point))
        return Item(command, frame, parameters, there.latitude, there.longitude, altitude)

    def way(
        self, frame: int, points: np.ndarray, speeds: np.ndarray, holds: np.ndarray, radii: np.ndarray
    ) -> list[Item]:
        """Take off to the first of the points (N, 3), and fly the others, each leg at its speed (N − 1,)."""
        items = [self.item(TAKEOFF, frame, points[0], (0.0, 0.0, 0.0, heading(points[0], points[1])))]
        asked = None
        for number in range(1, len(points)):
            if speeds[number - 1] != asked:
                asked = float(speeds[number - 1])
                items.append(Item(CHANGE_SPEED, NO_FRAME, (OVER_GROUND, asked, -1.0, 0.0)))
            onwards = (
                heading(*points[[number - 1, number]])
                if number == len(points) - 1
                else heading(*points[[number, number + 1]])
            )
            parameters = float(holds[number]), float(radii[number]), 0.0, onwards
            items.append(self.item(WAYPOINT, frame, points[number], parameters))
        return items

    def ending(self, end: str, frame: int, goal: np.ndarray, below: float, climb: np.ndarray) -> list[Item]:
        """What it does at the goal; to return it first rises to where the way home is clear, (0 or 1, 3)."""
        if end == "land":
            return [self.item(LAND, frame, np.array([*goal[:2], below]), (0.0, 0.0, 0.0, 0.0))]
        if end == "stay":
            return [self.item(LOITER, frame, goal, (0.0, 0.0, 0.0, 0.0))]
        return [*(self.item(WAYPOINT, frame, above, (STOP, 1.0, 0.0, 0.0)) for above in climb), Item(RETURN)]


def heading(start: np.ndarray, end: np.ndarray) -> float:
    """From north, clockwise [degrees]; north for a vertical leg."""
    east, north = (end - start)[:2]
    return float(np.degrees(np.arctan2(east, north)) % 360.0) if np.hypot(east, north) > 1e-9 else 0.0


def checked_way(route: Route | Way, city: City) -> Route:
    """A route that arrives, without legs of no length."""
    checks.instance("city", city, City)
    way = as_route(route)
    if not way.reached or not way.length > 0:
        raise ValueError(f"route must lead from a start to a goal{': ' * bool(way.reason)}{way.reason}")
    return way


def kept_clearance(way: Route, uav: UAV, min_clearance: float | None) -> float:
    """What legs keep to obstacles [m]."""
    asked = way.min_clearance if min_clearance is None else checks.not_negative_number("min_clearance", min_clearance)
    return max(asked, uav.diameter / 2)


def check_ceiling(way: Route, city: City, ceiling: float) -> None:
    """Refuse a way that is below the ground somewhere, or too high above it."""
    points = way.points if city.ground is None else way.resample(city.cell / 2).points
    above = city.height_above_ground(points)
    if above.min() < 0:
        lowest = checks.show(points[above.argmin()])
        raise ValueError(f"route is {-above.min():.1f} m below the ground at {lowest}: plan it above")
    if above.max() > ceiling + 1e-6:
        highest = checks.show(points[above.argmax()])
        raise ValueError(
            f"route is {above.max():.1f} m above the ground at {highest}, and the ceiling is {ceiling:g} m: plan it "
            f"with max_height={ceiling:g}, or ask for another ceiling, if it is lawful there"
        )


def located(
    city: City, home: Place | Sequence[float] | None, start: np.ndarray, altitudes: str
) -> tuple[Site, list[str]]:
    """Where home is, on the map and on the Earth, and what was assumed for that."""
    if home is None and city.reference is None:
        raise ValueError(
            f"city {city.name!r} doesn't know where on Earth it lies, and an autopilot must: give home=(longitude, "
            "latitude[, height above sea]), the place on Earth of what lies below the route's start"
        )
    known = UNKNOWN if city.source is None else city.source.heights
    below = np.array([*start[:2], floor_below(city, start)[0]])
    site = Site(city, city.checked_reference(), below, known) if home is None else given_site(city, home, start, known)
    if altitudes == "sea" and site.heights != ABOVE_SEA:
        kind = {ELLIPSOIDAL: "ellipsoidal, up to 100 m off the sea", UNKNOWN: "of an unknown system"}[site.heights]
        raise ValueError(
            f"altitudes='sea' needs heights above the sea, and those of {city.name!r} are {kind}: give "
            "home=(longitude, latitude, height above sea), or altitudes='home'"
        )
    unknown = site.heights != ABOVE_SEA
    return site, ["the height of home above the sea isn't known"] * unknown


def given_site(city: City, home: Place | Sequence[float], start: np.ndarray, known: str) -> Site:
    """Home where the caller says it is, on what lies there below the height of the start."""
    given = place_of("home", home)
    with_height = isinstance(home, Place) or len(home) == 3
    heights = ABOVE_SEA if with_height else known
    if city.reference is None:
        below = np.array([*start[:2], floor_below(city, start)[0]])
        height = given.height - below[2] if with_height else 0.0
        return Site(city, place_of_origin(given._replace(height=height), below[:2]), below, heights)
    at = city.reference.east_north((given.longitude, given.latitude))
    apart = float(np.hypot(*(at - start[:2])))
    if apart > FARTHEST_HOME:
        raise ValueError(
            f"home is {apart / 1000:.3g} km from the start of the route, at most {FARTHEST_HOME / 1000:g} km make "
            "sense: the order is (longitude, latitude[, height above sea])"
        )
    if not city.inside((*at, start[2])):
        raise ValueError(
            f"home lies outside of the map, at ({at[0]:.1f}, {at[1]:.1f}) m, where nothing is known of obstacles: read "
            "the city with a larger margin, or take off on the map"
        )
    at = np.array([*at, floor_below(city, np.array([*at, start[2]]))[0]])
    place = city.reference
    return Site(city, place._replace(height=given.height - at[2]) if with_height else place, at, heights)


def place_of_origin(where: Place, xy: np.ndarray) -> Place:
    """The place of x = y = 0 of a map, as high, on which a place has the coordinates (2,) [m]."""
    origin = where
    for _ in range(6):  # the axes turn a little when their origin moves
        off = xy - origin.east_north((where.longitude, where.latitude))
        longitude, latitude = origin.longitude_latitude(-off)
        origin = Place(float(longitude), float(latitude), where.height)
    return origin


def waypoints(legs: Corridor, way: Route, uav: UAV, speed: npt.ArrayLike | None) -> tuple[np.ndarray, np.ndarray]:
    """Few points (M, 3) between take-off and landing; and on each leg (M − 1,) the least speed it replaces [m/s]."""
    asked = checks.numbers("speed", uav.cruise_speed if speed is None else speed)
    count = len(way.points) - 1
    if asked.shape not in ((), (count,)):
        raise ValueError(f"speed must be one number, or one for each of the {count} legs, got shape {asked.shape}")
    checks.positive("speed", asked)
    if asked.max() > uav.top_speed:
        raise ValueError(f"speed must be at most the UAV's top speed of {uav.top_speed:g} m/s, got {asked.max():g}")
    first, last = way.takeoff, max(count - way.landing, 0)
    moving = np.flatnonzero(way.leg_lengths[first:last] > 0)  # legs of no length have no direction
    if len(moving) == 0:
        raise ValueError("route must have a way between take-off and landing, and has none")
    points = way.points[first : last + 1][np.append(moving, moving[-1] + 1)]
    speeds = np.broadcast_to(asked, count)[first:last][moving]
    chosen = legs.thinned(points)
    return points[chosen], np.minimum.reduceat(speeds, chosen[:-1])


def from_home(legs: Corridor, site: Site, points: np.ndarray, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same, with a first leg from above home where that isn't below the start."""
    if np.hypot(*(site.at - points[0])[:2]) <= 0.01:
        return points, speeds
    above = np.array([*site.at[:2], points[0, 2]])
    if not legs.clear(above, points[0]):
        raise ValueError(
            f"home at {checks.show(site.at)} has no clear way to the start of the route {checks.show(points[0])}: take "
            "off below that, or plan from above home"
        )
    return np.vstack([above, points]), np.append(speeds[:1], speeds)


def ground_at_ends(city: City, uav: UAV, points: np.ndarray, end: str) -> float:
    """Height of what it lands on [m]; take-off and landing are refused where a wall is in the way."""
    check_column(city, "home", points[0], uav.diameter)
    return check_column(city, "the goal", points[-1], uav.diameter) if end == "land" else float(points[-1, 2])


def height_to_return(site: Site, points: np.ndarray, keep: float) -> float:
    """Height above home at which the straight way home is clear of what stands anywhere between it and the way [m]."""
    city = site.city
    hull = shapely.MultiPoint(np.vstack([site.at, points])[:, :2]).convex_hull.buffer(keep + city.cell)
    x, y = np.meshgrid(city.coordinates(0), city.coordinates(1), indexing="ij")
    columns = shapely.contains_xy(hull, x.ravel(), y.ravel()).reshape(x.shape)
    solid = (city.occupied & columns[..., None]).any(axis=(0, 1))
    top = city.origin[2] + city.cell * (np.flatnonzero(solid)[-1] + 1) + keep if solid.any() else -np.inf
    return float(max(top, points[:, 2].max()) - site.at[2])


def climb_to_return(legs: Corridor, site: Site, points: np.ndarray, return_height: float, uav: UAV) -> np.ndarray:
    """Where it rises to above the last of the points (N, 3), (1, 3) [m]; (0, 3) where it is high enough."""
    check_return(legs, site, points, return_height, uav)
    goal, top = points[-1], site.at[2] + return_height
    return np.array([[*goal[:2], top]]) if top > goal[2] else np.empty((0, 3))


def check_return(legs: Corridor, site: Site, points: np.ndarray, return_height: float, uav: UAV) -> None:
    """Refuse to fly home from the last of the points (N, 3) where that is closed, too high, or something hangs over."""
    city, goal, start = site.city, points[-1], points[0]
    top = max(goal[2], site.at[2] + return_height)
    way = np.array([goal, [*goal[:2], top], [*start[:2], top], start])
    cure = "end='land' or 'stay'"
    body = contact_distance(uav.diameter)
    for where, high, keep in ((goal, way[1], legs.bounds.keep * city.cell), (start, way[2], body)):
        apart = float(city.segment_distance(where, high))
        if apart < keep:
            raise ValueError(
                f"end='return' needs a clear way up to {top - where[2]:.1f} m above {checks.show(where)}, from where "
                f"the straight way home is clear, and an obstacle is {apart:.2f} m from it: use {cure}"
            )
    above = extremes(above_ground(city, way[1], way[2])[1]).max()
    if above > legs.ceiling + 1e-6:
        raise ValueError(
            f"end='return' flies up to {above:.1f} m above the ground, over all that stands between the way and home, "
            f"and the ceiling is {legs.ceiling:g} m: use {cure}, or ask for another ceiling, if it is lawful there"
        )
    zone = zone_on_way(city, way)
    if zone:
        raise ValueError(f"end='return' flies straight home through no-fly zone {zone!r}: use {cure}")


def rally_points(site: Site, points: Sequence[npt.ArrayLike]) -> list[tuple[np.ndarray, Place]]:
    """Points to land at in trouble, see `rally_point`."""
    return [rally_point(site, f"rally[{n}]", each) for n, each in enumerate(checks.listed("rally", points, "points"))]


def rally_point(site: Site, name: str, point: npt.ArrayLike) -> tuple[np.ndarray, Place]:
    """A point to land at in trouble, on the map and on the Earth, its height above home."""
    where = checks.array(name, point, 3)
    if not site.city.is_free(where):
        raise ValueError(
            f"{name} {checks.show(where)} lies in {site.city.building_at(where)}, or off the map: choose another"
        )
    if site.city.zone_at(where):
        zone = site.city.zone_at(where)
        raise ValueError(f"{name} {checks.show(where)} lies in no-fly zone {zone!r}: choose another")
    there = site.geographic(where)
    return where, there._replace(height=float(where[2] - site.at[2]))
