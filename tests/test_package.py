"""A wheel, built and installed in another environment, holds the whole package and imports."""

import json
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

IMPORT_ALL = """
import importlib, json, pkgutil, traceback
import uavlab
files, failures = {"uavlab": uavlab.__file__}, {}
for module in pkgutil.walk_packages(uavlab.__path__, "uavlab.", onerror=lambda name: None):
    try:
        files[module.name] = importlib.import_module(module.name).__file__
    except Exception:
        failures[module.name] = traceback.format_exc()
print(json.dumps({"files": files, "failures": failures}))
"""


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A fresh environment with the wheel in it, and the folder into which it was installed.

    Dependencies come from the environment that runs the tests, by a path file. Path files inside it are not read, so
    its own uavlab, installed from this checkout, stays out of sight.
    """
    wheels, environment = tmp_path_factory.mktemp("wheels"), tmp_path_factory.mktemp("environment")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    run(*pip, "wheel", ROOT, "--no-deps", "--no-build-isolation", "--no-index", "-w", wheels)
    (wheel,) = wheels.glob("uavlab-*.whl")
    venv.create(environment, with_pip=False)
    python = environment / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    run(*pip, "--python", python, "install", "--no-deps", "--no-index", wheel)
    folder = Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    (folder / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return python, folder


def test_every_module_imports_from_the_wheel(installed):
    python, folder = installed
    found = json.loads(run(python, "-I", "-c", IMPORT_ALL))
    assert found["failures"] == {}
    assert all(Path(file).is_relative_to(folder) for file in found["files"].values())
    sources = (ROOT / "uavlab").rglob("*.py")
    modules = {".".join(source.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__") for source in sources}
    assert set(found["files"]) == modules


def test_the_wheel_holds_the_package_alone(installed):
    _, folder = installed
    (record,) = folder.glob("uavlab-*.dist-info/RECORD")
    tops = {line.split("/")[0] for line in record.read_text(encoding="utf-8").splitlines()}
    assert {top for top in tops if not top.startswith("..")} == {"uavlab", record.parent.name}


def test_the_metadata_name_the_version_of_the_package(installed):
    python, _ = installed
    call = "import importlib.metadata, uavlab; print(uavlab.__version__, importlib.metadata.version('uavlab'))"
    package, metadata = run(python, "-I", "-c", call).split()
    assert package == metadata
