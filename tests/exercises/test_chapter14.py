"""Exercises of chapter 14: other ways to the answer pass; typical mistakes fail, each with a hint of its own."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import binom

from uavlab.city import Place
from uavlab.exercises import check
from uavlab.mission import FencePolygon, Item, Mission, read_plan
from uavlab.planners import astar, shortcut, theta_star
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route


@pytest.mark.parametrize("number", ["14.1", "14.2", "14.3", "14.4", "14.5", "14.6"])
def test_a_blank_answer_is_no_answer(number, blank):
    assert "still raises NotImplementedError" in check(number, blank).hint
    assert "return" in check(number, lambda *_: None).hint


@pytest.mark.parametrize(
    ("number", "answer", "hint"),
    [
        ("14.1", lambda *_: ("a", "b"), "returns a tuple of 2. The answer is two numbers"),
        ("14.1", lambda *_: "north", "returns text, 'north'"),
        ("14.1", lambda *_: 0.011, "returns one number, 0.011. The answer is two numbers"),
        ("14.1", lambda *_: [0.011] * 3, "returns a list of 3"),
        ("14.2", lambda *_: "40 m", "For ('home', 65.0, 12.0, 430.0, 31.0) your function returns text"),
        ("14.2", lambda *_: (1.0, 2.0), "returns a tuple of 2. The answer is one number: the altitude"),
        (
            "14.2",
            lambda frame, *_: 1.0 if frame == "home" else None,
            "For ('sea', 65.0, 12.0, 430.0, 31.0) your function returns nothing",
        ),
        ("14.3", lambda before, *_: before, "returns an array of shape (3,). The answer is one number: the margin"),
        ("14.3", lambda *_: 1 + 2j, "returns a complex"),
        ("14.4", lambda *_: [[0.5], [0.5, 0.5]], "returns a list of 2"),
        ("14.4", lambda items, *_: np.full(items, 0.5), "an array of shape (20,)"),
        ("14.5", lambda *_: "for ever", "returns text, 'for ever'. The answer is one number: the time"),
        ("14.5", lambda *_: np.zeros(2), "an array of shape (2,)"),
        ("14.6", lambda *_: Route([(0, 0, 1), (5, 5, 5)]), "returns a Route, not a Mission"),
        ("14.6", lambda *_: "flight.plan", "returns a str, not a Mission"),
    ],
)
def test_answers_of_the_wrong_type_or_shape(number, answer, hint):
    verdict = check(number, answer)
    assert not verdict
    assert hint in verdict.hint


@pytest.mark.parametrize("number", ["14.1", "14.2", "14.3", "14.4", "14.5", "14.6"])
def test_an_answer_that_fails_is_told_so(number):
    assert "raises KeyError: 'radius'" in check(number, lambda *_: {}["radius"]).hint
    assert "without brackets" in check(number, 1.0).hint


def digit(latitude, *, mistake=""):
    """By circles and how many steps they have, and broken in several ways."""
    radius = 6_371_000.0 * {"diameter": 2.0, "half": 0.5, "km": 1e-3}.get(mistake, 1.0)
    steps = {"degree": 360, "times": 360e-7, "radians": 2e7 * math.pi}.get(mistake, 360e7)
    across = {"degrees": latitude, "sine": math.pi / 2 - math.radians(latitude)}.get(mistake, math.radians(latitude))
    north, east = 2 * math.pi * radius / steps, 2 * math.pi * radius * math.cos(across) / steps
    return {"no cosine": (north, north), "swapped": (east, north), "both": (east, east)}.get(mistake, (north, east))


def test_a_step_by_circles_is_right():
    assert check("14.1", digit)
    assert check("14.1", lambda latitude: np.array(digit(latitude)))


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("no cosine", "as long everywhere"),
        ("swapped", "wrong way round"),
        ("both", "all meridians are equally long"),
        ("degrees", "takes an angle in radians"),
        ("sine", "is 0 at the equator"),
        ("diameter", "twice too long"),
        ("half", "half of what they should be"),
        ("radians", "1e-7 radians"),
        ("times", "multiply by 10 000 000"),
        ("degree", "a whole degree"),
        ("km", "in kilometres"),
    ],
)
def test_mistakes_with_a_step(mistake, hint):
    verdict = check("14.1", lambda latitude: digit(latitude, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


def test_another_answer_for_a_step():
    hint = check("14.1", lambda latitude: (0.01, 0.02)).hint
    assert "At 47.25° your step is 0.01 m to the north and 0.02 m to the east" in hint


ZEROS = {
    "home": lambda home_z, home_above_sea, ground_z: home_z,
    "sea": lambda home_z, home_above_sea, ground_z: home_z - home_above_sea,
    "terrain": lambda home_z, home_above_sea, ground_z: ground_z,
}


def from_zero(frame, z, *heights):
    """By where on the map the zero of each frame is."""
    return z - ZEROS[frame](*heights)


def test_an_altitude_from_the_zero_of_its_frame_is_right():
    assert check("14.2", from_zero)


@pytest.mark.parametrize(
    ("frame", "wrong", "hint"),
    [
        ("home", lambda z, h, s, g: z, "'home': that is the height on the map"),
        ("home", lambda z, h, s, g: z + h, "you add home's height"),
        ("home", lambda z, h, s, g: h - z, "points above home have altitudes below 0"),
        ("home", lambda z, h, s, g: z - g, "from the ground below the point, not from home"),
        ("home", lambda z, h, s, g: z - h + s, "'home': that is the altitude above the sea"),
        ("sea", lambda z, h, s, g: z + s, "put the point at home"),
        ("sea", lambda z, h, s, g: z + h + s, "you add the heights of home and of the point"),
        ("sea", lambda z, h, s, g: z - h - s, "the sea lies below home"),
        ("sea", lambda z, h, s, g: z - s, "aren't those above the sea"),
        ("sea", lambda z, h, s, g: s + h - z, "your altitude falls"),
        ("sea", lambda z, h, s, g: z - h, "'sea': that is the altitude above home"),
        ("sea", lambda z, h, s, g: z - g + s, "you go by the ground below the point"),
        ("sea", lambda z, h, s, g: z, "'sea': that is the height on the map"),
        ("terrain", lambda z, h, s, g: z - h, "'terrain': that is above home"),
        ("terrain", lambda z, h, s, g: z - h - g, "the point is above home here"),
        ("terrain", lambda z, h, s, g: z - h + s - g, "the point is above the sea here"),
        ("terrain", lambda z, h, s, g: z + g, "more room below it, not less"),
        ("terrain", lambda z, h, s, g: g - z, "points above the ground have altitudes below 0"),
        ("terrain", lambda z, h, s, g: z, "'terrain': that is the height on the map"),
        ("home", lambda z, h, s, g: 7.0, "In 'home' you give 7 m"),
        ("sea", lambda z, h, s, g: 8.0, "In 'sea' you give 8 m"),
        ("terrain", lambda z, h, s, g: 9.0, "In 'terrain' you give 9 m"),
    ],
)
def test_mistakes_with_an_altitude(frame, wrong, hint):
    verdict = check("14.2", lambda asked, *heights: wrong(*heights) if asked == frame else from_zero(asked, *heights))
    assert not verdict
    assert hint in verdict.hint


def test_one_altitude_for_all_frames():
    assert "the same in all three frames" in check("14.2", lambda frame, z, *_: z).hint
    assert "the same in all three frames" in check("14.2", lambda frame, *heights: from_zero("home", *heights)).hint


def corner(before, here, after, radius, *, mistake=""):
    """By the middle of the triangle's third side and its distance to a leg, and broken in several ways."""
    if mistake == "plan":
        before, here, after = (point * [1, 1, 0] for point in (before, here, after))
    into, out = here - before, after - here
    first, second = math.dist(before, here), math.dist(here, after)
    reach = {
        "radius": radius, "whole": min(radius, first, second), "before": min(radius, first / 2),
        "behind": min(radius, second / 2),
    }.get(mistake, min(radius, first / 2, second / 2))  # fmt: skip
    turn = math.atan2(np.linalg.norm(np.cross(into, out)), into @ out)
    if turn > math.radians(91) and mistake not in ("sine", "plan"):
        return reach if mistake == "whole bound" else reach / 2
    middle = here + reach / 2 * (out / second - into / first)
    margin = np.linalg.norm(np.cross(middle - here, out / second))
    return {
        "twice": 2 * margin, "tangent": reach / 2 * math.tan(turn), "cosine": reach / 2 * math.cos(turn),
        "corner": math.dist(middle, here), "half turn": math.dist(middle, here) / 2, "any": reach / 2,
        "degrees": reach / 2 * math.sin(math.degrees(turn)), "long": margin * first * second,
    }.get(mistake, margin)  # fmt: skip


