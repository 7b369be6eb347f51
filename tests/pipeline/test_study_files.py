"""The files of a study as the rules name them."""

import pytest
from studies import SMOKE
from unlike_studies import STUDIES, write_study

from lube.pipeline.figure_list import study_figures
from lube.pipeline.study_files import StudyFiles, input_paths
from lube.study.metadata import About
from lube.study.study import load_study


@pytest.fixture
def files(study):
    return StudyFiles(study, SMOKE, {})


def test_a_target_that_the_study_lacks_is_refused_in_one_line(paper_with):
    path = paper_with(("film_shape", "computed"), ("name", "mine"))
    files = StudyFiles(load_study(path), path, {})
    files.check_targets(
        ["computed", "-n", "areal_contact", "archive", "results/mine/contact.nc"], {}
    )
    for target in ("areal_gauge", "master", "./results/mine/master.nc"):
        with pytest.raises(SystemExit, match=f"got the target {target}, need .*film_shape: flat"):
            files.check_targets(["--cores", "2", target], {})
    with pytest.raises(SystemExit, match="need a measured topography of a roller"):
        files.check_targets(["results/mine/surface.nc"], {})
    path = paper_with(("roughness_deformation", "venner-1997"), ("name", "mine"))
    files = StudyFiles(load_study(path), path, {})
    for target in ("areal_contact", "./results/mine/areal.nc", "sensitivity"):
        with pytest.raises(SystemExit, match=f"got the target {target}, need .*tion: none"):
            files.check_targets([target], {})


def test_a_target_makes_the_files_that_the_study_has_with_a_figure_or_without(paper_with):
    def made(*changes):
        path = paper_with(*changes, ("name", "mine"))
        study = load_study(path)
        made = StudyFiles(study, path, {}).made_by("areal_contact", study_figures(study))
        assert set(made) >= {
            f"results/mine/figures/fig39_surface_trace.{end}" for end in ("png", "pdf")
        }
        return [file.split("/")[-1] for file in made if file.endswith(".nc")]

    assert made() == ["areal.nc", "surface_trace.nc", "areal_gauge.nc"]
    assert made(("contact_model", ["surface"]), ("uncertainty", None)) == made()


def test_profiles_along_rolling_have_no_surface_to_press_or_to_count(tmp_path):
    path = write_study(STUDIES["insulator"], tmp_path / "mine")
    files = StudyFiles(load_study(path), path, {})
    for target in ("areal_contact", "patch_contact", "results/insulator/areal.nc"):
        with pytest.raises(SystemExit, match=f"the target {target}, need .*stand for surfaces"):
            files.check_targets([target], {})
    for target in ("rig", "results/insulator/experiment.nc", "comparison", "gauge"):
        with pytest.raises(SystemExit, match=f"the target {target}, need .*that conduct"):
            files.check_targets([target], {})


def test_a_sensitivity_study_is_checked_with_all_that_it_is_made_for(paper_with):
    path = paper_with(("load_sharing", "iterated"), ("name", "mine"))
    study = load_study(path)
    files, figures = StudyFiles(study, path, {}), study_figures(study)
    files.check_targets(["archive", "computed", "electrical", "results/mine/film.nc"], figures)
    results = "plan.nc", "figures/fig43_bands.png", "batches/sensitivity_runs_3.nc"
    asked = "sensitivity", "measurement_plan", "record_bands", *map(files.result, results)
    for target in asked:
        with pytest.raises(SystemExit, match="load_sharing: got iterated"):
            files.check_targets(["--cores", "2", target], figures)


def test_a_range_of_the_resistivity_alone_makes_no_sensitivity_study(paper_with):
    """No probability depends on it, so records are planned without one."""
    given = {"resistivity": {"range": "+- 10 %", "source": "assumed"}}
    path = paper_with(("uncertainty", given), ("name", "mine"))
    study = load_study(path)
    files = StudyFiles(study, path, {})
    files.check_targets(["measurement_plan", "electrical"], study_figures(study))
    with pytest.raises(SystemExit, match=r"the target sensitivity, need a section [^;]* on$"):
        files.check_targets(["sensitivity"], {})


def test_inputs_are_named_from_the_working_folder_each_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert input_paths([tmp_path / "b", "a", tmp_path / "a"]) == ["a", "b"]


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
