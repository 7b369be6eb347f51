"""Small text files: read whole, and never waited for."""

import os

import pytest

from lube.errors import DataError, RecordError
from lube.study.texts import MOST_BYTES, read_text


def refusal(path):
    with pytest.raises(DataError) as caught:
        read_text(path, DataError)
    message = str(caught.value)
    assert ": cannot be read: " in message
    return message


@pytest.mark.parametrize("content", [b"", b"a\r\nb", "µ".encode(), b"x" * MOST_BYTES])
def test_a_text_is_read_as_it_is(tmp_path, content):
    (tmp_path / "text").write_bytes(content)
    assert read_text(tmp_path / "text", DataError) == content.decode()


def test_a_byte_order_mark_is_passed_over(tmp_path):
    (tmp_path / "text").write_text("text", encoding="utf-8-sig")
    assert read_text(tmp_path / "text", DataError) == "text"


def test_what_is_too_large_is_refused(tmp_path):
    (tmp_path / "text").write_bytes(b"x" * (MOST_BYTES + 1))
    assert f"need a file of {MOST_BYTES} bytes at most" in refusal(tmp_path / "text")


def test_a_pipe_is_not_waited_for_and_a_device_not_read(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, "/dev/zero", "/dev/null"):
        assert "no folder, pipe or device" in refusal(path)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("absent", "No such file or directory"),
        ("x" * 300, "File name too long"),
        ("a\0b", "no file has such a name"),
        ("\ud800", "no file has such a name"),
    ],
)
def test_a_name_without_a_file_is_told(tmp_path, name, told):
    assert refusal(tmp_path / name).endswith(told)


def test_what_is_no_text_is_told_as_the_reader_wants(tmp_path):
    (tmp_path / "text").write_bytes(b"\xff")
    with pytest.raises(RecordError, match="it is not UTF-8 text"):
        read_text(tmp_path / "text", RecordError)
