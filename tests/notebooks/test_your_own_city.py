"""Chapter 16 on other files than its own: each cell runs, what is missing is said, and the page to hand in holds it."""

import ast
import importlib.util
import json
import re
import sys
from pathlib import Path

import jupytext
import nbformat
import numpy as np
import pytest
from bs4 import BeautifulSoup
from nbclient import NotebookClient

from uavlab.city import Place, read_geojson
from uavlab.city.footprints import TALL
from uavlab.risk import osm_layers
from uavlab.risk.osm import SHELTERED

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
SOURCE = NOTEBOOKS / "src" / "16_your_own_city.py"
PLACE = Place(4.36, 52.01)


def cells():
    return jupytext.read(SOURCE).cells


def text():
    return "\n\n".join(cell.source for cell in cells() if cell.cell_type == "markdown")


def with_settings(**settings):
    """The notebook as a student changes it: in the cell of the settings alone, each given as Python text."""
    notebook = jupytext.read(SOURCE)
    cell = next(cell for cell in notebook.cells if cell.source.startswith("from uavlab.vehicle"))
    names = {}
    for line in cell.source.splitlines():
        left = line.split("=")[0].strip()
        for name in left.split(", "):
            names[name] = line
    for left, value in settings.items():
        line = names[left.split("__")[0]]
        cell.source = cell.source.replace(line, f"{left.replace('__', ', ')} = {value}")
    ast.parse(cell.source)
    return notebook


def run(notebook, folder):
    """Run all of it in a fresh kernel, as JupyterLab saves it."""
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


def printed(notebook):
    return "\n".join(
        output.get("text") or "".join(output.get("data", {}).get("text/plain", ""))
        for cell in notebook.cells
        if cell.cell_type == "code"
        for output in cell.outputs
    )


def lonlat(*points):
    return PLACE.longitude_latitude(np.array(points, dtype=float)).round(7).tolist()


def outline(west, south, east, north):
    return lonlat((west, south), (east, south), (east, north), (west, north), (west, south))


def way(number, kind, coordinates, **tags):
    tags = {key.replace("__", ":"): value for key, value in tags.items()}
    feature = {"type": "Feature", "id": f"way/{number}", "properties": {"@id": f"way/{number}", **tags}}
    return feature | {"geometry": {"type": kind, "coordinates": coordinates}}


@pytest.fixture
def export(tmp_path):
    """What Overpass turbo writes for the query of the chapter: tags as text, relations, parts, no height at many."""
    court = [outline(0, 0, 60, 50), outline(20, 15, 40, 35)[::-1]]
    relation = way(7, "MultiPolygon", [court], type="multipolygon", building="yes", building__levels="3")
    relation |= {"id": "relation/7", "properties": relation["properties"] | {"@id": "relation/7"}}
    inside = {"role": "part", "rel": 9, "reltags": {"type": "building"}}
    part = way(12, "Polygon", [outline(100, 10, 115, 25)], building__part="yes", height="40", roof__shape="flat")
    part["properties"] |= {"@relations": [inside]}
    wire = way(31, "LineString", lonlat((0, 80), (200, 80)), power="line")
    tree = way(32, "Point", lonlat((80, 30))[0], natural="tree")
    features = [
        relation,
        part,
        way(11, "Polygon", [outline(90, 0, 140, 45)], building="office", building__levels="4", roof__levels="1"),
        way(13, "Polygon", [outline(160, 0, 175, 12)], building="house"),
        way(14, "Polygon", [outline(160, 20, 175, 32)], building="house", height="unknown"),
        way(15, "Polygon", [outline(0, 110, 40, 140)], building="retail", height="7,5"),
        way(16, "Polygon", [outline(90, 110, 130, 150)], building="apartments", height="21 m", name="Hof"),
        way(21, "LineString", lonlat((-40, 70), (240, 70)), highway="secondary", lanes="2", name="Straat"),
        way(22, "LineString", lonlat((70, -40), (70, 190)), highway="footway"),
        way(23, "Polygon", [outline(140, 100, 190, 160)], leisure="park"),
        way(24, "Polygon", [outline(-20, -20, 200, 170)], landuse="residential"),
        wire,
        tree,
    ]
    head = {"type": "FeatureCollection", "generator": "overpass-turbo", "copyright": "ODbL", "timestamp": "2026-05-01"}
    path = tmp_path / "export.geojson"
    path.write_text(json.dumps(head | {"features": features}))
    return path


