"""What a live scene's page is made of, and what it refuses; how it answers is tested in tests/browser/test_live.py."""

import json

import numpy as np
import pytest
from decoding import unpacked

from uavlab.city import City, NoFlyZone, table1_city
from uavlab.flight import Autopilot
from uavlab.flight.simulation import setup_of
from uavlab.planners import astar
from uavlab.risk import CAMPUS_FLIGHT, reference_campus
from uavlab.scene import live, live_curve
from uavlab.scene.live_offers import CONDITIONS, OFFERS, SLIDERS, conditions_told, settings_of
from uavlab.scene.live_parts import MOST_VOXELS
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import Wind
from uavlab.web import module

ENDS = (90.5, 18.5, 30.5), (50.5, 44.5, 30.5)
BY_RISK = [name for name, offer in OFFERS.items() if offer.kind == "risk"]
PLAIN = [name for name in OFFERS if name not in BY_RISK]


@pytest.fixture(scope="module")
def city():
    return table1_city()


@pytest.fixture(scope="module")
def campus():
    return reference_campus()


def test_page_of_a_small_city_is_small_and_the_same_each_time(city):
    scene = live(city, *ENDS, planners=PLAIN, flights=200, expansions=True)
    assert len(scene.page) < 600_000
    assert "http://" not in scene.page.replace("http://www.w3.org", "")
    assert scene.page == live(city, *ENDS, planners=PLAIN, flights=200, expansions=True).page
    assert scene.still.startswith(b"\x89PNG")
    assert "A*: 69.8 m" in scene.words


def test_page_of_a_campus_is_small(campus):
    assert len(live(campus.city, *CAMPUS_FLIGHT, planners=BY_RISK, risk=campus, flights=200).page) < 600_000


def test_settings_and_offers_are_told(city):
    scene = live(city, *ENDS, planners=["A*", "REPARE"], shown=["REPARE"], settings={"keep": 3.5, "conditions": 2})
    told = json.loads(unpacked(scene.page, "told"))
    assert [(offer["name"], offer["shown"]) for offer in told["offers"]] == [("A*", False), ("REPARE", True)]
    assert {slider["name"]: slider["value"] for slider in told["sliders"]} == {"keep": 3.5, "conditions": 2.0}
    assert told["ends"] == [["start", list(ENDS[0])], ["goal", list(ENDS[1])]]
    assert "flights" not in told


def test_the_city_is_told_to_the_bit(city):
    zone = NoFlyZone([(20, 20), (40, 20), (40, 40)], name="airfield")
    closed = City(city.occupied, no_fly=[zone])
    scene = live(closed, *ENDS)
    told, kept = json.loads(unpacked(scene.page, "told")), unpacked(scene.page, "kept")
    for name, flags in (("occupied", closed.occupied), ("closed", closed.in_no_fly), ("zones", closed.in_no_fly)):
        begin = told["arrays"][name]
        bits = np.unpackbits(np.frombuffer(kept, np.uint8, -(-flags.size // 8), begin))[: flags.size]
        assert np.array_equal(bits.reshape(flags.shape), flags)


def test_flights_touch_at_the_distance_of_pythons(city):
    told = json.loads(unpacked(live(city, *ENDS, flights=5).page, "told"))["flights"]
    route, calm = astar(city, *ENDS), Wind((0.0, 0.0), deviation=0.0)
    setup, _ = setup_of(route, city, LIGHT_QUADROTOR, calm, Autopilot(), told["step"])
    assert (told["touching"], told["near"]) == (setup.obstacles.touching, setup.obstacles.near_goal)


def test_each_of_repares_conditions_flies():
    assert [one["label"].split()[0] for one in conditions_told()] == [load for load, _ in CONDITIONS]
    assert all(one["distance"] > 0 for one in conditions_told())


@pytest.mark.parametrize("name", PLAIN)
def test_a_call_is_what_plans(city, name):
    now = settings_of([name], False, None)
    offer = OFFERS[name]
    for keep in {now.get("keep", 1.0), 0.0}:
        settings = now | ({"keep": keep} if "keep" in now else {})
        call = offer.python[-1] if keep == 0 else offer.python[0]
        words = {"start": ENDS[0], "goal": ENDS[1], **settings, "conditions": conditions_told()[0]["python"]}
        names = {"city": city}
        exec(f"{offer.imports}\nroute = {call.format(**words)}", names)
        assert np.array_equal(names["route"].points, offer.plan(city, *ENDS, settings).points)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"planners": "A*"}, "planners must be a list of names"),
        ({"planners": []}, "planners must be a list of names"),
        ({"planners": ["A"]}, "planners must be one of "),
        ({"planners": ["least risk"]}, "'least risk' needs risk="),
        ({"shown": ["REPARE"]}, r"shown: \['REPARE'\] aren't among planners"),
        ({"settings": {"sigma": 1.0}}, "settings: 'sigma' is none of those that this scene has: keep"),
        ({"settings": {"keep": 9.0}}, r"settings\['keep'\] must be "),
        ({"settings": [1]}, "settings must be numbers by name"),
        ({"flights": 1001}, "flights must be "),
        ({"expansions": 1}, "expansions must be True or False"),
        ({"risk": 1}, "risk must be a RiskMap"),
        ({"uav": 1}, "uav must be a UAV"),
        ({"camera": "chase"}, "follows a UAV"),
        ({"title": 3}, "title must be "),
    ],
)
def test_wrong_arguments_are_named(city, wrong, words):
    with pytest.raises(ValueError, match=words):
        live(city, *ENDS, **wrong)


