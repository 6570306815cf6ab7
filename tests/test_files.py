"""Files that are written whole or not at all."""

import os
import threading

import pytest

from uavlab.files import written_whole
from uavlab.prediction import OffsetPredictor, make_dataset
from uavlab.route import Route
from uavlab.storage import save

ROUTE = Route([(0, 0, 0), (3, 4, 0)])


def full_disk(*_, **__):
    raise OSError("disk full")


def test_an_old_file_outlives_an_error(tmp_path):
    path = tmp_path / "page.html"
    path.write_text("old")

    def write_half():
        with written_whole(path) as part:
            part.write_text("half of the n")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_half()
    assert [file.name for file in tmp_path.iterdir()] == ["page.html"]
    assert path.read_text() == "old"
    with written_whole(path) as part:
        part.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_table_and_a_model_are_kept_where_the_new_one_fails(tmp_path, monkeypatch):
    data = make_dataset(count=400, train_count=200)
    predictor = OffsetPredictor(("wind_speed",)).fit(data.features, data.offsets)
    predictor.save(tmp_path / "offsets.json")
    ROUTE.to_csv(tmp_path / "route.csv")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert set(before) == {"offsets.json", "route.csv"}
    monkeypatch.setattr("pathlib.Path.replace", full_disk)
    for write in (predictor.save, ROUTE.to_csv):
        with pytest.raises(OSError, match="disk full"):
            write(tmp_path / ("route.csv" if write == ROUTE.to_csv else "offsets.json"))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_link_stays_one(tmp_path):
    (tmp_path / "far").mkdir()
    (tmp_path / "link.csv").symlink_to(tmp_path / "far" / "route.csv")
    ROUTE.to_csv(tmp_path / "link.csv")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "far" / "route.csv").read_text().startswith("x_m,y_m,z_m")
    assert len(list((tmp_path / "far").iterdir())) == 1


def test_a_pipe_is_written_to(tmp_path):
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()), daemon=True)
    reader.start()
    ROUTE.to_csv(pipe)
    reader.join(timeout=30)
    assert read[0].splitlines()[-1] == "3.0,4.0,0.0,5.0"
    assert [file.name for file in tmp_path.iterdir()] == ["pipe"]


@pytest.mark.parametrize("write", [ROUTE.to_csv, lambda path: save(ROUTE, path)], ids=["to_csv", "save"])
def test_an_error_names_the_file_that_was_asked_for(write, tmp_path):
    missing = tmp_path / "missing" / "route.csv"
    with pytest.raises(FileNotFoundError) as error:
        write(missing)
    assert str(missing) in str(error.value)
    assert ".part" not in str(error.value)
    with pytest.raises(IsADirectoryError):
        write(tmp_path)
    assert not list(tmp_path.iterdir())