@pytest.mark.filterwarnings("ignore:.*city.source tells all")
def test_an_export_by_the_query_of_the_chapter_is_read(export):
    with pytest.raises(ValueError, match=r"2 of 7 buildings .* have no height .*default_height"):
        read_geojson(export)
    city = read_geojson(export, default_height=9.0, cell=2.0)
    top = {building.name: round(float(building.bounds[1, 2]), 1) for building in city.buildings}
    assert top == {"feature relation/7": 9.0, "feature way/12": 40.0, "feature way/11": 15.0, "feature way/13": 9.0,
                   "feature way/14": 9.0, "feature way/15": 7.5, "Hof": 21.0}  # fmt: skip
    assert not city.occupied[tuple(city.cell_of((30, 25, 5)))]  # the court of the relation
    assert city.source.count("assumed", "default_height") == 2
    assert city.source.count("left out") == 2  # the tree and the wire
    layers = osm_layers(city, export)
    assert layers.vehicle_share.max() > 0
    assert layers.source.count("taken", "sparse trees") == 2


def test_the_query_asks_for_all_that_the_readers_know():
    query = re.search(r"\[out:json\].*?out skel qt;", text(), re.DOTALL)[0]
    asked = dict(re.findall(r'\["([\w:]+)"(?:~"\^\((.*?)\)\$")?\]', query))
    assert {"building", "building:part", "highway", "landuse"} <= set(asked)
    for key, value in SHELTERED:
        assert key in asked
        assert not asked[key] or value in asked[key].split("|")
    for key in ("man_made", "natural", "power"):
        assert set(asked[key].split("|")) & TALL[key]


def test_each_answer_follows_its_question_and_isn_t_part_of_the_guide():
    found = cells()
    questions = [n for n, cell in enumerate(found) if "**Question" in cell.source]
    assert len(questions) == 9
    for number, at in enumerate(questions, 1):
        assert f"> **Question {number}.**" in found[at].source
        assert found[at + 1].source == f"**Answer {number}.** …"
        assert not found[at].metadata.get("tags")
        assert not found[at + 1].metadata.get("tags")


def test_the_rubric_has_a_hundred_points():
    rubric = re.search(r"^## How it is marked$(.*?)^## ", text(), re.MULTILINE | re.DOTALL)[1]
    rows = [line.strip("|").split("|") for line in rubric.splitlines() if line.startswith("|")][2:]
    assert 8 <= len(rows) <= 10
    assert {len(row) for row in rows} == {5}
    *rows, total = rows
    assert sum(int(row[-1]) for row in rows) == int(total[-1].strip(" *")) == 100
    assert "Half the points of a row are for each half." in text()


