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
    return [*falls(paper), *deaths(paper)]


def falls(paper: str) -> list[Claim]:
    at, claim = EQUATIONS[paper], partial(Claim, paper=paper)
    return [
        claim(
            item=f"{at['sum']}: sum over voxels", chapter="08", line=1.0, side="equal",
            unit="times the sum before",
            says="the risk of a route is a sum over the voxels that it passes, also when it lies elsewhere on the grid",
            why="It counts voxels and not metres, so it depends on where the grid lies.", experiment=SUMS, of="shifted",
        ),
        claim(
            item=f"{at['fall']}: speed of the fall", chapter="08", line=1.0, side="equal", unit="of the right form",
            says="speed after a fall, with twice the mass m in the exponent; right is the mass",
            why="In a short fall air hardly matters, and the speed is √(2gh); the papers' formula then gives √(gh).",
            experiment=FALLS, of="fall speed",
        ),
        claim(
            item=f"{at['fall']}: straight below", chapter="08", line=5.0, side="below", unit="m ahead",
            says="a wreck lands in the voxel below (line: one voxel of our campuses, 5 m)",
            why="It keeps most of its speed during the fall.", experiment=FALLS, of="ahead",
        ),
    ]  # fmt: skip


def deaths(paper: str) -> list[Claim]:
    at, claim = EQUATIONS[paper], partial(Claim, paper=paper)
    return [
        claim(
            item=f"{at['fatality']}: brace", chapter="08", says="the chance to die by the energy of the hit",
            why="A brace is missing in the text that we have, so the root has no end; we read that it covers α/β.",
        ),
        claim(
            item=f"{at['fatality']}: even odds", chapter="08", printed="50", unit="% die",
            says="a hit with the energy α kills one in two, at a shelter of 0.5",
            why="It follows from how we read the formula, so it can't fail.", experiment=FALLS, of="even odds",
            fair=False,
        ),
        claim(
            item="Table 1: shelter", chapter="08", printed="100", line=50.0, unit="% of the steps",
            says="the larger the value of shelter, the fewer die", why="True at the energy of such a fall.",
            experiment=FALLS, of="shelter",
        ),
        claim(
            item=f"{at['cars']}: K = 0.1", chapter="08", line=1.0, side="below", unit="times the route",
            says="0.1 cars per length of road: one voxel, read as per metre, over the risk of the paper's whole route",
            why="K has no unit. Per metre it can't be: a voxel would have more risk than the paper's whole route.",
            experiment=CARS, of=paper, fair=False,
        ),
    ]  # fmt: skip


def smoothing(paper: str) -> list[Claim]:
    """What both papers say of B-splines."""
    at, claim, recursion = EQUATIONS[paper], partial(Claim, paper=paper), paper == "PSO-BAS"
    return [
        claim(
            item=f"{at['degree']}: degree", chapter="12", line=2.0, side="equal", unit="degree for n = 3",
            says="the basis function with the number n is a polynomial of degree n − 1", experiment=SPLINES,
            why="By PSO-BAS's recursion, which begins at n = 0, its degree is n."
            if recursion else "The recursion isn't in the text that we have; beginning at n = 1 it would be right.",
            of="degree", fair=recursion,
        ),
        claim(
            item=f"{at['ends']}: P0 to P3", chapter="12", says="four points in each segment",
            why="In the text that we have the number of the segment is missing in the points.",
        ),
        claim(
            item=f"{at['section']}: continuous curvature", chapter="12", line=1.0, unit="continuous derivatives",
            says="curvature is continuous, so two derivatives are", why="The weights of neighbouring segments meet.",
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
                unit="% of maps",
                says="curvature stays below 1 per coding unit (a voxel, by our reading; "
                f"per metre is easier; {reading})", why=why, experiment=CURVES, of=reading,
            )
            for reading, why in (
                ("in plan", "A turn of 45° bends less."), ("in 3 D", "Where a turn meets a climb it bends more."),
            )
        ),
        claim(
            item=f"{at['pitch']}: pitch below π/{180 // int(other)}", chapter="12", printed="100", line=50.0,
            unit="% of maps", says=f"the pitch stays below {other}°",
            why="Proven: curves of a grid climb at most at 45°." if other == "60"
            else "Most of our curves reach 45° exactly, so it hangs on whether the bound counts.",
            experiment=CURVES, of=f"pitch {other}", fair=other == "60",
        ),
        claim(
            item="Conclusions: it can be flown", chapter="12", line=50.0, unit="% of maps",
            says="the smooth curve can be flown, at the 16 m/s of Table 2",
            why="No limits are given, and none would do: each curve's turns press with over three times the weight.",
            experiment=CURVES, of="flown",
        ),
    ]  # fmt: skip


def less_risk(paper: str) -> list[Claim]:
    """What a longer route saves, by the table in which each paper says so."""
    (table, cut, longer), claim = CUTS[paper], partial(Claim, paper=paper)
    what = f"{cut} % less risk for {longer} % more length"
    return [
        claim(
            item=f"{table}: a campus like the paper's", chapter="09", printed=cut, at_least=True, unit="% less risk",
            says=what, why="The reference campus was drawn so that it has such a detour.", experiment=DETOURS,
            of=f"{paper}, reference", fair=False,
        ),
        claim(
            item=f"{table}: possible", chapter="09", line=0.0, unit="% of maps",
            says=f"{what}, on one map at least", why="Random campuses have such detours, too.", experiment=DETOURS,
            of=f"{paper}, reached",
        ),
        claim(
            item=f"{table}: on most maps", chapter="09", line=50.0, unit="% of maps",
            says=f"{what}, as a rule", why="The paper has one map, and doesn't say how many others do so.",
            experiment=DETOURS, of=f"{paper}, reached", fair=False,
        ),
        claim(
            item=f"{table}: where wrecks land", chapter="09", printed=cut, at_least=True, line=0.0, unit="% less risk",
            says=f"{what}, in the median, if wrecks fall ahead", experiment=WRECKS, of=paper, fair=False,
            why="The papers let wrecks fall straight below, and claim nothing of others.",
        ),
        claim(
            item=f"{table}: risks and lengths", chapter="09", says="the four numbers of the table", why=OTHER_MAP,
        ),
    ]  # fmt: skip
