"""Figures with sliders: the frames, how they are kept, what the fragment says, and what is refused."""

import base64
import importlib
import io
import json
import re
import threading
from functools import partial
from html.parser import HTMLParser
from itertools import product

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from uavlab import plot
from uavlab.plot import fragment, palette

module = importlib.import_module("uavlab.plot.sliders")
"""Behind the function of the same name."""


def bar(wind=1.0, load=0.0, color="tab:blue"):
    """A figure of 200 × 100 pixels."""
    figure, axes = plot.new_figure(2.0, 1.0)
    axes.barh([0], [float(wind)], color=color)
    axes.barh([1], [float(load)], color="black")
    axes.set(xlim=(0, 10), ylim=(-1, 2))
    axes.set_axis_off()
    return plot.finished(figure)


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


def drawn(figure):
    """What a figure looks like before colours are brought together."""
    picture = io.BytesIO()
    figure.savefig(picture, dpi=100)
    return pixels(picture.getvalue()).astype(int)


def data_of(shown):
    return json.loads(re.search(r'<script type="application/json">(.*?)</script>', shown.html, re.DOTALL)[1])


def sliders(draw=bar, **more):
    more = more if {"wind", "a"} & more.keys() else {"wind": [0, 3, 6, 9], **more}
    return plot.sliders(draw, **{"progress": False, **more})