def test_ends_are_refused_as_by_planners(city):
    with pytest.raises(ValueError, match=r"start .* lies in building") as refusal:
        live(city, (80.5, 40.5, 30.5), ENDS[1])
    with pytest.raises(ValueError, match="lies in building") as same:
        astar(city, (80.5, 40.5, 30.5), ENDS[1], min_clearance=2.0)
    assert str(refusal.value) == str(same.value)
    with pytest.raises(ValueError, match=r"goal .* lies outside of the map"):
        live(city, ENDS[0], (500, 0, 0))


def test_a_risk_map_has_its_own_planners_and_city(campus, city):
    with pytest.raises(ValueError, match="'A\\*' doesn't know of people"):
        live(campus.city, *CAMPUS_FLIGHT, risk=campus)
    with pytest.raises(ValueError, match="risk must be a map of this city"):
        live(city, *ENDS, risk=campus, planners=["least risk"])


def test_a_city_too_large_is_told_a_cell_that_fits():
    large = City(np.zeros((300, 300, 80), bool), cell=2.0)
    with pytest.raises(ValueError, match=r"make it with cell=[\d.]+$") as refusal:
        live(large, (1, 1, 1), (500, 500, 100))
    cell = float(str(refusal.value).split("cell=")[1])
    assert np.prod(np.ceil(np.array(large.shape) * 2.0 / cell)) <= 1.03 * MOST_VOXELS


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"control": [(5, 5, 5), (9, 9, 9)]}, "control must be 3 to 40 points on the map, got 2"),
        ({"control": [(5, 5, 5), (9, 9, 9), (900, 9, 9)]}, "got 3 of which 2 lie on it"),
        ({"control": [(5, 5), (9, 9), (9, 9)]}, "control must have shape"),
        ({"step": 0.001}, "step must leave at most 20,000 points"),
        ({"step": 0.0}, "step must be "),
        ({"bank": 2.0}, "bank must be "),
        ({"colors": {"curve": "none such"}}, "must be a colour"),
    ],
)
def test_wrong_curves_are_named(city, wrong, words):
    given = {"control": [(5, 60, 30), (30, 60, 40), (60, 60, 30)]} | wrong
    with pytest.raises(ValueError, match=words):
        live_curve(city, **given)


def test_own_uav_is_called_so(city):
    heavy = LIGHT_QUADROTOR.loaded(0.5)
    told = json.loads(unpacked(live(city, *ENDS, flights=20, uav=heavy).page, "told"))
    assert "city, uav, wind" in told["flights"]["python"]
    assert not any("LIGHT_QUADROTOR" in line for line in told["flights"]["imports"])


def test_a_module_of_another_version_is_refused_by_name(monkeypatch):
    monkeypatch.setattr(module, "__version__", "9.9")
    module.facts_on.cache_clear()
    with pytest.raises(RuntimeError, match=r"planners.wasm was made for uavlab .*, this is 9\.9"):
        module.facts_on()
    monkeypatch.undo()
    monkeypatch.setattr(module, "wasm_bytes", lambda: b"other")
    with pytest.raises(RuntimeError, match=r"isn't the one that planners\.json tells of"):
        module.facts_on()
    monkeypatch.undo()
    module.facts_on.cache_clear()
    assert module.facts_on()["functions"]


def test_sliders_begin_within_their_range():
    assert all(one.least <= one.value <= one.most for one in SLIDERS.values())
