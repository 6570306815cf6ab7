"""The ground and no-fly zones in figures: where they are drawn, and above what heights are."""

import numpy as np
import pytest
import shapely
from matplotlib.colors import to_rgb
from matplotlib.patches import PathPatch

from uavlab import plot
from uavlab.city import Building, City, NoFlyZone, Terrain
from uavlab.flight import OffsetProcess, fly
from uavlab.planners import astar
from uavlab.plot import ground
from uavlab.plot.ground import CUT_COLOR, ground_lattice, height_label, height_words, zone_label, zone_surface
from uavlab.risk import RiskMap
from uavlab.route import Route
from uavlab.scene.stage import voxel_surface
from uavlab.spline import Curve
from uavlab.vehicle import LIGHT_QUADROTOR

SCHOOL = NoFlyZone([(80, 10), (120, 10), (120, 30), (80, 30)], 0.0, 30.0, name="school")
CHURCH = NoFlyZone([(140, 85), (160, 85), (150, 105)], 20.0, name="church")


@pytest.fixture(scope="module")
def hill():
    """A hill of 35 m between a house with a flat roof, 14 m high, and one on the slope; two no-fly zones."""
    x, y = np.meshgrid(np.linspace(0, 200, 101), np.linspace(120, 0, 61))
    heights = 35 * np.exp(-((x - 100) ** 2 + (y - 60) ** 2) / 1200)
    houses = (
        Building.prism([(15, 45), (35, 45), (35, 75), (15, 75)], 14, name="west"),
        Building.prism([(60, 84), (76, 84), (76, 96), (60, 96)], 26, name="slope"),
    )
    return City.from_buildings(houses, cell=4.0, origin=(0, 0, -4), size=(200, 120, 84), name="hill",
                               terrain=Terrain.from_raster(heights, (-1, -1, 201, 121)),
                               no_fly=(SCHOOL, CHURCH))  # fmt: skip


@pytest.fixture(scope="module")
def over(hill):
    return astar(hill, (8, 60, 10), (192, 60, 12), record=True)


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def brown(axes):
    """What the image of the cut ground shows, (nx, ny) bool; None if there is none."""
    for image in axes.images:
        if image.cmap.N == 1 and np.allclose(image.cmap(0)[:3], to_rgb(CUT_COLOR)):
            return ~np.ma.getmaskarray(image.get_array()).T
    return None


def test_section_tells_the_ground_from_buildings(hill, over):
    figure = plot.section(hill, 21.0, None, over)
    axes = figure.axes[0]
    cut = brown(axes)
    level = 22.0  # of the layer's centres
    x, y = np.meshgrid(hill.coordinates(0), hill.coordinates(1), indexing="ij")
    house = (x > 60) & (x < 76) & (y > 84) & (y < 96)
    assert not cut[house & (hill.ground < level)].any()
    assert cut[hill.ground > level].all()
    assert not cut[hill.ground < level - 8].any()
    assert np.array_equal(cut | house, hill.occupied[:, :, 6] | house)
    assert brown(plot.section(hill, 1.0).axes[0])[house].all()  # its cellar lies in the hill
    assert axes.get_title() == "Hill, z = 21 m, up to 21 m above the ground\n(buildings black, ground brown)"
    hatched = [drawn for drawn in axes.collections if getattr(drawn, "hatches", None)]
    assert hatched  # told apart from black without colours, too


def test_ground_of_a_city_that_knows_no_buildings_is_cut_where_it_reaches(hill):
    alone = City(hill.occupied, hill.cell, hill.origin, ground=hill.ground)
    assert np.array_equal(ground.cut_ground(alone, 6), alone.occupied[:, :, 6] & (hill.range_of_ground[1] > 20.0))
    assert not ground.built_columns(alone)[:, 0].any()
    assert ground.built_columns(alone)[5:8, 13:17].all()
    assert voxel_surface(alone)[..., 2].min() >= 0.0  # the ground has a mesh of its own
    assert np.ptp(voxel_surface(alone)[..., 0]) < 120


@pytest.mark.parametrize(
    ("height", "words"),
    [
        (60.0, "z = 60 m, 25 to 60 m above the ground"),
        (10.5, "z = 10.5 m, up to 10 m above the ground"),
        (-2.0, "z = -2 m, below the ground"),
    ],
)
def test_heights_over_uneven_ground_are_z_with_what_is_below(hill, height, words):
    assert height_words(hill, height) == words
    assert height_label(hill) == "height z [m]\n(ground at z = 0 to 35 m)"


def test_heights_over_level_ground_are_counted_from_it():
    shape = (6, 6, 8)
    open_floor = City(np.zeros(shape, dtype=bool), 5.0, origin=(0, 0, 100))
    level = City(np.zeros(shape, dtype=bool), 5.0, origin=(0, 0, 95), ground=np.full((6, 6), 100.0))
    way = Route([(2, 2, 104), (25, 25, 120)])
    for city in (open_floor, level):
        assert plot.section(city, 104.0).axes[0].get_title().startswith("City, 4 m above the ground (")
        above = plot.profile(city, way).axes[0]
        assert above.lines[0].get_ydata() == pytest.approx([4.0, 20.0])
        assert above.get_ylabel() == "height above the ground [m]"
        assert above.get_ylim()[0] == 0.0