CITYJSON = {"type": "CityJSON", "version": "1.1", "transform": {"scale": [0.001] * 3, "translate": [0.0] * 3}}
FACES = [[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]


def city_model(path, corner, system):
    """Five boxes as CityJSON, from a corner on [m]."""
    vertices, objects = [], {}
    boxes = [
        (0, 0, 40, 30, 12),
        (60, 0, 100, 30, 24),
        (0, 60, 40, 100, 9),
        (60, 60, 80, 100, 30),
        (120, 20, 160, 80, 15),
    ]
    for number, (west, south, east, north, height) in enumerate(boxes):
        first = len(vertices)
        for z in (0, height):
            for x, y in ((west, south), (east, south), (east, north), (west, north)):
                vertices.append([round(1000 * (c + at)) for c, at in zip((x, y, z), (*corner, 2.0), strict=True)])
        shell = [[[first + corner for corner in ring] for ring in face] for face in FACES]
        geometry = {"type": "Solid", "lod": "1", "boundaries": [shell]}
        objects[f"house {number}"] = {"type": "Building", "geometry": [geometry]}
    document = CITYJSON | {"CityObjects": objects, "vertices": vertices}
    if system:
        document |= {"metadata": {"referenceSystem": f"https://www.opengis.net/def/crs/EPSG/0/{system}"}}
    path.write_text(json.dumps(document))


def test_it_runs_on_a_city_model_without_a_place_without_people_and_terrain(tmp_path):
    city_model(tmp_path / "model.city.json", (0, 0), None)
    notebook = with_settings(
        CITY='"model.city.json"', READING='{"crs": "local"}', ROADS="None", PEOPLE="None", TERRAIN="None",
        START__GOAL="(-8, 45, 0), (165, 50, 18)", DETOUR__CHOICE='0.2, "shortest"', TITLE__NAME='"No place", "Bo"',
    )  # fmt: skip
    said = printed(run(notebook, tmp_path))
    assert "This city has no place on Earth: START and GOAL are in metres." in said
    assert "ASSUMED: 5000 people per km² everywhere" in said
    assert "ASSUMED: no cars, and no shelter but roofs" in said
    assert "The mission's place on Earth is invented." in said
    assert "Preflight of" in said
    assert (tmp_path / "mission.plan").exists()


def test_it_runs_on_an_export_with_missing_heights_and_makes_the_page(export, tmp_path, monkeypatch, capsys):
    (start, goal) = lonlat((-10, 60), (170, 90))
    notebook = with_settings(
        CITY=f'"{export.name}"', READING='{"default_height": 8.0}', ROADS=f'"{export.name}"', PEOPLE="None",
        TERRAIN="0",
        START__GOAL=f"({start[0]}, {start[1]}, 20), ({goal[0]}, {goal[1]}, 20)",
        SOURCES='["Buildings: © OpenStreetMap contributors, https://www.openstreetmap.org/copyright"]',
    )  # fmt: skip
    for cell in notebook.cells:
        if cell.source.startswith("**Answer") and "9" not in cell.source:
            cell.source = cell.source.replace("…", "A courier of mine, 3.5 m from the wall.")
    saved = tmp_path / "my_city.ipynb"
    nbformat.write(run(notebook, tmp_path), saved)
    assert "2 × height of 8 m (default_height)" in printed(notebook)
    monkeypatch.syspath_prepend(NOTEBOOKS)
    spec = importlib.util.spec_from_file_location("notebooks_build", NOTEBOOKS / "build.py")
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    monkeypatch.setattr(sys, "argv", ["build.py", "--page", str(saved)])
    assert build.main() == 0
    assert capsys.readouterr().out.splitlines() == [str(tmp_path / "my_city.html"), "not written yet: Answer 9"]
    assert "Not as the chapter asks" in (tmp_path / "my_city.html").read_text(encoding="utf-8")
    markup = (tmp_path / "my_city.html").read_text(encoding="utf-8")
    page = BeautifulSoup(markup, "html.parser")
    seen = page.get_text()
    assert seen.count("A courier of mine") == 8
    assert "OpenStreetMap contributors" in seen
    assert "How it is marked" not in seen
    assert "uavlab-scene" in markup
    assert "Preflight of" in seen
    outside = [link for tag in page.select("script[src], link[href], img[src]")
               if not (link := tag.get("src") or tag.get("href")).startswith(("data:", "#"))]  # fmt: skip
    assert not outside


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda code: code[1].update(execution_count=None), "wasn't run from top to bottom: Restart"),
        (
            lambda code: code[0].outputs.append(nbformat.v4.new_output("error", ename="E", evalue="", traceback=[])),
            "a cell of .* failed: mend it",
        ),
        (
            lambda code: code[0].outputs.append(
                nbformat.v4.new_output(
                    "execute_result", {"text/plain": "<Scene: …>", "image/png": ""}, execution_count=1
                )
            ),
            "is a still picture yet: Restart",
        ),
    ],
)
def test_a_page_of_what_was_not_run_is_refused(tmp_path, monkeypatch, change, words):
    monkeypatch.syspath_prepend(NOTEBOOKS)
    exported = importlib.import_module("exported")
    code = [nbformat.v4.new_code_cell(f"{n}", execution_count=n) for n in (1, 2)]
    notebook = nbformat.v4.new_notebook(cells=code)
    path = tmp_path / "mine.ipynb"
    nbformat.write(notebook, path)
    assert exported.handed_in(path) == (tmp_path / "mine.html", [])
    change(code)
    nbformat.write(notebook, path)
    with pytest.raises(ValueError, match=words):
        exported.handed_in(path)
    path.write_text("nothing")
    with pytest.raises(ValueError, match="is no notebook"):
        exported.handed_in(path)
    with pytest.raises(ValueError, match="there is no file"):
        exported.handed_in(tmp_path / "other.ipynb")


@pytest.mark.parametrize(
    ("answer", "written"),
    [
        ("**Answer 5.** …", False), ("**Answer 5.**", False), ("Answer 5: ...", False), ("TODO", False), ("", False),
        ("**Answer 5.** TODO: write", True), ("**Answer 5.** 12 % longer.", True), ("The second avoids", True),
        (None, False), ("## Answer", False),
    ],
)  # fmt: skip
def test_answers_that_are_missing_are_found_in_any_form(monkeypatch, answer, written):
    monkeypatch.syspath_prepend(NOTEBOOKS)
    exported = importlib.import_module("exported")
    notebook = jupytext.read(SOURCE)
    for cell in notebook.cells:
        cell.source = cell.source.replace("** …", "** It is so.") if cell.source.startswith("**Answer") else cell.source
    at = next(n for n, cell in enumerate(notebook.cells) if cell.source.startswith("**Answer 5"))
    if answer is None:
        del notebook.cells[at]
    else:
        notebook.cells[at].source = answer
    assert exported.unanswered(notebook) == ([] if written else ["not written yet: Answer 5"])


