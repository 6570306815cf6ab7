"""Falls against the equation of motion, without air against the parabola; blow and area against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from uavlab.risk import Fall, ballistic_fall, fall_speed, impact_energy, lethal_area, terminal_speed
from uavlab.risk.fall import PERSON_HEIGHT, PERSON_RADIUS
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR, RISK_QUADROTOR

NAN = float("nan")
REACH = PERSON_RADIUS + RISK_QUADROTOR.diameter / 2
IN_VACUUM = replace(RISK_QUADROTOR, fall_drag_area=1e-12)
heights = st.floats(0.01, 1000)
speeds = st.floats(0, 30)
pitches = st.floats(-1.5, 1.5)


def followed(uav, forward, climb, depth):
    """Distance, forward and vertical speed when `depth` is lost: another method than the package's, own constants."""
    k = (uav.fall_drag_area or uav.drag_area) * 1.225 / (2 * (uav.mass + uav.payload))

    def motion(_, state):
        _, _, vx, vz = state
        v = (vx**2 + vz**2) ** 0.5
        return vx, vz, -k * v * vx, -9.81 - k * v * vz

    def ground(_, state):
        return state[1] + depth

    ground.terminal, ground.direction = True, -1
    fall = solve_ivp(motion, (0, 1000), (0, 0, forward, climb), method="DOP853", events=ground, rtol=1e-11, atol=1e-11)
    x, z, vx, vz = fall.y[:, -1]
    assert z == pytest.approx(-depth, abs=1e-8)
    return fall.t[-1], x, vx, -vz


@pytest.mark.parametrize("uav", [RISK_QUADROTOR, RISK_QUADROTOR.loaded(0.7), LIGHT_QUADROTOR])
@pytest.mark.parametrize("height", [0.5, 8.0, 30.0, 200.0])
def test_fall_speed_solves_the_equation_of_motion(uav, height):
    assert fall_speed(height, uav) == pytest.approx(followed(uav, 0.0, 0.0, height)[3], rel=1e-8)


def test_a_short_fall_keeps_all_its_energy_and_as_printed_half_of_it():
    height = np.array([1e-6, 1e-4, 1e-2])
    assert fall_speed(height) ** 2 == pytest.approx(2 * GRAVITY * height, rel=1e-4)
    assert fall_speed(height, as_printed=True) ** 2 == pytest.approx(GRAVITY * height, rel=1e-4)


@given(heights)
def test_the_printed_fall_is_one_from_half_the_height(height):
    assert fall_speed(height, as_printed=True) == pytest.approx(fall_speed(height / 2), rel=1e-12)


def test_speeds_of_the_papers_vehicle():
    assert fall_speed(30.0) == pytest.approx(23.4, abs=0.05)
    assert fall_speed(30.0, as_printed=True) == pytest.approx(16.8, abs=0.05)
    assert terminal_speed() == pytest.approx(62.57, rel=1e-3)
    with_their_gravity = terminal_speed() * np.sqrt(9.8 / GRAVITY)
    assert with_their_gravity == pytest.approx(62.57, abs=0.005)


def test_terminal_speed_is_where_drag_carries_the_weight():
    for uav, density in ((RISK_QUADROTOR, 1.225), (LIGHT_QUADROTOR.loaded(0.5), 0.9)):
        speed = terminal_speed(uav, air_density=density)
        assert 0.5 * density * (uav.fall_drag_area or uav.drag_area) * speed**2 == pytest.approx(uav.weight, rel=1e-12)
        assert fall_speed(1e5, uav, air_density=density) == pytest.approx(speed, rel=1e-9)


@given(heights, st.floats(1.001, 2))
def test_a_higher_fall_is_faster_but_never_terminal(height, factor):
    assert 0 < fall_speed(height) < fall_speed(factor * height) < terminal_speed()
    assert fall_speed(height, as_printed=True) < fall_speed(height)


@pytest.mark.parametrize("shape", [(), (3,), (2, 3), (2, 1, 4)])
def test_arrays_keep_their_shape(shape):
    height = np.linspace(1, 40, int(np.prod(shape))).reshape(shape)
    assert np.shape(fall_speed(height)) == shape
    fall = ballistic_fall(height)
    assert isinstance(fall, Fall)
    assert [np.shape(part) for part in fall] == [shape] * 4


