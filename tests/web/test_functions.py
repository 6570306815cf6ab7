"""The functions of `planners.wasm`, run in Python, against the public ones: one case each.

`test_planners_wasm.py` has hundreds in a browser. What fails there and not here is for the build or the page to mend.
"""

import numpy as np
import pytest
from agreement import (
    Risk,
    astar_agrees,
    curve_agrees,
    field_agrees,
    flight_agrees,
    hazard_agrees,
    integral_agrees,
    least_risk_agrees,
    nearest_agrees,
    repare_agrees,
    set_hazard,
    set_repare,
    set_zone,
    theta_agrees,
    zone_agrees,
)
from sides import InPython, Town
from towns import with_zones

from uavlab.flight import PERFECT_GPS, Autopilot, fly
from uavlab.planners import astar
from uavlab.resilience import ADVANCED, ConditionCheck, Monitor
from uavlab.risk import CAMPUS_FLIGHT, random_campus
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind
from uavlab.web import functions
from uavlab.web.craft import CRAFT, craft_of

ENDS = (5.0, 5.0, 30.0), (95.0, 95.0, 30.0)


@pytest.fixture(scope="module")
def town():
    return Town(InPython(), with_zones())


@pytest.fixture(scope="module")
def fine(table1):
    return Town(InPython(), table1)


def test_clearance_and_where_a_route_may_not_be(town):
    assert np.array_equal(town.clearance, town.city.clearance)
    for min_clearance in (0.0, 2.5, 3.0):
        assert np.array_equal(town.blocked(min_clearance), town.city.blocked(min_clearance))
    for mine, own in zip(town.walls, town.city.runs[1:], strict=True):
        assert np.array_equal(mine, own)


def test_astar(town):
    assert astar_agrees(town, *ENDS, "octile", 2.0).reached


def test_astar_with_a_penalty_zone(town):
    price = set_zone(town, 4.0, 1.3)
    assert zone_agrees(town, *ENDS, price, "euclidean").reached


def test_hazard_astar(town):
    asked = 0.8, 1.0, 5.0, 1.2
    set_hazard(town, *asked)
    assert hazard_agrees(town, *ENDS, *asked) == [True, True]


def test_repare(fine):
    set_repare(fine, "moderate", "mild")
    repare_agrees(fine, *ENDS, "moderate", "mild")


def test_theta_star(town):
    assert theta_agrees(town, *ENDS, 2.0).reached


@pytest.mark.parametrize("free", [False, True])
def test_potential_field(town, free):
    assert field_agrees(town, (5.0, 5.0, 30.0), (5.0, 95.0, 30.0), free, 5.0, 5.0).reached


def test_least_risk():
    campus = random_campus(3)
    risk = Risk(Town(InPython(), campus.city), campus, (1.0, 1e-7, 0.0, False))
    assert least_risk_agrees(risk, *CAMPUS_FLIGHT).reached


def test_integral(town):
    integral_agrees(town, *ENDS, np.random.default_rng(1).random(town.city.shape))


def test_the_nearest_free_point(town):
    nearest_agrees(town, town.city.center_of(np.argwhere(town.city.occupied)[100]), 3.0)


def test_curve(town):
    curve_agrees(town, [(5, 5, 30), (20, 5, 32), (25, 9, 35), (20, 30, 30)], 0.3)


def test_fly(fine):
    route, wind, autopilot = astar(fine.city, (5, 5, 30), (30, 5, 30)), Wind((3, 4), rain_mm_per_h=8.0), Autopilot()
    flight = fly(route, fine.city, LIGHT_QUADROTOR, wind, autopilot, rng=7, number=1)
    flight_agrees(fine, route, LIGHT_QUADROTOR, wind, autopilot, flight, np.random.default_rng(7).spawn(2)[1])


def test_craft_is_what_a_vehicle_and_its_autopilot_are():
    autopilot = Autopilot(gps=PERFECT_GPS._replace(drift=3.0, vertical_drift=2.0), controller=ADVANCED)
    craft = dict(zip(CRAFT, craft_of(LIGHT_QUADROTOR, Wind((3, 0), air_density=1.1), autopilot, 0.01), strict=True))
    assert craft["mass"] == pytest.approx(LIGHT_QUADROTOR.mass)
    assert craft["drag"] == pytest.approx(0.5 * 1.1 * LIGHT_QUADROTOR.drag_area)
    assert craft["tan_tilt"] == pytest.approx(np.tan(ADVANCED.tilt_share * LIGHT_QUADROTOR.max_tilt))
    assert craft["gps_level"] / craft["gps_up"] == pytest.approx(1.5)
    assert (craft["gps_velocity"], craft["gps_fixes"]) == (0.0, 0.1)
    assert (craft["omega"], craft["pace"]) == (ADVANCED.natural_frequency, ADVANCED.speed_share)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"uav": "light"}, "uav"),
        ({"wind": 3.0}, "wind"),
        ({"wind": Wind((3, 0), gusts="dryden")}, 'wind must have gusts="ou"'),
        ({"autopilot": None}, "autopilot"),
        ({"autopilot": Autopilot(trimmed=False)}, "autopilot must know the mean wind"),
        (
            {"autopilot": Autopilot(monitor=Monitor(ConditionCheck(1.6), uav_diameter=1.0))},
            "autopilot must have no mon",
        ),
        ({"time_step": 0.0}, "time_step"),
    ],
)
def test_craft_refuses_what_a_page_can_t_fly(changed, message):
    with pytest.raises(ValueError, match=message):
        craft_of(
            **({"uav": LIGHT_QUADROTOR, "wind": Wind((3, 0)), "autopilot": Autopilot(), "time_step": 0.02} | changed)
        )


def test_names_of_answers_are_those_of_their_places():
    assert [getattr(functions, name.upper()) for name in functions.ANSWERS] == list(range(len(functions.ANSWERS)))