def test_a_margin_by_the_middle_of_the_third_side_is_right():
    assert check("14.3", corner)


def test_a_margin_by_the_angle_is_right():
    def by_angle(before, here, after, radius):
        legs = [(end - start) / np.linalg.norm(end - start) for start, end in pairwise((before, here, after))]
        inner = math.pi - math.acos(min(max(float(legs[0] @ legs[1]), -1.0), 1.0))
        reach = min(radius, math.dist(before, here) / 2, math.dist(here, after) / 2)
        return reach / 2 * (math.sin(inner) if inner > math.pi / 2 else 1)

    assert check("14.3", by_angle)


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("twice", "twice too much"),
        ("tangent", "that is a tangent"),
        ("cosine", "a cosine"),
        ("corner", "how far the corner, not a leg, is from the third side"),
        ("half turn", "half the turn"),
        ("degrees", "degrees for radians"),
        ("any", "whatever the turn"),
        ("radius", "Your reach is the radius"),
        ("whole", "may be a whole leg"),
        ("before", "the leg before the corner alone"),
        ("behind", "the leg behind the corner alone"),
        ("plan", "leave out the heights"),
        ("long", "as long as the legs"),
        ("sine", "the sine falls again"),
        ("whole bound", "you keep the whole reach"),
    ],
)
def test_mistakes_with_a_margin(mistake, hint):
    verdict = check("14.3", lambda *question: corner(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


def moved(before, here, after, radius):
    before -= here
    return 1.0


def unclipped(before, here, after, radius):
    legs = [(end - start) / np.linalg.norm(end - start) for start, end in pairwise((before, here, after))]
    with np.errstate(invalid="ignore"):
        turn = np.arccos(legs[0] @ legs[1])
    return corner(before, here, after, radius) + 0 * turn


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda *question: 1.234, "At a turn of 33.7°, radius 2 m and long legs, you give 1.23 m"),
        (lambda *question: corner(*question) + 1e-4, "which point of it is farthest"),
        (
            lambda b, h, a, r: 0.9 if (h - b) @ (a - h) < 0 else corner(b, h, a, r),
            "At a turn of 162° and a radius of 2 m you give 0.9 m",
        ),
        (moved, "changes an array"),
        (unclipped, "is NaN for points in a line"),
    ],
)
def test_other_answers_for_a_margin(answer, hint):
    verdict = check("14.3", answer)
    assert not verdict
    assert hint in verdict.hint


