"""A picture with sliders as a piece of HTML: native range inputs, and a script that puts the frames together.

Nothing in it has an identifier, so that any number of them may stand on one page: each script begins whatever pieces
aren't live yet. Without scripts the picture at the first position is shown, and a sentence instead of the sliders.
"""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Sequence
from typing import NamedTuple

Overlay = tuple[int, int, bytes]
"""What a frame draws over the base: left and upper end [pixels], PNG."""


class Scale(NamedTuple):
    """A slider: what it is called, and what stands for each of its values."""

    name: str
    """The argument's."""
    label: str
    values: tuple[float | int | str, ...]
    words: tuple[str, ...]
    """As shown, with the unit."""


class Pictures(NamedTuple):
    """Frames, each once, and where they belong."""

    size: tuple[int, int]
    """Width and height [pixels]."""
    still: bytes
    """PNG of the frame that is shown first."""
    base: bytes
    """PNG below all overlays."""
    overlays: Sequence[Overlay]
    order: Sequence[int]
    """Number of the overlay for each combination of values, the last slider's first."""


def alternative(title: str, scales: Sequence[Scale], at: Sequence[int]) -> str:
    """What stands for the picture where it can't be seen: "figure: wind 3 m/s, load 0.5"."""
    return f"{title}: " + ", ".join(f"{scale.label} {scale.words[i]}" for scale, i in zip(scales, at, strict=True))


def fragment(title: str, scales: Sequence[Scale], at: Sequence[int], pictures: Pictures) -> str:
    """The piece of HTML; `at` is the number of the value that each slider has first."""
    width, height = pictures.size
    label_room = min(24, max(len(scale.label) for scale in scales))
    word_room = min(24, max(len(word) for scale in scales for word in scale.words))
    data = {
        "title": title,
        "scales": [{"label": scale.label, "words": scale.words} for scale in scales],
        "base": encoded(pictures.base),
        "overlays": [(left, top, encoded(picture)) for left, top, picture in pictures.overlays],
        "order": pictures.order,
    }
    return FRAGMENT.format(
        title=html.escape(title),
        style=STYLE,
        width=width,
        height=height,
        room=f"--label:{label_room}ch;--word:{word_room}ch",
        rows="\n".join(row(scale, i) for scale, i in zip(scales, at, strict=True)),
        still=encoded(pictures.still),
        alt=html.escape(alternative(title, scales, at)),
        data=json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c"),
        script=SCRIPT,
    )


def row(scale: Scale, i: int) -> str:
    """A slider with its label on the left and its value on the right."""
    word = html.escape(scale.words[i])
    return (
        f'<div><label><span>{html.escape(scale.label)}</span><input type="range" min="0" max="{len(scale.words) - 1}" '
        f'step="1" value="{i}" aria-valuetext="{word}" autocomplete="off"></label>'
        f'<output aria-live="off">{word}</output></div>'
    )


def encoded(content: bytes) -> str:
    return base64.b64encode(content).decode()


FRAGMENT = """\
<div class="uavlab-sliders" role="group" aria-label="{title}" style="width:{width}px;max-width:100%;{room}">
<style>{style}</style>
<div class="uavlab-rows" hidden>
{rows}
</div>
<img src="data:image/png;base64,{still}" width="{width}" height="{height}" alt="{alt}">
<p>The sliders need scripts: in Jupyter they come with <i>Run All Cells</i>.</p>
<script type="application/json">{data}</script>
<script>{script}</script>
</div>"""

STYLE = """
.uavlab-sliders{container-type:inline-size}
.uavlab-sliders .uavlab-rows{padding:2px 0 6px}
.uavlab-sliders .uavlab-rows[hidden]{display:none}
.uavlab-sliders .uavlab-rows div,.uavlab-sliders label{display:flex;align-items:center;gap:0 12px}
.uavlab-sliders label{flex:1;min-width:0;margin:0}
.uavlab-sliders label span{flex:0 0 var(--label)}
.uavlab-sliders input{flex:1;min-width:0;height:28px;margin:0;accent-color:#0072b2;cursor:pointer}
.uavlab-sliders output{flex:0 0 var(--word);line-height:28px;font-variant-numeric:tabular-nums}
.uavlab-sliders img,.uavlab-sliders canvas{display:block;max-width:100%;height:auto;background:#fff}
@container (max-width:480px){
.uavlab-sliders .uavlab-rows div{align-items:end}
.uavlab-sliders label{flex-wrap:wrap}
.uavlab-sliders label span,.uavlab-sliders input{flex:1 0 100%}
}
"""

SCRIPT = """
for (const root of document.querySelectorAll(".uavlab-sliders:not([data-live])")) {
  root.dataset.live = "yes";
  const data = JSON.parse(root.querySelector("script[type='application/json']").textContent);
  const inputs = [...root.querySelectorAll("input")], outputs = [...root.querySelectorAll("output")];
  const still = root.querySelector("img"), canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d");
  const load = picture => new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = reject;
    image.src = "data:image/png;base64," + picture;
  });
  const base = load(data.base), loaded = new Map();
  let wanted;
  const show = async () => {
    const at = inputs.map(input => Number(input.value));
    const words = data.scales.map((scale, k) => scale.words[at[k]]);
    words.forEach((word, k) => {
      inputs[k].setAttribute("aria-valuetext", word);
      outputs[k].textContent = word;
    });
    const frame = wanted = at.reduce((sum, i, k) => sum * data.scales[k].words.length + i, 0);
    const [left, top, picture] = data.overlays[data.order[frame]];
    if (!loaded.has(picture)) loaded.set(picture, load(picture));
    const layers = await Promise.all([base, loaded.get(picture)]);
    if (wanted !== frame) return;  // dragged on while this one was unpacked
    pen.drawImage(layers[0], 0, 0);
    pen.drawImage(layers[1], left, top);
    const said = words.map((word, k) => data.scales[k].label + " " + word);
    canvas.setAttribute("aria-label", data.title + ": " + said.join(", "));
    canvas.dataset.frame = frame;
    still.replaceWith(canvas);
  };
  canvas.width = still.getAttribute("width");
  canvas.height = still.getAttribute("height");
  canvas.setAttribute("role", "img");
  root.querySelector("p").remove();
  root.querySelector(".uavlab-rows").hidden = false;
  for (const input of inputs) {
    input.addEventListener("input", show);
    input.addEventListener("keydown", event => {  // else JupyterLab takes it, too, and goes to another cell
      if (/^(Arrow|Home|End|Page)/.test(event.key) && !event.ctrlKey && !event.metaKey) event.stopPropagation();
    });
  }
  show();
}
"""
