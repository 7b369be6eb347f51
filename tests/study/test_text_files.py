"""Text files are read, or refused in one line with the file's name."""

from functools import partial

import pytest
from refusals import one_line

from lube.errors import RecordError, StudyError
from lube.study.text_files import read_text, read_yaml


@pytest.fixture
def write(tmp_path):
    def write_file(content):
        path = tmp_path / "file.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write_file


def test_yaml_is_read_as_plain_values_of_version_1_2(write):
    assert read_yaml(write("a: {b: [1, x]}"), StudyError) == {"a": {"b": [1, "x"]}}
    assert read_yaml(write("- a\n"), StudyError, list) == ["a"]
    text = "a: 1e6\nb: 1:30\nc: no\nd: 2026-11-21\n"
    content = {"a": 1e6, "b": "1:30", "c": "no", "d": "2026-11-21"}
    assert read_yaml(write(text), StudyError) == content


def test_a_byte_order_mark_is_ignored(write):
    assert read_text(write("text".encode("utf-8-sig")), StudyError) == "text"


def test_a_file_that_is_no_mapping_is_refused_with_the_line(write):
    for content, reason in [
        ("a: 1\nb: 2\na: 3\n", 'not valid YAML at line 3: found duplicate key "a"'),
        ("a:\n  b: 1\n  b: 1\n", 'not valid YAML at line 3: found duplicate key "b"'),
        ("a: [1\n", "not valid YAML at line 2: expected ',' or ']'"),
        ("a: \t- b", "at line 1: found character '\\t' that cannot start any token"),
        ("a: 1\nb: c: d\n", "at line 2: mapping values are not allowed here"),
        ("a: *b\n", "at line 1: found undefined alias 'b'"),
        ("a: !!python/object/apply:os.getcwd []\n", "not valid YAML at line 1"),
        ("a: !!int ''\n", "not valid YAML: "),
        ("- a\n- b\n", "need a mapping of keys to values, got list"),
        ("", "need a mapping of keys to values, got NoneType"),
        ("shear: 1 µPa".encode("latin-1"), "cannot be read: it is not UTF-8 text"),
    ]:
        path = write(content)
        message = one_line(StudyError, read_yaml, path, StudyError)
        assert message.startswith(f"{path}: ")
        assert reason in message


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    refusal = partial(one_line, RecordError, read_yaml)
    message = refusal(tmp_path / "absent.yaml", RecordError)
    assert message.endswith("absent.yaml: cannot be read: No such file or directory")
    assert refusal(tmp_path, RecordError).endswith("cannot be read: Is a directory")
