"""A connection to a vehicle: UDP with MAVLink on it, heartbeats, a record of all that was said.

Only this machine is talked to unless the caller allows more: a game with a simulated vehicle mustn't start a real one.
"""

from __future__ import annotations

import ipaddress
import select
import socket
import struct
import time
from collections import deque
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Self

from uavlab import checks
from uavlab.mavlink.dialect import codec, messages, packed, sender_of
from uavlab.mavlink.patience import Patience

STATION_SYSTEM, STATION_COMPONENT = 255, 190
"""What ground stations call themselves."""

BEAT = 1.0
"""From heartbeat to heartbeat [s]."""

LARGEST = 65535
TIMEOUT = 10.0
"""How long a vehicle is waited for [s]."""


class Address(NamedTuple):
    """Where to talk: listening there until a vehicle calls, or calling."""

    host: str
    port: int
    listens: bool


class Link:
    """A connection to one vehicle.

    See Also
    --------
    connect : Makes one.

    Examples
    --------
    >>> from uavlab.mavlink import connect
    >>> with connect("udp:127.0.0.1:0", wait=False) as link:
    ...     link.vehicle is None
    True
    """

    def __init__(self, address: Address, record: Path | None) -> None:
        self.address = address
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            if address.listens:
                self.socket.bind((address.host, address.port))
            self.socket.setblocking(False)
        except OSError as error:
            self.socket.close()
            raise type(error)(
                error.errno,
                f"{error.strerror}: can't listen on {address.host}:{address.port}; another ground station may be "
                "open there: close it, or choose another port",
            ) from error
        try:
            self.record = None if record is None else record.open("wb")
        except OSError:
            self.socket.close()
            raise
        self.peer: tuple[str, int] | None = None if address.listens else (address.host, address.port)
        self.codec = codec(STATION_SYSTEM, STATION_COMPONENT)
        self.vehicle: tuple[int, int] | None = None
        """Its system and component, once it was heard."""
        self.autopilot = 0
        """MAV_AUTOPILOT."""
        self.corrupted = 0
        """Packets that were no message."""
        self.heard = -float("inf")
        """When the vehicle was heard last, by `time.monotonic`."""
        self.patience = Patience()
        self.waiting: deque[Any] = deque()
        self.beaten = -float("inf")
        self.closed = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        verb = "listens on" if self.address.listens else "calls"
        heard = "nobody heard" if self.vehicle is None else f"vehicle {self.vehicle[0]}"
        return f"<Link {verb} udp {self.address.host}:{self.address.port}, {'closed' if self.closed else heard}>"

    @property
    def port(self) -> int:
        """Of this end."""
        return int(self.socket.getsockname()[1])

    def close(self) -> None:
        """Free the port; what was recorded stays."""
        if not self.closed:
            self.closed = True
            self.socket.close()
            if self.record is not None:
                self.record.close()

    def send(self, message: Any) -> None:
        """Send a message, if it is known to whom."""
        data = packed(self.codec, message)
        if self.peer is not None:
            try:
                self.socket.sendto(data, self.peer)
            except (BlockingIOError, ConnectionRefusedError):
                return  # as if it were lost
            self.note(data)

    def receive(self, *kinds: str, timeout: float) -> Any:
        """The next message of one of these kinds, or of any; None if none comes in time [s]. Heartbeats go on."""
        end = time.monotonic() + timeout
        while True:
            while self.waiting:
                message = self.waiting.popleft()
                if not kinds or message.get_type() in kinds:
                    return message
            now = time.monotonic()
            self.beat(now)
            if now >= end:
                return None
            ready, _, _ = select.select([self.socket], [], [], min(end - now, BEAT / 4))
            if ready:
                self.read()

    def read(self) -> None:
        """Take what has come."""
        try:
            data, sender = self.socket.recvfrom(LARGEST)
        except (BlockingIOError, ConnectionRefusedError):
            return
        if self.peer is not None and sender != self.peer:
            return  # one vehicle at a time
        for message in self.codec.parse_buffer(data) or []:
            if message.get_type() == "BAD_DATA":
                self.corrupted += 1
                continue
            who = sender_of(message)
            if self.vehicle is None and message.get_type() == "HEARTBEAT" and message.autopilot != 8:  # a vehicle's own
                self.peer, self.vehicle, self.autopilot = sender, who, message.autopilot
            if who == self.vehicle:
                self.heard = time.monotonic()
                self.note(message.get_msgbuf())
                self.waiting.append(message)

    def beat(self, now: float) -> None:
        """Say that there is a ground station, once a second."""
        if now - self.beaten >= BEAT:
            self.beaten = now
            self.send(messages().MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3))

    def note(self, data: bytes) -> None:
        """A packet in the record, as MAVLink's tools have it: microseconds since 1970, and the packet."""
        if self.record is not None:
            self.record.write(struct.pack(">Q", int(time.time() * 1e6)) + bytes(data))


