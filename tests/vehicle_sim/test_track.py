"""How far the vehicle is from its plan: as far as gusts and GPS together say it should be."""

from functools import cache

import numpy as np

from uavlab.flight import GPS, PERFECT_GPS, offset_sigma
from uavlab.mission import Mission
from uavlab.route import Route
from uavlab.weather import Wind

FLIGHTS, SPEED = 200, 5.0
SETTLED = 40
"""Tenths of a second after a turn; then only gusts and GPS are left."""

WINDY = Wind((4.0, 2.0), deviation=1.0, correlation=1.5)
WAY = [(0.0, 0.0, 40.0), (120.0, 0.0, 40.0), (120.0, 80.0, 40.0), (0.0, 80.0, 40.0)]


def covariance_of(uav, wind):
    """Of level offsets by gusts, east and north [m²], for a ground velocity: theory, `offset_sigma`."""

    @cache
    def found(velocity):
        stream = np.array(wind.mean[:2]) - velocity
        along = stream / np.linalg.norm(stream)
        frame = np.column_stack([along, (-along[1], along[0])])
        sigma = offset_sigma(uav, wind, ground_velocity=(*velocity, 0.0), altitude=40.0)[:2]
        return frame @ np.diag(sigma**2) @ frame.T

    return found


def offsets_in_sigma(campus, meadow, standing, gps, told_of_gps):
    """Radius of each offset from the reference in the ellipse of gusts and GPS, in σ; from cruise on straight legs."""
    uav = campus.uav
    mission = Mission.from_route(Route(WAY), meadow, uav, speed=SPEED, corner_radius=2.0)
    gusts = covariance_of(uav, WINDY)
    radii = []
    for seed in range(FLIGHTS):
        pilot = standing(meadow, (0, 0, 5), wind=WINDY, gps=gps, seed=seed)
        pilot.watch(mission.fence)
        pilot.take(mission.items)
        pilot.arm()
        pilot.start()
        before, steady = pilot.body.where, 0
        while pilot.armed:
            pilot.tick()
            now = pilot.body.where
            velocity = (now.target - before.target)[:2] / (now.time - before.time)
            steady = steady + 1 if abs(np.linalg.norm(velocity) - SPEED) < 1e-6 else 0
            before = now
            if steady < SETTLED:
                continue
            drift = (1 - np.exp(-2 * now.time / told_of_gps.correlation)) * told_of_gps.drift**2
            covariance = gusts(tuple(velocity.round(6))) + drift * np.eye(2)
            offset = (now.position - now.target)[:2]
            radii.append(float(np.sqrt(offset @ np.linalg.solve(covariance, offset))))
    return np.array(radii)


def test_the_track_stays_in_the_ellipse_of_gps_and_gusts(campus, meadow, standing):
    """3σ in the plane hold 98.9 % (1 − e^−4.5) of what is normally distributed."""
    radii = offsets_in_sigma(campus, meadow, standing, GPS, GPS)
    assert len(radii) > 100 * FLIGHTS
    assert 0.98 <= np.mean(radii < 3.0) < 0.9985
    assert 0.80 < np.mean(radii < 2.0) < 0.93  # 86.5 %


def test_an_ellipse_of_gusts_alone_is_far_too_small(campus, meadow, standing, monkeypatch):
    monkeypatch.setattr(f"{__name__}.FLIGHTS", 20)
    assert np.mean(offsets_in_sigma(campus, meadow, standing, GPS, PERFECT_GPS) < 3.0) < 0.6
