"""What the graph planners share: 26 neighbours, which moves are legal, heuristics, and questions asked well.

A node is a voxel, named by its code (`City.code_of`). From it there are 26 moves, to all voxels around it. A move is
legal when every voxel of its bounding box is free: 1 for a straight move, 3 more for a diagonal one, 7 for
one through a corner; so nothing is cut. The voxels around a node fit into one word of 27 bits, and a move is legal
when the word has no bit in common with the bounding box of the move.
"""

import numpy as np
import numpy.typing as npt

from uavlab import checks
from uavlab.city import City
from uavlab.compiled import compiled

MOVES = np.array([(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) if (i, j, k) != (0, 0, 0)])
"""The 26 moves (26, 3) [cells], in the order in which they are tried."""

LENGTHS = np.sqrt((MOVES**2).sum(axis=1))
"""Their lengths [cells]: 1, √2 or √3."""


def bit_of(i: int, j: int, k: int) -> int:
    """The bit of the word of 27 that stands for the voxel at offset (i, j, k), each −1, 0 or 1."""
    return 1 << (9 * (i + 1) + 3 * (j + 1) + (k + 1))


def bounding_box(move: np.ndarray) -> int:
    """The word of 27 bits with those set that the move's bounding box covers, but for the node itself."""
    covered = [sorted({0, int(offset)}) for offset in move]
    word = sum(bit_of(i, j, k) for i in covered[0] for j in covered[1] for k in covered[2])
    return word & ~bit_of(0, 0, 0)


BOXES = np.array([bounding_box(move) for move in MOVES])
"""Voxels that must be free for each move (26,), as words of 27 bits."""

EUCLIDEAN, OCTILE, ZERO = 0, 1, 2
HEURISTICS = {"octile": OCTILE, "euclidean": EUCLIDEAN, "zero": ZERO}
"""Estimates of the way that remains. None is above the true cost, so A* stays exact."""


@compiled
def blocked_around(blocked, i, j, k):
    """The word of 27 bits with those set whose voxels around (i, j, k) are blocked or outside of the map."""
    nx, ny, nz = blocked.shape
    word = 0
    bit = 1
    if 0 < i < nx - 1 and 0 < j < ny - 1 and 0 < k < nz - 1:  # nearly always, and then three voxels at once
        for a in range(i - 1, i + 2):
            for b in range(j - 1, j + 2):
                row = blocked[a, b]
                word |= (row[k - 1] | row[k] << 1 | row[k + 1] << 2) * bit
                bit <<= 3
        return word
    for a in range(i - 1, i + 2):
        for b in range(j - 1, j + 2):
            for c in range(k - 1, k + 2):
                if a < 0 or b < 0 or c < 0 or a >= nx or b >= ny or c >= nz or blocked[a, b, c]:
                    word |= bit
                bit <<= 1
    return word


@compiled
def steps_of(blocked):
    """By how much each move (26,) changes the code of a node."""
    ny, nz = blocked.shape[1], blocked.shape[2]
    return (MOVES[:, 0] * ny + MOVES[:, 1]) * nz + MOVES[:, 2]


