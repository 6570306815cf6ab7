"""What a ground station tells a vehicle: fly, stop, go home, land."""

from __future__ import annotations

import time

from uavlab import checks
from uavlab.mavlink.dialect import (
    ACCEPTED,
    ARDUPILOT,
    ARM,
    GO_HOME,
    LAND_HERE,
    SET_MODE,
    START_MISSION,
    messages,
    name_of,
)
from uavlab.mavlink.link import Link
from uavlab.mavlink.transfer import lost, target_of

TIMEOUT = 6.0
"""So long a command is sent again and again until it is answered [s]."""

CUSTOM = 1
"""That a mode is the autopilot's own (MAV_MODE_FLAG_CUSTOM_MODE_ENABLED)."""

HOLD_MODES = {ARDUPILOT: (5, 0)}
PX4_HOLD = (4, 3)
"""Main mode and sub-mode of hovering."""


class CommandDeniedError(RuntimeError):
    """A vehicle doesn't do what it is told; the message says why.

    See Also
    --------
    start : Raises it.

    Examples
    --------
    >>> from uavlab.mavlink import CommandDeniedError
    >>> raise CommandDeniedError("no mission")
    Traceback (most recent call last):
        ...
    uavlab.mavlink.commands.CommandDeniedError: no mission
    """


def start(link: Link) -> None:
    """Arm the vehicle and let it fly its mission.

    Parameters
    ----------
    link : Link
        On which a vehicle was heard.

    Raises
    ------
    ValueError
        If `link` is no open link on which a vehicle was heard.
    CommandDeniedError
        If the vehicle doesn't: it has no mission, or that leaves the fence.
    TimeoutError
        If it doesn't answer.

    See Also
    --------
    upload : Give it a mission first.
    follow : See it fly.

    References
    ----------
    MAVLink Developer Guide, command protocol, mavlink.io.

    Examples
    --------
    >>> from uavlab.mavlink import connect, start
    >>> with connect("udp:127.0.0.1:0", wait=False) as link:
    ...     start(link)
    Traceback (most recent call last):
        ...
    ValueError: link must be one on which a vehicle was heard: connect without wait=False
    """
    command(link, ARM, 1.0)
    try:
        command(link, START_MISSION)
    except CommandDeniedError:
        command(link, ARM, 0.0)
        raise


def hold(link: Link) -> None:
    """Let the vehicle stop and hover where it is.

    Parameters
    ----------
    link : Link
        On which a vehicle was heard.

    Raises
    ------
    ValueError, CommandDeniedError, TimeoutError
        As `start`.

    See Also
    --------
    start : Go on with the mission.

    Examples
    --------
    >>> from uavlab.mavlink import connect, hold
    >>> with connect("udp:127.0.0.1:0", wait=False) as link:
    ...     hold(link)
    Traceback (most recent call last):
        ...
    ValueError: link must be one on which a vehicle was heard: connect without wait=False
    """
    checks.instance("link", link, Link)
    main, sub = HOLD_MODES.get(link.autopilot, PX4_HOLD)
    command(link, SET_MODE, CUSTOM, main, sub)


def go_home(link: Link) -> None:
    """Let the vehicle return and land.

    Parameters
    ----------
    link : Link
        On which a vehicle was heard.

    Raises
    ------
    ValueError, CommandDeniedError, TimeoutError
        As `start`.

    See Also
    --------
    land : Land where it is.

    Examples
    --------
    >>> from uavlab.mavlink import connect, go_home
    >>> with connect("udp:127.0.0.1:0", wait=False) as link:
    ...     go_home(link)
    Traceback (most recent call last):
        ...
    ValueError: link must be one on which a vehicle was heard: connect without wait=False
    """
    command(link, GO_HOME)


def land(link: Link) -> None:
    """Let the vehicle land where it is.

    Parameters
    ----------
    link : Link
        On which a vehicle was heard.

    Raises
    ------
    ValueError, CommandDeniedError, TimeoutError
        As `start`.

    See Also
    --------
    go_home : Land at home.

    Examples
    --------
    >>> from uavlab.mavlink import connect, land
    >>> with connect("udp:127.0.0.1:0", wait=False) as link:
    ...     land(link)
    Traceback (most recent call last):
        ...
    ValueError: link must be one on which a vehicle was heard: connect without wait=False
    """
    command(link, LAND_HERE)


def command(link: Link, number: int, *parameters: float) -> None:
    """Send a command until it is answered; the vehicle's own words say why it is denied."""
    target = target_of(link)
    said, patience, attempt = [], link.patience, 0
    values = [*parameters, *[0.0] * (7 - len(parameters))]
    end, patience.times = time.monotonic() + TIMEOUT, 0
    while time.monotonic() < end:
        link.send(messages().MAVLink_command_long_message(*target, number, attempt, *values))
        patience.asked(time.monotonic())
        attempt = min(attempt + 1, 255)
        while (rest := patience.asked_at + patience.seconds - time.monotonic()) > 0:
            answer = link.receive("COMMAND_ACK", "STATUSTEXT", timeout=rest)
            if answer is not None and answer.get_type() == "STATUSTEXT":
                said.append(answer.text)
            elif answer is not None and answer.command == number:
                patience.answered(time.monotonic())
                if answer.result == ACCEPTED:
                    return
                why = said[-1] if said else name_of("MAV_RESULT", answer.result)
                raise CommandDeniedError(f"the vehicle doesn't {WORDS.get(number, f'do command {number}')}: {why}")
    raise lost(link, f"was told to {WORDS.get(number, f'do command {number}')}", TIMEOUT)


WORDS = {
    ARM: "arm", START_MISSION: "start its mission", GO_HOME: "return", LAND_HERE: "land", SET_MODE: "change its mode",
}  # fmt: skip
