"""Rates: the figures of the papers' model, limits of the fatality, laws that hold for all energies and shelters."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from uavlab.risk import (
    POPULATION_DENSITY,
    SHELTER,
    ballistic_fall,
    fall_speed,
    impact_energy,
    impact_fatality,
    lethal_area,
    person_rate,
    vehicle_rate,
    vehicle_share,
)
from uavlab.risk.rates import EVEN_ODDS_ENERGY, FAILURE_RATE, LEAST_FATAL_ENERGY
from uavlab.vehicle import LIGHT_QUADROTOR, RISK_QUADROTOR

NAN = float("nan")
ALPHA, BETA = 1e6, 34.0
AT_BETA = 1 / (1 + np.sqrt(ALPHA / BETA))
energies = st.floats(1e-3, 1e9)
shelters = st.floats(0, 1)
AT_30_METRES = [3.17e-6, 2.75e-7, 7.29e-8, 4.62e-8, 3.67e-8]  # shelter 0, 0.25, 0.5, 0.75, 1


@pytest.mark.parametrize(("energy", "shelter", "fatality"), [(1e3, 0.5, 0.030653), (1e6, 0.5, 0.5), (5e4, 1, 0.03485)])
def test_fatality_of_known_blows(energy, shelter, fatality):
    assert impact_fatality(energy, shelter) == pytest.approx(fatality, abs=1e-6)


@given(energies, st.floats(0.05, 1))
def test_fatality_is_the_formula_where_that_can_be_computed(energy, shelter):
    printed = 1 / (1 + np.sqrt(ALPHA / BETA) * (BETA / energy) ** (1 / (4 * shelter)))
    assert impact_fatality(energy, shelter) == pytest.approx(printed, rel=1e-9)


def test_constants_mean_what_the_papers_say():
    assert (EVEN_ODDS_ENERGY, LEAST_FATAL_ENERGY) == (ALPHA, BETA)
    assert impact_fatality(7e4, 0.5, even_odds_energy=7e4) == pytest.approx(0.5)
    assert impact_fatality([59.9, 60.1], 0.0, least_fatal_energy=60).tolist() == [0, 1]


def test_without_shelter_the_least_fatal_energy_decides():
    assert impact_fatality([0.0, 33.999, 34.001, 1e9], 0.0).tolist() == [0, 0, 1, 1]
    assert impact_fatality(BETA, 0.0) == pytest.approx(AT_BETA, rel=1e-12)


@given(shelters)
def test_at_the_least_fatal_energy_shelter_changes_nothing(shelter):
    assert impact_fatality(BETA, shelter) == pytest.approx(AT_BETA, rel=1e-12)


@pytest.mark.parametrize("energy", [0.0, 1.0, 30.0, 34.0, 40.0, 1e3])
def test_fatality_is_continuous_towards_no_shelter(energy):
    shelter = np.array([1e-3, 1e-5, 1e-9, 1e-300, 5e-324])
    assert impact_fatality(energy, shelter) == pytest.approx(impact_fatality(energy, 0.0), abs=1e-12)


@pytest.mark.parametrize("energy", [0.0, 5e-324, 1e-300, BETA, 1e6, 1e300, 1.7e308])
@pytest.mark.parametrize("shelter", [0.0, 5e-324, 1e-300, 1e-12, 1.0])
def test_extreme_values_give_probabilities_and_no_warning(energy, shelter):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert 0 <= impact_fatality(energy, shelter) <= 1


@given(energies, st.floats(1.01, 10), shelters)
def test_a_harder_blow_never_kills_less(energy, factor, shelter):
    weaker, harder = impact_fatality([energy, factor * energy], shelter)
    assert weaker <= harder
    if shelter > 0.1 and harder < 0.999:
        assert weaker < harder


@given(energies, shelters, shelters)
def test_shelter_protects_from_blows_that_kill_without(energy, one, other):
    assume(abs(energy - BETA) > 1e-6)
    less, more = sorted((one, other))
    if energy > BETA:
        assert impact_fatality(energy, less) >= impact_fatality(energy, more)
    else:  # the formula's oddity: below β it is the other way round
        assert impact_fatality(energy, less) <= impact_fatality(energy, more)


def test_fatality_broadcasts():
    grid = impact_fatality(np.array([[10.0], [500.0]]), list(SHELTER.values()))
    assert grid.shape == (2, 5)
    assert grid[1, 2] == impact_fatality(500.0, 0.5)


def test_person_rate_at_thirty_metres():
    assert list(SHELTER.values()) == [0, 0.25, 0.5, 0.75, 1]
    assert round(POPULATION_DENSITY * 1e6) == 30_000
    assert person_rate(30.0, shelter=list(SHELTER.values())) == pytest.approx(AT_30_METRES, rel=0.01)
    assert person_rate(30.0) == pytest.approx(AT_30_METRES[0], rel=0.01)


def test_person_rate_is_the_product_of_its_parts():
    uav = LIGHT_QUADROTOR.loaded(0.4)
    area = lethal_area(25.0, 7.0, fall_speed(25.0, uav), 1.0)
    energy = 0.5 * 1.9 * (7.0**2 + fall_speed(25.0, uav) ** 2)
    expected = 6.4e-5 * 0.004 * area * impact_fatality(energy, 0.3)
    assert person_rate(25.0, 0.004, 0.3, uav, speed=7.0) == pytest.approx(expected, rel=1e-12)
    assert FAILURE_RATE == 6.4e-5


def test_person_rate_of_a_ballistic_fall():
    fall = ballistic_fall(30.0)
    energy = impact_energy(1.38, fall.forward_speed, fall.fall_speed)
    area = lethal_area(30.0, fall.forward_speed, fall.fall_speed)
    rate = person_rate(30.0, shelter=0.5, ballistic=True)
    assert rate == pytest.approx(6.4e-5 * 0.03 * area * impact_fatality(energy, 0.5), rel=1e-9)
    assert 0.85 < rate / person_rate(30.0, shelter=0.5) < 0.95


def test_the_printed_fall_glides_farther_and_strikes_less():
    assert person_rate(30.0, as_printed=True) > person_rate(30.0)  # no shelter: the area alone counts
    down = fall_speed(30.0, as_printed=True)
    expected = 6.4e-5 * 0.03 * lethal_area(30.0, 16.0, down) * impact_fatality(0.69 * (256 + down**2), 1.0)
    assert person_rate(30.0, shelter=1.0, as_printed=True) == pytest.approx(expected, rel=1e-12)


@given(st.floats(0, 200, allow_subnormal=False), st.floats(0, 10), shelters, st.floats(0, 20))
def test_person_rate_is_finite_not_negative_and_in_proportion_to_people(height, density, shelter, speed):
    rate = person_rate(height, density, shelter, speed=speed)
    assert np.isfinite(rate)
    assert rate >= 0
    assert rate == pytest.approx(density * person_rate(height, 1.0, shelter, speed=speed), rel=1e-12)


def test_a_heavier_or_larger_vehicle_is_a_greater_risk():
    rate = person_rate(30.0, shelter=0.5)
    assert person_rate(30.0, shelter=0.5, uav=RISK_QUADROTOR.loaded(0.5)) > rate
    assert person_rate(30.0, shelter=0.5, uav=replace(RISK_QUADROTOR, diameter=0.8)) > 1.5 * rate


def test_person_rate_broadcasts_heights_people_and_shelter():
    rate = person_rate(np.array([5.0, 30.0]), np.full((3, 1), 0.01), np.array([[0.0], [0.5], [1.0]]))
    assert rate.shape == (3, 2)
    assert rate[1, 1] == person_rate(30.0, 0.01, 0.5)


def test_vehicle_rate_with_cars_per_kilometre():
    assert vehicle_share() == pytest.approx(8.4 * 0.1 / 1000 / 3)
    assert vehicle_rate(vehicle_share()) == pytest.approx(5.376e-8, rel=1e-9)
    assert vehicle_rate([0.0, 1.0]) == pytest.approx([0, 6.4e-5 * 3])


def test_with_cars_per_metre_one_cell_of_road_would_exceed_every_route_of_the_papers():
    per_metre = vehicle_rate(vehicle_share(cars_per_km=0.1 * 1000))
    assert per_metre == pytest.approx(5.376e-5, rel=1e-9)
    assert per_metre > 2.37e-5  # the risk-blind route of RISK-ACO Table 5


@given(st.floats(0, 300), st.floats(2.6, 6))
def test_share_is_cars_over_lane(cars_per_km, lane_width):
    lane = 1000 * lane_width
    assert vehicle_share(cars_per_km, lane_width) == pytest.approx(8.4 * cars_per_km / lane, rel=1e-12)


def test_population_is_asked_for_in_people_per_square_metre():
    assert person_rate(30.0, 10.0) > 0
    for density in (10.1, 30_000.0):
        with pytest.raises(ValueError, match=r"population_density must be in people per m².*per km² by 1e6\), got "):
            person_rate(30.0, density)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: impact_fatality(-1, 0.5), "energy must be finite and at least 0, got -1"),
        (lambda: impact_fatality([1, NAN], 0.5), "energy must be finite and at least 0, got nan"),
        (lambda: impact_fatality("1 kJ", 0.5), "energy must be a number .* got text, '1 kJ'"),
        (lambda: impact_fatality(1, 1.01), r"shelter must be from 0 to 1 \(0 none, 1 industry\), got 1.01"),
        (lambda: impact_fatality(1, -0.1), "shelter must be from 0 to 1 .* got -0.1"),
        (lambda: impact_fatality(1, NAN), "shelter must be from 0 to 1 .* got nan"),
        (lambda: impact_fatality(1, "none"), "shelter must be a number .* got text, 'none'"),
        (lambda: impact_fatality(1, 1, even_odds_energy=0), "even_odds_energy must be finite and above 0, got 0"),
        (lambda: impact_fatality(1, 1, least_fatal_energy=-34), "least_fatal_energy must be finite and above 0"),
        (lambda: person_rate(-1), "height must be finite and at least 0, got -1"),
        (lambda: person_rate(NAN), "height must be finite and at least 0, got nan"),
        (lambda: person_rate(30, -0.03), "population_density must be finite and at least 0, got -0.03"),
        (lambda: person_rate(30, np.inf), "population_density must be finite and at least 0, got inf"),
        (lambda: person_rate(30, 0.03, 2), "shelter must be from 0 to 1"),
        (lambda: person_rate(30, speed=-16), "^speed must be finite and at least 0, got -16"),
        (lambda: person_rate(30, speed=NAN), "^speed must be finite and at least 0, got nan"),
        (lambda: person_rate(30, speed="16"), "^speed must be a number .* got text"),
        (lambda: person_rate(30, speed=-16, ballistic=True), "^speed must be finite and at least 0, got -16"),
        (lambda: person_rate(30, air_density=0), "air_density must be finite and above 0, got 0"),
        (lambda: person_rate(30, ballistic="no"), "ballistic must be True or False, got 'no'"),
        (lambda: person_rate(30, as_printed=0), "as_printed must be True or False, got 0"),
        (lambda: impact_fatality(1, 1, even_odds_energy=[1, 2]), "even_odds_energy must be one number"),
        (lambda: person_rate(30, ballistic=True, as_printed=True), "as_printed and ballistic exclude each other"),
        (lambda: vehicle_share(-1), "cars_per_km must be finite and at least 0, got -1"),
        (lambda: vehicle_share(0.1, 0), "lane_width must be finite and above 0, got 0"),
        (lambda: vehicle_share(1000), "cars_per_km must leave cars on at most the whole lane; the share .* got 2.8"),
        (lambda: vehicle_share(NAN), "cars_per_km must be finite and at least 0, got nan"),
        (lambda: vehicle_rate(-0.1), "share must be from 0 to 1 of the ground, got -0.1"),
        (lambda: vehicle_rate([0.5, 1.5]), "share must be from 0 to 1 of the ground, got 1.5"),
        (lambda: vehicle_rate(NAN), "share must be from 0 to 1 of the ground, got nan"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()
