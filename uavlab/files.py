"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


def beside(path: Path) -> Path:
    """Where a file is written before it takes its place, which may be behind a link."""
    place = path.resolve()
    return place.with_name(f"{place.name}.{os.getpid()}.part")


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """A name to write to; the file there takes the place of `path` at the end, and goes if the writing failed.

    So an old file is lost neither to an error nor to a full disk. What is no file, such as /dev/stdout, is written to
    itself.
    """
    if path.exists() and not path.is_file():
        yield path
        return
    part = beside(path)
    try:
        yield part
        part.replace(path.resolve())
    except OSError as error:
        if str(error.filename) == str(part):  # nobody asked for that name
            error.filename = str(path)
        raise
    finally:
        part.unlink(missing_ok=True)
