"""Findings as a table in Markdown and as a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uavlab import checks, plot
from uavlab.plot.panels import GREY, with_legend
from uavlab.plot.style import plain
from uavlab.trial.judging import CANNOT, DOES_NOT, HOLDS, NEAR, NOT_SHOWN, PARTLY, Claim, Finding, Measured

LOOKS = {
    HOLDS: ("o", plot.BLUE), PARTLY: ("^", plot.GREEN), NOT_SHOWN: ("s", plot.YELLOW), DOES_NOT: ("v", plot.ORANGE),
    CANNOT: ("D", GREY),
}  # fmt: skip
"""Shape and colour of a verdict."""
SIGNS = {HOLDS: "●", PARTLY: "▲", NOT_SHOWN: "■", DOES_NOT: "▼", CANNOT: "◇"}
SIDE_SIGNS = {"above": ">", "below": "<", "equal": "≈"}
HEAD = ("claim", "paper's number", "line", "measured [95 % interval]", "quick, here", "verdict", "why", "chapter")
QUICK = HEAD.index("quick, here")
GOOD = "#dcebdc"
"""Behind the good side of a claim."""


def claims_table(
    findings: Sequence[Finding], quick: Sequence[Finding] = (), *, links: Mapping[str, str] | None = None
) -> str:
    """A table of findings in Markdown, a row for each.

    Parameters
    ----------
    findings : sequence of Finding
        In the order of the rows.
    quick : sequence of Finding
        Of smaller samples, shown in a column beside those of the same claims; without them there is no such column.
    links : mapping of str, optional
        File of each chapter, by its two digits.

    Returns
    -------
    str
        For `IPython.display.Markdown`.

    Raises
    ------
    ValueError
        If `findings` is empty, or it or `quick` has something else in it than findings, or `links` is no mapping of
        texts.

    See Also
    --------
    verdict_figure : the same as a picture.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, Finding, claims_table
    >>> print(claims_table([Finding.of(CLAIMS[1], None, "")]).splitlines()[2][:50])
    | **Eq. 1: force of the rain**: a raindrop presses
    """
    findings = checks.several("findings", findings, Finding)
    beside = {one.key: one.measured for one in checks.several("quick", quick, Finding, least=0)}
    files = checks.by_name("links", links or {}, str, least=0)
    rows = [HEAD, (":---",) * len(HEAD)]  # text, so at the left
    for one in findings:
        claim, chapter = one.claim, one.claim.chapter
        sample = f" {claim.unit}; {one.measured.sample}" if one.measured else ""
        rows.append((
            f"**{claim.item}**: {claim.says}", claim.printed, line_of(claim), with_interval(one, one.measured) + sample,
            with_interval(one, beside.get(one.key)), f"{SIGNS[one.verdict]} {one.verdict}", claim.why,
            f"[{chapter}]({files[chapter]})" if chapter in files else chapter,
        ))  # fmt: skip
    if not beside:
        rows = [row[:QUICK] + row[QUICK + 1 :] for row in rows]
    return "\n".join("| " + " | ".join(map(escaped, row)) + " |" for row in rows)


def line_of(claim: Claim) -> str:
    """The line, and on which side of it the claim lies."""
    if claim.line is None or claim.experiment is None:
        return ""
    return f"{SIDE_SIGNS[claim.side]} {claim.line:g}"


def escaped(cell: str) -> str:
    """Without signs that Markdown would take for its own, but for bold."""
    return cell.replace("A*", r"A\*").replace("|", r"\|")


def with_interval(finding: Finding, measured: Measured | None) -> str:
    """A value and its interval, with about as many digits as are printed."""
    if measured is None:
        return ""
    printed = len(finding.claim.printed.partition(".")[2].partition("e")[0])
    value, low, high = (rounded(number, printed) for number in measured[:3])
    return value if low == high else f"{value} [{low}, {high}]"


def rounded(number: float, decimals: int) -> str:
    """With three digits, or four where so many are printed; whole numbers without a point."""
    if float(number).is_integer():
        return f"{number:.0f}"
    least = 2 - int(np.floor(np.log10(abs(number))))
    return f"{number:.{max(least, min(decimals, least + 1), 0)}f}"


def verdict_figure(findings: Sequence[Finding]) -> Figure:
    """What was measured for the claims that could be checked, a row for each, in up to three panels.

    One panel holds percentages on an axis from 0 to 100. One holds what is measured for a printed number, over that
    number, close to 1. One holds ratios to the line, on a logarithmic axis. A bar behind a row is the claim's good
    side; shape and colour of a mark are the verdict's.

    Parameters
    ----------
    findings : sequence of Finding
        Best of one paper: rows have the names of its items. Those that can't be checked aren't drawn.

    Returns
    -------
    matplotlib.figure.Figure
        With a panel for each kind of axis that is needed, one below the other.

    Raises
    ------
    ValueError
        If `findings` is empty, has something else in it, or nothing in it could be checked.

    See Also
    --------
    claims_table : the same in words and numbers.

    Examples
    --------
    >>> from uavlab.trial import CLAIMS, Finding, Measured, verdict_figure
    >>> claim = next(claim for claim in CLAIMS if claim.item == "Fig. 11: A* collides")
    >>> figure = verdict_figure([Finding.of(claim, Measured(70, 60, 80, "100 flights"), "")])
    >>> figure.axes[0].get_yticklabels()[0].get_text()
    'Fig. 11: A* collides'
    """
    drawn = [one for one in checks.several("findings", findings, Finding) if one.verdict != CANNOT]
    if not drawn:
        raise ValueError("findings must have one that could be checked, to be drawn")
    kinds = [kind for kind in SCALES if any(scale_of(one.claim) == kind for one in drawn)]
    parts = [[one for one in drawn if scale_of(one.claim) == kind] for kind in kinds]
    height = 0.26 * len(drawn) + 1.0 * len(kinds) + 0.6
    _, panels = plot.new_panels(len(kinds), 1, width=9.0, height=height)
    if grid := panels[0].get_gridspec():
        grid.set_height_ratios([len(part) + 1 for part in parts])
    for axes, kind, part in zip(panels, kinds, parts, strict=True):
        for row, one in enumerate(part):
            draw_row(axes, row, one, SCALES[kind])
        dress(axes, part, SCALES[kind])
    for name, (marker, color) in LOOKS.items():
        if any(one.verdict == name for one in drawn):
            panels[0].plot([], [], marker, color=color, label=name)
    panels[0].plot([], [], "-", color="black", linewidth=2, label="interval, in the verdict's colour")
    panels[0].plot([], [], "|", color="black", markersize=10, label="the paper's number")
    panels[0].plot([], [], "-", color=GOOD, linewidth=8, label="the claim's side of its line")
    return with_legend(panels[0])


class Scale(NamedTuple):
    """An axis of the figure."""

    title: str
    label: str
    least: float
    most: float
    ticks: tuple[float, ...]
    logarithmic: bool = False


SCALES = {
    "percent": Scale("percentages", "measured [%], of what the table says", 0.0, 100.0, (0, 25, 50, 75, 100)),
    "number": Scale("numbers that are printed", "measured over the paper's number (linear axis)", 0.9, 1.1,
                    (0.9, 0.95, 1.0, 1.05, 1.1)),
    "ratio": Scale("formulas and ratios without a printed number", "measured over the line (logarithmic axis)", 0.1,
                   10.0, (0.1, 0.2, 0.5, 1, 2, 5, 10), logarithmic=True),
}  # fmt: skip
"""By what a claim is about."""


def scale_of(claim: Claim) -> str:
    """Which axis a claim belongs to."""
    if claim.unit.startswith("%") and (claim.line is not None or not claim.printed):
        return "percent"
    return "number" if claim.printed else "ratio"


def over(claim: Claim) -> float:
    """What a measurement is divided by on the claim's axis."""
    kind = scale_of(claim)
    if kind == "percent":
        return 1.0
    return abs((claim.number if kind == "number" else claim.line) or 1.0)


