"""Every table, figure and claim of RISK-ACO (10.19650/j.cnki.cjsi.J2007192), PSO-BAS (10.23919/JSEE.2022.000111)."""

from __future__ import annotations

from functools import partial

from uavlab.trial import by_colonies, by_formula, by_swarms
from uavlab.trial.both_risk_papers import OTHER_MAP, SPLINES, flyable, less_risk, model_of_risk, smoothing
from uavlab.trial.judging import Claim, Experiment

ONE_FLIGHT, ANTENNAE = Experiment(by_formula.one_flight), Experiment(by_formula.antennae, 10_000, 100_000, 11)
HABITS, LIMITS = Experiment(by_colonies.habits, 10, 30, 100), Experiment(by_colonies.limits, 10, 30, 100)
SPLITS, TABLE_5 = Experiment(by_colonies.splits, 6, 30, 100), Experiment(by_colonies.table_5, 20, 20)
PRINTED, OURS = Experiment(by_swarms.as_printed, 3, 12), Experiment(by_swarms.ours, 3, 12)
FUNCTIONS = Experiment(by_swarms.functions, 8, 15)

FUNCTION_NAMES = "sphere", "rosenbrock", "rastrigin"
NOT_SETTLED = "They make up for a swarm that doesn't settle."
TOO_FEW = "Once a swarm settles, what they change is small against what chance does."
NOT_IN_TEXT = "The figures aren't in the text that we have."

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
        says="ants that look at the height of the goal, too, find less risk",
        why="It draws the ants to the goal's level.",
        experiment=HABITS, of="height",
    ),
    ant(
        item="Section 3.2: turns", chapter="10", printed="100", line=50.0, unit="% of routes",
        says="no turn exceeds π/3", why="A rule of the search and no result: such moves are closed to the ants.",
        experiment=TABLE_5, of="turns", fair=False,
    ),
    ant(
        item="Eqs 14 to 16: choice and update", chapter="10",
        says="ants choose by pheromone and distance; short routes get more of it",
        why="Definitions: they are used as they are, and the risk isn't in them.",
    ),
    ant(
        item="Eq. 17, Table 3: limits", chapter="10", line=50.0, unit="% of runs",
        says="limits of the pheromone keep the search from an early end: it improves after generation "
        "10 of 100 (line: in half of the runs, ours)",
        why="With Table 3 the upper limit isn't reached and the lower one is 0.", experiment=LIMITS, of="still better",
    ),
    ant(
        item="Section 3.4, Fig. 12: splits, risk", chapter="10", line=50.0, unit="% of runs",
        says="a route that is searched in parts has less risk (against as many ants in one part)",
        why="Of each part the best is picked by its risk; the ants themselves choose by length.",
        experiment=SPLITS, of="better",
    ),
    ant(
        item="Fig. 12: splits, time", chapter="10", says="time grows with the splits",
        why="Time is what one gives: as many ants can walk in one part or in many.",
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
        item="Table 4: risk", chapter="10", printed="21", line=0.0, unit="% less risk",
        says="the improved colony finds less risk than the basic one",
        why="Basic isn't defined; by our guess it sees no height and makes any turn.", experiment=HABITS,
        of="less risk", fair=False,
    ),
    ant(
        item="Table 4: time", chapter="10", says="7.67 s against 8.12 s",
        why="A ratio of times belongs to a machine and a program.",
    ),
    *less_risk("RISK-ACO"),
    ant(
        item="Table 5: by the paper's colony", chapter="10", line=50.0, unit="% of runs",
        says="its own settings find such a route on a campus that has one",
        why="It ends early, with routes that are far from the best.", experiment=TABLE_5, of="met",
    ),
    ant(
        item="Fig. 13: hardware", chapter="14", says="multirotor, autopilot, radio, ground station",
        why="Mass and control, and what the radio loses, aren't given.",
    ),
    ant(
        item="Fig. 14: photographs", chapter="14", says="in flight and landing", why=NOT_IN_TEXT,
    ),
    ant(
        item="Fig. 15: a safe flight", chapter="14", line=50.0, unit="% of flights",
        says="flights on the route are safe (line: half of them, ours)", why="One flight says next to nothing.",
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
        item="Eqs 13 to 16, Table 3: swarm", chapter="11",
        says="settings of the swarm: inertia ω = 1, pulls c1 + c2 = 3.5",
        why="Settings are no claim; what they do is judged in the rows on beetles.",
    ),
    bas(
        item="Eq. 17: random direction", chapter="11", line=1.0, side="equal", unit="of the even share",
        says="directions are random, so corners of a cube get their even share",
        why="Numbers from a cube, divided by their length, prefer its corners.", experiment=ANTENNAE, of="corners",
    ),
    bas(
        item="Eq. 18: distance of the antennae", chapter="11", line=1.0, side="equal", unit="of d",
        says="d is the distance between the tips of both antennae", experiment=ANTENNAE, of="length", fair=False,
        why="In our text the tips are twice as far apart; indices are misread there, so a halving may be lost, too.",
    ),
    bas(
        item="Eqs 19 to 21: steps", chapter="11", says="antennae and step shrink",
        why="The first lengths aren't given.",
    ),
    *(
        bas(
            item=f"Section 4.3: beetles help, {name}, {how}", chapter="11", line=50.0, unit="% of runs",
            says=f"antennae improve a swarm on a test function, {settings}", why=why, experiment=FUNCTIONS,
            of=f"{name}, {how}",
        )
        for how, settings, name, why in (
            *(("printed", "with Table 3 and bounds of ours", name, NOT_SETTLED) for name in FUNCTION_NAMES),
            ("ours", "with settings that settle", "sphere", "A swarm that settles has better use for the evaluations."),
            *(("ours", "with settings that settle", name, TOO_FEW) for name in FUNCTION_NAMES[1:]),
        )
    ),
    *smoothing("PSO-BAS"),
    *flyable("PSO-BAS"),
    bas(
        item="Eq. 23: intervals", chapter="12", line=1.0, side="equal", unit="sum of the weights",
        says="the weights of the control points add up to 1, also at the ends of intervals",
        why="It hangs on < or ≤ at one place, which a machine may misread.", experiment=SPLINES, of="at knots",
        fair=False,
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
        why="Complete isn't defined: here, within a hundredth of the end, by our choice.", experiment=PRINTED,
        of="iterations", fair=False,
    ),
    *(
        bas(
            item=f"Fig. 10: sooner than {name}", chapter="11", line=50.0, unit="% of maps",
            says=f"PSO-BAS is at its end after fewer iterations than {name}",
            why="Its end isn't defined; by our choice, within a hundredth of the last value, the others end sooner.",
            experiment=PRINTED, of=f"sooner than {name}", fair=False,
        )
        for name in ("PSO", "ACO")
    ),
    bas(
        item="Fig. 10: a risk of 8.75e-7", chapter="11", printed="8.75e-7", says="the risk of the route", why=OTHER_MAP,
    ),
    *less_risk("PSO-BAS"),
]  # fmt: skip

CLAIMS = [*RISK_ACO, *PSO_BAS]
