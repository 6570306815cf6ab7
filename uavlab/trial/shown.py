"""Findings as a table in Markdown and as a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uavlab import checks, plot
from uavlab.plot.panels import GREY, with_legend
from uavlab.plot.style import plain
from uavlab.trial.judging import CANNOT, DOES_NOT, HOLDS, NOT_SHOWN, PARTLY, Claim, Finding, Measured

LOOKS = {
    HOLDS: ("o", plot.BLUE), PARTLY: ("^", plot.GREEN), NOT_SHOWN: ("s", plot.YELLOW), DOES_NOT: ("v", plot.ORANGE),
    CANNOT: ("D", GREY),
}  # fmt: skip
"""Shape and colour of a verdict."""
SIGNS = {HOLDS: "●", PARTLY: "▲", NOT_SHOWN: "■", DOES_NOT: "▼", CANNOT: "◇"}
SIDE_SIGNS = {"above": ">", "below": "<", "equal": "≈"}
HEAD = ("claim", "paper's number", "line", "measured [95 % interval]", "quick, here", "verdict", "why", "chapter")
LEAST, MOST = 0.1, 10.0
"""Ends of the figure's axis; what lies beyond is drawn at the end."""


def claims_table(
    findings: Sequence[Finding], quick: Sequence[Finding] = (), *, links: Mapping[str, str] | None = None
) -> str:
    """A table of findings in Markdown, a row for each.

    Parameters
    ----------
    findings : sequence of Finding
        In the order of the rows.
    quick : sequence of Finding
        Of smaller samples, shown beside those of the same claims.
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
    | **Eq. 1: force of the rain**: the loss of moment
    """
    findings = checks.several("findings", findings, Finding)
    beside = {one.key: one.measured for one in checks.several("quick", quick, Finding, least=0)}
    files = checks.by_name("links", links or {}, str, least=0)
    rows = [HEAD, ("---",) * len(HEAD)]
    for one in findings:
        claim, chapter = one.claim, one.claim.chapter
        sample = f" {claim.unit}; {one.measured.sample}" if one.measured else ""
        rows.append((
            f"**{claim.item}**: {claim.says}", claim.printed, line_of(claim), with_interval(one, one.measured) + sample,
            with_interval(one, beside.get(one.key)), f"{SIGNS[one.verdict]} {one.verdict}", claim.why,
            f"[{chapter}]({files[chapter]})" if chapter in files else chapter,
        ))  # fmt: skip
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
    """What was measured, over what is printed, or over the line where nothing is: a row for each claim.

    Shape and colour are the verdict's.

    Parameters
    ----------
    findings : sequence of Finding
        Those without a measurement aren't drawn.

    Returns
    -------
    matplotlib.figure.Figure
        With two columns of rows.

    Raises
    ------
    ValueError
        If `findings` is empty, has something else in it, or nothing in it was measured.

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
    drawn = [one for one in checks.several("findings", findings, Finding) if one.measured and reference(one)]
    if not drawn:
        raise ValueError("findings must have one that was measured, to be drawn")
    first = [one for one in drawn if one.claim.paper == "REPARE"]
    columns = [part for part in (first, [one for one in drawn if one not in first]) if part]
    most = max(map(len, columns))
    _, panels = plot.new_panels(1, len(columns), width=6.6 * len(columns), height=1.2 + 0.19 * most)
    for axes, part in zip(panels, columns, strict=True):
        for height, one in enumerate(part):
            draw_row(axes, height, one)
        papers = " and ".join(dict.fromkeys(one.claim.paper for one in part))
        axes.set(xscale="log", xlim=(LEAST, MOST), ylim=(most - 0.4, -0.6), title=papers,
                 xlabel="measured over the paper's number, or over the line")  # fmt: skip
        axes.set_xticks([0.1, 0.2, 0.5, 1, 2, 5, 10], ["≤ 0.1", "0.2", "0.5", "1", "2", "5", "≥ 10"])
        axes.minorticks_off()
        axes.axvline(1.0, color="0.4", linewidth=0.8)
        axes.set_yticks(range(len(part)), [plain(one.claim.item) for one in part], fontsize=7)
        axes.grid(visible=True, axis="x", alpha=0.4)
    for name, (marker, color) in LOOKS.items():
        if any(one.verdict == name for one in drawn):
            panels[0].plot([], [], marker, color=color, label=name)
    panels[0].plot([], [], "o", color=GREY, markerfacecolor="white", label="hollow: over the line, no number is given")
    return with_legend(panels[0])


def reference(finding: Finding) -> float:
    """What a measurement is held against: the printed number, else the line; 0 where there is none."""
    return abs(finding.claim.number or finding.claim.line or 0.0)


def draw_row(axes: Axes, height: int, finding: Finding) -> None:
    """A mark with its interval; at the end of the axis, where it lies beyond."""
    marker, color = LOOKS[finding.verdict]
    if finding.measured is None:
        return
    value, low, high = np.clip(np.array(finding.measured[:3]) / reference(finding), LEAST, MOST)
    axes.plot([low, high], [height, height], "-", color=color, linewidth=1.6)
    filled = color if finding.claim.number else "white"
    axes.plot(value, height, marker, color=color, markerfacecolor=filled, markersize=5, clip_on=False)