def arrives(items, loss, tries, *, mistake=""):
    """By what happens after each try, and broken in several ways."""
    lost = {"one way": loss, "both": loss * loss, "sum": 2 * loss}.get(mistake, loss + (1 - loss) * loss)
    open_still = 1.0
    for _ in range({"less": tries - 1, "more": tries + 1, "single": 1}.get(mistake, tries)):
        open_still *= lost
    one = 1 - open_still
    every = float(binom.pmf(items, items, one)) if one >= 0 else one**items
    return {
        "one item": one, "average": items * one, "failure": 1 - every, "one fails": open_still, "percent": 100 * every,
        "any": 1 - open_still**items, "added": 1 - items * open_still, "apart": (1 - loss**tries) ** (2 * items),
    }.get(mistake, every)  # fmt: skip


def test_a_chance_try_by_try_is_right():
    assert check("14.4", arrives)


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("one way", "one way only"),
        ("apart", "try question and answer apart"),
        ("both", "only when both messages are lost"),
        ("sum", "You add two losses"),
        ("less", "one try less"),
        ("more", "one try more"),
        ("single", "a single try for each item"),
        ("one item", "the chance of one item"),
        ("average", "arrive on average"),
        ("failure", "something is missing"),
        ("one fails", "one item doesn't arrive"),
        ("any", "at least one item arrives"),
        ("added", "You add the failures"),
        ("percent", "in percent"),
    ],
)
def test_mistakes_with_a_chance(mistake, hint):
    verdict = check("14.4", lambda *question: arrives(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda *question: 0.5, "For 20 items, 10% loss and 3 tries you give 0.5. With which chance"),
        (lambda *question: 1.5, "you give 1.5. No chance is below 0 or above 1"),
        (lambda *question: arrives(*question) - 1e-4, "you give 0.8713. With which chance"),
    ],
)
def test_other_answers_for_a_chance(answer, hint):
    verdict = check("14.4", answer)
    assert not verdict
    assert hint in verdict.hint


