"""The origin of a result: fingerprints that agree, and differences named in words."""

import hashlib
import json

import pytest
import xarray as xr

from lube.errors import DataError
from lube.schema import FILES
from lube.storage.netcdf import save
from lube.storage.provenance import (
    LIBRARIES,
    check_config,
    config_text,
    digest,
    fingerprints,
    global_attributes,
    merged_config,
)
from lube.study.oil_properties import lubricant_table


def made_by(study, kind):
    """A dataset that has nothing but its origin."""
    return xr.Dataset(attrs=global_attributes(study, kind))


@pytest.fixture
def stronger(study):
    """The study with a stronger boundary layer."""
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e6})
    return study.model_copy(update={"boundary_layer": layer})


def test_every_file_states_the_studys_values_and_their_sha256(study):
    for kind in FILES:
        attributes = global_attributes(study, kind)
        stage = kind.removesuffix("_batch")
        config = json.loads(attributes["config"])
        assert config[stage] == json.loads(json.dumps(study.stage_inputs(stage)))
        expected = hashlib.sha256(attributes["config"].encode()).hexdigest()
        assert attributes["config_sha256"] == expected
        assert attributes["study_seed"] == study.seed


def test_files_with_values_of_measured_records_say_so(study):
    experiment = study.experiment.model_copy(update={"manifest": "records.csv"})
    measured = study.model_copy(update={"experiment": experiment})
    for kind in ("experiment", "comparison", "gauge", "areal_gauge", "record_bands"):
        assert global_attributes(study, kind)["source"].startswith("simulation by lube")
        assert global_attributes(measured, kind)["source"].startswith("records of a rig")
    assert global_attributes(measured, "contact")["source"].startswith("simulation by lube")


def test_the_title_of_an_oil_is_no_value_and_in_no_byte_of_the_lubricant_file(study, tmp_path):
    found = set()
    for title in ("Mobilgear SHC XMP 320", "My <oil>"):
        (oil,) = (record.model_copy(update={"title": title}) for record in study.lubricants)
        mine = study.model_copy(update={"lubricants": (oil,)})
        assert mine.stage_inputs("lubricant") == study.stage_inputs("lubricant")
        table = lubricant_table(mine.lubricants, mine.operating_grid.temperature)
        save(table, tmp_path / "lubricant.nc", "lubricant", mine)
        found.add((tmp_path / "lubricant.nc").read_bytes())
    assert len(found) == 1
    oil = oil.model_copy(update={"viscosity_law": "vogel"})
    other = study.model_copy(update={"lubricants": (oil,)})
    assert other.stage_inputs("lubricant") != study.stage_inputs("lubricant")


def test_files_name_the_creators_and_the_libraries(study):
    creators = [{"name": "Popov, V.", "affiliation": "Berlin"}, {"name": "Li, Q."}]
    about = study.about.model_validate({"title": "My rollers", "creators": creators})
    attributes = global_attributes(study.model_copy(update={"about": about}), "film")
    assert attributes["title"] == "My rollers, film"
    assert attributes["creator_name"] == "Popov, V.; Li, Q."
    assert attributes["creator_institution"] == "Berlin; -"
    assert attributes["license"].startswith("CC-BY-4.0 https://")
    assert all(f"{name} " in attributes["software"] for name in LIBRARIES)


def test_inputs_are_listed_by_name_and_sha256_wherever_they_are(study, tmp_path):
    expected = {
        "list.csv": digest("file"),
        f"run.csv#{digest('monday')[:10]}": digest("monday"),
        f"run.csv#{digest('tuesday')[:10]}": digest("tuesday"),
    }
    for folder in ("here", "else/where"):
        texts = {"list.csv": "file", "a/run.csv": "monday", "b/run.csv": "tuesday"}
        for name, text in texts.items():
            (tmp_path / folder / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / folder / name).write_text(text)
        paths = [tmp_path / folder / name for name in texts]
        assert fingerprints(paths) == expected
    attributes = global_attributes(study, "experiment", paths)
    assert json.loads(attributes["inputs_sha256"]) == expected
    assert attributes["history"].endswith("made from " + ", ".join(sorted(expected)))


def test_a_missing_input_is_named(tmp_path):
    with pytest.raises(DataError, match=r"gone.csv: cannot be read: No such file"):
        fingerprints([tmp_path / "gone.csv"])


def test_a_file_of_other_values_is_refused_with_the_first_difference(study, stronger):
    expected = (
        r"contact.nc: made from other values than this study's: contact.boundary_layer."
        r"shear_strength is 2000000.0, need 1000000.0; delete it and run snakemake again"
    )
    check_config(made_by(study, "contact"), study, "contact", "contact.nc")
    with pytest.raises(DataError, match=expected):
        check_config(made_by(stronger, "contact"), study, "contact", "contact.nc")
    check_config(made_by(stronger, "film"), study, "film", "film.nc")  # a film has no layer
    with pytest.raises(DataError, match=r"contact\..* is missing, need"):
        check_config(made_by(study, "film"), study, "contact", "film.nc")


def test_the_values_of_several_files_are_merged(study):
    contact, film = (made_by(study, kind) for kind in ("contact", "film"))
    assert merged_config([film]) == config_text(study, "film")
    assert merged_config([film, contact]) == config_text(study, "contact")
