"""A number of contact.nc is traced to what it follows from, and made again to the last bit."""

import json
import shutil
from itertools import product

import numpy as np
import pytest
import xarray as xr

from lube.archive.explain import explain, in_words
from lube.errors import DataError
from lube.schema import CONTACT_DIMS
from lube.stages.contact import contact_statistics
from lube.stages.ensemble import gather
from lube.stages.film import film_table
from lube.stages.lubricant import lubricant_table
from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import save
from lube.storage.provenance import digest

PLACE = {"force": 1600.0, "speed": 100.0, "temperature": 80.0}
CELLS = [
    PLACE,
    PLACE | {"film_formula": "pan-hamrock", "slide_to_roll_ratio": 0.1},
    PLACE | {"speed": 86.0, "force": 800.0},
]

REALISATIONS = 9  # from eight on, NumPy's own sum would pair them


@pytest.fixture(scope="module")
def folder(study, tmp_path_factory):
    """The smoke study's answer on a coarser grid, and what it follows from, in one folder."""
    folder = tmp_path_factory.mktemp("study")
    coarse = study.roughness.model_copy(update={"points": 12_000})
    study = study.model_copy(update={"roughness": coarse})
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants, grid.temperature)
    film = film_table(oil, study.rollers, grid.force, grid.speed, study.film_formulas)
    lines = roughness_batch(study.line_spec, study.seed, range(REALISATIONS))
    run = contact_statistics(lines, film, study.boundary_layer, study.slips, study.revolutions)
    save(oil, folder / "lubricant.nc", "lubricant", study)
    save(film, folder / "film.nc", "film", study, [folder / "lubricant.nc"])
    save(gather([run], film), folder / "contact.nc", "contact", study, [folder / "film.nc"])
    return folder


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("realisation", [0, 2])
def test_a_realisation_is_made_again_to_the_last_bit(folder, cell, realisation):
    told = explain(folder / "contact.nc", realisation, **cell)
    assert told.differing == []
    assert told.again["realisation"].values.tolist() == [realisation]
    with xr.open_dataset(folder / "contact.nc") as contact:
        names = {name: cell.pop(name) for name in ("film_formula",) if name in cell}
        names.setdefault("film_formula", "paper")
        here = {"slide_to_roll_ratio": 0.0} | cell
        stored = contact.sel(realisation=realisation, **names).sel(here, method="nearest")
        for name in told.again:
            np.testing.assert_array_equal(told.again[name].squeeze(), stored[name].squeeze())


def test_mean_and_interval_are_made_again_at_every_point(folder):
    """One point by itself has the bits that it has among all the others."""
    with xr.open_dataset(folder / "contact.nc") as contact:
        levels = [contact[name].values.tolist() for name in CONTACT_DIMS]
        results = set(contact.data_vars) - {"critical_thickness", "shear_strength"}
    for point in product(*levels):
        told = explain(folder / "contact.nc", None, **dict(zip(CONTACT_DIMS, point, strict=True)))
        assert told.differing == []
        assert results <= set(told.again.data_vars)


def test_what_is_made_again_does_not_come_from_the_stored_results(folder, tmp_path):
    for path in folder.iterdir():
        shutil.copy(path, tmp_path)
    with xr.open_dataset(tmp_path / "contact.nc") as contact:
        emptied = contact.load()
    for name in emptied.data_vars:
        emptied[name].values[...] = np.nan
    emptied.to_netcdf(tmp_path / "emptied.nc")
    true, told = (
        explain(path, None, **PLACE) for path in (folder / "contact.nc", tmp_path / "emptied.nc")
    )
    xr.testing.assert_identical(told.again, true.again)
    assert set(told.differing) == set(told.again.data_vars)


def test_mean_and_interval_are_made_again_from_all_realisations(folder):
    told = explain(folder / "contact.nc", None, **PLACE)
    assert told.again["breakthrough_probability_upper"].size == 1
    assert f"all {REALISATIONS} realisations" in in_words(told)
    assert "NOT" not in in_words(told)


def test_a_number_that_was_changed_is_found_out(folder, study, tmp_path):
    for path in folder.iterdir():
        shutil.copy(path, tmp_path)
    with xr.open_dataset(tmp_path / "contact.nc") as contact:
        changed = contact.load()
    force = changed["mean_contact_force"].values
    force[...] = np.nextafter(force, np.inf)
    changed.to_netcdf(tmp_path / "changed.nc")
    told = explain(tmp_path / "changed.nc", 1, **PLACE)
    assert told.differing == ["mean_contact_force"]
    assert "NOT THE SAME" in in_words(told)


def test_an_explanation_tells_what_a_number_follows_from(folder, study):
    words = in_words(explain(folder / "contact.nc", 2, **PLACE))
    assert f"SeedSequence(({study.seed}, 2)).spawn(2)" in words
    for told in ("1600.0 N", "80.0 degC", "entrainment speed", "5e-09 m", "the same bits"):
        assert told in words
    assert "nominal load of a patch 2a x 2a" in words


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        (PLACE | {"force": 700.0}, "force: got 700.0, need one of 800, 1600"),
        (PLACE | {"film_formula": "nope"}, "film_formula: got nope, need one of paper, pan-h"),
        ({"force": 800.0}, "temperature: missing, need one of 40, 80"),
        (PLACE | {"colour": 1}, "got colour, need names among slide_to_roll_ratio, "),
        (PLACE | {"realisation": 9}, "realisation: got 9, need 0 to 8"),
    ],
)
def test_a_cell_that_is_not_there_is_refused(folder, asked, told):
    with pytest.raises(DataError, match=told):
        explain(folder / "contact.nc", **asked)


def test_a_folder_is_no_dataset(folder):
    with pytest.raises(DataError, match=r"got a folder, need a contact.nc; an archive's is in its"):
        explain(folder, **PLACE)


@pytest.mark.parametrize(
    "change",
    [
        lambda values: values.clear(),
        lambda values: values["contact"].pop("seed"),
        lambda values: values["contact"].update(seed=-1),
        lambda values: values["contact"].update(boundary_layer={}),
        lambda values: values["contact"].update(revolutions="x"),
    ],
)
def test_a_file_that_does_not_tell_how_it_was_made_is_refused(folder, tmp_path, change):
    for path in folder.iterdir():
        shutil.copy(path, tmp_path)
    with xr.open_dataset(tmp_path / "contact.nc") as contact:
        changed = contact.load()
    values = json.loads(changed.attrs["config"])
    change(values)
    changed.attrs["config"] = json.dumps(values)
    changed.attrs["config_sha256"] = digest(changed.attrs["config"])
    changed.to_netcdf(tmp_path / "changed.nc")
    with pytest.raises(DataError, match="'config' does not tell how it was made"):
        explain(tmp_path / "changed.nc", **PLACE)


def test_a_film_table_of_another_run_is_refused(folder, study, tmp_path):
    for path in folder.iterdir():
        shutil.copy(path, tmp_path)
    shutil.copy(folder / "film.nc", tmp_path / "lubricant.nc")
    with pytest.raises(DataError, match=r"lubricant.nc: not a lubricant file"):
        explain(tmp_path / "contact.nc", **PLACE)
    oil = lubricant_table(study.lubricants, [40.0, 60.0, 80.0])
    save(oil, tmp_path / "lubricant.nc", "lubricant", study)
    with pytest.raises(DataError, match=r"lubricant.nc: not the file that .*film.nc was made from"):
        explain(tmp_path / "contact.nc", **PLACE)
