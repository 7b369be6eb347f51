"""Bad input: one clear line before any job, non-zero exit, nothing overwritten."""

import json
import os
import shutil
from pathlib import Path

import pytest
import yaml
from repository import COPIED, SMOKE

PROFILE_NOTE = "Using workflow specific profile"


def refusal(repository, *arguments, study):
    """The one line that Snakemake says of a study that cannot start; results stay as they are."""
    before = repository.snapshot()
    finished = repository.snakemake(*arguments, study=study)
    assert finished.returncode != 0
    assert repository.snapshot() == before
    said = [line for line in finished.stdout.splitlines() if not line.startswith(PROFILE_NOTE)]
    assert len(said) == 1, finished.stdout
    assert said[0].startswith("The study cannot start. ")
    return said[0]


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"colour": "blue"}, "mine.yaml: colour: unknown key"),
        ({"rollers__length": 10}, "rollers.length: got 10, need a number with its unit"),
        ({"operating_grid__force": {"values": [2, 1], "units": "N"}}, "need rising levels"),
        ({"operating_grid__temperature": {"values": [20], "units": "degC"}}, "got 20 degC, need"),
        ({"lubricants": ["nope"]}, "got 'nope', need one of"),
        ({"roughness__points": 1000}, "too coarse a grid"),
        ({"kept_realisations": [0, 4]}, "got 4, need realisations from 0 to 3"),
        ({"traces": [{"force": "1 N", "speed": "100 rpm", "temperature": "40 degC"}]}, "got 1.0"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_a_mistaken_study_ends_in_one_line_before_any_job(smoke, changes, told):
    assert told in refusal(smoke, study=smoke.with_values(**changes))


def test_a_name_that_snakemake_takes_for_a_wildcard_is_refused(spare):
    shipped = (spare / "lube/study/lubricants/mobilgear-shc-xmp-320.yaml").read_text("utf-8")
    (spare / "{oil}.yaml").write_text(shipped, encoding="utf-8")
    message = refusal(spare, study=spare.with_values(lubricants=["{oil}.yaml"]))
    assert "{oil}.yaml: got a name with braces, need one without" in message


def test_a_study_whose_name_does_not_fit_a_line_is_refused(spare):
    study = shutil.copy(spare / SMOKE, spare / "my\u2028\n\udcffstudy.yaml")
    message = refusal(spare, study=study.name)
    assert "study.yaml: got a name with an invisible character, need one without" in message


def test_values_on_the_command_line_are_refused(smoke):
    assert "--config is not used" in refusal(smoke, "--config", "seed=3", study=SMOKE)


def test_two_studies_at_once_are_refused(smoke):
    study = smoke.with_values()
    finished = smoke.snakemake("--configfile", SMOKE, study, study=None)
    assert finished.returncode != 0
    assert "got several --configfile, need one" in finished.stdout


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (b"name: [1\n", "not valid YAML at line 2"),
        (b"- name\n", "need a mapping of keys to values"),
        (b"\xff\xfe", "it is not UTF-8 text"),
        (b"a: " + b"[" * 5000, "not valid YAML"),
    ],
    ids=["torn", "list", "binary", "deep"],
)
def test_what_is_no_yaml_mapping_is_refused(smoke, text, told):
    (smoke / "broken.yaml").write_bytes(text)
    assert told in refusal(smoke, study="broken.yaml")


def test_a_study_that_is_no_file_is_refused_at_once(smoke):
    os.mkfifo(smoke / "pipe.yaml")
    try:
        assert "no folder, pipe or device" in refusal(smoke, study="pipe.yaml")
    finally:
        (smoke / "pipe.yaml").unlink()
    assert "No such file" in refusal(smoke, study="absent.yaml")


@pytest.mark.parametrize(
    "template", ["seed: ?{touch} or 1\n", '__definitions__: ["{touch}"]\nseed: 1.5\n']
)
def test_no_python_in_a_study_is_executed(smoke, template):
    canary = smoke / "canary"
    text = template.format(touch=f"__import__('pathlib').Path('{canary}').touch()")
    study = (smoke / SMOKE).read_text("utf-8").replace("seed: 20181109\n", text)
    (smoke / "evil.yaml").write_text(f"__use_yte__: true\n{study}", encoding="utf-8")
    assert "evil.yaml: seed: got" in refusal(smoke, study="evil.yaml")
    assert not canary.exists()


