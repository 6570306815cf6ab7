"""Missions to a vehicle and back: MAVLink's mission protocol, with progress, patience and a look at what arrived.

The vehicle asks for one item after the other; what gets lost on the way is asked for again. First the old mission goes,
then fence and rally points come, the mission last: whatever goes wrong, there is never half a mission to be flown, nor
one without its fence. In the end all is read back and compared.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tqdm import tqdm

from uavlab import checks
from uavlab.city.place import ABOVE_SEA, Place
from uavlab.mavlink.coding import item_of, items_of, message_of, polygons_of, rally_of
from uavlab.mavlink.dialect import (
    ACCEPTED,
    ARDUPILOT,
    CANCELLED,
    EVERYTHING,
    FENCE,
    HOME_POSITION,
    MISSION,
    PLANS,
    PX4,
    RALLY_POINTS,
    REQUEST_MESSAGE,
    RETURN_HEIGHTS,
    messages,
    name_of,
)
from uavlab.mavlink.link import TIMEOUT, Link, checked_address, connect, on_this_machine
from uavlab.mission import Mission, Preflight
from uavlab.mission.items import Item

AGAIN = 0.25
"""What isn't answered is sent again after this [s]."""

TRIES = 12
"""So many times in all; on a link that loses a tenth each way, one in 500 million goes unanswered."""

SINGLE = 9
"""MAV_PARAM_TYPE of 32 bits with a point."""


class MissionRejectedError(RuntimeError):
    """A vehicle doesn't take a mission; the message says which item and why.

    See Also
    --------
    upload : Raises it.

    Examples
    --------
    >>> from uavlab.mavlink import MissionRejectedError
    >>> raise MissionRejectedError("item 3: unsupported")
    Traceback (most recent call last):
        ...
    uavlab.mavlink.transfer.MissionRejectedError: item 3: unsupported
    """


def upload(
    mission: Mission,
    vehicle: Link | str,
    checked: Preflight | None = None,
    *,
    despite: bool = False,
    timeout: float = TIMEOUT,
    progress: bool = False,
    allow_network: bool = False,
) -> Mission:
    """Give a mission to a vehicle, with its fence, rally points and height to return at, and read it back.

    Parameters
    ----------
    mission : Mission
    vehicle : Link or str
        A link, or an address for one, as for `connect`.
    checked : Preflight, optional
        What `uavlab.mission.preflight` found for this mission. A vehicle that isn't on this machine needs one.
    despite : bool
        Whether to go on although a check failed, or there are none for a vehicle elsewhere.
    timeout : float
        How long to wait for the vehicle, and for its next word [s], above 0.
    progress : bool
        Show a bar.
    allow_network : bool
        Whether an address may be that of another machine.

    Returns
    -------
    Mission
        As the vehicle has it now; equal in all that travels.

    Raises
    ------
    ValueError
        If `mission` is no Mission; `vehicle` is neither a link nor an address, or one of another machine that isn't
        allowed; `checked` is no Preflight or that of another mission, or one of its checks failed and `despite` is
        False; `timeout` is not above 0; or `despite`, `progress` or `allow_network` is neither True nor False.
    MissionRejectedError
        If the vehicle doesn't take an item, or has something else in the end.
    TimeoutError
        If nobody answers, or nobody answers any more; the vehicle then has no mission, or not a new one.

    See Also
    --------
    download : What a vehicle has.
    start : Fly it.
    uavlab.mission.preflight : The checks.

    References
    ----------
    MAVLink Developer Guide, mission protocol, mavlink.io.

    Examples
    --------
    >>> from uavlab.city import Place
    >>> from uavlab.mavlink import upload
    >>> from uavlab.mission import Item, Mission
    >>> mission = Mission((Item(16, 3, (0, 2, 0, 0), 47.25, 8.5, 30.0),), Place(8.5, 47.25, 420.0))
    >>> upload(mission, "udp:127.0.0.1:0", timeout=0.1)
    Traceback (most recent call last):
        ...
    TimeoutError: no vehicle was heard: listened on udp 127.0.0.1:0 for 0.1 s; is the vehicle on, and does it send to \
that address?
    """
    checks.instance("mission", mission, Mission)
    timeout = checks.positive_number("timeout", timeout)
    checks.flag("progress", progress)
    check_preflight(mission, vehicle, checked, checks.flag("despite", despite))
    with linked(vehicle, timeout, checks.flag("allow_network", allow_network)) as link:
        clear(link, timeout)
        plans = {kind: items_of(mission, kind, link.autopilot) for kind in (FENCE, RALLY_POINTS, MISSION)}
        with tqdm(total=sum(map(len, plans.values())), unit=" item", disable=not progress) as bar:
            for kind, items in plans.items():
                if items:
                    give(link, kind, items, timeout, bar)
        if mission.return_height > 0:
            set_return_height(link, mission.return_height)
        found = {kind: fetch(link, kind, timeout) for kind in plans}
        wrong = [PLANS[kind] for kind, items in plans.items() if not same(found[kind], items, kind, link.autopilot)]
        if wrong:
            clear(link, timeout)
            raise MissionRejectedError(
                f"read back, {' and '.join(wrong)} differ from what was sent; the vehicle was cleared"
            )
        return mission_of(found, link.autopilot, mission.home, mission)


