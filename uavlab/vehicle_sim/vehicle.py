"""The vehicle's side of MAVLink: what it answers to a ground station, and what it says of itself.

It behaves as PX4 and ArduPilot do for missions: it asks for each item, again where an answer is lost; takes a mission
whole or not at all, from one ground station at a time; says which item it doesn't take; and asks its fence before it
flies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from uavlab.mavlink.coding import message_of, polygons_of
from uavlab.mavlink.dialect import (
    ACCEPTED,
    ARDUPILOT,
    ARM,
    CANCELLED,
    EVERYTHING,
    FENCE,
    GO_HOME,
    HOME_POSITION,
    LAND_HERE,
    MISSION,
    PLANS,
    PX4,
    RALLY_POINTS,
    REQUEST_MESSAGE,
    RETURN_HEIGHTS,
    SET_MODE,
    START_MISSION,
    codec,
    messages,
    packed,
    sender_of,
)
from uavlab.mavlink.patience import Patience
from uavlab.mission.items import (
    SEA,
    WAYPOINT,
    Item,
)
from uavlab.vehicle_sim.judging import DENIED, INVALID, INVALID_SEQUENCE, NO_SPACE, UNSUPPORTED, judged
from uavlab.vehicle_sim.pilot import FLYING_MISSION, HOLDING, LANDING, RETURNING, TICK, Pilot
from uavlab.vehicle_sim.words import (
    MODES,
    PX4_AUTO,
    VERSION,
    home_of,
    position_of,
    spoken,
    state_of,
    version,
)

SYSTEM, COMPONENT = 1, 1
PER_SECOND = round(1 / TICK)
MOST_ITEMS = 1000
"""That it has room for, as many autopilots."""

GIVE_UP = 3.0
"""An item that doesn't come is asked for so long [s]."""

COMMAND_UNKNOWN, TEMPORARILY_REJECTED = 3, 1
"""Of commands (MAV_RESULT)."""

FENCE_ACTIONS = {ARDUPILOT: "FENCE_ACTION", PX4: "GF_ACTION"}
FENCE_RETURNS = {ARDUPILOT: 1.0, PX4: 3.0}
"""The parameter, and its value by which who leaves the fence goes home; with others it only says so."""

LARGEST_PARAMETER = 1e6
"""What is more, or negative, isn't taken: a height of 10 km in centimetres is the most."""

Peer = tuple[str, int]


@dataclass
class Upload:
    """A mission that is on its way to the vehicle."""

    peer: Peer
    sender: tuple[int, int]
    kind: int
    count: int
    items: list[Item] = field(default_factory=list)
    since: float = 0.0
    """When the last item came [s]."""
    patience: Patience = field(default_factory=Patience)


