"""What the colours and signs of a scene mean, as HTML."""

from __future__ import annotations

import html

import numpy as np
from matplotlib.colors import LogNorm

from uavlab.plot.colors import Style, sequential_color
from uavlab.plot.maps import RISK_LABEL
from uavlab.plot.words import with_style
from uavlab.scene.drawing import Drawing, Entry

SIGNS = {
    "start": '<circle cx="9" cy="7" r="5"/>',
    "goal": '<path d="M9 1 15 13H3z"/>',
    "missed": '<path d="M9 2.5 14 12.5H4z" fill="none" stroke="currentColor" stroke-width="2"/>',
    "stopped": '<path d="M4 2h10v10H4z"/>',
    "crash": '<path d="M4 2 14 12M14 2 4 12" stroke="currentColor" stroke-width="3.5" fill="none"/>',
    "patch": '<path d="M1 1h16v12H1z" opacity=".35"/><path d="M1 1h16v12H1z" fill="none" stroke="currentColor"/>',
    "ball": '<circle cx="9" cy="7" r="6.5" opacity=".3"/>',
    "wind": '<path d="M1 6h9V3l7 4-7 4V8H1z"/>',
}
"""In a box of 18 by 14."""


MOST_TICKS = 6
"""On a colour bar, whose labels would overprint each other."""


def legend(drawing: Drawing) -> str:
    """The legend as a list, and the notes below it."""
    lines = [f"<li>{sign(entry)}<span>{html.escape(entry.text)}</span></li>" for entry in drawing.legend]
    bars = []
    if drawing.order:
        bars.append(bar("first", "last", f"{drawing.order:,} expanded nodes by their order"))
    if drawing.risk is not None:
        bars.append(risk_bar(drawing.risk))
    said = "".join(f"<p>{html.escape(note[:1].upper() + note[1:])}.</p>" for note in drawing.notes)
    return f"<ul>{''.join(lines)}</ul>{''.join(bars)}{said}"


def sign(entry: Entry) -> str:
    """The sign before a line of the legend, as inline SVG."""
    drawn = SIGNS.get(entry.kind) or line_of(entry.style or Style(entry.color, "-"), 2 if entry.kind == "thin" else 4)
    return f'<svg viewBox="0 0 18 14" aria-hidden="true" style="color:{entry.color}" fill="currentColor">{drawn}</svg>'


def line_of(style: Style, width: float) -> str:
    """A piece of a line in its style."""
    from uavlab.scene.shapes import DASHES

    dashes = DASHES[style.line] if isinstance(style.line, str) else style.line[1]
    pattern = f' stroke-dasharray="{" ".join(f"{width / 2 * length:g}" for length in dashes)}"' if dashes else ""
    return f'<path d="M0 7h18" stroke="currentColor" stroke-width="{width}"{pattern}/>'


def gradient() -> str:
    stops = ",".join(sequential_color(share) for share in np.linspace(0, 1, 9))
    return f"background:linear-gradient(90deg,{stops})"


def bar(low: str, high: str, label: str) -> str:
    """A colour bar with words at its ends."""
    return (
        f'<figure class="bar"><div style="{gradient()}"></div>'
        f"<div><span>{low}</span><span>{high}</span></div><figcaption>{html.escape(label)}</figcaption></figure>"
    )


def risk_bar(norm: LogNorm) -> str:
    """The scale of risk with a tick at each power of ten, or at every second or third where they are many."""
    low, high = np.log10([norm.vmin or 1.0, norm.vmax or 1.0])
    first, last = np.ceil(low - 1e-9), np.floor(high + 1e-9)
    powers = np.arange(first, last + 1, max(1, np.ceil((last - first + 1) / MOST_TICKS)))
    ticks = "".join(
        f'<span style="left:{100 * float(norm(10.0**power)):.1f}%">10<sup>{power:.0f}</sup></span>' for power in powers
    )
    ends = f"from {norm.vmin:.1e} to {norm.vmax:.1e}"
    return (
        f'<figure class="bar"><div style="{gradient()}"></div><div class="ticks">{ticks}</div>'
        f"<figcaption>{html.escape(RISK_LABEL)}, {ends}, logarithmic scale</figcaption></figure>"
    )


def words_of(drawing: Drawing) -> str:
    """What a scene shows, in a sentence or two."""
    width, depth, height = np.ptp(drawing.box, axis=0)
    said = [f"Scene in 3D: {drawing.title}, {width:.0f} by {depth:.0f} m on the ground, {height:.0f} m high"]
    lines = [entry.text for entry in drawing.legend if entry.kind in ("patch", "wind")]
    lines = [with_style(e.text, e.style) for e in drawing.legend if e.style and e.kind in ("line", "thin")] + lines
    if lines:
        said.append("; ".join(lines))
    if drawing.order:
        said.append(f"{drawing.order:,} expanded nodes, dark first, bright last")
    if drawing.risk is not None:
        said.append(f"the ground is coloured by the {RISK_LABEL}, {drawing.risk.vmin:.1e} to {drawing.risk.vmax:.1e}")
    return ". ".join(part[:1].upper() + part[1:] for part in said) + "."