def by_root(margin, sigma, correlation, *, mistake=""):
    """Where 3σ(t) comes to the margin, by search, and broken in several ways."""
    sigmas = 1.0 if mistake == "one sigma" else 3.0
    rate = {"no two": 1.0, "two below": 0.5}.get(mistake, 2.0) / correlation

    def spread(t):
        grown = 1 - math.exp(-rate * t)
        return sigmas * sigma * (grown if mistake == "no root" else math.sqrt(grown))

    if sigmas * sigma <= margin:
        return math.inf
    found = brentq(lambda t: spread(t) - margin, 0.0, 1e6, xtol=1e-12, rtol=1e-14)
    return found * {"minutes": 1 / 60, "negative": -1.0, "base 10": 1 / math.log(10)}.get(mistake, 1.0)


def test_a_time_by_search_is_right():
    assert check("14.5", by_root)


@pytest.mark.parametrize(
    ("mistake", "hint"),
    [
        ("one sigma", "one σ reach the margin"),
        ("no two", "twice too long"),
        ("two below", "four times too long"),
        ("no root", "forget the root"),
        ("negative", "times are negative"),
        ("minutes", "in minutes"),
        ("base 10", "natural logarithm"),
    ],
)
def test_mistakes_with_a_time(mistake, hint):
    verdict = check("14.5", lambda *question: by_root(*question, mistake=mistake))
    assert not verdict
    assert hint in verdict.hint


def unguarded(margin, sigma, correlation, log=math.log):
    return -correlation / 2 * log(1 - (margin / 3 / sigma) ** 2)


def quiet(number):
    with np.errstate(all="ignore"):
        return np.log(number)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda m, s, c: math.inf if 3 * s <= m else 0.0, "in the long run. At the start the error is 0"),
        (lambda m, s, c: math.inf, "No margin here is as large"),
        (lambda m, s, c: c / 2 * (m / 3 / s) ** 2, "the curve's beginning"),
        (lambda m, s, c: 60.0, "you give 60 s. Then 3σ is 4.53 m"),
        (lambda m, s, c: -5.0, "you give -5 s. Then 3σ is 0.00 m"),
        (unguarded, "no flight is too long. Your function raises ValueError('math domain error')"),
        (lambda m, s, c: unguarded(m, s, c, quiet), "no flight is too long. Your answers are nan"),
        (lambda m, s, c: by_root(m, s, c) if m < 3 * s else 1e9, "Your answers are 1e+09 and 1e+09 s"),
        (lambda m, s, c: by_root(m, s, c) if m < 3 * s else -math.inf, "Your answers are -inf and -inf s"),
        (lambda m, s, c: by_root(m, s, c) if m != 3 * s else 0.0, "Your answers are inf and 0 s"),
        (
            lambda m, s, c: by_root(m, s, c) if m < 3 * s else None,
            "returns nothing: it needs a line with `return`. The answer is one number: the time [s], math.inf",
        ),
        (lambda m, s, c: by_root(m, s, c) if m < 3 * s else "inf", "returns text, 'inf'"),
    ],
)
def test_other_answers_for_a_time(answer, hint):
    verdict = check("14.5", answer)
    assert not verdict
    assert hint in verdict.hint


