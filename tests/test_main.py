"""`python -m uavlab`, as a person calls it."""

import base64
import gzip
import html
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from uavlab.__main__ import main
from uavlab.flight import Flights
from uavlab.report import Premises, Trial, trial_table
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind
from uavlab.whole_way import free_memory, tell

pytestmark = pytest.mark.filterwarnings("error:.*city.source tells all:UserWarning")


def test_writes_one_page_and_says_where(tmp_path, capsys):
    out = tmp_path / "route.html"
    assert main(["--out", str(out)]) == 0
    assert f"open {out}" in capsys.readouterr().out
    page = out.read_text(encoding="utf-8")
    assert "A* + shortcut through the city of REPARE Table 1" in page
    assert "srcdoc=" in page
    assert "data:image/svg+xml;base64," in page
    assert "<th>distance to keep</th><td>3.5 m</td>" in page
    assert "<th>least clearance</th><td>3.61 m</td>" in page
    assert len(page) < 700_000


def test_goes_the_whole_way_from_weather_to_flights(tmp_path, capsys):
    out = tmp_path / "route.html"
    assert main(["--flights", "40", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "smoothed: " in said
    assert "at 5 m/s all limits kept" in said
    assert "flown 40 times in gusts, crashed 0 times" in said
    page = out.read_text(encoding="utf-8")
    rows = dict(re.findall(r"<th>([^<]+)</th><td>([^<]+)</td>", page))
    assert rows["weather"] == "wind of 6.0 m/s, gusts up to 10.5 m/s"
    assert rows["offsets to be survived"] == "3.0 m (σ = 1.00 m)"
    assert rows["crashes in these gusts"] == "0 [0, 88.1] per 1 000 (40 flights)"  # 1 − 0.025^(1/40)
    assert rows["gave up in these gusts"] == "0%"
    assert rows["flown at"] == "5 m/s, all limits kept"
    assert page.count("<td>yes</td>") == 10  # the limits of the curve


def test_the_same_seed_flies_the_same_flights(tmp_path):
    pages = []
    for seed in ("1", "1", "2"):
        out = tmp_path / "route.html"
        assert main(["--flights", "5", "--seed", seed, "--out", str(out)]) == 0
        pages.append(out.read_text(encoding="utf-8"))
    assert pages[0] == pages[1] != pages[2]


def test_more_load_and_wind_keep_a_larger_distance(tmp_path):
    out = tmp_path / "route.html"
    kept = []
    for conditions in ("--wind=1", "--wind=6", "--wind=9", "--wind=6 --payload=1"):
        assert main([*conditions.split(), "--flights", "0", "--start", "90,20,40", "--out", str(out)]) == 0
        kept.append(float(re.search(r"distance to keep</th><td>([\d.]+) m", out.read_text(encoding="utf-8"))[1]))
    assert kept == [2.5, 3.5, 5.5, 4.5]  # the last three as in REPARE Table 4


def test_in_too_much_wind_it_stays_on_the_ground(tmp_path, capsys):
    out = tmp_path / "route.html"
    assert main(["--wind", "20", "--out", str(out)]) == 1
    said = capsys.readouterr().out
    assert re.match(r"grounded: gusts: 35.0 m/s, and the thrust left over holds [\d.]+ m/s; head wind: ", said)
    page = out.read_text(encoding="utf-8")  # no older one seems to be the answer
    assert "<h1>Grounded in the city of REPARE Table 1</h1>" in page
    assert rows_of(page)["grounded"].startswith("gusts: 35.0 m/s")
    assert "inf m" not in page


def test_a_route_that_scrapes_a_wall_is_drawn_but_not_flown(tmp_path, capsys):
    voxels, out = tmp_path / "wall.3dmap", tmp_path / "route.html"
    lines = [f"5 {y} {z}" for y in range(9) for z in range(10)]
    voxels.write_text("voxel 10 10 10\n" + "\n".join(lines) + "\n")
    arguments = ["--city", str(voxels), "--cell", "0.5", "--clearance", "0", "--out", str(out)]
    assert main(arguments) == 1
    assert "not flown: route comes within" in capsys.readouterr().out
    assert "a body of 1 m needs 0.5 m" in out.read_text(encoding="utf-8")


def test_planner_start_and_goal_are_taken(tmp_path, capsys):
    out = tmp_path / "route.html"
    arguments = ["--planner", "astar", "--start", "5,5,10", "--goal", "5,5,50", "--clearance", "0", "--out", str(out)]
    assert main(arguments) == 0
    assert capsys.readouterr().out.startswith("A*: 40.0 m\n")
    assert "A* through the city of REPARE Table 1" in out.read_text(encoding="utf-8")


def test_plans_through_a_city_file(tmp_path, capsys):
    square = [[[0, 0], [30, 0], [30, 30], [0, 30], [0, 0]]]
    feature = {
        "type": "Feature",
        "properties": {"height": 20},
        "geometry": {"type": "Polygon", "coordinates": square},
    }
    file = tmp_path / "town.geojson"
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::28992"}}
    file.write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": [feature]}))
    out = tmp_path / "route.html"
    assert main(["--city", str(file), "--out", str(out)]) == 0
    assert "1 buildings" in out.read_text(encoding="utf-8")


def test_the_campus_is_planned_by_risk(tmp_path, capsys):
    out = tmp_path / "route.html"
    assert main(["--city", "campus", "--detour", "8", "--out", str(out)]) == 0
    assert "least risk" in (said := capsys.readouterr().out)
    assert re.search(r"at [\d.]+ m/s all limits kept", said)
    page = out.read_text(encoding="utf-8")
    saved, longer = re.search(r"(\d+)% less risk for ([\d.]+)% more way", page).groups()
    assert int(saved) >= 60
    assert float(longer) <= 8
    assert re.search(r"<td>[\d.]+ m/s, all limits kept; its cruise speed of 16 m/s breaks limits</td>", page)
    assert "deaths per hour of flight" in page  # the scene's colour bar


def test_least_risk_in_a_city_without_people_takes_them_as_spread_evenly(tmp_path):
    voxels, out = tmp_path / "wall.3dmap", tmp_path / "route.html"
    lines = [f"5 {y} {z}" for y in range(9) for z in range(9)]
    voxels.write_text("voxel 10 10 10\n" + "\n".join(lines) + "\n")
    arguments = ["--city", str(voxels), "--cell", "2", "--clearance", "0", "--planner", "least-risk", "--out", str(out)]
    assert main(arguments) == 0
    assert "30,000 per km² on average, at most 30,000" in out.read_text(encoding="utf-8")


def test_no_way_is_an_answer_with_its_own_exit_code(tmp_path, capsys):
    voxels = tmp_path / "wall.3dmap"
    lines = [f"5 {y} {z}" for y in range(10) for z in range(10)]
    voxels.write_text("voxel 10 10 10\n" + "\n".join(lines) + "\n")
    out = tmp_path / "route.html"
    code = main(["--city", str(voxels), "--cell", "1", "--clearance", "0", "--out", str(out)])
    assert code == 1
    assert "not reached: no free way from" in capsys.readouterr().out
    assert "no free way" in out.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--detour", "nan"], "--detour must be a percentage, finite and at least 0, got nan"),
        (["--out", "."], "can't write .: Is a directory; choose another file with --out"),
        (["--flights", "9" * 31], "--flights must be from 0 to 1,000,000, got 1e+31"),
        (["--out", "no/such/folder/page.html"], "can't write no/such/folder/page.html: No such file or directory"),
        (["--city", "campus", "--detour", "-3"], "--detour must be a percentage, finite and at least 0, got -3"),
        (["--city", "campus", "--detour", "inf"], "--detour must be a percentage, finite and at least 0, got inf"),
        (["--city", "nowhere"], "--city nowhere: neither a known name (table1, campus) nor a file"),
        (["--start", "65,20,30"], "start (65.0, 20.0, 30.0) lies in building '1 notch'"),
        (["--cell", "-1"], "cell must be the edge of a voxel in metres, above 0, got -1.0"),
        (["--clearance", "60"], "--clearance 60: no voxel of the map is that far from all obstacles"),
        (["--wind", "-1"], "forecast_wind must be finite and at least 0, got -1"),
        (["--payload", "9"], "thrust 28 N can't lift 1.5 kg + payload 9 kg"),
        (["--flights", "-1"], "--flights must be from 0 to 1,000,000, got -1"),
    ],
)
def test_wrong_question_is_one_line_and_exit_code_2(arguments, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_position_that_is_none(capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["--start", "1,2"])
    assert "'1,2' is not a position: give three numbers in metres, as in 90,20,30" in capsys.readouterr().err


def test_help_names_every_option():
    text = subprocess.run([sys.executable, "-m", "uavlab", "--help"], capture_output=True, text=True, check=True).stdout
    named = "--city --cell --planner --detour --start --goal --wind --wind-from --rain --payload --clearance --flights"
    for option in [*named.split(), "--seed", "--out"]:
        assert option in text


def square(west, south, side):
    return [[west, south], [west + side, south], [west + side, south + side], [west, south + side]]


def feature(ring, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": [ring]}}


@pytest.fixture
def town(tmp_path):
    """A file with two houses, one of them of unknown height, in metres near (0, 0)."""

    def write(*features, name="town.geojson"):
        path = tmp_path / name
        houses = [feature(square(0, 0, 20), roof=20, levels=6), feature(square(80, 60, 20), levels=2)]
        path.write_text(json.dumps({"type": "FeatureCollection", "features": list(features) or houses}))
        return str(path)

    return write


def page_of(tmp_path, *arguments, status=0):
    out = tmp_path / "route.html"
    out.unlink(missing_ok=True)
    assert main([*arguments, "--flights", "0", "--out", str(out)]) == status
    return out.read_text(encoding="utf-8") if out.exists() else ""


def rows_of(page):
    return dict(re.findall(r"<th>([^<]+)</th><td>([^<]+)</td>", page))


def test_heights_of_a_file_are_found_where_one_says(tmp_path, town, capsys):
    file = town()
    assert main(["--city", file, "--crs", "local"]) == 2
    assert "Pass default_height=10.0" in capsys.readouterr().err
    roofs = {}
    for name, options in {
        "property": ["--height", "roof", "--default-height", "40"],
        "storeys": ["--height", "levels"],
        "higher storeys": ["--height", "levels", "--storey-height", "5"],
        "one": ["--height", "13.5"],
    }.items():
        page = page_of(tmp_path, "--city", file, "--crs", "local", "--cell", "4", *options)
        roofs[name] = rows_of(page)["city"].split(" voxels")[0]
        assert "What was read" in page
    assert len(set(roofs.values())) == 4  # how high the map is follows the highest roof
    assert "assumed: 1 × height of 40 m (default_height)" in capsys.readouterr().out


def test_the_reference_system_and_degrees_are_taken(tmp_path, town, capsys):
    ring = [[4.36, 52.01], [4.3603, 52.01], [4.3603, 52.0102], [4.36, 52.0102]]
    file = town(feature(ring, height="30 ft"))
    ends = ["--start-lonlat", "4.3599,52.0101,14", "--goal-lonlat", "4.3604,52.0101,15"]
    page = page_of(tmp_path, "--city", file, "--cell", "1", *ends)
    assert "(longitude, latitude 4.359900°, 52.010100° to 4.360400°, 52.010100°)" in rows_of(page)["start, goal"]
    assert re.search(r", 14\.0\) m to \(.*, 15\.0\) m", rows_of(page)["start, goal"])
    assert main(["--city", file, "--crs", "EPSG:0"]) == 2
    assert "is no reference system that pyproj knows" in capsys.readouterr().err
    assert main(["--city", file, "--start-lonlat", "52.01,104.36,14"]) == 2
    assert "latitudes must be from -90 to 90 degrees (order: longitude" in capsys.readouterr().err


def test_negative_coordinates_are_no_options(tmp_path, town):
    ends = ["--start", "-10,10,25", "--goal", "60,-12,25"]
    page = page_of(tmp_path, "--city", town(), "--crs", "local", "--height", "levels", *ends)
    assert rows_of(page)["start, goal"] == "(-10.0, 10.0, 25.0) m to (60.0, -12.0, 25.0) m"


def test_ground_heights_and_zones_are_kept(tmp_path, town, capsys):
    grid = tmp_path / "hill.asc"
    header = "ncols 40\nnrows 40\nxllcorner -60\nyllcorner -60\ncellsize 6\n"
    grid.write_text(header + "\n".join(" ".join(str(2 * column) for column in range(40)) for _ in range(40)))
    zone = town(feature(square(40, -10, 20), upper="90 m", name="school"), name="zone.geojson")
    where = ["--city", town(), "--crs", "local", "--height", "levels", "--cell", "4", "--terrain", str(grid)]
    page = page_of(tmp_path, *where, "--max-height", "60", "--no-fly", zone)
    assert "ground from the terrain given" in page
    assert "school" in page
    assert page_of(tmp_path, *where, "--max-height", "2", status=2) == ""
    assert "within the limits of height" in capsys.readouterr().err
    inside = ["--start", "50,0,58", "--goal", "-10,10,58"]
    assert page_of(tmp_path, *where, *inside, "--no-fly", zone, status=2) == ""
    assert "start (50.0, 0.0, 58.0) lies in no-fly zone 'school'" in capsys.readouterr().err


FOR_FILES = ["--height=9", "--default-height=9", "--storey-height=3", "--crs=local", "--terrain=0"]


@pytest.mark.parametrize("option", FOR_FILES)
def test_options_for_files_are_refused_for_known_cities(option, capsys):
    assert main([option]) == 2
    assert "is for cities from a file, not for table1" in capsys.readouterr().err


def test_an_option_that_a_format_doesnt_know_is_refused(tmp_path, capsys):
    voxels = tmp_path / "wall.3dmap"
    voxels.write_text("voxel 10 10 10\n5 5 5\n")
    assert main(["--city", str(voxels), "--crs", "local"]) == 2
    assert "crs is no option for a voxel map, which takes cell" in capsys.readouterr().err


def test_the_city_s_own_file_is_never_overwritten(town, capsys):
    file = town()
    before = Path(file).read_text()
    assert main(["--city", file, "--crs", "local", "--height", "levels", "--out", file]) == 2
    assert "is the city's own file: choose another" in capsys.readouterr().err
    assert Path(file).read_text() == before


def test_flights_that_give_up_are_told():
    none = np.zeros(3)
    outcome = np.array(["arrived", "gave up", "crashed"])
    flights = Flights(outcome, none, none, none, np.zeros((3, 3)), np.zeros((3, 1, 3)))
    assert Trial("", flights=flights).lines() == ["flown 3 times in gusts, crashed 1 times, gave up 1 times"]


def flown_rows(tmp_path, *arguments):
    """The table of a page after three flights."""
    out = tmp_path / "route.html"
    assert main([*arguments, "--flights", "3", "--out", str(out)]) == 0
    return rows_of(out.read_text(encoding="utf-8"))


def test_rain_and_where_the_wind_comes_from_reach_the_flights(tmp_path):
    usual = flown_rows(tmp_path)
    rainy = flown_rows(tmp_path, "--rain", "300")
    assert rainy["weather"].endswith(", 300 mm/h of rain")
    assert float(rainy["energy"].split()[0]) > float(usual["energy"].split()[0])
    turned = flown_rows(tmp_path, "--wind-from", "60")
    assert turned["weather"] == usual["weather"]
    assert turned["offsets in these gusts"] != usual["offsets in these gusts"]
    assert turned["time"] != usual["time"] or turned["energy"] != usual["energy"]


def test_the_campus_takes_a_payload(tmp_path):
    light, heavy = (flown_rows(tmp_path, "--city", "campus", "--payload", load) for load in ("0", "0.3"))
    assert "with a load of 0.3 kg" in heavy["the UAV"]
    assert float(heavy["energy"].split()[0]) > 1.1 * float(light["energy"].split()[0])


def test_energy_is_in_watt_hours_and_offsets_across_come_before_those_up():
    offsets = np.zeros((2, 400, 3))
    offsets[..., 1:] = np.random.default_rng(0).normal(0, (3.0, 0.5), (2, 400, 2))
    ones = np.ones(2)
    flights = Flights(np.array(["arrived"] * 2), 30 * ones, 4 * ones, 7200 * ones, np.zeros((2, 3)), offsets)
    conditions = Premises(LIGHT_QUADROTOR, Wind((6.0, 0.0)), 10.0, 1.0, 3.5, "")
    rows = dict(trial_table(Trial("", flights=flights, as_planned=flights), conditions))
    assert rows["energy"] == "2.00 Wh from the battery, 2% of it"
    across, up = map(float, re.findall(r"[\d.]+(?= m)", rows["offsets in these gusts"]))
    assert across == pytest.approx(3.0, abs=0.2)
    assert up == pytest.approx(0.5, abs=0.05)


def test_names_from_a_file_are_text_on_the_page(tmp_path, town):
    page = page_of(tmp_path, "--city", town(name="<script>alert(1)<script>.geojson".replace("/", "")), "--crs", "local",
                   "--height", "levels")  # fmt: skip
    assert "<script>alert(1)" not in page
    assert "&lt;script&gt;alert(1)" in page


def test_ctrl_c_ends_in_one_line_and_leaves_no_page(tmp_path, capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("uavlab.__main__.load_city", interrupted)
    assert main(["--out", str(tmp_path / "route.html")]) == 130
    assert capsys.readouterr().err == "uavlab: stopped; no page was written\n"
    assert not list(tmp_path.iterdir())


def test_too_little_memory_is_said_before_and_if_it_runs_out(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("uavlab.whole_way.free_memory", lambda: 1e6)
    assert main(["--out", str(tmp_path / "route.html")]) == 2
    assert (
        "a map of 1,000,000 voxels needs about 0.1 GB of memory to plan on, 0.0 GB are free: take a larger --cell"
        in (capsys.readouterr().err)
    )

    def too_much(*_):
        raise MemoryError("8 TB")

    monkeypatch.setattr("uavlab.__main__.load_city", too_much)
    assert main(["--out", str(tmp_path / "route.html")]) == 2
    assert "the memory isn't enough (8 TB): take a larger --cell" in capsys.readouterr().err


def test_long_work_is_announced(capsys):
    tell("planning on 300,000,000 voxels", 90.0, 15e9)
    tell("nothing much", 4.0)
    assert capsys.readouterr().err == "planning on 300,000,000 voxels: about 90 s, 15.0 GB; Ctrl-C stops it\n"
    assert free_memory() is None or free_memory() > 1e8


def test_an_unwritable_place_is_found_before_the_work(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("uavlab.__main__.load_city", lambda options: pytest.fail("it began to work"))
    assert main(["--out", str(tmp_path / "no" / "page.html")]) == 2
    assert "can't write" in capsys.readouterr().err


def test_a_key_that_stands_twice_is_refused(tmp_path, capsys):
    file = tmp_path / "twice.geojson"
    once = json.dumps({"type": "FeatureCollection", "features": [feature(square(0, 0, 20), height=5)]})
    file.write_text(once.replace('"height": 5', '"height": 5, "height": 50'))
    assert main(["--city", str(file), "--crs", "local"]) == 2
    assert "the key 'height' stands twice in one object" in capsys.readouterr().err


def test_the_profile_has_the_colours_of_the_scene(tmp_path):
    out = tmp_path / "route.html"
    assert main(["--city", "campus", "--flights", "2", "--out", str(out)]) == 0
    page = html.unescape(out.read_text(encoding="utf-8"))
    scene = dict(re.findall(r'style="color:(#\w+)"[^>]*>(?:(?!style=).)*?</svg><span>([^:,<]+): ', page))
    svg = base64.b64decode(re.search(r"data:image/svg\+xml;base64,([^\"]+)", page)[1]).decode()
    profile = dict(re.findall(r'stroke: (#\w+)[^"]*"(?:(?!stroke).)*?<!-- ([^<>]+?), [\d.]+ m -->', svg, re.DOTALL))
    colors = {name: color.upper() for color, name in scene.items()}
    assert set(colors) == {"shortest", "least risk + B-spline"}
    assert {name: color.upper() for color, name in profile.items()} == colors
    assert len(set(colors.values())) == 2


def told_of(page, name):
    return json.loads(gzip.decompress(base64.b64decode(re.search(rf'[{{ ]{name}: "([^"]*)"', page)[1])))


def test_live_writes_a_page_that_answers(tmp_path, capsys):
    out = tmp_path / "live.html"
    assert main(["--live", "--wind", "7", "--wind-from", "270", "--payload", "0.5", "--out", str(out)]) == 0
    assert f"open {out}" in capsys.readouterr().out
    page = out.read_text(encoding="utf-8")
    assert len(page) < 600_000
    told = told_of(page, "told")
    assert [offer["name"] for offer in told["offers"]] == ["A*", "Theta*", "hazard A*", "potential field"]
    settings = {slider["name"]: slider["value"] for slider in told["sliders"]}
    assert settings["wind"] == 7.0
    assert settings["towards"] == 90.0
    assert settings["keep"] >= 3.5
    assert told["flights"]["total"] == 200
    assert "city, uav, wind" in told["flights"]["python"]  # with its load, it isn't the usual one


def test_live_over_people_plans_by_risk(tmp_path):
    out = tmp_path / "live.html"
    assert main(["--live", "--city", "campus", "--flights", "0", "--out", str(out)]) == 0
    told = told_of(out.read_text(encoding="utf-8"), "told")
    assert [offer["name"] for offer in told["offers"]] == ["least risk", "shortest"]
    assert "flights" not in told


def test_live_of_a_file_with_its_terrain_and_zones(tmp_path):
    square = [[4.36, 52.01], [4.3604, 52.01], [4.3604, 52.0102], [4.36, 52.0102], [4.36, 52.01]]
    feature = {
        "type": "Feature",
        "properties": {"height": 12},
        "geometry": {"type": "Polygon", "coordinates": [square]},
    }
    town = tmp_path / "town.geojson"
    town.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}), encoding="utf-8")
    out = tmp_path / "live.html"
    assert main(["--live", "--city", str(town), "--cell", "2", "--out", str(out)]) == 0
    assert told_of(out.read_text(encoding="utf-8"), "told")["cell"] == 2.0


@pytest.mark.parametrize("option", [("--min-height", "5"), ("--max-height", "50"), ("--planner", "astar")])
def test_live_refuses_what_it_has_not(tmp_path, capsys, option):
    out = tmp_path / "live.html"
    assert main(["--live", *option, "--out", str(out)]) == 2
    assert f"{option[0]} is nothing that a page with --live has" in capsys.readouterr().err
    assert not out.exists()