def draw_row(axes: Axes, row: int, finding: Finding, scale: Scale) -> None:
    """The good side, the printed number, the interval and the value; beyond the axis the value in digits."""
    if finding.measured is None:
        return
    claim, (marker, color) = finding.claim, LOOKS[finding.verdict]
    low, high = good_side(claim, scale)
    axes.barh(row, high - low, left=low, height=0.8, color=GOOD, edgecolor=GOOD, linewidth=2, zorder=0)
    if claim.number is not None:
        axes.plot(claim.number / over(claim), row, "|", color="black", markersize=11, zorder=2, clip_on=False)
    measured = np.array(finding.measured[:3]) / over(claim)
    value, low, high = np.clip(measured, scale.least, scale.most)
    axes.plot([low, high], [row, row], "-", color=color, linewidth=2)
    axes.plot(value, row, marker, color=color, markersize=6, clip_on=False, zorder=3)
    if value != measured[0]:
        left = value == scale.least
        axes.annotate(f"{'←' if left else ''} {measured[0]:.2g} {'' if left else '→'}", (value, row), fontsize=8,
                      xytext=(7 if left else -7, 0), textcoords="offset points", va="center",
                      ha="left" if left else "right")  # fmt: skip


def good_side(claim: Claim, scale: Scale) -> tuple[float, float]:
    """From where to where the claim would be right, on its axis; at a number without a line, all that is printed so."""
    if claim.line is None:
        half = claim.rounding / over(claim)
        return 1.0 - half, 1.0 + half
    line = claim.line / over(claim)
    if claim.side == "equal":
        ends = (1 - NEAR) * line, (1 + NEAR) * line
    else:
        ends = (line, scale.most) if claim.side == "above" else (scale.least, line)
    low, high = np.clip(ends, scale.least, scale.most)
    return float(low), float(high)


def dress(axes: Axes, part: Sequence[Finding], scale: Scale) -> None:
    """Names of the rows and what the axis is."""
    papers = ", ".join(dict.fromkeys(one.claim.paper for one in part))
    axes.set(title=f"{papers}: {scale.title}", xlabel=scale.label, ylim=(len(part) - 0.4, -0.6))
    if scale.logarithmic:
        axes.set_xscale("log")
    beyond = 0.0 if scale.logarithmic else 0.02 * (scale.most - scale.least)  # room for a number at the end
    axes.set_xlim(scale.least - beyond, scale.most + beyond)
    axes.set_xticks(scale.ticks, [f"{tick:g}" for tick in scale.ticks])
    axes.minorticks_off()
    axes.set_yticks(range(len(part)), [plain(one.claim.item) for one in part], fontsize=8.5)
    axes.grid(visible=True, axis="x", alpha=0.4)