class Elements(HTMLParser):
    """The elements of a piece of HTML, each with its attributes, and those that weren't closed."""

    def __init__(self, text):
        super().__init__()
        self.found, self.inside = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))
        if tag not in ("img", "input"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        assert self.inside.pop() == tag

    def all(self, tag):
        return [attributes for name, attributes in self.found if name == tag]


def test_each_frame_looks_like_its_figure():
    winds, loads = [0, 3, 6], [0.5, 9.0]
    shown = sliders(wind=winds, load=loads)
    assert len(shown.frames) == 6
    for frame, (wind, load) in zip(shown.frames, product(winds, loads), strict=True):
        apart = np.abs(pixels(frame).astype(int) - drawn(bar(wind, load)))
        assert apart.max() == 0  # so few colours that all are kept


def test_overlays_on_the_base_are_the_frames_to_the_pixel():
    shown = sliders(wind=range(0, 10, 2), load=[0.0, 5.0, 10.0])
    data = data_of(shown)
    for frame, number in zip(shown.frames, data["order"], strict=True):
        left, top, overlay = data["overlays"][number]
        page = Image.open(io.BytesIO(base64.b64decode(data["base"]))).convert("RGBA")
        page.alpha_composite(Image.open(io.BytesIO(base64.b64decode(overlay))).convert("RGBA"), (left, top))
        assert np.array_equal(np.asarray(page)[..., :3], pixels(frame))


def test_frames_that_look_the_same_are_kept_once():
    shown = sliders(lambda wind: bar(min(wind, 3)), wind=[0, 3, 6, 9])
    assert data_of(shown)["order"][1:] == [data_of(shown)["order"][1]] * 3
    assert len(data_of(shown)["overlays"]) == 2
    assert shown.frames[1] == shown.frames[2] != shown.frames[0]


def test_what_all_frames_share_is_kept_once():
    def framed(wind):
        figure = bar(wind)
        figure.text(0.1, 0.8, "a long text that stays")
        return figure

    for left, top, overlay in data_of(sliders(framed))["overlays"]:
        width, height = Image.open(io.BytesIO(base64.b64decode(overlay))).size
        assert left + width <= 200
        assert top + height <= 100
        assert height < 60


def test_photos_keep_their_commonest_colours_and_no_colour_is_far_away():
    rng = np.random.default_rng(0)

    def photo(a):
        figure = plt.figure(figsize=(2, 2))
        figure.figimage(photos[a])
        figure.patches.append(plt.Rectangle((0, 0), 1, 0.3, transform=figure.transFigure, color="#D55E00"))
        return figure

    ramp = np.linspace(0, 1, 200)
    photos = [np.stack([*np.meshgrid(ramp, ramp), np.full((200, 200), blue)], axis=-1) for blue in rng.random(2)]
    shown = sliders(photo, a=[0, 1])
    for frame, a in zip(shown.frames, (0, 1), strict=True):
        true, kept = drawn(photo(a)), pixels(frame).astype(int)
        exact = (true == (0xD5, 0x5E, 0x00)).all(axis=-1)
        assert exact.mean() > 0.25
        assert np.array_equal(kept[exact], true[exact])
        assert np.sqrt(((kept - true) ** 2).sum(axis=-1).mean()) < 18
    assert len(np.unique(np.concatenate([pixels(frame).reshape(-1, 3) for frame in shown.frames]), axis=0)) > 100
    plt.close("all")


def test_what_can_be_seen_through_is_seen_on_white():
    def clear(a):
        figure = bar(a)
        figure.patch.set_facecolor((1.0, 0.0, 0.0, 0.0 if a == 1 else 0.5))
        return figure

    frames = [pixels(frame) for frame in sliders(clear, a=[1, 2]).frames]
    assert frames[0][0, 0].tolist() == [255, 255, 255]
    assert frames[1][0, 0].tolist() == pytest.approx([255, 128, 128], abs=1)


@pytest.mark.parametrize("jobs", [1, 2, None])
def test_the_bytes_do_not_depend_on_where_frames_are_drawn(monkeypatch, jobs):
    def local(wind, load):
        return bar(wind, load)

    case = {"wind": [0, 3, 6], "load": [1, 2], "start": {"wind": 6}}
    alone = sliders(local, jobs=1, **case)
    monkeypatch.setattr(module, "QUICK", 0.0)
    elsewhere = sliders(local, jobs=jobs, **case)
    assert elsewhere.html == alone.html
    assert elsewhere.frames == alone.frames


def processes_of(monkeypatch, quick, jobs=2, draw=bar):
    asked = []
    monkeypatch.setattr(module, "QUICK", quick)
    monkeypatch.setattr(module, "sweep", lambda function, cases, *, jobs, **more: asked.append(jobs) or ordered(cases))

    def ordered(cases):
        return [module.drawn_elsewhere(**case) for case in cases]

    sliders(draw, jobs=jobs)
    return asked


def test_other_processes_are_begun_only_where_it_pays(monkeypatch):
    assert processes_of(monkeypatch, quick=1e9) == [1]
    assert processes_of(monkeypatch, quick=0.0) == [2]
    assert processes_of(monkeypatch, quick=0.0, jobs=1) == [1]
    assert processes_of(monkeypatch, quick=0.0, jobs=-1) == [-1]


def test_settings_of_matplotlib_go_along(monkeypatch):
    def plain(a):
        figure = Figure((2, 1))
        figure.subplots().plot([0, a])
        return figure

    monkeypatch.setattr(module, "QUICK", 0.0)
    usual = sliders(plain, a=[1, 2])
    with matplotlib.rc_context({"axes.facecolor": "yellow", "savefig.bbox": "tight"}):
        here, there = (sliders(plain, a=[1, 2], jobs=jobs) for jobs in (1, 2))
    assert here.html == there.html != usual.html
    assert pixels(here.still).shape == (100, 200, 3)  # not cut to what is drawn


def test_what_draw_sets_ends_with_the_frame():
    def styled(a):
        if a == 1:
            matplotlib.rcParams["axes.facecolor"] = "yellow"
        return bar(a)

    before = matplotlib.rcParams["axes.facecolor"]
    shown = sliders(styled, a=[1, 2])
    assert matplotlib.rcParams["axes.facecolor"] == before
    assert np.array_equal(pixels(shown.frames[1]), drawn(bar(2)))


def test_what_can_not_travel_is_drawn_here(monkeypatch):
    lock = threading.Lock()
    monkeypatch.setattr(module, "QUICK", 0.0)
    shown = sliders(lambda wind: bar(wind if lock else 0), jobs=2)
    assert shown.html == sliders().html


def test_figures_of_pyplot_are_closed_and_others_stay_open():
    def pyplot(a):
        plt.figure(figsize=(2, 1))
        plt.plot([0, a])
        return plt.gcf()

    before, kept = plt.get_fignums(), plt.figure()
    sliders(pyplot, a=[1, 2])
    with pytest.raises(ValueError, match="draw failed"):
        sliders(lambda a: pyplot(a) / 2, a=[1, 2])
    assert plt.get_fignums() == [*before, kept.number]
    plt.close(kept)


def test_a_bar_counts_the_frames(capsys):
    sliders(progress=True)
    shown = capsys.readouterr()
    assert "3/3" in shown.err
    assert "frame" in shown.err
    sliders(progress=False)
    assert capsys.readouterr().err == ""


def test_a_notebook_gets_a_fragment_a_still_and_an_alternative_text():
    shown = sliders(wind=[0, 3], load=[0, 9], start={"load": 9}, title="force", labels={"wind": "wind speed [m/s]"})
    data, about = shown._repr_mimebundle_(include=None, exclude=None)
    assert set(data) == {"text/html", "image/png", "text/plain"}
    assert data["text/html"] == shown.html
    assert base64.b64decode(data["image/png"]) == shown.still == shown.frames[1]
    assert data["text/plain"] == repr(shown) == f"<Sliders: wind, load, 4 frames, {len(shown.html) / 1000:.0f} kB>"
    assert about == {"image/png": {"alt": "force: wind speed 0 m/s, load 9"}}
    assert np.array_equal(pixels(shown.still), drawn(bar(0, 9)))


def test_the_fragment_has_native_inputs_with_labels_and_values():
    shown = sliders(wind=[0, 3, 6], load=[0.5, 1], start={"wind": 3}, labels={"wind": "wind [m/s]"}, title="force")
    elements = Elements(shown.html)
    assert elements.inside == []
    assert elements.found[0][0] == "div"
    assert elements.found[0][1]["class"] == "uavlab-sliders"
    assert elements.found[0][1]["aria-label"] == "force"
    wind, load = elements.all("input")
    assert (wind["type"], wind["min"], wind["max"], wind["step"], wind["value"]) == ("range", "0", "2", "1", "1")
    assert (load["max"], load["value"]) == ("1", "0")
    assert [wind["aria-valuetext"], load["aria-valuetext"]] == ["3 m/s", "0.5"]
    assert re.findall(r"<label><span>(.*?)</span><input[^>]*></label><output[^>]*>(.*?)</output>", shown.html) == [
        ("wind", "3 m/s"),
        ("load", "0.5"),
    ]
    (image,) = elements.all("img")
    assert (image["width"], image["height"], image["alt"]) == ("200", "100", shown.alt)
    assert base64.b64decode(image["src"].removeprefix("data:image/png;base64,")) == shown.still
    assert "id" not in {name for _, attributes in elements.found for name in attributes}  # there may be two on a page
    assert not re.search(r"https?:|url\(|@import", shown.html)


def test_the_order_of_frames_is_that_of_the_sliders():
    shown = sliders(wind=[0, 3, 6], load=[1, 2])
    data = data_of(shown)
    assert [scale["words"] for scale in data["scales"]] == [["0", "3", "6"], ["1", "2"]]
    assert len(data["order"]) == 6
    assert len(set(data["order"])) == 6


def test_names_with_markup_stay_text():
    evil = '</script><b onclick="x">&'
    shown = sliders(lambda a: bar(len(a)), a=[evil, "A*"], title=evil, labels={"a": evil})
    elements = Elements(shown.html)
    assert elements.inside == []
    assert "b" not in {tag for tag, _ in elements.found}
    assert elements.all("input")[0]["aria-valuetext"] == evil
    assert data_of(shown)["scales"] == [{"label": evil, "words": [evil, "A*"]}]
    assert elements.all("img")[0]["alt"] == f"{evil}: {evil} {evil}"


@pytest.mark.parametrize(
    ("values", "unit", "said"),
    [
        ([0, 3, 6], "m/s", ("0 m/s", "3 m/s", "6 m/s")),
        ([0.0, 0.5, 1.0], "", ("0", "0.5", "1")),
        (np.linspace(0, 1, 11)[[1, 3]].tolist(), "kg", ("0.1 kg", "0.3 kg")),
        ((10 ** np.array([0.25, 3, 6])).tolist(), "", ("1.778", "1000", "1000000")),
        ([-5, 30], "°", ("−5°", "30°")),
        ([1e-5, 2.5e-5], "", ("1e−05", "2.5e−05")),
        ([1.2345678901, 1.2345678902], "", ("1.2345678901", "1.2345678902")),
        ([1234.5, 1200.25], "m", ("1234.5 m", "1200.25 m")),
        (["A*", "REPARE"], "m", ("A*", "REPARE")),
    ],
)
def test_values_are_shown_with_the_digits_that_they_need(values, unit, said):
    assert module.words(values, unit) == said


@pytest.mark.parametrize(
    ("label", "parts"),
    [
        ("wind [m/s]", ("wind", "2 m/s")),
        ("  wind from [west] [m/s] ", ("wind from [west]", "2 m/s")),
        ("wind", ("wind", "2")),
        ("[m]", ("bank_deg", "2 m")),
        ("", ("bank_deg", "2")),
        (None, ("bank deg", "2")),
    ],
)
def test_a_label_says_name_and_unit(label, parts):
    (scale,) = module.checked_scales({"bank_deg": [2, 3]}, {} if label is None else {"bank_deg": label})
    assert (scale.label, scale.words[0]) == parts


def test_draw_gets_plain_numbers_and_texts():
    got = []

    def seen(**case):
        got.append(case)
        return bar()

    sliders(seen, a=np.array([1, 2]), b=np.array([0.5, 1.0], dtype=np.float32), c=np.array(["x", "y"]))
    assert {type(value) for case in got for value in case.values()} == {int, float, str}
    assert {tuple(case.values()) for case in got} == set(product([1, 2], [0.5, 1.0], ["x", "y"]))
    assert len(got) == 8  # each once


def test_a_value_to_start_with_may_come_from_a_sum():
    values = np.arange(0, 1, 0.1)  # 0.30000000000000004
    assert sliders(lambda a: bar(a * 10), a=values, start={"a": 0.3}).alt == "figure: a 0.3"
    assert sliders(lambda a: bar(a * 10), a=values, start={"a": np.float64(0)}).alt == "figure: a 0"


def test_the_base_is_what_most_frames_have_in_common():
    frames = np.array([[[1, 2, 3]], [[1, 5, 4]], [[7, 5, 4]], [[1, 5, 9]]], dtype=np.uint8)
    assert palette.commonest(frames).tolist() == [[1, 5, 4]]


def test_a_difference_is_cut_to_what_changed():
    base = np.zeros((5, 7), dtype=np.uint8)
    frame = base.copy()
    frame[1, 2], frame[3, 4] = 8, 9
    left, top, piece = palette.difference(frame, base)
    assert (left, top, piece.shape) == (2, 1, (3, 3))
    assert piece[0, 0] == 8
    assert piece[2, 2] == 9
    assert (piece == palette.TRANSPARENT).sum() == 7
    assert palette.difference(base, base)[2].tolist() == [[palette.TRANSPARENT]]


def test_a_png_holds_only_the_colours_that_it_needs():
    colors = np.arange(90, dtype=np.uint8).reshape(30, 3)
    for numbers in ([[3, 7], [7, 29]], [[3, 255], [7, 29]], [[255, 255]]):
        picture = Image.open(io.BytesIO(palette.png(np.array(numbers, dtype=np.uint8), colors)))
        rgba = np.asarray(picture.convert("RGBA"))
        for row, line in zip(numbers, rgba, strict=True):
            for number, pixel in zip(row, line, strict=True):
                assert pixel[3] == (0 if number == 255 else 255)
                assert number == 255 or (pixel[:3] == colors[number]).all()
        assert len(picture.palette.colors) <= 4


def test_the_script_and_python_say_the_same_of_a_picture():
    scale = fragment.Scale("a", "wind", (1, 2), ("1 m/s", "2 m/s"))
    assert fragment.alternative("force", [scale, scale], [1, 0]) == "force: wind 2 m/s, wind 1 m/s"


def noisy(wind, seed=1):
    figure = plt.figure(figsize=(5, 4))
    figure.figimage(np.random.default_rng(wind).random((400, 500)))
    return figure


def test_too_many_bytes_are_refused_with_how_many_frames_fit():
    with pytest.raises(
        ValueError, match=r"wind make 6 frames of \d+ kB, of which about (\d) fit into 500 kB: give f"
    ) as no:
        sliders(noisy, wind=range(6))
    fit = int(re.search(r"about (\d)", str(no.value))[1])
    assert 0 <= fit < 6
    if fit >= 2:
        sliders(noisy, wind=range(fit))


def test_how_many_fit_is_about_right(monkeypatch):
    monkeypatch.setattr(module, "MOST_BYTES", 100_000)
    winds = np.linspace(0, 10, 60)
    with pytest.raises(ValueError, match="of which about") as no:
        sliders(chart, wind=winds)
    fit = int(re.search(r"about (\d+)", str(no.value))[1])
    assert 5 < fit < 60
    assert len(sliders(chart, wind=winds[: int(0.8 * fit)]).html) <= 100_000
    with pytest.raises(ValueError, match="of which about"):
        sliders(chart, wind=winds[: int(1.5 * fit)])


def chart(wind):
    figure, axes = plot.new_figure(3.0, 2.0)
    x = np.linspace(0, 6, 200)
    axes.plot(x, np.sin(x * (1 + wind / 4)))
    return plot.finished(figure)


MANY = range(21)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"wind": [3]}, r"wind must have at least two values to step over, got \[3\]: .*partial\(draw, wind=…\)"),
        ({"wind": []}, "wind must have at least two values"),
        ({"wind": 3}, "wind must be a list of numbers or texts, got int"),
        ({"wind": "A*"}, "wind must be a list of numbers or texts, got str"),
        ({"wind": {1: 2}}, "wind must be a list of numbers or texts, got dict"),
        ({"wind": {1, 2}}, "wind must be a list of numbers or texts, got set, which has no order"),
        ({"wind": [1, 2, 2.0]}, "wind must have each value once, got 2 again"),
        ({"wind": ["A*", "A*"]}, r"wind must have each value once, got 'A\*' again"),
        ({"wind": [1, np.nan]}, "wind must be finite, got nan"),
        ({"wind": [1, np.inf]}, "wind must be finite, got inf"),
        ({"wind": [1, None]}, "wind must hold numbers or texts, got None in it"),
        ({"wind": [False, True]}, "wind must hold numbers or texts, got False in it"),
        ({"wind": [[1, 2], [3, 4]]}, r"wind must hold numbers or texts, got \[1, 2\] in it"),
        ({"wind": MANY, "load": MANY}, "wind, load make 441 frames, of which at most 400 are drawn: give fewer values"),
        ({"labels": {"wnd": "wind"}}, "labels names 'wnd', which is no slider: wind"),
        ({"labels": {"wind": 3}}, r"labels\['wind'\] must be a str"),
        ({"labels": "wind"}, "labels must be str by name"),
        ({"start": {"load": 3}}, "start names 'load', which is no slider: wind"),
        ({"start": {"wind": 4}}, r"start\['wind'\] must be one of 0, 3, 6, 9, got 4"),
        ({"start": {"wind": 10**400}}, r"start\['wind'\] must be a number"),
        ({"start": {"wind": "3"}}, r"start\['wind'\] must be one of"),
        ({"start": {"wind": False}}, r"start\['wind'\] must be one of"),
        ({"start": [3]}, "start must be something by name"),
        ({"title": 3}, "title must be text"),
        ({"jobs": 0}, "jobs must be a number of processes"),
        ({"jobs": True}, "jobs must be a number of processes"),
        ({"progress": "no"}, "progress must be True or False"),
        ({"draw": "bar"}, r"draw must be a function, called as draw\(wind=…\), got 'bar'"),
        ({"draw": Figure}, "draw must be a function"),
    ],
)
def test_mistakes_are_named_before_anything_is_drawn(asked, message):
    drawn_ones = []
    with pytest.raises(ValueError, match=message):
        sliders(**{"draw": lambda **case: drawn_ones.append(case), **asked})
    assert drawn_ones == []