@cache
def campus():
    """The reference campus, and its city with the place that the exercise gives it."""
    risk = reference_campus()
    return risk, replace(risk.city, reference=Place(8.5, 47.25, 420.0))


LIMITS = {"min_clearance": 3.0, "max_height": 60.0}
(X, Y, _), (GOAL_X, GOAL_Y, _) = CAMPUS_FLIGHT
UP = 70.0


@cache
def good(planner=astar, **options):
    """A mission that passes."""
    risk, city = campus()
    route = shortcut(planner(city, *CAMPUS_FLIGHT, **LIMITS), city)
    return Mission.from_route(route, city, risk.uav, **options)


def by_hand(*points, land=None):
    """A mission over points of the campus, whatever is in the way; it lands below the last one, or elsewhere."""
    _, city = campus()
    places = [city.to_geographic(point) for point in (*points, points[-1] if land is None else land)]
    commands = [22] + [16] * (len(points) - 1) + [21]
    items = tuple(
        Item(command, 3, (0, 0, 0, 0), place[1], place[0], place[2] - 420.0)
        for command, place in zip(commands, places, strict=True)
    )
    return Mission(items, Place(places[0][0], places[0][1], 420.0), good().fence)


def rectangle(west, south, east, north, inclusion=True, name="fence"):
    """A polygon of a fence around a part of the campus, in metres."""
    _, city = campus()
    corners = city.reference.longitude_latitude([(west, south), (east, south), (east, north), (west, north)])
    return FencePolygon(tuple((north, east) for east, north in corners.tolist()), inclusion, name)


def without(*commands):
    return replace(good(), items=tuple(item for item in good().items if item.command not in commands))


def changed(number, **fields):
    """The good mission with another item."""
    items = list(good().items)
    items[number] = items[number]._replace(**fields)
    return replace(good(), items=tuple(items))


@pytest.mark.parametrize(
    "mission",
    [
        lambda: good(),
        lambda: good(theta_star),
        lambda: good(altitudes="terrain"),
        lambda: good(home=(*campus()[1].to_geographic(CAMPUS_FLIGHT[0])[:2], 420.0), altitudes="sea"),
        lambda: good(speed=4.0, hold=5.0, fence_margin=2.0),
        lambda: replace(good(), fence=(rectangle(0, 0, 150, 150), rectangle(100, 5, 140, 20, inclusion=False))),
        lambda: replace(good(), place=None),
        lambda: by_hand((X, Y, 24.0), (24.5, 28.0, 24.0), land=(GOAL_X, GOAL_Y, 0.0)),  # level to above the goal
    ],
)
def test_other_missions_are_right(mission):
    verdict = check("14.6", lambda *_: mission())
    assert verdict, verdict


def test_a_mission_is_asked_for_with_the_city_and_both_ends():
    risk, _ = campus()
    asked = []

    def from_question(city, start, goal):
        asked.append((city.reference, start, goal))
        return Mission.from_route(theta_star(city, start, goal, **LIMITS), city, risk.uav)

    assert check("14.6", from_question)
    assert asked == [(Place(8.5, 47.25, 420.0), *CAMPUS_FLIGHT)]


def test_a_mission_from_a_file_is_right(tmp_path):
    good().to_plan(tmp_path / "flight.plan")
    assert check("14.6", lambda *_: read_plan(tmp_path / "flight.plan"))


def home_at(x, y):
    return Place(*campus()[1].to_geographic((x, y, 0.0))[:2], 420.0)


def dull():
    """A route with a waypoint at each voxel, that rises and falls."""
    points = np.linspace((X, Y, 40.0), (GOAL_X, GOAL_Y, 40.0), 22)
    points[1::2, 2] += 5.0
    return Route(points)


def crossed():
    return rectangle(0, 0, 150, 150)._replace(
        corners=tuple(rectangle(0, 0, 150, 150).corners[n] for n in (0, 2, 1, 3)), name="bow"
    )


