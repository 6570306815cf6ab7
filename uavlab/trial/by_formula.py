"""What needs no sample: formulas as they are printed beside the right ones, laws of offsets, falls and curves.

A ratio is the printed form over the right one, at a case that the claim names.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from uavlab import offsets, risk
from uavlab.city import City, table1_buildings
from uavlab.resilience import DISTURBANCES, LEVELS, LOADS, resilience_level
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.spline import basis_functions, cubic_bspline
from uavlab.statistics import share_interval
from uavlab.trial.judging import Measured
from uavlab.trial.measures import exact, percent
from uavlab.vehicle import GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import lift_margin, rain_force, wind_drag

TABLE_1 = (
    "70,15,0 60,15,0 60,45,0 70,15,65 95,35,0 70,35,0 60,15,65 60,45,65 95,45,0 95,45,65 95,35,65 70,35,65 65,15,70 "
    "65,40,70 90,40,70",
    "10,15,0 10,55,0 35,55,0 35,15,0 10,15,60 10,55,60 35,55,60 35,15,60 22,25,65 22,45,65",
    "70,60,0 70,80,0 90,80,0 90,60,0 70,60,80 70,80,80 90,80,80 90,60,80 75,65,90 85,65,90 85,75,90 75,75,90",
    "15,65,45 10,75,45 50,95,45 55,85,45 15,65,60 10,75,60 50,95,60 55,85,60",
    "45,55,0 48,53,0 50,55,0 50,60,0 48,62,0 45,60,0 45,55,95 48,53,95 50,55,95 50,60,95 48,62,95 45,60,95 48,58,99",
)
"""Corners of the five buildings, as REPARE prints them."""
TABLE_4 = {("light", "mild"): "intermediate", ("heavy", "mild"): "advanced", ("light", "heavy"): "advanced"}
"""Levels of the three cases, as REPARE prints them."""
ACCURACIES, TESTED = ("9.424", "59.426", "72.852"), 1466
"""In percent, of so many samples, as REPARE prints them."""
ROUTE_RISKS = {"RISK-ACO": 4.82e-6, "PSO-BAS": 8.75e-7}
"""Of the papers' best routes [1/h], as printed."""
PRINTED_MATRIX = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]) / 6
"""RISK-ACO Eq. 19, PSO-BAS Eq. 25."""


def pauta(size: int, seed: int) -> dict[str, Measured]:
    """Share within 3σ [%] in one to three dimensions, and for a force that grows with V²."""
    city = offsets.SkewedOffset(mean=0.0, sigma=1.0, turbulence_intensity=0.3)
    found = {name: 100 * offsets.coverage(3, n) for n, name in enumerate(("one axis", "in a plane", "in 3 D"), start=1)}
    found["force of the wind"] = 100 * (city.beyond(-3.0) - city.beyond(3.0))
    return {name: exact(value) for name, value in found.items()}


def joint_density(size: int, seed: int) -> dict[str, Measured]:
    """The integral of the density of two offsets that depend on each other, on a grid."""
    joint = offsets.JointOffset(mean=(0.3, -0.5), sigma=(1.0, 1.4), correlation=0.5)
    steps = np.linspace(-12, 12, 481)
    grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1)
    return {"integral": exact(joint.density(grid).sum() * (steps[1] - steps[0]) ** 2)}


def forces(size: int, seed: int) -> dict[str, Measured]:
    """Drag at 10 m/s, lift in heavy rain, and rain over the heaviest load."""
    still, flying, uav = (0.0, 0.0), (10.0, 0.0), LIGHT_QUADROTOR
    drag = [np.linalg.norm(wind_drag(still, flying, uav.drag_area, as_printed=form)) for form in (True, False)]
    rain = rain_force(100.0, uav.rain_area)
    margins = [lift_margin(uav.loaded(LOADS["light"]), rain, as_printed=form) for form in (True, False)]
    stuck, bounced = (float(rain_force(100.0, uav.rain_area, restitution=e)) for e in (0.0, 1.0))
    heaviest = LOADS["heavy"] * GRAVITY
    return {
        "drag": exact(drag[0] / drag[1], "at 10 m/s in still air"),
        "lift": exact(float(margins[0]) / float(margins[1]), "light load, 100 mm/h"),
        "rain": Measured(
            stuck / heaviest,
            stuck / heaviest,
            bounced / heaviest,
            "at 100 mm/h; no interval, but the range from drops that stick to drops that bounce",
        ),
    }


def tables_3_and_4(size: int, seed: int) -> dict[str, Measured]:
    """Whether more load or wind ever lowers a level, and how many rows of Table 4 agree with Table 3."""
    level = np.array([[LEVELS.index(resilience_level(load, wind)) for load in LOADS] for wind in DISTURBANCES])
    steps = np.concatenate([np.diff(level, axis=0).ravel(), np.diff(level, axis=1).ravel()])
    agreeing = sum(resilience_level(*case) == printed for case, printed in TABLE_4.items())
    return {
        "never lower": exact(100 * (steps >= 0).mean(), f"{len(steps)} neighbours"),
        "agree": exact(100 * agreeing / len(TABLE_4), f"{len(TABLE_4)} rows"),
    }


def corners(size: int, seed: int) -> dict[str, Measured]:
    """Share of Table 1's corners [%] that are on our five buildings."""
    found = []
    for building, text in zip(table1_buildings(), TABLE_1, strict=True):
        points = np.array([point.split(",") for point in text.split()], dtype=float)
        middle = points.mean(axis=0)
        found += (building.contains(points) & ~building.contains(points + 0.01 * (points - middle))).tolist()
    return {"on our buildings": exact(100 * np.mean(found), f"{len(found)} corners")}