def test_no_slider_and_too_many():
    with pytest.raises(ValueError, match=r"values must make 1 to 4 sliders, as in sliders.* got 0"):
        plot.sliders(bar)
    with pytest.raises(ValueError, match=r"values must make 1 to 4 sliders, .* got 5"):
        plot.sliders(bar, **{name: [1, 2] for name in "abcde"})


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_draw_that_fails_is_named_with_its_values_and_its_cause(monkeypatch, jobs):
    monkeypatch.setattr(module, "QUICK", 0.0)

    def fails(wind, load):
        if (wind, load) == (6, 0.5):
            raise KeyError("nothing there")
        return bar(wind)

    with pytest.raises(ValueError, match=r"draw failed at wind=6, load=0\.5: KeyError: 'nothing there'") as no:
        sliders(fails, wind=[3, 6], load=[0.0, 0.5], jobs=jobs)
    assert isinstance(no.value.__cause__, KeyError)
    assert no.value.__cause__.__traceback__.tb_next.tb_frame.f_code.co_name == "fails"


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda wind: None, "draw must return a Figure of matplotlib, .* got NoneType at wind=0"),
        (lambda wind: bar(wind).axes[0], "draw must return a Figure of matplotlib, .* got Axes at wind=0"),
        (lambda speed: bar(speed), "draw failed at wind=0: TypeError: .*unexpected keyword argument 'wind'"),
        (
            lambda wind: plot.new_figure(2 + wind / 3, 1)[0],
            "draw must give figures of one size, got 200 × 100 pixels at wind=0 and 300 × 100 at wind=3",
        ),
    ],
)
def test_a_draw_that_gives_no_frames_is_named(draw, message):
    with pytest.raises(ValueError, match=message):
        sliders(draw)
    plt.close("all")


def test_a_generator_from_outside_is_refused():
    """Else a frame would depend on how many were drawn before it in the same process."""
    rng = np.random.default_rng(1)
    with pytest.raises(ValueError, match="draw uses rng, a random generator"):
        sliders(lambda wind: bar(wind + rng.random()))
    with pytest.raises(ValueError, match="draw uses color, a random generator"):
        sliders(partial(bar, color=rng))
    sliders(lambda wind: bar(wind + np.random.default_rng(1).random()))
