"""JSON of one object or of many, whatever stands between them; and JSON that is none."""

import gzip
import json
import sys

import pytest
from files import write

from uavlab.city import documents
from uavlab.city.documents import progress, read_json

OBJECTS = [{"n": 1, "name": 'a \x7f NaN \\" Infinity'}, {"n": 2}, {"n": [3.5, -1e3]}]


@pytest.mark.parametrize("between", ["\n", "\r\n", "\n\n \t\n", "\x1e", "\n\x1e", "", " "])
@pytest.mark.parametrize("start", ["", "\x1e", "\n", "\ufeff"])
@pytest.mark.parametrize("end", ["", "\n", "\n\n\x1e "])
def test_sequences_with_any_separator(tmp_path, start, between, end):
    text = start + between.join(json.dumps(document) for document in OBJECTS) + end
    assert read_json(write(tmp_path / "a.json", text)) == OBJECTS


@pytest.mark.parametrize("constant", ["NaN", "Infinity", "-Infinity"])
def test_what_is_no_number_is_refused_with_its_place(tmp_path, constant):
    text = f'{{"a": "NaN \\" Infinity"}}\n{{"b": [1,\n  {constant}]}}'
    with pytest.raises(
        ValueError, match=rf"a\.json is not valid JSON: {constant} is not a number, at line 3, column 3"
    ):
        read_json(write(tmp_path / "a.json", text))


@pytest.mark.parametrize("text", ['{"a":' * 200_000, '{"a": ' + "[" * 200_000 + "]" * 200_000 + "}"])
def test_deep_nesting_is_refused(tmp_path, text):
    with pytest.raises(ValueError, match=r"a\.json is nested too deeply"):
        read_json(write(tmp_path / "a.json", text))


def test_endless_numbers_are_refused(tmp_path):
    digits = sys.get_int_max_str_digits() + 1
    with pytest.raises(ValueError, match=r"a\.json can't be read: Exceeds the limit"):
        read_json(write(tmp_path / "a.json", '{"a": ' + "9" * digits + "}"))


def test_each_thing_in_a_sequence_must_be_an_object(tmp_path):
    with pytest.raises(ValueError, match=r"a\.json must hold a JSON object \{\.\.\.\}, got a list"):
        read_json(write(tmp_path / "a.json", '{"a": 1}\n[2]'))


def test_objects_are_made_while_the_file_is_read(tmp_path):
    seen = []

    def objects(pairs):
        seen.append(pairs)
        return dict(pairs)

    path = write(tmp_path / "a.json", '{"a": {"b": 1, "b": 2}, "c": {}}')
    assert read_json(path, objects) == [{"a": {"b": 2}, "c": {}}]
    assert seen == [[("b", 1), ("b", 2)], [], [("a", {"b": 2}), ("c", {})]]


def test_progress_is_shown_for_very_many_things_only(monkeypatch, capsys):
    monkeypatch.setattr(documents, "MANY", 3)
    assert list(progress([1, 2, 3], "features")) == [1, 2, 3]
    assert capsys.readouterr().err == ""
    assert list(progress([1, 2, 3, 4], "features")) == [1, 2, 3, 4]
    assert "4/4" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "advice"),
    [
        (gzip.compress(b"{}", mtime=0), "packed with gzip: unpack it"),
        (b"PK\x03\x04\xff", "a zip archive: unpack it"),
        ('{"a": 1}'.encode("utf-16"), "UTF-16: save it as UTF-8"),
        ('{"a": "ß"}'.encode("latin-1"), "byte 7$"),
    ],
)
def test_what_is_no_text_is_refused_with_advice(tmp_path, content, advice):
    path = tmp_path / "a.geojson"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=rf"a\.geojson is not UTF-8 text: .*{advice}"):
        read_json(path)
