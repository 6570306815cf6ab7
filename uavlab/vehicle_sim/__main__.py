"""`python -m uavlab.vehicle_sim`: a vehicle that ground stations can talk to, such as QGroundControl or a notebook.

It calls a ground station on this machine, by default where those listen, udp port 14550; it also listens itself, and
answers whoever calls. Ctrl-C ends it.
"""

from __future__ import annotations

import argparse
import signal
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from uavlab.vehicle_sim.process import FASTEST, FIRMWARES, LONGEST, announce, serve, standing_place
from uavlab.vehicle_sim.radio import P840, PERFECT_LINK

SOMEWHERE = (8.5000, 47.2500, 420.0)
"""Where cities without a place on Earth are put, if nothing else is said."""

LINKS = {"perfect": PERFECT_LINK, "p840": P840}


def main(arguments: list[str] | None = None) -> int:
    """Be a vehicle; 0 when it is stopped, 2 for a wrong question."""
    options = parser().parse_args(arguments)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # which shells switch off for what runs in the background
    try:
        if options.settings is not None:
            serve(options.settings)
        else:
            run(options)
    except (ValueError, OSError, ImportError) as error:
        print(f"uavlab.vehicle_sim: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        pass
    return 0


def parser() -> argparse.ArgumentParser:
    command = argparse.ArgumentParser(
        prog="python -m uavlab.vehicle_sim",
        description="A simulated multirotor that speaks MAVLink, for ground stations on this machine.",
    )
    command.add_argument(
        "--city", default="campus", metavar="NAME|FILE", help="campus (the default), table1, or a file"
    )
    command.add_argument("--home", type=numbers, default=SOMEWHERE, metavar="LON,LAT[,HEIGHT]",
                         help="where x = y = z = 0 of a city without a place lies; default %(default)s")  # fmt: skip
    command.add_argument("--at", type=numbers, default=(12.5, 17.5, 22.5), metavar="X,Y[,Z]",
                         help="where it stands on the map, in metres; default %(default)s")  # fmt: skip
    command.add_argument("--wind", type=float, default=4.0, metavar="M/S", help="mean wind; default %(default)s")
    command.add_argument("--wind-from", type=float, default=240.0, metavar="DEG", help="default %(default)s (0: north)")
    command.add_argument(
        "--seed", type=int, default=1, metavar="N", help="of gusts, GPS and radio; default %(default)s"
    )
    command.add_argument("--link", choices=LINKS, default="perfect", help="the radio; p840 is RISK-ACO's")
    command.add_argument(
        "--firmware", choices=FIRMWARES, default="px4", help="as which it behaves; default %(default)s"
    )
    command.add_argument("--station", type=peer, default=("127.0.0.1", 14550), metavar="HOST:PORT",
                         help="the ground station that it calls, on this machine; default 127.0.0.1:14550")  # fmt: skip
    command.add_argument(
        "--port", type=int, default=14580, metavar="N", help="on which it listens; default %(default)s"
    )
    command.add_argument("--pace", type=float, default=1.0, metavar="N", help="seconds of flight a second; default 1")
    command.add_argument("--settings", type=Path, metavar="FOLDER", help=argparse.SUPPRESS)
    return command


def numbers(text: str) -> tuple[float, ...]:
    """Two or three numbers, as in 12.5,17.5."""
    try:
        found = tuple(float(part) for part in text.split(","))
    except ValueError:
        found = ()
    if len(found) not in (2, 3):
        raise argparse.ArgumentTypeError(f"{text!r} must be two or three numbers, as in 12.5,17.5")
    return found


def peer(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not host or not port.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} must be a host and a port, as in 127.0.0.1:14550")
    return host, int(port)


def run(options: argparse.Namespace) -> None:
    """Make the vehicle that was asked for, and serve."""
    from uavlab.city import read_city, table1_city
    from uavlab.flight import Autopilot
    from uavlab.risk import reference_campus
    from uavlab.vehicle import LIGHT_QUADROTOR
    from uavlab.vehicle_sim.pilot import Pilot
    from uavlab.vehicle_sim.server import Server, Service
    from uavlab.weather import Weather, Wind

    if not 0.1 <= options.pace <= FASTEST:
        raise ValueError(f"--pace must be from 0.1 to {FASTEST:g}, got {options.pace:g}")
    uav = LIGHT_QUADROTOR
    if options.city == "campus":
        campus = reference_campus()
        city, uav = campus.city, campus.uav
    else:
        city = table1_city() if options.city == "table1" else read_city(options.city, cell=2.0)
    if city.reference is None:
        city = replace(city, reference=options.home)
    wind = Wind.from_weather(Weather(forecast_wind=options.wind, wind_from_deg=options.wind_from))
    flight, radio = np.random.default_rng(options.seed).spawn(2)
    autopilot = Autopilot(heeds_limits=False)
    pilot = Pilot.standing(city, uav, wind, autopilot, standing_place(city, options.at), flight)
    service = Service(
        port=options.port, station=options.station, link=LINKS[options.link], pace=options.pace, lifetime=LONGEST
    )
    print(f"{uav!r}\n{wind!r}\ncalls udp {options.station[0]}:{options.station[1]}; Ctrl-C ends it", flush=True)
    announce(Server(pilot, FIRMWARES[options.firmware], service, radio))


if __name__ == "__main__":
    sys.exit(main())