@pytest.mark.parametrize(
    ("mission", "hint"),
    [
        (lambda: good(end="return"), "lands where it took off"),
        (lambda: good(end="stay"), "hovers until the battery is empty"),
        (lambda: replace(good(), items=(*good().items, Item(183))), "Where command 183 leads"),
        (lambda: without(22), "its only take-off"),
        (lambda: replace(good(), items=(good().items[0], *good().items)), "its only take-off"),
        (lambda: without(21), "the only landing"),
        (lambda: replace(good(), items=(*good().items, good().items[2])), "the only landing"),
        (lambda: replace(good(), items=(*good().items, good().items[-1])), "the only landing"),
        (lambda: changed(0, frame=5), "has a place in frame 5"),
        (lambda: by_hand((X + 20, Y, 30), (X + 30, Y, 30)), "It takes off 20.0 m from the start; 3 m are allowed."),
        (lambda: by_hand((X, Y, 30), (GOAL_X, GOAL_Y - 10, 30)), "It lands 10.0 m from the goal; 3 m are allowed."),
        (lambda: replace(good(), home=Place(47.25, 8.5, 420.0)), "km away from the campus"),
        (lambda: by_hand((X, Y, 30), (GOAL_X + 4, GOAL_Y - 3, 30)), "It lands 5.0 m from the goal; 3 m are allowed."),
        (lambda: replace(good(), home=home_at(X + 6, Y)), "It takes off 6.0 m from the start"),
        (lambda: by_hand((X, Y, 22.5), (GOAL_X, GOAL_Y, 22.5)), "as near as 2.50 m to an obstacle; it must keep 3 m."),
        (lambda: by_hand((X, Y, 10), (GOAL_X, GOAL_Y, 10)), "It hits an obstacle or leaves the map."),
        (lambda: by_hand((X, Y, 30), (-5, 80, 30), (GOAL_X, GOAL_Y, 30)), "It hits an obstacle or leaves the map."),
        (lambda: by_hand((X, Y, 10), land=(GOAL_X, GOAL_Y, 0)), "It hits an obstacle or leaves the map."),
        (lambda: Mission.from_route(dull(), campus()[1], campus()[0].uav), "It has 21 waypoints; 12 are allowed."),
        (lambda: replace(good(), fence=(crossed(),)), "The polygon 'bow' of the fence crosses itself."),
        (
            lambda: by_hand((X, Y, 30), (X, Y, UP), (GOAL_X, GOAL_Y, UP)),
            "It climbs to 70.0 m above the ground; 60 m are",
        ),
        (lambda: replace(good(), fence=()), "It has no fence to stay inside of."),
        (lambda: replace(good(), fence=(rectangle(100, 5, 140, 20, False),)), "It has no fence to stay inside of."),
        (lambda: replace(good(), fence=(rectangle(0, 0, 100, 150),)), "m outside of its fence"),
        (
            lambda: replace(good(), fence=(*good().fence, rectangle(60, 0, 80, 150, False, "school"))),
            "m through 'school', which the fence closes",
        ),
    ],
)
def test_mistakes_with_a_mission(mission, hint):
    verdict = check("14.6", lambda *_: mission())
    assert not verdict
    assert hint in verdict.hint


def test_all_that_a_mission_does_not_keep_is_said():
    mission = by_hand((X + 4, Y, UP), (GOAL_X, GOAL_Y - 4, UP))
    hint = check("14.6", lambda *_: replace(mission, fence=())).hint
    for part in ("takes off 4.0 m", "lands 4.0 m", "climbs to 70.0 m", "no fence"):
        assert part in hint
    assert "obstacle" not in hint
    assert "waypoints" not in hint


@pytest.mark.parametrize(
    ("above_roof", "top", "right"),
    [(3.0, 60.0, True), (2.995, 60.005, True), (2.985, 60.0, False), (3.0, 60.015, False)],
)
def test_what_rounding_costs_is_let_pass(above_roof, top, right):
    """The first leg is over a building whose voxels end at 20 m."""
    low, over_roof = (X, Y, 20 + above_roof), (24.5, 28.0, 20 + above_roof)
    mission = by_hand(low, over_roof, (24.5, 28.0, top), (GOAL_X, GOAL_Y, top))
    assert bool(check("14.6", lambda *_: mission)) == right