@compiled
def blocked_around_node(blocked, node):
    """`blocked_around` a node with this code."""
    ny, nz = blocked.shape[1], blocked.shape[2]
    return blocked_around(blocked, node // (ny * nz), node // nz % ny, node % nz)


@compiled
def distance_left(heuristic, di, dj, dk):
    """Estimate of the way [cells] over (di, dj, dk): straight (Eq. 9), by 26 moves (octile), or nothing."""
    di, dj, dk = abs(di), abs(dj), abs(dk)
    if heuristic == EUCLIDEAN:
        return np.sqrt(di * di + dj * dj + dk * dk)
    if heuristic == OCTILE:  # as many corner moves as the shortest side, then diagonals, then straight ones
        least = min(di, dj, dk)
        most = max(di, dj, dk)
        middle = di + dj + dk - least - most
        return (np.sqrt(3.0) - np.sqrt(2.0)) * least + (np.sqrt(2.0) - 1.0) * middle + most
    return 0.0


def node_at(
    city: City, point: npt.ArrayLike, argument: str, min_clearance: float = 0.0, flyable: np.ndarray | None = None
) -> int:
    """The code of the voxel in which a start or a goal lies; points to fly from instead are `flyable`, if it is given.

    Raises
    ------
    ValueError
        If it isn't three finite numbers, lies outside of the map, in an obstacle, or nearer to one than
        `min_clearance`; the message names the argument, what is in the way, and the nearest point that would do.
    """
    position = np.asarray(point, dtype=float)
    if position.shape != (3,):
        raise ValueError(f"{argument} must be three numbers (x, y, z) in metres, got shape {position.shape}")
    if not np.isfinite(position).all():
        raise ValueError(f"{argument} must be finite, got {checks.show(position)}")
    if not city.inside(position):
        low, high = city.bounds
        ranges = ", ".join(f"{a} {lo:g} to {hi:g}" for a, lo, hi in zip("xyz", low, high, strict=True))
        raise ValueError(f"{argument} {checks.show(position)} lies outside of the map: {ranges} m")
    index = tuple(city.cell_of(position))
    blocked = city.blocked(min_clearance)
    if city.occupied[index]:
        wrong = f"lies in {city.building_at(position)}"
    elif blocked[index]:
        clearance = city.clearance[index]
        wrong = f"is {clearance:.2f} m from the nearest obstacle, min_clearance asks for {min_clearance:g} m"
    else:
        return int(city.code_of(index))
    allowed = ~blocked if flyable is None else flyable & ~blocked
    raise ValueError(f"{argument} {checks.show(position)} {wrong}; {nearest_allowed(city, position, allowed)}")


def nearest_allowed(city: City, position: np.ndarray, allowed: np.ndarray) -> str:
    """Words for the centre nearest to a position among allowed voxels (nx, ny, nz), looked for in boxes that grow."""
    index = city.cell_of(position)
    radius = 4
    while True:
        low, high = np.maximum(index - radius, 0), np.minimum(index + radius + 1, city.shape)
        free = low + np.argwhere(allowed[low[0] : high[0], low[1] : high[1], low[2] : high[2]])
        centers = city.center_of(free)
        away = np.linalg.norm(centers - position, axis=1)
        whole_map = (high - low == city.shape).all()
        if away.min(initial=np.inf) < (np.inf if whole_map else radius * city.cell):
            return f"the nearest free point is {checks.show(centers[away.argmin()])}"
        if whole_map:
            return "no voxel of the map is free"
        radius *= 2


def endpoints(
    city: City,
    start: npt.ArrayLike,
    goal: npt.ArrayLike,
    min_clearance: float = 0.0,
    flyable: np.ndarray | None = None,
) -> tuple[int, int]:
    """Codes of the start's and the goal's voxel; `ValueError` if one can't be flown from or to, or both are one."""
    checks.instance("city", city, City)
    codes = (
        node_at(city, start, "start", min_clearance, flyable),
        node_at(city, goal, "goal", min_clearance, flyable),
    )
    if codes[0] == codes[1]:
        raise ValueError(
            f"start {checks.show(start)} and goal {checks.show(goal)} lie in the same voxel: "
            f"there is no route to plan; choose a goal at least one cell ({city.cell:g} m) away"
        )
    return codes


def checked_price(city: City, price: npt.ArrayLike) -> tuple[np.ndarray, float]:
    """A price per metre as a float array of the city's shape, and the cheapest."""
    checked = np.ascontiguousarray(price, dtype=float)
    if checked.shape != city.shape:
        raise ValueError(f"price must have the city's shape {city.shape}, got {checked.shape}")
    cheapest = float(checked.min())
    if not 0 <= cheapest <= checked.max() < np.inf:  # NaN fails too
        raise ValueError("price must be finite and at least 0 everywhere; use min_clearance to forbid voxels")
    return checked, cheapest
