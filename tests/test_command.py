"""The command `lube`: what it refuses, in a line. Its work is tested on a real archive."""

import pytest

from lube.command import main


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
