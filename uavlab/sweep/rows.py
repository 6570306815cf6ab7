"""A file that takes the results of a sweep as they come, and gives them back to the next call.

Each line is a JSON object: first the header, which says what sweep it is, then a row for each case that ended. While
the sweep runs, the file only grows; at the end it is rewritten in the order of the cases, if it isn't in it, so that
it has the same bytes wherever the sweep ran and however often it was stopped.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import stat
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

from uavlab import __version__
from uavlab.files import written_whole
from uavlab.sweep.failure import Failure, described, ranges, words
from uavlab.sweep.values import KINDS, as_text, fingerprint, name_of, read, text_mark

try:
    import fcntl
except ImportError:  # on Windows two sweeps with one file aren't told apart
    fcntl = None  # type: ignore[assignment]

FORMAT = 1

LONGEST = 100_000
"""Bytes of a header: a line that is longer isn't one, and isn't read whole."""


class NoRows:
    """Nothing is kept: a sweep without a file."""

    results: dict[int, Any]
    remarks: list[str]
    """What is to be said at the end."""

    def __init__(self) -> None:
        self.results, self.remarks = {}, []

    def __enter__(self) -> NoRows:
        return self

    def __exit__(self, *error: Any) -> None:
        pass

    def add(self, number: int, result: Any) -> None:
        self.results[number] = result

    def finish(self) -> None:
        pass

    def __str__(self) -> str:
        done = len(self.results)
        return f"{done} case{'s' * (done != 1)} had ended and are lost: a file, to=, would keep them" * bool(done)


class Rows(NoRows):
    """The file of a sweep, open.

    `results` holds what it had of cases that succeeded, and what was added.
    """

    def __init__(self, path: Path, header: bytes, count: int) -> None:
        super().__init__()
        self.path, self.header, self.count = path, header, count
        self.places: dict[int, tuple[int, int]] = {}

    def __enter__(self) -> Rows:
        place = self.stat()
        if place and not stat.S_ISREG(place.st_mode):
            raise ValueError(f"to must be the name of a file that can be read again, got {str(self.path)!r}")
        for last in (False, False, True):  # as on some network disks no file is ever the one that was opened
            self.file = open(self.path, "a+b", buffering=0)
            try:
                self.lock()
                if last or self.is_in_place():
                    self.read()
                    return self
            except BaseException:
                self.file.close()
                raise
            self.file.close()  # since it was opened, another sweep has put its file there
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, frames: TracebackType | None
    ) -> None:
        self.file.close()

    def lock(self) -> None:
        """Refuse a file that another sweep is writing to; the system opens the lock if its process dies."""
        if fcntl is None:
            return
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno not in (errno.EAGAIN, errno.EACCES):
                return  # some network disks have no locks
            raise ValueError(f"to: another sweep is writing to {self.path.name}: wait for it, or stop it") from error

    def is_in_place(self) -> bool:
        """Whether the file that is open is the one of that name: it may have been removed, or replaced."""
        place = self.stat()
        return place is not None and os.path.samestat(os.fstat(self.file.fileno()), place)

    def stat(self) -> os.stat_result | None:
        """What there is of that name: asked once, as others may put a file there or remove it."""
        try:
            return self.path.stat()
        except FileNotFoundError:
            return None

    def again(self) -> BinaryIO:
        """The open file, to be read from."""
        return open(self.file.fileno(), "rb", closefd=False)

    def read(self) -> None:
        """Take the rows of a file; cut off a last line that isn't whole, as power cuts and full disks leave it."""
        self.file.seek(0)
        first = self.file.readline(LONGEST)
        if not first.endswith(b"\n") and self.header.startswith(first):
            self.file.truncate(0)
            self.end = 0
            self.append(self.header)
            return
        if why := why_another(first, self.header):
            raise ValueError(f"to: {self.path.name} {why}: take another name, or remove it")
        self.end = len(first)
        with self.again() as lines:
            lines.seek(self.end)
            for number, line in enumerate(lines, start=2):
                if not self.took(line):
                    if lines.readline():
                        raise ValueError(
                            f"to: {self.path.name} is damaged in line {number}, and more follow: remove that line, and "
                            "its case runs again; or take another name"
                        )
                    break
        self.file.truncate(self.end)
        self.keep_header(first)

    def keep_header(self, first: bytes) -> None:
        """The header of the file stays, with the mark of the function's text, while it has results of that text."""
        mark, mine = json.loads(first)["text"], json.loads(self.header)
        if mark == mine["text"] or self.results:
            self.header = first
        else:
            self.file.truncate(0)
            self.places, self.end = {}, 0
            self.append(self.header)
        if self.results and None not in (mark, mine["text"]) and mark != mine["text"]:
            count = f"{len(self.results)} result{'s are' if len(self.results) > 1 else ' is'}"
            self.remarks.append(
                f"{self.path.name} was begun with another text of {mine['sweep']}, and its {count} kept: to have them "
                "anew, remove it"
            )

    def took(self, line: bytes) -> bool:
        """Take a row, if it is whole."""
        try:
            row = json.loads(line) if line.endswith(b"\n") else {}
        except (ValueError, RecursionError):
            row = {}
        if not isinstance(row, dict) or not ("failed" in row) ^ ("result" in row):
            return False
        number = row.get("case")
        if type(number) is not int or not 0 <= number < self.count:
            raise ValueError(f"to: {self.path.name} has a row of case {number!r:.20}, which isn't one of {self.count}")
        self.results.pop(number, None)
        if "result" in row:
            try:
                self.results[number] = read(row["result"])
            except ValueError as error:
                raise ValueError(f"to: {self.path.name}, case {number}: {error}") from error
        self.places[number] = self.end, len(line)
        self.end += len(line)
        return True

    def add(self, number: int, result: Any) -> None:
        """A row at the end of the file."""
        self.append(row_of(number, result), number)
        self.results[number] = result

    def append(self, line: bytes, number: int | None = None) -> None:
        """A line at the end of the file, whole or not at all."""
        try:
            rest = memoryview(line)
            while rest:
                rest = rest[self.file.write(rest) :]
        except OSError as error:
            self.file.truncate(self.end)
            raise OSError(error.errno, f"{error.strerror}; {self}", str(self.path)) from error
        if number is not None:
            self.places[number] = self.end, len(line)
        self.end += len(line)

    def finish(self) -> None:
        """Bring the rows into the order of the cases."""
        in_place = self.is_in_place()
        if not in_place and self.stat():
            self.remarks.append(f"{self.path.name} was replaced while the sweep ran: what came later isn't in it")
            return
        if in_place and self.is_ordered():
            return
        try:
            with written_whole(self.path) as part, self.again() as source, part.open("wb") as target:
                target.write(self.header)
                for number in range(self.count):
                    place, size = self.places[number]
                    source.seek(place)
                    target.write(source.read(size))
                target.flush()
                os.fsync(target.fileno())
        except OSError as error:
            text = f"{error.strerror}; the rows aren't in order yet, for which {self.path.name} is written once more"
            raise OSError(error.errno, f"{text}; {self}", str(self.path)) from error

    def is_ordered(self) -> bool:
        """Whether the rows are in the order of the cases, each once."""
        expected = len(self.header)
        for number in range(self.count):
            place, size = self.places[number]
            if place != expected:
                return False
            expected += size
        return True

    def __str__(self) -> str:
        kept = [number for number, result in self.results.items() if not isinstance(result, Failure)]
        return (
            f"{len(kept)} of {self.count} cases are kept in {self.path}{f' ({ranges(kept)})' * bool(kept)}: the same "
            "call goes on from there"
        )


