"""All claims at once: measured, judged, stored in a small file, read again."""

from __future__ import annotations

import csv
import importlib.metadata
from collections.abc import Iterable
from pathlib import Path

from uavlab import checks
from uavlab.sweep import sweep
from uavlab.trial import repare, repare_results, risk_papers
from uavlab.trial.judging import Claim, Experiment, Finding, Measured

CLAIMS: tuple[Claim, ...] = (*repare.METHOD, *repare_results.RESULTS, *risk_papers.CLAIMS)
"""Of all three papers, in their order."""

COLUMNS = ("paper", "item", "printed", "measured", "low", "high", "sample", "seed", "verdict", "versions")
LIBRARIES = ("numpy", "scipy", "numba", "scikit-learn", "xgboost")
"""On which measured values can depend."""


def experiments(claims: Iterable[Claim] = CLAIMS) -> list[Experiment]:
    """Each experiment once, large samples first, as they run beside each other."""
    found = {id(claim.experiment): claim.experiment for claim in claims if claim.experiment is not None}
    return sorted(found.values(), key=lambda one: -one.full)


def measure(experiment: Experiment, full: bool) -> dict[str, Measured]:
    """Run an experiment with one of its sizes."""
    return experiment.measure(experiment.full if full else experiment.quick, experiment.seed)


def run_trial(
    claims: Iterable[Claim] | None = None, *, full: bool = False, jobs: int | None = None, progress: bool = True
) -> list[Finding]:
    """Measure and judge claims, by default all of the three papers.

    Parameters
    ----------
    claims : iterable of Claim, optional
        By default `CLAIMS`. An experiment that several of them share runs once.
    full : bool
        With the full samples: minutes, for all claims. Else with the first part of each: less than one.
    jobs, progress
        As for `sweep`. What is measured doesn't depend on them.

    Returns
    -------
    list of Finding
        One for each of `claims`, in their order.

    Raises
    ------
    ValueError
        If `claims` is empty or has something else in it, an experiment doesn't answer, `full` is not True or False,
        or `jobs` or `progress` is what `sweep` refuses.
    Exception
        What an experiment raises; a note says which.

    See Also
    --------
    write_findings : keeps them.
    verdict : the rule.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, run_trial
    >>> rain = [claim for claim in CLAIMS if claim.item == "Table 3, note 2: heavy rain"]
    >>> [finding.verdict for finding in run_trial(rain, progress=False)]
    ["doesn't"]
    """
    claims = checks.several("claims", CLAIMS if claims is None else claims, Claim)
    full = checks.flag("full", full)
    each = experiments(claims)
    cases = [{"experiment": one, "full": full} for one in each]
    results = sweep(measure, cases, jobs=jobs, on_error="raise", progress=progress, unit="experiment")
    found = {id(one): result for one, result in zip(each, results, strict=True)}
    used, findings = versions(), []
    for claim in claims:
        answers = found[id(claim.experiment)] if claim.experiment else {}
        if claim.experiment and claim.of not in answers:
            raise ValueError(f"claims has one that asks for {claim.of!r}; its experiment gives {', '.join(answers)}")
        findings.append(Finding.of(claim, answers.get(claim.of), used))
    return findings


def versions() -> str:
    """Of this library and of those that measured values can depend on."""
    return "; ".join(f"{name} {version_of(name)}" for name in ("uavlab", *LIBRARIES))


def version_of(name: str) -> str:
    """As installed; XGBoost comes under two names."""
    for alias in (name, f"{name}-cpu"):
        try:
            return importlib.metadata.version(alias)
        except importlib.metadata.PackageNotFoundError:
            continue
    return "not installed"


def write_findings(findings: Iterable[Finding], path: str | Path) -> None:
    """Write findings to a CSV file: the same findings are the same bytes.

    Parameters
    ----------
    findings : iterable of Finding
        As from `run_trial`.
    path : str or path
        Of the file. Numbers have six digits.

    Returns
    -------
    None

    Raises
    ------
    ValueError
        If `findings` is empty or has something else in it, or `path` is no path.
    OSError
        If the file can't be written.

    See Also
    --------
    read_findings : the way back.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, Finding, read_findings, write_findings
    >>> findings = [Finding.of(claim, None, "") for claim in CLAIMS]
    >>> write_findings(findings, "trial.csv")
    >>> read_findings("trial.csv") == findings
    True
    """
    findings, path = checks.several("findings", findings, Finding), checks.path("path", path)
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for claim, measured, verdict, used in findings:
            numbers = [f"{number:.6g}" for number in measured[:3]] + [measured.sample] if measured else [""] * 4
            seed = claim.experiment.seed if measured and claim.experiment else ""
            table.writerow([claim.paper, claim.item, claim.printed, *numbers, seed, verdict, used])


def read_findings(path: str | Path) -> list[Finding]:
    """Read findings that are stored; their verdicts follow anew from the numbers.

    Parameters
    ----------
    path : str or path
        A file of `write_findings`.

    Returns
    -------
    list of Finding
        One for each of `CLAIMS`.

    Raises
    ------
    ValueError
        If `path` is no path, the file is none of `write_findings`, its claims are others than `CLAIMS`, or a verdict in
        it doesn't follow from its numbers: then the file is older than the claims.
    OSError
        If the file can't be read.

    See Also
    --------
    write_findings : the way there.
    agree : compares one with a new measurement.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, Finding, read_findings, write_findings
    >>> write_findings([Finding.of(claim, None, "") for claim in CLAIMS], "trial.csv")
    >>> {finding.verdict for finding in read_findings("trial.csv")}
    {"can't be checked"}
    """
    path = checks.path("path", path)
    with open(path, encoding="utf-8", newline="") as file:
        table = csv.DictReader(file)
        if tuple(table.fieldnames or ()) != COLUMNS:
            raise ValueError(f"path must be a file of write_findings, with the columns {', '.join(COLUMNS)}: {path}")
        rows = {(row["paper"], row["item"]): row for row in table}
    again = "run python notebooks/build.py --full"
    if list(rows) != [(claim.paper, claim.item) for claim in CLAIMS]:
        raise ValueError(f"path must hold today's claims in their order, {path} has others: {again}")
    findings = [finding_of(claim, rows[claim.paper, claim.item]) for claim in CLAIMS]
    for finding in findings:
        row = rows[finding.key]
        if (row["printed"], row["verdict"]) != (finding.claim.printed, finding.verdict):
            raise ValueError(f"path holds a verdict that doesn't follow from its numbers, of {finding.key}: {again}")
    return findings


def finding_of(claim: Claim, row: dict[str, str]) -> Finding:
    """A row of the file."""
    if not row["measured"]:
        return Finding.of(claim, None, row["versions"])
    value, low, high = (float(row[name]) for name in ("measured", "low", "high"))
    return Finding.of(claim, Measured(value, low, high, row["sample"]), row["versions"])