def test_both_profiles_keep_snakemake_from_reading_the_study(smoke):
    """Snakemake would evaluate a --configfile that says `__use_yte__`."""
    ours, slurm = (
        yaml.safe_load((smoke / f"profiles/{name}/config.yaml").read_text("utf-8"))
        for name in ("default", "slurm")
    )
    assert ours["__use_yte__"] is slurm["__use_yte__"] is True
    assert ours["__definitions__"] == slurm["__definitions__"]


def test_a_study_writes_nothing_outside_its_results(smoke):
    """Beside the copied repository there is what was run for, and what Snakemake keeps."""
    copied = {path.parts[0] for path in map(Path, COPIED)}
    made = {path.name for path in smoke.folder.iterdir()} - copied
    ours = {"said", "mine.yaml", "broken.yaml", "evil.yaml", "submit"}
    assert made - ours <= {"results", ".snakemake"}
    assert [path.name for path in (smoke / "results").iterdir()] == ["smoke"]


def test_a_record_without_sources_is_refused(spare):
    shipped = (spare / "lube/study/lubricants/mobilgear-shc-xmp-320.yaml").read_text("utf-8")
    record = yaml.safe_load(shipped)
    del record["density"]["source"]
    (spare / "mine-oil.yaml").write_text(yaml.safe_dump(record), encoding="utf-8")
    message = refusal(spare, study=spare.with_values(lubricants=["mine-oil.yaml"]))
    assert "mine-oil.yaml: density.source: missing" in message


# Notebooks that cannot be figures


def test_a_notebook_that_snakemake_takes_for_a_pattern_is_refused(spare):
    shutil.copy(spare / f"notebooks/{spare.notebooks[0]}.ipynb", spare / "notebooks/a{b}.ipynb")
    message = refusal(spare, study=SMOKE)
    assert "a{b}.ipynb: got a name with braces, need one without" in message


def broken_notebook(repository, change):
    figure = repository.notebooks[0]
    path = repository / f"notebooks/{figure}.ipynb"
    notebook = json.loads(path.read_text("utf-8"))
    change(notebook["cells"])
    path.write_text(json.dumps(notebook), encoding="utf-8")
    return path.name


def test_a_notebook_that_is_no_python_is_refused(spare):
    def change(cells):
        cells[-1]["source"] = ["plot this nicely\n"]

    name = broken_notebook(spare, change)
    assert f"{name}: got 'plot this nicely', which is not Python" in refusal(spare, study=SMOKE)


def test_a_notebook_without_a_parameters_cell_is_refused(spare):
    def change(cells):
        for cell in cells:
            cell["metadata"] = {}

    name = broken_notebook(spare, change)
    assert f"{name}: no cell is tagged 'parameters'" in refusal(spare, study=SMOKE)


def test_a_damaged_notebook_is_refused(spare):
    (spare / "notebooks/fig99_mine.ipynb").write_text('{"cells": [', encoding="utf-8")
    assert "fig99_mine.ipynb: not a Jupyter notebook" in refusal(spare, study=SMOKE)


# Datasets that a job cannot use


def failure(repository, target):
    """What a failing job says on the terminal, and its log."""
    finished = repository.snakemake(f"results/smoke/{target}.nc")
    assert finished.returncode != 0
    assert "Traceback" not in finished.stdout
    log = (repository.results / f"logs/{target}.log").read_text("utf-8")
    assert log.count("\n") == 1
    assert log in finished.stdout
    return log


def test_a_truncated_dataset_is_named_by_the_job_that_reads_it(spare):
    film = spare.results / "film.nc"
    film.write_bytes(film.read_bytes()[:20_000])
    assert "Error: results/smoke/film.nc: not a whole NetCDF file" in failure(spare, "trace")


def test_a_foreign_dataset_is_named_by_the_job_that_reads_it(spare):
    film = spare.results / "film.nc"
    film.write_bytes((spare.results / "lubricant.nc").read_bytes())
    assert "Error: results/smoke/film.nc: not a film file" in failure(spare, "trace")


def test_a_truncated_batch_is_named_when_batches_are_gathered(spare):
    batch = spare.results / "batches/contact_2.nc"
    batch.write_bytes(batch.read_bytes()[:5_000])
    assert "Error: results/smoke/batches/contact_2.nc: not a whole" in failure(spare, "contact")
