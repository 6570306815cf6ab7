"""The city of REPARE Table 1: five buildings of different shapes in 100 × 100 × 100 m."""

from __future__ import annotations

from uavlab.city.buildings import Building
from uavlab.city.model import City


def table1_buildings() -> tuple[Building, ...]:
    """The five buildings of REPARE Table 1, in the paper's order; colours are pale, so that routes stand out.

    Building 1 is an L with a ridge along both wings. Its two wings are convex: each is the hull of its walls to
    65 m and of its half of the ridge at 70 m.

    Returns
    -------
    tuple of Building

    See Also
    --------
    table1_city : their map.

    Examples
    --------
    >>> from uavlab.city import table1_buildings
    >>> [building.name for building in table1_buildings()]
    ['1 notch', '2 hip roof', '3 frustum', '4 floating', '5 spire']
    >>> table1_buildings()[3]
    <Building 4 floating: 1 convex piece, 45 × 30 m, z from 45 to 60 m>
    """
    wings = (
        Building.roofed([(60, 15), (70, 15), (70, 45), (60, 45)], 65, [(65, 15, 70), (65, 40, 70)]),
        Building.roofed([(60, 35), (95, 35), (95, 45), (60, 45)], 65, [(65, 40, 70), (90, 40, 70)]),
    )
    return (
        Building(wings[0].pieces + wings[1].pieces, "1 notch", "#F3C77A"),
        Building.roofed(
            [(10, 15), (35, 15), (35, 55), (10, 55)],
            60,
            [(22, 25, 65), (22, 45, 65)],
            name="2 hip roof",
            color="#B5DFF5",
        ),
        Building.roofed(
            [(70, 60), (90, 60), (90, 80), (70, 80)],
            80,
            [(75, 65, 90), (85, 65, 90), (85, 75, 90), (75, 75, 90)],
            name="3 frustum",
            color="#8FD3BF",
        ),
        Building.prism([(15, 65), (10, 75), (50, 95), (55, 85)], 60, bottom=45, name="4 floating", color="#93B5DD"),
        Building.roofed(
            [(45, 55), (48, 53), (50, 55), (50, 60), (48, 62), (45, 60)],
            95,
            (48, 58, 99),
            name="5 spire",
            color="#F5EE9E",
        ),
    )


def table1_city(cell: float = 1.0) -> City:
    """The map of REPARE Table 1.

    Parameters
    ----------
    cell : float
        Edge of a voxel [m]; the paper's is 1, which gives 100³ voxels, 144 858 of them occupied: those whose centres
        lie in a building.

    Returns
    -------
    City
        100 × 100 × 100 m with five buildings, one of them floating, one an L-shaped notch.

    Raises
    ------
    ValueError
        If `cell` is not above 0, or so small that the map would have over 500 million voxels.

    See Also
    --------
    table1_buildings : its buildings alone.
    City.from_buildings : a map of other buildings.

    Examples
    --------
    >>> from uavlab.city import table1_city
    >>> city = table1_city()
    >>> city
    <City the city of REPARE Table 1: 100 × 100 × 100 voxels of 1 m, 5 buildings>
    >>> int(city.occupied.sum())
    144858
    """
    return City.from_buildings(
        table1_buildings(),
        cell=cell,
        origin=(0, 0, 0),
        size=(100, 100, 100),
        name="the city of REPARE Table 1",
        voxels="centres",
    )
