"""Every table, figure and claim of RISK-ACO (10.19650/j.cnki.cjsi.J2007192) and of PSO-BAS (10.23919/JSEE.2022.000111).

They share a model of risk, so several claims stand in both and are measured once.
"""

from __future__ import annotations

from functools import partial

from uavlab.trial import by_campuses, by_colonies, by_formula, by_swarms
from uavlab.trial.judging import Claim, Experiment

FALLS, SUMS, CARS = Experiment(by_formula.falls), Experiment(by_formula.voxel_sums), Experiment(by_formula.cars)
SPLINES, ONE_FLIGHT = Experiment(by_formula.splines), Experiment(by_formula.one_flight)
ANTENNAE = Experiment(by_formula.antennae, 10_000, 100_000, 11)
DETOURS, WRECKS = Experiment(by_campuses.detours, 8, 40), Experiment(by_campuses.wrecks, 8, 40)
CURVES = Experiment(by_campuses.curves, 10, 40)
HABITS, LIMITS = Experiment(by_colonies.habits, 10, 30, 100), Experiment(by_colonies.limits, 10, 30, 100)
SPLITS, TABLE_5 = Experiment(by_colonies.splits, 6, 30, 100), Experiment(by_colonies.table_5, 20, 20)
PRINTED, OURS = Experiment(by_swarms.as_printed, 3, 12), Experiment(by_swarms.ours, 3, 12)
FUNCTIONS = Experiment(by_swarms.functions, 8, 15)

NOT_IN_TEXT = "The figures aren't in the text that we have."
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


ant = partial(Claim, paper="RISK-ACO")
RISK_ACO = [
    ant(
        item="Figs 1 to 6: drawings", chapter="04", says="grid, city, threat, area of a fall, splitting, smoothing",
        why=NOT_IN_TEXT,
    ),
    ant(
        item="Eqs 1, 2, J0: threat", chapter="09", says="the baseline keeps away from buildings",
        why="The constant f1 isn't given, and it decides what the baseline is.",
    ),
    ant(
        item="Eqs 4 to 6: deaths", chapter="08", says="failures, people in the area, chance to die",
        why="Definitions; they are used as they are.",
    ),
    *model_of_risk("RISK-ACO"),
    ant(
        item="Eqs 11 to 13: height", chapter="10", line=50.0, unit="% of runs",
        says="height in the choice improves the search", why="It draws the ants to the goal's level.",
        experiment=HABITS, of="height",
    ),
    ant(
        item="Section 3.2: turns", chapter="10", printed="100", line=50.0, unit="% of routes",
        says="no turn exceeds π/3", why="Such moves are closed to an ant.", experiment=TABLE_5, of="turns",
    ),
    ant(
        item="Eqs 14 to 16: choice and update", chapter="10",
        says="ants choose by scent and distance; short ways smell",
        why="Definitions: they are used as they are, and the risk isn't in them.",
    ),
    ant(
        item="Eq. 17, Table 3: limits", chapter="10", line=50.0, unit="% of runs",
        says="limits of the pheromone prevent an early end (line: half of the runs improve after 10 of 100)",
        why="With Table 3 the upper limit isn't reached and the lower one is 0.", experiment=LIMITS, of="still better",
    ),
    ant(
        item="Section 3.4, Fig. 12: splits, risk", chapter="10", line=50.0, unit="% of runs",
        says="splitting the route lowers the risk (against as many ants without a split)",
        why="A shorter way is easier for ants that don't see the risk.", experiment=SPLITS, of="better",
    ),
    ant(
        item="Fig. 12: splits, time", chapter="10", says="time grows with the splits",
        why="It is the number of ants, which one chooses.",
    ),
    *smoothing("RISK-ACO"),
    *flyable("RISK-ACO"),
    ant(
        item="Figs 7, 8: the campus", chapter="08", says="map and planned route", why=NOT_IN_TEXT,
    ),
    ant(
        item="Fig. 11: less redundancy", chapter="10", says="the improved colony's route is less redundant",
        why="Redundancy isn't defined, and the figures aren't in the text that we have.",
    ),
    ant(
        item="Table 4: risk", chapter="10", printed=f"{100 * (1 - 4.82 / 6.12):.0f}", at_least=True, line=0.0,
        unit="% less risk", says="the improved colony against the basic one (we guess: no height, any turn)",
        why="Neither sees the risk when it chooses.", experiment=HABITS, of="less risk",
    ),
    ant(
        item="Table 4: time", chapter="10", says="7.67 s against 8.12 s",
        why="A ratio of times belongs to a machine and a program.",
    ),
    *less_risk("RISK-ACO"),
    ant(
        item="Table 5: by the paper's colony", chapter="10", line=50.0, unit="% of runs",
        says="its own settings find such a route, where there is one",
        why="It ends early, with routes that are far from the best.", experiment=TABLE_5, of="met",
    ),
    ant(
        item="Fig. 13: hardware", chapter="14", says="multirotor, autopilot, radio, ground station",
        why="Mass, speed, loss and delay aren't given.",
    ),
    ant(
        item="Fig. 14: photographs", chapter="14", says="in flight and landing", why=NOT_IN_TEXT,
    ),
    ant(
        item="Fig. 15: a safe flight", chapter="14", line=50.0, unit="% of flights",
        says="flights on the route are safe (line: half of them)", why="One flight says next to nothing.",
        experiment=ONE_FLIGHT, of="safe",
    ),
]  # fmt: skip

