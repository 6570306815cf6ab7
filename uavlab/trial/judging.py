"""Claims of papers, what is measured for them, and the rule by which a verdict follows.

Nobody writes a verdict down. A claim has what the paper prints, as it prints it, and a line that divides yes from no;
an experiment measures a value and its 95 % interval. How the three lie is the verdict.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from typing import NamedTuple

import numpy as np

from uavlab import checks

HOLDS, PARTLY, NOT_SHOWN, DOES_NOT, CANNOT = "holds", "partly", "not shown", "doesn't", "can't be checked"
VERDICTS = (HOLDS, PARTLY, NOT_SHOWN, DOES_NOT, CANNOT)
SIDES = ("above", "below", "equal")
PAPERS = ("REPARE", "RISK-ACO", "PSO-BAS")

NEAR = 0.05
"""Share by which a printed formula may differ from the right one and still be called equal to it; our choice."""


class Measured(NamedTuple):
    """A measured value.

    See Also
    --------
    Experiment : measures some.

    Examples
    --------
    >>> from uavlab.trial import Measured
    >>> Measured(0.5, 0.4, 0.6, "100 flights").sample
    '100 flights'
    """

    value: float
    """In the unit of the claim."""
    low: float
    """Lower end of the 95 % interval; the value itself where it is computed and not sampled."""
    high: float
    """Upper end."""
    sample: str
    """Of what."""


@dataclass(frozen=True)
class Experiment:
    """A function that measures several things at once, how large its sample is, and its seed.

    Attributes
    ----------
    measure : callable
        Called as measure(size, seed), at the top of a module; returns `Measured` by name.
    quick, full : int
        Sizes of the sample; the quick one is the first part of the full one.
    seed : int
        Of what is drawn.

    Raises
    ------
    ValueError
        If `measure` is no function; if `quick`, `full` or `seed` is no whole number, `quick` is below 1, or `full` is
        below `quick`.

    See Also
    --------
    Claim : what it is measured for.
    run_trial : runs all.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS
    >>> experiment = next(claim.experiment for claim in CLAIMS if claim.item == "Section 2.2.2, Fig. 2: one axis")
    >>> experiment.measure(experiment.quick, experiment.seed)["one axis"].value
    99.73...
    """

    measure: Callable[[int, int], dict[str, Measured]]
    quick: int = 1
    full: int = 1
    seed: int = 0

    def __post_init__(self) -> None:
        checks.function("measure", self.measure, "measure(size, seed)")
        object.__setattr__(self, "quick", checks.whole("quick", self.quick, least=1))
        object.__setattr__(self, "full", checks.whole("full", self.full, least=self.quick))
        object.__setattr__(self, "seed", checks.whole("seed", self.seed, least=0))

    @property
    def name(self) -> str:
        return self.measure.__name__.replace("_", " ")


@dataclass(frozen=True, kw_only=True)
class Claim:
    """What a paper says, and what would show it.

    Attributes
    ----------
    paper, item : str
        Such as "REPARE" and "Table 2: length"; no two claims share both.
    says : str
        The claim in words.
    why : str
        One sentence: where the result comes from, or why there is none.
    chapter : str
        Two digits: where more is said.
    printed : str
        The number as the paper prints it, with its digits, such as "0.952"; nothing where it prints none.
    at_least : bool
        Whether the printed number is a promise that may be outdone, on its side of the line.
    line : float, optional
        Divides yes from no.
    side : {"above", "below", "equal"}
        Where of the line the claim lies; "equal" is within 5 % of it.
    unit : str
        Of the number and the line.
    experiment : Experiment, optional
        None: nothing can be measured.
    of : str
        Which of the experiment's values.
    fair : bool
        Whether the measurement can speak against the claim. False where our model was fitted to the number, or stands
        for data that aren't there: it is shown, and nothing is concluded.

    Raises
    ------
    ValueError
        If a text is missing or no text, `printed` is no number, `side` is unknown, `line` is not finite, `at_least` or
        `fair` is not True or False, or an experiment is given but no `of`, or neither a number nor a line.

    See Also
    --------
    verdict : the rule.
    Finding : a claim and what was found.

    Examples
    --------
    >>> from uavlab.trial import Claim
    >>> shorter = Claim(paper="REPARE", item="Table 2", says="A* is shorter than the field", why="It searches.",
    ...                 chapter="06", printed="0.952", line=1.0, side="below")
    >>> shorter.number, shorter.rounding
    (0.952, 0.0005)
    """

    paper: str
    item: str
    says: str
    why: str
    chapter: str
    printed: str = ""
    at_least: bool = False
    line: float | None = None
    side: str = "above"
    unit: str = ""
    experiment: Experiment | None = None
    of: str = ""
    fair: bool = True

    def __post_init__(self) -> None:
        for name in ("item", "says", "why", "chapter"):
            if not checks.text(name, getattr(self, name)).strip():
                raise ValueError(f"{name} must say something")
        for name in ("printed", "unit", "of"):
            checks.text(name, getattr(self, name))
        checks.one_of("paper", self.paper, PAPERS)
        checks.one_of("side", self.side, SIDES)
        checks.flag("at_least", self.at_least)
        checks.flag("fair", self.fair)
        if self.line is not None:
            object.__setattr__(self, "line", checks.number("line", self.line, checks.finite))
        if self.printed and not is_number(self.printed):
            raise ValueError(f"printed must be a number as the paper prints it, such as '0.952', got {self.printed!r}")
        if self.experiment is not None:
            checks.instance("experiment", self.experiment, Experiment)
            if not self.of:
                raise ValueError("of must name the value of the experiment that the claim is about")
            if self.fair and self.line is None and not self.printed:
                raise ValueError("line must be a number where the paper prints none: what would show the claim?")

    @property
    def number(self) -> float | None:
        """What is printed, as a number."""
        return float(self.printed) if self.printed else None

    @property
    def rounding(self) -> float:
        """Half of the last digit that is printed."""
        return 0.5 * 10.0 ** int(Decimal(self.printed).as_tuple().exponent) if self.printed else 0.0


def is_number(text: str) -> bool:
    """Whether a text is a finite number."""
    try:
        return bool(np.isfinite(float(text)))
    except ValueError:
        return False


class Finding(NamedTuple):
    """A claim, what was measured, and the verdict.

    See Also
    --------
    run_trial : finds all.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, Finding
    >>> finding = Finding.of(CLAIMS[0], None, "")
    >>> finding.verdict
    "can't be checked"
    """

    claim: Claim
    measured: Measured | None
    verdict: str
    versions: str

    @classmethod
    def of(cls, claim: Claim, measured: Measured | None, versions: str) -> Finding:
        """The verdict follows from the claim and what was measured."""
        return cls(claim, measured, verdict(claim, measured), versions)

    @property
    def key(self) -> tuple[str, str]:
        return self.claim.paper, self.claim.item


def verdict(claim: Claim, measured: Measured | None) -> str:
    """What a measurement says of a claim.

    - *can't be checked*: there is no measurement, or it isn't a fair test.
    - *doesn't*: the whole interval lies on the wrong side of the line; or there is no line, and the interval misses the
      printed number.
    - *not shown*: the line goes through the interval.
    - *holds*: the whole interval lies on the claim's side of the line, and has the printed number in it, if there is
      one, as far as its digits go; a promise may be outdone.
    - *partly*: the whole interval lies on the claim's side of the line, but misses the number.

    Parameters
    ----------
    claim : Claim
        With its number, line and side.
    measured : Measured, optional
        None where nothing was measured.

    Returns
    -------
    str
        One of the five.

    Raises
    ------
    ValueError
        If `claim` is no Claim, or `measured` is neither None nor a Measured of a value within its interval.

    See Also
    --------
    Claim : what it needs.

    Examples
    --------
    >>> from uavlab.trial import Claim, Measured, verdict
    >>> claim = Claim(paper="RISK-ACO", item="Table 5", says="80 % less risk", why="Detours.", chapter="09",
    ...               printed="80", at_least=True, line=0.0)
    >>> for low, high in ((70, 90), (85, 95), (40, 60), (-10, 85), (-20, -5)):
    ...     print(low, high, verdict(claim, Measured((low + high) / 2, low, high, "40 maps")))
    70 90 holds
    85 95 holds
    40 60 partly
    -10 85 not shown
    -20 -5 doesn't
    """
    checks.instance("claim", claim, Claim)
    if measured is None:
        return CANNOT
    checks.instance("measured", measured, Measured)
    value, low, high = (float(number) for number in measured[:3])
    if not low <= value <= high:  # also where one is NaN
        raise ValueError(f"measured must have its value within its interval, got {value:g} and [{low:g}, {high:g}]")
    if not claim.fair:
        return CANNOT
    if claim.line is not None and (found := side_of_line(claim, low, high)):
        return found
    return HOLDS if reaches(claim, low, high) else DOES_NOT if claim.line is None else PARTLY


def side_of_line(claim: Claim, low: float, high: float) -> str:
    """The verdict where an interval isn't all on the claim's side of its line; nothing where it is."""
    line = float(claim.line or 0.0)
    if claim.side == "equal":
        least, most = line - NEAR * abs(line), line + NEAR * abs(line)
        right, wrong = least <= low and high <= most, high < least or most < low
    else:
        worst, best = (low - line, high - line) if claim.side == "above" else (line - high, line - low)
        right, wrong = worst > 0, best <= 0
    return "" if right else DOES_NOT if wrong else NOT_SHOWN


def reaches(claim: Claim, low: float, high: float) -> bool:
    """Whether an interval has the printed number in it, or outdoes a promise; without a number it does."""
    if claim.number is None:
        return True
    half = claim.rounding * (1 + 1e-9)  # so that 0.9525 counts for 0.952, as it does on paper
    least, most = claim.number - half, claim.number + half
    if claim.at_least and claim.line is not None:
        return high >= least if claim.side == "above" else low <= most
    return low <= most and high >= least


def agree(one: Finding, other: Finding) -> bool:
    """Whether two measurements of a claim can both be right: their intervals touch.

    Parameters
    ----------
    one, other : Finding
        Of the same claim.

    Returns
    -------
    bool
        Also True where both measured nothing. Numbers are compared to six digits, as they are stored.

    Raises
    ------
    ValueError
        If `one` or `other` is no Finding, or they are of two claims.

    See Also
    --------
    read_findings : those that are stored.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, Finding, Measured, agree
    >>> claim = next(claim for claim in CLAIMS if claim.experiment)
    >>> few, many = Measured(0.5, 0.3, 0.7, "20"), Measured(0.62, 0.59, 0.65, "1000")
    >>> agree(Finding.of(claim, few, ""), Finding.of(claim, many, ""))
    True
    """
    for name, finding in (("one", one), ("other", other)):
        checks.instance(name, finding, Finding)
    if one.key != other.key:
        raise ValueError(f"other must be of the same claim as one, {one.key}, got {other.key}")
    if one.measured is None or other.measured is None:
        return one.measured is other.measured
    slack = 1e-5 * max(abs(one.measured.value), abs(other.measured.value))
    return bool(one.measured.low <= other.measured.high + slack and other.measured.low <= one.measured.high + slack)
