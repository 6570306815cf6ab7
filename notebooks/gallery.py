"""Pictures of the README, taken from the chapters that draw them: cells with the tag `gallery`, one to a chapter."""

import base64
from pathlib import Path

import nbformat

HERE = Path(__file__).resolve().parent
FIGURES = HERE / "figures"


def pictures(folder: Path = HERE) -> dict[Path, bytes]:
    """PNG pictures of tagged cells in the built notebooks, by the file in which each is to be.

    Raises
    ------
    ValueError
        If a tagged cell has no picture, or a chapter has two of them.
    """
    found: dict[Path, bytes] = {}
    for path in sorted(folder.glob("[0-9][0-9]_*.ipynb")):
        for cell in nbformat.read(path, as_version=4).cells:
            if "gallery" not in cell.metadata.get("tags", []):
                continue
            drawn = [output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
            file = FIGURES / f"{path.stem}.png"
            if len(drawn) != 1 or file in found:
                raise ValueError(f"{path.name}: one cell with the tag gallery, and one picture in it, are needed")
            found[file] = base64.b64decode(drawn[0])
    return found


def stale(folder: Path = HERE) -> list[Path]:
    """Files that aren't the chapters' pictures."""
    return [file for file, png in pictures(folder).items() if not file.exists() or file.read_bytes() != png]


def write(folder: Path = HERE) -> None:
    for file, png in pictures(folder).items():
        file.write_bytes(png)