def connect(
    address: str,
    *,
    timeout: float = TIMEOUT,
    record: str | Path | None = None,
    allow_network: bool = False,
    wait: bool = True,
) -> Link:
    """A connection to a vehicle.

    Parameters
    ----------
    address : str
        "udp:127.0.0.1:14550" listens there until a vehicle calls, as most do; "udpout:127.0.0.1:14580" calls one that
        listens.
    timeout : float
        How long to wait for its heartbeat [s], above 0.
    record : str or Path, optional
        Where to keep all that is said, as `.tlog`, which MAVLink's tools open; what is there is replaced.
    allow_network : bool
        Whether `address` may be that of another machine. There a real vehicle may listen.
    wait : bool
        Whether to wait for the vehicle at all.

    Returns
    -------
    Link
        To be closed, best by `with connect(...) as link:`.

    Raises
    ------
    ValueError
        If `address` is none of these, or not on this machine and `allow_network` is not True; `timeout` is not above 0;
        `record` is not the name of a file; or `allow_network` or `wait` is neither True nor False.
    OSError
        If the port is taken, as by another ground station, or `record` can't be written.
    TimeoutError
        If no vehicle is heard.

    See Also
    --------
    upload : Takes such a link, or an address.
    uavlab.vehicle_sim.simulated_vehicle : A vehicle to talk to.

    References
    ----------
    MAVLink Developer Guide, heartbeat protocol, mavlink.io.

    Examples
    --------
    >>> from uavlab.mavlink import connect
    >>> connect("udp:192.168.1.7:14550")
    Traceback (most recent call last):
        ...
    ValueError: address must be on this machine, as udp:127.0.0.1:14550, got 'udp:192.168.1.7:14550': where a real \
vehicle may listen, allow_network=True is needed
    """
    where = checked_address(address, checks.flag("allow_network", allow_network))
    timeout = checks.positive_number("timeout", timeout)
    checks.flag("wait", wait)
    link = Link(where, None if record is None else checks.path("record", record))
    if not wait:
        return link
    try:
        wait_for_vehicle(link, timeout)
    except BaseException:
        link.close()
        raise
    return link


def wait_for_vehicle(link: Link, timeout: float) -> None:
    """Wait for its heartbeat; `TimeoutError` with what was tried."""
    end = time.monotonic() + timeout
    while link.vehicle is None and time.monotonic() < end:
        link.receive("HEARTBEAT", timeout=min(BEAT, max(end - time.monotonic(), 0.0)))
    if link.vehicle is None:
        host, port, listens = link.address
        tried, cure = (
            (f"listened on udp {host}:{port}", "is the vehicle on, and does it send to that address?")
            if listens
            else (f"sent heartbeats to udp {host}:{port}", "is the vehicle on, and does it listen there?")
        )
        noise = f" {link.corrupted} packets were no MAVLink." if link.corrupted else ""
        raise TimeoutError(f"no vehicle was heard: {tried} for {timeout:g} s; {cure}{noise}")


def checked_address(address: str, allow_network: bool, name: str = "address") -> Address:
    """Where to talk; `ValueError` if that isn't on this machine, unless it may be elsewhere."""
    kind, _, rest = checks.text(name, address).partition(":")
    host, _, number = rest.rpartition(":")
    known = {"udp": True, "udpin": True, "udpout": False}
    if kind not in known or not host or not number.isdecimal() or not int(number) <= LARGEST:
        raise ValueError(
            f"{name} must be as udp:127.0.0.1:14550 (listens) or udpout:127.0.0.1:14550 (calls), got {address!r:.60}; "
            "serial lines and TCP can be forwarded to UDP, as by mavlink-router or MAVProxy"
        )
    if not allow_network and not on_this_machine(host):
        raise ValueError(
            f"{name} must be on this machine, as udp:127.0.0.1:14550, got {address!r:.60}: where a real vehicle may "
            "listen, allow_network=True is needed"
        )
    return Address("127.0.0.1" if host == "localhost" else host, int(number), known[kind])


def on_this_machine(host: str) -> bool:
    """Whether a host is the loopback; 0.0.0.0 listens to all the world."""
    if host == "localhost":
        return True
    try:
        return ipaddress.IPv4Address(host).is_loopback
    except ValueError:
        return False