def download(vehicle: Link | str, *, timeout: float = TIMEOUT, allow_network: bool = False) -> Mission:
    """The mission that a vehicle has, with its fence and rally points.

    Parameters
    ----------
    vehicle : Link or str
        A link, or an address for one, as for `connect`.
    timeout : float
        How long to wait for the vehicle, and for its next word [s], above 0.
    allow_network : bool
        Whether an address may be that of another machine.

    Returns
    -------
    Mission

    Raises
    ------
    ValueError
        If `vehicle` is neither a link nor an address, or one of another machine that isn't allowed; `timeout` is not
        above 0; `allow_network` is neither True nor False; or the vehicle has no mission.
    TimeoutError
        If nobody answers, or nobody answers any more.

    See Also
    --------
    upload : The other way.

    Examples
    --------
    >>> from uavlab.mavlink import download
    >>> download("udp:127.0.0.1:0", timeout=0.1)
    Traceback (most recent call last):
        ...
    TimeoutError: no vehicle was heard: listened on udp 127.0.0.1:0 for 0.1 s; is the vehicle on, and does it send to \
that address?
    """
    timeout = checks.positive_number("timeout", timeout)
    with linked(vehicle, timeout, checks.flag("allow_network", allow_network)) as link:
        found = {kind: fetch(link, kind, timeout) for kind in PLANS}
        if len(found[MISSION]) <= (link.autopilot == ARDUPILOT):
            raise ValueError("the vehicle has no mission: upload one first")
        return mission_of(found, link.autopilot, home_of(link, timeout))


def check_preflight(mission: Mission, vehicle: Link | str, checked: Preflight | None, despite: bool) -> None:
    """Refuse what wasn't checked or failed, unless told otherwise."""
    if checked is not None:
        checks.instance("checked", checked, Preflight)
        if checked.mission is not mission:
            raise ValueError("checked must be the preflight of this mission, got that of another: run preflight again")
        if not checked.passed and not despite:
            failed = ", ".join(check.name for check in checked.failed)
            raise ValueError(
                f"checked: the checklist failed, {failed}: change the mission, or give despite=True to fly all the same"
            )
        return
    if isinstance(vehicle, Link):
        host = vehicle.address.host
    elif isinstance(vehicle, str):
        host = checked_address(vehicle, True, "vehicle").host
    else:
        return  # which is refused where it is opened
    if not (on_this_machine(host) or despite):
        raise ValueError(
            "checked must be given for a vehicle that isn't on this machine: run uavlab.mission.preflight, or give "
            "despite=True"
        )


