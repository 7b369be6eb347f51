"""What goes into an archive, and where; workflow/test_archived_study.py makes a whole one."""

import json
import re
import shutil

import pytest
import yaml
from studies import ROOT

from lube.archive.build import VALUES, archive_contents, exact_versions, make_archive, written_files
from lube.errors import DataError, StudyError
from lube.storage.provenance import config_text, digest
from lube.study.resolve import resolved_content
from lube.study.study import load_study


@pytest.fixture
def own(tmp_path):
    """A study with a lubricant record and a list of measured records of its own."""
    shipped = ROOT / "lube/study/lubricants/mobilgear-shc-xmp-320.yaml"
    record = yaml.safe_load(shipped.read_text("utf-8")) | {"name": "mine"}
    study = resolved_content(ROOT / "workflow/config/smoke.yaml")
    study["lubricants"] = ["mobilgear-shc-xmp-320", "../oils/mine.yaml"]
    study["experiment"]["manifest"] = "records/list.csv"
    for name in ("oils", "studies/records"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "oils/mine.yaml").write_text(yaml.safe_dump(record), encoding="utf-8")
    (tmp_path / "studies/records/list.csv").write_text("file, force [N]\n", encoding="utf-8")
    (tmp_path / "studies/study.yaml").write_text(yaml.safe_dump(study), encoding="utf-8")
    return tmp_path / "studies/study.yaml"


def test_what_people_wrote_keeps_its_place_towards_one_another(own, tmp_path):
    contents = archive_contents(load_study(own), own, tmp_path / "results", ["film"], [])
    written = {name for name in contents if name.startswith(("study/", "lubricants/"))}
    assert written == {
        *("study/studies/study.yaml", "study/studies/records/list.csv", "study/oils/mine.yaml"),
        *("lubricants/mine.yaml", "lubricants/mobilgear-shc-xmp-320.yaml"),
    }
    assert contents["study/oils/mine.yaml"].samefile(tmp_path / "oils/mine.yaml")
    assert json.loads(contents[VALUES])["study_file"] == "studies/study.yaml"


@pytest.mark.parametrize("place", ["lubricants", "manifest"])
def test_an_absolute_path_is_refused(own, place):
    study = yaml.safe_load(own.read_text("utf-8"))
    if place == "manifest":
        named = study["experiment"]["manifest"] = str(own.parent / "records/list.csv")
    else:
        named = study["lubricants"][1] = str(own.parent.parent / "oils/mine.yaml")
    own.write_text(yaml.safe_dump(study), encoding="utf-8")
    with pytest.raises(StudyError, match="need the straight path from the study's") as caught:
        written_files(load_study(own), own)
    assert named[:40] in str(caught.value)


@pytest.mark.parametrize("way", ["../studies/mine.yaml", "records/../mine.yaml"])
def test_a_way_through_folders_that_are_not_archived_is_refused(own, tmp_path, way):
    shutil.copy(tmp_path / "oils/mine.yaml", own.with_name("mine.yaml"))
    study = yaml.safe_load(own.read_text("utf-8"))
    study["lubricants"][1] = way
    own.write_text(yaml.safe_dump(study), encoding="utf-8")
    told = f"got '{way}', need the straight path from the study's folder, 'mine.yaml'"
    with pytest.raises(StudyError, match=re.escape(told)):
        written_files(load_study(own), own)


def test_a_study_may_have_the_name_of_any_file_of_the_archive(own, tmp_path):
    own = own.rename(own.with_name(VALUES))
    contents = archive_contents(load_study(own), own, tmp_path / "results", ["film"], [])
    assert contents[f"study/studies/{VALUES}"].samefile(own)
    assert json.loads(contents[VALUES])["study_file"] == f"studies/{VALUES}"


