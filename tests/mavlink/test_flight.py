"""Missions flown by MAVLink, seen from the ground."""

import csv
import time
from dataclasses import replace

import numpy as np
import pytest

from uavlab.flight import PERFECT_GPS
from uavlab.mavlink import (
    CommandDeniedError,
    FlightLog,
    Telemetry,
    connect,
    follow,
    go_home,
    hold,
    land,
    start,
    upload,
)
from uavlab.mission import FencePolygon
from uavlab.plot import ground_station
from uavlab.vehicle_sim import DataLink


def address(server):
    return f"udpout:127.0.0.1:{server.port}"


def flown(link, mission, city):
    return FlightLog(mission, city, list(follow(link)))


@pytest.mark.parametrize("firmware", ["px4", "ardupilot"])
def test_a_mission_is_flown_and_followed(campus, mission, served, firmware):
    with served(campus.city, firmware=firmware, pace=20.0) as server, connect(address(server)) as link:
        upload(mission, link)
        start(link)
        log = flown(link, mission, campus.city)
    reached = [number for one in log.samples for number in one.reached]
    assert reached == [n for n, item in enumerate(mission.items) if item.command != 178]
    assert log.outcome == "arrived"
    assert not log.samples[-1].armed
    assert log.deviation.max() < 2.0
    assert log.position[-1] == pytest.approx([112.5, 112.5, 0.0], abs=2.5)
    assert np.diff(log.time).min() > 0.05
    assert log.time[-1] - log.time[0] > mission.path(campus.city).length / 8.0
    assert {"mission", "ready"} >= {one.mode for one in log.samples}
    assert log.battery[-1] < 100
    assert len(log.breaches) == 0
    currents = [one.current for one in log.samples if one.current >= 0]
    assert currents == sorted(currents)


def test_over_a_poor_link_it_flies_all_the_same(campus, mission, served):
    with served(campus.city, link=DataLink(loss=0.2)) as server, connect(address(server)) as link:
        upload(mission, link)
        start(link)
        log = flown(link, mission, campus.city)
        assert server.vehicle.pilot.finished
    assert log.deviation.max() < 2.0


def test_commands_from_the_ground(meadow, square, served):
    with served(meadow, (0, 0, 5), gps=PERFECT_GPS, pace=20.0) as server, connect(address(server)) as link:
        for told in (hold, go_home, land):
            if told is not hold:
                with pytest.raises(CommandDeniedError, match="it isn't flying"):
                    told(link)
        upload(square, link)
        start(link)
        telemetry = follow(link)
        next(one for one in telemetry if one.above_home > 25)
        with pytest.raises(Exception, match="old mission: denied"):
            upload(square, link)
        hold(link)
        assert next(one for one in telemetry if one.mode == "hold").armed
        start(link)
        assert next(one for one in telemetry if one.mode == "mission").armed
        land(link)
        modes = [one.mode for one in telemetry]
        assert "land" in modes
        start(link)
        telemetry = follow(link)
        next(one for one in telemetry if one.above_home > 10)
        go_home(link)
        assert "return" in [one.mode for one in telemetry]
        deadline = time.monotonic() + 5
        while server.vehicle.pilot.armed and time.monotonic() < deadline:
            time.sleep(0.05)
        assert server.vehicle.pilot.body.where.position == pytest.approx([0, 0, 0], abs=1.5)


def test_the_moment_a_fence_is_met(meadow, square, served, tmp_path):
    narrow = FencePolygon(((47.2495, 8.4995), (47.2510, 8.4995), (47.2510, 8.5004), (47.2495, 8.5004)), inclusion=True)
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        upload(square, link)
        start(link)
        samples = []
        for one in follow(link):
            if not samples:
                server.vehicle.pilot.watch((narrow,))
            samples.append(one)
    log = FlightLog(replace(square, fence=(narrow,)), meadow, samples)
    assert len(log.breaches) == 1
    at = log.position[np.searchsorted(log.time, log.breaches[0])]
    edge = meadow.from_geographic((8.5004, 47.25, 420.0))[0]
    assert edge <= at[0] < edge + 12  # told once a second
    assert any("fence breached" in words for one in samples for words in one.said)
    assert log.outcome == "landed"
    assert "fence left" in [text.get_text() for text in ground_station(log).legends[0].get_texts()]