@contextmanager
def linked(vehicle: Link | str, timeout: float, allow_network: bool) -> Iterator[Link]:
    """A link for a while; one that was open before stays open."""
    if isinstance(vehicle, Link):
        if vehicle.closed:
            raise ValueError(f"vehicle must be an open link, got {vehicle!r}")
        target_of(vehicle, "vehicle")
        yield vehicle
        return
    if not isinstance(vehicle, str):
        raise ValueError(f"vehicle must be a Link or an address as udp:127.0.0.1:14550, got {type(vehicle).__name__}")
    checked_address(vehicle, allow_network, "vehicle")
    with connect(vehicle, timeout=timeout, allow_network=allow_network) as link:
        yield link


def clear(link: Link, timeout: float) -> None:
    """Take all plans from the vehicle."""
    for _ in range(TRIES):
        link.send(messages().MAVLink_mission_clear_all_message(*target_of(link), EVERYTHING))
        answer = link.receive("MISSION_ACK", timeout=AGAIN)
        if answer is None:
            continue
        if answer.type != ACCEPTED:
            raise MissionRejectedError(
                f"the vehicle keeps its old mission: {name_of('MAV_MISSION_RESULT', answer.type)}; it may be flying, "
                "or be talking to another ground station"
            )
        return
    raise lost(link, "was asked to drop its old mission", timeout)


def give(link: Link, kind: int, items: list[Item], timeout: float, bar: Any) -> None:
    """Send one plan: say how many items, then each as the vehicle asks for it."""
    target, asked, count_sent = target_of(link), -1, 0
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        if asked < 0 and count_sent < TRIES:
            link.send(messages().MAVLink_mission_count_message(*target, len(items), kind))
            count_sent += 1
        message = link.receive("MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK", timeout=AGAIN)
        if message is None or message.mission_type != kind:
            if asked == len(items) - 1 and message is None:
                link.send(message_of(items[asked], asked, kind, target))  # the last word may have been lost
            continue
        if message.get_type() == "MISSION_ACK":
            if message.type == CANCELLED:
                raise lost(link, f"asked in vain for item {asked + 1} of {len(items)} of the {PLANS[kind]}", timeout)
            if message.type != ACCEPTED:
                raise rejected(kind, items, asked, message.type)
            if asked == len(items) - 1:
                return
            continue
        if not 0 <= message.seq < len(items):
            raise MissionRejectedError(f"the vehicle asked for item {message.seq} of {len(items)} of the {PLANS[kind]}")
        end = time.monotonic() + timeout
        bar.update(max(message.seq - max(asked, -1), 0))
        asked = max(asked, message.seq)
        link.send(message_of(items[message.seq], message.seq, kind, target))
    where = f"was given item {asked + 1} of {len(items)} of the {PLANS[kind]}"
    raise lost(link, where if asked >= 0 else f"was told of {len(items)} items of the {PLANS[kind]}", timeout)


def rejected(kind: int, items: list[Item], asked: int, result: int) -> MissionRejectedError:
    """Which item, and why."""
    why = name_of("MAV_MISSION_RESULT", result)
    if asked < 0:
        return MissionRejectedError(f"the vehicle doesn't take a {PLANS[kind]} of {len(items)} items: {why}")
    return MissionRejectedError(f"the vehicle doesn't take item {asked} of the {PLANS[kind]}, {items[asked]!r}: {why}")


def fetch(link: Link, kind: int, timeout: float) -> list[Item]:
    """Ask for one plan, item by item."""
    target = target_of(link)
    request = messages().MAVLink_mission_request_list_message(*target, kind)
    answer = asked_for(link, request, "MISSION_COUNT", lambda m: m.mission_type == kind, timeout)
    items: list[Item] = []
    for number in range(answer.count):
        request = messages().MAVLink_mission_request_int_message(*target, number, kind)
        item = asked_for(
            link, request, "MISSION_ITEM_INT", lambda m, n=number: m.seq == n and m.mission_type == kind, timeout
        )
        items.append(item_of(item))
    link.send(messages().MAVLink_mission_ack_message(*target, ACCEPTED, kind))
    return items


