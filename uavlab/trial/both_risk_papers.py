"""What RISK-ACO and PSO-BAS both say: of falls and people below, of B-splines, of less risk for a longer route.

These claims stand in both papers and are measured once.
"""

from __future__ import annotations

from functools import partial

from uavlab.trial import by_campuses, by_formula
from uavlab.trial.judging import Claim, Experiment

FALLS, SUMS, CARS = Experiment(by_formula.falls), Experiment(by_formula.voxel_sums), Experiment(by_formula.cars)
SPLINES = Experiment(by_formula.splines)
DETOURS, WRECKS = Experiment(by_campuses.detours, 8, 40), Experiment(by_campuses.wrecks, 8, 40)
CURVES = Experiment(by_campuses.curves, 10, 40)

OTHER_MAP = "The paper's map, its roads and its people aren't there."

EQUATIONS = {
    "RISK-ACO": {"sum": "Eq. 3", "fall": "Eq. 7", "fatality": "Eq. 8", "cars": "Eqs 9, 10, Table 2", "ends": "Eq. 19",
                 "degree": "Eq. 18", "curvature": "Fig. 9", "pitch": "Fig. 10", "section": "Section 3.5"},
    "PSO-BAS": {"sum": "Eq. 1", "fall": "Eq. 5", "fatality": "Eq. 6", "cars": "Eqs 7, 8, Table 2", "ends": "Eq. 25",
                "degree": "Eqs 22, 24", "curvature": "Fig. 7", "pitch": "Fig. 8", "section": "Section 4.4"},
}  # fmt: skip
"""Where the two papers say the same."""
CUTS = {"RISK-ACO": ("Table 5", "80", "7"), "PSO-BAS": ("Table 4", "86", "15")}
"""Table, less risk [%] and more length [%], as printed."""


def model_of_risk(paper: str) -> list[Claim]:
    """What both papers say of falls and of the people below."""
    at, claim = EQUATIONS[paper], partial(Claim, paper=paper)
    return [
        claim(
            item=f"{at['sum']}: sum over voxels", chapter="08", line=1.0, side="equal", unit="times the sum",
            says="the risk of a route is a sum over the voxels that it passes",
            why="It counts voxels and not metres, so it depends on where the grid lies.", experiment=SUMS, of="shifted",
        ),
        claim(
            item=f"{at['fall']}: speed of the fall", chapter="08", line=1.0, side="equal", unit="of the right form",
            says="the drag stands with 2m in the exponent",
            why="Then a short fall gives less than √(2gh): energy is lost.", experiment=FALLS, of="fall speed",
        ),
        claim(
            item=f"{at['fall']}: straight below", chapter="08", line=5.0, side="below", unit="m ahead",
            says="a wreck lands in the voxel below (line: one voxel of our maps)",
            why="It keeps most of its speed during the fall.", experiment=FALLS, of="ahead",
        ),
        claim(
            item=f"{at['fatality']}: brace", chapter="08", says="the chance to die by the energy of the hit",
            why="A brace is missing in the text that we have, so the root has no end; we read that it covers α/β.",
        ),
        claim(
            item=f"{at['fatality']}: even odds", chapter="08", printed="50", unit="% die",
            says="α kills one in two behind half a shelter", why="It follows from the formula as we read it.",
            experiment=FALLS, of="even odds",
        ),
        claim(
            item="Table 1: shelter", chapter="08", printed="100", line=50.0, unit="% of the steps",
            says="the larger the value, the better the shelter", why="True at the energy of such a fall.",
            experiment=FALLS, of="shelter",
        ),
        claim(
            item=f"{at['cars']}: K = 0.1", chapter="08", line=1.0, side="below", unit="times the route",
            says="cars on a road (line: read as per metre, one voxel has no more risk than the paper's whole route)",
            why="K has no unit, and this reading is ruled out by the paper's own result.", experiment=CARS, of=paper,
        ),
    ]  # fmt: skip


