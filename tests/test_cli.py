"""The command `lube`: what it refuses, in a line. Its work is tested on a real archive."""

import json
import os
import subprocess
import sys

import pytest

import lube
import lube.archive
from lube.cli import main


def test_what_is_missing_or_no_archive_is_refused_in_one_line(files, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for arguments, expected in (
        (["verify", "gone"], "Error: gone: no such archive"),
        (["verify", str(files / "film.nc")], "neither a folder nor a complete zip"),
        (["explain", "gone/contact.nc"], "Error: gone/contact.nc: no such file"),
    ):
        assert main(arguments) == 2
        printed = capsys.readouterr()
        assert printed.out == ""
        assert expected in printed.err
        assert printed.err.count("\n") == 1


def test_figures_may_be_named_before_and_after_their_folder(monkeypatch, capsys, tmp_path):
    asked = []
    monkeypatch.setattr("lube.archive.redraw.redraw", lambda *words: asked.append(words) or [])
    (tmp_path / "SHA256SUMS").touch()
    archive = str(tmp_path)
    for words in (["a", "b", "--to", "new"], ["a", "--to", "new", "b"], ["--to", "new", "a", "b"]):
        assert main(["figures", archive, *words]) == 0
    assert [words[1:] for words in asked] == [("new", ["a", "b"])] * 3
    for words in (["figures", archive, "--to", "new", "--b"], ["verify", archive, "b"]):
        with pytest.raises(SystemExit):
            main(words)
        assert f"unrecognized arguments: {words[-1]}" in capsys.readouterr().err


def test_a_realisation_is_a_number_or_all(capsys):
    with pytest.raises(SystemExit):
        main(["explain", "contact.nc", "--realisation", "1.5"])
    assert "--realisation: invalid number_or_all value: '1.5'" in capsys.readouterr().err


def test_a_reader_that_stops_is_no_error(tmp_path):
    (tmp_path / "SHA256SUMS").write_text("".join(f"0  {number}\n" for number in range(10_000)))
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "lube.cli", "verify", str(tmp_path)]
    finished = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, check=False)
    os.close(write)
    assert (finished.stderr, finished.returncode) == (b"", 2)


def test_the_bare_command_helps(capsys):
    assert main([]) == 0
    assert "compare" in capsys.readouterr().out


def test_a_command_that_needs_the_workflow_says_how_to_install_it(monkeypatch, capsys):
    # `lube` itself also holds the package, and has the old one again afterwards.
    monkeypatch.setattr(lube, "archive", lube.archive)
    for name in [name for name in sys.modules if name.startswith("lube.archive")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "yaml", None)
    assert main(["verify", "nowhere"]) == 2
    message = "Error: the package yaml is not installed, need it for this command: "
    assert capsys.readouterr().err == f"{message}pip install 'lube[workflow]'\n"


def test_the_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out == f"lube {lube.__version__}\n"


def test_a_schema_is_printed(capsys):
    assert main(["schema", "lubricant"]) == 0
    assert json.loads(capsys.readouterr().out)["title"] == "A lubricant of lube"
