"""What a UAV can fly: forces on circles, dips and straight lines against closed forms, and the table of limits."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

from uavlab.city import City, NoFlyZone
from uavlab.spline import Curve, Feasibility, feasibility, greatest_speed, tilted_thrust
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR, RISK_QUADROTOR
from uavlab.weather.forces import STANDARD_AIR

OPEN = City(np.zeros((40, 40, 40), bool), cell=5.0)
SWIFT = replace(RISK_QUADROTOR, drag_area=0.00564, top_speed=20.0, climb_speed=np.inf, sink_speed=np.inf)
SLIPPERY = replace(SWIFT, drag_area=1e-12)
MASS = SWIFT.weight / GRAVITY

NAMES = ["clearance", "map", "height", "curvature", "pitch", "thrust", "tilt", "air speed"]


def circle(radius, height=20.0, count=73, turn=5.0):
    """A level circle, to 0.13 % of its radius; without its straight ends `count` − 3 segments of it are left."""
    angle = np.radians(turn) * np.arange(count)
    out = radius * 3 / (2 + np.cos(np.radians(turn)))
    return Curve(np.stack([100 + out * np.cos(angle), 100 + out * np.sin(angle), 0 * angle + height], axis=1), step=0.2)


def inner(curve):
    """Which of its points are not on the first or the last segment, which run out straight."""
    return (curve.parameter >= 1) & (curve.parameter <= curve.parameter[-1] - 1)


def straight(direction=(1.0, 0.0, 0.0), length=50.0):
    start = np.array([20.0, 100.0, 50.0])
    return Curve(start + np.linspace(0, length, 6)[:, None] * np.array(direction) / np.linalg.norm(direction))


def upright(radius, sign):
    """The upper half of a vertical circle, or the lower one."""
    angle = np.radians(5.0) * np.arange(5, 32)
    out = radius * 3 / (2 + np.cos(np.radians(5.0)))
    return Curve(np.stack([out * np.cos(angle), 0 * angle, sign * out * np.sin(angle)], axis=1) + 50.0, step=0.1)


def corner(times):
    return Curve([(20, 20, 20), *[(50, 20, 20)] * times, (50, 50, 20)])


@pytest.mark.parametrize("speed", [3.0, 8.0, 16.0])
@pytest.mark.parametrize("radius", [5.0, 20.0, 60.0])
def test_without_drag_a_level_circle_takes_the_weight_and_v_squared_over_r(radius, speed):
    curve = circle(radius)
    thrust, tilt = (values[inner(curve)] for values in tilted_thrust(curve, SLIPPERY, speed))
    across = speed**2 / radius
    assert thrust == pytest.approx(np.full(len(thrust), MASS * np.hypot(GRAVITY, across)), rel=3e-3)
    assert np.tan(tilt) == pytest.approx(np.full(len(tilt), across / GRAVITY), rel=3e-3)


@pytest.mark.parametrize("radius", [5.0, 20.0])
@pytest.mark.parametrize("wind", [(0.0, 0.0), (6.0, -2.0), (0.0, 9.0, 1.5)])
def test_drag_on_a_level_circle_is_that_of_the_air_that_comes_towards_it(radius, wind):
    """T = m(g ẑ + v²/r·inwards) − ½ρCS|w − v|(w − v), at every angle of the circle."""
    uav, speed, curve = LIGHT_QUADROTOR, 7.0, circle(radius)
    here = inner(curve)
    outwards = (curve.points[here] - (100, 100, 20)) / radius
    forwards = np.stack([-outwards[:, 1], outwards[:, 0], 0 * outwards[:, 2]], axis=1)
    relative = np.array((*wind, 0.0)[:3]) - speed * forwards
    drag = 0.5 * STANDARD_AIR * uav.drag_area * np.linalg.norm(relative, axis=1, keepdims=True) * relative
    needed = uav.mass * (np.array([0, 0, GRAVITY]) - speed**2 / radius * outwards) - drag
    thrust, tilt = tilted_thrust(curve, uav, speed, wind)
    assert thrust[here] == pytest.approx(np.linalg.norm(needed, axis=1), rel=5e-3)
    upright = needed[:, 2] / np.linalg.norm(needed, axis=1)
    assert np.cos(tilt[here]) == pytest.approx(upright, abs=5e-3)


@pytest.mark.parametrize("uav", [SWIFT, LIGHT_QUADROTOR, LIGHT_QUADROTOR.loaded(0.6)])
def test_on_a_straight_line_thrust_holds_weight_and_drag(uav):
    drag = 0.5 * STANDARD_AIR * uav.drag_area * 10.0**2
    thrust, tilt = tilted_thrust(straight(), uav, 10.0)
    assert thrust == pytest.approx(np.full(len(thrust), np.hypot(uav.weight, drag)), rel=1e-9)
    assert tilt == pytest.approx(np.full(len(tilt), np.arctan(drag / uav.weight)), rel=1e-9)


def test_with_the_wind_as_fast_as_the_wind_it_is_like_hover():
    thrust, tilt = tilted_thrust(straight((3, 4, 0)), LIGHT_QUADROTOR, 5.0, wind=(3.0, 4.0))
    assert thrust == pytest.approx(np.full(len(thrust), LIGHT_QUADROTOR.weight), rel=1e-9)
    assert tilt == pytest.approx(np.zeros(len(tilt)), abs=1e-9)


@pytest.mark.parametrize(("sign", "name"), [(1, "dip"), (-1, "hump")])
def test_a_dip_takes_more_thrust_and_a_hump_less(sign, name):
    """At the lowest point of a vertical turn m(g + v²/r), at the highest m(g − v²/r), both without tilt."""
    curve = upright(30.0, -sign)
    level = np.argmin(np.abs(curve.pitch))
    speed = 8.0
    thrust, tilt = tilted_thrust(curve, SLIPPERY, speed)
    assert thrust[level] == pytest.approx(MASS * (GRAVITY + sign * speed**2 / 30), rel=5e-3), name
    assert tilt[level] == pytest.approx(0, abs=0.02)


def test_faster_than_a_hump_allows_the_thrust_points_down():
    curve = upright(5.0, 1)
    level = np.argmin(np.abs(curve.pitch))
    assert tilted_thrust(curve, SLIPPERY, 16.0)[1][level] == pytest.approx(np.pi, abs=0.1)


def test_at_a_corner_thrust_is_infinite_and_nothing_warns():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        thrust, tilt = tilted_thrust(corner(3), SWIFT, 1.0)
        assert np.isinf(thrust).sum() == 1
        assert np.degrees(tilt[np.isinf(thrust)]) == pytest.approx(90)
        report = feasibility(corner(3), OPEN, SWIFT, speed=1.0)
    assert not report.feasible
    for name in ("curvature", "thrust"):
        assert report[name].worst == np.inf
        assert report[name].place == pytest.approx((50, 20, 20))


def test_a_straight_level_flight_meets_all_limits():
    report = feasibility(straight(), OPEN, SWIFT)
    assert isinstance(report, Feasibility)
    assert report.feasible
    assert report.speed == SWIFT.cruise_speed
    assert [limit.name for limit in report.limits] == NAMES
    assert all(limit.met for limit in report.limits)
    assert report["clearance"].worst == np.inf
    assert report["curvature"].worst == pytest.approx(0, abs=1e-12)
    assert report["pitch"].worst == 0


@pytest.mark.parametrize("bank", [20.0, 30.0, 45.0])
@pytest.mark.parametrize("speed", [4.0, 16.0])
def test_curvature_is_limited_to_what_the_bank_holds_at_that_speed(speed, bank):
    curve = circle(20.0)
    row = feasibility(curve, OPEN, SWIFT, speed=speed, bank=np.radians(bank))["curvature"]
    assert row.limit == pytest.approx(GRAVITY * np.tan(np.radians(bank)) / speed**2)
    assert row.unit == "1/m"
    assert row.worst == curve.level_curvature.max() == pytest.approx(1 / 20, rel=3e-3)
    assert row.met == (speed == 4.0)


def test_only_the_level_part_of_the_curvature_is_held_by_the_bank():
    curve = Curve([(20, 50, 50), (25, 50, 50), (30, 50, 52), (35, 50, 56)])
    report = feasibility(curve, OPEN, SWIFT, speed=3.0)
    assert report["curvature"].worst == curve.level_curvature.max()
    assert report["curvature"].worst < 0.5 * curve.curvature.max()


@pytest.mark.parametrize("gap", [0.15, 0.5, 2.0])
def test_clearance_is_least_where_the_curve_passes_the_box(gap):
    occupied = np.zeros((40, 20, 10), bool)
    occupied[25, 5, 5] = True
    curve = Curve([(2, 6 + gap, 5.5), (20, 6 + gap, 5.5), (38, 6 + gap, 5.5)], step=0.02)
    report = feasibility(curve, City(occupied), SWIFT, speed=5.0)
    row = report["clearance"]
    assert row.at_least
    assert row.limit == pytest.approx(0.98 * SWIFT.diameter / 2)  # the contact that `smooth` allows
    assert row.met == report.feasible == (gap > 0.2)
    if gap <= 0.5:  # beyond what is asked for by a voxel, the distance is a lower bound only
        assert row.worst == pytest.approx(gap, abs=1e-3)
        assert 25 - 0.1 <= row.place[0] <= 26
        assert row.distance == pytest.approx(row.place[0] - 2, abs=1e-6)
    assert row.worst <= gap
    asked = feasibility(curve, City(occupied), SWIFT, speed=5.0, min_clearance=gap + 0.3)["clearance"]
    assert (asked.limit, asked.met) == (gap + 0.3, False)
    assert asked.worst == pytest.approx(gap, abs=1e-3)


@pytest.mark.parametrize(("climb", "steepest", "met"), [(45.0, 60.0, True), (-45.0, 60.0, True), (-45.0, 30.0, False)])
def test_pitch_counts_up_and_down(climb, steepest, met):
    curve = straight((1, 0, np.tan(np.radians(climb))))
    row = feasibility(curve, OPEN, SWIFT, speed=5.0, max_pitch=np.radians(steepest))["pitch"]
    assert (row.unit, row.met) == ("°", met)
    assert row.worst == pytest.approx(45)
    assert row.limit == pytest.approx(steepest)


def test_the_limit_of_pitch_is_by_default_that_of_the_paper():
    assert feasibility(straight(), OPEN, SWIFT)["pitch"].limit == pytest.approx(60)


def test_thrust_tilt_and_air_speed_are_the_worst_along_the_curve():
    curve, wind = circle(40.0), (5.0, 3.0)
    report = feasibility(curve, OPEN, LIGHT_QUADROTOR, speed=9.0, wind=wind)
    thrust, tilt = tilted_thrust(curve, LIGHT_QUADROTOR, 9.0, wind)
    assert report["thrust"].worst == thrust.max()
    assert report["tilt"].worst == pytest.approx(np.degrees(tilt.max()))
    assert (report["thrust"].limit, report["tilt"].limit) == (28.0, pytest.approx(60))
    head_on = np.argmax(np.linalg.norm(9.0 * curve.tangent - (5, 3, 0), axis=1))
    assert report["air speed"].worst == pytest.approx(9.0 + np.hypot(5, 3), rel=1e-3)
    assert report["air speed"].limit == LIGHT_QUADROTOR.top_speed
    assert report["air speed"].place == tuple(curve.points[head_on])
    assert report["air speed"].distance == curve.distance[head_on]
    assert curve.tangent[head_on] @ (5, 3, 0) == pytest.approx(-np.hypot(5, 3), rel=1e-2)


@pytest.mark.parametrize(
    ("wind", "worst"), [((0, 0), 16), ((-6, 0), 22), ((10, 0), 6), ((0, 12, 0), 20), ((0, 0, 5), 16.7631)]
)
def test_air_speed_is_that_against_the_wind(wind, worst):
    row = feasibility(straight(), OPEN, SWIFT, wind=wind)["air speed"]
    assert row.worst == pytest.approx(worst, rel=1e-5)
    assert row.met == (worst <= 20)


def test_one_limit_that_is_not_met_is_enough():
    report = feasibility(straight(), OPEN, SWIFT, wind=(-6, 0))
    assert [limit.name for limit in report.limits if not limit.met] == ["air speed"]
    assert not report.feasible


def test_as_printed_the_check_passes_what_nobody_flies_at_that_speed():
    """A circle of 5 m is a curvature of 0.2 per voxel of 1 m; at 16 m/s it takes 5.3 times the weight."""
    city = City(np.zeros((200, 200, 40), bool))
    curve = circle(5.0)
    printed = feasibility(curve, city, SWIFT, as_printed=True)
    assert printed.feasible
    assert [(limit.name, limit.unit, limit.limit) for limit in printed.limits] == [
        ("curvature in plan", "per voxel", 1.0),
        ("heading change", "° per voxel", pytest.approx(60)),
        ("pitch", "°", pytest.approx(60)),
    ]
    assert printed["heading change"].worst == pytest.approx(np.degrees(1 / 5), rel=0.05)
    assert printed["curvature in plan"].worst == pytest.approx(0.2, rel=3e-3)
    right = feasibility(curve, city, SWIFT)
    assert [limit.name for limit in right.limits if not limit.met] == ["curvature", "thrust", "tilt"]
    assert right["thrust"].worst / SWIFT.weight == pytest.approx(np.hypot(1, 16**2 / 5 / GRAVITY), rel=5e-3)
    slow = feasibility(curve, city, SWIFT, speed=3.0, as_printed=True)
    assert slow.limits == printed.limits  # it doesn't know the speed


@pytest.mark.parametrize("cell", [1.0, 4.0, 6.0])
def test_as_printed_a_curve_is_the_less_flyable_the_larger_the_voxels(cell):
    row = feasibility(circle(5.0), City(np.zeros((40, 40, 10), bool), cell), SWIFT, as_printed=True)[
        "curvature in plan"
    ]
    assert row.worst == pytest.approx(cell / 5, rel=3e-3)
    assert row.met == (cell < 5)


@pytest.mark.parametrize("uav", [SWIFT, LIGHT_QUADROTOR])
@pytest.mark.parametrize("wind", [(0.0, 0.0), (4.0, -3.0), (0.0, 0.0, 2.0)])
@pytest.mark.parametrize("radius", [2.0, 10.0, 40.0])
def test_feasibility_flips_at_the_greatest_speed(uav, wind, radius):
    curve = circle(radius)
    speed = greatest_speed(curve, uav, wind)
    assert speed > 0
    assert feasibility(curve, OPEN, uav, speed=speed, wind=wind).feasible
    assert not feasibility(curve, OPEN, uav, speed=speed + 0.0011, wind=wind).feasible


@pytest.mark.parametrize("bank", [10.0, 25.0])
def test_on_a_circle_without_wind_the_bank_limits_the_greatest_speed(bank):
    speed = greatest_speed(circle(10.0), SWIFT, bank=np.radians(bank))
    assert speed == pytest.approx(np.sqrt(GRAVITY * 10 * np.tan(np.radians(bank))), rel=3e-3)


def test_on_a_circle_where_the_bank_would_allow_more_the_tilt_limits_the_greatest_speed():
    speed = greatest_speed(circle(10.0), SLIPPERY, bank=np.radians(45))
    assert speed == pytest.approx(np.sqrt(GRAVITY * 10 * np.tan(SLIPPERY.max_tilt)), rel=3e-3)


def test_where_bank_and_tilt_would_allow_more_the_thrust_limits_the_greatest_speed():
    """T² = m²(g² + v⁴/r²)."""
    weak = replace(SLIPPERY, thrust=1.1 * SLIPPERY.weight)
    speed = greatest_speed(circle(10.0), weak, bank=np.radians(45))
    assert speed == pytest.approx(np.sqrt(GRAVITY * 10 * np.sqrt(1.1**2 - 1)), rel=3e-3)


def test_on_a_straight_line_the_top_speed_in_the_air_limits_the_greatest_speed():
    for wind, most in (((0, 0), 20), ((-5, 0), 15), ((5, 0), 25), ((25, 0), 45), ((0, 12), 16)):
        assert greatest_speed(straight(), SWIFT, wind) == pytest.approx(most, abs=0.0011)
    assert greatest_speed(straight(), SWIFT, (-21, 0)) == 0


def test_at_a_corner_no_speed_is_slow_enough():
    assert greatest_speed(corner(3), SWIFT) == 0
    assert greatest_speed(corner(2), SWIFT) > 0
    assert greatest_speed(corner(2), SWIFT) < greatest_speed(corner(1), SWIFT)


def test_what_can_t_be_held_in_the_wind_flies_at_no_speed():
    heavy = LIGHT_QUADROTOR.loaded(1.2)
    assert greatest_speed(circle(40.0), heavy, (17.0, 0)) == 0
    assert greatest_speed(circle(40.0), LIGHT_QUADROTOR, (17.0, 0)) > 0


def test_in_a_strong_tail_wind_the_speeds_that_work_begin_above_0():
    """Before: 0, "when there is none"; hovering in it takes more thrust than there is, flying with it hardly any."""
    slow = replace(LIGHT_QUADROTOR.loaded(0.83), cruise_speed=5.0, top_speed=11.9)
    speed, wind = greatest_speed(straight(), slow, (38.9, 0)), (38.9, 0)
    assert speed == pytest.approx(50.8, abs=0.1)
    assert feasibility(straight(), OPEN, slow, speed=speed, wind=wind, bank=np.pi / 4).feasible
    assert not feasibility(straight(), OPEN, slow, speed=speed + 0.01, wind=wind, bank=np.pi / 4).feasible
    assert not feasibility(straight(), OPEN, slow, speed=20.0, wind=wind).feasible


def through(*points):
    """A curve through points, to a millimetre: straight lines between points that stand three times."""
    return Curve(np.repeat(np.array(points, dtype=float), 3, axis=0))


@pytest.mark.parametrize(
    ("point", "inside"),
    [((100, 100, -57), -57), ((-80, 100, 50), -80), ((100, 203, 50), -3), ((100, 100, 199), 1), ((100, 100, 60), 20)],
)
def test_outside_of_the_map_nothing_may_fly(point, inside):
    """Before, a curve 57 m below the ground or 80 m beside the map was feasible."""
    report = feasibility(through((20, 100, 50), point), OPEN, RISK_QUADROTOR, speed=0.5, max_pitch=np.pi / 2)
    assert report["map"].worst == pytest.approx(inside, abs=1e-6)
    assert report["map"].met == (inside >= 0)
    assert report["map"].place == pytest.approx(point if inside != 20 else (20, 100, 50), abs=0.2)


def hilly(seed=0):
    """Rough ground, two houses and a floating block on it."""
    rng = np.random.default_rng(seed)
    ground = 5.0 + 4.0 * rng.random((41, 41))
    occupied = np.zeros((40, 40, 40), bool)
    occupied[10:14, 10:30, :6], occupied[25:29, 5:35, :4], occupied[18:21, 18:22, 5:7] = True, True, True
    return City(occupied, cell=5.0, ground=ground[:40, :40])


@pytest.mark.parametrize("seed", range(6))
def test_heights_are_those_above_each_column_that_the_curve_passes(seed):
    """Against points a centimetre apart: never more than the least of them, and hardly less."""
    city, rng = hilly(seed), np.random.default_rng(seed)
    curve = Curve(rng.uniform([10, 10, 30], [190, 190, 90], (7, 3)), step=0.5)
    report = feasibility(curve, city, RISK_QUADROTOR, min_height=20.0, max_height=60.0, safe_height=12.0)
    points = replace(curve, step=0.01).points
    i, j, k = ((points - city.origin) // city.cell).astype(int).T
    lowest, highest = (layer[i, j] for layer in city.range_of_ground)
    least = (points[:, 2] - highest).min(), (points[:, 2] - city.surface_below[i, j, k]).min()
    assert least[0] - 0.6 < report["height"].worst <= least[0] + 1e-9
    assert least[1] - 0.6 < report["height above roofs"].worst <= least[1] + 1e-9
    assert -1e-9 <= report["height at most"].worst - (points[:, 2] - lowest).max() < 0.6
    assert report["height"].met == (report["height"].worst >= 20)
    assert report["height above roofs"].met == (report["height above roofs"].worst >= 12)


def test_a_no_fly_zone_is_a_limit_where_there_is_one():
    closed = replace(OPEN, no_fly=(NoFlyZone(np.array([(90, 90), (110, 90), (110, 110), (90, 110)]), name="dome"),))
    report = feasibility(straight(length=150), closed, RISK_QUADROTOR)
    assert not report["distance to no-fly zones"].met
    assert feasibility(straight(length=60), closed, RISK_QUADROTOR)["distance to no-fly zones"].worst == 10.0
    assert "distance to no-fly zones" not in [limit.name for limit in feasibility(straight(), OPEN, SWIFT).limits]


@pytest.mark.parametrize(("rise", "name"), [(1.0, "climb rate"), (-0.8, "sink rate")])
def test_climb_and_descent_are_limited_by_what_the_uav_can(rise, name):
    curve = straight((1.0, 0.0, rise))
    vertical = 8.0 * abs(rise) / np.hypot(1, rise)
    report = feasibility(curve, OPEN, RISK_QUADROTOR, speed=8.0)
    assert report[name].worst == pytest.approx(vertical)
    assert report[name].limit == {"climb rate": 6.0, "sink rate": 4.0}[name]
    assert report.feasible == (vertical <= report[name].limit)
    assert greatest_speed(curve, RISK_QUADROTOR) == pytest.approx(report[name].limit / vertical * 8.0, abs=0.0011)


@pytest.mark.parametrize("radius", [4.0, 8.0])
def test_the_heading_changes_by_the_voxel_over_the_radius(radius):
    cell = 2.0
    city = City(np.zeros((100, 100, 20), bool), cell)
    row = feasibility(circle(radius), city, SWIFT, max_turn=np.radians(20))["heading change"]
    assert row.worst == pytest.approx(np.degrees(cell / radius), rel=0.06)
    assert row.met == (radius == 8.0)
    up = through((20, 20, 10), (20, 20, 30), (40, 20, 30))
    assert feasibility(up, OPEN, SWIFT, max_turn=1.0, max_pitch=np.pi / 2)["heading change"].worst == 0


def test_the_printed_curvature_names_its_reading():
    """On a helix the plan is a circle of 1/r, the track in space bends r/(r² + c²) only; in a dip it is reversed."""
    angle = np.radians(5) * np.arange(100)
    helix = Curve(np.column_stack([100 + 5 * np.cos(angle), 100 + 5 * np.sin(angle), 50 + 5 * angle]), step=0.1)
    city = City(np.zeros((200, 200, 200), bool))
    plan, space = (feasibility(helix, city, SWIFT, as_printed=True, reading=by) for by in ("plan", "space"))
    middle = len(helix.points) // 2
    assert plan["curvature in plan"].worst == pytest.approx(1 / 5, rel=0.02)
    assert helix.curvature[middle] == pytest.approx(5 / 50, rel=0.02)
    assert space["curvature in space"].worst == pytest.approx(helix.curvature.max())
    dip = Curve([(20, 20, 30), (40, 20, 30), (50, 20, 20), (60, 20, 30), (80, 20, 30)])
    assert feasibility(dip, city, SWIFT, as_printed=True)["curvature in plan"].worst == pytest.approx(0, abs=1e-9)
    assert feasibility(dip, city, SWIFT, as_printed=True, reading="space")["curvature in space"].worst > 0.05
    for by in ("plan", "space"):
        sharp = feasibility(corner(3), city, SWIFT, as_printed=True, reading=by)
        assert sharp[f"curvature in {by}"].worst == np.inf


def test_the_report_is_a_table_to_print():
    report = feasibility(circle(5.0), OPEN, SWIFT)
    lines = str(report).splitlines()
    assert lines[0].split() == ["limit", "at", "16", "m/s", "worst", "after,", "at", "met"]
    assert [line.split("  ")[0] for line in lines[1:]] == NAMES
    by_name = dict(zip(NAMES, lines[1:], strict=True))
    row = report["curvature"]
    assert "<= 0.0221 1/m" in by_name["curvature"]
    assert f"{row.worst:.3g} 1/m" in by_name["curvature"]
    assert f"{row.distance:.1f} m, (" in by_name["curvature"]
    assert by_name["curvature"].endswith("NO")
    assert ">= 0.196 m" in by_name["clearance"]
    assert by_name["pitch"].endswith("yes")
    assert (
        len({line.index(entry) for line, entry in zip(lines[1:], [row[1] for row in report.rows()], strict=True)}) == 1
    )


def test_the_report_is_a_table_in_a_notebook():
    report = feasibility(circle(5.0), OPEN, SWIFT)
    page = report._repr_html_()
    assert page.startswith("<table>")
    assert page.endswith("</table>")
    assert page.count("<tr>") == page.count("</tr>") == 1 + len(NAMES)
    assert page.count("<th>") == 5
    cells = re.findall(r"<td>(.*?)</td>", page)
    assert cells == [cell.replace("<=", "≤").replace(">=", "≥") for row in report.rows() for cell in row]
    str(report).encode("cp1252")  # a terminal of Windows can print it


def test_an_unknown_limit_is_refused_with_those_that_are():
    with pytest.raises(ValueError, match=r"name must be one of 'clearance', 'map', 'height', .* got 'comfort'"):
        feasibility(straight(), OPEN, SWIFT)["comfort"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"curve": [(0, 0, 0), (1, 1, 1)]}, "curve must be a Curve, got list: smooth(route, city, uav) makes one"),
        ({"uav": "quadrotor"}, "uav must be a UAV, got str"),
        ({"city": None}, "city must be a City, got NoneType"),
        ({"speed": 0.0}, "speed must be finite and above 0, got 0"),
        ({"speed": np.nan}, "speed must be finite and above 0, got nan"),
        ({"speed": [5.0, 6.0]}, "speed must be one number, got an array of shape (2,)"),
        ({"wind": 5.0}, "wind must be two or three finite numbers"),
        ({"wind": (1, np.nan)}, "wind must be two or three finite numbers"),
        ({"bank": 30.0}, "rad (from degrees: numpy.radians), got 30"),
        ({"bank": 0.0}, "bank must be from"),
        ({"max_pitch": 60.0}, "rad (from degrees: numpy.radians), got 60"),
        ({"max_pitch": 0.0}, "max_pitch must be finite and above 0"),
        ({"min_clearance": -0.1}, "min_clearance must be finite and at least 0, got -0.1"),
        ({"min_clearance": np.inf}, "min_clearance must be finite and at least 0, got inf"),
        ({"as_printed": True, "max_pitch": 60.0}, "max_pitch must be from"),
        ({"as_printed": True, "bank": 30.0}, "bank must be from"),
        ({"as_printed": True, "wind": 5.0}, "wind must be two or three finite numbers"),
        ({"as_printed": True, "max_height": -1.0}, "max_height must be above min_height (0 m), got -1.0"),
        ({"max_turn": 60.0}, "max_turn must be from"),
        ({"as_printed": True, "max_turn": 0.0}, "max_turn must be finite and above 0"),
        ({"reading": "level"}, "reading must be one of 'plan', 'space', got 'level'"),
        ({"min_height": -1.0}, "min_height must be"),
        ({"safe_height": np.nan}, "safe_height must be finite and at least 0"),
    ],
)
def test_wrong_questions_about_feasibility_are_refused(arguments, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        feasibility(**({"curve": straight(), "uav": SWIFT, "city": OPEN} | arguments))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: greatest_speed("curve", SWIFT), "curve must be a Curve, got str"),
        (lambda: greatest_speed(straight(), 1.38), "uav must be a UAV, got float"),
        (lambda: greatest_speed(straight(), SWIFT, (1, 2, 3, 4)), "wind must be two or three finite numbers"),
        (lambda: greatest_speed(straight(), SWIFT, bank=30), "rad (from degrees: numpy.radians), got 30"),
        (lambda: tilted_thrust("curve", SWIFT, 5.0), "curve must be a Curve, got str"),
        (lambda: tilted_thrust(straight(), None, 5.0), "uav must be a UAV, got NoneType"),
        (lambda: tilted_thrust(straight(), SWIFT, 0.0), "speed must be finite and above 0, got 0"),
        (lambda: tilted_thrust(straight(), SWIFT, 5.0, np.inf), "wind must be two or three finite numbers"),
    ],
)
def test_wrong_questions_about_speed_and_thrust_are_refused(call, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        call()


def test_what_is_none_is_no_minus_none():
    """A level curve neither climbs nor sinks; its sink rate would read −0 m/s."""
    report = feasibility(straight(), OPEN, replace(SWIFT, climb_speed=5.0, sink_speed=4.0))
    assert "-0 " not in str(report)
    assert repr(report["sink rate"]) == "<Limit sink rate: 0 m/s, at most 4, met>"
