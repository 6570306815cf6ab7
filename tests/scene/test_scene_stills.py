"""Stills: size, legend, signs where things are, compass, scale, the moment."""

import io

import matplotlib.colors
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

from uavlab import plot, scene
from uavlab.city import City, NoFlyZone
from uavlab.plot.colors import CRASH_COLOR
from uavlab.plot.pictures import png_of
from uavlab.plot.style import DPI
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route
from uavlab.scene.camera import FIELD_OF_VIEW_DEG
from uavlab.scene.content import drawing_of
from uavlab.scene.stills import HEIGHT, WIDTH, view_of
from uavlab.weather import Wind

FLAT = City(np.zeros((20, 20, 4), dtype=bool), 5.0)
WAY = Route([(10.0, 10, 10), (80, 20, 10), (80, 90, 15)], "A*")
ASPECT = WIDTH / HEIGHT


def names_of(figure):
    return [text.get_text().replace("\u200b", "") for text in figure.legends[0].get_texts()]


def signs_of(figure, marker):
    """Places of signs in the picture, without their white borders."""
    lines = [line for line in figure.axes[0].lines if line.get_marker() == marker]
    return [line.get_xydata()[0] for line in lines if line.get_color() != "white"]


def pixels_of(drawing, camera, points, moment=0.0):
    """Column and row of points in a picture of 720 by 480, by a pinhole of one's own."""
    view = view_of(drawing, camera, moment, 2.0, ASPECT)
    forward = (view.target - view.eye) / np.linalg.norm(view.target - view.eye)
    right = np.cross(forward, view.up)
    focus = HEIGHT * DPI / 2 / np.tan(np.radians(FIELD_OF_VIEW_DEG / 2))
    away = np.atleast_2d(points) - drawing.center - view.eye
    depth = away @ forward
    return np.column_stack([WIDTH * DPI / 2 + focus * away @ right / depth,
                            HEIGHT * DPI / 2 - focus * away @ view.up / depth])  # fmt: skip


@pytest.mark.parametrize("camera", ["overview", "above", "side", (45.0, 25.0)])
def test_signs_are_where_things_are(camera):
    lost = Route(WAY.points[::-1], "lost", reached=False, reason="stuck", info={"goal": (5.0, 95, 3)})
    figure, drawing = scene.still(FLAT, WAY, lost, camera=camera), drawing_of(FLAT, (WAY, lost))
    ends = {"o": [WAY.points[0], WAY.points[-1]], "^": [WAY.points[-1], (5.0, 95, 3)], "s": [WAY.points[0]]}
    for marker, places in ends.items():
        found = signs_of(figure, marker)
        for place in pixels_of(drawing, camera, places):
            assert min(np.linalg.norm(place - one) for one in found) < 0.01
    assert names_of(figure) == [
        "A*: 140.9 m",
        "lost: doesn't arrive, stuck",
        "start",
        "goal",
        "stopped",
        "goal not reached",
    ]


def test_the_tube_is_drawn_in_the_route_s_colour():
    figure = scene.still(FLAT, WAY, camera="above", colors={"A*": "#FF0000"})
    picture = np.asarray(figure.axes[0].images[0].get_array())
    assert picture.shape == (480, 720, 3)
    drawing = drawing_of(FLAT, (WAY,))
    for share in (0.3, 0.6):
        place = WAY.points[0] + share * (WAY.points[1] - WAY.points[0])
        (column, row), = pixels_of(drawing, "above", place).astype(int)  # fmt: skip
        red, green, blue = picture[row, column]
        assert red > 0.5
        assert max(green, blue) < 0.2


def test_the_crash_is_there_from_its_moment_on(table1, crash_and_safe):
    crash = crash_and_safe["A*"]
    for moment, there in ((0.0, 0), (0.95 * crash.duration, 0), (crash.duration, 1), (None, 1)):
        figure = scene.still(table1, flights=crash_and_safe, start_at=moment)
        assert len(signs_of(figure, "x")) == there
        if there:
            drawing = drawing_of(table1, (), flights=crash_and_safe)
            place = pixels_of(drawing, "overview", crash.position[-1])[0]
            assert signs_of(figure, "x")[0] == pytest.approx(place, abs=0.01)
        assert "crash" in names_of(figure)
    (line,) = [line for line in figure.axes[0].lines if line.get_marker() == "x" and line.get_color() != "white"]
    assert line.get_color() == CRASH_COLOR


