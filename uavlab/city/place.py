"""Where on Earth a city lies: from the coordinates of a file to metres east and north, and back.

Any reference system that pyproj knows is brought to longitude and latitude, then to the plane that touches the Earth at
the city's own place, at its height (PROJ's topocentric coordinates): true east and true north, in true metres. Heights
stay in the vertical system of the file, whatever it is; only their unit is converted.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt
import pyproj
from pyproj.exceptions import CRSError

from uavlab import checks

LOCAL = "local"
"""What `crs=` says of plain metres from somewhere."""

NOWHERE = "coordinates in metres, of an unknown place (crs='EPSG:...' names their system)"
"""What reports say of those."""

FARTHEST_LOCAL = 20e3
"""Coordinates up to this size [m] are taken for metres from a corner, where a file names no system."""

WIDEST = 100e3
"""Extent of a city [m]."""

OUTSIDE_DEG = 5.0
"""How far beyond the area of use of a system coordinates may lie [degrees]; more, and the system is wrong."""

UNITS = {
    "m": 1.0, "metre": 1.0, "metres": 1.0, "meter": 1.0, "meters": 1.0,
    "ft": 0.3048, "foot": 0.3048, "feet": 0.3048,
    "us-ft": 1200 / 3937, "us_survey_foot": 1200 / 3937, "us survey foot": 1200 / 3937,
}  # fmt: skip
"""Metres per unit of length."""


ABOVE_SEA, ELLIPSOIDAL, UNKNOWN = "above sea", "ellipsoidal", "unknown"
"""What heights of a city may be: orthometric, as on maps; above the ellipsoid, as GPS itself has them, up to 100 m more
or less; or not said."""


class Geographic(NamedTuple):
    """Three coordinates."""

    longitude: float
    latitude: float
    height: float = 0.0


class Place(Geographic):
    """The place of x = y = z = 0 of a city.

    Attributes
    ----------
    longitude, latitude : float
        [degrees, WGS84]; longitudes may go on past ±180, to ±540.
    height : float
        [m], in the vertical system of the file that it was read from.

    Raises
    ------
    ValueError
        If `longitude` is not from −540 to 540, `latitude` not from −90 to 90, or `height` is not finite.

    See Also
    --------
    City.to_geographic : from points of a map to longitude, latitude and height.
    City.from_geographic : the inverse.

    Examples
    --------
    >>> from uavlab.city import Place
    >>> Place(13.3777, 52.5163)
    Place(longitude=13.3777, latitude=52.5163, height=0.0)
    """

    __slots__ = ()

    def __new__(cls, longitude: float, latitude: float, height: float = 0.0) -> Self:
        east = checks.number("longitude", longitude, checks.within, -540.0, 540.0, "degrees")
        degrees = "degrees (the order is longitude, latitude)"
        north = checks.number("latitude", latitude, checks.within, -90.0, 90.0, degrees)
        return super().__new__(cls, east, north, checks.number("height", height, checks.finite))

    def east_north(self, lonlat: npt.ArrayLike) -> np.ndarray:
        """East and north of longitudes and latitudes, in the plane that touches the Earth here.

        (e, n) are the first two coordinates of R (X − X₀): X and X₀ are the point and the place from the Earth's
        centre, both at the height of the place, and R turns the axes to east, north and up.

        Parameters
        ----------
        lonlat : (..., 2) array
            Longitudes and latitudes [degrees, WGS84].

        Returns
        -------
        (..., 2) array
            East and north [m].

        Raises
        ------
        ValueError
            If `lonlat` hasn't shape (..., 2), is not finite, or has a latitude that is not from −90 to 90.

        See Also
        --------
        Place.longitude_latitude : the inverse.
        City.from_geographic : with heights, for a city.

        Examples
        --------
        A hundredth of a degree is shorter to the east than to the north, about by the cosine of the latitude.

        >>> from uavlab.city import Place
        >>> gate = Place(13.3777, 52.5163)
        >>> gate.east_north((13.3877, 52.5263)).round(1)
        array([ 678.7, 1112.8])
        """
        lonlat = checks.array("lonlat", lonlat, ..., 2)
        checks.within("lonlat: latitudes", lonlat[..., 1], -90.0, 90.0, "degrees (the order is longitude, latitude)")
        east, north, _ = topocentric(self).transform(
            lonlat[..., 0], lonlat[..., 1], np.full(lonlat.shape[:-1], self.height)
        )
        return np.stack([east, north], axis=-1)

    def longitude_latitude(self, points: npt.ArrayLike) -> np.ndarray:
        """Longitudes and latitudes of points east and north: the inverse of `east_north`.

        The Earth falls away below the plane, so the point that is looked for, at the height of the place, lies below
        it: found by going down as far as it is too high, which converges at once. Longitudes go on past ±180.

        Parameters
        ----------
        points : (..., 2) array
            East and north [m].

        Returns
        -------
        (..., 2) array
            Longitudes and latitudes [degrees, WGS84].

        Raises
        ------
        ValueError
            If `points` hasn't shape (..., 2) or is not finite.

        See Also
        --------
        Place.east_north : the inverse.
        City.to_geographic : with heights, for a city.

        Examples
        --------
        >>> from uavlab.city import Place
        >>> gate = Place(13.3777, 52.5163)
        >>> gate.longitude_latitude((678.7, 1112.8)).round(4)
        array([13.3877, 52.5263])
        """
        points = checks.array("points", points, ..., 2)
        down = np.zeros(points.shape[:-1])
        for _ in range(4):
            longitude, latitude, height = topocentric(self).transform(
                points[..., 0], points[..., 1], -down, direction="INVERSE"
            )
            down = down + (height - self.height)
        turned = (longitude - self.longitude + 180.0) % 360.0 - 180.0
        return np.stack([self.longitude + turned, latitude], axis=-1)


def place_of(name: str, value: Any) -> Place:
    """A place, also given as (longitude, latitude[, height])."""
    if isinstance(value, Place):
        return value
    coordinates = checks.numbers(name, value)
    if coordinates.shape not in ((2,), (3,)):
        raise ValueError(f"{name} must be a Place, or (longitude, latitude[, height]), got {value!r:.60}")
    try:
        return Place(*coordinates.tolist())
    except ValueError as wrong:
        raise ValueError(f"{name}: {wrong}") from wrong


def place_at_corner(lonlat: np.ndarray, height: float = 0.0) -> Place:
    """The south-west corner of the bounding box, east and north of itself, of longitudes and latitudes (N, 2)."""
    corner = lonlat[0]
    for _ in range(4):  # the axes turn a little when their origin moves
        place = Place(float(corner[0]), float(corner[1]), height)
        corner = place.longitude_latitude(place.east_north(lonlat).min(axis=0))
    return place


def check_extent(plan: np.ndarray, advice: str, least: float = 1.0) -> None:
    """Refuse corners (N, 2) [m] that span what is no city, most of all degrees that were read as metres."""
    x, y = np.ptp(plan, axis=0)
    if not least <= max(x, y) <= WIDEST:
        raise ValueError(f"the buildings cover {x:.3g} × {y:.3g} m, which is no city: {advice}")


@lru_cache(64)
def topocentric(place: Place) -> pyproj.Transformer:
    """Longitude, latitude and height to east, north and up of a place."""
    longitude, latitude, height = map(float, place)
    return pyproj.Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 "
        f"+step +proj=topocentric +ellps=WGS84 +lon_0={longitude!r} +lat_0={latitude!r} +h_0={height!r}"
    )


class System:
    """A reference system for coordinates of a file, see `system_of`."""

    def __init__(self, crs: pyproj.CRS) -> None:
        self.crs = crs
        parts = crs.sub_crs_list if crs.is_compound else [crs.to_2d() if len(crs.axis_info) > 2 else crs]
        self.horizontal = parts[0]
        self.vertical = parts[1].axis_info[0] if len(parts) > 1 else None
        self.heights = ABOVE_SEA if len(parts) > 1 else ELLIPSOIDAL if len(crs.axis_info) > 2 else UNKNOWN

    def __repr__(self) -> str:
        return f"<System {self.name}>"

    @property
    def name(self) -> str:
        """Such as "EPSG:7415 (Amersfoort / RD New + NAP height)"."""
        authority = self.crs.to_authority()
        return f"{':'.join(authority)} ({self.crs.name})" if authority else self.crs.name

    @property
    def degrees(self) -> bool:
        """Whether coordinates are longitudes and latitudes."""
        return bool(self.horizontal.is_geographic)

    @cached_property
    def transformer(self) -> pyproj.Transformer:
        return pyproj.Transformer.from_crs(self.horizontal, "EPSG:4326", always_xy=True)

    def to_lonlat(self, xy: npt.ArrayLike) -> np.ndarray:
        """Longitudes and latitudes (..., 2) [degrees, WGS84] of coordinates (..., 2), x or longitude first.

        Raises
        ------
        ValueError
            If a coordinate has no place on Earth in this system.
        """
        xy = np.asarray(xy, dtype=float)
        if self.degrees:
            checks.within("latitudes", xy[..., 1], -90.0, 90.0, "degrees (the order is longitude, latitude)")
        lonlat = np.stack(self.transformer.transform(xy[..., 0], xy[..., 1]), axis=-1)
        if not np.isfinite(lonlat).all():
            wrong = xy[~np.isfinite(lonlat).all(axis=-1)].reshape(-1, 2)[0]
            raise ValueError(
                f"({wrong[0]:g}, {wrong[1]:g}) has no place on Earth in {self.name}: is crs the system of the file?"
            )
        return lonlat

    def from_lonlat(self, lonlat: npt.ArrayLike) -> np.ndarray:
        """Coordinates (..., 2) in this system of longitudes and latitudes (..., 2) [degrees, WGS84]."""
        lonlat = np.asarray(lonlat, dtype=float)
        return np.stack(self.transformer.transform(lonlat[..., 0], lonlat[..., 1], direction="INVERSE"), axis=-1)

    @property
    def height_factor(self) -> float:
        """Metres per unit of heights: of the vertical part, else of the plane, else metres."""
        if self.vertical is not None:
            return float(self.vertical.unit_conversion_factor)
        return 1.0 if self.degrees else float(self.horizontal.axis_info[0].unit_conversion_factor)

    @property
    def height_unit(self) -> str:
        """Name of the unit of heights."""
        if self.vertical is not None:
            return str(self.vertical.unit_name)
        return "metre" if self.degrees else str(self.horizontal.axis_info[0].unit_name)

    @property
    def accuracy(self) -> str:
        """Words for how well its datum is known beside WGS84, without grids from a network."""
        metres = self.transformer.accuracy
        known = f"within about {max(metres, 0.0):g} m" if metres >= 0 else "how exactly is unknown, usually 1 to 4 m"
        return f"{self.name} to WGS84: {known}"


def system_of(crs: Any, argument: str = "crs") -> System:
    """A reference system by its code or description.

    Parameters
    ----------
    crs : str, int, pyproj.CRS, or anything else that pyproj takes
        Such as "EPSG:2263", 2263, "urn:ogc:def:crs:EPSG::2263", "OGC:CRS84",
        "https://www.opengis.net/def/crs/EPSG/0/7415".
    argument : str
        What messages call it.

    Raises
    ------
    ValueError
        If pyproj doesn't know `crs`, or it is no system for places on a map.
    """
    if isinstance(crs, System):
        return crs
    return known_system(crs, argument) if isinstance(crs, str | int) else read_system(crs, argument)


@lru_cache(64)
def known_system(crs: str | int, argument: str) -> System:
    return read_system(crs, argument)


def read_system(crs: Any, argument: str) -> System:
    cure = "give the EPSG code of the file's reference system, such as crs='EPSG:25832', or crs='local'"
    try:
        found = pyproj.CRS.from_user_input(crs)
    except (CRSError, TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{argument}={crs!r:.80} is no reference system that pyproj knows; {cure}") from error
    horizontal = found.sub_crs_list[0] if found.is_compound else found
    if not (horizontal.is_geographic or horizontal.is_projected):
        raise ValueError(f"{argument}={crs!r:.80} ({found.name}) has no plane coordinates: {cure}")
    return System(found)


def common_system(declared: Sequence[Any], file: str) -> Any:
    """What the documents of a file name as their reference system, None if none does; `ValueError` if they differ."""
    named = [system for system in declared if system is not None]
    for other in named[1:]:
        if other != named[0] and not system_of(other).crs.equals(system_of(named[0]).crs, ignore_axis_order=True):
            raise ValueError(
                f"{file} has coordinates in more than one reference system, {named[0]!r:.80} and {other!r:.80}: "
                "read a file for each"
            )
    return named[0] if named else None


def system_for(bounds: npt.ArrayLike, declared: Any, given: Any, file: str) -> System | None:
    """The reference system of coordinates, or None for plain metres from somewhere.

    Parameters
    ----------
    bounds : (west, south, east, north)
        Of the coordinates.
    declared : anything that pyproj takes, or None
        What the file says.
    given : the same, or "local", or None
        What the caller says; it outweighs the file.
    file : str
        Its name, for messages.

    Raises
    ------
    ValueError
        If neither says anything and the numbers don't tell; or the coordinates can't be in that system.
    """
    box = checks.numbers("bounds", bounds)
    in_degrees = bool((np.abs(box) <= [180, 90, 180, 90]).all())
    if (np.abs(box) <= [540, 90, 540, 90]).all() and max(box[2] - box[0], box[3] - box[1]) < 1.0:
        in_degrees = True  # past ±180, and too small for a city in metres
    ranges = f"({box[0]:g}, {box[1]:g}) to ({box[2]:g}, {box[3]:g})"
    if isinstance(given, str) and given == LOCAL:
        return None
    if given is None and declared is None:
        if in_degrees:
            return system_of("OGC:CRS84")
        if np.abs(box).max() <= FARTHEST_LOCAL:
            return None
        raise ValueError(
            f"{file} names no reference system, and its coordinates, {ranges}, don't tell: give crs='EPSG:...', "
            "the code of its system (a projection in metres or feet), or crs='local' for plain metres"
        )
    system = system_of(declared, f"the system of {file}") if given is None else system_of(given)
    check_fits(box, system, file, ranges, in_degrees)
    return system


def check_fits(box: np.ndarray, system: System, file: str, ranges: str, in_degrees: bool) -> None:
    """Refuse coordinates that can't be in a system."""
    if system.degrees:
        if not (np.abs(box) <= [540, 90, 540, 90]).all():  # longitudes may go on past 180
            raise ValueError(
                f"{file}: coordinates {ranges} are no degrees, but {system.name} has longitudes within ±180 and "
                "latitudes within ±90: is their order longitude, latitude? If they are no degrees give "
                "crs='EPSG:...', the code of their system, or crs='local' for plain metres"
            )
        corners = box.reshape(2, 2)
        if degrees_outside(system, corners) > OUTSIDE_DEG and degrees_outside(system, corners[:, ::-1]) <= 0:
            raise ValueError(
                f"{file}: coordinates {ranges} lie outside of where {system.name} is used, and inside if the latitude "
                "stands first: change their order to longitude, latitude"
            )
        return
    there = system.to_lonlat(box.reshape(2, 2))
    outside = degrees_outside(system, there)
    if outside > OUTSIDE_DEG:
        guess = "they look like degrees: give crs='EPSG:4326'" if in_degrees else "give crs='EPSG:...', their own"
        raise ValueError(
            f"{file}: coordinates {ranges} in {system.name} lie at longitude {there[0, 0]:.4f}°, latitude "
            f"{there[0, 1]:.4f}°, {outside:.0f}° outside of where that is used: {guess}"
        )


def degrees_outside(system: System, lonlat: np.ndarray) -> float:
    """How far places (N, 2) lie outside of where a system is used [degrees]; −inf if that is everywhere or unknown."""
    area = system.horizontal.area_of_use
    if area is None or (area.east - area.west) % 360 == 0:
        return -np.inf
    half = (area.east - area.west) % 360 / 2
    apart = (lonlat[:, 0] - (area.west + half) + 180) % 360 - 180
    beyond = np.concatenate([np.abs(apart) - half, lonlat[:, 1] - area.north, area.south - lonlat[:, 1]])
    return float(beyond.max())


def metres_per(unit: str, argument: str = "height_unit") -> float:
    """Metres per unit of length: "m", "ft" or "us-ft", see `UNITS`.

    Raises
    ------
    ValueError
        If `unit` is none of these.
    """
    known = unit.strip().lower() if isinstance(unit, str) else unit
    return UNITS[checks.one_of(argument, known, UNITS)]
