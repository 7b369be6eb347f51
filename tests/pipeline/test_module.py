"""The workflow as a module of another repository, set up as the documentation says."""

import os
import re
import shutil

import pytest
import yaml
from repository import (
    ROOT,
    SNAKEMAKE,
    Repository,
    copy_of_the_repository,
    figures_in,
    products_of,
)
from studies import SMOKE_DATASETS

from lube.storage.netcdf import load

PAGE = (ROOT / "docs/as-a-module.md").read_text("utf-8")


def example(language):
    return re.search(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)[1]


@pytest.fixture
def other(tmp_path, monkeypatch):
    """Another repository, with a clone of this one, a study and a Snakefile."""
    monkeypatch.setenv("PATH", f"{SNAKEMAKE.parent}{os.pathsep}{os.environ['PATH']}")
    copy_of_the_repository(tmp_path / "lube")
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies/mine.yaml").write_text(example("yaml"), "utf-8")
    (tmp_path / "Snakefile").write_text(example("text"), "utf-8")
    return Repository(tmp_path)


def run(repository, *arguments):
    return repository.run("--cores", "2", *arguments, study=None)


def planned(repository):
    rows = [line.split("\t") for line in run(repository, "--summary").splitlines()]
    return {row[0] for row in rows if row[-1] == "update pending"}


def test_all_results_are_planned_in_the_other_repository(other):
    figures = figures_in(other / "lube/notebooks")
    results = {f"{kind}.nc" for kind in SMOKE_DATASETS}.union(*map(products_of, figures))
    made = planned(other)
    assert {"number.txt", *(f"results/mine/{name}" for name in results)} <= made
    assert all(name.startswith("results/mine/") for name in made - {"number.txt"})


def test_targets_go_by_their_names_there(other):
    shutil.copy2(ROOT / "notebooks/fig42_electrical.ipynb", other / "lube/notebooks")
    planned = run(other, "--dry-run", "lube_electrical", "lube_archive")
    (archive,) = re.findall(r"Job \d+: Archive.*\nReason: (.*)", planned)
    assert "results/mine/figures/fig42_electrical.png" in archive
    with open(other / "studies/mine.yaml", "a", encoding="utf-8") as study:
        study.write("resistivity: insulator\n")
    for target in ("lube_electrical", "results/mine/electrical.nc"):
        finished = other.snakemake("--dry-run", target, study=None)
        assert finished.returncode == 1
        assert "The study cannot start. studies/mine.yaml: got the target" in finished.stdout


@pytest.mark.slow
def test_snakefile_and_configuration_of_the_catalogue_do_as_well(other):
    """As snakedeploy sets up a repository: with a copy of the folder `config`."""
    shutil.copytree(ROOT / "config", other / "config")
    (other / "studies/mine.yaml").rename(other / "config/study.yaml")
    (other / "Snakefile").write_text(
        'configfile: "config/config.yaml"\n'
        "module lube:\n"
        '    snakefile: "lube/workflow/Snakefile"\n'
        "    config: config\n"
        "use rule * from lube\n",
        encoding="utf-8",
    )
    assert "results/mine/contact.nc" in planned(other)
    settings = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text("utf-8"))
    assert settings["usage"]["report"] is True


@pytest.mark.slow
def test_the_other_repository_gets_the_same_numbers_figures_report_and_archive(other, smoke):
    run(other)
    results = other / "results/mine"
    contact = load(results / "contact.nc", "contact")
    expected = load(smoke.results / "contact.nc", "contact").isel(realisation=[0, 1])
    assert contact.breakthrough_probability.equals(expected.breakthrough_probability)
    assert "the same bits" in (other / "number.txt").read_text("utf-8")
    assert "Nothing to be done" in run(other)
    run(other, "lube_archive")
    assert "nothing wrong" in run(other, "lube_verify")
    run(other, "--report")
    assert not (other / "lube/results").exists()
