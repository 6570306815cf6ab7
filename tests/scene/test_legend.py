"""Legends: each sign in the colour and with the dashes of its thing, names as text, ticks where they belong."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.colors import LogNorm, to_hex

from uavlab import plot, scene
from uavlab.city import City, NoFlyZone
from uavlab.flight import OffsetProcess, fly
from uavlab.plot.colors import LINES
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route
from uavlab.scene.content import drawing_of
from uavlab.scene.legend import legend, risk_bar, words_of
from uavlab.scene.shapes import DASHES
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind

HOSTILE = "</title><script>alert('1')</script>\"<b>&amp;$\\foo$"
WAY = [(5.0, 5, 5), (40, 40, 20)]


class Reader(HTMLParser):
    """Tags, with their attributes, and the text between them."""

    def __init__(self, page):
        super().__init__(convert_charrefs=True)
        self.tags, self.text = [], []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_data(self, data):
        self.text.append(data)


def city_of(name, zone=None):
    zones = () if zone is None else (NoFlyZone([(50, 50), (60, 50), (60, 60)], name=zone),)
    return City(np.zeros((20, 20, 6), dtype=bool), 5.0, name=name, no_fly=zones)


def test_names_with_markup_are_text_everywhere():
    """City, zone, route, reason, flight, title: the page has the same tags as one with harmless names."""
    pages, bundles = [], []
    for name in (HOSTILE, "harmless"):
        city = city_of(name, name)
        route = Route(WAY, name, reached=False, reason=name)
        flight = fly(Route(WAY, name), city, LIGHT_QUADROTOR, OffsetProcess(0.1), rng=1)
        pages.append(scene.page(city, route, flights={name: flight}, title=name))
        bundles.append(scene.show(city, route, flights={name: flight}))
    hostile, harmless = map(Reader, pages)
    assert [tag for tag, _ in hostile.tags] == [tag for tag, _ in harmless.tags]
    assert [set(attributes) for _, attributes in hostile.tags] == [set(attributes) for _, attributes in harmless.tags]
    assert "alert('1')<" not in pages[0]
    shown = [text for text in hostile.text if text.startswith((HOSTILE, "no-fly zone: "))]
    assert shown == [
        HOSTILE, HOSTILE, f"{HOSTILE}: doesn't arrive, {HOSTILE}", f"{HOSTILE}: arrived after {flight.duration:.1f} s",
        f"no-fly zone: {HOSTILE}",
    ]  # fmt: skip
    (pane,) = [attributes for _, attributes in hostile.tags if attributes.get("id") == "pane"]
    assert HOSTILE in pane["aria-label"]
    frame = Reader(bundles[0]._repr_mimebundle_()[0]["text/html"]).tags
    assert [tag for tag, _ in frame] == ["div", "iframe"]
    assert [tag for tag, _ in Reader(frame[1][1]["srcdoc"]).tags] == [tag for tag, _ in Reader(bundles[0].page).tags]
    assert bundles[0].still.startswith(b"\x89PNG")


def signs_of(drawing):
    """Colour and drawn elements of each line of the legend, by its text."""
    lines = re.findall(r"<li><svg[^>]*color:([^\"]+)\"[^>]*>(.*?)</svg><span>(.*?)</span></li>", legend(drawing))
    return {text: (color, drawn) for color, drawn, text in lines}


def test_lines_have_their_colour_and_dashes():
    ways = {f"way {number}": Route(WAY) for number in range(7)}
    drawing = drawing_of(city_of("town"), (ways,))
    signs = signs_of(drawing)
    for entry in drawing.legend[:7]:
        color, drawn = signs[entry.text]
        assert color == entry.color
        line = LINES[color]
        pattern = DASHES[line] if isinstance(line, str) else line[1]
        found = re.search(r'stroke-dasharray="([^"]+)"', drawn)
        if pattern:
            lengths = np.array([float(part) for part in found[1].split()])
            assert lengths / lengths[0] == pytest.approx(np.array(pattern) / pattern[0], rel=1e-3)
        else:
            assert found is None
    assert {text for text in signs if not text.startswith("way")} == {"start", "goal"}


def test_each_sign_is_another():
    city = city_of("town", "school")
    lost = Route(WAY, reached=False, reason="stuck", info={"goal": (90.0, 90, 5)})
    flight = fly(Route(WAY, "A*"), city, LIGHT_QUADROTOR, OffsetProcess(0.1), rng=1)
    drawing = drawing_of(city, (lost,), flights=[flight], wind=Wind((1.0, 0.0)), safe_distance=2.0)
    signs = signs_of(drawing)
    drawn = [sign for _, sign in signs.values()]
    assert len(set(drawn)) == len(drawn) == len(drawing.legend) == 9
    assert signs["distance to keep, 2 m"][0] == plot.styles(["", "flight 1"])[1].color


def ticks_of(page):
    """Share and power of each tick."""
    found = re.findall(r'left:([\d.]+)%">10<sup>(-?\d+)</sup>', page)
    return {int(power): float(share) / 100 for share, power in found}


@pytest.mark.parametrize(("low", "high"), [(1e-7, 1e-3), (3e-6, 2e-4), (1e-5, 1e-4), (2e-5, 9e-5)])
def test_ticks_of_risk_are_powers_of_ten_at_their_share(low, high):
    page = risk_bar(LogNorm(low, high))
    ticks = ticks_of(page)
    expected = [power for power in range(-12, 3) if low * (1 - 1e-6) <= 10.0**power <= high * (1 + 1e-6)]
    assert sorted(ticks) == expected
    for power, share in ticks.items():
        assert share == pytest.approx(np.log(10.0**power / low) / np.log(high / low), abs=6e-4)
    assert f"from {low:.1e} to {high:.1e}" in page


@pytest.mark.parametrize(("low", "high", "step"), [(1e-9, 1.0, 2), (5e-16, 2e-6, 2), (1e-6, 1.0, 2), (1e-20, 1e-4, 3)])
def test_where_powers_are_many_ticks_are_few(low, high, step):
    powers = sorted(ticks_of(risk_bar(LogNorm(low, high))))
    assert len(powers) <= 6
    assert set(np.diff(powers)) == {step}


def test_the_bar_has_the_colours_that_the_ground_has():
    campus = reference_campus()
    page = scene.page(campus.city, risk=campus)
    stops = re.search(r"linear-gradient\(90deg,([^)]*)\)", page)[1].split(",")
    for share, color in zip(np.linspace(0, 1, len(stops)), stops, strict=True):
        assert color == to_hex(plot.SEQUENTIAL(share))
    assert 1 <= len(ticks_of(page)) <= 8
    assert f"<figcaption>{plot.RISK_LABEL}, from " in page
    assert "logarithmic scale</figcaption>" in page


def test_risk_of_nobody_and_of_one_decade_have_a_scale():
    city = city_of("desert")
    for rate in (0.0, 1e-3):
        page = scene.page(city, risk=RiskMap(city, rate, 0.5))
        ticks = ticks_of(page)
        assert 1 <= len(ticks) <= 2
        assert all(-1e-9 <= share <= 1 for share in ticks.values())
        assert "nan" not in legend(drawing_of(city, (), risk=RiskMap(city, rate, 0.5))).lower()


def test_expansions_have_a_bar_and_notes_are_sentences(table1, route):
    page = legend(drawing_of(table1, (route,), expansion=True))
    assert "<span>first</span><span>last</span>" in page
    assert "18,007 expanded nodes by their order" in page
    assert re.findall(r"<p>(.*?)</p>", page) == ["Squares of 10 m.", "9,004 of 18,007 expanded nodes are drawn."]


def test_words_say_what_is_to_be_seen(table1, crash_and_safe, hill):
    words = words_of(drawing_of(table1, (), flights=crash_and_safe, wind=Wind((3.0, 4.0))))
    assert words.startswith("Scene in 3D: the city of REPARE Table 1, 100 by 100 m on the ground, 99 m high. ")
    for part in ("A*: crashed after", "REPARE: arrived after", "wind 5 m/s"):
        assert part in words
    assert "No-fly zones: <school>, church" in words_of(drawing_of(hill, ()))
    campus = reference_campus()
    assert "the ground is coloured by" in words_of(drawing_of(campus.city, (), risk=campus)).lower()
