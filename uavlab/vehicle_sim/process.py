"""The vehicle as another process: started, flown, gone."""

from __future__ import annotations

import json
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from uavlab import checks, storage
from uavlab.city import City
from uavlab.flight import Autopilot
from uavlab.flight.autopilot import GPS, Gps, checked_gps
from uavlab.mavlink.dialect import ARDUPILOT, PX4, messages
from uavlab.vehicle import UAV
from uavlab.vehicle_sim.pilot import Pilot
from uavlab.vehicle_sim.radio import PERFECT_LINK, DataLink
from uavlab.vehicle_sim.server import Server, Service
from uavlab.weather import Weather, Wind
from uavlab.weather.wind import wind_of

FIRMWARES = {"px4": PX4, "ardupilot": ARDUPILOT}

STARTING, STOPPING = 180.0, 5.0
"""How long its start may take, with a compiler on the way, and its end [s]."""

FASTEST = 100.0
"""Times the world's clock."""

LONGEST = 24 * 3600.0

READY = "listening on udp "
"""What it prints when it is there."""


class SimulatedVehicle(NamedTuple):
    """A vehicle in another process.

    Attributes
    ----------
    address : str
        For `uavlab.mavlink.connect`.
    port : int
        Its UDP port on this machine.
    process : subprocess.Popen

    See Also
    --------
    simulated_vehicle : Starts one.

    Examples
    --------
    >>> from uavlab.vehicle_sim import SimulatedVehicle
    >>> SimulatedVehicle("udpout:127.0.0.1:14580", 14580, None).address
    'udpout:127.0.0.1:14580'
    """

    address: str
    port: int
    process: Any


@contextmanager
def simulated_vehicle(
    city: City,
    uav: UAV,
    weather: Wind | Weather,
    at: npt.ArrayLike,
    *,
    rng: int = 0,
    gps: Gps = GPS,
    link: DataLink = PERFECT_LINK,
    firmware: str = "px4",
    pace: float = 1.0,
    port: int = 0,
    lifetime: float = 3600.0,
    truth: str | Path | None = None,
) -> Iterator[SimulatedVehicle]:
    """A vehicle that speaks MAVLink and flies over a city, in a process of its own, for as long as the block lasts.

    It moves as `uavlab.flight.fly` does: a body with limited thrust in wind and gusts, with GPS that drifts and a
    battery. It takes missions, fences and rally points, checks them, flies them, says where it is ten times a second,
    goes home when it leaves its fence or has only the reserve left, and crashes where there are walls.

    Parameters
    ----------
    city : City
        With its place on Earth.
    uav : UAV
    weather : Wind or Weather
        In which it flies.
    at : (2,) or (3,) array
        Where it stands on the map [m]: on what lies there, or, with a height, below that.
    rng : int
        Seed of gusts, GPS and radio.
    gps : Gps
        What it knows of where it is.
    link : DataLink
        The radio; by default all is heard at once. `P840` is RISK-ACO's.
    firmware : {"px4", "ardupilot"}
        As which it behaves: ArduPilot's missions begin with home.
    pace : float
        Seconds of flight, and of its radio, in one of the world, 0.1 to 100.
    port : int
        To listen on, on this machine only; 0: any that is free.
    lifetime : float
        After so many seconds it ends in any case [s], above 0, at most a day.
    truth : str or Path, optional
        Where to write, when the block ends, where it really was in flight: a table of time [s], place, and place as GPS
        had it [m]. No ground station knows that.

    Yields
    ------
    SimulatedVehicle
        With its address.

    Raises
    ------
    ValueError
        If `city` is no City or has no place on Earth; `uav`, `weather`, `gps` or `link` is of another kind; `at` is not
        two or three finite numbers, or not free; `rng` is no seed; `firmware` is unknown; or `pace`, `port` or
        `lifetime` is out of its range; or `truth` is not the name of a file.
    RuntimeError
        If it doesn't start; the message has what it said.

    See Also
    --------
    uavlab.mavlink.upload : Give it a mission.
    uavlab.flight.fly : A flight without all this.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from uavlab.city import Place
    >>> from uavlab.mavlink import connect
    >>> from uavlab.risk import CAMPUS_FLIGHT, reference_campus
    >>> from uavlab.vehicle_sim import simulated_vehicle
    >>> from uavlab.weather import Wind
    >>> campus = reference_campus()
    >>> city = replace(campus.city, reference=Place(8.5, 47.25, 420.0))
    >>> with simulated_vehicle(city, campus.uav, Wind((4, 0)), CAMPUS_FLIGHT[0]) as vehicle:
    ...     with connect(vehicle.address) as link:
    ...         link.vehicle
    (1, 1)
    """
    messages()  # before any work
    made = settings_of(uav, weather, gps, link)
    place = standing_place(city, at)
    one = {
        "rng": checks.whole("rng", rng, 0),
        "firmware": checks.one_of("firmware", firmware, FIRMWARES),
        "pace": checks.number("pace", pace, checks.within, 0.1, FASTEST, "times the world's clock"),
        "port": checks.whole("port", port, 0, 65535),
        "lifetime": checks.number("lifetime", lifetime, checks.within, 0.1, LONGEST, "s"),
        "at": place.tolist(),
        "truth": None if truth is None else str(checks.path("truth", truth).resolve()),
    }
    with tempfile.TemporaryDirectory(prefix="uavlab") as folder:
        storage.save(city, Path(folder) / "city.npz")
        (Path(folder) / "settings.json").write_text(json.dumps(made | one), encoding="utf-8")
        command = [sys.executable, "-m", "uavlab.vehicle_sim", "--settings", folder]
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        try:
            port = port_of(process)
            yield SimulatedVehicle(f"udpout:127.0.0.1:{port}", port, process)
        finally:
            stop(process)


