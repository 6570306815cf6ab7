"""What stands beside a live scene: planners, settings, flights, the calls in Python."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from typing import Any

from uavlab.plot.colors import Style
from uavlab.scene.legend import line_of
from uavlab.scene.live_offers import OFFERS, SLIDERS, Settings


def panel(looks: Mapping[str, Style], first: Mapping[str, str], now: Settings, told: Mapping[str, Any]) -> str:
    """As HTML; `first` is what is said at first of those that are shown."""
    names = list(looks)
    rows = "".join(
        f'<li id="offer-{number}"><label><input type="checkbox"{" checked" * (name in first)}>'
        f'<svg viewBox="0 0 18 14" aria-hidden="true" style="color:{looks[name].color}">{line_of(looks[name], 4)}</svg>'
        f'{html.escape(name)}</label><span class="found">{html.escape(first.get(name, ""))}</span>'
        '<span class="flown" role="status"></span></li>'
        for number, name in enumerate(names)
    )
    sliders = "".join(control(name, value, told["conditions"], users_of(name, names)) for name, value in now.items())
    expanded = '<label class="tick"><input type="checkbox" id="expanded">Show expanded voxels, as dots</label>'
    times = told.get("flights", {}).get("total", 0)
    fly = f'<button id="fly">Fly each {times} times</button>' if times else ""
    flies = ' class="flies"' if times else ""
    ends = "control points" if "curve" in told else "start and goal"
    where = "" if "curve" in told else '<p id="where" role="status"></p>'
    return (
        f'<section id="live"{flies}><ul id="offers">{rows}</ul>'
        '<p id="wrong" role="alert" hidden><span></span> <button id="instead"></button></p>'
        f"{where}"
        f'<div class="sets">{sliders}</div>{expanded * told["expansions"]}<p class="acts">{fly}'
        '<button id="again">Start over</button><button id="link">Copy link</button></p>'
        '<input id="linked" readonly hidden aria-label="Link"><details><summary>As Python</summary>'
        '<pre id="python" tabindex="0"></pre></details>'
        f"<p>Drag {ends} over the map, and the arrow above for the height. Or click one: arrow keys (up is north), "
        "Page Up and Page Down move it; with Shift ten times as far.</p>"
        '<p id="lifeless" role="alert" hidden></p></section>'
    )


def users_of(setting: str, names: Sequence[str]) -> str:
    """Which of a scene's planners have a setting; empty if all or none have."""
    users = [name for name in names if name in OFFERS and setting in OFFERS[name].needs]
    return ", ".join(users) if len(users) < len(names) else ""


def control(name: str, value: float, conditions: Sequence[Mapping[str, Any]], users: str) -> str:
    """A slider, or a list to choose from."""
    slider = SLIDERS[name]
    of = f"<small>{html.escape(users)}</small>" if users else ""
    if name == "conditions":
        options = "".join(f'<option value="{n}">{one["label"]}</option>' for n, one in enumerate(conditions))
        return f'<label class="set">{slider.label}<select id="set-{name}">{options}</select>{of}</label>'
    return (
        f'<label class="set">{slider.label} <output id="is-{name}">{value:g}{slider.unit}</output>'
        f'<input type="range" id="set-{name}" min="{slider.least:g}" max="{slider.most:g}" step="{slider.step:g}" '
        f'value="{value:g}">{of}</label>'
    )