def asked_for(link: Link, request: Any, kind: str, fits: Any, timeout: float) -> Any:
    """The answer to a request, which is sent again and again."""
    end, patience = time.monotonic() + timeout, link.patience
    patience.times = 0
    while time.monotonic() < end:
        link.send(request)
        patience.asked(time.monotonic())
        while (rest := patience.asked_at + patience.seconds - time.monotonic()) > 0:
            answer = link.receive(kind, timeout=rest)
            if answer is not None and fits(answer):
                patience.answered(time.monotonic())
                return answer
    raise lost(link, f"was asked for a {kind}", timeout)


def set_return_height(link: Link, height: float) -> None:
    """Tell the vehicle how high to return; a warning where it doesn't know the parameter."""
    name, parts = RETURN_HEIGHTS.get(link.autopilot, RETURN_HEIGHTS[PX4])
    wanted = round(height * parts, 1)
    request = messages().MAVLink_param_set_message(*target_of(link), name.encode(), wanted, SINGLE)
    try:
        answer = asked_for(link, request, "PARAM_VALUE", lambda m: m.param_id == name, 3 * AGAIN)
    except TimeoutError:
        answer = None
    if answer is None or abs(answer.param_value - wanted) > 0.5:
        warnings.warn(
            f"the vehicle didn't take {name} = {wanted:g}: it returns at another height than the {height:.1f} m above "
            "home at which the way is clear",
            stacklevel=3,
        )


def home_of(link: Link, timeout: float) -> Place:
    """Where the vehicle says home is."""
    request = messages().MAVLink_command_long_message(*target_of(link), REQUEST_MESSAGE, 0, HOME_POSITION, *[0.0] * 6)
    message = asked_for(link, request, "HOME_POSITION", lambda m: True, timeout)
    return Place(message.longitude / 1e7, message.latitude / 1e7, message.altitude / 1000)


def same(found: list[Item], sent: list[Item], kind: int, autopilot: int) -> bool:
    """Whether two plans are alike; home, ArduPilot's first item, is its own to say."""
    first = int(kind == MISSION and autopilot == ARDUPILOT)
    return found[first:] == sent[first:] and len(found) == len(sent)


def mission_of(found: dict[int, list[Item]], autopilot: int, home: Place, like: Mission | None = None) -> Mission:
    """A mission of what was read; what doesn't travel is as in another."""
    names = ("speed", "corner_radius", "heights", "place", "return_height", "name", "notes")
    kept = {"heights": ABOVE_SEA} if like is None else {name: getattr(like, name) for name in names}
    items = found[MISSION][int(autopilot == ARDUPILOT) :]
    return Mission(tuple(items), home, polygons_of(found[FENCE]), rally_of(found[RALLY_POINTS]), **kept)


def target_of(link: Link, name: str = "link") -> tuple[int, int]:
    """Whom messages are for; `name` is what the argument is called."""
    checks.instance(name, link, Link)
    if link.closed or link.vehicle is None:
        raise ValueError(f"{name} must be one on which a vehicle was heard: connect without wait=False")
    return link.vehicle


def lost(link: Link, what: str, timeout: float) -> TimeoutError:
    """Nobody answers any more: what the vehicle was asked, and how long it is silent."""
    silent = time.monotonic() - link.heard
    heard = f"it was heard {silent:.1f} s ago" if silent < 1e6 else "it was never heard"
    return TimeoutError(
        f"the vehicle {what} and didn't answer for {timeout:g} s ({heard}): is the link gone? Nothing that was sent in "
        "part is flown"
    )
