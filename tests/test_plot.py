"""Figures: axes with units, equal scales, and data that is the route's."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.quiver import Quiver

from uavlab import plot, scene
from uavlab.city import City
from uavlab.flight import Flight, OffsetProcess, Rate, fly
from uavlab.flight.state import COLUMNS
from uavlab.offsets import safety_domain
from uavlab.planners import Comparison, astar, least_risk, pareto_front, potential_field, potential_forces
from uavlab.plot.flights import track
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, reference_campus
from uavlab.route import Route
from uavlab.spline import Curve
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import Wind


@pytest.fixture(scope="module")
def route(table1):
    return astar(table1, (90, 18, 30), (50, 44, 30), record=True)


def labels(figure):
    return [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]


def test_plan_has_equal_scales_and_the_route(table1, route):
    figure = plot.plan(table1, route)
    axes = figure.axes[0]
    assert axes.get_aspect() == 1.0
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x, east [m]", "y, north [m]")
    assert any(np.array_equal(line.get_xydata(), route.points[:, :2]) for line in axes.lines)
    assert figure.legends[0].get_texts()[0].get_text() == "A*, 66.4 m"


def test_plan_shows_how_high_the_buildings_are(table1):
    image = plot.plan(table1).axes[0].images[0].get_array()
    assert image[70, 80] == 90  # row y, column x: the frustum
    assert np.ma.getmaskarray(image)[5, 5]


def test_section_cuts_at_the_height_asked_for(table1):
    image = plot.section(table1, 30.4).axes[0].images[0].get_array()
    assert image[18, 90] == pytest.approx(table1.clearance[90, 18, 30])
    assert np.ma.getmaskarray(image)[20, 65]  # building 1


def test_section_outside_of_the_map(table1):
    with pytest.raises(ValueError, match="height must lie on the map, 0 to 100 m, got 120"):
        plot.section(table1, 120)


def test_field_points_along_the_force_and_colours_the_potential(table1):
    goal = (50, 44, 30)
    trapped = potential_field(table1, (90, 18, 30), goal)
    figure = plot.field(table1, 30, goal, trapped, area=(66, 96, 12, 40), spacing=2.0, push=8.0)
    axes = figure.axes[0]
    arrows = next(drawn for drawn in axes.collections if isinstance(drawn, Quiver))
    places = np.column_stack([arrows.X, arrows.Y, np.full(arrows.N, 30.0)])
    free = table1.is_free(places)
    resultant = sum(potential_forces(table1, places[free], goal, push=8.0)[:2])[:, :2]
    drawn = np.column_stack([arrows.U, arrows.V])
    assert np.array_equal(np.ravel(arrows.Umask), ~free)  # none in a building
    assert drawn[free] == pytest.approx(resultant / np.linalg.norm(resultant, axis=1, keepdims=True), abs=1e-6)
    assert (axes.get_aspect(), axes.get_xlim(), axes.get_ylim()) == (1.0, (66, 96), (12, 40))
    assert axes.child_axes[0].get_ylabel() == "potential U [unit of force · m]"
    assert figure.legends[0].get_texts()[0].get_text() == "potential field: not reached"


def test_field_marks_a_goal_that_no_route_marks(table1):
    goal = (50, 44, 30)
    marks = {}
    for area in (None, (66, 96, 12, 40)):
        axes = plot.field(table1, 30, goal, area=area, spacing=5.0).axes[0]
        marks[area] = [line.get_xydata().tolist() for line in axes.lines if line.get_label() == "goal"]
    assert list(marks.values()) == [[[[50, 44]]], []]  # in the second it lies outside
    with_route = plot.field(table1, 30, goal, astar(table1, (90, 18, 30), goal), spacing=5.0)
    assert [text.get_text() for text in with_route.legends[0].get_texts()].count("goal") == 1


@pytest.mark.parametrize(("shape", "height"), [((50, 50, 3), 5.4), ((100, 10, 3), 3.6), ((10, 100, 3), 8.0)])
def test_a_map_s_figure_has_its_shape(shape, height):
    city = City(np.zeros(shape, bool))
    for figure in (
        plot.plan(city),
        plot.section(city, 1.0),
        plot.value_map(city, np.zeros(shape[:2]), "height [m]"),
        plot.area_map(city, {"built": np.zeros(shape[:2], bool)}),
    ):
        assert figure.get_size_inches() == pytest.approx((6.4, height))


def test_signs_outside_of_the_picture_are_not_in_its_legend(table1):
    trapped = potential_field(table1, (90, 18, 30), (50, 44, 30))
    names = [
        [text.get_text() for text in plot.field(table1, 30, (50, 44, 30), trapped, area=area).legends[0].get_texts()]
        for area in ((66, 96, 12, 40), (40, 96, 12, 50))
    ]
    assert names == [["potential field: not reached", "start", "stopped"],
                     ["potential field: not reached", "start", "stopped", "goal not reached"]]  # fmt: skip


def test_field_refuses_what_it_can_t_draw(table1):
    with pytest.raises(ValueError, match="height must lie on the map, 0 to 100 m, got 120"):
        plot.field(table1, 120, (50, 44, 30))
    with pytest.raises(ValueError, match="spacing must be finite and above 0, got 0"):
        plot.field(table1, 30, (50, 44, 30), spacing=0)
    with pytest.raises(ValueError, match="reach must be finite and above 0, got -1"):
        plot.field(table1, 30, (50, 44, 30), reach=-1)


def test_profile_draws_height_and_clearance(table1, route):
    above, below = plot.profile(table1, route, safe_distance=3.5).axes
    assert above.lines[0].get_ydata() == pytest.approx(route.points[:, 2])
    assert below.lines[0].get_ydata().min() == pytest.approx(route.clearance(table1))
    assert below.lines[1].get_ydata() == pytest.approx([3.5, 3.5])
    assert below.get_xlabel() == "distance flown [m]"


def bent_curve():
    """Two level legs and one that climbs."""
    return Curve(np.array([[10.0, 10, 30], [40, 10, 30], [40, 40, 30], [40, 60, 45]]), planner="bent")


def test_curve_profile_draws_curvature_and_pitch_with_the_papers_limits_and_ours():
    curve = bent_curve()
    other = Curve(curve.control[:3], planner="other")
    figure = plot.curve_profile(curve, other, speed=8.0, cell=5.0, bank=np.radians(20.0))
    above, below = figure.axes
    assert (above.get_ylabel(), below.get_ylabel()) == ("curvature κ [1/m]", "pitch [°]")
    assert below.get_xlabel() == "distance flown [m]"
    assert np.array_equal(above.lines[0].get_xydata(), np.column_stack([curve.distance, curve.curvature]))
    assert np.array_equal(above.lines[1].get_ydata(), curve.level_curvature)
    assert np.array_equal(below.lines[0].get_ydata(), np.degrees(curve.pitch))
    limits = [
        line.get_ydata()[0]
        for axes in (above, below)
        for line in axes.lines
        if line.get_color() == "0.3" and len(line.get_ydata()) == 2
    ]
    assert limits == pytest.approx([0.2, GRAVITY * np.tan(np.radians(20)) / 64, 60, -60])
    assert "20° of bank\nat 8 m/s" in [text.get_text() for text in above.texts]
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["bent", "other", "level part of it"]
    assert above.lines[0].get_color() != above.lines[2].get_color()


@pytest.mark.parametrize("speed", [4.5, 5.0, 5.32, 6.0, 7.0, 16.0])
def test_limits_of_curvature_near_to_each_other_are_labelled_apart(speed):
    figure = plot.curve_profile(Curve([(0, 0, 0), (20, 10, 5), (40, 0, 0)]), speed=speed, cell=5.0)
    figure.draw_without_rendering()
    papers, banked = (text.get_window_extent() for text in figure.axes[0].texts)
    assert not papers.overlaps(banked)


def test_curve_profile_of_a_corner_shows_what_is_finite():
    corner = np.repeat([[10.0, 10, 30], [40, 10, 30], [40, 40, 30]], [1, 3, 1], axis=0)
    above = plot.curve_profile(Curve(corner), speed=8.0, cell=5.0).axes[0]
    assert np.isnan(above.lines[0].get_ydata()).sum() == 1
    assert np.isfinite(above.get_ylim()).all()


def test_corner_shows_where_the_body_touches_and_its_width(table1):
    through = Curve(np.array([[50.0, 12, 30], [58, 10, 30], [66, 18, 30], [72, 10, 30]]), planner="through")
    around = Curve(np.array([[50.0, 12, 30], [58, 10, 30], [72, 10, 30]]), planner="around")
    route = Route(through.control, "given")
    figure = plot.corner(table1, through, around, center=(64, 15, 30), reach=8.0, uav_diameter=2.0, route=route)
    left, right = figure.axes
    for axes in (left, right):
        assert axes.get_aspect() == 1.0
        assert (*axes.get_xlim(), *axes.get_ylim()) == (56, 72, 7, 23)
        assert axes.get_xlabel() == "x, east [m]"
    drawn, line, touch, control = left.lines
    assert np.array_equal(drawn.get_xydata(), route.points[:, :2])
    assert np.array_equal(line.get_xydata(), through.points[:, :2])
    assert np.array_equal(control.get_xydata(), through.control[:, :2])
    x, y = touch.get_xydata()[np.isfinite(touch.get_xydata()[:, 0])].T
    assert len(x) > 10
    assert (y > 14 - 0.1).all()  # building 1 begins at y = 15, and half of the body is 1 m
    assert not np.isfinite(right.lines[2].get_xydata()).any()
    band = left.collections[0].get_paths()[40].vertices
    assert np.linalg.norm(band[0] - band[3]) == pytest.approx(2.0, abs=1e-9)
    assert "touches an obstacle" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert left.get_title().startswith("through: 0.00 m clear")


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda city, curve: plot.curve_profile(speed=8, cell=5), "curves is empty"),
        (lambda city, curve: plot.curve_profile([curve], speed=8, cell=5), "curves must be a Curve, got list"),
        (lambda city, curve: plot.curve_profile(curve, speed=0, cell=5), "speed must be finite and above 0"),
        (lambda city, curve: plot.curve_profile(curve, speed=8, cell=-5), "cell must be finite and above 0"),
        (lambda city, curve: plot.curve_profile(curve, speed=8, cell=5, bank=30), "bank must be below π/2 rad"),
        (lambda city, curve: plot.curve_profile(curve, speed=8, cell=5, max_pitch=60), "max_pitch must be from 0 to"),
        (
            lambda city, curve: plot.corner(city, curve, center=(5, 5), reach=5, uav_diameter=1),
            r"center must have shape \(3,\)",
        ),
        (
            lambda city, curve: plot.corner(city, curve, center=(5, 5, 5), reach=5, uav_diameter=1, route=3),
            "route must be a Route, got int",
        ),
        (
            lambda city, curve: plot.corner(city, curve.route(), center=(0, 0, 0), reach=5, uav_diameter=1),
            "curves must be a Curve, got Route",
        ),
        (
            lambda city, curve: plot.corner(city, curve, center=(5, 5, 120), reach=5, uav_diameter=1),
            "height must lie on",
        ),
        (lambda city, curve: plot.corner(city, curve, center=5, reach=5, uav_diameter=1), "center must have"),
        (lambda city, curve: plot.corner(city, curve, center=(5, 5, 5), reach=0, uav_diameter=1), "reach must be"),
        (
            lambda city, curve: plot.corner(city, curve, center=(5, 5, 5), reach=5, uav_diameter=0),
            "uav_diameter must be",
        ),
        (lambda city, curve: plot.corner(curve, center=(5, 5, 5), reach=5, uav_diameter=1), "city must be a City"),
    ],
)
def test_curves_are_not_drawn_from_something_else(draw, message, table1):
    with pytest.raises(ValueError, match=message):
        draw(table1, bent_curve())


def test_expansions_names_routes_and_marks_their_ends(table1):
    searched = {"near": astar(table1, (90, 18, 30), (50, 44, 30), record=True)}
    stuck = Route.none("A*", "walled in", goal=np.array([5.0, 5.0, 5.0]), order=searched["near"].info["order"])
    figure = plot.expansions(table1, searched, stuck)
    assert [axes.get_title() for axes in figure.axes[:2]] == ["near: 18,007 expanded", "A*: 18,007 expanded"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "near, 66.4 m", "start", "goal", "building", "goal not reached"
    ]  # fmt: skip


def test_expansions_needs_a_recorded_order(table1, route):
    assert "18,007 expanded" in plot.expansions(table1, route).axes[0].get_title()
    with pytest.raises(ValueError, match="record=True"):
        plot.expansions(table1, astar(table1, (90, 18, 30), (50, 44, 30)))


def test_bars_carry_their_numbers():
    axes = plot.bars({"octile": 12.0, "zero": 1234.0}, "expansions").axes[0]
    assert {text.get_text() for text in axes.texts} == {"12", "1,234"}


def test_route_that_did_not_arrive_is_named_and_not_drawn(table1):
    lost = Route(np.empty((0, 3)), "A*", reached=False, reason="no free way")
    for figure in (plot.plan(table1, lost), plot.profile(table1, lost)):
        assert figure.axes
    assert plot.plan(table1, lost).legends[0].get_texts()[0].get_text() == "A*: not reached"


def test_empty_city_can_be_drawn():
    city = City(np.zeros((5, 5, 5), dtype=bool))
    assert plot.plan(city).axes


def test_risk_section_is_the_rate_on_a_scale_of_factors_with_what_is_too_low_hatched():
    campus = reference_campus()
    image = plot.risk(campus, 27.5).axes[0].images[0]
    assert type(image.norm).__name__ == "LogNorm"
    assert image.get_array()[3, 2] == pytest.approx(campus.rate[2, 3, 5])  # row y, column x
    assert np.ma.getmaskarray(image.get_array())[18, 10]  # a building of 28 m
    low = plot.risk(campus, 2.5).axes[0]
    assert "too low hatched" in low.get_title()
    assert any(getattr(drawn, "hatches", None) == ["////"] for drawn in low.collections)
    with pytest.raises(ValueError, match="height must lie on the map, 0 to 80 m"):
        plot.risk(campus, 80.5)


def test_layers_show_people_shelter_and_cars_with_units():
    campus = reference_campus()
    figure = plot.layers(campus)
    shown = [axes.images[0].get_array() for axes in figure.axes if axes.images]
    for image, layer in zip(
        shown, (1e3 * campus.population_density, campus.shelter, 1e6 * campus.vehicle_share), strict=True
    ):
        assert np.allclose(image.T, layer)
    assert {"thousands of people per km²", "ground under cars [m² per km²]"} <= set(labels(figure))


def test_layers_that_are_the_same_everywhere_have_a_scale_from_zero():
    city = reference_campus().city
    figure = plot.layers(RiskMap(city, 0.005, 0.25, 0.0))
    assert [axes.images[0].get_clim() for axes in figure.axes if axes.images] == [(0, 5), (0, 0.25), (0, 1)]


def test_front_draws_length_against_risk():
    campus = reference_campus()
    routes = pareto_front(campus, *CAMPUS_FLIGHT, lengths=4)
    shortest = least_risk(campus, *CAMPUS_FLIGHT, risk_weight=0, length_weight=1)
    axes = plot.front(routes, shortest).axes[0]
    assert np.allclose(axes.lines[0].get_xydata(), [(route.length, route.cost) for route in routes])
    assert axes.get_xlabel() == "length [m]"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["Pareto front", "shortest, 140.9 m"]


def test_front_without_a_route_is_refused_with_its_reason_and_no_other_route_is_left_out():
    campus = reference_campus()
    shortest = least_risk(campus, *CAMPUS_FLIGHT, risk_weight=0, length_weight=1)
    none = least_risk(campus, *CAMPUS_FLIGHT, max_length=100.0)
    for routes, message in (([], "it is empty"), ([none], "max_length is 100 m"), (shortest, "a list.* got Route")):
        with pytest.raises(ValueError, match=f"routes must .*{message}"):
            plot.front(routes)
    axes = plot.front([shortest], *[shortest] * 7).axes[0]
    assert len(axes.lines) == 8


def test_colors_span_a_factor_of_ten_at_least():
    """So that nearly equal risks look so, and the ticks of the bar can be read."""
    even = RiskMap(City(np.zeros((4, 4, 4), dtype=bool), 5.0), 0.03, 0.5)
    for risk_map in (even, replace(even, population_density=0.0)):
        norm = plot.risk_norm(risk_map)
        assert norm.vmax == pytest.approx(10 * norm.vmin)
    assert plot.risk_norm(even).vmax == even.rate[even.flyable].max()
    campus = reference_campus()
    rates = campus.rate[campus.flyable]
    assert (plot.risk_norm(campus).vmin, plot.risk_norm(campus).vmax) == (rates.min(), rates.max())


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda campus, route: plot.risk(campus.city, 27.5), "risk_map must be a RiskMap, got City"),
        (lambda campus, route: plot.layers(campus.city), "risk_map must be a RiskMap, got City"),
        (lambda campus, route: plot.risk(campus, route), "height must be a number"),
        (
            lambda campus, route: plot.risk(campus, 27.5, [route]),
            r"routes must be a Route, got list: .* as in \*routes",
        ),
        (lambda campus, route: plot.plan(campus, route), "city must be a City, got RiskMap: .* as its .city"),
        (lambda campus, route: plot.section(campus, 27.5), "city must be a City, got RiskMap"),
        (lambda campus, route: plot.profile(campus, route), "city must be a City, got RiskMap"),
        (lambda campus, route: scene.page(campus, route), "city must be a City, got RiskMap"),
        (lambda campus, route: scene.show(campus.city, [route]), "routes must be a Route, got list"),
        (lambda campus, route: scene.page(campus.city, risk=campus.city), "risk must be a RiskMap, got City"),
    ],
)
def test_city_and_risk_map_are_not_taken_for_one_another(draw, message, route):
    with pytest.raises(ValueError, match=message):
        draw(reference_campus(), route)


def runs_of_two_planners():
    """A comparison by hand: on 2 maps with 3 seeds, one planner halves its gap with each evaluation, one is stuck."""
    rng = np.random.default_rng(1)
    halves = 4 * rng.uniform(1, 2, (2, 3, 1)) / 2.0 ** np.arange(12) - 0.08
    stuck = np.broadcast_to(rng.uniform(0.1, 0.5, (2, 3, 1)), (2, 3, 12)).copy()
    stuck[..., :4] = np.inf
    histories = np.stack([halves, stuck])
    ends = [np.array([3, 6, 9, 12]), np.array([6, 12])]
    return Comparison(["halves", "stuck"], histories[..., -1], histories, ends, np.zeros((2, 2, 3)), [])


def test_convergence_by_evaluations_has_the_median_and_the_quartiles_in_per_cent():
    comparison = runs_of_two_planners()
    axes = plot.convergence(comparison).axes[0]
    halves, stuck = axes.lines[:2]
    runs = 100 * comparison.histories.reshape(2, 6, 12)
    assert np.array_equal(halves.get_xdata(), np.arange(1, 13))
    assert np.allclose(halves.get_ydata(), np.median(runs[0], axis=0))
    assert np.isnan(stuck.get_ydata()[:4]).all()
    assert np.allclose(stuck.get_ydata()[4:], np.median(runs[1], axis=0)[4:])
    band = axes.collections[0].get_paths()[0].vertices
    assert band[:, 1].max() == pytest.approx(np.sort(runs[0][:, 0])[4])
    assert band[:, 1].min() == pytest.approx(np.sort(runs[0][:, -1])[1])
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        "evaluations made",
        "gap to the exact optimum\n(linear to 10 %, logarithmic beyond)",
    )
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["halves", "stuck"]


def test_convergence_by_iterations_takes_each_planner_at_the_end_of_its_own():
    comparison = runs_of_two_planners()
    halves, stuck = plot.convergence(comparison, by="iterations").axes[0].lines[:2]
    assert halves.get_xdata().tolist() == [1, 2, 3, 4]
    assert stuck.get_xdata().tolist() == [1, 2]
    assert np.allclose(halves.get_ydata(), 100 * np.median(comparison.histories[0], axis=(0, 1))[[2, 5, 8, 11]])
    short = plot.convergence(comparison, by="iterations", until=2).axes[0]
    assert [line.get_xdata().tolist() for line in short.lines[:2]] == [[1, 2], [1, 2]]
    assert short.get_xlim() == (0, 2)


def test_convergence_shows_every_line_and_tells_planners_apart_by_color_and_style():
    axes = plot.convergence(runs_of_two_planners()).axes[0]
    low, high = axes.get_ylim()
    assert low < min(np.nanmin(line.get_ydata()) for line in axes.lines)
    assert high > max(np.nanmax(line.get_ydata()) for line in axes.lines)
    assert len({line.get_color() for line in axes.lines[:2]}) == len({line.get_linestyle() for line in axes.lines[:2]})
    assert axes.lines[0].get_color() != axes.lines[1].get_color()
    assert axes.lines[0].get_linestyle() != axes.lines[1].get_linestyle()


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        ({}, {"by": "seconds"}, "by must be one of 'evaluations', 'iterations', got 'seconds'"),
        ({}, {"until": 1}, "until must be"),
        ({"histories": np.full((2, 2, 3, 12), np.inf)}, {}, "comparison must have a planner with a route"),
        ({"planners": list("abcdefgh")}, {}, "at most 7 planners"),
    ],
)
def test_convergence_refuses_what_it_cannot_draw(change, arguments, message):
    with pytest.raises(ValueError, match=message):
        plot.convergence(replace(runs_of_two_planners(), **change), **arguments)
    with pytest.raises(ValueError, match=r"comparison must be a Comparison, got list: compare_planners"):
        plot.convergence([1, 2])


@pytest.fixture(scope="module")
def flights_of_astar(table1, route):
    """Six flights in offsets of 1 m beside walls: some crash, some arrive."""
    flights = [fly(route, table1, LIGHT_QUADROTOR, OffsetProcess(1.0), rng=3, number=n) for n in range(6)]
    assert {flight.outcome for flight in flights} == {"crashed", "arrived"}
    return flights


def straight_flight(outcome="arrived", seconds=1.0):
    """A flight by hand, eastwards with 5 m/s."""
    log = np.zeros((round(seconds / 0.02) + 1, len(COLUMNS)))
    log[:, 0] = np.arange(len(log)) * 0.02
    log[:, 1] = 5 * log[:, 0]
    log[:, COLUMNS.index("across")] = np.sin(log[:, 0])
    log[:, COLUMNS.index("speed")] = 5.0
    log[:, COLUMNS.index("thrust")] = 17.0 + log[:, 0]
    return Flight(outcome, "", log, 1.0, 100.0)


def test_tracks_has_a_panel_for_each_name_and_a_cross_where_each_flight_crashed(table1, route, flights_of_astar):
    crashed = [flight for flight in flights_of_astar if flight.outcome == "crashed"]
    trapped = potential_field(table1, (90, 18, 30), (50, 44, 30))
    figure = plot.tracks(
        table1, {"A*": flights_of_astar}, {"A*": route, "field": trapped}, area=(40.0, 100.0, 5.0, 65.0)
    )
    astar_axes, field_axes = figure.axes
    assert astar_axes.get_title() == f"A*: {len(crashed)} of 6 crash"
    assert field_axes.get_title() == "field: doesn't arrive"
    crosses = next(line for line in astar_axes.lines if line.get_marker() == "x")
    assert np.allclose(crosses.get_xydata(), [flight.position[-1, :2] for flight in crashed])
    drawn = [line.get_xydata() for line in astar_axes.lines]
    assert any(np.array_equal(line, track(flights_of_astar[0])[1][:, :2]) for line in drawn)
    assert any(np.array_equal(line, route.points[:, :2]) for line in drawn)
    assert (astar_axes.get_aspect(), astar_axes.get_xlim(), astar_axes.get_ylim()) == (1.0, (40, 100), (5, 65))
    assert astar_axes.get_xlabel() == "x, east [m]"
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert named == ["flown, in a colour for each panel", "planned", "crash", "start", "goal", "stopped"]


def test_track_keeps_every_fifth_of_a_second_and_the_end():
    time, places = track(straight_flight(seconds=1.06))
    assert time == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.06])
    assert places[:, 0] == pytest.approx(5 * time)


def test_crash_rates_are_points_with_intervals_on_a_scale_of_factors_and_none_seen_is_an_arrow():
    rates = {
        "calm": {"A*": Rate(700.0, 600.0, 800.0), "hazard": Rate(0.0, 0.0, 1.8)},
        "gusty": {"A*": Rate(720.0, 650.0, 790.0), "hazard": Rate(14.0, 0.0, 21.0)},
    }
    axes = plot.crash_rates(rates, least=0.1).axes[0]
    points = [tuple(line.get_xdata()) for line in axes.lines]
    for ends in ((600.0, 800.0), (650.0, 790.0), (0.1, 21.0), (700.0,), (720.0,), (14.0,)):
        assert any(len(drawn) == len(ends) and np.allclose(drawn, ends) for drawn in points)
    (arrow,) = [text for text in axes.texts if text.arrow_patch is not None]
    assert (arrow.xy[0], arrow.xyann[0]) == (0.1, 1.8)
    assert axes.get_xscale() == "log"
    assert [label.get_text() for label in axes.get_yticklabels()] == ["calm", "gusty"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["A*", "hazard"]
    colors = {line.get_label(): line.get_color() for line in axes.lines if line.get_label() in ("A*", "hazard")}
    assert len(set(colors.values())) == 2


def test_in_flight_draws_offset_speed_and_thrust_over_time_and_where_it_crashed():
    flights = {"light": straight_flight(), "heavy": straight_flight("crashed", 0.5)}
    panels = plot.in_flight(flights, **{"greatest thrust": 28.0}).axes
    for axes, column in zip(panels, ("across", "speed", "thrust"), strict=True):
        light, heavy = (line for line in axes.lines if line.get_label() in flights)
        assert np.array_equal(light.get_ydata(), flights["light"].column(column))
        assert np.array_equal(heavy.get_xdata(), flights["heavy"].time)
        (cross,) = [line for line in axes.lines if line.get_marker() == "x"]
        assert cross.get_xydata()[0] == pytest.approx((0.5, flights["heavy"].column(column)[-1]))
        assert light.get_linestyle() != heavy.get_linestyle()
    assert panels[2].get_xlabel() == "time in flight [s]"
    assert [text.get_text() for text in panels[2].texts] == ["greatest thrust"]
    assert panels[2].get_ylim()[1] > 28.0


def test_safety_domain_is_a_density_that_sums_to_one_with_the_ellipses_on_it():
    samples = np.random.default_rng(1).normal(0.0, [1.0, 0.5], (20_000, 2))
    printed, right = (safety_domain(samples, as_printed=as_printed) for as_printed in (True, False))
    axes = plot.safety_domain(samples, **{"3σ_as printed": printed, "right": right}).axes[0]
    mesh = axes.collections[0]
    density = np.ma.filled(mesh.get_array(), 0.0)
    corners = mesh.get_coordinates()
    bin_area = (corners[0, 1, 0] - corners[0, 0, 0]) * (corners[1, 0, 1] - corners[0, 0, 1])
    assert np.nansum(density) * bin_area == pytest.approx(1.0, abs=0.01)
    drawn = [line.get_xydata() for line in axes.lines]
    assert all(any(np.array_equal(line, domain.ellipse) for line in drawn) for domain in (printed, right))
    assert axes.get_legend().get_texts()[0].get_text() == f"3σ as printed: {printed.in_ellipse:.2%} inside"
    assert axes.get_aspect() == 1.0
    assert axes.get_xlim() == axes.get_ylim()


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda city, route: plot.tracks(city, {}), "flights is empty: give at least one name"),
        (lambda city, route: plot.tracks(city, {"A*": [route]}), "flights must be a Flight, got Route"),
        (lambda city, route: plot.tracks(city, {"A*": straight_flight()}), "flights must be a list of Flight"),
        (lambda city, route: plot.tracks(city, {}, {"A*": city}), r"routes\['A\*'\] must be a Route, got City"),
        (lambda city, route: plot.crash_rates({}), "rates must hold one to 7 planners, got 0"),
        (lambda city, route: plot.crash_rates({"calm": {"A*": Rate(1, 0, 2)}}, least=0.0), "least must be"),
        (
            lambda city, route: plot.crash_rates({"calm": {"A*": Rate(1, 0, 2)}}, least=1000),
            "least must be below 1,000",
        ),
        (lambda city, route: plot.crash_rates({"calm": Rate(1, 0, 2)}), r"rates\['calm'\] must be Rate by name"),
        (lambda city, route: plot.crash_rates({"calm": {"A*": 2.0}}), r"rates\['calm'\]\['A\*'\] must be a Rate"),
        (lambda city, route: plot.tracks(city, [straight_flight()]), "flights must be lists by name, .* got list"),
        (lambda city, route: plot.tracks(city, {"a": []}, []), "routes must be a Route, got list"),
        (lambda city, route: plot.in_flight({"a": straight_flight()}, most="28"), "most must be a number"),
        (lambda city, route: plot.in_flight({"a": straight_flight()}, most=np.inf), "most must be finite, got inf"),
        (lambda city, route: plot.safety_domain(np.eye(5)[:, :2], best=1.0), "best must be a SafetyDomain, got float"),
        (lambda city, route: plot.in_flight({}), "flights must hold one to 7 that flew, got 0"),
        (
            lambda city, route: plot.in_flight([fly(route, city, LIGHT_QUADROTOR, Wind((40.0, 0.0)), rng=1)]),
            "flights must hold one to 7 that flew, got 0",
        ),
        (lambda city, route: plot.safety_domain(np.zeros((5, 3))), "samples"),
    ],
)
def test_flights_that_cannot_be_drawn_are_refused(table1, route, draw, message):
    with pytest.raises(ValueError, match=message):
        draw(table1, route)


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (
            lambda city: plot.section(city, 30.0, np.ones((4, 4, 4))),
            r"values must have the city's shape \(100, 100, 100\)",
        ),
        (lambda city: plot.section(city, 30.0, city.occupied.astype(str)), "values must be .* got text"),
        (lambda city: plot.section(city, 30.0, label=3), "label must be text, got 3"),
        (lambda city: plot.section(city, 30.0, norm="log"), "norm must be a Normalize, got str: .*LogNorm"),
        (lambda city: plot.field(city, 30.0, (50, 44, 30), area=(60, 90, 20)), r"area must have shape \(4,\)"),
        (lambda city: plot.field(city, 30.0, (50, 44, 30), area=(90, 60, 20, 30)), "area must be .* from less to more"),
        (lambda city: plot.field(city, 30.0, (50, 44, 30), area=(-9, 0, 0, 9)), "area must lie on the map, 0 to 100 m"),
        (lambda city: plot.field(city, 30.0, (50, 44, 30), area=(66, 68, 20, 22)), "area must have a free point 30 m"),
        (
            lambda city: plot.field(city, 30.0, (50, 44, 30), spacing=0.01),
            "spacing must be at least 0.32 m on this area",
        ),
        (lambda city: plot.tracks(city, {"a": []}, area=(9, 9, 0, 9)), "area must be .* from less to more"),
        (lambda city: plot.tracks(city, {"a": []}, area=(0, np.nan, 0, 9)), "area must be finite, got nan"),
        (lambda city: plot.bars([1.0], "length [m]"), "values must be something by name"),
        (lambda city: plot.bars({"a": "1"}, "length [m]"), r"values\['a'\] must be a number"),
        (lambda city: plot.bars({"a": np.inf}, "length [m]"), "values must be finite, or NaN for no bar"),
        (
            lambda city: plot.bars(dict.fromkeys(map(str, range(1001)), 1.0), ""),
            "values must be at most 1,000, got 1,001",
        ),
        (lambda city: plot.bars({"a": 1.0}, None), "label must be text, got None"),
        (lambda city: plot.bars({"a": 1.0}, "", title=3), "title must be text, got 3"),
        (lambda city: plot.front([Route([(1, 1, 1), (2, 2, 2)])]), "routes must have a cost, .* RiskMap.integral"),
        (lambda city: plot.front([Route([(1, 1, 1)], cost=1.0)], 3), "marked must be a Route, got int"),
        (lambda city: plot.front([Route([(1, 1, 1)], cost=1.0)], label=3), "label must be text, got 3"),
        (lambda city: plot.draw_map(None, city, city.occupied[0], "Greys"), "axes must be an Axes, got NoneType"),
        (lambda city: plot.ground_risk(city), "risk_map must be a RiskMap, got City"),
        (lambda city: plot.risk_norm(city), "risk_map must be a RiskMap, got City"),
        (lambda city: plot.finished(None), "figure must be a Figure, got NoneType"),
        (lambda city: plot.new_figure(0, 4), "width must be finite and above 0, got 0"),
        (lambda city: plot.new_figure(6, 1e6), "height must be from 0 to 650 inches"),
    ],
)
def test_what_a_figure_cannot_show_is_refused_by_name(table1, draw, message):
    with pytest.raises(ValueError, match=message):
        draw(table1)


@pytest.mark.parametrize(
    ("values", "colors", "limits", "message"),
    [
        (np.ones((3, 3)), "Greys", {}, r"values must have shape \(100, 100\), got \(3, 3\)"),
        (
            np.ones((100, 100)),
            "greyish",
            {},
            "colors must be a colour map of matplotlib or the name of one, got 'greyish'",
        ),
        (np.ones((100, 100)), 3, {}, "colors must be a colour map"),
        (np.ones((100, 100)), "Greys", {"vmin": "0"}, "vmin must be a number"),
        (np.ones((100, 100)), "Greys", {"vmax": np.nan}, "vmax must be finite, got nan"),
    ],
)
def test_a_map_says_what_it_cannot_draw(table1, values, colors, limits, message):
    figure, axes = plot.new_figure(4.0, 3.0)
    with pytest.raises(ValueError, match=message):
        plot.draw_map(axes, table1, values, colors, **limits)
    plot.finished(figure)


def test_what_is_masked_is_not_drawn(table1):
    hidden = np.arange(10_000).reshape(100, 100) % 2 == 0
    figure, axes = plot.new_figure(4.0, 3.0)
    image = plot.draw_map(axes, table1, np.ma.masked_array(np.ones((100, 100)), hidden), "Greys")
    plot.finished(figure)
    assert (np.ma.getmaskarray(np.ma.masked_invalid(image.get_array())) == hidden.T).all()


def test_a_profile_counts_heights_from_level_ground():
    high = City(np.zeros((20, 10, 10), bool), origin=(0.0, 0.0, 120.0))
    figure = plot.profile(high, Route([(1, 5, 123.0), (18, 5, 127.0)]))
    assert figure.axes[0].lines[0].get_ydata() == pytest.approx([3.0, 7.0])
    assert figure.axes[0].get_ylabel() == "height above the ground [m]"
