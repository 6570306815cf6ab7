"""Campuses: what the reference is, that random ones are the seed's, and that all of them can be flown over."""

import numpy as np
import pytest

from uavlab.planners import least_risk, pareto_front
from uavlab.risk import CAMPUS_FLIGHT, POPULATION_DENSITY, random_campus, reference_campus
from uavlab.risk.campus import BELT, MIN_HEIGHT, ROAD_WIDTH, ROADS
from uavlab.risk.layers import column_centers

CELLS = [5.0, 2.0]
SEEDS = range(60)
HALF_ROAD, HALF_BELT = 3.0, 6.0  # from the middle of a road to its edge, and to that of the trees


def built(campus):
    return campus.city.occupied.any(axis=2)


def in_footprints(campus):
    """Columns whose centres lie in a building."""
    at = column_centers(campus.city)
    bounds = [building.bounds[:, :2] for building in campus.city.buildings]
    return np.any([((at >= low) & (at < high)).all(axis=-1) for low, high in bounds], axis=0)


def to_road(campus):
    """Distance from the centre of each column to the nearest of the six middle lines, (nx, ny) [m]."""
    at = column_centers(campus.city)[..., None]
    return np.abs(at - np.array([37.5, 75.0, 112.5])).min(axis=(2, 3))


def assert_flyable(campus):
    index = tuple(campus.city.cell_of(CAMPUS_FLIGHT).T)
    assert campus.flyable[index].all()


@pytest.mark.parametrize("cell", CELLS)
def test_reference_campus(cell):
    campus = reference_campus(cell)
    assert campus.city.shape == tuple(round(extent / cell) for extent in (150, 150, 80))
    assert campus.city.bounds.tolist() == [[0, 0, 0], [150, 150, 80]]
    assert campus.city.name == "reference campus"
    assert campus.population_density.mean() == pytest.approx(POPULATION_DENSITY, rel=1e-12)
    assert campus.min_height == MIN_HEIGHT
    assert not campus.as_printed
    assert_flyable(campus)
    assert max(building.bounds[1, 2] for building in campus.city.buildings) == 60


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("make", [reference_campus, lambda cell: random_campus(4, cell)])
def test_roads_have_cars_and_no_shelter_and_belts_have_trees(make, cell):
    campus = make(cell)
    distance, open_ground = to_road(campus), ~in_footprints(campus)
    road = open_ground & (distance < HALF_ROAD)
    belt = open_ground & (distance >= HALF_ROAD) & (distance < HALF_BELT)
    assert road.any()
    assert belt.any()
    assert (campus.shelter[road] == 0).all()
    assert (campus.shelter[belt] == 0.5).all()
    assert (campus.vehicle_share[road] > 0).all()
    assert (campus.vehicle_share[~open_ground] == 0).all()
    assert (campus.vehicle_share[distance > HALF_ROAD + cell / 2] == 0).all()
    assert campus.population_density[road].mean() < 0.5 * campus.population_density[belt].mean()


@pytest.mark.parametrize("cell", CELLS)
def test_cars_are_those_of_the_roads_whatever_the_resolution(cell):
    campus = reference_campus(cell)
    covered = 6 * 6 * 150 - 9 * 36  # six roads of 6 m, nine crossings counted once
    cars = campus.vehicle_share.sum() * cell**2
    assert cars == pytest.approx(covered * 2.8e-4, rel=0.01)  # coarse columns under a building may hold some road
    assert cars <= covered * 2.8e-4 * (1 + 1e-9)


def test_reference_campus_has_all_kinds_of_shelter():
    assert set(np.unique(reference_campus().shelter)) == {0.0, 0.25, 0.5, 0.75, 1.0}


def test_on_the_reference_campus_a_little_way_more_saves_most_of_the_risk():
    """RISK-ACO Table 5: 80 % less risk for 7 % more length."""
    campus = reference_campus()
    blind = least_risk(campus, *CAMPUS_FLIGHT, risk_weight=0, length_weight=1)
    lengths = [blind.length * (1 + 1e-9), 1.07 * blind.length]
    safest_of_the_shortest, aware = pareto_front(campus, *CAMPUS_FLIGHT, lengths=lengths)
    assert safest_of_the_shortest.length == pytest.approx(blind.length)
    assert aware.length <= 1.07 * blind.length
    for other in (blind, safest_of_the_shortest):
        assert campus.integral(aware) < 0.2 * campus.integral(other)
        assert campus.cell_sum(aware) < 0.21 * campus.cell_sum(other)
    assert campus.cell_sum(aware) == pytest.approx(4.82e-6, rel=0.3)  # the paper's figure


