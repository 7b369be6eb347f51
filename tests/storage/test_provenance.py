"""Where a result comes from: fingerprints that agree, and differences told in words."""

import hashlib
import json

import pytest
import xarray as xr

from lube.errors import DataError
from lube.schema import FILES, SUMMARIES
from lube.storage.provenance import (
    LIBRARIES,
    check_config,
    check_origin,
    config_text,
    digest,
    fingerprints,
    global_attributes,
    merged_config,
    told_by,
    told_inputs,
)


def made_by(study, kind):
    """A dataset of which nothing matters but its origin."""
    return xr.Dataset(attrs=global_attributes(study, kind))


@pytest.fixture
def stronger(study):
    """The study with a stronger boundary layer."""
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e6})
    return study.model_copy(update={"boundary_layer": layer})


# What a file says


def test_every_kind_of_file_has_its_summary():
    assert set(SUMMARIES) == {kind for kind in FILES if not kind.endswith("_batch")}


@pytest.mark.parametrize("kind", FILES)
def test_the_values_are_the_studys_and_their_fingerprint_holds(study, kind):
    attributes = global_attributes(study, kind)
    stage = kind.removesuffix("_batch")
    config = json.loads(attributes["config"])
    assert config[stage] == json.loads(json.dumps(study.stage_inputs(stage)))
    expected = hashlib.sha256(attributes["config"].encode()).hexdigest()
    assert attributes["config_sha256"] == expected
    assert attributes["study_seed"] == study.seed


def test_files_name_the_makers_and_the_libraries_behind_the_numbers(study):
    creators = [{"name": "Popov, V.", "affiliation": "Berlin"}, {"name": "Li, Q."}]
    about = study.about.model_validate({"title": "My rollers", "creators": creators})
    attributes = global_attributes(study.model_copy(update={"about": about}), "film")
    assert attributes["title"] == "My rollers, film"
    assert attributes["creator_name"] == "Popov, V.; Li, Q."
    assert attributes["creator_institution"] == "Berlin; -"
    assert attributes["license"].startswith("CC-BY-4.0 https://")
    assert all(f"{name} " in attributes["software"] for name in LIBRARIES)


def test_values_that_change_no_result_change_no_fingerprint(study):
    larger = study.model_copy(update={"batch_size": 3, "name": "other"})
    assert config_text(larger, "contact") == config_text(study, "contact")


def test_inputs_are_told_by_name_and_fingerprint(study, tmp_path):
    for folder in ("monday", "tuesday"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "run.csv").write_text(folder)
    (tmp_path / "list.csv").write_text("file")
    paths = sorted(tmp_path.rglob("*.csv"))
    expected = {
        name: hashlib.sha256(text.encode()).hexdigest()
        for name, text in {
            "list.csv": "file",
            f"run.csv#{digest('monday')[:10]}": "monday",
            f"run.csv#{digest('tuesday')[:10]}": "tuesday",
        }.items()
    }
    assert fingerprints(paths) == expected
    attributes = global_attributes(study, "experiment", paths)
    assert json.loads(attributes["inputs_sha256"]) == expected
    assert attributes["history"].endswith("made from " + ", ".join(sorted(expected)))
    told = told_inputs(xr.Dataset(attrs=attributes), "experiment.nc")
    runs = {digest("monday"), digest("tuesday")}
    assert told == {"list.csv": {digest("file")}, "run.csv": runs}


def test_names_of_inputs_do_not_depend_on_where_they_lie(tmp_path):
    told = []
    for place in ("here", "else/where"):
        files = [tmp_path / place / name for name in ("film.nc", "a/run.csv", "b/run.csv")]
        for file in files:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(file.parent.name if file.suffix == ".csv" else "film")
        told.append(fingerprints(files))
    assert told[0] == told[1]
    assert told[0]["film.nc"] == digest("film")


def test_an_input_that_is_not_there_is_named(tmp_path):
    with pytest.raises(DataError, match=r"gone.csv: cannot be read: No such file"):
        fingerprints([tmp_path / "gone.csv"])


# Files that do not say where they come from


@pytest.mark.parametrize("name", ["title", "config", "config_sha256", "inputs_sha256", "software"])
def test_a_file_that_does_not_say_where_it_comes_from_is_refused(study, name):
    dataset = made_by(study, "film")
    check_origin(dataset, "film.nc")
    del dataset.attrs[name]
    with pytest.raises(DataError, match=f"film.nc: its attribute '{name}' is missing"):
        check_origin(dataset, "film.nc")


def test_a_file_whose_values_were_changed_by_hand_is_refused(study):
    dataset = made_by(study, "contact")
    dataset.attrs["config"] = dataset.attrs["config"].replace("5e-09", "9e-09")
    with pytest.raises(DataError, match=r"contact.nc: damaged or changed by hand: its attribute"):
        check_origin(dataset, "contact.nc")


def test_what_nobody_can_read_is_told():
    dataset = xr.Dataset(attrs={"config": "[" * 100_000})
    with pytest.raises(DataError, match="attribute 'config' is missing or damaged"):
        told_by(dataset, "config", "film.nc")


# Files of other values


def test_a_file_of_the_same_values_is_taken(study):
    check_config(made_by(study, "contact"), study, "contact", "contact.nc")


def test_a_file_of_other_values_is_refused_with_the_first_difference(study, stronger):
    told = (
        r"contact.nc: belongs to other values than this study's: contact.boundary_layer."
        r"shear_strength is 2000000.0, need 1000000.0; take it away and run snakemake again"
    )
    with pytest.raises(DataError, match=told):
        check_config(made_by(stronger, "contact"), study, "contact", "contact.nc")
    check_config(made_by(stronger, "film"), study, "film", "film.nc")  # no layer in a film


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda attributes: attributes.clear(), "it does not say which"),
        (lambda attributes: attributes.update(config_sha256="0"), "not that of its values"),
    ],
)
def test_a_file_without_honest_values_is_refused(study, spoil, told):
    dataset = made_by(study, "film")
    spoil(dataset.attrs)
    with pytest.raises(DataError, match=told):
        check_config(dataset, study, "film", "film.nc")


# Figures


def test_the_values_behind_one_file_are_its_own(study):
    assert merged_config([made_by(study, "film")]) == config_text(study, "film")


def test_a_file_that_holds_anothers_values_adds_nothing(study):
    contact, film = (made_by(study, kind) for kind in ("contact", "film"))
    assert merged_config([film, contact]) == config_text(study, "contact")