def smoothing(paper: str) -> list[Claim]:
    """What both papers say of B-splines."""
    at, claim = EQUATIONS[paper], partial(Claim, paper=paper)
    return [
        claim(
            item=f"{at['degree']}: degree", chapter="12", printed="2", unit="of step 3",
            says="a basis function of order n has degree n − 1",
            why="Their recursion begins at 0, so step n has degree n.", experiment=SPLINES, of="degree",
        ),
        claim(
            item=f"{at['ends']}: P0 to P3", chapter="12", says="four points in each segment",
            why="In the text that we have the number of the segment is missing in the points.",
        ),
        claim(
            item=f"{at['section']}: continuous curvature", chapter="12", line=1.0, unit="derivatives",
            says="the curve's second derivative is continuous", why="The weights of neighbouring segments meet.",
            experiment=SPLINES, of="continuous",
        ),
        claim(
            item=f"{at['section']}: local", chapter="12", line=10.0, side="below", unit="of 10 segments",
            says="a moved point doesn't change the whole curve", why="Each segment has four points.",
            experiment=SPLINES, of="segments",
        ),
    ]  # fmt: skip


def flyable(paper: str) -> list[Claim]:
    """What both papers say of curves that can be flown."""
    at, claim, other = EQUATIONS[paper], partial(Claim, paper=paper), {"RISK-ACO": "60", "PSO-BAS": "45"}[paper]
    return [
        *(
            claim(
                item=f"{at['curvature']}: curvature below 1, {reading}", chapter="12", printed="100", line=50.0,
                unit="% of maps", says="per coding unit, a voxel here",
                why="A turn of 45° needs less, steeper ones can need more.", experiment=CURVES, of=reading,
            )
            for reading in by_campuses.BENDS
        ),
        claim(
            item=f"{at['pitch']}: pitch below π/{180 // int(other)}", chapter="12", printed="100", line=50.0,
            unit="% of maps", says=f"the pitch stays below {other}°",
            why="The steepest move of a grid with turns is 45°, and curves reach it.", experiment=CURVES,
            of=f"pitch {other}",
        ),
        claim(
            item="Conclusions: it can be flown", chapter="12", line=50.0, unit="% of maps",
            says="the smooth curve can be flown, at the 16 m/s of Table 2",
            why="Curvature says nothing of speed: tilt and climb bind.", experiment=CURVES, of="flown",
        ),
    ]  # fmt: skip


def less_risk(paper: str) -> list[Claim]:
    """What a longer route saves, by the table in which each paper says so."""
    (table, cut, longer), claim = CUTS[paper], partial(Claim, paper=paper)
    what = f"{cut} % less risk for {longer} % more length"
    return [
        claim(
            item=f"{table}: possible", chapter="09", printed=cut, at_least=True, line=0.0, unit="% less risk",
            says=what, why="There is a map with such a detour; it was drawn for that.", experiment=DETOURS,
            of=f"{paper}, reference",
        ),
        claim(
            item=f"{table}: typical", chapter="09", printed=cut, at_least=True, line=0.0, unit="% less risk",
            says=f"{what}, in the median", why="How much a detour saves is for the map to say.", experiment=DETOURS,
            of=f"{paper}, median",
        ),
        claim(
            item=f"{table}: on most maps", chapter="09", line=50.0, unit="% of maps", says=what,
            why="How much a detour saves is for the map to say.", experiment=DETOURS, of=f"{paper}, reached",
        ),
        claim(
            item=f"{table}: where wrecks land", chapter="09", printed=cut, at_least=True, line=0.0, unit="% less risk",
            says=f"{what}, with the wreck where it really lands", why="What the route avoids lies straight below it.",
            experiment=WRECKS, of=paper,
        ),
        claim(
            item=f"{table}: risks and lengths", chapter="09", says="the four numbers of the table", why=OTHER_MAP,
        ),
    ]  # fmt: skip