bas = partial(Claim, paper="PSO-BAS")
PSO_BAS = [
    bas(
        item="Figs 1 to 6: drawings", chapter="04", says="grid, area of a fall, smoothing, map, steps, route",
        why=NOT_IN_TEXT,
    ),
    bas(
        item="Eqs 2 to 4: deaths", chapter="08", says="failures, people in the area, chance to die",
        why="Definitions; they are used as they are.",
    ),
    *model_of_risk("PSO-BAS"),
    bas(
        item="Eqs 9 to 12: constraints", chapter="09", says="turn, pitch, height over the ground",
        why="The greatest turn and pitch aren't given, and the height is asked for at waypoints only.",
    ),
    bas(
        item="Eqs 13 to 16, Table 3: swarm", chapter="11", says="ω = 1, c1 + c2 = 3.5",
        why="Bounds and a greatest speed aren't given, and without them the swarm spreads.",
    ),
    bas(
        item="Eq. 17: random direction", chapter="11", line=1.0, side="equal", unit="of the even share",
        says="the direction is random (line: as many near a cube's corners as evenly)",
        why="Numbers from a cube, divided by their length, prefer its corners.", experiment=ANTENNAE, of="corners",
    ),
    bas(
        item="Eq. 18: distance of the antennae", chapter="11", line=1.0, side="equal", unit="of d",
        says="d is the distance between both tips", why="By the equation it is half of that.", experiment=ANTENNAE,
        of="length",
    ),
    bas(
        item="Eqs 19 to 21: steps", chapter="11", says="antennae and step shrink",
        why="The first lengths aren't given.",
    ),
    *(
        bas(
            item=f"Section 4.3: beetles help, {name}, {how}", chapter="11", line=50.0, unit="% of runs",
            says=f"antennae improve a swarm, {settings}", why=why, experiment=FUNCTIONS, of=f"{name}, {how}",
        )
        for how, settings, why in (
            ("printed", "with Table 3", "They make up for a swarm that doesn't settle."),
            ("ours", "with our settings", "A swarm that settles has better use for the evaluations."),
        )
        for name in ("sphere", "rosenbrock", "rastrigin")
    ),
    *smoothing("PSO-BAS"),
    *flyable("PSO-BAS"),
    bas(
        item="Eq. 23: intervals", chapter="12", line=1.0, side="equal", unit="sum of the weights",
        says="each interval has both its ends in it", why="At a knot two of them count.", experiment=SPLINES,
        of="at knots",
    ),
    *(
        bas(
            item=f"Figs 9, 10: less risk than {name}, {how}", chapter="11", line=50.0, unit="% of maps",
            says=f"PSO-BAS finds less risk than {name}", why=why, experiment=experiment, of=f"less risk than {name}",
        )
        for how, experiment, why in (
            ("as printed", PRINTED, "The others are weak with these settings."),
            ("our settings", OURS, "Settings matter as much as the method."),
        )
        for name in ("PSO", "ACO")
    ),
    bas(
        item="Figs 9, 10: PSO-ACO", chapter="11", says="PSO-BAS finds less risk than PSO-ACO",
        why="PSO-ACO is named, and nowhere defined.",
    ),
    bas(
        item="Fig. 9: less redundancy", chapter="11", says="the route is less redundant",
        why="Redundancy isn't defined, and the figures aren't in the text that we have.",
    ),
    bas(
        item="Fig. 10: 55 iterations", chapter="11", printed="55", unit="iterations",
        says="the search is complete after 55 iterations",
        why="It depends on the map and on what complete means: here, within a hundredth of the end.",
        experiment=PRINTED, of="iterations",
    ),
    *(
        bas(
            item=f"Fig. 10: sooner than {name}", chapter="11", line=50.0, unit="% of maps",
            says=f"PSO-BAS is at its end after fewer iterations than {name}",
            why="The others stop early, far from the best.", experiment=PRINTED, of=f"sooner than {name}",
        )
        for name in ("PSO", "ACO")
    ),
    bas(
        item="Fig. 10: a risk of 8.75e-7", chapter="11", printed="8.75e-7", says="the risk of the route", why=OTHER_MAP,
    ),
    *less_risk("PSO-BAS"),
]  # fmt: skip

CLAIMS = [*RISK_ACO, *PSO_BAS]
