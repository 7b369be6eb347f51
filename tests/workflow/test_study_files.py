"""The files of a study as the rules name them."""

from types import SimpleNamespace

import pytest
from studies import SMOKE

from lube.study.metadata import About
from lube.study.study import load_study
from lube.workflow.study_files import StudyFiles, input_paths, one_line_errors

RECORD = "mobilgear-shc-xmp-320.yaml"


@pytest.fixture
def files(study):
    return StudyFiles(study, SMOKE, {})


def line_of(call, *arguments):
    """The line in which Snakemake ends."""
    with pytest.raises(SystemExit) as refused:
        call(*arguments)
    assert "\n" not in refused.value.code
    return refused.value.code


def test_inputs_are_named_from_the_working_folder_each_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert input_paths([tmp_path / "b", "a", tmp_path / "a"]) == ["a", "b"]


def test_a_name_that_snakemake_takes_for_a_wildcard_is_refused():
    line = line_of(one_line_errors()(input_paths), ["{oil}.yaml"])
    assert line == "The study cannot start. {oil}.yaml: got a name with braces, need one without"


def test_results_and_inputs_of_stages(files):
    assert files.result("film.nc") == "results/smoke/film.nc"
    assert files.stage_files("trace") == {
        "film": "results/smoke/film.nc",
        "roughness": "results/smoke/roughness.nc",
    }
    assert files.batches_of("contact") == [
        f"results/smoke/batches/contact_{first}.nc" for first in (0, 2)
    ]
    assert files.batch_limits(SimpleNamespace(first="2")) == (2, 3)
    assert [path.split("/")[-1] for path in files.record_files()] == [RECORD]


def test_fingerprints_follow_values_and_makers(files, study):
    def of(**changes):
        return StudyFiles(study.model_copy(update=changes), SMOKE, {}).stage_inputs

    for stage in ("film", "contact", "rig"):
        assert of(batch_size=1)(stage) == files.stage_inputs(stage)
        assert of(about=About(title="mine"))(stage) != files.stage_inputs(stage)
    assert of(seed=1)("film") == files.stage_inputs("film")
    assert of(seed=1)("rig") != files.stage_inputs("rig")  # by the experiment's values
    formulas = of(film_formulas=("moes",))
    assert formulas("contact") == files.stage_inputs("contact")  # which reads film.nc
    assert formulas("speed") != files.stage_inputs("speed")  # which reads no file
    assert files.stage_inputs("contact", "master") != files.stage_inputs("contact")


def test_a_manifest_and_its_records_are_inputs(paper_with, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    head = "file,force [N],speed [rpm],temperature [degC]\n"
    (tmp_path / "records.csv").write_text(f"{head}run.csv,800,100,40\nno.csv,800,100,40\n")
    (tmp_path / "run.csv").write_text("time [s],voltage [mV]\n0,50\n")
    path = paper_with(("experiment.manifest", "records.csv"))
    files = StudyFiles(load_study(path), path, {})
    assert files.measured_files() == ["records.csv", "run.csv"]
    assert files.refused_records() is None  # nothing evaluated yet


def test_without_a_manifest_there_are_no_measured_files(files):
    assert files.measured_files() == []
    assert files.refused_records() is None


def test_a_figures_products_are_named(files):
    assert set(files.products(["fig02_film"])) == {
        *(f"results/smoke/figures/fig02_film.{suffix}" for suffix in ("png", "pdf", "json")),
        "results/smoke/notebooks/fig02_film.ipynb",
    }


def test_steps_name_the_benchmarks_of_all_jobs(files):
    steps = files.benchmarks(["fig02_film"])
    assert steps["film"] == ["results/smoke/benchmarks/film.tsv"]
    assert steps["batches of realisations"] == [
        f"results/smoke/benchmarks/batch_{first}.tsv" for first in (0, 2)
    ]
    assert steps["figures"] == ["results/smoke/benchmarks/fig02_film.tsv"]
