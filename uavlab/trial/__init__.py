"""The papers on trial: each table, figure and claim, what is measured for it, and what follows.

`CLAIMS` lists what the three papers say; `run_trial` measures it and judges by one rule, `verdict`. How each value is
measured stands in the modules `by_formula`, `by_routes`, `by_flights`, `by_models`, `by_campuses`, `by_colonies` and
`by_swarms`, a function for each experiment.
"""

from uavlab.trial.judging import VERDICTS, Claim, Experiment, Finding, Measured, agree, verdict
from uavlab.trial.running import CLAIMS, read_findings, run_trial, write_findings
from uavlab.trial.shown import claims_table, verdict_figure

__all__ = [
    "CLAIMS",
    "VERDICTS",
    "Claim",
    "Experiment",
    "Finding",
    "Measured",
    "agree",
    "claims_table",
    "read_findings",
    "run_trial",
    "verdict",
    "verdict_figure",
    "write_findings",
]
