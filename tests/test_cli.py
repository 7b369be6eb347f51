"""The command `lube`: what it refuses, in a line. Its work is tested on a real archive."""

import os
import subprocess
import sys

import pytest
from refusals import in_time

from lube.cli import main


@pytest.mark.parametrize("arguments", [["verify", "gone"], ["explain", "gone/contact.nc"]])
def test_what_is_not_there_is_told_in_one_line(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("Error: gone")
    assert told.err.count("\n") == 1


@pytest.mark.parametrize("text", ["many", "1.5", ""])
def test_a_realisation_is_a_number_or_all(text, capsys):
    with pytest.raises(SystemExit):
        main(["explain", "contact.nc", "--realisation", text])
    assert f"got '{text}', need a whole number or `all`" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["film.nc", "pipe"])
def test_what_is_neither_a_folder_nor_a_zip_is_told_at_once(kind, files, tmp_path, capsys):
    path = files / kind
    if kind == "pipe":
        path = tmp_path / kind
        os.mkfifo(path)
    with in_time():
        assert main(["verify", str(path)]) == 2
    assert "neither an archive's folder nor its zip" in capsys.readouterr().err


def test_a_name_that_the_terminal_cannot_show_is_told_all_the_same():
    finished = lube("verify", "Öl", env=os.environ | {"PYTHONIOENCODING": "ascii"})
    assert finished.stderr.startswith(b"Error: \\xd6l: no such archive")
    assert finished.returncode == 2


def test_nobody_need_read_to_the_end(tmp_path):
    (tmp_path / "SHA256SUMS").write_text("".join(f"0  {number}\n" for number in range(10_000)))
    read, write = os.pipe()
    os.close(read)
    finished = lube("verify", tmp_path, stdout=write)
    os.close(write)
    assert (finished.stderr, finished.returncode) == (b"", 2)


def lube(*arguments, **settings):
    """Run the command as a process of its own."""
    command = [sys.executable, "-m", "lube.cli", *map(str, arguments)]
    settings = {"stdout": subprocess.PIPE} | settings
    return subprocess.run(command, stderr=subprocess.PIPE, check=False, **settings)