class Vehicle:
    """A pilot with a radio; time `now` is given in seconds of any clock that goes on."""

    def __init__(self, pilot: Pilot, autopilot: int, send: Callable[[bytes, Peer | None], None]) -> None:
        self.pilot, self.autopilot, self.send = pilot, autopilot, send
        self.codec = codec(SYSTEM, COMPONENT)
        self.readers: dict[Peer, Any] = {}
        self.plans: dict[int, list[Item]] = {kind: [] for kind in PLANS}
        self.upload: Upload | None = None
        self.done: tuple[Peer, int, int] | None = None
        self.ticks = 0
        self.told_item = -1
        self.flying_time = 0.0
        self.parameters = self.usual_parameters()

    def usual_parameters(self) -> dict[str, float]:
        """Names and values as those of the autopilot that it is."""
        name, parts = RETURN_HEIGHTS[self.autopilot]
        return {name: parts * self.pilot.return_height, FENCE_ACTIONS[self.autopilot]: FENCE_RETURNS[self.autopilot]}

    def receive(self, data: bytes, peer: Peer, now: float) -> None:
        """A packet; what is no MAVLink, or not for it, is ignored."""
        if peer not in self.readers:
            self.readers[peer] = codec(SYSTEM, COMPONENT)
        for message in self.readers[peer].parse_buffer(data) or []:
            if message.get_type() == "BAD_DATA":
                continue
            if getattr(message, "target_system", SYSTEM) in (0, SYSTEM):
                handler = getattr(self, f"on_{message.get_type().lower()}", None)
                if handler is not None:
                    handler(message, peer, now)

    def answer(self, message: Any, peer: Peer | None) -> None:
        self.send(packed(self.codec, message), peer)

    def acknowledge(self, message: Any, peer: Peer, kind: int, result: int) -> None:
        self.answer(messages().MAVLink_mission_ack_message(*sender_of(message), result, kind), peer)

    def on_mission_count(self, message: Any, peer: Peer, now: float) -> None:
        kind, sender = message.mission_type, sender_of(message)
        if kind not in PLANS:
            self.acknowledge(message, peer, kind, UNSUPPORTED)
        elif self.upload is not None and (self.upload.peer, self.upload.sender) != (peer, sender):
            self.acknowledge(message, peer, kind, DENIED)  # another ground station is at it
        elif kind == MISSION and self.pilot.armed:
            self.acknowledge(message, peer, kind, DENIED)
        elif message.count > MOST_ITEMS:
            self.acknowledge(message, peer, kind, NO_SPACE)
        elif message.count == 0:
            self.take(kind, [])
            self.acknowledge(message, peer, kind, ACCEPTED)
        elif self.upload is None or (self.upload.kind, self.upload.count) != (kind, message.count):
            self.upload = Upload(peer, sender, kind, message.count, since=now)
            self.ask(now)
        else:
            self.ask(now)  # it didn't hear the question

    def on_mission_item_int(self, message: Any, peer: Peer, now: float) -> None:
        upload = self.upload
        if upload is None or upload.peer != peer:
            if self.done == (peer, message.mission_type, message.seq):  # it didn't hear that all is well
                self.acknowledge(message, peer, message.mission_type, ACCEPTED)
            return
        if message.mission_type != upload.kind:
            return
        if message.seq != len(upload.items):
            if message.seq > len(upload.items):
                self.ask(now)
            return
        result, item = judged(message, upload.kind)
        if item is None:
            self.upload = None
            self.acknowledge(message, peer, message.mission_type, result)
            return
        upload.items.append(item)
        upload.since = now
        upload.patience.answered(now)
        if len(upload.items) < upload.count:
            self.ask(now)
            return
        self.upload = None
        if self.take(upload.kind, upload.items):
            self.done = (peer, upload.kind, message.seq)
            self.acknowledge(message, peer, upload.kind, ACCEPTED)
        else:
            self.acknowledge(message, peer, upload.kind, INVALID)

    def take(self, kind: int, items: list[Item]) -> bool:
        """Keep a plan, and use it; whether it could."""
        try:
            if kind == FENCE:
                self.pilot.watch(polygons_of(items))
            elif kind == RALLY_POINTS:
                self.pilot.rally = tuple(self.pilot.point_of(item) for item in items)
            else:
                self.pilot.take(tuple(items[int(self.autopilot == ARDUPILOT) :]))
        except ValueError:
            return False
        self.plans[kind] = items
        return True

    def ask(self, now: float) -> None:
        """Ask for the next item."""
        upload = self.upload
        assert upload is not None
        upload.patience.asked(now)
        request = messages().MAVLink_mission_request_int_message(*upload.sender, len(upload.items), upload.kind)
        self.answer(request, upload.peer)

    def on_mission_request_list(self, message: Any, peer: Peer, now: float) -> None:
        count = len(self.kept(message.mission_type))
        self.answer(messages().MAVLink_mission_count_message(*sender_of(message), count, message.mission_type), peer)

    def on_mission_request_int(self, message: Any, peer: Peer, now: float) -> None:
        sender, items = sender_of(message), self.kept(message.mission_type)
        if message.seq < len(items):
            self.answer(message_of(items[message.seq], message.seq, message.mission_type, sender), peer)
        else:
            self.acknowledge(message, peer, message.mission_type, INVALID_SEQUENCE)

    on_mission_request = on_mission_request_int

    def kept(self, kind: int) -> list[Item]:
        """A plan as it is asked for; ArduPilot's missions begin with home, whatever was sent."""
        items = self.plans.get(kind, [])
        if kind == MISSION and self.autopilot == ARDUPILOT and items:
            longitude, latitude, height = self.pilot.city.to_geographic(self.pilot.home).tolist()
            return [Item(WAYPOINT, SEA, (0.0, 0.0, 0.0, 0.0), latitude, longitude, height), *items[1:]]
        return items

    def on_mission_clear_all(self, message: Any, peer: Peer, now: float) -> None:
        kinds = tuple(PLANS) if message.mission_type == EVERYTHING else (message.mission_type,)
        busy = self.upload is not None and self.upload.peer != peer
        if busy or (self.pilot.armed and MISSION in kinds):
            self.acknowledge(message, peer, message.mission_type, DENIED)
            return
        self.upload = None
        for kind in kinds:
            self.take(kind, [])
        self.acknowledge(message, peer, message.mission_type, ACCEPTED)

    def on_mission_ack(self, message: Any, peer: Peer, now: float) -> None:
        """A ground station gives up what it began to send."""
        if self.upload is not None and self.upload.peer == peer and message.type != ACCEPTED:
            self.upload = None

    def on_param_set(self, message: Any, peer: Peer, now: float) -> None:
        if message.param_id in self.parameters and 0 <= message.param_value <= LARGEST_PARAMETER:
            self.parameters[message.param_id] = message.param_value
            height, action = self.parameters.values()
            self.pilot.return_height = height / RETURN_HEIGHTS[self.autopilot][1]
            self.pilot.fence_returns = action == FENCE_RETURNS[self.autopilot]
            self.say_parameter(message.param_id, peer)

    def on_param_request_list(self, message: Any, peer: Peer, now: float) -> None:
        for name in self.parameters:
            self.say_parameter(name, peer)

    def on_param_request_read(self, message: Any, peer: Peer, now: float) -> None:
        names = list(self.parameters)
        name = names[message.param_index] if 0 <= message.param_index < len(names) else message.param_id
        if name in self.parameters:
            self.say_parameter(name, peer)

    def say_parameter(self, name: str, peer: Peer) -> None:
        number, count = list(self.parameters).index(name), len(self.parameters)
        value = self.parameters[name]
        self.answer(messages().MAVLink_param_value_message(name.encode(), value, 9, count, number), peer)

    def on_command_long(self, message: Any, peer: Peer, now: float) -> None:
        """Do what is told; the answer says whether, a text why not."""
        result = self.obeyed(message, peer)
        for words in spoken(self.pilot):
            self.answer(words, None)
        ack = messages().MAVLink_command_ack_message(message.command, result, 255, 0, *sender_of(message))
        self.answer(ack, peer)

    on_command_int = on_command_long

    def obeyed(self, message: Any, peer: Peer) -> int:
        pilot, first = self.pilot, message.param1
        if message.command == ARM:
            return self.armed(first, message.param2)
        if message.command == START_MISSION:
            return self.told(pilot.start())
        if message.command == GO_HOME:
            return self.told(pilot.go_home())
        if message.command == LAND_HERE:
            return self.told(pilot.land_here())
        if message.command == SET_MODE:
            return self.mode_set(message.param2, message.param3)
        if message.command == REQUEST_MESSAGE and first in (HOME_POSITION, VERSION):
            self.answer(home_of(pilot) if first == HOME_POSITION else version(), peer)
            return ACCEPTED
        return COMMAND_UNKNOWN

    def armed(self, wanted: float, force: float) -> int:
        """Motors on; or off, which in flight needs to be forced, and then it falls."""
        pilot = self.pilot
        if wanted == 1:
            return self.told(pilot.arm())
        if pilot.body.path is not None:
            return self.told("it is flying")
        pilot.armed = False
        return ACCEPTED

    def mode_set(self, main: float, sub: float) -> int:
        """A mode by its number; on the ground only that of a mission makes a difference."""
        number = main if self.autopilot == ARDUPILOT else sub if main == PX4_AUTO else -1
        wanted = next((mode for at, mode in MODES[self.autopilot].items() if at == number), None)
        actions = {HOLDING: self.pilot.hold, RETURNING: self.pilot.go_home, LANDING: self.pilot.land_here}
        if wanted == FLYING_MISSION:
            return self.told(self.pilot.start())
        if wanted not in actions:
            return self.told(f"no mode {main:g}, {sub:g}")
        return ACCEPTED if self.pilot.body.path is None else self.told(actions[wanted]())

    def told(self, refused: str) -> int:
        """What to answer; a refusal is said in words, too."""
        if refused:
            self.pilot.say(refused)
        return TEMPORARILY_REJECTED if refused else ACCEPTED

    def advance(self, seconds: float, now: float) -> None:
        """Time goes by for the vehicle [s], and what there is to say is said."""
        self.flying_time += seconds
        while self.flying_time >= TICK:
            self.flying_time -= TICK
            self.pilot.tick()
            self.say_all()
            self.ticks += 1
        upload = self.upload
        if upload is not None and now - upload.since > GIVE_UP:
            self.upload = None
            ack = messages().MAVLink_mission_ack_message(*upload.sender, CANCELLED, upload.kind)
            self.answer(ack, upload.peer)
        elif upload is not None and upload.patience.over(now):
            self.ask(now)

    def say_all(self) -> None:
        """Position ten times a second, state once, and what happened."""
        reached, pilot = messages().MAVLink_mission_item_reached_message, self.pilot
        said = [position_of(pilot), *(reached(self.numbered(number)) for number in pilot.reached), *spoken(pilot)]
        pilot.reached.clear()
        regular = self.ticks % PER_SECOND == 0
        if regular or self.told_item != pilot.current:
            self.told_item = pilot.current
            number = self.numbered(pilot.current)
            said.append(messages().MAVLink_mission_current_message(number, len(self.plans[MISSION])))
        for message in said + state_of(pilot, self.autopilot) * regular:
            self.answer(message, None)

    def numbered(self, number: int) -> int:
        """An item's number as the ground station counts them."""
        return number + int(self.autopilot == ARDUPILOT)