def test_other_code_than_the_chapter_s_is_listed_but_not_other_settings(monkeypatch):
    monkeypatch.syspath_prepend(NOTEBOOKS)
    exported = importlib.import_module("exported")
    monkeypatch.setattr(exported, "read_project", lambda: jupytext.read(SOURCE).cells)
    notebook = with_settings(
        CELL__MIN_HEIGHT__MAX_HEIGHT="5.0, 20.0, 100.0", GPS_SIGMAS="0.0", DETOUR__CHOICE='0.1, "shortest"'
    )
    assert exported.changed(notebook) == []
    cell = next(cell for cell in notebook.cells if "monte_carlo(curve" in cell.source)
    cell.source = cell.source.replace("rng=1", "rng=2")
    gone = next(n for n, cell in enumerate(notebook.cells) if cell.source.startswith("wind = "))
    del notebook.cells[gone]
    assert exported.changed(notebook) == [
        "code that isn't the chapter's: flights = {",
        "code of the chapter that is gone: wind = Wind.from_weather(WEATHER)",
    ]


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"CITY": '"my_city/buildngs.geojson"'}, r"CITY = 'my_city/buildngs.geojson': there is no such file"),
        ({"DETOUR__CHOICE": '0.2, "Least risk"'}, "CHOICE = 'Least risk' must be"),
        ({"START__GOAL": "(11.00011, 50.00101), (11.0043, 50.00105, 25)"}, r"START = .* must be three numbers"),
        ({"START__GOAL": "(50.00101, 11.00011, 9), (11.0043, 50.00105, 25)"},
         "START = .* off the map.*longitude comes first"),
        ({"START__GOAL": "(11.0037, 50.0016, 25), (11.0043, 50.00105, 25)"},
         r"look at START.*lies in building.*m is \(11\.00\d+, 50\.00\d+, \d+\.\d\) as a setting"),
        ({"TERRAIN": '"no_system.asc"'}, r"TERRAIN_CRS: no_system.asc has no \.prj beside it"),
        ({"TERRAIN": '"no_system.asc"', "TERRAIN_CRS": '"EPSG:4326"'}, "look at CITY, READING, TERRAIN, TERRAIN_CRS: "),
        ({"CITY": '"raw.json"'}, "look at CITY.*raw.json is Overpass' own JSON"),
        ({"PEOPLE": '"no_system.asc"'}, "look at PEOPLE.*no_system.asc"),
    ],
)  # fmt: skip
def test_errors_name_the_settings_to_look_at(tmp_path, monkeypatch, settings, words):
    monkeypatch.chdir(tmp_path)
    Path("raw.json").write_text('{"version": 0.6, "elements": []}')
    Path("no_system.asc").write_text("ncols 2\nnrows 2\nxllcorner 8\nyllcorner 40\ncellsize 0.1\n1 2\n3 4")
    names = {}
    with pytest.raises(ValueError, match=words):  # noqa: PT012
        for cell in with_settings(**settings).cells:
            tags = cell.metadata.get("tags", [])
            if cell.cell_type == "code" and "figure" not in tags and not cell.source.startswith("wind = "):
                exec(compile(cell.source, "cell", "exec"), names)


def test_a_record_of_pvgis_is_read_as_it_is(tmp_path):
    cell = next(cell for cell in cells() if "def wind_record" in cell.source)
    names = {}
    exec(
        "from contextlib import contextmanager\nfrom pathlib import Path\nfrom uavlab.weather import read_weather",
        names,
    )
    exec(cell.source, names)
    rows = ["Latitude (decimal degrees): 44.488", "month,year", "1,2010", "", "time(UTC),T2m,RH,WS10m,WD10m,SP"]
    rows += [f"20100101:0{hour}00,5.2,80,{2 + hour},200,1e5" for hour in range(3)] + [
        "",
        "T2m: 2-m air temperature (°C)",
    ]
    path = tmp_path / "tmy.csv"
    path.write_text("\n".join(rows), encoding="utf-8")
    assert names["wind_record"](path).columns["wind_speed"].tolist() == [2.0, 3.0, 4.0]
    path.write_text("wind speed [m/s]\n4.5\n")
    assert names["wind_record"](path).columns["wind_speed"].tolist() == [4.5]
