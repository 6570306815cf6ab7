"""Before a mission is flown: a checklist as a function, each check with what was found and what was asked for.

Where a mission goes is checked all along its legs and corners, not at sampled points; what the weather does to it is
tried in flights, up to the return and the landing. A check says in words where it is worst and what to do about it.
"""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

import numpy as np
import shapely

from uavlab import checks
from uavlab.city import City
from uavlab.flight.autopilot import GPS, Gps
from uavlab.flight.simulation import MOST_FLIGHTS
from uavlab.mission.corridor import above_ground, extremes, floor_below, room_in_column, zone_on_way
from uavlab.mission.fences import polygon_on
from uavlab.mission.making import Site, height_to_return
from uavlab.mission.model import CEILING, Mission
from uavlab.mission.way import (
    ROUNDED,
    MissionWay,
    Trial,
    drift_after,
    least_room,
    most_take,
    planned_time,
    ready,
    room_inside,
    speeds_of,
    tried_out,
    way_of,
)
from uavlab.spline.curve import contact_distance
from uavlab.spline.limits import OUTSIDE
from uavlab.statistics import share_interval
from uavlab.vehicle import UAV, WATT_HOUR
from uavlab.weather import Weather, Wind, lift_margin, rain_force, wind_limit
from uavlab.weather.envelope import CREEP, steady_air_speed
from uavlab.weather.forces import SAFETY_FACTOR
from uavlab.weather.wind import gust_deviations, strongest_gust, why_grounded, wind_of

SIGMAS = 3.0
"""Of GPS, that a way keeps to its fence."""

DENSE = 1.0
"""What lies outside of a fence is looked at as often as this [m]."""

HEADS = ("check", "found", "asked for", "met", "in words")


@dataclass(frozen=True)
class Check:
    """One line of the checklist.

    Attributes
    ----------
    name : str
    value, limit : float
        What was found, nearest to the limit or farthest beyond it, and the limit, in the unit. −∞ or ∞ where there is
        nothing to measure: no fence, no obstacle, a battery that isn't known.
    unit : str
    at_least : bool
        Whether the limit is a lower one.
    words : str
        Where and why, and the cure.

    See Also
    --------
    preflight : Makes them.

    Examples
    --------
    >>> from uavlab.mission import Check
    >>> check = Check("clearance", 2.3, 2.5, "m", True, "nearest on the way to item 5")
    >>> check
    <Check clearance: 2.3 m, at least 2.5, NOT met>
    >>> check.met
    False
    """

    name: str
    value: float
    limit: float
    unit: str
    at_least: bool
    words: str

    @property
    def met(self) -> bool:
        """Whether the limit is kept, to rounding; never by what is no number."""
        slack = 1e-9 * abs(self.limit) if np.isfinite(self.limit) else 0.0
        return self.value >= self.limit - slack if self.at_least else self.value <= self.limit + slack

    def __repr__(self) -> str:
        bound = f"at {'least' if self.at_least else 'most'} {shown(self.limit)}"
        found = shown(self.value, self.unit)
        return f"<Check {self.name}: {found}, {bound}, {'met' if self.met else 'NOT met'}>"