def counts(size: int, seed: int) -> dict[str, Measured]:
    """How many of the printed accuracies are a whole number of 1466 samples."""
    shares = {f"{100 * k / TESTED:.3f}" for k in range(TESTED + 1)}
    return {"whole": exact(sum(accuracy in shares for accuracy in ACCURACIES), f"{len(ACCURACIES)} figures")}


def falls(size: int, seed: int) -> dict[str, Measured]:
    """Speed after a fall of 30 m, how far ahead a wreck lands, and what shelter does to the chance to die."""
    speeds = [float(risk.fall_speed(30.0, as_printed=form)) for form in (True, False)]
    energy = risk.impact_energy(risk.model.RISK_QUADROTOR.mass, 16.0, speeds[1])
    deaths = risk.impact_fatality(energy, np.array(sorted(risk.SHELTER.values())))
    even = risk.impact_fatality(risk.rates.EVEN_ODDS_ENERGY, 0.5)
    return {
        "fall speed": exact(speeds[0] / speeds[1], "from 30 m"),
        "ahead": exact(risk.ballistic_fall(22.5).drift, "from 22.5 m at 16 m/s"),
        "shelter": exact(100 * np.mean([after < before for before, after in pairwise(deaths)]), "4 steps of shelter"),
        "even odds": exact(100 * float(even), "E = α, shelter 0.5"),
    }


def voxel_sums(size: int, seed: int) -> dict[str, Measured]:
    """The sum over the voxels of a diagonal that is shifted by a millimetre, over that of the diagonal."""
    city, ground = City(np.zeros((10, 10, 10), dtype=bool), cell=5.0), np.ones((10, 10))
    even = RiskMap(city, 0.03 * ground, 0.5 * ground)
    diagonal = np.array([(2.5, 2.5, 27.5), (47.5, 47.5, 27.5)])
    routes = [Route(diagonal + np.array([shift, 0.0, 0.0])) for shift in (0.001, 0.0)]
    shifted, unshifted = (even.cell_sum(route) for route in routes)
    return {"shifted": exact(shifted / unshifted, "a diagonal of 10 voxels, shifted by 1 mm")}


def cars(size: int, seed: int) -> dict[str, Measured]:
    """Risk of one voxel of road with 0.1 cars per metre, over that of the papers' whole routes."""
    voxel = float(risk.vehicle_rate(risk.vehicle_share(cars_per_km=100.0)))
    return {paper: exact(voxel / whole, "one voxel of road") for paper, whole in ROUTE_RISKS.items()}


def splines(size: int, seed: int) -> dict[str, Measured]:
    """Weights at knots, the recursion's degree, continuous derivatives, and how far a control point reaches."""
    at, knots = np.linspace(3, 7, 401), np.arange(11.0)
    inner = basis_functions(at, knots)[101:200]
    degree = next(n for n in range(6) if np.abs(np.diff(inner, n + 1, axis=0)).max() < 1e-12)
    begins = np.diag([1.0, 1.0, 2.0, 6.0])[:, ::-1]  # powers of t and their derivatives, at t = 0 …
    ends = np.array([(1, 1, 1, 1), (3, 2, 1, 0), (6, 2, 0, 0), (6, 0, 0, 0)])  # … and at t = 1
    before, after = np.pad(ends @ PRINTED_MATRIX, ((0, 0), (0, 1))), np.pad(begins @ PRINTED_MATRIX, ((0, 0), (1, 0)))
    jumps = np.abs(before - after).max(axis=1)  # of the curve, its slope, its second and third derivative
    row = np.column_stack([np.arange(11.0), np.zeros(11)])
    moved = np.abs(cubic_bspline(row + 7.0 * np.eye(11)[:, [5]], 40) - cubic_bspline(row, 40)).any(axis=1)
    segments = sum(moved[40 * n : 40 * n + 41].any() for n in range(10))
    return {
        "at knots": exact(basis_functions(at[::100], knots, as_printed=True).sum(axis=1).mean(), "5 knots"),
        "degree": exact(degree, "step 3 of the recursion"),
        "continuous": exact((jumps > 1e-9).argmax() - 1, "at the joints"),
        "segments": exact(segments, "of 10 segments"),
    }


def antennae(size: int, seed: int) -> dict[str, Measured]:
    """Length of antennae over d, and how often a random direction points near a cube's corner, over the even share."""
    rng = np.random.default_rng(seed)
    drawn = rng.uniform(-1, 1, (size, 3))  # Eq. 17 with Table 3's m = 3
    unit = drawn / np.linalg.norm(drawn, axis=1, keepdims=True)
    near = np.abs(unit).sum(axis=1) / np.sqrt(3) > np.cos(np.radians(15.0))  # of one of 8 diagonals
    even = 100 * 8 * (1 - np.cos(np.radians(15.0))) / 2
    share = percent(near, "")
    d, x = 0.3, np.array([1.0, 2.0, 3.0])
    left, right = x + d * unit[0], x - d * unit[0]  # Eq. 18
    return {
        "corners": Measured(share.value / even, share.low / even, share.high / even, f"{size} directions"),
        "length": exact(float(np.linalg.norm(left - right)) / d),
    }


def one_flight(size: int, seed: int) -> dict[str, Measured]:
    """What one flight without a crash says of the share of such flights [%]."""
    low, high = share_interval(1, 1)
    return {"safe": Measured(100.0, 100 * low, 100 * high, "1 flight, the paper's")}
