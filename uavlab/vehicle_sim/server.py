"""The vehicle on a port of this machine: packets in and out, by a clock that may run faster than the world's."""

from __future__ import annotations

import os
import select
import socket
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uavlab.files import written_whole
from uavlab.mavlink.link import LARGEST, on_this_machine
from uavlab.vehicle_sim.body import Body, Where
from uavlab.vehicle_sim.pilot import TICK, Pilot
from uavlab.vehicle_sim.radio import Channel, DataLink
from uavlab.vehicle_sim.vehicle import Peer, Vehicle

LOOK = 0.01
"""How often it looks for packets, at least [s]."""

FORGOTTEN = 10.0
"""Who says nothing for so long is told nothing any more [s]."""

BACKLOG = 1.0
"""A clock that can't keep up runs slower than asked for rather than be so far behind [s]."""


class Service(NamedTuple):
    """How the vehicle is to be reached."""

    host: str = "127.0.0.1"
    port: int = 0
    """0: any that is free."""
    station: Peer | None = None
    """A ground station that is called without having called."""
    link: DataLink = DataLink()
    pace: float = 1.0
    """Seconds of flight in one of the world."""
    lifetime: float = 3600.0
    """After so many seconds it ends in any case."""
    truth: Path | None = None
    """Where to write, in the end, where it really was."""
    with_parent: bool = False
    """Whether it ends when its standard input does, as that of a parent that is gone."""


def rehearse(pilot: Pilot) -> None:
    """Fly a moment with another body, so that the flight is compiled before anybody waits for it in the air."""
    body = pilot.body
    other = Body(body.city, body.uav, body.wind, body.autopilot, pilot.home, np.random.default_rng(0))
    other.follow(pilot.home[None] + (0.0, 0.0, 1.0), 1.0)
    other.fly(TICK, low=True)


class Server:
    """A vehicle that is heard and talks."""

    def __init__(self, pilot: Pilot, autopilot: int, service: Service, rng: np.random.Generator) -> None:
        if not on_this_machine(service.host) or (service.station and not on_this_machine(service.station[0])):
            raise ValueError("host and station must be on this machine: a simulated vehicle talks to nobody else")
        rehearse(pilot)
        self.service = service
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((service.host, service.port))
        self.socket.setblocking(False)
        self.peers: dict[Peer, float] = {} if service.station is None else {service.station: np.inf}
        up, down = rng.spawn(2)
        self.up, self.down = Channel(service.link, up), Channel(service.link, down)
        self.vehicle = Vehicle(pilot, autopilot, self.send)
        self.over = threading.Event()
        self.now = time.monotonic()
        self.track: list[Where] = []
        self.clock = 0.0
        """By which the vehicle flies, and its radio sends [s]."""

    @property
    def port(self) -> int:
        return int(self.socket.getsockname()[1])

    def send(self, data: bytes, peer: Peer | None) -> None:
        """A packet to one ground station, or to all that are there."""
        self.down.put(self.clock, len(data), (data, peer))

    def run(self) -> None:
        """Until it is told to stop, its parent is gone, or its lifetime is over."""
        if self.service.with_parent:
            threading.Thread(target=self.wait_for_parent, daemon=True).start()
        began = last = self.now = time.monotonic()
        try:
            while not self.over.is_set() and self.now - began < self.service.lifetime:
                ready, _, _ = select.select([self.socket], [], [], LOOK)
                self.now = time.monotonic()
                if ready:
                    self.hear()
                gone, last = self.service.pace * min(self.now - last, BACKLOG), self.now
                self.clock += gone
                for data, peer in self.up.due(self.clock):
                    self.vehicle.receive(data, peer, self.now)
                self.vehicle.advance(gone, self.now)
                self.remember(self.vehicle.pilot.body.where)
                self.speak()
        finally:
            self.socket.close()
            if self.service.truth is not None:
                write_truth(self.service.truth, self.track)

    def remember(self, where: Where) -> None:
        """Keep where it really is, in flight, if that is to be written."""
        flies = self.service.truth is not None and self.vehicle.pilot.body.path is not None
        if flies and (not self.track or where.time > self.track[-1].time):
            self.track.append(where)

    def wait_for_parent(self) -> None:
        while os.read(0, LARGEST):  # not by sys.stdin, whose lock would be held when Python ends
            pass
        self.over.set()

    def hear(self) -> None:
        """Take all packets that have come."""
        while True:
            try:
                data, peer = self.socket.recvfrom(LARGEST)
            except (BlockingIOError, ConnectionRefusedError):
                return
            self.peers[peer] = max(self.peers.get(peer, 0.0), self.now)
            self.up.put(self.clock, len(data), (data, peer))

    def speak(self) -> None:
        """Send what is through the radio."""
        self.peers = {peer: heard for peer, heard in self.peers.items() if self.now - heard < FORGOTTEN}
        for data, one in self.down.due(self.clock):
            for peer in list(self.peers) if one is None else [one]:
                try:
                    self.socket.sendto(data, peer)
                except OSError:
                    continue  # nobody there any more


def write_truth(path: Path, track: Sequence[Where]) -> None:
    """Where it really was, and where GPS had it, in metres of the map, as a table."""
    rows = [[one.time, *one.position, *one.seen] for one in track]
    names = "time_s,x_m,y_m,z_m,gps_x_m,gps_y_m,gps_z_m"
    with written_whole(path) as part:
        np.savetxt(part, np.array(rows).reshape(-1, 7), fmt="%.3f", delimiter=",", header=names, comments="")
