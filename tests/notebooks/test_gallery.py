"""The README's pictures are those of the chapters."""

import base64
import sys
from pathlib import Path

import nbformat
import pytest

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
sys.path.insert(0, str(NOTEBOOKS))
import gallery  # noqa: E402


def notebook(*cells):
    """A built notebook, of the tags and the pictures of its cells."""
    made = nbformat.v4.new_notebook()
    for tags, pictures in cells:
        outputs = [
            nbformat.v4.new_output("display_data", {"image/png": base64.b64encode(png).decode()}) for png in pictures
        ]
        made.cells.append(nbformat.v4.new_code_cell("", outputs=outputs, metadata={"tags": tags}))
    return made


def test_the_readme_shows_what_chapters_draw():
    pictures = gallery.pictures()
    assert len(pictures) == 4
    assert gallery.stale() == []
    text = (NOTEBOOKS.parent / "README.md").read_text(encoding="utf-8")
    for file in pictures:
        assert f"](notebooks/figures/{file.name})" in text
        assert f"](notebooks/{file.stem}.ipynb)" in text


def test_pictures_of_tagged_cells(tmp_path):
    nbformat.write(notebook((["figure"], [b"a"]), (["figure", "gallery"], [b"b"]), ([], [])), tmp_path / "05_a.ipynb")
    nbformat.write(notebook((["figure"], [b"c"])), tmp_path / "06_b.ipynb")
    assert gallery.pictures(tmp_path) == {gallery.FIGURES / "05_a.png": b"b"}
    assert gallery.stale(tmp_path) == [gallery.FIGURES / "05_a.png"]


@pytest.mark.parametrize("cells", [[(["gallery"], [])], [(["gallery"], [b"a", b"b"])], [(["gallery"], [b"a"])] * 2])
def test_one_picture_of_a_chapter_is_needed(tmp_path, cells):
    nbformat.write(notebook(*cells), tmp_path / "05_a.ipynb")
    with pytest.raises(ValueError, match=r"05_a.ipynb: one cell"):
        gallery.pictures(tmp_path)