def test_records_of_one_file_name_are_both_there(own, tmp_path):
    oil = yaml.safe_load((tmp_path / "oils/mine.yaml").read_text("utf-8")) | {"name": "other"}
    same = own.parent / "mobilgear-shc-xmp-320.yaml"
    same.write_text(yaml.safe_dump(oil), encoding="utf-8")
    study = yaml.safe_load(own.read_text("utf-8"))
    study["lubricants"].append(same.name)
    own.write_text(yaml.safe_dump(study), encoding="utf-8")
    contents = archive_contents(load_study(own), own, tmp_path / "results", ["film"], [])
    assert contents["lubricants/other/mobilgear-shc-xmp-320.yaml"].samefile(same)
    shipped = contents["lubricants/mobilgear-shc-xmp-320/mobilgear-shc-xmp-320.yaml"]
    assert shipped.is_relative_to(ROOT / "lube/study/lubricants")
    assert contents["study/studies/mobilgear-shc-xmp-320.yaml"].samefile(same)


def test_a_record_behind_a_link_is_taken_where_the_study_looks_for_it(own, tmp_path):
    record = tmp_path / "oils/mine.yaml"
    record.rename(tmp_path / "elsewhere.yaml")
    record.symlink_to(tmp_path / "elsewhere.yaml")
    assert "oils/mine.yaml" in written_files(load_study(own), own)


def test_a_shipped_record_named_by_its_path_stands_where_it_leads(own, tmp_path):
    shutil.copytree(ROOT / "lube/study/lubricants", tmp_path / "lube/study/lubricants")
    study = yaml.safe_load(own.read_text("utf-8"))
    study["lubricants"][0] = "../lube/study/lubricants/n-dodecane.yaml"
    study["operating_grid"]["temperature"]["values"] = [40, 50]
    study["traces"] = [{"force": "800 N", "speed": "100 rpm", "temperature": "40 degC"}]
    own.write_text(yaml.safe_dump(study), encoding="utf-8")
    assert "lube/study/lubricants/n-dodecane.yaml" in written_files(load_study(own), own)


def test_the_values_are_those_behind_the_files(study, tmp_path):
    file = ROOT / "workflow/config/smoke.yaml"
    told = json.loads(archive_contents(study, file, tmp_path, ["film", "contact"], [])[VALUES])
    assert told["config_sha256"] == {
        kind: digest(config_text(study, kind)) for kind in ("film", "contact")
    }
    assert set(told["values"]) == {"lubricant", "film", "roughness", "contact"}


def test_results_are_taken_as_datasets_pictures_and_notebooks(study, tmp_path):
    file = ROOT / "workflow/config/smoke.yaml"
    contents = archive_contents(study, file, tmp_path, ["film"], ["fig02_film"])
    assert contents["data/film.nc"] == tmp_path / "film.nc"
    drawn = [f"figures/fig02_film.{suffix}" for suffix in ("png", "pdf", "json")]
    for name in (*drawn, "notebooks/fig02_film.ipynb"):
        assert contents[name] == tmp_path / name


def test_versions_are_fit_for_pip():
    system, *lines = exact_versions().splitlines()
    assert system.startswith("# Python 3.")
    assert all(line.count("==") == 1 for line in lines)
    assert not [line for line in lines if line.startswith("lube==")]


def test_a_missing_result_is_named_and_the_old_archive_stays(study, tmp_path):
    (tmp_path / "archive").mkdir()
    (tmp_path / "archive/README.md").write_text("old")
    file = ROOT / "workflow/config/smoke.yaml"
    with pytest.raises(DataError, match=r"archive: cannot be archived: .*film.nc: No such file"):
        make_archive(study, file, tmp_path, ["film"], [], tmp_path / "archive")
    assert (tmp_path / "archive/README.md").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["archive"]


def test_a_figure_that_the_workflow_did_not_make_is_refused_and_the_old_archive_stays(
    study, tmp_path
):
    (tmp_path / "archive").mkdir()
    (tmp_path / "archive/README.md").write_text("old")
    file = ROOT / "workflow/config/smoke.yaml"
    told = r"figures/fig02_film.json: missing or damaged; take it away and run snakemake again"
    with pytest.raises(DataError, match=told):
        make_archive(study, file, tmp_path, [], ["fig02_film"], tmp_path / "archive")
    assert (tmp_path / "archive/README.md").read_text() == "old"
