"""What goes into an archive, and where; workflow/test_archived_study.py makes a whole one."""

import json
import re
import shutil

import pytest
import yaml
from studies import ROOT, SMOKE

from lube.archive.build import VALUES, archive_contents, exact_versions, make_archive, written_files
from lube.errors import DataError, StudyError
from lube.report import SUMMARISED
from lube.storage.netcdf import save
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study


@pytest.fixture
def own(tmp_path):
    """A study based on another, with a lubricant record and a manifest of its own."""
    shipped = ROOT / "lube/study/lubricants/mobilgear-shc-xmp-320.yaml"
    for name in ("oils", "studies/records"):
        (tmp_path / name).mkdir(parents=True)
    shutil.copytree(ROOT / "workflow/config", tmp_path / "config")
    text = shipped.read_text("utf-8").replace("name: mobilgear-shc-xmp-320", "name: mine")
    (tmp_path / "oils/mine.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "studies/records/list.csv").write_text("file, force [N]\n", encoding="utf-8")
    study = {
        "based_on": "../config/smoke.yaml",
        "name": "mine",
        "lubricants": ["mobilgear-shc-xmp-320", "../oils/mine.yaml"],
        "experiment": {"manifest": "records/list.csv"},
    }
    path = tmp_path / "studies/study.yaml"
    path.write_text(yaml.safe_dump(study), encoding="utf-8")
    return path


def change(path, **values):
    """Change some values of a study's file."""
    content = yaml.safe_load(path.read_text("utf-8")) | values
    path.write_text(yaml.safe_dump(content), encoding="utf-8")


def contents_of(path, archive):
    study, results = load_study(path), path.with_name("results")
    shutil.copytree(archive / "data", results)
    oils = lubricant_table(study.lubricants, study.operating_grid.temperature)
    save(oils, results / "lubricant.nc", "lubricant", study)
    return archive_contents(study, path, results, ["fig02_film"])


def test_a_study_is_archived_with_all_its_files_and_loads_from_there(own, archive, tmp_path):
    contents = contents_of(own, archive)
    written = {name for name in contents if name.startswith(("study/", "lubricants/"))}
    assert written == {
        "study/studies/study.yaml",
        "study/studies/records/list.csv",
        "study/oils/mine.yaml",
        "study/config/smoke.yaml",
        "study/config/paper.yaml",
        "lubricants/mine.yaml",
        "lubricants/mobilgear-shc-xmp-320.yaml",
    }
    for name in written:
        (tmp_path / "archive" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(contents[name], tmp_path / "archive" / name)
    study_file = json.loads(contents[VALUES])["study_file"]
    assert study_file == "studies/study.yaml"
    archived = load_study(tmp_path / "archive/study" / study_file)
    assert archived.stage_inputs("film") == load_study(own).stage_inputs("film")


def test_paths_that_would_not_resolve_in_an_archive_are_refused(own, tmp_path):
    shutil.copy(tmp_path / "oils/mine.yaml", own.with_name("mine.yaml"))
    oil, manifest = str(tmp_path / "oils/mine.yaml"), str(own.parent / "records/list.csv")
    for changed, direct in (
        ({"lubricants": [oil]}, "../oils/mine.yaml"),
        ({"experiment": {"manifest": manifest}}, "records/list.csv"),
        ({"lubricants": ["../studies/mine.yaml"]}, "mine.yaml"),
        ({"lubricants": ["records/../mine.yaml"]}, "mine.yaml"),
        ({"based_on": str(tmp_path / "config/smoke.yaml")}, "../config/smoke.yaml"),
    ):
        before = own.read_text("utf-8")
        change(own, **changed)
        expected = rf"got '.*, an archive needs the direct relative path, '{re.escape(direct)}'"
        with pytest.raises(StudyError, match=expected):
            written_files(load_study(own), own)
        own.write_text(before, encoding="utf-8")


def test_records_with_the_same_file_name_are_both_archived(own, archive, tmp_path):
    same = own.parent / "mobilgear-shc-xmp-320.yaml"
    shutil.copy(tmp_path / "oils/mine.yaml", same)
    change(own, lubricants=["mobilgear-shc-xmp-320", same.name])
    contents = contents_of(own, archive)
    assert contents["lubricants/mine/mobilgear-shc-xmp-320.yaml"].samefile(same)
    shipped = contents["lubricants/mobilgear-shc-xmp-320/mobilgear-shc-xmp-320.yaml"]
    assert shipped.is_relative_to(ROOT / "lube/study/lubricants")
    assert contents["study/studies/mobilgear-shc-xmp-320.yaml"].samefile(same)


def test_a_record_is_archived_where_the_study_names_it(own, tmp_path):
    record = tmp_path / "oils/mine.yaml"
    record.rename(tmp_path / "elsewhere.yaml")
    record.symlink_to(tmp_path / "elsewhere.yaml")
    assert "oils/mine.yaml" in written_files(load_study(own), own)
    # Also one that comes with the package, if it is given by its path.
    shutil.copytree(ROOT / "lube/study/lubricants", tmp_path / "lube/study/lubricants")
    change(own, lubricants=["../lube/study/lubricants/mobilgear-shc-xmp-320.yaml"])
    shipped = "lube/study/lubricants/mobilgear-shc-xmp-320.yaml"
    assert shipped in written_files(load_study(own), own)


def test_versions_are_fit_for_pip():
    system, *lines = exact_versions().splitlines()
    assert system.startswith("# Python 3.")
    assert all(line.count("==") == 1 for line in lines)
    assert not [line for line in lines if line.startswith("lube==")]


def test_an_archive_that_cannot_be_made_leaves_the_old_one(
    study, files, tmp_path, tmp_path_factory
):
    results = tmp_path_factory.mktemp("results")
    for kind in SUMMARISED:
        shutil.copy(files / f"{kind}.nc", results)
    archive = tmp_path / "archive"
    archive.mkdir()
    (archive / "README.md").write_text("old")
    for figures, expected in (
        ([], "archive: cannot be archived: No such file"),
        (["fig02_film"], r"fig02_film.json: missing or damaged; delete it and run snakemake"),
    ):
        with pytest.raises(DataError, match=expected):
            make_archive(study, SMOKE, results, figures, archive)
        assert (archive / "README.md").read_text() == "old"
        assert list(tmp_path.iterdir()) == [archive]


def test_datasets_made_on_request_are_archived_and_measured_times_are_not(study, archive, tmp_path):
    results = shutil.copytree(archive / "data", tmp_path / "results")
    without = archive_contents(study, SMOKE, results, [])
    for kind in ("areal", "speed", "film_profile"):
        (results / f"{kind}.nc").touch()
    contents = archive_contents(study, SMOKE, results, [])
    assert contents.keys() - without.keys() == {"data/areal.nc", "data/film_profile.nc"}
    assert {"areal", "film_profile"} < json.loads(contents[VALUES])["values"].keys()
    assert "| `data/areal.nc` |" in contents["README.md"]
    flattened = study.model_copy(update={"roughness_deformation": "venner-1997"})
    assert "areal" not in flattened.datasets_in(results)