def test_plan_shows_how_high_buildings_are_above_the_ground_and_how_high_that_is(hill, over):
    figure = plot.plan(hill, over)
    axes = figure.axes[0]
    tops = axes.images[0].get_array().T
    shown = ~np.ma.getmaskarray(tops)
    assert np.argwhere(shown).min(axis=0).tolist() == [3, 11]  # the western house from (15, 45) on
    assert shown.sum() == 6 * 8 + 4 * 3
    assert tops[6, 14] == pytest.approx(16.0 - hill.ground[6, 14])
    assert tops[16, 22] == pytest.approx(28.0 - hill.ground[16, 22])
    expected = ["height z of the ground [m]", "no-fly zones: school, church", f"A*, {over.length:.1f} m"]
    assert legend_of(figure) == [*expected, "start", "goal"]
    levels = {float(text.get_text()) for text in axes.texts}
    assert levels
    assert levels <= set(range(0, 40, 5))


def test_plan_of_level_ground_has_no_contours():
    city = City.from_buildings([Building.prism([(0, 0), (9, 0), (9, 9)], 5)], terrain=0.0)
    figure = plot.plan(city)
    assert not figure.axes[0].texts
    assert not figure.legends


def test_profile_draws_the_ground_below_and_what_is_on_it(hill, over):
    figure = plot.profile(hill, over, safe_distance=np.float32(3))
    above = figure.axes[0]
    way = over.resample(2.0)
    area = above.collections[0].get_paths()[0].vertices
    beneath = -hill.height_above_ground(way.points * [1, 1, 0])
    for distance, z in zip(way.distance[::7], beneath[::7], strict=True):
        assert np.abs(area - (distance, z)).max(axis=1).min() < 1e-9
    assert above.lines[0].get_ydata() == pytest.approx(over.points[:, 2])
    tops = above.lines[1].get_ydata()
    assert (tops >= beneath - 1e-9).all()
    assert (tops <= way.points[:, 2] + 1e-9).all()
    assert tops[np.argmin(np.abs(way.points[:, 0] - 25))] == 16.0  # the roof's voxels
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names[1:] == ["ground", "occupied voxels below it"]
    two = plot.profile(hill, over, Route(over.points[::-1], "back"))
    assert "ground below each route" in [text.get_text() for text in two.legends[0].get_texts()]


def test_searches_tracks_and_corners_tell_buildings_from_ground(hill, over):
    built = plot.expansions(hill, over).axes[0].images[0].get_array().T
    assert np.ma.getmaskarray(built).sum() == built.size - 6 * 8 - 4 * 3
    flight = fly(over, hill, LIGHT_QUADROTOR, OffsetProcess(0.1), rng=1)
    built = plot.tracks(hill, {"A*": [flight]}).axes[0].images[0].get_array()
    assert np.ma.getmaskarray(built).sum() == built.size - 6 * 8 - 4 * 3
    curve = Curve(np.array([[60.0, 40, 22], [80, 20, 22], [110, 20, 22]]))
    assert brown(plot.corner(hill, curve, center=(90, 40, 22), reach=30, uav_diameter=1).axes[0]).any()
    assert brown(plot.field(hill, 21.0, (180, 60, 21), spacing=10.0).axes[0]).any()


def test_zones_are_hatched_outlines_where_the_height_meets_them(hill, over):
    def outlines(figure):
        return [patch for patch in figure.axes[0].patches if isinstance(patch, PathPatch) and patch.get_hatch()]

    low, high = plot.section(hill, 15.0, None, over), plot.section(hill, 70.0)
    assert [patch.get_path().get_extents().bounds for patch in outlines(low)] == [(80, 10, 40, 20)]
    assert [patch.get_path().get_extents().bounds for patch in outlines(high)] == [(140, 85, 20, 20)]
    assert legend_of(low)[0] == "no-fly zone: school"
    assert legend_of(high) == ["no-fly zone: church"]
    assert len(outlines(plot.plan(hill))) == 2


def test_what_a_zone_closes_is_not_called_too_low(hill):
    axes = plot.risk(RiskMap(hill, 1e-3, 0.5), 45.0).axes[0]
    assert "too low" not in axes.get_title()
    assert "too low hatched, ground brown" in plot.risk(RiskMap(hill, 1e-3, 0.5), 21.0).axes[0].get_title()


@pytest.mark.parametrize(
    ("names", "label"),
    [
        (["no-fly zone"], "no-fly zone"),
        (["no-fly zone"] * 2, "no-fly zones"),
        (["a", "a"], "no-fly zones: a"),
        (["a", "no-fly zone", "b", "c", "d"], "no-fly zones: a, b, c, …"),
    ],
)
def test_zones_have_one_entry_in_a_legend(names, label):
    assert zone_label([NoFlyZone(SCHOOL.outline, name=name) for name in names]) == label


