"""Files of routes, curves, cities and risk maps: all comes back, and only ValueError comes out of a bad one."""

import warnings
from dataclasses import fields, replace

import numpy as np
import pytest

from uavlab.city import Building, City, NoFlyZone, read_city
from uavlab.planners import ant_colony, astar, repare
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.route import Route
from uavlab.spline import smooth
from uavlab.storage import load, save
from uavlab.vehicle import LIGHT_QUADROTOR


def assert_same(one, other):
    """All that is kept of two things is equal, down to the last bit."""
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        assert np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
        assert one.dtype == other.dtype
    elif isinstance(one, list | tuple):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            assert_same(a, b)
    elif isinstance(one, dict):
        assert list(one) == list(other)
        for key, value in one.items():
            assert_same(value, other[key])
    elif hasattr(one, "__dataclass_fields__"):
        for part in fields(one):
            assert_same(getattr(one, part.name), getattr(other, part.name))
    else:
        assert one == other or (one != one and other != other)


@pytest.fixture(scope="module")
def campus():
    return reference_campus()


@pytest.fixture(scope="module")
def things(table1, campus):
    ends = (90, 18, 30), (20, 75, 75)
    route = astar(table1, *ends, min_clearance=3.5, record=True)
    zone = NoFlyZone([(0, 0), (9, 0), (0, 9)], 5.0, np.inf, holes=[[(1, 1), (2, 1), (1, 2)]], name="pond")
    ground = np.add.outer(np.arange(6.0), np.arange(5.0)) / 4
    hill = City(np.zeros((6, 5, 9), bool), 2.0, (1, 2, -3), reference=(4.36, 52.01, 3.0), ground=ground, no_fly=[zone])
    return {
        "route": route,
        "replanned": repare(table1, *ends, disturbance=lambda clock: "none" if clock < 3 else "mild"),
        "no route": Route.none("A*", "no way", expanded=3),
        "curve": smooth(route, table1, LIGHT_QUADROTOR),
        "city": table1,
        "hill": hill,
        "risk map": replace(campus, uav=campus.uav.loaded(0.5), min_height=5.0),
        "ants": ant_colony(campus, *CAMPUS_FLIGHT, rng=0, budget=30),
    }


NAMES = ("route", "replanned", "no route", "curve", "city", "hill", "risk map", "ants")


