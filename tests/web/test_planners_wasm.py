"""Planners, measures and flights of `planners.wasm` in a real browser against the public functions, on random cases."""

import dataclasses

import numpy as np
import pytest
from agreement import (
    NEARLY,
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
    way_of,
    zone_agrees,
)
from sides import InBrowser, Town
from towns import random_city, random_ends, small_cities, with_zones

from uavlab.city import City
from uavlab.flight import PERFECT_GPS, Autopilot, fly, monte_carlo
from uavlab.flight.simulation import setup_of
from uavlab.planners import astar, penalty_zone, theta_star
from uavlab.planners.risk_question import MAX_TURN
from uavlab.resilience import ADVANCED
from uavlab.risk import CAMPUS_FLIGHT, random_campus
from uavlab.spline.limits import MAX_PITCH
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR
from uavlab.weather import Wind
from uavlab.web.craft import craft_of, state_of

FINE, COARSE = 100, 10
"""Pairs in Table 1's city at 1 m, and in each of the small cities."""


@pytest.fixture(scope="module")
def side(browser):
    page = browser.new_page()
    problems = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    yield InBrowser(page)
    page.close()
    assert problems == []


@pytest.fixture(scope="module")
def fine(side, table1):
    return Town(side, table1)


@pytest.fixture(scope="module")
def small(side):
    """With no-fly zones, and random ones."""
    return [Town(side, city) for city in small_cities()]


def test_clearance_and_where_a_route_may_not_be(fine, small):
    for town in (fine, *small):
        assert np.array_equal(town.side.values(town.clearance), town.city.clearance)
        for mine, own in zip(town.walls, town.city.runs[1:], strict=True):
            assert np.array_equal(town.side.values(mine), own)
        for min_clearance in (0.0, 1.0, town.city.cell, 2.5):
            expected = town.city.blocked(min_clearance)
            assert np.array_equal(town.side.values(town.blocked(min_clearance)), expected)
            count = town.side.call(
                "close", town.occupied, town.closed, town.clearance, min_clearance, town.city.cell,
                town.blocked(min_clearance),
            )  # fmt: skip
            assert count == expected.sum()


