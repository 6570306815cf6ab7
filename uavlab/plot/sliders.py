"""Figures with sliders that need no kernel: every frame is drawn beforehand, and the browser shows the one asked for.

The frames are drawn once, on several cores where that pays, brought to one palette and kept as what differs from what
most of them have in common. So about 36 of them fit into a notebook, an exported page or a website.
"""

from __future__ import annotations

import base64
import inspect
import io
import math
import re
import time
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from uavlab import checks
from uavlab.plot.fragment import Overlay, Pictures, Scale, alternative, fragment
from uavlab.plot.palette import commonest, difference, indexed, png
from uavlab.plot.style import DPI
from uavlab.sweep import UnpicklableError, sweep

MOST_BYTES = 500_000
"""Of a fragment: pages and notebooks hold several."""
MOST_FRAMES = 400
"""No more are drawn: by far not all of them would fit."""
MOST_SLIDERS = 4
QUICK = 6.0
"""Frames that take less altogether [s] are drawn here: to begin other processes takes half of that."""

Values = Sequence[float] | Sequence[str] | np.ndarray


class Sliders:
    """A figure with sliders; the last line of a notebook's cell shows it.

    Attributes
    ----------
    html : str
        A piece of HTML, at most 500 kB, for any page; it needs no network.
    still : bytes
        PNG of the frame that is shown first, for places that can't run scripts.
    alt : str
        What stands for that picture where it can't be seen.
    frames : tuple of bytes
        PNGs of all frames as they are shown, the last slider's values first, as `itertools.product` has them.

    See Also
    --------
    sliders : Makes one.

    Examples
    --------
    >>> from uavlab import plot
    >>> shown = plot.sliders(lambda a: plot.bars({"a": a, "b": 2}, "length [m]"), a=[1, 2, 3], progress=False)
    >>> shown
    <Sliders: a, 3 frames, ... kB>
    >>> shown.alt, len(shown.frames), shown.still == shown.frames[0]
    ('figure: a 1', 3, True)
    """

    def __init__(self, html: str, frames: Sequence[bytes], first: int, names: Sequence[str], alt: str) -> None:
        self.html = html
        self.frames = tuple(frames)
        self.still = self.frames[first]
        self.names = tuple(names)
        self.alt = alt

    def __repr__(self) -> str:
        size = len(self.html.encode()) / 1000
        return f"<Sliders: {', '.join(self.names)}, {len(self.frames)} frames, {size:.0f} kB>"

    def _repr_mimebundle_(self, **_: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        still = base64.b64encode(self.still).decode()
        return (
            {"text/html": self.html, "image/png": still, "text/plain": repr(self)},
            {"image/png": {"alt": self.alt}},
        )


def sliders(
    draw: Callable[..., Figure],
    *,
    title: str = "figure",
    labels: Mapping[str, str] | None = None,
    start: Mapping[str, float | str] | None = None,
    jobs: int | None = -1,
    progress: bool = True,
    **values: Values,
) -> Sliders:
    """A figure with a slider for each argument of the function that draws it; it needs no kernel.

    Each combination of the values is drawn once, and the browser shows the one that the sliders stand for. So two
    sliders of six values make 36 frames, of which about as many fit.

    Parameters
    ----------
    draw : function
        Called as draw(wind=3, load=0.5), returns a figure, always of the same size. What it draws may depend on its
        arguments alone: random numbers come from a seed.
    title : str
        What the figure shows, for who can't see it: "title: wind 3 m/s, load 0.5" is the picture's alternative text.
    labels : mapping of name to str, optional
        What is written beside a slider, with the unit of its values in brackets: {"wind": "wind [m/s]"}. By default
        its name.
    start : mapping of name to value, optional
        What the sliders stand for first; by default the first of their values.
    jobs : int, optional
        Processes, −1 for one per core; at most 10,000. Frames that take less than 6 s altogether are drawn in this
        one. None: what `joblib.parallel_config` says, else 1.
    progress : bool
        Show a bar.
    **values : lists of numbers, or of texts
        For each slider, at most 4, what it steps over, at least two: wind=[0, 3, 6, 9], planner=["A*", "REPARE"]. At
        most 400 combinations.

    Returns
    -------
    Sliders
        Shown where it is the last line of a notebook's cell.

    Raises
    ------
    ValueError
        If `draw` is no function, uses a random generator from outside, fails or returns no figure or figures of
        different sizes; if `values` have no slider or more than 4, less than two values for one of them, a value that
        is neither a finite number nor text or that is repeated, or too many combinations; if `labels` or `start` name
        another slider, a label is no text or `start` no value of the slider; if `title` is no text, `jobs` is 0, no
        whole number or above 10,000, or `progress` is not True or False; if the frames exceed 500 kB, with how many
        would fit.

    See Also
    --------
    uavlab.scene.show : A scene to turn and fly through.
    uavlab.sweep.sweep : Draws the frames.

    Examples
    --------
    >>> from uavlab import plot
    >>> from uavlab.city import table1_city
    >>> city = table1_city(cell=5.0)
    >>> def at(height):
    ...     return plot.section(city, height)
    >>> plot.sliders(at, height=[10, 30, 50], labels={"height": "height [m]"}, start={"height": 30}, progress=False)
    <Sliders: height, 3 frames, ... kB>
    """
    draw = checks.function("draw", draw, f"draw({', '.join(f'{name}=…' for name in values) or 'wind=…'})")
    title, progress = checks.text("title", title) or "figure", checks.flag("progress", progress)
    jobs = None if jobs is None else checks.processes("jobs", jobs)
    scales = checked_scales(values, {} if labels is None else checks.by_name("labels", labels, str, least=0))
    at = positions(scales, {} if start is None else checks.by_name("start", start, least=0))
    refuse_generators(draw)
    cases = [dict(zip(values, case, strict=True)) for case in product(*(scale.values for scale in scales))]
    first = int(np.ravel_multi_index(at, [len(scale.values) for scale in scales]))
    palette, frames = indexed(same_size(all_drawn(draw, cases, first, jobs, progress), cases))
    unique, order = np.unique(frames.reshape(len(frames), -1), axis=0, return_inverse=True)
    kept = unique.reshape(-1, *frames.shape[1:])
    base = commonest(frames)
    overlays: list[Overlay] = [
        (left, top, png(piece, palette)) for left, top, piece in (difference(frame, base) for frame in kept)
    ]
    shown = [png(frame, palette) for frame in kept]
    number = order.ravel().tolist()
    height, width = base.shape
    pictures = Pictures((width, height), shown[number[first]], png(base, palette), overlays, number)
    content = fragment(title, scales, at, pictures)
    refuse_large(content, pictures, scales)
    return Sliders(content, [shown[i] for i in number], first, list(values), alternative(title, scales, at))


def checked_scales(values: Mapping[str, Values], labels: Mapping[str, str]) -> list[Scale]:
    """The sliders, each with its label and with words for its values."""
    if not 0 < len(values) <= MOST_SLIDERS:
        raise ValueError(
            f"values must make 1 to {MOST_SLIDERS} sliders, as in sliders(draw, wind=[0, 3, 6, 9]), got {len(values)}"
        )
    refuse_strangers("labels", labels, values)
    scales = []
    for name, given in values.items():
        label, unit = re.fullmatch(
            r"\s*(.*?)\s*(?:\[([^][]*)\])?\s*", labels.get(name, name.replace("_", " "))
        ).groups()  # type: ignore[union-attr]
        several = checked_values(name, given)
        scales.append(Scale(name, label or name, several, words(several, unit or "")))
    count = math.prod(len(scale.values) for scale in scales)
    if count > MOST_FRAMES:
        raise ValueError(
            f"{', '.join(values)} make {count:,} frames, of which at most {MOST_FRAMES} are drawn: give fewer values"
        )
    return scales


def checked_values(name: str, given: Values) -> tuple[float | int | str, ...]:
    """The values of a slider: numbers or texts, each once."""
    if isinstance(given, set | frozenset):
        raise ValueError(f"{name} must be a list of numbers or texts, got {type(given).__name__}, which has no order")
    several = [
        value.item() if isinstance(value, np.generic) else value
        for value in checks.listed(name, given, "numbers or texts")
    ]
    for value in several:
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            raise ValueError(f"{name} must hold numbers or texts, got {value!r:.60} in it")
        if not isinstance(value, str):
            checks.number(name, value, checks.finite)
    if len(set(several)) < len(several):
        raise ValueError(f"{name} must have each value once, got {max(several, key=several.count)!r:.60} again")
    if len(several) < 2:
        raise ValueError(
            f"{name} must have at least two values to step over, got {several!r:.60}: what never changes can be given "
            f"by functools.partial(draw, {name}=…)"
        )
    return tuple(several)


def words(values: Sequence[float | int | str], unit: str) -> tuple[str, ...]:
    """Values as they are shown, numbers with as few digits as tell them apart: "3 m/s", "30°", "A*"."""
    numbers = [value for value in values if not isinstance(value, str)]
    apart = (n for n in range(4, 18) if len({number_word(value, n) for value in numbers}) == len(numbers))
    digits, unit = next(apart, 17), unit if unit in ("", "°") else f" {unit}"
    return tuple(value if isinstance(value, str) else number_word(value, digits) + unit for value in values)


def number_word(value: float, digits: int) -> str:
    """A number as it is, if that is short, else rounded."""
    exact = f"{value:.15g}"
    rounded = exact if len(exact) <= 8 or value == round(value) else f"{float(f'{value:.{digits}g}'):.15g}"
    return rounded.replace("-", "−")


def positions(scales: Sequence[Scale], start: Mapping[str, Any]) -> list[int]:
    """Number of the value that each slider has first."""
    refuse_strangers("start", start, [scale.name for scale in scales])
    at = []
    for scale in scales:
        wanted = start.get(scale.name, scale.values[0])
        if isinstance(wanted, int | float | np.number):
            checks.number(f"start[{scale.name!r}]", wanted, checks.finite)
        found = [i for i, value in enumerate(scale.values) if is_same(value, wanted)]
        if not found:
            known = ", ".join(map(repr, scale.values))
            raise ValueError(f"start[{scale.name!r}] must be one of {known:.300}, got {wanted!r:.60}")
        at.append(found[0])
    return at


def is_same(value: float | int | str, wanted: Any) -> bool:
    """Whether a value is the one asked for, but for what is lost in sums such as 0.1 + 0.2."""
    if isinstance(value, str) or isinstance(wanted, bool) or not isinstance(wanted, int | float | np.number):
        return type(value) is str and isinstance(wanted, str) and value == wanted
    return bool(value == wanted) or math.isclose(value, wanted, rel_tol=1e-9)


def refuse_strangers(argument: str, given: Mapping[str, Any], names: Any) -> None:
    """Refuse names that no slider has."""
    for name in given:
        if name not in names:
            raise ValueError(f"{argument} names {name!r:.60}, which is no slider: {', '.join(names)}")


def refuse_generators(draw: Callable[..., Figure]) -> None:
    """Refuse a function that draws from a generator outside: its frames would depend on who is drawn before."""
    used = inspect.getclosurevars(draw) if inspect.isfunction(draw) else None
    outside = {**used.globals, **used.nonlocals} if used else getattr(draw, "keywords", {})
    for name, value in outside.items():
        if isinstance(value, np.random.Generator):
            raise ValueError(
                f"draw uses {name}, a random generator, so that frames would depend on which are drawn before: make "
                "it in draw, from a seed"
            )


class FailedError(Exception):
    """In another process a frame couldn't be drawn; which one, its argument says."""


def all_drawn(
    draw: Callable[..., Figure], cases: list[dict[str, Any]], first: int, jobs: int | None, progress: bool
) -> list[bytes]:
    """A PNG for each case; the first is drawn here, and the others where it is sooner done."""
    began = time.perf_counter()
    picture = drawn(draw, cases[first])
    if (time.perf_counter() - began) * len(cases) < QUICK:
        jobs = 1
    settings: Any = {name: value for name, value in dict.items(matplotlib.rcParams) if "backend" not in name}
    others = [
        {"draw": draw, "cases": cases, "number": number, "settings": settings}
        for number in range(len(cases))
        if number != first
    ]
    failed = None
    try:
        pictures = sweep(drawn_elsewhere, others, jobs=jobs, on_error="raise", progress=progress, unit="frame")
    except UnpicklableError:  # what can't travel to other processes, such as an open file, can be drawn here
        pictures = sweep(drawn_elsewhere, others, jobs=1, on_error="raise", progress=progress, unit="frame")
    except FailedError as error:
        failed = error
    if failed is not None:
        drawn(draw, cases[failed.args[0]])  # again, so that its exception comes whole, with the lines where it rose
        raise failed
    return [*pictures[:first], picture, *pictures[first:]]


def drawn_elsewhere(draw: Callable[..., Figure], cases: list[dict[str, Any]], number: int, settings: Any) -> bytes:
    """A frame, with matplotlib's settings as they are where it was asked for."""
    try:
        with matplotlib.rc_context(settings):
            return drawn(draw, cases[number])
    except ValueError as error:
        raise FailedError(number) from error


def drawn(draw: Callable[..., Figure], case: dict[str, Any]) -> bytes:
    """A PNG of what a function draws; nothing stays open in pyplot that wasn't."""
    where = ", ".join(f"{name}={value!r:.60}" for name, value in case.items())
    before, written = set(plt.get_fignums()), io.BytesIO()
    try:
        with matplotlib.rc_context():
            figure = draw(**case)
            matplotlib.rcParams["savefig.bbox"] = "standard"  # cut to what is drawn, frames would differ in size
            if isinstance(figure, Figure):
                figure.savefig(written, format="png", dpi=DPI, pil_kwargs={"compress_level": 1})
    except Exception as error:
        raise ValueError(f"draw failed at {where}: {type(error).__name__}: {error}") from error
    finally:
        for number in set(plt.get_fignums()) - before:
            plt.close(number)
    if not isinstance(figure, Figure):
        raise ValueError(
            f"draw must return a Figure of matplotlib, as all functions of uavlab.plot do, got {type(figure).__name__} "
            f"at {where}"
        )
    return written.getvalue()


def same_size(pictures: list[bytes], cases: Sequence[dict[str, Any]]) -> list[bytes]:
    """The pictures, if all are of one size."""
    sizes = [Image.open(io.BytesIO(picture)).size for picture in pictures]
    for size, case in zip(sizes, cases, strict=True):
        if size != sizes[0]:
            at = [", ".join(f"{name}={value!r:.60}" for name, value in one.items()) for one in (cases[0], case)]
            raise ValueError(
                "draw must give figures of one size, got {} × {} pixels at {} and {} × {} at {}".format(
                    *sizes[0], at[0], *size, at[1]
                )
            )
    return pictures


def refuse_large(content: str, pictures: Pictures, scales: Sequence[Scale]) -> None:
    """Refuse a fragment above the limit, and say how many frames would fit."""
    size = len(content.encode())
    if size <= MOST_BYTES:
        return
    frames = sum(-(-len(picture) // 3) * 4 for _, _, picture in pictures.overlays)
    room, count = MOST_BYTES - (size - frames), len(pictures.order)
    fit = max(0, int(room / frames * count))
    names = ", ".join(scale.name for scale in scales)
    raise ValueError(
        f"{names} make {count} frames of {size / 1000:.0f} kB, of which about {fit} fit into {MOST_BYTES / 1000:.0f} "
        "kB: give fewer values, or draw a smaller figure"
    )