@pytest.mark.parametrize(("off", "right"), [(2.98, True), (3.02, False)])
def test_ends_are_near_within_three_metres(off, right):
    begins = by_hand((X, Y + off, 45.0), (GOAL_X, GOAL_Y, 45.0))
    ends = by_hand((X, Y, 45.0), (GOAL_X - off, GOAL_Y, 45.0))
    taken_off_there = by_hand((X, Y + off, 45.0), (GOAL_X, GOAL_Y, 45.0), land=(GOAL_X, GOAL_Y - off, 0.0))
    for mission in (begins, ends, taken_off_there):
        assert bool(check("14.6", lambda *_, mission=mission: mission)) == right


@pytest.mark.parametrize("count", [1, 11, 12, 13])
def test_waypoints_are_counted(count):
    way = np.linspace((X, Y, 40.0), (GOAL_X, GOAL_Y, 40.0), count + 1)
    assert bool(check("14.6", lambda *_: by_hand(*way))) == (count <= 12)


def test_solutions_answer_examples(solutions):
    assert solutions["digit_in_metres"](60.0) == pytest.approx((0.0111195, 0.00555975), rel=1e-5)
    assert [solutions["altitude"](frame, 65.0, 12.0, 430.0, 31.0) for frame in ZEROS] == [53.0, 483.0, 34.0]
    square = [np.array(point, dtype=float) for point in ((0, 0, 30), (20, 0, 30), (20, 3, 30))]
    assert solutions["corner_margin"](*square, 2.0) == pytest.approx(0.75)
    assert solutions["corner_margin"](*square, 1.0) == pytest.approx(0.5)
    assert solutions["chance_of_transfer"](2, 0.5, 1) == pytest.approx(0.0625)
    assert solutions["chance_of_transfer"](300, 0.1, 5) == pytest.approx(0.9284, abs=1e-4)
    assert solutions["longest_flight"](3.0, 4.7, 1100.0) == pytest.approx(by_root(3.0, 4.7, 1100.0))
    assert solutions["longest_flight"](6.0, 2.0, 300.0) == math.inf
    risk, city = campus()
    way = solutions["own_mission"](city, *CAMPUS_FLIGHT).path(city)
    assert way.en_route.clearance(city) > 3.0
    assert risk.fatalities(way.en_route) < 0.2 * risk.fatalities(good().path(city).en_route)


MISTAKES = {
    "14.1": {
        "as long everywhere": lambda latitude: digit(latitude, mistake="no cosine"),
        "takes an angle in radians": lambda latitude: digit(latitude, mistake="degrees"),
        "a whole degree": lambda latitude: digit(latitude, mistake="degree"),
    },
    "14.2": {
        "the same in all three frames": lambda frame, z, *_: z,
        "you add home's height": lambda frame, z, h, s, g: z + h if frame == "home" else from_zero(frame, z, h, s, g),
        "points above home have altitudes below 0": lambda frame, z, h, s, g: (
            h - z if frame == "home" else from_zero(frame, z, h, s, g)
        ),
    },
    "14.3": {
        "twice too much": lambda *question: corner(*question, mistake="twice"),
        "that is a tangent": lambda *question: corner(*question, mistake="tangent"),
        "may be a whole leg": lambda *question: corner(*question, mistake="whole"),
    },
    "14.4": {
        "one way only": lambda *question: arrives(*question, mistake="one way"),
        "a single try for each item": lambda *question: arrives(*question, mistake="single"),
        "the chance of one item": lambda *question: arrives(*question, mistake="one item"),
    },
    "14.5": {
        "one σ reach the margin": lambda *question: by_root(*question, mistake="one sigma"),
        "forget the root": lambda *question: by_root(*question, mistake="no root"),
        "in minutes": lambda *question: by_root(*question, mistake="minutes"),
    },
    "14.6": {
        "lands where it took off": lambda *_: good(end="return"),
        "hovers until the battery is empty": lambda *_: good(end="stay"),
        "has no fence to stay inside of": lambda *_: replace(good(), fence=()),
    },
}
