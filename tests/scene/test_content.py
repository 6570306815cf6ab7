"""From routes and flights to a drawing: marks, colours, moments, the legend; what can't be drawn is said."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from uavlab import plot, scene
from uavlab.city import City
from uavlab.flight import fly
from uavlab.planners import shortcut
from uavlab.plot.colors import CRASH_COLOR
from uavlab.route import Route
from uavlab.scene.content import MOST_FLIGHTS, NEAR_WIDTH, OUTCOME_COLORS, drawing_of
from uavlab.scene.shapes import dashed
from uavlab.spline import Curve
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

EMPTY = City(np.zeros((20, 20, 10), dtype=bool), 5.0)
THERE = np.array([(5.0, 5, 20), (60, 5, 20), (60, 80, 40)])


def marks(drawing):
    return [(mark.kind, tuple(np.round(mark.place, 6).tolist()), mark.color) for mark in drawing.markers]


def entries(drawing):
    return {entry.text: entry for entry in drawing.legend}


def radius_of(part, line):
    """How far the surface of a tube is from the first leg of its line, where that begins."""
    corners = part.triangles.reshape(-1, 3)
    return np.linalg.norm(corners[np.linalg.norm(corners - line[0], axis=1).argsort()[:30]] - line[0], axis=1).max()


def test_a_route_that_arrives_has_a_start_and_a_goal_in_its_colour():
    drawing = drawing_of(EMPTY, (Route(THERE, "A*"),))
    assert marks(drawing) == [("start", (5, 5, 20), plot.BLUE), ("goal", (60, 80, 40), plot.BLUE)]
    assert list(entries(drawing)) == ["A*: 132.6 m", "start", "goal"]
    assert all(mark.since == 0 for mark in drawing.markers)


def test_a_route_that_stops_says_where_and_why_and_where_it_should_have_arrived():
    lost = Route(THERE, "A*", reached=False, reason="stuck at (60, 80, 40)", info={"goal": (90.0, 90, 20)})
    drawing = drawing_of(EMPTY, (lost,))
    assert marks(drawing) == [
        ("start", (5, 5, 20), plot.BLUE), ("stopped", (60, 80, 40), plot.BLUE), ("missed", (90, 90, 20), plot.BLUE)
    ]  # fmt: skip
    assert list(entries(drawing)) == [
        "A*: doesn't arrive, stuck at (60, 80, 40)", "start", "stopped", "goal not reached",
    ]  # fmt: skip
    none = Route.none("A*", "no free way")
    drawing = drawing_of(EMPTY, (none,))
    assert not drawing.markers
    assert not drawing.movers
    assert list(entries(drawing)) == ["A*: doesn't arrive, no free way"]
    assert drawing.duration == 0


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_route_that_stays_where_it_is_has_marks_and_no_tube(count):
    hover = Route([(7, 8, 9)] * count)
    drawing = drawing_of(EMPTY, (hover,))
    assert [mark[:2] for mark in marks(drawing)] == [("start", (7, 8, 9)), ("goal", (7, 8, 9))]
    assert not [name for name in drawing.parts if name.startswith("route")]
    assert not drawing.movers
    assert scene.show(EMPTY, hover).still


def test_flights_have_marks_when_and_where_they_end(table1, crash_and_safe):
    crash, safe = crash_and_safe.values()
    drawing = drawing_of(table1, (), flights=crash_and_safe)
    blue, green = plot.BLUE, plot.GREEN
    found = {(kind, color): mark for (kind, _, color), mark in zip(marks(drawing), drawing.markers, strict=True)}
    assert set(found) == {
        ("start", blue), ("crash", CRASH_COLOR), ("missed", blue), ("start", green), ("goal", green)
    }  # fmt: skip
    assert np.array_equal(found["crash", CRASH_COLOR].place, crash.position[-1])
    assert found["crash", CRASH_COLOR].since == pytest.approx(crash.duration)
    assert np.array_equal(found["missed", blue].place, crash.goal)
    assert np.array_equal(found["goal", green].place, safe.position[-1])
    assert found["missed", blue].since == found["goal", green].since == found["start", blue].since == 0
    assert drawing.duration == pytest.approx(max(crash.duration, safe.duration))
    assert list(entries(drawing)) == [
        f"A*: crashed after {crash.duration:.1f} s", f"REPARE: arrived after {safe.duration:.1f} s",
        "start", "goal", "goal not reached", "crash",
    ]  # fmt: skip
    assert entries(drawing)["crash"].color == CRASH_COLOR


def test_flights_that_give_up_end_in_a_square_at_their_moment(table1, crash_and_safe):
    landed = replace(crash_and_safe["REPARE"], outcome="landed", reason="empty")
    drawing = drawing_of(table1, (), flights=[landed])
    (stopped,) = [mark for mark in drawing.markers if mark.kind == "stopped"]
    assert np.array_equal(stopped.place, landed.position[-1])
    assert stopped.since == pytest.approx(landed.duration)
    assert [mark.kind for mark in drawing.markers] == ["start", "stopped", "missed"]
    without = drawing_of(table1, (), flights=[replace(landed, goal=None)])
    assert [mark.kind for mark in without.markers] == ["start", "stopped"]


@pytest.mark.parametrize("rows", [1, 2, 3])
def test_flights_that_end_at_once_show_where(table1, crash_and_safe, rows):
    crash = crash_and_safe["A*"]
    short = replace(crash, log=crash.log[:rows])
    drawing = drawing_of(table1, (), flights=[short])
    (mark,) = [mark for mark in drawing.markers if mark.kind == "crash"]
    assert np.array_equal(mark.place, short.position[-1])
    assert scene.show(table1, flights=[short], start_at=short.duration).still


def test_a_grounded_flight_is_named_and_not_drawn(table1, route):
    grounded = fly(route, table1, LIGHT_QUADROTOR, Wind((40.0, 0.0)), rng=1)
    drawing = drawing_of(table1, (), flights={"A*": grounded})
    assert list(entries(drawing)) == ["A*: grounded"]
    assert not drawing.movers
    assert not drawing.markers
    assert scene.show(table1, flights=[grounded]).still


def test_a_route_and_a_flight_of_one_name_look_alike(table1, route, crash_and_safe):
    drawing = drawing_of(table1, (route, {"mine": shortcut(route, table1)}),
                         flights={**crash_and_safe, "mine": crash_and_safe["A*"]})  # fmt: skip
    looks = {text: entry.style for text, entry in entries(drawing).items() if entry.kind in ("line", "thin")}
    by_name = {}
    for text, style in looks.items():
        by_name.setdefault(text.split(":")[0], []).append(style)
    assert {name: len(both) for name, both in by_name.items()} == {"A*": 2, "mine": 2, "REPARE": 1}
    assert all(one == other for one, other in (by_name["A*"], by_name["mine"]))
    assert by_name["A*"][0] == plot.styles(["A*"])[0]
    assert len({both[0].color for both in by_name.values()}) == 3
    asked = drawing_of(table1, (route,), flights=crash_and_safe, colors={"A*": plot.PINK, "REPARE": "tab:green"})
    colors = {text.split(":")[0]: entry.color for text, entry in entries(asked).items() if entry.kind == "line"}
    assert colors == {"A*": plot.PINK, "REPARE": "#2CA02C"}
    assert [mover.color for mover in asked.movers] == [plot.PINK, "#2CA02C"]


def test_two_routes_of_one_name_are_two_things_and_the_flight_looks_like_the_first(table1, route, crash_and_safe):
    drawing = drawing_of(table1, (route, route), flights={"A*": crash_and_safe["A*"]})
    first, second, flight = (entry.style for entry in drawing.legend[:3])
    assert first == flight == plot.styles(["A*"])[0]
    assert second != first


def test_tubes_have_the_colour_and_the_dashes_of_the_legend():
    ways = {f"way {n}": Route(np.add(THERE, (0, n, 0))) for n in range(7)}
    drawing = drawing_of(EMPTY, (ways,))
    width = 2 * radius_of(drawing.parts["route0"], THERE)
    for number, (name, way) in enumerate(ways.items()):
        entry = drawing.legend[number]
        assert entry.text.startswith(name)
        assert entry.kind == "line"
        pieces = dashed(way.points, entry.style.line, width)
        for part in (drawing.parts[f"route{number}"], drawing.parts[f"route{number} near"]):
            assert part.color == entry.color == drawing.movers[number].color
            corners = np.unique(part.triangles.reshape(-1, 3).round(9), axis=0)
            for piece in pieces:
                for end in (piece[0], piece[-1]):
                    assert np.linalg.norm(corners - end, axis=1).min() < 1e-6  # the tip of each fan
            gaps = [(one[-1] + other[0]) / 2 for one, other in pairwise(pieces)]
            for gap in gaps:
                assert np.linalg.norm(corners - gap, axis=1).min() > 0.3 * width / 2
    assert len({entry.style.line for entry in drawing.legend[:7]}) == 7


def test_routes_are_thin_beside_flights_and_nobody_flies_them(table1, route, crash_and_safe):
    alone, beside = drawing_of(table1, (route,)), drawing_of(table1, (route,), flights=crash_and_safe)
    line = route.points
    assert radius_of(beside.parts["route0"], line) == pytest.approx(0.4 * radius_of(alone.parts["route0"], line))
    assert beside.legend[0].kind == "thin"
    assert alone.legend[0].kind == "line"
    assert len(alone.movers) == 1
    assert len(beside.movers) == len(crash_and_safe)


def test_from_near_tubes_are_thin_so_that_no_uav_is_hidden():
    large = City(np.zeros((50, 50, 4), dtype=bool), 20.0)
    drawing = drawing_of(large, (Route(THERE),))
    assert radius_of(drawing.parts["route0 near"], THERE) == pytest.approx(NEAR_WIDTH / 2)
    assert radius_of(drawing.parts["route0"], THERE) == pytest.approx(0.0045 * 1000 * np.sqrt(2) / 2)
    assert set(drawing.shown(0.0, 0.9 * drawing.closeup)) >= {"route0 near"}
    assert "route0" not in drawing.shown(0.0, 0.9 * drawing.closeup)
    assert "route0 near" not in drawing.shown(0.0, 1.1 * drawing.closeup)


def test_uavs_are_shown_where_they_are_at_the_moment(table1, crash_and_safe):
    drawing = drawing_of(table1, (), flights=crash_and_safe, safe_distance=3.0)
    for moment in (0.0, 2.0, drawing.duration):
        shown = drawing.shown(moment, 1e3)
        for number, flight in enumerate(crash_and_safe.values()):
            place = flight.position[np.abs(flight.time - flight.time[0] - moment).argmin()]
            ball = shown[f"ball{number}"].triangles.reshape(-1, 3)
            assert (ball.min(axis=0) + ball.max(axis=0)) / 2 == pytest.approx(place, abs=0.15)
            body = shown[f"uav{number}"].triangles.reshape(-1, 3)
            assert np.linalg.norm(body.mean(axis=0) - place) < 0.3
    assert entries(drawing)["distance to keep, 3 m"].kind == "ball"
    assert any("UAVs are drawn at their size, 1 m" in note for note in drawing.notes)


def test_expanded_nodes_appear_in_their_order(table1, route):
    drawing = drawing_of(table1, (route,), expansion=True)
    order = route.info["order"]
    assert drawing.duration == drawing.order == len(order)
    position = {node: place for place, node in enumerate(order.tolist())}
    for moment in (0, len(order) // 3, len(order)):
        shown = [part for name, part in drawing.shown(moment, 1e3).items() if name.startswith("expanded")]
        codes = table1.code_of(table1.cell_of(np.concatenate([part.points for part in shown])))
        latest = max(position[code] for code in codes.tolist())
        assert moment <= latest + 3
        assert latest <= moment + len(order) / 40 + 3
    assert not drawing.movers
    assert "9,004 of 18,007 expanded nodes are drawn" in drawing.notes


def test_two_hundred_flights_are_thinned_and_it_is_said(table1, crash_and_safe):
    crash, safe = crash_and_safe.values()
    grounded = replace(safe, outcome="grounded", log=safe.log[:0])
    flights = [crash, safe, safe, safe] * 49 + [grounded] * 4
    drawing = drawing_of(table1, (), flights=flights, safe_distance=3.0)
    drawn = len(drawing.movers)
    assert 12 < drawn <= MOST_FLIGHTS
    assert f"{drawn} of 196 flights are drawn" in drawing.notes
    assert [text for text in entries(drawing) if "flights" in text] == [
        "crashed: 49 flights", "arrived: 147 flights", "grounded: 4 flights",
    ]  # fmt: skip
    colors = {mover.color for mover in drawing.movers}
    assert colors == {OUTCOME_COLORS["crashed"], OUTCOME_COLORS["arrived"]}
    assert entries(drawing)["crashed: 49 flights"].color == OUTCOME_COLORS["crashed"]
    assert len(scene.page(table1, flights=flights)) < 600_000
    seven = drawing_of(table1, (), flights=[safe] * 7)
    assert len({mover.color for mover in seven.movers}) == 7
    assert not any("flights are drawn" in note for note in seven.notes)


def test_many_flights_end_where_they_end_too(table1, crash_and_safe):
    flights = list(crash_and_safe.values()) * 8
    drawing = drawing_of(table1, (), flights=flights)
    for flight, mover in zip(flights, drawing.movers, strict=True):
        assert np.array_equal(mover.points[-1], flight.position[-1])
    assert len([mark for mark in drawing.markers if mark.kind == "crash"]) == 1  # all in one place


def test_curves_are_drawn_by_name_and_flown():
    curve = Curve([(5, 5, 20), (40, 5, 20), (60, 40, 30), (60, 80, 40)])
    drawing = drawing_of(EMPTY, ({"smooth": curve},))
    assert next(iter(entries(drawing))).startswith("smooth: ")
    assert np.array_equal(drawing.movers[0].points[-1], curve.points[-1])


@pytest.mark.parametrize("kind", [np.int64, np.float32, int])
def test_safe_distance_of_any_kind_of_number(kind):
    assert scene.page(EMPTY, Route(THERE), safe_distance=kind(3)) == scene.page(EMPTY, Route(THERE), safe_distance=3.0)


def test_a_distance_larger_than_the_map_is_drawn():
    assert scene.show(EMPTY, Route(THERE), safe_distance=900.0, camera="chase").still


@pytest.mark.parametrize("draw", [scene.page, scene.show, scene.still])
@pytest.mark.parametrize(
    ("routes", "more", "message"),
    [
        ((), {"expansion": True}, "expansion needs a first route planned with record=True"),
        ((), {"expansion": "no"}, "expansion must be True or False, got 'no'"),
        ((), {"safe_distance": 0.0}, "safe_distance must be finite and above 0, got 0"),
        ((), {"safe_distance": np.nan}, "safe_distance must be"),
        ((), {"safe_distance": "3"}, "safe_distance must be a number"),
        (([THERE],), {}, "routes must be a Route, got list"),
        (({"a": 3},), {}, r"routes\['a'\] must be a Route, got int"),
        ((), {"flights": Route(THERE)}, "flights must be a list of Flight, or Flight by name, got Route"),
        ((), {"flights": [Route(THERE)]}, "flights must be a Flight, got Route"),
        ((), {"wind": (3.0, 4.0)}, "wind must be a Wind, got tuple"),
        ((), {"uav": 1.0}, "uav must be a UAV, got float"),
        ((), {"colors": ["red"]}, "colors must be colours by name"),
        ((), {"colors": {"A*": "reddish"}}, r"colors\['A\*'\] must be a colour, such as plot.BLUE, got 'reddish'"),
        ((), {"start_at": -1.0}, "start_at must be .*not negative|start_at must be at least 0|start_at must be"),
        ((Route(THERE),), {"start_at": 900.0}, "start_at must be at most 26.5.* s, the animation's length, got 900"),
        (
            (Route(np.add(THERE, (5e5, 5.7e6, 0))),),
            {},
            r"must lie within 1,000 km of the map's centre, .* got one 5,700 km away",
        ),
    ],
)
def test_what_can_not_be_drawn_is_said(draw, routes, more, message):
    with pytest.raises(ValueError, match=message):
        draw(EMPTY, *routes, **more)


def test_an_expansion_and_flights_are_two_scenes(table1, route, crash_and_safe):
    with pytest.raises(ValueError, match="two animations"):
        scene.page(table1, route, expansion=True, flights=crash_and_safe)
    with pytest.raises(ValueError, match="start_at must be at most 18007 expanded nodes"):
        scene.page(table1, route, expansion=True, start_at=20_000)
