"""The vehicle as another process: it comes, flies and goes, and leaves nothing behind."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uavlab.city import City
from uavlab.mavlink import FlightLog, connect, download, follow, start, upload
from uavlab.mission import Mission
from uavlab.route import Route
from uavlab.vehicle_sim import P840, simulated_vehicle
from uavlab.weather import Weather, Wind

CALM = Wind((2.0, 0.0), deviation=0.3)


def free(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", port))
    return True


def children():
    """Numbers of this process's own children, where the system says them."""
    folder = Path(f"/proc/{os.getpid()}/task")
    return (
        {int(n) for task in folder.glob("*/children") for n in task.read_text().split()} if folder.exists() else set()
    )


def test_a_mission_to_a_roof_is_uploaded_flown_and_read_back(campus):
    """From the ground of the campus to the roof of a building, in wind, over a radio as RISK-ACO's."""
    roof = campus.city.buildings[2].bounds
    middle, top = roof.mean(axis=0), roof[1, 2]
    route = Route([(12.5, 17.5, 65.0), (75.0, 75.0, 65.0), (*middle[:2], top + 12.0)])
    mission = Mission.from_route(route, campus.city, campus.uav, speed=8.0)
    with (
        simulated_vehicle(
            campus.city, campus.uav, Weather(forecast_wind=3.0), (12.5, 17.5), link=P840, pace=20.0
        ) as vehicle,
        connect(vehicle.address) as link,
    ):
        back = upload(mission, link)
        assert (back.items, back.fence) == (mission.items, mission.fence)
        start(link)
        log = FlightLog(mission, campus.city, list(follow(link)))
        assert download(link).items == mission.items
    assert vehicle.process.returncode == 0
    assert log.outcome == "arrived"
    assert log.position[-1, 2] == pytest.approx(top, abs=4.0)  # as GPS has it
    assert np.hypot(*(log.position[-1] - middle)[:2]) < 3.0


def test_ten_flights_in_a_row_leave_nothing_behind(meadow, campus):
    mission = Mission.from_route(Route([(0, 0, 15), (30, 0, 15)]), meadow, campus.uav, speed=8.0)
    before, ports = children(), set()
    for number in range(10):
        with simulated_vehicle(meadow, campus.uav, CALM, (0, 0), pace=50.0, rng=number) as vehicle:
            with connect(vehicle.address) as link:
                upload(mission, link)
                start(link)
                log = FlightLog(mission, meadow, list(follow(link)))
            assert log.outcome == "arrived"
        ports.add(vehicle.port)
        assert vehicle.process.returncode == 0
        with pytest.raises(ProcessLookupError):
            os.kill(vehicle.process.pid, 0)
    assert children() == before
    assert all(free(port) for port in ports)


def test_it_goes_when_the_block_ends_in_an_error(meadow, campus):
    with pytest.raises(KeyError), simulated_vehicle(meadow, campus.uav, CALM, (0, 0)) as vehicle:
        raise KeyError("a mistake in the notebook")
    assert vehicle.process.returncode == 0
    assert free(vehicle.port)


def test_it_goes_when_its_parent_is_killed(tmp_path):
    """A kernel that is restarted takes its vehicles with it."""
    program = tmp_path / "parent.py"
    program.write_text(
        "import time, numpy as np\n"
        "from uavlab.city import City, Place\n"
        "from uavlab.vehicle import LIGHT_QUADROTOR\n"
        "from uavlab.vehicle_sim import simulated_vehicle\n"
        "from uavlab.weather import Wind\n"
        "city = City(np.zeros((4, 4, 4), bool), 10.0, reference=Place(8.5, 47.25))\n"
        "with simulated_vehicle(city, LIGHT_QUADROTOR, Wind(), (5, 5)) as vehicle:\n"
        "    print(vehicle.process.pid, flush=True)\n"
        "    time.sleep(600)\n"
    )
    parent = subprocess.Popen([sys.executable, str(program)], stdout=subprocess.PIPE, text=True)
    child = int(parent.stdout.readline())
    os.kill(child, 0)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline and running(child):
        time.sleep(0.1)
    assert not running(child)


def running(process):
    """Whether a process runs; one that is only waited for no more doesn't."""
    status = Path(f"/proc/{process}/stat")
    return status.exists() and status.read_text().rpartition(")")[2].split()[0] != "Z"


def test_it_ends_after_its_lifetime(meadow, campus):
    with simulated_vehicle(meadow, campus.uav, CALM, (0, 0), lifetime=0.5) as vehicle:
        assert vehicle.process.wait(20) == 0