@dataclass(frozen=True, repr=False)
class Preflight:
    """What `preflight` found.

    Attributes
    ----------
    checks : tuple of Check
    mission : Mission
        That was checked.

    Raises
    ------
    ValueError
        If `checks` is no list of at least one `Check`, or `mission` is no Mission.

    See Also
    --------
    preflight : Makes it, with an example of the table.
    uavlab.mavlink.upload : Takes it as `checked`.

    Examples
    --------
    >>> from uavlab.city import Place
    >>> from uavlab.mission import Check, Item, Mission, Preflight
    >>> mission = Mission((Item(16, 3, (0, 2, 0, 0), 47.25, 8.5, 130.0),), Place(8.5, 47.25, 420.0))
    >>> found = Preflight((Check("greatest height", 130.0, 120.0, "m", False, "on the way to item 0"),), mission)
    >>> print(found)
    Preflight of mission: NOT passed, greatest height
    check            found  asked for  met  in words
    greatest height  130 m  <= 120 m   NO   on the way to item 0
    >>> found.passed, found["greatest height"].met
    (False, False)
    """

    checks: tuple[Check, ...]
    mission: Mission

    def __post_init__(self) -> None:
        object.__setattr__(self, "checks", tuple(checks.several("checks", self.checks, Check)))
        checks.instance("mission", self.mission, Mission)

    @property
    def passed(self) -> bool:
        """Whether all checks are met."""
        return not self.failed

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that are not met."""
        return tuple(check for check in self.checks if not check.met)

    def __getitem__(self, name: str) -> Check:
        """The check with a name."""
        named = {check.name: check for check in self.checks}
        return named[checks.one_of("name", name, named)]

    def rows(self) -> list[tuple[str, ...]]:
        """Rows of its table, text only."""
        return [
            (
                check.name,
                "none" if check.at_least and np.isinf(check.value) else shown(check.value, check.unit),
                f"{'>=' if check.at_least else '<='} {shown(check.limit, check.unit)}",
                "yes" if check.met else "NO",
                check.words,
            )
            for check in self.checks
        ]

    @property
    def verdict(self) -> str:
        failed = f"NOT passed, {', '.join(check.name for check in self.failed)}"
        return f"Preflight of {self.mission.name}: {'passed' if self.passed else failed}"

    def __str__(self) -> str:
        table = [HEADS, *self.rows()]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in table]
        return "\n".join([self.verdict, *lines])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        signs = str.maketrans({">": "≥", "<": "≤", "=": ""})  # which not every terminal can print
        left = ' style="text-align:left"'  # numbers with units and words: read from the left
        heads = "".join(f"<th{left}>{head}</th>" for head in HEADS)
        cells = [map(html.escape, (*row[:2], row[2].translate(signs), *row[3:])) for row in self.rows()]
        rows = "".join("<tr>" + "".join(f"<td{left}>{cell}</td>" for cell in row) + "</tr>" for row in cells)
        return f"<table><caption>{html.escape(self.verdict)}</caption><tr>{heads}</tr>{rows}</table>"


def shown(value: float, unit: str = "") -> str:
    """A number for the table."""
    return "none" if value == -np.inf else f"{value:.4g} {unit}".rstrip()


def preflight(
    mission: Mission,
    city: City,
    uav: UAV,
    weather: Weather | Wind,
    *,
    ceiling: float = CEILING,
    min_clearance: float | None = None,
    fence_margin: float | None = None,
    flights: int = 200,
    rng: np.random.Generator | int = 0,
    gps: Gps = GPS,
) -> Preflight:
    """Check a mission before it is flown: its way, its fence, its heights and speeds, the wind, and the battery.

    Legs and corners are checked all along: of each corner that the autopilot rounds, all that it may cut off. Where
    altitudes are above terrain, legs follow the ground of the city.

    Flights go from take-off to landing, those of `uavlab.flight.monte_carlo`, with a speed for each leg. On the ground
    they would have crashed before they began, so they begin above it, by the UAV's diameter or a voxel, and what it
    takes to rise so far is added, P·h/v with the power P of `uavlab.power`. Whoever touches ground or roof so low on
    its last leg has landed, and what is left below it is added likewise; so is hovering where the mission says hold.
    Corners are flown as drawn, slowly, which takes a little more than to round them.

    Parameters
    ----------
    mission : Mission
    city : City
        The map that it is flown on.
    uav : UAV
        With its payload.
    weather : Weather or Wind
    ceiling : float
        Greatest height above ground [m], above 0; 120 m in the open category of the European Union.
    min_clearance : float, optional
        Least distance to obstacles [m]; by default, and at least, half the UAV's diameter. As degrees are rounded, it
        may be 1 cm less.
    fence_margin : float, optional
        Least distance of the way to the fence [m], at least 0; by default 3σ of what GPS drifts in the time of flight:
        the autopilot watches the fence by GPS, whose error it doesn't see.
    flights : int
        That are simulated, 1 to a million; from 59 on there is an upper bound for the energy, 200 are usual.
    rng : numpy.random.Generator or int
        Same seed, same result.
    gps : Gps
        What the autopilot knows of where it is.

    Returns
    -------
    Preflight
        "home" and "landing": room on the way up and down to what is higher than the ground or roof there [m]. "map":
        how far inside of it [m]. "clearance" to obstacles and "no-fly zones": distance [m]. "least height" and
        "greatest height" above ground, that of the return with it [m]. "return height" above home at which the straight
        way home is clear [m]. "fence": how far inside of it [m]. "speed" that is asked for, "ground speed" of the
        slowest leg as it is flown, in climb, descent and mean wind [m/s]. "lift", "mean wind" and "gusts" with the
        limits of `uavlab.weather.grounded_by` [N, m/s]. "energy" that 19 of 20 flights don't exceed [Wh], an upper
        bound that holds with a confidence of 95 %, whatever their distribution: of the n flights that arrived the r-th,
        with the least r for which at most r − 1 of n are below the quantile with a probability of 95 %. "flights" that
        crashed or gave up.

    Raises
    ------
    ValueError
        If `mission`, `city`, `uav`, `weather` or `gps` is of another kind; `ceiling` is not above 0; `min_clearance` or
        `fence_margin` is negative; `flights` is no whole number from 1 to a million; or `rng` is neither generator nor
        seed. If `mission` lands or returns before it has flown anywhere, has an item at a place that can't be judged,
        or lies over 50 km off the map; or `city` has no place on Earth and the mission was read from a file.

    See Also
    --------
    Mission.from_route : Makes a mission.
    uavlab.mavlink.upload : Takes the result as `checked`.
    uavlab.flight.monte_carlo : The flights.

    References
    ----------
    Commission Implementing Regulation (EU) 2019/947, UAS.OPEN.010: 120 m above ground.

    H. A. David and H. N. Nagaraja, Order Statistics, 2003, 7.1: confidence intervals for quantiles.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> from uavlab.mission import Mission, preflight
    >>> from uavlab.route import Route
    >>> from uavlab.vehicle import LIGHT_QUADROTOR
    >>> from uavlab.weather import Weather
    >>> city, route = table1_city(cell=5.0), Route([(5, 5, 30), (40, 5, 30), (40, 50, 30)])
    >>> mission = Mission.from_route(route, city, LIGHT_QUADROTOR, home=(4.36, 52.01))
    >>> found = preflight(mission, city, LIGHT_QUADROTOR, Weather(forecast_wind=3.0), flights=59)
    >>> found["clearance"]
    <Check clearance: 4.997 m, at least 0.49, met>
    """
    checks.instance("mission", mission, Mission)
    checks.instance("city", city, City)
    checks.instance("uav", uav, UAV)
    checks.instance("gps", gps, Gps)
    wind = wind_of(weather, "weather")
    ceiling = checks.positive_number("ceiling", ceiling)
    asked = uav.diameter / 2 if min_clearance is None else checks.not_negative_number("min_clearance", min_clearance)
    keep = max(asked, uav.diameter / 2) - ROUNDED
    if fence_margin is not None:
        fence_margin = checks.not_negative_number("fence_margin", fence_margin)
    flights = checks.whole("flights", flights, 1, MOST_FLIGHTS)
    generator = checks.generator("rng", rng)
    way = way_of(mission, city)
    setup, on_map = ready(way, uav, wind, gps), check_map(way)
    kept_down = "; ".join(why_grounded(uav, wind, setup.altitude)) or on_map.words * (not on_map.met)
    trials = [] if kept_down else tried_out(setup, way, generator.spawn(flights))
    return Preflight(
        (
            check_home(way, uav),
            *check_landing(way, uav),
            on_map,
            check_clearance(way, uav, keep),
            check_zones(way),
            *check_heights(way, uav, ceiling),
            check_return(way, keep),
            check_fence(way, fence_margin, planned_time(way, uav, wind), gps),
            check_speed(way, uav),
            check_ground_speed(way, uav, wind),
            *check_wind(uav, wind, setup.altitude),
            check_energy(uav, trials, kept_down),
            check_arrival(trials, flights, kept_down),
        ),
        mission,
    )


def check_home(way: MissionWay, uav: UAV) -> Check:
    """Whether home is where something stands, and it can rise."""
    home, begin = way.stops[0].point, way.begin
    off = float(home[2] - floor_below(way.city, begin)[0])
    room, beside = room_in_column(way.city, begin, uav.diameter)
    words = f"{beside} on the way up to {begin[2] - home[2]:.1f} m"
    if room_inside(way.city, home[None, :2]) < -ROUNDED:
        room, words = -np.inf, "home is off the map: take off on it, or read the city with a larger margin"
    elif not way.takes_off:
        room, words = -np.inf, "the mission doesn't begin with a take-off: give it one"
    elif abs(off) > max(uav.diameter, way.city.cell):
        side = "above" if off > 0 else "below"
        room, words = -np.inf, f"home is {abs(off):.1f} m {side} what it would stand on, and with it all altitudes"
    return Check("home", room, contact_distance(uav.diameter), "m", True, words)


def check_landing(way: MissionWay, uav: UAV) -> list[Check]:
    """Whether it can sink to where it lands; nothing of a mission that stays in the air."""
    room, beside = room_in_column(way.city, way.end, uav.diameter)
    words = f"{beside} on the way down from {checks.show(way.end)}"
    return [Check("landing", room, contact_distance(uav.diameter), "m", True, words)] * way.lands


def check_map(way: MissionWay) -> Check:
    """Whether all of the way is on the map."""
    flown = np.array([way.begin, *(leg.end for leg in way.legs)])
    room = min(room_inside(way.city, flown), room_inside(way.city, way.stops[0].point[None, :2]))
    words = "inside of its border"
    if room < -ROUNDED:
        words = "the way leaves the map, and nothing is known beyond: read the city with a larger margin"
    return Check("map", room, -ROUNDED, "m", True, words)


def check_clearance(way: MissionWay, uav: UAV, keep: float) -> Check:
    """Distance to obstacles between take-off and landing."""
    room, leg = least_room(way.city, [*way.legs, *way.corners])
    rounds = any(leg is other for other in way.corners)
    cut = f", less {leg.aside:.2f} m that a corner may be cut by" if rounds else ""
    half = ", half of the UAV" * (keep + ROUNDED == uav.diameter / 2)
    words = f"{leg.named}{cut}; asked for are {keep + ROUNDED:.4g} m{half}, less 1 cm for rounded degrees"
    return Check("clearance", room, keep, "m", True, words)


def check_zones(way: MissionWay) -> Check:
    """Distance to no-fly zones, with take-off and landing."""
    city = way.city
    if not city.in_no_fly.any():
        return Check("no-fly zones", np.inf, OUTSIDE, "m", True, "there are none on the map")
    highest = np.array([np.inf, np.inf, city.bounds[1, 2] - city.cell / 2])  # a zone goes on above the map
    legs = [
        leg._replace(start=np.minimum(leg.start, highest), end=np.minimum(leg.end, highest))
        for leg in (*way.columns, *way.legs, *way.corners)
    ]
    room, leg = least_room(City(city.in_no_fly, city.cell, city.origin), legs)
    name = zone_on_way(city, np.array([leg.start, leg.end])) or "one"
    words = f"enters {name} {leg.named}: fly around it" if room < OUTSIDE else f"nearest {leg.named}"
    return Check("no-fly zones", room, OUTSIDE, "m", True, words)


def check_heights(way: MissionWay, uav: UAV, ceiling: float) -> list[Check]:
    """Least and greatest height above ground, the latter also of a return."""
    heights = [(above_ground(way.city, leg.start, leg.end)[1], leg) for leg in way.legs]
    spans = [(above[[0, 2]] if leg.stop.follows else extremes(above), leg) for above, leg in heights]
    least, lowest = min(((float(above.min()), leg) for above, leg in spans), key=lambda one: one[0])
    most, highest = max(((float(above.max()), leg) for above, leg in spans), key=lambda one: one[0])
    back = float(way.stops[0].point[2]) + way.mission.return_height - lowest_ground(way)
    words = f"above ground; {most:.1f} m {highest.named}, {back:.1f} m if it returns"
    top = round(max(most, back), 2)
    if top > ceiling:
        words += ": fly lower, or where no tall building forces the return up"
    return [
        Check("least height", round(least, 2), uav.diameter / 2, "m", True, f"above ground, {lowest.named}"),
        Check("greatest height", top, ceiling, "m", False, words),
    ]


def lowest_ground(way: MissionWay) -> float:
    """Height of the lowest ground between home and the way [m], which a return may pass over."""
    city, home = way.city, way.stops[0].point
    lowest = city.range_of_ground[0]
    if city.ground is None:
        return float(lowest.min())
    places = [stop.point for stop in way.stops]
    area = shapely.union_all([shapely.MultiPoint([home, *leg]).convex_hull for leg in pairwise(places)])
    west, south = (city.origin[axis] + city.cell * np.arange(city.shape[axis]) for axis in (0, 1))
    columns = shapely.box(west[:, None], south, west[:, None] + city.cell, south + city.cell)
    shapely.prepare(area)
    below = lowest[shapely.intersects(area, columns)]
    return float(below.min() if len(below) else lowest.min())


def check_return(way: MissionWay, keep: float) -> Check:
    """Whether the straight way home is clear at the height at which it returns."""
    mission = way.mission
    site = Site(way.city, mission.place_on(way.city), way.stops[0].point, mission.heights)
    needed = height_to_return(site, np.array([stop.point for stop in way.stops]), keep)
    words = "above home; over all that stands between home and the way"
    if mission.return_height < needed - ROUNDED:
        known = "isn't known" if mission.return_height == 0 else "is too low"
        words = f"it {known}: dataclasses.replace(mission, return_height={np.ceil(needed):.0f}) is above all between"
    return Check("return height", mission.return_height, needed - ROUNDED, "m", True, words)


def check_fence(way: MissionWay, margin: float | None, seconds: float, gps: Gps) -> Check:
    """Distance to the fence, on its right side."""
    least = SIGMAS * drift_after(seconds, gps) if margin is None else margin
    if not way.mission.fence:
        return Check("fence", -np.inf, least, "m", True, "the mission has none: Mission.from_route makes one")
    plan = np.array([stop.point[:2] for stop in way.stops])
    parts = [shapely.LineString(plan) if np.ptp(plan, axis=0).any() else shapely.Point(plan[0])]
    for _, corner in groupby(way.corners, key=lambda leg: leg.stop.number):
        ends = [end[:2] for leg in corner for end in (leg.start, leg.end)]
        parts.append(shapely.MultiPoint(ends).convex_hull)
    place = way.mission.place_on(way.city)
    areas = [(polygon_on(place, polygon), polygon) for polygon in way.mission.fence]
    room, name = min((inside_by(part, area, of.inclusion), of.name) for area, of in areas for part in parts)
    why = f"; {SIGMAS:g}σ of GPS after {seconds:.0f} s, an error that the autopilot doesn't see" * (margin is None)
    return Check("fence", room, least, "m", True, f"to {name}{why}")


def inside_by(part: shapely.Geometry, area: shapely.Polygon, inclusion: bool) -> float:
    """How far a part of the way is on the right side of a polygon [m]; negative on the wrong one, or if it has none."""
    if not area.is_valid:
        return -np.inf
    beyond = part.difference(area) if inclusion else part.intersection(area)
    if beyond.is_empty:
        return float(part.distance(area.boundary))
    points = shapely.points(shapely.get_coordinates(shapely.segmentize(beyond, DENSE)))
    return -float(area.boundary.distance(points).max())


def check_speed(way: MissionWay, uav: UAV) -> Check:
    """The greatest speed that is asked for."""
    fastest = max(way.legs, key=lambda leg: leg.stop.speed)
    return Check("speed", fastest.stop.speed, uav.top_speed, "m/s", False, f"asked for {fastest.named}")


def check_ground_speed(way: MissionWay, uav: UAV, wind: Wind) -> Check:
    """The slowest leg as it is flown: where the UAV can't keep up, the autopilot slows down."""
    asked, held = speeds_of(way.legs, uav, wind)
    flown = np.minimum(asked, held)
    at = int((flown / asked).argmin())
    leg, words = way.legs[at], "all legs are as fast as asked for"
    if flown[at] < asked[at]:
        up = float((leg.end - leg.start)[2] / np.linalg.norm(leg.end - leg.start))
        most, verb = (uav.climb_speed, "climbs") if up > 0 else (uav.sink_speed, "sinks")
        steep = flown[at] * abs(up) >= most * (1 - 1e-9)
        why = f"it {verb} at {most:g} m/s at most" if steep else "wind and thrust leave no more"
        words = f"slowed down {leg.named}, to {flown[at]:.3g} of {asked[at]:.3g} m/s, as {why}"
    return Check("ground speed", float(flown.min()), CREEP, "m/s", True, words)