def test_astar(fine, small):
    """On small cities with each estimate; some goals can't be reached."""
    for n, pair in enumerate(fine.city.random_pairs(FINE, rng=11, min_clearance=3.0)):
        astar_agrees(fine, *pair, "euclidean" if n % 20 == 0 else "octile", n % 7 / 2)
    rng, reached = np.random.default_rng(12), []
    for town in small:
        for n, least in enumerate(np.tile([0.0, 1.0, 1.75, 2.5, 3.0], COARSE // 5)):
            for pair in random_ends(town.city, 1, rng, least):
                reached.append(astar_agrees(town, *pair, ("octile", "euclidean", "zero")[n % 3], least).reached)
    assert len(reached) > 150
    assert 0 < np.mean(reached) < 1


def test_astar_with_a_penalty_zone(fine, small):
    rng = np.random.default_rng(21)
    for n, pair in enumerate(fine.city.random_pairs(FINE, rng=22)):
        if n % 20 == 0:
            price = set_zone(fine, rng.uniform(1.0, 5.5), rng.uniform(0.1, 3.0))
        zone_agrees(fine, *pair, price, "octile")
    for town in small:
        price = set_zone(town, rng.uniform(1.0, 5.5), rng.uniform(0.1, 3.0))
        for n, pair in enumerate(random_ends(town.city, COARSE, rng)):
            zone_agrees(town, *pair, price, ("octile", "euclidean", "zero")[n % 3])


def test_hazard_astar(fine, small):
    """Prices have an exp in them: routes may differ where two cost the same but for rounding."""
    rng, equal = np.random.default_rng(31), []
    for n, pair in enumerate(fine.city.random_pairs(FINE, rng=32, min_clearance=0.5)):
        if n % 20 == 0:
            asked = rng.uniform(0.2, 1.5), 1.0, rng.uniform(2.0, 10.0), rng.uniform(0.5, 2.0)
            set_hazard(fine, *asked)
        equal += hazard_agrees(fine, *pair, *asked)
    for town in small:
        diameter = float(rng.choice([0.4, 1.0]))
        asked = rng.uniform(0.2, 3.0), diameter, rng.uniform(2.0, 10.0), rng.uniform(0.5, 2.0)
        set_hazard(town, *asked)
        for pair in random_ends(town.city, COARSE, rng, diameter / 2):
            equal += hazard_agrees(town, *pair, *asked)
    assert len(equal) >= 600
    assert np.mean(equal) >= 0.99


CLASSES = [
    (load, disturbance)
    for load in ("dead", "light", "moderate", "heavy")
    for disturbance in ("none", "mild", "moderate", "heavy")
]


def test_repare_s_price(small, fine):
    for load, disturbance in CLASSES:
        set_repare(small[0], load, disturbance)
        set_repare(small[1], load, disturbance, force_weight=0.3, load_weight=2.5)
    set_repare(fine, "light", "mild")


def test_repare(fine, small):
    asked = 0
    for n, (load, disturbance) in enumerate(
        (("dead", "mild"), ("light", "heavy"), ("heavy", "mild"), ("heavy", "none"))
    ):
        distance = set_repare(fine, load, disturbance).safe_distance
        for pair in fine.city.random_pairs(FINE // 4, rng=n, min_clearance=distance):
            repare_agrees(fine, *pair, load, disturbance)
    rng = np.random.default_rng(41)
    for town in small:
        for load, disturbance in (("light", "mild"), ("moderate", "moderate")):
            distance = set_repare(town, load, disturbance).safe_distance
            for pair in random_ends(town.city, COARSE, rng, distance):
                repare_agrees(town, *pair, load, disturbance)
                asked += 1
    assert asked >= 200


def test_theta_star(fine, small):
    for n, pair in enumerate(fine.city.random_pairs(FINE, rng=51, min_clearance=3.0)):
        theta_agrees(fine, *pair, n % 7 / 2)
    rng, reached = np.random.default_rng(52), []
    for town in small:
        for least in np.tile([0.0, 1.0, 1.75, 2.5, 3.0], COARSE // 5):
            for pair in random_ends(town.city, 1, rng, least):
                reached.append(theta_agrees(town, *pair, least).reached)
    assert 0 < np.mean(reached) < 1


@pytest.mark.parametrize("free", [False, True])
def test_potential_field(fine, small, free):
    """It arrives, is trapped, crashes, flies where it may not, and gives up."""
    rng, reasons = np.random.default_rng(61), set()
    for pair in fine.city.random_pairs(FINE, rng=62):
        reasons.add(field_agrees(fine, *pair, free, 5.0, 5.0).reason[:14])
    for town in small:
        for pair in random_ends(town.city, COARSE, rng):
            push, reach = rng.uniform(0.01, 8.0), rng.uniform(1.0, 6.0)
            reasons.add(field_agrees(town, *pair, free, push, reach, int(rng.choice([5, 50, 2000]))).reason[:14])
    endings = {"", "stuck in a loc", "gave up after "}
    assert reasons == (endings | {"flies into an ", "flies where it"} if free else endings)


WEIGHTS = (
    (1.0, 0.0, 0.0, False), (0.0, 1.0, 0.0, False), (1.0, 1e-7, 0.0, False), (0.0, 0.5, 0.2, False),
    (1.0, 2e-8, 1e-7, True),
)  # fmt: skip
"""Of risk, length and threat; and whether risk counts where the wreck lands."""


def test_least_risk(side):
    """Over risk, length, threat and drift, with limits on turns and climb, some of which leave no way."""
    rng, reached = np.random.default_rng(71), []
    for seed in range(10):
        campus = random_campus(seed, cell=5.0 if seed else 4.0)
        questions = [Risk(Town(side, campus.city), campus, weights) for weights in WEIGHTS[seed % 2 :: 2]]
        allowed = np.flatnonzero(campus.flyable)
        pairs = [
            CAMPUS_FLIGHT,
            *(campus.city.center_of(campus.city.index_of(rng.choice(allowed, 2))) for _ in range(31)),
        ]
        for n, pair in enumerate(pairs):
            limits = (rng.uniform(0.0, np.pi), rng.uniform(0.0, np.pi / 2)) if n % 8 == 7 else (MAX_TURN, MAX_PITCH)
            if (campus.city.cell_of(pair[0]) != campus.city.cell_of(pair[1])).any():
                reached.append(least_risk_agrees(questions[n % len(questions)], *pair, *limits).reached)
    assert len(reached) >= 300
    assert 0 < np.mean(reached) < 1


def test_integrals(fine, small):
    rng = np.random.default_rng(81)
    for town in (fine, *small):
        for size, pair in zip((1e-9, 1.0, 1e9), random_ends(town.city, 3, rng), strict=True):
            integral_agrees(town, *pair, size * rng.random(town.city.shape))


def test_the_nearest_free_point(small):
    rng = np.random.default_rng(91)
    for town in small:
        low, high = town.city.bounds
        for point in rng.uniform(low, high, (15, 3)):
            nearest_agrees(town, point, float(rng.choice([0.0, 1.0, 3.0, 500.0])))
    solid = Town(small[0].side, City(np.ones((3, 4, 5), bool)))
    assert solid.nearest((1.5, 1.5, 1.5), 0.0) == -1


def test_curves(fine, small):
    """Through control points anywhere, near each other, twice in one place, and far apart."""
    rng = np.random.default_rng(101)
    for n in range(80):
        town = (fine, *small)[n % 8]
        low, high = town.city.bounds
        count = rng.integers(2, 12)
        control = (
            rng.uniform(low, high, (count, 3)) if n % 2 else low + np.cumsum(rng.uniform(0, 3, (count, 3)), axis=0)
        )
        if n % 5 == 0 and count > 3:
            control[2] = control[1]
        curve_agrees(town, control, float(rng.choice([0.2, 0.5, 2.0])))


def test_a_curve_with_more_points_than_there_is_room_for(fine):
    points, _, _, _ = fine.curve([(5, 5, 30), (95, 95, 30)], 0.01)
    assert len(points) == fine.points.shape[0]


def test_lengths_and_distances_of_any_way(small):
    """Also of one point, of ways through buildings, and with points that stand twice."""
    rng = np.random.default_rng(111)
    for town in small:
        low, high = town.city.bounds
        for count in (1, 2, 3, 8):
            points = rng.uniform(low, high, (count, 3))
            points[-1] = points[0] if count == 3 else points[-1]
            points[-2:] = points[-1] if count == 8 else points[-2:]
            kept = town.side.array(points)
            length = town.side.call(
                "measure", kept, count, town.clearance, *town.walls, town.origin, town.city.cell, town.facts
            )
            route = way_of(points)
            assert (length, town.side.values(town.facts)[6]) == (route.length, route.clearance(town.city))
            town.side.free(kept)


ACROSS = (5, 5, 30), (60, 46, 32)
WEAK = dataclasses.replace(LIGHT_QUADROTOR, battery=4000.0)
FLIGHTS = {
    "calm": ("A*", LIGHT_QUADROTOR, Wind((0.5, 0), deviation=0.2), Autopilot(), 10),
    "windy": ("A*", LIGHT_QUADROTOR, Wind((4, -3), deviation=1.5, correlation=2.0), Autopilot(), 20),
    "rain, thin air": (
        "Theta*", LIGHT_QUADROTOR, Wind((-3, 2, 0.3), deviation=1.0, rain_mm_per_h=15.0, air_density=1.0),
        Autopilot(speed=7.0), 10,
    ),
    "another vehicle": ("Theta*", RISK_QUADROTOR, Wind((2, 6), deviation=2.0), Autopilot(acceptance_radius=0.7), 10),
    "careful": ("Theta*", LIGHT_QUADROTOR, Wind((5, 0), deviation=1.0), Autopilot(ADVANCED, gps=PERFECT_GPS), 5),
    "storm": ("open", LIGHT_QUADROTOR, Wind((25, 8), deviation=4.0), Autopilot(heeds_limits=False), 5),
    "empty": ("open", WEAK, Wind((1, 1)), Autopilot(), 5),
    "never near": ("short", LIGHT_QUADROTOR, Wind((1, 1)), Autopilot(acceptance_radius=1e-6), 2),
}  # fmt: skip
"""A route, a vehicle, a wind, an autopilot, and how many flights."""


@pytest.fixture(scope="module")
def flown(fine):
    """Outcomes of all flights, each held against the public function's."""
    city, outcomes = fine.city, {}
    ways = {
        "A*": astar(city, *ACROSS),
        "Theta*": theta_star(city, *ACROSS, min_clearance=1.0),
        "open": way_of([(5, 5, 80), (5, 5, 90), (90, 90, 90)]),
        "short": way_of([(5, 5, 90), (12, 5, 90)]),
    }
    for seed, (name, (way, uav, wind, autopilot, count)) in enumerate(FLIGHTS.items()):
        outcomes[name] = []
        for number in range(count):
            flight = fly(ways[way], city, uav, wind, autopilot, rng=seed, number=number)
            generator = np.random.default_rng(seed).spawn(count)[number]
            flight_agrees(fine, ways[way], uav, wind, autopilot, flight, generator)
            outcomes[name].append(flight.outcome)
        many = monte_carlo(ways[way], city, uav, wind, autopilot, rng=seed, flights=count)
        assert many.outcome.tolist() == outcomes[name]
    return outcomes


def test_flights(flown):
    assert sum(map(len, flown.values())) >= 60
    assert {outcome for outcomes in flown.values() for outcome in outcomes} == {"arrived", "crashed", "gave up"}
    assert set(flown["storm"]) == set(flown["empty"]) == set(flown["never near"]) == {"gave up"}


def test_a_flight_is_logged_every_so_many_steps_and_at_its_end(fine):
    route, wind, autopilot = way_of([(5, 5, 90), (30, 5, 90)]), Wind((2, 1)), Autopilot()
    setup, _ = setup_of(route, fine.city, LIGHT_QUADROTOR, wind, autopilot, 0.02)
    craft, space = craft_of(LIGHT_QUADROTOR, wind, autopilot, 0.02), setup.obstacles

    def log(**options):
        state = state_of(np.random.default_rng(5))
        ends = space.touching, space.near_goal
        return fine.fly(route.points, setup.speed, wind, craft, state, *ends, **options)[0]

    whole, seldom, short = log(), log(every=50), log(every=50, room=4)
    assert np.array_equal(seldom[:-1], whole[:-1:50])
    assert np.array_equal(seldom[-1], whole[-1])
    assert np.array_equal(short, np.vstack([seldom[:3], whole[-1:]]))


def test_a_page_asks_again_and_again_in_the_same_memory(side):
    town = Town(side, random_city(3))
    pairs = random_ends(town.city, 5, np.random.default_rng(1))
    price = penalty_zone(town.city, 2.0, penalty=1.0)
    set_zone(town, 2.0, 1.0)

    def asked():
        for pair in pairs:
            town.astar(*pair)
            town.astar(*pair, cheapest=1.0)
            town.theta_star(*pair)
            town.potential_field(*pair, True)
        return side.page.evaluate("planners.used()")

    asked()
    used = asked()
    for _ in range(3):
        assert asked() == used
    assert np.array_equal(side.values(town.price), price)


def test_arrays_outlive_the_growth_of_memory(browser):
    side = InBrowser(browser.new_page())
    rng = np.random.default_rng(2)
    kept = {}
    for values in (
        rng.random((7, 3)), rng.random((5, 4, 3)) < 0.5, rng.integers(-9, 9, 11, dtype=np.int32),
        rng.integers(-(2**62), 2**62, 5), rng.integers(0, 2**64, 4, dtype=np.uint64),
    ):  # fmt: skip
        kept[side.array(values)] = values
    before = side.page.evaluate("planners.used()")
    large = side.empty(float, (120, 120, 120))
    assert side.page.evaluate("planners.used()") >= before + 8 * 120**3
    for array, values in kept.items():
        assert np.array_equal(side.values(array), values)
    side.free(large)
    again = side.empty(float, (60, 240, 120))
    assert side.page.evaluate("([one, other]) => one === other", [large.at, again.at]) is False
    assert side.page.evaluate("planners.used()") < before + 8 * 120**3 + 1000  # the room of the one that was given back
    side.page.close()


def test_blocks_of_memory_don_t_overlap(browser):
    """Of many sizes, taken and given back; each keeps what it was filled with."""
    side = InBrowser(browser.new_page())
    mixed = side.page.evaluate("""() => {
        const kept = [];
        let seed = 7, wrong = 0;
        const random = most => { seed = (seed * 48271) % 2147483647; return seed % most; };
        for (let n = 0; n < 3000; n++) {
            if (kept.length && random(3) === 0) {
                const [array, value] = kept.splice(random(kept.length), 1)[0];
                wrong += array.values.some(one => one !== value);
                array.free();
            } else {
                const array = planners.empty("int32", random(200));
                array.values.fill(n);
                kept.push([array, n]);
            }
        }
        return wrong + kept.filter(([array, value]) => array.values.some(one => one !== value)).length;
    }""")
    assert mixed == 0
    side.page.close()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("planners.nearest(flags, point, point)", "nearest takes 4 arguments, got 3|nearest: cell must be a number"),
        ("planners.nearest(flags, point, point, 1, 2)", "nearest takes 4 arguments, got 5"),
        ("planners.nearest(flags, point, point, '1')", "nearest: cell must be a number"),
        ("planners.nearest(flags, point, point, point)", "nearest: cell must be a number"),
        ("planners.nearest(point, point, point, 1)", "nearest: blocked must be boolean with 3 axes"),
        ("planners.nearest(few, point, point, 1)", "nearest: blocked must be boolean with 3 axes"),
        ("planners.nearest(flags, [1, 2, 3], point, 1)", "nearest: point must be float64 with 1 axes"),
        ("planners.nearest(flags, flags, point, 1)", "nearest: point must be float64 with 1 axes"),
        ("planners.nearest(flags, undefined, point, 1)", "nearest: point must be float64 with 1 axes"),
        ("planners.numbers('float64', [1, 2, 3], [2])", "offset|bounds"),
        ("planners.measure(way, 0, field, longs, ints, ints, few, point, 1, facts)", "measure failed|asked for"),
    ],
)
def test_wrong_calls_are_told(side, call, message):
    side.page.evaluate("""() => Object.assign(window, {
        flags: planners.empty("boolean", 2, 2, 2), point: planners.empty("float64", 3),
        way: planners.empty("float64", 4, 3), field: planners.empty("float64", 2, 2, 2),
        longs: planners.empty("int64", 5), ints: planners.empty("int32", 0),
        few: planners.empty("boolean", 0), facts: planners.empty("float64", planners.answers.length),
    })""")
    with pytest.raises(Exception, match=message):
        side.page.evaluate(f"() => {{ {call}; }}")
    assert side.page.evaluate(  # and the next call is answered
        "() => { flags.values.fill(0); point.values.fill(0); return planners.nearest(flags, point, point, 1); }"
    ) == NEARLY(0)


def test_a_town_with_no_obstacle(side):
    town = Town(side, City(np.zeros((12, 11, 10), bool)))
    assert np.isinf(side.values(town.clearance)).all()
    for pair in random_ends(town.city, 3, np.random.default_rng(4)):
        astar_agrees(town, *pair, "octile", 2.0)
        theta_agrees(town, *pair, 2.0)
        field_agrees(town, *pair, True, 5.0, 5.0)
    curve_agrees(town, [(1, 1, 1), (5, 5, 5), (9, 1, 1)], 0.1)


def test_zones_don_t_push_and_can_t_be_hit(side):
    town = Town(side, with_zones())
    assert not np.array_equal(side.values(town.blocked(0.0)), town.city.occupied)
    assert np.array_equal(side.values(town.clearance), dataclasses.replace(town.city, no_fly=()).clearance)