def test_small_uavs_have_a_ring_where_they_are(table1, crash_and_safe):
    drawing = drawing_of(table1, (), flights=crash_and_safe)
    for moment in (0.0, 2.0):
        figure = scene.still(table1, flights=crash_and_safe, start_at=moment)
        rings = [
            line
            for line in figure.axes[0].lines
            if line.get_markersize() == 13 and line.get_markeredgecolor() != "white"
        ]
        assert [ring.get_markeredgecolor() for ring in rings] == [plot.BLUE, plot.GREEN]
        for ring, mover in zip(rings, drawing.movers, strict=True):
            place = pixels_of(drawing, "overview", mover.at(moment)[0], moment)[0]
            assert ring.get_xydata()[0] == pytest.approx(place, abs=0.01)
    near = scene.still(table1, flights=crash_and_safe, camera="chase", start_at=1.0)
    assert len([line for line in near.axes[0].lines if line.get_markersize() == 13]) <= 2  # the followed one is large


@pytest.mark.parametrize("azimuth", [-150.0, -61.0, 0.0, 30.0, 135.0])
@pytest.mark.parametrize("elevation", [15.0, 50.0, 90.0])
def test_the_arrow_points_to_the_north_and_the_wind_s_along_it(azimuth, elevation):
    wind = Wind((3.0, -1.0))
    figure = scene.still(FLAT, WAY, wind=wind, camera=(azimuth, elevation))
    drawing = drawing_of(FLAT, (WAY,), wind=wind)
    view = view_of(drawing, (azimuth, elevation), 0.0, 2.0, ASPECT)
    target = view.target + drawing.center
    arrows = [text for text in figure.axes[0].texts if getattr(text, "arrow_patch", None) is not None]
    assert len(arrows) == 2
    for arrow, direction in zip(arrows, ([0, 1e-3, 0], [3e-3, -1e-3, 0]), strict=True):
        seen = np.subtract(*pixels_of(drawing, (azimuth, elevation), [target + direction, target]))
        drawn = np.array(arrow.xy) - np.array(arrow.xyann)
        assert drawn / np.linalg.norm(drawn) == pytest.approx(seen / np.linalg.norm(seen), abs=1e-3)
    (letter,) = [text for text in figure.axes[0].texts if text.get_text() == "N"]
    tip = np.array(arrows[0].xy)
    assert np.linalg.norm(np.array(letter.get_position()) - tip) < 15


def test_without_wind_there_is_one_arrow():
    figure = scene.still(FLAT)
    assert len([text for text in figure.axes[0].texts if getattr(text, "arrow_patch", None) is not None]) == 1


@pytest.mark.parametrize("size", [0.5, 5.0, 400.0])
def test_the_scale_is_true_at_the_target(size):
    city = City(np.zeros((20, 20, 4), dtype=bool), size)
    figure, drawing = scene.still(city), drawing_of(city, ())
    view = view_of(drawing, "overview", 0.0, 2.0, ASPECT)
    target = view.target + drawing.center
    right = np.cross(view.target - view.eye, view.up)
    right /= np.linalg.norm(right)
    (words,) = [text.get_text() for text in figure.axes[0].texts if text.get_text().endswith(" m")]
    length = float(words.removesuffix(" m"))
    assert f"{length:e}"[0] in "125"
    bar = next(line for line in figure.axes[0].lines if line.get_color() == "#222222")
    across = np.ptp(bar.get_xdata())
    seen = np.subtract(*pixels_of(drawing, "overview", [target + length * right, target]))
    assert across == pytest.approx(np.linalg.norm(seen), rel=1e-6)
    assert 50 < across <= 150