def test_the_same_seed_gives_the_same_campus():
    for seed in (0, np.random.default_rng(8)):
        again = np.random.default_rng(8) if isinstance(seed, np.random.Generator) else seed
        one, two = random_campus(seed), random_campus(again)
        assert np.array_equal(one.city.occupied, two.city.occupied)
        assert np.array_equal(one.rate, two.rate)
    assert np.array_equal(random_campus(8).rate, random_campus(np.random.default_rng(8)).rate)
    assert random_campus(8).city.name == "random campus 8"


def test_another_seed_gives_another_campus():
    campuses = [random_campus(seed) for seed in range(6)]
    for n, one in enumerate(campuses):
        for other in campuses[:n]:
            assert (one.city.occupied != other.city.occupied).any()
            assert (one.population_density != other.population_density).mean() > 0.9
            assert (one.shelter != other.shelter).any()


def test_a_campus_leaves_the_global_state_alone():
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    random_campus(1)
    reference_campus()
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002


@pytest.mark.parametrize("seed", SEEDS)
def test_every_random_campus_can_be_flown_over(seed):
    campus = random_campus(seed)
    assert campus.population_density.mean() == pytest.approx(POPULATION_DENSITY, rel=1e-12)
    assert ((campus.shelter >= 0) & (campus.shelter <= 1)).all()
    assert_flyable(campus)
    route = least_risk(campus, *CAMPUS_FLIGHT)
    assert route.reached
    assert 137 < route.length < 300  # 137.6 m are the straight way
    assert campus.flyable[tuple(campus.city.cell_of(route.points).T)].all()


@pytest.mark.parametrize("seed", range(8))
def test_finer_campuses_are_the_same_ones(seed):
    coarse, fine = random_campus(seed), random_campus(seed, 2.0)
    assert_flyable(fine)
    assert [b.bounds.tolist() for b in coarse.city.buildings] == [b.bounds.tolist() for b in fine.city.buildings]
    sides = np.array([np.ptp(b.bounds, axis=0)[:2] for b in fine.city.buildings])
    assert sides.prod(axis=1).sum() < built(fine).sum() * 4 < (sides + 2 * 2.0).prod(axis=1).sum()


@pytest.mark.parametrize("seed", SEEDS[:20])
def test_buildings_keep_off_the_roads(seed):
    campus = random_campus(seed)
    lines = np.array([37.5, 75.0, 112.5])
    assert len(campus.city.buildings) > 0
    for building in campus.city.buildings:
        low, high = building.bounds[:, :2]
        assert 5 < building.bounds[1, 2] <= 60
        for axis in range(2):
            assert (np.maximum(low[axis] - lines, lines - high[axis]) >= HALF_BELT).all()


@pytest.mark.parametrize("cell", [4.0, 7.0])
def test_columns_that_stick_out_of_the_campus_are_no_way_around_its_people(cell):
    campus = random_campus(2, cell)
    assert campus.city.bounds[1, 0] > 150
    assert (campus.population_density > 0).all()
    assert (campus.rate > 0).all()


def test_risk_map_says_what_it_is():
    assert repr(reference_campus()) == "<RiskMap of reference campus: 30 × 30 × 16 voxels of 5 m>"


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: reference_campus(0), "cell must be finite and above 0, got 0"),
        (lambda: reference_campus(np.nan), "cell must be finite and above 0, got nan"),
        (lambda: random_campus(1, -5), "cell must be finite and above 0, got -5"),
        (lambda: random_campus(1, [5, 2]), "cell must be one number"),
        (lambda: random_campus(1, "5"), "cell must be a number .* got text"),
        (lambda: reference_campus(0.01), "cell=0.01 m gives .* use a cell of at least"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize("seed", range(3))
def test_beside_the_roads_runs_a_belt_of_trees_with_five_times_as_many_people_as_on_them(seed):
    """Shelter of trees, half of the usual density, on a road a tenth; crowds are the same within 10 m."""
    campus = random_campus(seed, cell=2.5)
    x, y = np.moveaxis(column_centers(campus.city), -1, 0)
    away = np.min([np.abs(axis - road) for axis in (x, y) for road in ROADS], axis=0)
    free = ~campus.city.occupied.any(axis=2)
    belt, road = free & (away > ROAD_WIDTH / 2) & (away < ROAD_WIDTH / 2 + BELT), free & (away < ROAD_WIDTH / 2)
    assert (campus.shelter[belt] == 0.5).all()
    assert (campus.shelter[road] == 0.0).all()
    square, ratios = x // 10 * 100 + y // 10, []
    for number in np.unique(square[belt]):
        one, other = (campus.population_density[kind & (square == number)] for kind in (belt, road))
        if len(one) and len(other):
            assert np.ptp(one) < 1e-12
            ratios.append(one[0] / other[0])
    assert len(ratios) > 20
    assert ratios == pytest.approx(np.full(len(ratios), 5.0))