def test_the_answer_for_a_height_doesnt_depend_on_the_others():
    height = np.array([0.0, 1e-6, 1e-3, 0.4, 7.0, 30.0, 120.0])
    together = np.array(ballistic_fall(height, pitch=-0.3))
    alone = np.transpose([np.array(ballistic_fall(h, pitch=-0.3)) for h in height])
    assert together == pytest.approx(alone, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("height", [0.0, 1e-6, 0.01, 3.0, 30.0, 200.0])
def test_without_forward_speed_the_ballistic_fall_is_the_closed_form(height):
    fall = ballistic_fall(height, speed=0.0)
    assert fall.fall_speed == pytest.approx(fall_speed(height), rel=1e-6, abs=1e-9)
    assert fall.drift == fall.forward_speed == 0
    beside_a_deep_one = ballistic_fall([height, 300.0], speed=0.0)
    assert beside_a_deep_one.fall_speed[0] == pytest.approx(fall_speed(height), rel=1e-6, abs=1e-9)


@given(heights, speeds, pitches)
def test_without_air_the_fall_is_the_parabola(height, speed, pitch):
    climb = speed * np.sin(pitch)
    duration = (climb + np.sqrt(climb**2 + 2 * GRAVITY * height)) / GRAVITY
    fall = ballistic_fall(height, IN_VACUUM, speed=speed, pitch=pitch)
    assert fall.duration == pytest.approx(duration, rel=1e-6)
    assert fall.drift == pytest.approx(speed * np.cos(pitch) * duration, rel=1e-6, abs=1e-9)
    assert fall.forward_speed == pytest.approx(speed * np.cos(pitch), rel=1e-6, abs=1e-9)
    assert fall.fall_speed == pytest.approx(GRAVITY * duration - climb, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("uav", [RISK_QUADROTOR, LIGHT_QUADROTOR])
@pytest.mark.parametrize("pitch", [-np.pi / 2, -0.8, 0.0, 0.5, 1.3])
@pytest.mark.parametrize("height", [2.0, 30.0, 90.0])
def test_ballistic_fall_solves_the_equation_of_motion(uav, pitch, height):
    expected = followed(uav, 14 * np.cos(pitch), 14 * np.sin(pitch), height)
    assert ballistic_fall(height, uav, speed=14.0, pitch=pitch) == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_ballistic_fall_from_thirty_metres():
    fall = ballistic_fall(30.0)
    assert fall.forward_speed == pytest.approx(14.1, abs=0.05)
    assert impact_energy(RISK_QUADROTOR.mass, fall.forward_speed, fall.fall_speed) == pytest.approx(505, abs=1)
    assert impact_energy(RISK_QUADROTOR.mass, 16.0, fall_speed(30.0)) == pytest.approx(554, abs=1)


def test_the_wreck_drifts_farther_than_a_cell():
    drift = ballistic_fall(np.linspace(22, 32, 11)).drift
    assert drift[0] == pytest.approx(32.9, abs=0.05)
    assert drift[-1] == pytest.approx(39.4, abs=0.05)
    assert (np.diff(drift) > 0).all()


@given(heights, speeds, pitches)
def test_drag_only_takes_energy(height, speed, pitch):
    fall = ballistic_fall(height, speed=speed, pitch=pitch)
    energy = impact_energy(1.0, fall.forward_speed, fall.fall_speed)
    assert energy <= (0.5 * speed**2 + GRAVITY * height) * (1 + 1e-9)
    assert fall.forward_speed <= speed * np.cos(pitch) + 1e-9


def test_a_climbing_vehicle_rises_first():
    level, climbing = ballistic_fall(30.0), ballistic_fall(30.0, pitch=np.radians(30))
    assert climbing.duration > level.duration + 0.5
    assert climbing.drift > level.drift
    assert climbing.fall_speed > level.fall_speed
    back_at_its_height = ballistic_fall(0.0, IN_VACUUM, pitch=np.radians(30))
    assert back_at_its_height.drift == pytest.approx(16**2 * np.sin(np.radians(60)) / GRAVITY, rel=1e-6)
    assert back_at_its_height.fall_speed == pytest.approx(8.0, rel=1e-6)
    assert ballistic_fall(0.0).duration == ballistic_fall(0.0).drift == 0


def test_a_diving_vehicle_lands_where_it_is():
    fall = ballistic_fall(30.0, pitch=-np.pi / 2)
    assert fall.drift == pytest.approx(0, abs=1e-9)
    assert fall_speed(30.0) < fall.fall_speed < np.hypot(fall_speed(30.0), 16.0)


def test_what_sinks_at_a_snails_pace_arrives_too():
    under_canvas = replace(RISK_QUADROTOR, fall_drag_area=300.0)
    pace = terminal_speed(under_canvas)
    assert pace < 0.3
    fall = ballistic_fall(30.0, under_canvas)
    assert fall.duration == pytest.approx(30 / pace, rel=0.01)
    assert fall.fall_speed == pytest.approx(pace, rel=1e-6)


@given(st.floats(0.1, 20), speeds, speeds)
def test_energy_is_that_of_the_whole_speed(mass, forward, down):
    assert impact_energy(mass, forward, down) == pytest.approx(mass * np.hypot(forward, down) ** 2 / 2)


def test_lethal_area_at_thirty_metres():
    assert lethal_area(30.0, 16.0, fall_speed(30.0)) == pytest.approx(1.653, abs=5e-4)


@given(st.floats(2, 500), speeds, st.floats(0.1, 2))
def test_lethal_area_is_a_disc_dragged_along(height, forward, radius):
    glide = PERSON_HEIGHT * forward / float(fall_speed(height))
    reach = radius + PERSON_RADIUS
    dragged = shapely.LineString([(0, 0), (glide, 0)]).buffer(reach, quad_segs=200)
    area = dragged.area if glide > 0 else np.pi * reach**2
    assert lethal_area(height, forward, fall_speed(height), 2 * radius) == pytest.approx(area, rel=1e-4)


def test_one_half_disc_less_is_the_area_that_casex_1_2_3_counts():
    """It encloses the same glide, with half a disc at one end only."""
    area = lethal_area(30.0, 16.0, fall_speed(30.0))
    assert area - np.pi * REACH**2 / 2 == pytest.approx(1.335, abs=1e-3)


def test_lethal_area_close_to_the_ground_is_the_disc():
    disc = np.pi * REACH**2
    assert lethal_area(0.0, 16.0, 0.0) == pytest.approx(disc)
    height = np.array([1e-9, 1e-6, 1e-3])
    area = lethal_area(height, 16.0, fall_speed(height))
    assert (np.diff(area) > 0).all()
    assert area[0] == pytest.approx(disc, rel=1e-3)
    glide = 0.5 * 16.0 / fall_speed(0.5)  # from half a metre it glides from there, not from a head's height
    assert lethal_area(0.5, 16.0, fall_speed(0.5)) == pytest.approx(disc + 2 * REACH * glide)


def test_numbers_of_8_bits_are_numbers():
    assert impact_energy(1.5, np.uint8(16), np.uint8(20)) == impact_energy(1.5, 16.0, 20.0)
    assert ballistic_fall(np.uint8(30), speed=np.uint8(16)) == ballistic_fall(30.0, speed=16.0)


def test_lethal_area_broadcasts():
    assert lethal_area(np.full((2, 1), 30.0), 16.0, fall_speed([10.0, 20.0, 30.0])).shape == (2, 3)
    assert lethal_area(30.0, 0.0, 0.0) == pytest.approx(np.pi * REACH**2)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: fall_speed(-1), "height must be finite and at least 0, got -1"),
        (lambda: fall_speed([3, NAN]), "height must be finite and at least 0, got nan"),
        (lambda: fall_speed("30"), "height must be a number .* got text, '30'"),
        (lambda: fall_speed(3, air_density=0), "air_density must be finite and above 0, got 0"),
        (lambda: terminal_speed(air_density=-1), "air_density must be finite and above 0, got -1"),
        (lambda: terminal_speed(air_density=[1.0, 1.2]), r"air_density must be one number, got .* shape \(2,\)"),
        (lambda: fall_speed(30, air_density=np.ones(3)), r"air_density must be one number, got .* shape \(3,\)"),
        (lambda: ballistic_fall(30, pitch=[0.1]), r"pitch must be one number, got an array of shape \(1,\)"),
        (lambda: impact_energy([1, 2], 1, 1), r"mass must be one number, got an array of shape \(2,\)"),
        (lambda: lethal_area(1, 1, 1, [0.5]), r"uav_diameter must be one number, got an array of shape \(1,\)"),
        (lambda: ballistic_fall(-1), "height must be from 0 to 50000 m, got -1"),
        (lambda: ballistic_fall(np.inf), "height must be from 0 to 50000 m, got inf"),
        (lambda: ballistic_fall(3, speed=-16), "speed must be finite and at least 0, got -16"),
        (lambda: ballistic_fall(3, speed=[1, 2]), r"speed must be one number, got an array of shape \(2,\)"),
        (lambda: ballistic_fall(3, pitch=30), r"pitch must be from -1.5708 to 1.5708 rad \(from degrees: .* got 30"),
        (lambda: ballistic_fall(3, pitch=NAN), "pitch must be .* got nan"),
        (lambda: ballistic_fall(3, air_density=NAN), "air_density must be finite and above 0, got nan"),
        (lambda: impact_energy(0, 1, 1), "mass must be finite and above 0, got 0"),
        (lambda: impact_energy(1, -1, 1), "forward_speed must be finite and at least 0, got -1"),
        (lambda: impact_energy(1, 1, -1), "fall_speed must be finite and at least 0, got -1"),
        (lambda: lethal_area(-1, 1, 1), "height must be finite and at least 0, got -1"),
        (lambda: lethal_area(1, -1, 1), "forward_speed must be finite and at least 0, got -1"),
        (lambda: lethal_area(1, 1, NAN), "fall_speed must be finite and at least 0, got nan"),
        (lambda: lethal_area(1, 1, 1, -0.2), "uav_diameter must be finite and at least 0, got -0.2"),
        (lambda: lethal_area(1, 1, 1, person_radius=-1), "person_radius must be finite and at least 0"),
        (lambda: lethal_area(1, 1, 1, person_height=NAN), "person_height must be finite and at least 0"),
        (lambda: lethal_area([0, 9], 16, [0, 0]), "fall_speed must be above 0 where .* it would glide for ever"),
    ],
)
def test_wrong_questions_are_refused_by_name(call, message):
    with pytest.raises(ValueError, match=message):
        call()
