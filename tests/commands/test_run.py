"""`lube run`: Snakemake with the study, from any folder."""

import subprocess
import sys

import pytest
from refusals import one_line
from studies import ROOT, SMOKE

from lube.commands import run as module
from lube.commands.run import repository, snakemake_command
from lube.errors import LubeError


def test_the_study_comes_last_so_that_targets_and_options_are_snakemakes(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    expected = ["archive", "-n", "--configfile", str(tmp_path / "mine.yaml")]
    assert snakemake_command(["mine.yaml", "archive", "-n"])[3:] == expected
    assert snakemake_command(["--dry-run"])[3:] == ["--dry-run"]


def test_the_help_is_that_of_snakemake_under_the_name_of_the_command():
    command = snakemake_command(["--help"])
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert printed.startswith("usage: lube run ") and "--configfile" in printed


def test_the_repository_is_that_of_the_current_folder_or_of_the_package(monkeypatch, tmp_path):
    assert repository(ROOT / "workflow" / "config") == repository(tmp_path) == ROOT
    clone = tmp_path / "clone"
    (clone / "workflow/rules").mkdir(parents=True)
    for name in ("Snakefile", "workflow/rules/study.smk"):
        (clone / name).touch()
    assert repository(clone / "workflow") == clone
    monkeypatch.setattr(module, "ROOT", tmp_path / "gone")
    assert "need a clone of its repository" in one_line(LubeError, repository, tmp_path)


@pytest.mark.slow
def test_it_plans_the_study_from_another_folder(tmp_path):
    command = [sys.executable, "-m", "lube.cli", "run", str(SMOKE), "-n", "--quiet"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
