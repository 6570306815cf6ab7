"""`planners.wasm` is what the library's functions give, small, and asks a page for nothing that it hasn't."""

import gzip
import json
import re
import shutil
import subprocess
import sys

import llvmlite
import numba
import pytest

from uavlab import __version__
from uavlab.web import build as building
from uavlab.web.build import FACTS, WASM, arguments_of, build, functions, intermediate, kind_of, main, result_of

WITHOUT_LINKER = "no wasm-ld on this machine: apt-get install lld, then run these tests again"


@pytest.fixture(scope="module")
def facts():
    return json.loads(FACTS.read_text(encoding="utf-8"))


def sections(code):
    """Numbers of the sections of a module and their bytes."""
    at = 8
    while at < len(code):
        number = code[at]
        size, at = leb128(code, at + 1)
        yield number, code[at : at + size]
        at += size


def leb128(code, at):
    """A number of as many bytes as it takes, and where it ends."""
    value = shift = 0
    while True:
        byte = code[at]
        value |= (byte & 127) << shift
        at, shift = at + 1, shift + 7
        if byte < 128:
            return value, at


def names_in(section, skipped):
    """Of imports or exports; `skipped` reads over what follows a name."""
    count, at = leb128(section, 0)
    names = []
    for _ in range(count):
        texts = []
        for _ in range(2 if skipped == "import" else 1):
            size, at = leb128(section, at)
            texts.append(section[at : at + size].decode())
            at += size
        _, at = leb128(section, at + 1)  # after the kind
        names.append(texts[-1])
    return names


@pytest.fixture(scope="module")
def parts():
    return dict(sections(WASM.read_bytes()))


def test_the_committed_module_is_what_the_functions_give(tmp_path, facts):
    """In a process of its own, as numba reads how it is set up when it is imported."""
    if shutil.which("wasm-ld") is None:
        pytest.skip(WITHOUT_LINKER)
    linker = subprocess.run(["wasm-ld", "--version"], capture_output=True, text=True, check=True).stdout
    here = {
        "uavlab": __version__,
        "numba": numba.__version__,
        "llvmlite": llvmlite.__version__,
        "lld": re.findall(r"[\d.]+\d", linker)[0],
    }
    if here != facts["made_by"]:
        pytest.skip(f"planners.wasm was made by {facts['made_by']}, here are {here}: other bytes would say nothing")
    wasm, json_ = tmp_path / "planners.wasm", tmp_path / "planners.json"
    program = f"""
from pathlib import Path
from uavlab.web import build
build.WASM, build.FACTS = Path({str(wasm)!r}), Path({str(json_)!r})
build.build.__defaults__ = build.WASM, build.FACTS
build.build()
"""
    settings = building.os.environ | building.PLAIN | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    subprocess.run([sys.executable, "-W", "ignore", "-c", program], env=settings, check=True)
    assert json_.read_bytes() == FACTS.read_bytes()
    assert wasm.read_bytes() == WASM.read_bytes(), "python -m uavlab.web.build, and commit what it makes"


def test_it_is_small():
    code = WASM.read_bytes()
    assert len(code) <= 150_000
    assert len(gzip.compress(code, 9)) <= 60_000


def test_a_page_gives_all_that_it_asks_for(parts):
    page = (WASM.parent / "planners.js").read_text(encoding="utf-8")
    given = re.search(r"const given = \{(.*?)\n  \};", page, re.DOTALL)[1]
    names = set(re.findall(r"(\w+)(?:\(bytes\) \{|:)", given))
    assert {"NRT_MemInfo_alloc_aligned", "NRT_MemInfo_call_dtor", "NRT_Allocate", "NRT_Free", "exp"} <= names
    asked = names_in(parts[2], "import")
    errors = [name for name in asked if name not in names]
    assert all("raise_with_shape_context" in name for name in errors), f"planners.js hasn't {errors}"
    assert not names - set(asked), "planners.js gives what nobody asks for"


def test_it_has_all_functions_and_nothing_else(parts, facts):
    assert set(names_in(parts[7], "export")) == {*functions(), "memory", "__heap_base"}
    assert set(facts["functions"]) == set(functions())


def test_signatures_are_those_of_the_functions(facts):
    for name, function in functions().items():
        takes = [[argument, *kind_of(hint)] for argument, hint in arguments_of(function).items()]
        assert facts["functions"][name] == {"takes": takes, "gives": kind_of(result_of(function))[0]}
    assert facts["functions"]["nearest"] == {
        "takes": [["blocked", "boolean", 3], ["point", "float64", 1], ["origin", "float64", 1], ["cell", "float64", 0]],
        "gives": "int32",
    }
    assert facts["functions"]["measure"]["gives"] == "float64"


def test_without_a_linker_it_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr(building.shutil, "which", lambda name: None)
    with pytest.raises(RuntimeError, match=r"wasm-ld isn't there.* package lld"):
        build(tmp_path / "planners.wasm", tmp_path / "planners.json")
    assert list(tmp_path.iterdir()) == []


def test_it_is_built_in_a_process_with_plain_settings(monkeypatch):
    asked = []
    monkeypatch.setattr(building.subprocess, "run", lambda *told, **options: asked.append((told, options)))
    main()
    ((told, options),) = asked
    assert told[0][0] == sys.executable
    assert "build()" in told[0][-1]
    assert options["check"]
    assert options["env"].items() >= building.PLAIN.items()
    assert options["env"]["NUMBA_CACHE_DIR"]


def test_intermediate_code_names_no_machine():
    text = intermediate("nearest", functions()["nearest"])
    assert re.search(r"^define [^\n]*@nearest\(", text, re.MULTILINE)
    assert not re.search(r'target (triple|datalayout)|"target-(cpu|features)"|= common |atomicrmw', text)
    assert not re.search(r"(?<!\n)@\.const\.picklebuf", text)