def row_of(number: int, result: Any) -> bytes:
    """The line of a case that ended."""
    if isinstance(result, Failure):
        text = json.dumps(described(result.exception))
        return f'{{"case":{number},"failed":{text}}}\n'.encode()
    try:
        return f'{{"case":{number},"result":{as_text(result)}}}\n'.encode()
    except (TypeError, AttributeError) as error:
        raise ValueError(
            f"to: case {number} returned a {type(result).__name__}, and a file can't hold {error!s:.200}: return "
            f"{KINDS}; of a table, table.to_dict('list')"
        ) from error


def header_of(function: Callable[..., Any], cases: Sequence[Mapping[str, Any]]) -> bytes:
    """The first line of a file: what sweep it is of."""
    seen: dict[int, tuple[Any, str]] = {}
    mark = told_apart("function", function, seen)
    name = name_of(getattr(function, "func", function))
    digest, owners = hashlib.sha256(f"{name} {mark}".encode()), dict[str, int]()
    for number, case in enumerate(cases):
        marks = [f"{key}: {told_apart(f'{key} of case {number}', case[key], seen)}" for key in sorted(case, key=str)]
        one = hashlib.sha256("\n".join(marks).encode()).hexdigest()
        if (first := owners.setdefault(one, number)) != number:
            raise ValueError(
                f"cases {first} and {number} are equal ({words(case):.200}), and a file keeps each once: give each a "
                "seed of its own, or leave one out"
            )
        digest.update(one.encode())
    says = {
        "uavlab": __version__, "format": FORMAT, "sweep": name, "cases": len(cases), "digest": digest.hexdigest(),
        "text": text_mark(function),
    }  # fmt: skip
    return json.dumps(says).encode() + b"\n"


def told_apart(name: str, value: Any, seen: dict[int, tuple[Any, str]] | None = None) -> str:
    """What tells a thing from others, in a file too; `ValueError` for what nothing tells."""
    try:
        return fingerprint(value, {} if seen is None else seen)
    except Exception as error:
        raise ValueError(
            f"{name} can't be told from others, so that a file, to=, can't say whose results it holds: "
            f"{described(error):.200}. Numbers, text, arrays, dataclasses and functions with a name can; files are to "
            "be opened in the function"
        ) from error


def why_another(first: bytes, header: bytes) -> str:
    """What tells the first line of a file from the header of a sweep, in words; none for a file of the sweep."""
    mine = json.loads(header)
    try:
        says = json.loads(first)
        theirs = {key: says[key] for key in mine}
    except (ValueError, TypeError, KeyError):
        return "is no file of a sweep"
    if theirs["format"] != FORMAT or theirs["uavlab"] != mine["uavlab"]:
        return f"is of version {theirs['uavlab']} (format {theirs['format']}), this is {__version__} (format {FORMAT})"
    if theirs["sweep"] != mine["sweep"]:
        return f"holds a sweep of {theirs['sweep']}, this is one of {mine['sweep']}"
    if theirs["digest"] == mine["digest"] and first.endswith(b"\n"):
        return ""
    return f"holds a sweep of {mine['sweep']} over other cases ({theirs['cases']}, these are {mine['cases']})"