@pytest.mark.parametrize("count", [0, 1, 5])
def test_a_picture_has_its_size_in_pixels_and_a_palette(count):
    routes = [
        Route(WAY.points, f"a route of a long name, with more words than fit in half a line: {n}") for n in range(count)
    ]
    figure = scene.still(FLAT, *routes)
    picture = Image.open(io.BytesIO(png_of(figure, DPI)))
    width, height = picture.size
    assert width == WIDTH * DPI == 720
    assert height == round(figure.get_size_inches()[1] * DPI)
    assert height >= HEIGHT * DPI
    assert picture.mode == "P"
    assert len(picture.getcolors(256)) <= 256
    assert len(png_of(figure, DPI)) < 150_000
    figure.canvas.draw()
    if count:
        box = figure.legends[0].get_window_extent()
        assert box.x0 >= 0
        assert box.x1 <= width
        assert box.y0 >= 0
        seen = figure.axes[0].get_window_extent()
        assert box.y1 <= seen.y0 + 1  # below the picture
        assert seen.width > 0.85 * width


def test_palettes_keep_the_colours():
    figure = scene.still(FLAT, WAY, colors={"A*": "#FF0000"}, camera="above")
    picture = np.asarray(Image.open(io.BytesIO(png_of(figure, DPI))).convert("RGB"))
    red = (picture[..., 0] > 130) & (picture[..., 1:] < 60).all(axis=-1)
    assert red.sum() > 300


def test_the_legend_has_colour_and_dashes():
    ways = {f"way {n}": Route(WAY.points + n) for n in range(7)}
    figure = scene.still(FLAT, ways)
    looks = plot.styles(list(ways))
    for handle, look in zip(figure.legends[0].legend_handles[:7], looks, strict=True):
        assert to_rgb(handle.get_color()) == to_rgb(look.color)
        pattern = handle._dash_pattern[1]
        if isinstance(look.line, tuple):
            assert np.array(pattern) / pattern[0] == pytest.approx(np.array(look.line[1]) / look.line[1][0])
        else:
            assert handle.get_linestyle() == look.line


def test_risk_and_the_order_of_expansion_have_a_scale(table1, route):
    campus = reference_campus(cell=10.0)
    figure = scene.still(campus.city, risk=campus)
    bar = figure.axes[1]
    assert bar.get_xlabel() == f"{plot.RISK_LABEL}, logarithmic scale"
    norm = plot.risk_norm(campus)
    assert bar.get_xlim() == pytest.approx((norm.vmin, norm.vmax))
    figure = scene.still(table1, route, expansion=True)
    assert figure.axes[1].get_xlim() == pytest.approx((0, 18_007))
    assert "expanded" in figure.axes[1].get_xlabel()
    early, late = (np.asarray(scene.still(table1, route, expansion=True, start_at=moment).axes[0].images[0].get_array())
                   for moment in (0, 18_007))  # fmt: skip
    assert not np.array_equal(early, late)


def test_land_is_lighter_towards_the_sun(hill):
    bare = City(hill.occupied, hill.cell, hill.origin, hill.buildings, "bare", None, hill.ground)
    picture = np.asarray(scene.still(bare, camera="above").axes[0].images[0].get_array())
    land = picture[np.ptp(picture, axis=-1) < 0.1]
    assert np.ptp(land[:, 0]) > 0.15  # a slope in the light and one in the shade
    figure = scene.still(hill)
    assert names_of(figure) == ["no-fly zones: <school>, church"]
    painted = np.asarray(scene.still(bare, risk=RiskMap(bare, 1e-3, 0.5), camera="above").axes[0].images[0].get_array())
    assert np.ptp(matplotlib.colors.rgb_to_hsv(painted[240, 360:365])[:, 0]) < 0.02


@pytest.mark.parametrize("name", [r"$\foo$", "$x", "_x", "_$\\foo$_"])
def test_names_are_shown_as_they_are(name, crash_and_safe):
    zone = NoFlyZone([(50, 50), (60, 50), (60, 60)], name=name)
    city = City(FLAT.occupied, FLAT.cell, name=name, no_fly=(zone,))
    flight = crash_and_safe["REPARE"]
    figure = scene.still(city, Route(WAY.points, name), flights={name: flight})
    figure.canvas.draw()
    shown = [text.replace("\\$", "$") for text in names_of(figure)]
    assert shown[0] == f"{name}: 140.9 m"
    assert f"no-fly zone: {name}" in shown
    assert figure.axes[0].get_title().replace("\\$", "$").replace("\u200b", "") == name


def test_a_still_is_closed_for_pyplot():
    import matplotlib.pyplot as plt

    before = plt.get_fignums()
    scene.still(FLAT)
    assert plt.get_fignums() == before