def volume_of(triangles):
    """Inside of a closed surface of triangles, whichever way round they are, by the heights of its caps."""
    level = np.ptp(triangles[..., 2], axis=1) == 0
    corners = triangles[level]
    area = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]) / 2
    return area.sum() / 2 * np.ptp(triangles[..., 2])


def test_zone_is_a_prism_without_walls_inside_cut_off_at_the_map():
    courtyard = [(20, 20), (30, 20), (30, 30), (20, 30)]
    corner = NoFlyZone([(-50, -50), (40, -50), (40, 40), (-50, 40)], 5.0, holes=(courtyard,))
    city = City(np.zeros((50, 50, 20), dtype=bool), 2.0, origin=(0, 0, 10), no_fly=(corner,))
    triangles, edges = zone_surface(city)
    assert triangles.min(axis=(0, 1)) == pytest.approx([0, 0, 15])
    assert triangles.max(axis=(0, 1)) == pytest.approx([40, 40, 50])  # an infinite limit ends at the map's top
    assert volume_of(triangles) == pytest.approx((40 * 40 - 10 * 10) * 35)
    walls = triangles[np.ptp(triangles[..., 2], axis=1) > 0]
    rings = shapely.Polygon([(0, 0), (40, 0), (40, 40), (0, 40)], [courtyard]).boundary
    for x, y, _ in walls.mean(axis=1):
        assert rings.distance(shapely.Point(x, y)) < 1e-9
    assert len(edges) == 2 * 3 * 8


def test_zone_beside_the_map_is_not_named():
    away = NoFlyZone([(500, 500), (600, 500), (600, 600)], name="away")
    city = City(np.zeros((9, 9, 9), dtype=bool), 2.0, no_fly=(away,))
    assert not plot.plan(city).legends
    assert len(zone_surface(city)[0]) == 0


def test_lattice_has_the_heights_of_the_ground_at_the_columns_corners(hill):
    lattice = ground_lattice(hill)
    assert lattice.shape == (51, 31, 3)
    inner = (hill.ground[:-1, :-1] + hill.ground[1:, :-1] + hill.ground[:-1, 1:] + hill.ground[1:, 1:]) / 4
    assert np.allclose(lattice[1:-1, 1:-1, 2], inner)
    assert np.allclose(lattice[3, 7, :2], (12, 28))
    thin = ground_lattice(hill, 10)
    assert thin.shape == (11, 11, 3)
    assert np.allclose(hill.height_above_ground(thin), 0.0)


def test_bare_ground_can_be_drawn(hill):
    bare = City(np.zeros((9, 1, 5), dtype=bool), 2.0, ground=np.linspace(0, 4, 9)[:, None])
    for city in (bare, City(np.zeros((9, 9, 5), dtype=bool), 2.0, ground=np.ones((9, 9)))):
        risk = RiskMap(city, 1e-3, 0.5)
        for figure in (
            plot.plan(city),
            plot.section(city, 3.0),
            plot.risk(risk, 3.0),
        ):
            figure.canvas.draw()


@pytest.mark.parametrize("name", [r"$\foo$", "$x", "_x", "_$\\foo$_"])
def test_names_are_shown_as_they_are(hill, over, name):
    zone = NoFlyZone(SCHOOL.outline, name=name)
    city = City(hill.occupied, hill.cell, hill.origin, hill.buildings, name, None, hill.ground, (zone,))
    route = Route(over.points, name, info=over.info)
    flight = fly(route, city, LIGHT_QUADROTOR, OffsetProcess(0.1), rng=1)
    curve = Curve(np.array([[60.0, 40, 22], [80, 20, 22], [110, 20, 22]]), planner=name)
    figures = [
        plot.plan(city, route),
        plot.section(city, 21.0, None, route),
        plot.profile(city, route),
        plot.tracks(city, {name: [flight]}, {name: route}),
        plot.in_flight({name: flight}, **{name: 20.0}),
        plot.curve_profile(curve, speed=8.0, cell=5.0),
        plot.corner(city, curve, center=(80, 30, 22), reach=20, uav_diameter=1, route=route),
        plot.expansions(city, route),
        plot.bars({name: 1.0}, "m"),
        plot.risk(RiskMap(city, 1e-3, 0.5), 21.0, route),
    ]
    for figure in figures:
        figure.canvas.draw()
    shown = legend_of(figures[0])[-3].replace("\\$", "$").replace("\u200b", "")
    assert shown == f"{name}, {route.length:.1f} m"
    assert name in legend_of(figures[0])[1].replace("\\$", "$")


@pytest.mark.parametrize("kind", [np.int64, np.float32, int])
def test_numbers_of_any_kind_are_taken(hill, over, kind):
    assert plot.section(hill, kind(20)).axes[0].get_title() == plot.section(hill, 20.0).axes[0].get_title()
    assert plot.profile(hill, over, safe_distance=kind(3)).axes[1].texts[0].get_text() == "to keep: 3 m"
    with pytest.raises(ValueError, match="safe_distance must be finite and above 0, got -3"):
        plot.profile(hill, over, safe_distance=kind(-3))
