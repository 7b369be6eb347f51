"""A study that is based on another, and a study with changes by --config."""

import shutil
from functools import partial

import pytest
import yaml
from refusals import one_line
from studies import CONFIG, OIL, PAPER, PAPER_CONTENT, SMOKE

from lube.errors import StudyError
from lube.study.lubricant_record import SHIPPED_FOLDER
from lube.study.resolve import resolved_content, resolved_text, study_files
from lube.study.study import load_study

refusal = partial(one_line, StudyError)


@pytest.fixture
def write(tmp_path):
    """Write a study's content below a folder that has the paper's study, and return the file."""
    shutil.copy(PAPER, tmp_path)

    def write_study(file, /, **content):
        path = tmp_path / file
        path.parent.mkdir(exist_ok=True)
        path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
        return path

    return write_study


def test_mappings_are_merged_and_lists_and_single_values_replaced(write):
    grid, rollers = {"force": {"values": [800, 1600]}}, {"first": {"radius": "60 mm"}}
    own = {"seed": 3, "film_formulas": ["moes"], "rollers": rollers, "operating_grid": grid}
    path = write("mine.yaml", based_on="paper.yaml", name="mine", **own)
    content = resolved_content(path)
    first, force = content["rollers"]["first"], content["operating_grid"]["force"]
    assert first == PAPER_CONTENT["rollers"]["first"] | {"radius": "60 mm"}
    assert force == {"values": [800, 1600], "units": "N"}
    assert (content["seed"], content["film_formulas"]) == (3, ["moes"])
    assert {key for key in content if content[key] != PAPER_CONTENT[key]} == {"name", "about", *own}
    assert list(content) == list(PAPER_CONTENT)


def test_a_chain_of_files_is_followed_to_its_end(write, tmp_path):
    write("a.yaml", based_on="paper.yaml", name="a", seed=1, realisations=2)
    path = write("below/b.yaml", based_on="../a.yaml", name="b", realisations=3)
    content = resolved_content(path)
    assert (content["seed"], content["realisations"]) == (1, 3)
    files = [path, tmp_path / "a.yaml", tmp_path / "paper.yaml"]
    assert [file.resolve() for file in study_files(path)] == files
    assert study_files(PAPER) == [PAPER]


def test_paths_start_from_the_folder_of_the_file_that_holds_them(write, tmp_path):
    record = (SHIPPED_FOLDER / f"{OIL}.yaml").read_text("utf-8")
    write("oils/mine.yaml", **yaml.safe_load(record) | {"name": "mine"})
    write("list.csv")
    own = {"lubricants": [OIL, "oils/mine.yaml"], "experiment": {"manifest": "list.csv"}}
    write("base.yaml", based_on="paper.yaml", name="base", **own)
    path = write("below/b.yaml", based_on="../base.yaml", name="b")
    content = resolved_content(path)
    assert content["lubricants"] == [OIL, "../oils/mine.yaml"]
    assert content["experiment"]["manifest"] == "../list.csv"
    study = load_study(path)
    assert study.lubricants[1].files[0].samefile(tmp_path / "oils/mine.yaml")
    assert (tmp_path / "list.csv").samefile(study.experiment.manifest)
    (tmp_path / "results").mkdir()
    resolved = tmp_path / "results/study.yaml"
    resolved.write_text(resolved_text(path, folder=resolved.parent), encoding="utf-8")
    again = load_study(resolved)
    assert again.model_dump()["lubricants"] == study.model_dump()["lubricants"]
    assert (tmp_path / "list.csv").samefile(again.experiment.manifest)


@pytest.mark.parametrize("name", ["paper", "smoke", "slip", "thousand", "run-in", "oils"])
def test_the_resolved_text_is_the_same_study_in_one_file(tmp_path, name):
    path = CONFIG / f"{name}.yaml"
    (tmp_path / "resolved.yaml").write_text(resolved_text(path), encoding="utf-8")
    assert study_files(tmp_path / "resolved.yaml") == [tmp_path / "resolved.yaml"]
    assert load_study(tmp_path / "resolved.yaml") == load_study(path)


def test_changes_come_on_top_and_need_a_new_name():
    changes = {"name": "coarse", "roughness": {"points": 10_000}}
    study = load_study(SMOKE, changes)
    assert (study.name, study.roughness.points) == ("coarse", 10_000)
    assert study.roughness.hurst_exponent == load_study(SMOKE).roughness.hurst_exponent
    assert "changed by --config" in resolved_text(SMOKE, changes).splitlines()[0]
    assert load_study(SMOKE, {}) == load_study(SMOKE)
    for old in ({"seed": 3}, {"seed": 3, "name": "smoke"}):
        message = refusal(load_study, SMOKE, old)
        came = "got 'smoke'" if "name" in old else "missing"
        assert f"smoke.yaml: --config: name: {came}, need one other than 'smoke'" in message


def test_what_is_said_of_one_studys_results_is_not_said_of_anothers(write):
    base = PAPER_CONTENT["about"]
    assert {"title", "date"} <= set(base)
    path = write("mine.yaml", based_on="paper.yaml", name="mine", about={"licence": "CC0-1.0"})
    expected = {"creators": base["creators"], "licence": "CC0-1.0"}
    assert resolved_content(path)["about"] == expected
    assert load_study(path).title == "Mixed lubrication study mine"
    assert load_study(PAPER, {"name": "mine", "about": {"title": "Mine"}}).title == "Mine"


def test_a_study_based_on_another_needs_a_name_of_its_own(write):
    for content in ({}, {"name": "paper"}):
        path = write("mine.yaml", based_on="paper.yaml", seed=3, **content)
        assert "need one other than 'paper'" in refusal(load_study, path)


def test_a_circle_and_a_missing_base_are_refused(write):
    write("a.yaml", based_on="b.yaml", name="a")
    path = write("b.yaml", based_on="a.yaml", name="b")
    message = refusal(load_study, path)
    assert message.endswith("got the circle b.yaml -> a.yaml -> b.yaml, need a chain that ends")
    for base in ("papers.yaml", 3, ["paper.yaml"], "."):
        path = write("mine.yaml", based_on=base, name="mine")
        message = refusal(load_study, path)
        assert f"mine.yaml: based_on: got {base!r}, need the path from this file" in message
