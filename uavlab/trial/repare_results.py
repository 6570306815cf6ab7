"""What REPARE says in its results: maps, tables, figures and conclusions, in the paper's order."""

from __future__ import annotations

from uavlab.trial import by_routes
from uavlab.trial.repare import (
    CORNERS,
    DOMAIN,
    FINER,
    FORCES,
    GUSTS,
    JOINT,
    KEPT,
    LEVELS,
    NOTCH,
    PAUTA,
    TABLE_2,
    WALL,
    by_field,
    claim,
)

NO_DYNAMICS = "The text that we have gives no mass, no control and no gusts, and the figure isn't in it."
OTHER_FIELD = {
    "lattice, weak": "",
    "lattice, medium": "Both go along 26 directions, and walls push the field aside.",
    "continuous, weak": "It goes straight in any direction, A* and REPARE along 26.",
    "continuous, strong": "It goes in any direction, and strong walls push it far aside.",
}
SEARCHED = "Both search for a short way; the field doesn't."
OTHER_CLOCK = "A ratio of times belongs to a machine and to how each program looks for obstacles."

RESULTS = [
    claim(
        item="Table 1: corners", chapter="04", printed="100", line=50.0, unit="% of the corners",
        says="the five buildings of the map have the printed corners", why="Number 1 has to be read as two wings.",
        experiment=CORNERS,
        of="on our buildings",
    ),
    *by_field(
        "Table 2: A* over the field", "A*", OTHER_FIELD, chapter="06", printed="0.952", line=1.0, side="below",
        unit="of the length", says="A* is shorter than the field",
    ),
    *by_field(
        "Table 2: REPARE over the field", "REPARE", OTHER_FIELD, chapter="06", printed="0.973", line=1.0, side="below",
        unit="of the length", says="REPARE is shorter than the field",
    ),
    *(
        claim(
            item=f"Table 2: REPARE over A*, {distance} m", chapter="07", printed=f"{0.973 / 0.952:.3f}", line=1.0,
            unit="of the length", says="REPARE is longer than A*, by the ratio of the table's 0.973 and 0.952",
            why="The detour grows with the distance, which the table doesn't give: each of Table 4's has a row.",
            experiment=TABLE_2, of=f"REPARE / A*, {case}",
        )
        for case, distance in by_routes.DISTANCES.items()
    ),
    claim(
        item="Table 2: time of A* over the field", chapter="06", printed="0.558", says="A* is quicker", why=OTHER_CLOCK,
    ),
    claim(
        item="Table 2: time of REPARE over the field", chapter="06", printed="0.655", says="REPARE is quicker",
        why=OTHER_CLOCK,
    ),
    claim(
        item="Table 2: work of REPARE over A*", chapter="07", printed=f"{0.655 / 0.558:.2f}", line=1.0,
        unit="times the nodes", says="REPARE takes longer than A*, by the table's two times; we count places looked at",
        why="A ratio of times belongs to a machine, and we count nodes.", experiment=TABLE_2, of="work", fair=False,
    ),
    *by_field(
        "Figs 8–10: lengths in calm air", "alike", dict.fromkeys(by_routes.FIELDS, SEARCHED), chapter="06", line=50.0,
        unit="% of pairs", says="A* and REPARE differ less in length than A* and the field",
    ),
    claim(
        item="Fig. 11: A* collides", chapter="13", line=50.0, unit="% of flights",
        says="A* crashes once it is disturbed (line: in half of the flights, ours)",
        why="Shortest routes round a building touch it.", experiment=GUSTS, of="A* crashes, mild",
    ),
    claim(
        item="Fig. 12: the field is trapped", chapter="06", line=50.0, unit="% of settings",
        says="the field can't leave the notch of the L-shaped building",
        why="The pull leads into the corner, and the walls around it push back.", experiment=NOTCH, of="trapped",
    ),
    claim(
        item="Section 3.2: REPARE isn't trapped", chapter="07", printed="100", line=50.0, unit="% of pairs",
        says="its list of places to look at leads out of traps",
        why="Proven: a search forgets no place that it hasn't looked at.",
        experiment=TABLE_2, of="REPARE arrives",
    ),
    *(
        claim(
            item=f"Fig. 13: the field withstands {wind} gusts, {name}", chapter="13", line=50.0, unit="% of pairs",
            says="the field crashes less often than A*", why="Walls push it, so it keeps a distance.",
            experiment=GUSTS, of=f"field safer, {wind}, {name}",
        )
        for wind in ("mild", "heavy") for name in by_routes.UNFITTED
    ),
    *(
        claim(
            item=f"Fig. 14: REPARE withstands {wind} gusts", chapter="13", line=50.0, unit="% of pairs",
            says="REPARE crashes less often than A*",
            why="It keeps the distance of its case wherever a detour is cheaper.", experiment=GUSTS,
            of=f"REPARE safer, {wind}",
        )
        for wind in ("mild", "heavy")
    ),
    *(
        claim(
            item=f"Section 3.2: a smaller margin, {name}", chapter="13", line=50.0, unit="% of pairs",
            says="REPARE leaves a smaller margin than the field, to be efficient",
            why="The field's constants decide how far it keeps.", experiment=GUSTS, of=f"smaller margin, {name}",
        )
        for name in by_routes.UNFITTED
    ),
    claim(
        item="Table 3: more load or wind", chapter="07", printed="100", line=50.0, unit="% of steps",
        says="the level of care never falls with more load or wind",
        why="The printed table rises along each row and each column.", experiment=LEVELS,
        of="never lower",
    ),
    claim(
        item="Table 3, note 1: no disturbance", chapter="07", says="little wind counts as none", why="A definition.",
    ),
    claim(
        item="Table 3, note 2: heavy rain", chapter="01", line=1.0, unit="of the largest load",
        says="heavy rain can press harder than the largest load", why="A downpour presses like a few grams.",
        experiment=FORCES, of="rain",
    ),
    claim(
        item="Fig. 15: light load, mild wind", chapter="13", says="hardly deviates, runs fast", why=NO_DYNAMICS,
    ),
    claim(
        item="Fig. 16: heavy load, mild wind", chapter="13", says="slow, at its limit", why=NO_DYNAMICS,
    ),
    claim(
        item="Fig. 17: light load, heavy wind", chapter="13", says="more driving force", why=NO_DYNAMICS,
    ),
    claim(
        item="Table 4: three distances", chapter="07", says="3.5, 4.5 and 5.5 m",
        why="They are given without σ and body; our formula was fitted to them, so it tests nothing.",
    ),
    *(
        claim(
            item=f"Table 4: {distance} m are kept", chapter="07", printed="100", line=50.0, unit="% of pairs",
            says=f"{name}: REPARE keeps them", why="On these pairs a detour costs less than the zone.", experiment=KEPT,
            of=name,
        )
        for name, distance in by_routes.DISTANCES.items()
    ),
    claim(
        item="Table 4: levels", chapter="07", printed="100", line=50.0, unit="% of rows",
        says="the levels of care of three cases are those of Table 3",
        why="Light load in mild wind is intermediate here, and lower in Table 3.", experiment=LEVELS, of="agree",
    ),
    claim(
        item="Eq. 17: joint density", chapter="02", line=1.0, side="equal", unit="probability in all",
        says="it is a density of two offsets, so it adds up to 1", why="It is the bivariate normal law.",
        experiment=JOINT, of="integral",
    ),
    claim(
        item="Fig. 18: circle of 3σ", chapter="02", printed="99.7", unit="% within 3σ",
        says="the safe circle holds 99.7 % of offsets in a plane (if its radius is 3σ)",
        why="The circle's radius isn't in the text that we have; with 3σ it would hold less.", experiment=PAUTA,
        of="in a plane", fair=False,
    ),
    claim(
        item="Fig. 18: circle of 99.73 %, a flight", chapter="13", unit="% of flights",
        says="flights stay inside of a circle that holds 99.73 % of moments (26 s, ours)",
        why="The paper doesn't say for how long; a flight has many moments, and one outside is enough.",
        experiment=DOMAIN, of="inside", fair=False,
    ),
    claim(
        item="Section 3.4: safe and reliable", chapter="02", unit="% of flights",
        says="flights beside a wall at 3σ don't touch it (8 s, ours)",
        why="The paper gives neither a share nor a time; the chance of a moment adds up over a flight.",
        experiment=WALL, of="untouched", fair=False,
    ),
    claim(
        item="Section 4: a finer map", chapter="05", line=2.0, unit="times the nodes",
        says="half the cell takes A* much more work (line: more than twice the nodes, ours)",
        why="A way has twice the nodes, and a volume eight times; most pairs here need little of the volume.",
        experiment=FINER, of="expansions",
    ),
]  # fmt: skip
