"""The cache of compiled code: dropped when it is old, done without where nothing can be written."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import uavlab
from uavlab.compiled import discard_stale

PACKAGE = Path(uavlab.__file__).parent

SMALL_SEARCH = """
import json, warnings
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    import numpy as np
    import uavlab
    from uavlab.city import City
    from uavlab.planners import astar, shortcut
    occupied = np.zeros((5, 5, 1), bool)
    occupied[2, :4] = True
    city = City(occupied)
    route = astar(city, (0.5, 0.5, 0.5), (4.5, 0.5, 0.5))
    short = shortcut(route, city)
print(json.dumps({
    "package": uavlab.__file__,
    "cost": route.cost,
    "short": short.points.tolist(),
    "warnings": [[w.category.__name__, str(w.message)] for w in caught],
}))
"""


def run(folder, script, **environment):
    """Run a script with the package that lies in a folder; what it printed."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=folder,
        env={**kept, "PYTHONPATH": str(folder), **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def read_only_package(tmp_path):
    """A copy of the package beside which no cache folder can be made, not even by root: files stand in their places."""
    copy = tmp_path / "uavlab"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    for folder in [copy, *(path for path in copy.rglob("*") if path.is_dir())]:
        (folder / "__pycache__").write_text("not a folder")
    return tmp_path


def test_without_a_cache_folder_everything_works_after_one_warning(read_only_package):
    nowhere = os.devnull + "/nowhere"
    homes = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA", "USERPROFILE"), nowhere)
    result = json.loads(run(read_only_package, SMALL_SEARCH, **homes))
    assert Path(result["package"]).is_relative_to(read_only_package)
    assert result["cost"] == pytest.approx(8 + 2 * 2**0.5)  # around the end of the wall
    assert result["short"] == [[0.5, 0.5, 0.5], [1.5, 4.5, 0.5], [3.5, 4.5, 0.5], [4.5, 0.5, 0.5]]
    about_cache = [[category, text] for category, text in result["warnings"] if "numba" in text.lower()]
    assert [category for category, _ in about_cache] == ["RuntimeWarning"]
    assert "set NUMBA_CACHE_DIR to a folder you may write" in about_cache[0][1]


@pytest.fixture
def package(tmp_path):
    """A copy of the package without anything compiled, to spoil."""
    shutil.copytree(PACKAGE, tmp_path / "uavlab", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
def test_damaged_compiled_code_is_made_anew(package, suffix):
    first = run(package, SMALL_SEARCH)
    damaged = sorted(package.rglob(f"*.{suffix}"))
    assert damaged
    for number, path in enumerate(damaged):
        whole = path.read_bytes()
        path.write_bytes((whole[: len(whole) // 2], b"", b"garbage" * 50)[number % 3])
    assert run(package, SMALL_SEARCH) == first
    mended = {path: path.stat().st_mtime_ns for path in package.rglob("*.nbi")}
    assert run(package, SMALL_SEARCH) == first
    assert {path: path.stat().st_mtime_ns for path in package.rglob("*.nbi")} == mended


def test_a_source_from_the_future_doesnt_make_it_compile_each_time(package):
    os.utime(package / "uavlab" / "checks.py", (2e9 + 1e9, 2e9 + 1e9))
    first = run(package, SMALL_SEARCH)
    compiled = {path: path.stat().st_mtime_ns for path in package.rglob("*.nbi")}
    assert run(package, SMALL_SEARCH) == first
    assert {path: path.stat().st_mtime_ns for path in package.rglob("*.nbi")} == compiled


def test_it_runs_uncompiled_for_a_debugger(package):
    told = json.loads(run(package, SMALL_SEARCH, NUMBA_DISABLE_JIT="1"))
    assert told["cost"] == pytest.approx(8 + 2 * 2**0.5)
    assert told["warnings"] == []
    assert not list(package.rglob("*.nbi"))


def test_an_edit_in_another_file_is_not_hidden_by_the_cache(tmp_path):
    package = tmp_path / "uavlab"
    package.mkdir()
    (package / "__init__.py").touch()
    shutil.copy(PACKAGE / "compiled.py", package)
    header = "from uavlab.compiled import compiled\n"
    inner = header + "@compiled\ndef inner(): return {}\n"
    outer = header + "from uavlab.inner import inner\n@compiled\ndef outer(): return inner() + 1\n"
    call = "from uavlab.outer import outer; print(outer())"
    (package / "outer.py").write_text(outer)
    (package / "inner.py").write_text(inner.format(1))
    assert run(tmp_path, call) == "2\n"
    assert list(package.glob("__pycache__/outer*.nbi"))
    (package / "inner.py").write_text(inner.format(41))
    an_hour_ago = (package / "inner.py").stat().st_mtime - 3600
    for index in package.glob("__pycache__/*.nbi"):
        os.utime(index, (an_hour_ago, an_hour_ago))
    assert run(tmp_path, call) == "42\n"


def test_compiled_code_older_than_the_newest_source_is_dropped(tmp_path):
    newest = max(source.stat().st_mtime for source in PACKAGE.rglob("*.py"))
    for name, age in {"old.nbi": 10, "old.nbc": 10, "just_as_new.nbi": 0, "new.nbi": -10}.items():
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (newest - age, newest - age))
    discard_stale(tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {"old.nbc", "just_as_new.nbi", "new.nbi"}


def test_compiled_code_that_another_process_drops_meanwhile_is_no_error(tmp_path):
    (tmp_path / "gone.nbi").symlink_to(tmp_path / "dropped by another")
    discard_stale(tmp_path)


EVERYTHING = """
import json, sys, warnings
if sys.argv[1:] == ["without"]:
    sys.modules["numba"] = None  # an import of it fails
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    import numpy as np
    from uavlab import planners
    from uavlab.city import Building, City
    from uavlab.flight import OffsetProcess, fly
    from uavlab.risk import RiskMap
    from uavlab.spline import smooth
    from uavlab.vehicle import LIGHT_QUADROTOR
    from uavlab.weather import Wind
ends = (3.0, 3.0, 3.0), (13.0, 13.0, 5.0)
tower = Building.prism([(6, 6), (10, 6), (10, 10), (6, 10)], 8.0)
city = City.from_buildings([tower], cell=2.0, origin=(0, 0, 0), size=(16, 16, 12))
risk_map = RiskMap(city, np.linspace(0, 0.01, 64).reshape(8, 8), 0.2, safe_height=0.0)
route = planners.astar(city, *ends, min_clearance=0.6)
routes = [
    route,
    planners.shortcut(route, city),
    planners.theta_star(city, *ends, min_clearance=0.6),
    planners.potential_field(city, *ends),
    planners.repare(city, *ends, disturbance="none"),
    planners.hazard_astar(city, *ends, sigma=0.2, uav_diameter=0.5),
    planners.least_energy(city, *ends, LIGHT_QUADROTOR, Wind((2.0, 1.0))),
    planners.least_risk(risk_map, *ends),
    planners.least_risk(risk_map, *ends, drift=True, max_length=25.0),
    planners.ant_colony(risk_map, *ends, rng=0, budget=60),
    planners.waypoint_swarm(risk_map, *ends, rng=0, budget=300, arcs=50),
]
curve = smooth(route, city, LIGHT_QUADROTOR, min_clearance=0.55)
gusts = Wind(gusts="dryden", mean=(2, 0)), OffsetProcess(0.1)
flights = [fly(curve, city, LIGHT_QUADROTOR, each, rng=1) for each in gusts]
print(json.dumps({
    "points": [route.points.round(6).tolist() for route in routes],
    "reached": [route.reached for route in routes],
    "flights": [[flight.outcome, round(flight.clearance, 6), flight.log[-1, 0]] for flight in flights],
    "slow": [str(w.message) for w in caught if "numba" in str(w.message)],
}))
"""


def test_without_numba_everything_works_slowly_after_one_warning():
    runs = [
        json.loads(
            subprocess.run(
                [sys.executable, "-c", EVERYTHING, *arguments],
                capture_output=True,
                text=True,
                check=True,
                cwd=PACKAGE.parent,
            ).stdout
        )
        for arguments in ([], ["without"])
    ]
    compiled, plain = runs
    assert plain["reached"] == compiled["reached"]
    assert sum(plain["reached"]) >= 9
    assert plain["points"] == compiled["points"]
    assert plain["flights"] == compiled["flights"]
    assert compiled["slow"] == []
    assert len(plain["slow"]) == 1
    assert "plain Python" in plain["slow"][0]