def check_wind(uav: UAV, wind: Wind, altitude: float) -> list[Check]:
    """Lift, mean wind and gusts, as `grounded_by` asks for them."""
    rain = float(rain_force(wind.rain_mm_per_h, uav.rain_area))
    gust = strongest_gust(wind.speed, float(gust_deviations(wind, altitude)[0]))
    reach = steady_air_speed(uav, rain, wind.air_density)
    held = float(wind_limit(uav, rain, air_density=wind.air_density))
    return [
        Check(
            "lift", float(lift_margin(uav, rain)), 0.0, "N", True, f"left above {SAFETY_FACTOR:g} times weight and rain"
        ),
        Check("mean wind", wind.speed, reach - CREEP, "m/s", False, "the limit is what it reaches through the air"),
        Check("gusts", gust, held, "m/s", False, "the strongest, 3σ above the mean; the limit is what it holds"),
    ]


def check_energy(uav: UAV, trials: Sequence[Trial], kept_down: str) -> Check:
    """What the flights that arrived take from the battery."""
    usable = uav.usable_energy / WATT_HOUR
    arrived = [trial for trial in trials if not trial.failed]
    if not arrived:
        why = f"not flown: {kept_down}" if kept_down else "no flight arrived"
        return Check("energy", np.inf, usable, "Wh", False, why)
    seconds, _ = most_take([trial.seconds for trial in arrived])
    energy, how = most_take([trial.energy / WATT_HOUR for trial in arrived])
    known = "; what the battery holds isn't known" if np.isinf(usable) else ""
    return Check("energy", energy, usable, "Wh", False, f"in {seconds:.0f} s; {how}{known}")


def check_arrival(trials: Sequence[Trial], flights: int, kept_down: str) -> Check:
    """How many flights crash or give up."""
    if kept_down:
        return Check("flights", flights, 0, f"of {flights}", False, f"not flown: {kept_down}")
    failed = [trial.failed for trial in trials if trial.failed]
    share = 100 * share_interval(len(failed), flights)[1]
    words = f"crashed or gave up; of all such flights at most {share:.3g} % do (95 % interval of Clopper and Pearson)"
    words += f"; one {failed[0]}" if failed else ""
    return Check("flights", len(failed), 0, f"of {flights}", False, words)
