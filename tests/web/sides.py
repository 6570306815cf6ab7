"""The functions of `planners.wasm` in a page and in Python, called alike, and a city of which they are asked.

What differs between a page and the public functions can so be looked for in Python, too: there the same functions run
without a browser.
"""

import base64
import json
import time
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from uavlab.city.bounds import slack_of
from uavlab.planners.grid import HEURISTICS
from uavlab.spline.curve import BANK
from uavlab.web import functions
from uavlab.web.functions import ANSWERS, COST, ENERGY, EXPANDED, NEAREST, OUTCOME, REACHED, RECORDED

KINDS = {"bool": "boolean", "int32": "int32", "int64": "int64", "uint64": "uint64", "float64": "float64"}

OPEN_PAGE = """async ({code, facts}) => {
  const bytes = async text => (await fetch("data:application/octet-stream;base64," + text)).arrayBuffer();
  const types = {
    boolean: Uint8Array, int32: Int32Array, int64: BigInt64Array, uint64: BigUint64Array, float64: Float64Array,
  };
  const planners = await loadPlanners(await bytes(code), facts), kept = [];
  const text = array => {
    const flat = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    let all = "";
    for (let n = 0; n < flat.length; n += 32768) all += String.fromCharCode(...flat.subarray(n, n + 32768));
    return btoa(all);
  };
  window.planners = planners;
  window.side = {
    async array(kind, shape, data) {
      return kept.push(planners.numbers(kind, new types[kind](await bytes(data)), shape)) - 1;
    },
    empty: (kind, shape) => kept.push(planners.empty(kind, ...shape)) - 1,
    values: (at, count) => text(kept[at].values.subarray(0, count)),
    free(at) { kept[at].free(); delete kept[at]; },
    call(name, passed) {
      const known = passed.map(one => one.kept === undefined ? one : kept[one.kept]), began = performance.now();
      const answer = planners[name](...known);
      return [answer, performance.now() - began];
    },
  };
}"""


class Kept(NamedTuple):
    """An array in a page's memory."""

    at: int
    dtype: np.dtype
    shape: tuple[int, ...]


class InPython:
    """Arrays are NumPy's, and numba runs the functions."""

    seconds = 0.0

    def array(self, values):
        return np.array(values, order="C")

    def empty(self, dtype, shape):
        return np.zeros(shape, dtype)

    def values(self, array, rows=None):
        return array[:rows].copy()

    def free(self, *arrays):
        pass

    def call(self, name, *arguments):
        began = time.perf_counter()
        answer = getattr(functions, name)(*arguments)
        self.seconds = time.perf_counter() - began
        return answer


class InBrowser:
    """Arrays are in a page's memory, and a browser runs the functions; its clock shows tenths of milliseconds."""

    seconds = 0.0

    def __init__(self, page):
        here = files("uavlab.web")
        self.page = page
        page.goto("about:blank")
        page.add_script_tag(content=here.joinpath("planners.js").read_text(encoding="utf-8"))
        code = base64.b64encode(here.joinpath("planners.wasm").read_bytes()).decode()
        facts = json.loads(here.joinpath("planners.json").read_text(encoding="utf-8"))
        page.evaluate(OPEN_PAGE, {"code": code, "facts": facts})

    def array(self, values):
        values = np.ascontiguousarray(values)
        data = base64.b64encode(values.tobytes()).decode()
        at = self.page.evaluate(
            "([kind, shape, data]) => side.array(kind, shape, data)", [KINDS[str(values.dtype)], values.shape, data]
        )
        return Kept(at, values.dtype, values.shape)

    def empty(self, dtype, shape):
        dtype, shape = np.dtype(dtype), tuple(np.atleast_1d(shape).tolist())
        at = self.page.evaluate("([kind, shape]) => side.empty(kind, shape)", [KINDS[str(dtype)], shape])
        return Kept(at, dtype, shape)

    def values(self, array, rows=None):
        rows = array.shape[0] if rows is None else min(rows, array.shape[0])
        count = rows * int(np.prod(array.shape[1:]))
        data = self.page.evaluate("([at, count]) => side.values(at, count)", [array.at, count])
        return np.frombuffer(base64.b64decode(data), array.dtype).reshape(rows, *array.shape[1:])

    def free(self, *arrays):
        for array in arrays:
            self.page.evaluate("at => side.free(at)", array.at)

    def call(self, name, *arguments):
        passed = [{"kept": one.at} if isinstance(one, Kept) else as_number(one) for one in arguments]
        answer, milliseconds = self.page.evaluate("([name, passed]) => side.call(name, passed)", [name, passed])
        self.seconds = milliseconds / 1000
        return answer


def as_number(value):
    return float(value) if isinstance(value, float | np.floating) else int(value)


class Answer(NamedTuple):
    """What is found out about a route."""

    points: np.ndarray
    cost: float
    expanded: int
    length: float
    clearance: float
    order: np.ndarray
    reach: int
    outcome: int


