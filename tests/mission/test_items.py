"""Numbers of items as they travel: what is read back equals what was written."""

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from missions import DELFT, SQUARE, plain

from uavlab.city import Place
from uavlab.mission import FencePolygon, Item, Mission
from uavlab.mission.items import checked_item, checked_polygon, has_place, kept, longitude_on_wire, on_wire


@given(st.floats(width=32, allow_infinity=False))
def test_what_is_kept_is_kept_by_32_bits(value):
    """Once written, read and written again nothing changes any more."""
    once = kept(value)
    travelled = struct.unpack("<f", struct.pack("<f", once))[0]
    assert once is math.nan or (kept(once) == once == kept(travelled) and abs(once - value) <= 5.001e-4)
    assert math.copysign(1.0, once) > 0 or once != 0


@given(st.floats(-540.0, 540.0))
def test_longitudes_go_round(degrees):
    once = longitude_on_wire(degrees)
    assert -180.0 <= once < 180.0
    assert longitude_on_wire(once) == once
    assert abs((once - degrees + 180.0) % 360.0 - 180.0) <= 0.51e-7
    assert round(once * 1e7) == pytest.approx(once * 1e7, abs=1e-4)


@pytest.mark.parametrize(
    ("given_", "kept_"),
    [(179.99999999, -180.0), (-180.0, -180.0), (180.0, -180.0), (540.0, -180.0), (181.5, -178.5), (-0.00000001, 0.0)],
)
def test_longitudes_at_the_date_line(given_, kept_):
    item = plain(items=(Item(16, 3, (0, 2, 0, 0), -17.7, given_, 30.0),)).items[0]
    assert item.longitude == kept_
    assert math.copysign(1.0, item.longitude) == math.copysign(1.0, kept_)
    assert plain(home=Place(given_, 1.0)).home.longitude == kept_


def test_degrees_are_kept_to_a_centimetre():
    assert on_wire(52.123456789) == 52.1234568
    item = checked_item("item", Item(16, 3, (0.12345, 2, 0, math.nan), 52.123456789, 4.987654321, 30.00049))
    assert item == (16, 3, (0.123, 2.0, 0.0, math.nan), 52.1234568, 4.9876543, 30.0)
    assert item.parameters[3] is math.nan


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("waypoint", r"items\[0\] must be an? Item, got str"),
        (Item("16"), r"items\[0\]\.command must be a whole number"),
        (Item(70_000), r"items\[0\]\.command must be at most 65,535"),
        (Item(-1), r"items\[0\]\.command must be a whole number of at least 0"),
        (Item(16, 256), r"items\[0\]\.frame must be at most 255"),
        (Item(16, 3.0), r"items\[0\]\.frame must be a whole number"),
        (Item(16, True), r"items\[0\]\.frame must be a whole number"),
        (Item(16, 3, (0, 0, 0)), r"items\[0\]\.parameters must have shape \(4,\)"),
        (Item(16, 3, (0, 0, 0, math.inf)), r"items\[0\]\.parameters must not be infinite"),
        (Item(16, 3, (0, 0, 0, -1e39)), r"items\[0\]\.parameters must not be infinite, or too large for 32 bits"),
        (
            Item(16, 3, (0, 0, 0, 0), 90.1),
            r"items\[0\]: latitude must be from -90 to 90 degrees \(the order is latitude",
        ),
        (Item(16, 3, (0, 0, 0, 0), 0, 541), r"items\[0\]: longitude must be from -540 to 540"),
        (Item(16, 3, (0, 0, 0, 0), math.nan), r"items\[0\]: latitude must be from -90"),
        (Item(16, 3, (0, 0, 0, 0), 0, 0, 20_001), r"items\[0\]\.altitude must be from -20000 to 20000 m"),
        (Item(16, 3, (0, 0, 0, 0), 0, 0, math.nan), r"items\[0\]\.altitude must be from"),
    ],
)
def test_an_item_that_cant_travel_is_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        Mission((wrong,), DELFT)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("fence", r"fence\[0\] must be a FencePolygon"),
        (SQUARE._replace(corners=SQUARE.corners[:2]), r"fence\[0\] must have at least three different corners, got 2"),
        (SQUARE._replace(corners=SQUARE.corners[:2] * 2), "at least three different corners, got 2"),
        (SQUARE._replace(corners=5), r"fence\[0\](\.corners)? must be a list of"),
        (SQUARE._replace(corners=((1, 2, 3),) * 3), r"fence\[0\]\.corners must have shape \(2,\)"),
        (SQUARE._replace(corners=((91, 2), (1, 2), (3, 4))), r"fence\[0\]\.corners: latitude must be"),
        (SQUARE._replace(inclusion=1), r"fence\[0\]\.inclusion must be True or False"),
        (SQUARE._replace(name=5), r"fence\[0\]\.name must be text"),
    ],
)
def test_a_polygon_that_is_none_is_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        plain(fence=(wrong,))


def test_polygons_are_kept_as_they_travel():
    found = checked_polygon("fence", FencePolygon(((1.00000004, 181.0), (2, 3), (4, 5)), np.True_))
    assert found.corners == ((1.0, -179.0), (2.0, 3.0), (4.0, 5.0))
    assert found.inclusion is True


@pytest.mark.parametrize(
    ("item", "place"),
    [
        (Item(16, 3), True),
        (Item(21, 0), True),
        (Item(20), False),
        (Item(178, 2, (1, 5, -1, 0)), False),
        (Item(201, 3, (0, 0, 0, 0), 52.0, 4.0, 5.0), True),  # a region of interest
        (Item(205, 2, (-45, 0, 0, 0), 0.0, 0.0, 2.0), False),
    ],
)
def test_which_items_have_a_place(item, place):
    assert has_place(item) is place


@pytest.mark.parametrize(
    ("item", "words"),
    [
        (
            Item(16, 3, (0, 2, 0, 90), 52.5, -13.25, 30),
            "<Item: waypoint at 52.5000000°, -13.2500000°, 30.0 m above home>",
        ),
        (
            Item(16, 0, (2.5, 0, 0, 0), 1, 2, 3),
            "<Item: waypoint at 1.0000000°, 2.0000000°, 3.0 m above sea, hold 2.5 s>",
        ),
        (Item(22, 10, (0, 0, 0, 0), 1, 2, 3), "<Item: take off at 1.0000000°, 2.0000000°, 3.0 m above terrain>"),
        (Item(21, 9, (0, 0, 0, 0), 1, 2, 3), "<Item: land at 1.0000000°, 2.0000000°, 3.0 m above frame 9>"),
        (Item(178, 2, (1, 5.5, -1, 0)), "<Item: change speed to 5.5 m/s>"),
        (Item(20), "<Item: return>"),
        (Item(206, 2, (5, 0, 0, 0)), "<Item: command 206>"),
        (Item(17, 3), "<Item: stay at 0.0000000°, 0.0000000°, 0.0 m above home>"),
    ],
)
def test_items_in_words(item, words):
    assert repr(item) == words


def test_polygons_in_words():
    assert repr(SQUARE) == "<FencePolygon fence: stay inside of 4 corners>"
    assert repr(SQUARE._replace(inclusion=False, name="school")) == "<FencePolygon school: stay outside of 4 corners>"
