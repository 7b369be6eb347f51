"""Bad input: one clear line before any job, non-zero exit, nothing overwritten.

Which line each mistake gets is tested in tests/study, test_command_line.py and test_figure_list.py.
"""

from repository import SMOKE

PROFILE_NOTE = "Using workflow specific profile"


def refusal(repository, *arguments, study=SMOKE):
    """The one line that Snakemake says of a study that cannot start; results stay as they are."""
    before = repository.snapshot()
    finished = repository.snakemake(*arguments, study=study)
    assert finished.returncode != 0
    assert repository.snapshot() == before
    said = [line for line in finished.stdout.splitlines() if not line.startswith(PROFILE_NOTE)]
    assert len(said) == 1, finished.stdout
    assert said[0].startswith("The study cannot start. ")
    return said[0]


def test_a_mistaken_study_is_refused_before_any_job(smoke):
    study = smoke.with_values(rollers__lenght="10 mm")
    assert "mine.yaml: rollers.lenght: unknown key" in refusal(smoke, study=study)


def test_what_snakemake_cannot_read_is_refused_in_one_line_too(smoke):
    profile = ("--workflow-profile", "profiles/slurm", "--executor", "local", "--cores", "1")
    said = refusal(smoke, *profile, study="absent.yaml")
    assert "absent.yaml: cannot be read: No such file" in said


def test_a_mistaken_command_is_refused_before_any_job(smoke):
    put_first = refusal(smoke, "--configfile", SMOKE, "archive", study=None)
    assert "`snakemake archive --configfile" in put_first


def test_a_notebook_that_is_no_figure_is_refused_before_any_job(spare):
    (spare / "notebooks/fig99_mine.ipynb").write_text('{"cells": [', encoding="utf-8")
    assert "fig99_mine.ipynb: not a Jupyter notebook" in refusal(spare)


def test_a_damaged_dataset_is_named_in_one_line_by_the_job_that_reads_it(spare):
    film = spare.results / "film.nc"
    film.write_bytes(film.read_bytes()[:20_000])
    finished = spare.snakemake("results/smoke/trace.nc")
    assert finished.returncode != 0
    assert "Traceback" not in finished.stdout
    log = (spare.results / "logs/trace.log").read_text("utf-8")
    assert log.startswith("Error: results/smoke/film.nc: ") and log.count("\n") == 1
    assert log in finished.stdout
