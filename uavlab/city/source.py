"""What a reader made of a file: what it took, mended, derived, assumed and left out, and why.

A city that was read is only as good as its file. What the reader had to decide stands here, in words and numbers, with
the names of the first few things that it concerns; a warning says the part that one must know before one flies.
"""

from __future__ import annotations

import html
import itertools
import sys
import traceback
import warnings
from collections import defaultdict
from dataclasses import dataclass

from uavlab import checks
from uavlab.city.place import UNKNOWN

KINDS = ("taken", "mended", "derived", "assumed", "left out")
"""In the order in which they are told; the last two are doubts."""

DOUBTS = ("assumed", "left out")

FIRST = 3
"""Of so many things the names are kept."""

LONGEST_NAME = 30
"""Letters of a name that are printed; a longer one, such as a UUID, is cut. `Entry.first` has it whole."""


@dataclass(frozen=True)
class Entry:
    """One thing that a reader did, and how often."""

    kind: str
    """One of `KINDS`."""
    what: str
    """Such as "Building" or "height from building:levels × 3 m"."""
    count: int
    first: tuple[str, ...]
    """Names of the first few that it concerns."""

    def __str__(self) -> str:
        names = [name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 1]}…" for name in self.first]
        named = f" ({', '.join(names)}{', …' if self.count > len(names) else ''})" if names else ""
        return f"{self.kind}: {self.count:,} × {self.what}{named}" if self.count else f"{self.kind}: {self.what}"


@dataclass(frozen=True)
class Source:
    """Where a city comes from, and what became of what stood there.

    Attributes
    ----------
    name : str
        Of the file.
    format : str
        Such as "GeoJSON".
    entries : tuple of Entry
        In the order of `KINDS`.
    heights : {"above sea", "ellipsoidal", "unknown"}
        What the height of the city's `reference` is measured from, by what the file says.

    See Also
    --------
    read_city : gives the city that it reads one, as `city.source`.

    Examples
    --------
    Readers make it. Here a town was read in which one house has no height.

    >>> from uavlab.city import Source
    >>> from uavlab.city.source import Entry
    >>> source = Source("town.geojson", "GeoJSON", (
    ...     Entry("taken", "building", 2, ()), Entry("assumed", "height of 9 m", 1, ("annexe",))))
    >>> source
    town.geojson (GeoJSON)
      taken: 2 × building
      assumed: 1 × height of 9 m (annexe)
    """

    name: str
    format: str
    entries: tuple[Entry, ...] = ()
    heights: str = UNKNOWN

    def of(self, kind: str) -> tuple[Entry, ...]:
        """The entries of one kind.

        Parameters
        ----------
        kind : {"taken", "mended", "derived", "assumed", "left out"}

        Returns
        -------
        tuple of Entry

        Raises
        ------
        ValueError
            If `kind` is none of these.

        See Also
        --------
        Source.count : how many things they concern.

        Examples
        --------
        >>> from uavlab.city import Source
        >>> from uavlab.city.source import Entry
        >>> source = Source("town.geojson", "GeoJSON", (Entry("left out", "mast", 4, ("mast 1",)),))
        >>> [entry.what for entry in source.of("left out")], source.of("assumed")
        (['mast'], ())
        """
        checks.one_of("kind", kind, KINDS)
        return tuple(entry for entry in self.entries if entry.kind == kind)

    def count(self, kind: str, what: str = "") -> int:
        """How many things entries of a kind concern; with `what`, those that have this in their words.

        Parameters
        ----------
        kind : {"taken", "mended", "derived", "assumed", "left out"}
        what : str
            Part of the words to look for; by default all count.

        Returns
        -------
        int

        Raises
        ------
        ValueError
            If `kind` is none of these, or `what` is no text.

        See Also
        --------
        Source.of : the entries themselves.

        Examples
        --------
        >>> from uavlab.city import Source
        >>> from uavlab.city.source import Entry
        >>> source = Source("town.geojson", "GeoJSON", (
        ...     Entry("left out", "mast", 4, ()), Entry("left out", "polygon without area", 1, ())))
        >>> source.count("left out"), source.count("left out", "polygon")
        (5, 1)
        """
        words = checks.text("what", what)
        return sum(entry.count for entry in self.of(kind) if words in entry.what)

    @property
    def doubts(self) -> tuple[Entry, ...]:
        """What was assumed or left out."""
        return tuple(entry for entry in self.entries if entry.kind in DOUBTS)

    def __str__(self) -> str:
        return "\n".join([f"{self.name} ({self.format})", *(f"  {entry}" for entry in self.entries)])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        left = ' style="text-align:left"'
        rows = "".join(
            f"<tr><td{left}>{entry.kind}</td><td{left}>{html.escape(str(entry).split(': ', 1)[1])}</td></tr>"
            for entry in self.entries
        )
        return f"<table><caption>{html.escape(self.name)} ({self.format})</caption>{rows}</table>"

    def warn(self, advice: str = "city.source tells all") -> None:
        """One warning with all that was assumed or left out, at the caller's line; none where nothing was.

        Parameters
        ----------
        advice : str
            What the warning ends with.

        Raises
        ------
        ValueError
            If `advice` is no text.

        Warns
        -----
        UserWarning
            If anything was assumed or left out.

        See Also
        --------
        Source.of : the entries, also those that the warning leaves out.

        Examples
        --------
        >>> import warnings
        >>> from uavlab.city import Source
        >>> from uavlab.city.source import Entry
        >>> with warnings.catch_warnings(record=True) as said:
        ...     Source("town.geojson", "GeoJSON", (Entry("left out", "mast", 4, ()),)).warn()
        >>> print(said[0].message)
        town.geojson: left out: 4 × mast. city.source tells all
        """
        checks.text("advice", advice)
        if self.doubts:
            said = "; ".join(map(str, self.doubts))
            # one reader calls another: as many frames are left out as belong to the library
            stack = traceback.walk_stack(sys._getframe())
            inside = itertools.takewhile(lambda at: at[0].f_globals.get("__name__", "").startswith("uavlab."), stack)
            warnings.warn(f"{self.name}: {said}. {advice}", stacklevel=1 + sum(1 for _ in inside))


class Notes:
    """Collects what a reader does, one thing after the other."""

    def __init__(self) -> None:
        self.counts: dict[tuple[str, str], int] = defaultdict(int)
        self.first: dict[tuple[str, str], list[str]] = defaultdict(list)

    def add(self, kind: str, what: str, name: str = "", count: int = 1) -> None:
        """Note a thing, with its name if it has one; `count` 0 for what holds for the file as a whole."""
        entry = checks.one_of("kind", kind, KINDS), what
        self.counts[entry] += count
        if name and len(self.first[entry]) < FIRST:
            self.first[entry].append(name)

    def source(self, name: str, file_format: str, heights: str = UNKNOWN) -> Source:
        """All notes as a report, in the order of `KINDS`, and within a kind as they came."""
        keys = sorted(self.counts, key=lambda entry: KINDS.index(entry[0]))
        entries = [Entry(*key, self.counts[key], tuple(self.first[key])) for key in keys]
        return Source(name, file_format, tuple(entries), heights)