def settings_of(uav: UAV, weather: Wind | Weather, gps: Gps, link: DataLink) -> dict[str, Any]:
    """What the process is to know, as JSON takes it; infinite numbers as text."""
    checks.instance("uav", uav, UAV)
    checks.instance("link", link, DataLink)
    parts = {
        "uav": asdict(uav),
        "wind": asdict(wind_of(weather, "weather")),
        "gps": checked_gps(gps)._asdict(),
        "link": asdict(link),
    }
    return {
        name: {key: str(value) if value == np.inf else value for key, value in part.items()}
        for name, part in parts.items()
    }


def standing_place(city: City, at: npt.ArrayLike) -> np.ndarray:
    """The point (3,) below which it stands [m]."""
    checks.instance("city", city, City)
    city.checked_reference()
    place = checks.numbers("at", at)
    if place.shape not in ((2,), (3,)) or not np.isfinite(place).all():
        raise ValueError(f"at must be two or three finite numbers (x, y[, z]) in metres, got {at!r:.60}")
    point = np.append(place, city.bounds[1, 2] - city.cell / 2) if len(place) == 2 else place
    if not city.is_free(point):
        raise ValueError(
            f"at {checks.show(point)} lies in {city.building_at(point)}, or off the map: choose another place"
        )
    return point


def port_of(process: subprocess.Popen) -> int:
    """The port on which a new process listens, as it prints it; `RuntimeError` with what it says instead."""
    assert process.stdout is not None
    end, said = time.monotonic() + STARTING, []
    while time.monotonic() < end:
        ready, _, _ = select.select([process.stdout], [], [], 0.2)
        line = process.stdout.readline() if ready else ""
        if line.startswith(READY):
            return int(line.rpartition(":")[2])
        if line:
            said.append(line.rstrip())
        elif process.poll() is not None:
            break
    raise RuntimeError(f"the simulated vehicle didn't start: {' / '.join(said[-3:]) or 'it said nothing'}")


def stop(process: subprocess.Popen) -> None:
    """End a process: it ends by itself when its input does; who doesn't is ended."""
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.close()
    try:
        process.wait(STOPPING)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    process.stdout.close()


def serve(folder: Path) -> None:
    """What the process does: read what it is, print its port, be a vehicle."""
    city = storage.load(folder / "city.npz")
    checks.instance("city", city, City)
    read = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    parts: dict[str, dict[str, Any]] = {
        name: {key: float(value) if value == "inf" else value for key, value in read[name].items()}
        for name in ("uav", "wind", "gps", "link")
    }
    wind = Wind(**parts["wind"])
    autopilot = Autopilot(gps=Gps(**parts["gps"]), heeds_limits=False)
    flight, radio = np.random.default_rng(read["rng"]).spawn(2)
    pilot = Pilot.standing(city, UAV(**parts["uav"]), wind, autopilot, np.array(read["at"]), flight)  # type: ignore[arg-type]
    service = Service(
        port=read["port"],
        link=DataLink(**parts["link"]),
        pace=read["pace"],
        lifetime=read["lifetime"],
        truth=None if read["truth"] is None else Path(read["truth"]),
        with_parent=True,
    )
    announce(Server(pilot, FIRMWARES[read["firmware"]], service, radio))


def announce(server: Server) -> None:
    """Say where it listens, and serve."""
    print(f"{READY}{server.service.host}:{server.port}", flush=True)
    server.run()