class Town:
    """A city on one side, and its planners; codes and centres of ends are those of the city."""

    def __init__(self, side, city, most=5001):
        self.side, self.city = side, city
        self.occupied, closed = side.array(city.occupied), city.occupied | city.in_no_fly
        self.closed, self.origin = side.array(closed), side.array(city.origin)
        self.clearance, self.price = side.empty(float, city.shape), side.empty(float, city.shape)
        side.call("clear", self.occupied, city.cell, self.clearance)
        self.walls, self.zones = self.runs_of(self.occupied), self.runs_of(side.array(city.in_no_fly))
        self.facts, self.points = side.empty(float, len(ANSWERS)), side.empty(float, (most, 3))
        self.order = side.empty(np.int32, city.occupied.size)
        self.nothing = side.empty(np.int32, 0)
        self.closed_at = {}

    def runs_of(self, flags):
        first = self.side.empty(np.int64, int(np.prod(self.city.shape[:2])) + 1)
        count = self.side.call("count_runs", flags, first)
        runs = [first, *(self.side.empty(dtype, count) for dtype in (np.int32, np.int32, bool))]
        self.side.call("put_runs", flags, *runs)
        return runs

    def blocked(self, min_clearance):
        if min_clearance not in self.closed_at:
            blocked = self.side.empty(bool, self.city.shape)
            self.side.call("close", self.occupied, self.closed, self.clearance, min_clearance, self.city.cell, blocked)
            self.closed_at[min_clearance] = blocked
        return self.closed_at[min_clearance]

    def codes(self, *points):
        return [int(self.city.code_of(self.city.cell_of(point))) for point in points]

    def astar(self, start, goal, heuristic="octile", min_clearance=0.0, cheapest=None, record=False):
        """With a cheapest price, at the price that is set."""
        name, price = ("astar", []) if cheapest is None else ("astar_priced", [self.price, cheapest])
        order = self.order if record else self.nothing
        return self.asked(
            name, self.blocked(min_clearance), *price, HEURISTICS[heuristic], *self.codes(start, goal), self.origin,
            self.city.cell, self.points, order, self.facts,
        )  # fmt: skip

    def theta_star(self, start, goal, min_clearance=0.0):
        return self.asked(
            "thetastar", self.blocked(min_clearance), min_clearance, slack_of(self.city), *self.codes(start, goal),
            self.origin, self.city.cell, *self.walls, *self.zones, self.points, self.facts,
        )  # fmt: skip

    def straighten(self, count, min_clearance):
        """The way that was found last, at the price that is set."""
        return self.asked(
            "straighten", self.points, count, self.price, min_clearance, slack_of(self.city), self.origin,
            self.city.cell, *self.walls, *self.zones, self.facts,
        )  # fmt: skip

    def potential_field(self, start, goal, free, push=5.0, reach=5.0, most=2000):
        ends = [self.side.array(np.asarray(point, float)) for point in (start, goal)]
        answer = self.asked(
            "field", self.occupied, self.blocked(0.0), self.city.cell, self.origin, *ends, int(free), push, reach,
            self.city.cell / 2, most, self.points, self.facts,
        )  # fmt: skip
        self.side.free(*ends)
        return answer

    def least_risk(self, blocked, price, climb, turn, source, target):
        return self.asked(
            "least_risk", blocked, price, climb, turn, source, target, self.origin, self.city.cell, self.points,
            self.facts,
        )  # fmt: skip

    def asked(self, name, *arguments):
        """A planner's answer, and what is measured on it."""
        count = self.side.call(name, *arguments)
        facts = self.side.values(self.facts)
        recorded = any(argument is self.order for argument in arguments)
        order = self.side.values(self.order, int(facts[RECORDED])) if recorded else None
        length, clearance = self.measured(count) if count else (0.0, np.nan)
        return Answer(
            self.side.values(self.points, count), facts[COST], facts[EXPANDED], length, clearance, order,
            facts[REACHED], facts[OUTCOME],
        )  # fmt: skip

    def measured(self, count):
        """Length [m] and clearance [m] of the first so many points."""
        length = self.side.call(
            "measure", self.points, count, self.clearance, *self.walls, self.origin, self.city.cell, self.facts
        )
        return length, self.side.values(self.facts)[NEAREST]

    def integral(self, count, values):
        """∫ values ds along the first so many points."""
        return self.side.call("integral", self.points, count, values, self.origin, self.city.cell)

    def nearest(self, point, min_clearance):
        place = self.side.array(np.asarray(point, float))
        code = self.side.call("nearest", self.blocked(min_clearance), place, self.origin, self.city.cell)
        self.side.free(place)
        return code

    def curve(self, control, step):
        """Points, level curvature, length [m] and a bound of the clearance [m]."""
        control = np.asarray(control, float)
        passed, bend = self.side.array(control), self.side.empty(float, self.points.shape[0])
        count = self.side.call(
            "curve", passed, len(control), step, BANK, self.clearance, *self.walls, self.origin, self.city.cell,
            self.points, bend, self.facts,
        )  # fmt: skip
        facts, found = self.side.values(self.facts), [self.side.values(one, count) for one in (self.points, bend)]
        self.side.free(passed, bend)
        return *found, facts[COST], facts[NEAREST]

    def fly(self, points, speed, wind, craft, state, touching, near_goal, time_step=0.02, every=1, room=12_000):
        """Log, outcome, clearance [m] and energy [J] of a flight."""
        passed = [self.side.array(np.asarray(one)) for one in (points, wind.mean, craft, state)]
        log = self.side.empty(float, (room, 12))
        rows = self.side.call(
            "fly", passed[0], len(points), speed, passed[1], wind.deviation, wind.correlation, passed[2], time_step,
            every, touching, near_goal, self.occupied, self.clearance, *self.walls, self.origin, self.city.cell,
            passed[3], log, self.facts,
        )  # fmt: skip
        facts, logged = self.side.values(self.facts), self.side.values(log, rows)
        self.side.free(*passed, log)
        return logged, int(facts[OUTCOME]), facts[NEAREST], facts[ENERGY]