@pytest.mark.parametrize(
    ("wrong", "name"),
    [({"at": (1.0,)}, "at"), ({"at": (0, 0, np.nan)}, "at"), ({"at": (900, 0)}, "at"), ({"pace": 0}, "pace"),
     ({"pace": 1000}, "pace"), ({"port": 70_000}, "port"), ({"port": 1.5}, "port"), ({"firmware": "dji"}, "firmware"),
     ({"rng": -1}, "rng"), ({"rng": None}, "rng"), ({"lifetime": 0}, "lifetime"), ({"link": "p840"}, "link"),
     ({"gps": None}, "gps"), ({"weather": 5.0}, "weather"), ({"uav": None}, "uav"), ({"city": None}, "city")],
)  # fmt: skip
def test_wrong_arguments_are_named(meadow, campus, wrong, name):
    right = {"city": meadow, "uav": campus.uav, "weather": CALM, "at": (0, 0)}
    with pytest.raises(ValueError, match=rf"\b{name}\b"), simulated_vehicle(**(right | wrong)):
        pass


def test_a_city_without_a_place_is_refused_with_the_cure(campus):
    nowhere = City(np.zeros((4, 4, 4), bool), 10.0)
    with (
        pytest.raises(ValueError, match="reference=\\(longitude, latitude, height\\)"),
        simulated_vehicle(nowhere, campus.uav, CALM, (5, 5)),
    ):
        pass


def test_a_place_in_a_building_is_refused(town, campus):
    with (
        pytest.raises(ValueError, match="lies in building 'tower'"),
        simulated_vehicle(town, campus.uav, CALM, (50, 50, 10)),
    ):
        pass


def test_a_port_that_is_taken_is_said(meadow, campus):
    with simulated_vehicle(meadow, campus.uav, CALM, (0, 0)) as vehicle:
        again = simulated_vehicle(meadow, campus.uav, CALM, (0, 0), port=vehicle.port)
        with pytest.raises(RuntimeError, match=r"didn't start.*in use"), again:
            pass


def test_infinite_batteries_travel(meadow, campus):
    with (
        simulated_vehicle(meadow, replace(campus.uav, battery=np.inf), CALM, (0, 0)) as vehicle,
        connect(vehicle.address) as link,
    ):
        assert link.receive("SYS_STATUS", timeout=5.0).battery_remaining == -1


def shell(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "uavlab.vehicle_sim", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_from_a_shell_it_calls_a_ground_station():
    with connect("udp:127.0.0.1:0", wait=False) as link:
        process = shell(
            "--station", f"127.0.0.1:{link.port}", "--port", "0", "--pace", "2", "--city", "table1", "--at", "5,5"
        )
        try:
            deadline = time.monotonic() + 180
            while link.vehicle is None and time.monotonic() < deadline:
                link.receive("HEARTBEAT", timeout=1.0)
            assert link.vehicle == (1, 1)
        finally:
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=20)
    assert process.returncode == 0
    assert "listening on udp 127.0.0.1:" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["--pace", "0"], "--pace must be"), (["--city", "no.geojson"], "no.geojson"), (["--at", "900,0"], "off the map"),
     (["--station", "8.8.8.8:14550"], "on this machine"), (["--at", "1"], "two or three numbers"),
     (["--station", "here"], "a host and a port")],
)  # fmt: skip
def test_a_wrong_question_from_a_shell(arguments, words):
    process = shell("--port", "0", *arguments)
    _, error = process.communicate(timeout=120)
    assert process.returncode == 2
    assert words in error
    assert "Traceback" not in error


def test_damaged_settings_are_said(tmp_path):
    (tmp_path / "settings.json").write_text(json.dumps({}))
    process = shell("--settings", str(tmp_path))
    _, error = process.communicate(timeout=120)
    assert process.returncode == 2
    assert "city.npz" in error


def test_where_it_really_was_is_written_in_the_end(meadow, campus, tmp_path):
    mission = Mission.from_route(Route([(0, 0, 15), (60, 0, 15)]), meadow, campus.uav, speed=8.0)
    started = simulated_vehicle(meadow, campus.uav, CALM, (0, 0), pace=20.0, truth=tmp_path / "truth.csv")
    with started as vehicle, connect(vehicle.address) as link:
        upload(mission, link)
        start(link)
        log = FlightLog(mission, meadow, list(follow(link)))
    truth = np.genfromtxt(tmp_path / "truth.csv", delimiter=",", names=True)
    assert np.diff(truth["time_s"]).min() > 0
    assert truth["x_m"][-1] == pytest.approx(60.0, abs=6.0)
    both = np.isin(truth["time_s"].round(1), log.time.round(1))
    heard = log.position[np.isin(log.time.round(1), truth["time_s"].round(1))]
    assert both.sum() > 50
    assert truth["gps_x_m"][both] == pytest.approx(heard[:, 0], abs=0.05)
    wrong = np.hypot(truth["x_m"] - truth["gps_x_m"], truth["y_m"] - truth["gps_y_m"])
    assert wrong[0] < 0.3 < wrong.max()