def test_a_vehicle_that_falls_silent(meadow, square, served):
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        upload(square, link)
        start(link)
        telemetry = follow(link, silence=2.0)
        for _ in range(20):
            next(telemetry)
        server.over.set()
        with pytest.raises(TimeoutError, match=r"the vehicle was followed and didn't answer for 2 s"):
            list(telemetry)


def test_a_command_that_nobody_hears(meadow, square, served, monkeypatch):
    monkeypatch.setattr("uavlab.mavlink.commands.TIMEOUT", 0.5)
    with served(meadow, (0, 0, 5)) as server, connect(address(server)) as link:
        server.over.set()
        time.sleep(0.1)
        with pytest.raises(TimeoutError, match="was told to arm"):
            start(link)


def sample(time, x=0.0, **more):
    return Telemetry(time, 8.5, 47.25 + x / 111_177.0, 450.0, 30.0, (3.0, 4.0, 0.0), 80.0, "mission", True, 2, **more)


def test_a_log_measures_from_the_plan(meadow, square):
    log = FlightLog(square, meadow, [sample(1.0, 0.0), sample(2.0, 3.0), sample(3.0, 5.0, breached=True, reached=(0,))])
    assert log.deviation == pytest.approx([0.0, 3.0, 5.0], abs=0.02)
    assert log.position[:, 1] == pytest.approx([0.0, 3.0, 5.0], abs=0.02)
    assert log.breaches.tolist() == [3.0]
    assert log.outcome == "gave up"
    assert "3 samples, 2.0 s" in repr(log)
    flight = log.flight()
    assert flight.outcome == "gave up"
    assert np.linalg.norm(flight.position - flight.reference, axis=1) == pytest.approx(log.deviation)
    assert flight.column("speed") == pytest.approx([5.0, 5.0, 5.0])


@pytest.mark.parametrize(
    ("armed", "mode", "current", "outcome"),
    [(False, "ready", 5, "arrived"), (False, "ready", 3, "landed"), (False, "crashed", 5, "crashed"),
     (True, "mission", 5, "gave up")],
)  # fmt: skip
def test_how_a_flight_ended(meadow, square, armed, mode, current, outcome):
    log = FlightLog(square, meadow, [sample(1.0), sample(2.0)._replace(armed=armed, mode=mode, current=current)])
    assert log.outcome == outcome
    assert log.flight().outcome == outcome


def test_a_log_as_a_table(meadow, square, tmp_path):
    FlightLog(square, meadow, [sample(1.0), sample(2.0, 3.0)]).to_csv(tmp_path / "log.csv")
    rows = list(csv.DictReader((tmp_path / "log.csv").open()))
    assert [row["time_s"] for row in rows] == ["1.00", "2.00"]
    assert float(rows[1]["y_m"]) == pytest.approx(3.0, abs=0.02)
    assert float(rows[1]["from_plan_m"]) == pytest.approx(3.0, abs=0.02)
    assert (rows[0]["mode"], rows[0]["item"], rows[0]["speed_m_per_s"]) == ("mission", "2", "5.00")


def test_an_empty_log(meadow, square):
    log = FlightLog(square, meadow, [])
    assert repr(log) == "<FlightLog: nothing heard>"
    assert log.position.shape == (0, 3)
    assert len(log.deviation) == 0
    assert ground_station(log).axes[0].get_title() == "nothing heard yet"
    with pytest.raises(ValueError, match="samples must be at least two"):
        log.flight()


def test_wrong_arguments_are_named(meadow, square):
    for name, arguments in (
        ("mission", (meadow, meadow, [])), ("city", (square, square, [])), (r"samples\[0\]", (square, meadow, [1])),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=f"{name} must be"):
            FlightLog(*arguments)
    with pytest.raises(ValueError, match="link must be a Link"):
        follow("udp:127.0.0.1:14550")
    with pytest.raises(ValueError, match="link must be a Link"):
        start("udp:127.0.0.1:14550")