@pytest.mark.parametrize("name", NAMES)
def test_what_was_saved_comes_back_to_the_last_bit(name, things, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        save(things[name], tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == [name]  # nothing else is left behind
    assert_same(load(tmp_path / name), things[name])


def test_what_comes_back_is_worked_with_as_before(things, tmp_path, campus):
    save(things["risk map"], tmp_path / "map.npz")
    back = load(str(tmp_path / "map.npz"))
    assert back.integral(things["ants"]) == things["risk map"].integral(things["ants"])
    save(things["city"], tmp_path / "city.npz")
    assert astar(load(tmp_path / "city.npz"), (90, 18, 30), (20, 75, 75)).length == pytest.approx(119.213, abs=1e-3)


def test_a_city_that_was_read_keeps_its_report(tmp_path):
    text = '{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"height": 9}, "geometry": '
    text += '{"type": "Polygon", "coordinates": [[[4.36, 52], [4.361, 52], [4.361, 52.001], [4.36, 52]]]}}]}'
    (tmp_path / "a.geojson").write_text(text)
    city = read_city(tmp_path / "a.geojson", cell=5.0)
    save(city, tmp_path / "a.npz")
    assert_same(load(tmp_path / "a.npz"), city)
    assert str(load(tmp_path / "a.npz").source) == str(city.source)


def test_what_cannot_be_saved_of_info_is_said(tmp_path):
    route = Route([(0, 0, 0), (1, 1, 1)], info={"expanded": 3, "why": object(), "city": {"a": [1.5, np.inf, None]}})
    with pytest.warns(UserWarning, match="left out of info, as it can't be saved: why"):
        save(route, tmp_path / "route.npz")
    assert load(tmp_path / "route.npz").info == {"expanded": 3, "city": {"a": [1.5, np.inf, None]}}


def test_an_old_file_is_kept_where_the_new_one_fails(tmp_path, monkeypatch):
    save(Route([(0, 0, 0), (1, 1, 1)]), tmp_path / "route.npz")
    monkeypatch.setattr("numpy.savez_compressed", lambda *_, **__: (_ for _ in ()).throw(OSError("disk full")))
    with pytest.raises(OSError, match="disk full"):
        save(Route([(0, 0, 0), (2, 2, 2)]), tmp_path / "route.npz")
    assert load(tmp_path / "route.npz").points[-1].tolist() == [1, 1, 1]
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("thing", [Building.prism([(0, 0), (1, 0), (0, 1)], 3.0), LIGHT_QUADROTOR, Route, None, [1]])
def test_other_things_are_refused(thing, tmp_path):
    with pytest.raises(ValueError, match="thing must be a Route, a Curve, a City or a RiskMap, got"):
        save(thing, tmp_path / "thing.npz")
    assert not list(tmp_path.iterdir())


def test_names_of_files_are_names(tmp_path):
    for wrong in (2, None, b"route.npz"):
        with pytest.raises(ValueError, match="path must be the name of a file"):
            save(Route([(0, 0, 0)]), wrong)
        with pytest.raises(ValueError, match="path must be the name of a file"):
            load(wrong)
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "none.npz")


def test_only_value_errors_come_out_of_files_that_were_changed(things, tmp_path):
    """Cut off, bits turned, other files, other headers, pickles."""
    path, broken = tmp_path / "hill.npz", tmp_path / "broken.npz"
    save(things["hill"], path)
    whole, rng = path.read_bytes(), np.random.default_rng(0)
    contents = [b"", b"PK", b"\x93NUMPY", whole[:-1], whole[: len(whole) // 2], b"x" * 1000]
    for _ in range(400):
        changed = np.frombuffer(whole, np.uint8).copy()
        changed[rng.integers(len(changed), size=rng.integers(1, 9))] = rng.integers(256)
        contents.append(changed.tobytes())
    said = []
    for content in contents:
        broken.write_bytes(content)
        try:
            load(broken)
        except ValueError as error:
            said.append(str(error))
    assert len(said) > len(contents) / 2
    assert all("broken.npz is no file of uavlab.storage.save, or damaged" in words for words in said)


@pytest.mark.parametrize(
    "header",
    [
        "[]", "{}", '{"version": 1}', '{"version": 2, "thing": null}', '{"version": 1, "thing": 3}', "{", "[[[[",
        '{"version": 1, "thing": {"kind": "eval", "fields": {}}}', '{"version": 1, "thing": {"kind": "Route"}}',
        '{"version": 1, "thing": {"kind": "Route", "fields": {"points": {"array": "none"}}}}',
        '{"version": 1, "thing": {"kind": "Route", "fields": {"points": {"list": [1, 2]}}}}',
        '{"version": 1, "thing": {"kind": "Route", "fields": {"planner": "A*", "colour": 1}}}',
        '{"version": 1, "thing": {"list": [], "tuple": []}}', '{"version": 1, "thing": {"float": "many"}}',
        '{"version": 1, "thing": {"kind": "UAV", "fields": {"mass": 1}}}',
        '{"version": 1, "thing": ' + 50 * '{"list": [' + "1" + 50 * "]}" + "}",
    ],
)  # fmt: skip
def test_headers_that_say_what_cannot_be_are_refused(header, tmp_path):
    np.savez(tmp_path / "a.npz", uavlab=np.frombuffer(header.encode(), np.uint8))
    with pytest.raises(ValueError, match=r"a\.npz (is no file of|holds a)"):
        load(tmp_path / "a.npz")


def test_pickles_are_not_opened(tmp_path):
    np.savez(tmp_path / "a.npz", uavlab=np.array([print], dtype=object))
    with pytest.raises(ValueError, match=r"a\.npz is no file"):
        load(tmp_path / "a.npz")
