"""`QGC WPL 110`: a mission as lines of text, which nearly every ground station reads. Its first line is home."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from uavlab import checks
from uavlab.city.place import Place
from uavlab.files import written_whole
from uavlab.mission.items import CHANGE_SPEED, SEA, WAYPOINT, Item
from uavlab.mission.plan_file import SAME_FRAMES

if TYPE_CHECKING:
    from uavlab.mission.model import Mission

FIRST_LINE = "QGC WPL 110"
COLUMNS = 12


def write_wpl(mission: Mission, path: str | Path) -> None:
    """`Mission.to_wpl`."""
    home = Item(WAYPOINT, SEA, (0.0, 0.0, 0.0, 0.0), mission.home.latitude, mission.home.longitude, mission.home.height)
    lines = [line_of(number, item) for number, item in enumerate((home, *mission.items))]
    with written_whole(checks.path("path", path)) as part:
        part.write_text("\n".join([FIRST_LINE, *lines]) + "\n", encoding="utf-8", newline="\n")


def line_of(number: int, item: Item) -> str:
    """An item as a line: number, whether it is current, frame, command, parameters, place, whether to go on."""
    parameters = [f"{value:.10g}" for value in item.parameters]
    place = f"{item.latitude:.7f}", f"{item.longitude:.7f}", f"{item.altitude:.3f}"
    return "\t".join([str(number), str(int(number == 0)), str(item.frame), str(item.command), *parameters, *place, "1"])


def fields_of_wpl(path: Path) -> dict[str, Any]:
    """What a file says of a mission, by the names of its fields."""
    try:
        first, *lines = path.read_text(encoding="utf-8-sig").splitlines()
        if first.split() != FIRST_LINE.split():
            raise ValueError(f"its first line must be {FIRST_LINE!r}, got {first!r:.40}")
        rows = [(number, line.split()) for number, line in enumerate(lines, 2)]
        rows = [(number, words) for number, words in rows if words and not words[0].startswith("#")]
        found = [item_of_row(number, count, words) for count, (number, words) in enumerate(rows)]
        if len(found) < 2:
            raise ValueError(f"it must have home and at least one item, got {len(found)} lines")
        home, *items = found
        place = Place(home.longitude, home.latitude, home.altitude)
    except (UnicodeDecodeError, ValueError, OverflowError) as error:
        raise ValueError(f"{path.name} is no file of waypoints (QGC WPL 110), or damaged: {error!s:.300}") from error
    speeds = [item.parameters[1] for item in items if item.command == CHANGE_SPEED and item.parameters[1] > 0]
    return {
        "items": tuple(items),
        "home": place,
        "speed": max(speeds, default=5.0),
        "heights": "above sea",
        "name": path.stem,
    }


def item_of_row(line: int, count: int, words: list[str]) -> Item:
    """The item that a line says."""
    if len(words) != COLUMNS:
        raise ValueError(f"line {line} must have {COLUMNS} columns, got {len(words)}")
    number, _, frame, command = (int(word) for word in words[:4])
    if number != count:
        raise ValueError(f"line {line} must be that of item {count}, got {number}: a line is missing, or stands twice")
    values = [float(word) for word in words[4:11]]
    if any(math.isinf(value) for value in values):
        raise ValueError(f"line {line} must have finite numbers, got {words[4:11]}")
    return Item(command, SAME_FRAMES.get(frame, frame), tuple(values[:4]), *values[4:])  # type: ignore[arg-type]
