"""What an autopilot does with a mission: stage by stage, in its fence, as long as its battery lasts.

A stage is what is flown without a stop: from waypoint to waypoint with rounded corners, up, or down. At its end the
vehicle waits as long as the item says, then the next stage follows. When it leaves the fence, or only the reserve is
left in the battery, it goes home.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from uavlab.city import City
from uavlab.flight.autopilot import Autopilot
from uavlab.flight.state import BATTERY_EMPTY, FLYING
from uavlab.mission.corridor import floor_below
from uavlab.mission.fences import polygon_on
from uavlab.mission.items import (
    CHANGE_SPEED,
    LAND,
    LOITER,
    PLACED,
    RETURN,
    TAKEOFF,
    TERRAIN,
    WAYPOINT,
    FencePolygon,
    Item,
)
from uavlab.mission.model import Mission
from uavlab.mission.way import CLIMB, LAST_METRES, SINK, TOUCH_DOWN
from uavlab.vehicle import UAV
from uavlab.vehicle_sim.body import OVER, Body
from uavlab.vehicle_sim.stages import BETWEEN, Passed, Stage, rounded
from uavlab.weather import Wind

READY, FLYING_MISSION, HOLDING, RETURNING, LANDING, CRASHED = (
    "ready", "mission", "hold", "return", "land", "crashed",
)  # fmt: skip

NOT_FLYING = "it isn't flying"

TICK = 0.1
"""From fix to fix of GPS, and from look to look at the fence [s]."""

BELOW = 5.0
"""The reference of a landing goes on below the ground, as GPS may be wrong [m]."""

CONTACT = 0.1
"""So near to what lies below it has landed [m]."""

ARRIVED = 1.5
"""Who waits at a point is that near to it, as GPS has it [m]."""


@dataclass
class Pilot:
    """The vehicle with its autopilot, without a radio."""

    city: City
    body: Body
    home: np.ndarray
    """On the map, (3,) [m]."""
    items: tuple[Item, ...] = ()
    areas: list[tuple[shapely.Polygon, bool]] = field(default_factory=list)
    """Polygons of the fence on the map, and whether to stay inside."""
    rally: tuple[np.ndarray, ...] = ()
    mode: str = READY
    armed: bool = False
    current: int = 0
    reached: list[int] = field(default_factory=list)
    """Numbers of items reached since it was asked last."""
    words: list[str] = field(default_factory=list)
    """What it said since then."""
    breached: bool = False
    return_height: float = 15.0
    """Above home at which it returns, at least [m]."""
    fence_returns: bool = True
    """Whether it goes home when it leaves the fence."""
    speed: float = 5.0
    queue: list[Stage] = field(default_factory=list)
    waiting: float = 0.0
    marks: list[tuple[float, int]] = field(default_factory=list)
    finished: bool = False
    """Whether the mission was flown to its end."""

    @classmethod
    def standing(
        cls, city: City, uav: UAV, wind: Wind, autopilot: Autopilot, at: np.ndarray, rng: np.random.Generator
    ) -> Pilot:
        """On the ground, or on a roof, below the point (3,) [m]."""
        home = np.array([*at[:2], floor_below(city, at)[0]])
        return cls(city, Body(city, uav, wind, autopilot, home, rng), home, speed=autopilot.speed or uav.cruise_speed)

    def take(self, items: tuple[Item, ...]) -> None:
        """A new mission; the old one is gone."""
        self.items, self.current, self.finished = items, 0, False

    def watch(self, fence: tuple[FencePolygon, ...]) -> None:
        """A new fence."""
        place = self.city.checked_reference()
        self.areas = [(polygon_on(place, polygon), polygon.inclusion) for polygon in fence]
        for area, _ in self.areas:
            shapely.prepare(area)

    def arm(self) -> str:
        """Start the motors; or why not."""
        if self.mode == CRASHED:
            return "it crashed"
        self.armed = True
        return ""

    def start(self) -> str:
        """Fly the mission from its current item; or why not."""
        refused = self.why_not()
        if refused:
            return refused
        if self.body.path is None and self.items[self.current].command not in (TAKEOFF, CHANGE_SPEED):
            return "on the ground a mission must begin with a take-off"
        self.mode = FLYING_MISSION
        self.queue = self.stages()
        self.next_stage()
        return ""

    def why_not(self) -> str:
        """What keeps it from flying its mission; empty if nothing does."""
        if not self.items:
            return "no mission"
        if not self.armed:
            return "not armed"
        points = [self.point_of(item) for item in self.items if item.command in PLACED]
        way = shapely.LineString(np.vstack([self.body.state.seen_position, *points])[:, :2])
        for area, inside in self.areas:
            if inside and not area.contains(way):
                return "the mission leaves the fence"
            if not inside and area.intersects(way):
                return "the mission crosses a closed zone"
        return ""

    def hold(self) -> str:
        """Stop and hover; or why not."""
        if self.body.path is None:
            return NOT_FLYING
        self.mode, self.queue, self.marks, self.waiting = HOLDING, [], [], 0.0
        self.body.hover()
        return ""

    def land_here(self) -> str:
        """Land below where it is; or why not."""
        if self.body.path is None:
            return NOT_FLYING
        self.mode = LANDING
        self.queue = [self.landing(self.body.state.target)]
        self.next_stage()
        return ""

    def go_home(self) -> str:
        """Rise, fly straight to home or the nearest rally point, and land; or why not."""
        if self.body.path is None:
            return NOT_FLYING
        self.mode = RETURNING
        here = self.body.state.target
        goal = min([self.home, *self.rally], key=lambda place: float(np.hypot(*(place - here)[:2])))
        above = np.array([*here[:2], max(here[2], self.home[2] + self.return_height)])
        there = np.array([*goal[:2], above[2]])
        points = np.vstack([above, there])
        self.queue = [Stage(points, np.array([CLIMB, self.asked_speed]), (), 0.0, False), self.landing(there)]
        self.next_stage()
        return ""

    @property
    def asked_speed(self) -> float:
        """What the mission asked for last, before its current item [m/s]."""
        asked = [item.parameters[1] for item in self.items[: self.current] if item.command == CHANGE_SPEED]
        return next((speed for speed in reversed(asked) if speed > 0), self.speed)

    def point_of(self, item: Item) -> np.ndarray:
        """The place of an item on the map; altitudes above home are from where it stands."""
        place = self.city.checked_reference()
        home = place._replace(height=float(self.home[2] + place.height))
        frame = Mission((item,), home, place=place)
        return frame.point_of(item, self.city, self.home)

    def stages(self) -> list[Stage]:
        """From the current item to the end."""
        found, legs, speed = [], [], self.asked_speed
        begin = here = self.body.state.target.copy()
        for number, item in list(enumerate(self.items))[self.current :]:
            point = self.point_of(item) if item.command in PLACED else here
            if item.command == CHANGE_SPEED:
                speed = item.parameters[1] if item.parameters[1] > 0 else speed
                continue
            if item.command in (WAYPOINT, LOITER):
                legs += [*self.over_ground(here, point, speed, item), (number, point, speed, item)]
                here = point
                if item.command == WAYPOINT and not item.parameters[0] > 0:
                    continue
            if legs:
                stays = np.inf if item.command == LOITER else item.parameters[0] if item.command == WAYPOINT else 0.0
                found.append(rounded(begin, legs, stays))
                begin, legs = here, []
            if item.command == TAKEOFF:
                begin = here = np.array([*here[:2], point[2]])
                found.append(Stage(here[None], np.array([CLIMB]), ((0.0, number),), 0.0, True))
            elif item.command == LAND:
                there = np.array([*point[:2], here[2]])
                over = Stage(there[None], np.array([speed]), (), 0.0, False)
                found += [over] * bool(np.hypot(*(there - here)[:2]) > ARRIVED)
                found.append(self.landing(there)._replace(reached=((0.0, number),)))
            elif item.command == RETURN:
                found.append(Stage(np.empty((0, 3)), np.empty(0), ((0.0, number),), 0.0, False))
        return [*found, rounded(begin, legs, 0.0)] if legs else found

    def over_ground(self, start: np.ndarray, end: np.ndarray, speed: float, item: Item) -> list[Passed]:
        """Points between two others that keep their height above the ground, of an item whose altitude is above it."""
        ground = self.city.ground
        count = (
            int(np.ceil(np.hypot(*(end - start)[:2]) / self.city.cell))
            if item.frame == TERRAIN and ground is not None
            else 0
        )
        if count < 2:
            return []
        share = np.linspace(0.0, 1.0, count + 1)[1:-1, None]
        points = start + share * (end - start)
        first, last = self.city.height_above_ground(np.array([start, end]))
        points[:, 2] += first + share[:, 0] * (last - first) - self.city.height_above_ground(points)
        return [(BETWEEN, point, speed, item) for point in points]

    def landing(self, point: np.ndarray) -> Stage:
        """Straight down, slowly at the end."""
        ground = floor_below(self.city, point)[0]
        slow = min(point[2], ground + LAST_METRES)
        points = np.array([[*point[:2], slow], [*point[:2], ground - BELOW]])
        return Stage(points, np.array([SINK, TOUCH_DOWN]), (), np.inf, True)

    def next_stage(self) -> None:
        """Begin with the first stage of the queue; without one, hover."""
        self.waiting = 0.0
        if not self.queue:
            self.finished = self.finished or self.mode == FLYING_MISSION
            self.hold()
            return
        stage = self.queue[0]
        if len(stage.points) == 0:  # the mission says: go home
            self.current = stage.reached[0][1]
            self.finished = True
            self.go_home()
            return
        self.marks = list(stage.reached)
        if self.marks:
            self.current = self.marks[0][1]
        self.body.follow(stage.points, stage.speeds)

    def tick(self) -> None:
        """A tenth of a second."""
        if self.body.path is None:
            self.body.stand(TICK)
            return
        stage = self.queue[0] if self.queue else None
        outcome = self.body.fly(TICK, stage is not None and stage.low)
        if outcome == BATTERY_EMPTY and self.body.uav.reserve > 0:
            self.body.uav = replace(self.body.uav, reserve=0.0)
            self.say("battery: only the reserve is left, going home")
            self.go_home()
            return
        if outcome != FLYING:
            self.crash(OVER[outcome])
            return
        if stage is not None and stage.low and self.landed(stage):
            return
        self.look_at_fence()
        self.go_on()

    def landed(self, stage: Stage) -> bool:
        """Whether it has touched down at the end of a landing; then it stands."""
        if np.isfinite(stage.hold) or self.body.height() > CONTACT:
            return False
        self.reached += [number for _, number in self.marks]
        self.finished = self.finished or (self.mode == FLYING_MISSION and bool(self.marks))
        position = self.body.state.position
        self.body.land(np.array([*position[:2], floor_below(self.city, position)[0]]))
        self.mode, self.armed, self.queue, self.marks = READY, False, [], []
        self.say("landed")
        return True

    def go_on(self) -> None:
        """Note what is reached; at the end of a stage wait, then begin the next one."""
        stage = self.queue[0] if self.queue else None
        if stage is None:
            return
        while (
            self.marks
            and self.marks[0][0] <= self.body.flown
            and (self.marks[0][0] > 0 or self.body.at_end)
            and not stage.low
        ):
            self.reached.append(self.marks.pop(0)[1])
            if self.marks:
                self.current = self.marks[0][1]
        if not (self.body.at_end and self.body.from_end < ARRIVED):
            return
        if self.waiting < stage.hold:
            self.waiting += TICK
            return
        self.reached += [number for _, number in self.marks]
        self.queue.pop(0)
        self.next_stage()

    def look_at_fence(self) -> None:
        """Go home, or only say it, when it leaves the fence, as GPS has it."""
        x, y, _ = self.body.state.seen_position
        outside = any(shapely.contains_xy(area, x, y) != inside for area, inside in self.areas)
        if outside and not self.breached:
            returns = self.fence_returns and self.mode not in (RETURNING, LANDING)
            self.say("fence breached" + ", going home" * returns)
            if returns:
                self.go_home()
        self.breached = outside

    def crash(self, how: str) -> None:
        x, y, z = self.body.state.position
        self.say(f"{how} at ({x:.1f}, {y:.1f}, {z:.1f})")
        self.mode, self.armed, self.queue, self.marks = CRASHED, False, [], []
        self.body.path = self.body.model = None
        self.body.state.velocity[:] = 0.0

    def say(self, words: str) -> None:
        self.words.append(words)
