"""An operating point of contact.nc is traced to its origin and computed again to the last bit."""

import shutil
from itertools import product

import numpy as np
import pytest
import xarray as xr
from made import made

from lube.archive.explain import explain, in_words
from lube.contact.ensemble import gather
from lube.contact.rough_pair import roughness_batch
from lube.errors import DataError
from lube.schema import CONTACT_DIMS
from lube.schema.stages import STAGES
from lube.stages.contact import contact_statistics
from lube.stages.film import film_table
from lube.storage.netcdf import save
from lube.study.oil_properties import lubricant_table

POINT = {"force": 1600.0, "speed": 100.0, "temperature": 80.0}
REALISATIONS = 9  # from eight on, NumPy sums pairwise


CORRECTED = {
    "inlet_shear_heating": "zhu-cheng-1988",
    "inlet_meniscus": 0.4e-3,
    "load_sharing": "iterated",
}


@pytest.fixture(scope="module")
def folder(study, tmp_path_factory):
    """Contact results of the smoke study on a coarser grid, and the files they were made from."""
    return results(study, tmp_path_factory.mktemp("study"))


def results(study, folder):
    """A folder with the results of a study on a coarser grid."""
    coarse = study.roughness.model_copy(update={"points": 12_000})
    study = study.model_copy(update={"roughness": coarse})
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants, grid.temperature)
    levels = grid.force, grid.speed, study.film_formulas
    corrections = {"slide_to_roll_ratio": study.slips, **study.film_model}
    film = film_table(oil, study.rollers, *levels, **corrections)
    lines = roughness_batch(study.line_spec, study.seed, range(REALISATIONS))
    run = study.boundary_layer, study.slips, study.revolutions, study.gap
    run = contact_statistics(lines, film, *run)
    save(oil, folder / "lubricant.nc", "lubricant", study)
    save(film, folder / "film.nc", "film", study, [folder / "lubricant.nc"])
    save(gather([run], film), folder / "contact.nc", "contact", study, [folder / "film.nc"])
    return folder


@pytest.fixture
def copied(folder, tmp_path):
    """Contact results and the files they were made from, free to be changed."""
    return shutil.copytree(folder, tmp_path, dirs_exist_ok=True) / "contact.nc"


def test_realisations_are_computed_again_to_the_last_bit(folder):
    others = {"film_formula": "pan-hamrock", "slide_to_roll_ratio": 0.1}
    for point, realisation in ((POINT, 0), (POINT | others, 2), (POINT | {"force": 800.0}, 8)):
        result = explain(folder / "contact.nc", realisation, **point)
        assert result.differing == []
        assert result.again["realisation"].values.tolist() == [realisation]
        with xr.open_dataset(folder / "contact.nc") as contact:
            names = {"film_formula": "paper", "slide_to_roll_ratio": 0.0} | point
            stored = contact.sel(realisation=realisation, **names)
            for name in result.again:
                np.testing.assert_array_equal(result.again[name].squeeze(), stored[name].squeeze())


def test_contact_of_lines_that_the_oil_answers_is_computed_again(study, tmp_path):
    changes = {"film_shape": "computed", "roughness_deformation": "computed"}
    folder = results(study.model_copy(update=changes), tmp_path)
    slip = {"film_formula": "paper", "slide_to_roll_ratio": 0.1}
    result = explain(folder / "contact.nc", 2, **POINT, **slip)
    assert result.differing == []
    assert result.again["geometric_contact_probability"].item() > 0.0


@pytest.fixture
def of_surfaces(study, few_surfaces, tmp_path):
    """Save contact of surfaces of the smoke study with changes, and what it was made from."""

    def run(**changes):
        choices = {"roughness": study.roughness.model_copy(update={"points": 12_000})}
        mine = study.model_copy(update={"contact_model": ("surface",)} | choices | changes)
        kinds = "lubricant", "film", "surface_response", "areal"
        datasets = made(mine, kinds if mine.gap.is_answered else (kinds[0], kinds[1], kinds[3]))
        for kind, dataset in datasets.items():
            inputs = [tmp_path / f"{one}.nc" for one in STAGES[kind].inputs]
            if kind == "areal" and mine.gap.is_answered:
                inputs.append(tmp_path / "surface_response.nc")
            save(dataset, tmp_path / f"{kind}.nc", kind, mine, inputs)
        return tmp_path / "areal.nc"

    return run


def test_contact_of_surfaces_is_computed_again_at_points_of_every_level(of_surfaces):
    path = of_surfaces()
    with xr.open_dataset(path) as areal:
        levels = [areal[name].values.tolist() for name in CONTACT_DIMS]
    for point in [*product(*levels)][::5]:
        result = explain(path, **dict(zip(CONTACT_DIMS, point, strict=True)))
        assert result.differing == []
        assert result.again["geometric_contact_probability"].item() > 0.0
    for formula, last in (("paper", 23), ("pan-hamrock", 5)):
        words = in_words(explain(path, film_formula=formula, **POINT))
        for stated in (f"s = 0 to {last}", "spawn(7)[5:]", "0.01 m", "the same bits"):
            assert stated in words
        assert "NOT" not in words and "realisation" not in words


def test_contact_of_surfaces_that_the_oil_answers_is_computed_again(of_surfaces, study):
    grid = study.operating_grid.model_copy(update={"temperature": (80.0,)})
    changes = {"film_shape": "computed", "roughness_deformation": "computed"}
    path = of_surfaces(operating_grid=grid, film_formulas=("paper",), **changes)
    result = explain(path, slide_to_roll_ratio=0.1, force=1600.0, speed=100.0)
    assert result.differing == []
    assert 0.0 < result.again["geometric_contact_probability"].item() <= 1.0


def test_mean_and_interval_are_computed_again_at_points_of_every_level(folder):
    """A point computed alone has the same bits as among all the others."""
    with xr.open_dataset(folder / "contact.nc") as contact:
        levels = [contact[name].values.tolist() for name in CONTACT_DIMS]
        results = set(contact.data_vars) - {"critical_thickness", "shear_strength"}
    for point in [*product(*levels)][::5]:
        result = explain(folder / "contact.nc", None, **dict(zip(CONTACT_DIMS, point, strict=True)))
        assert result.differing == []
        assert results <= set(result.again.data_vars)


def test_a_changed_number_is_found(copied):
    with xr.open_dataset(copied) as contact:
        changed = contact.load()
    changed["mean_contact_force"][:] = np.nextafter(changed["mean_contact_force"], np.inf)
    copied.unlink()
    changed.to_netcdf(copied)
    result = explain(copied, 1, **POINT)
    assert result.differing == ["mean_contact_force"]
    assert "NOT THE SAME" in in_words(result)


def test_an_explanation_states_what_determines_a_number(folder, study):
    words = in_words(explain(folder / "contact.nc", 2, **POINT))
    assert f"SeedSequence(({study.seed}, 2)).spawn(2)" in words
    for stated in ("1600.0 N", "80.0 degC", "entrainment speed", "5e-09 m", "the same bits"):
        assert stated in words
    words = in_words(explain(folder / "contact.nc", None, **POINT))
    assert f"all {REALISATIONS} realisations" in words
    assert "NOT" not in words


def test_a_corrected_film_is_explained_by_its_factors(study, tmp_path):
    lay = study.roughness.model_copy(update={"lay_ratio": 4.0, "lay_angle": 90.0})
    study = study.model_copy(update=CORRECTED | {"roughness": lay})
    path = results(study, tmp_path) / "contact.nc"
    result = explain(path, None, slide_to_roll_ratio=0.1, **POINT)
    assert result.differing == []
    words = in_words(result)
    for stated in (
        "film thickness relative to a flooded contact",
        "relative to that without inlet shear",
        "share of the load that the asperities of both surfaces carry",
        "length over width and angle to rolling",
        "4.0 and 90.0 deg",
    ):
        assert stated in words


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        (POINT | {"force": 700.0}, "force: got 700.0, need one of 800, 1600"),
        (POINT | {"film_formula": "nope"}, "film_formula: got nope, need one of paper, pan-h"),
        ({"force": 800.0}, "temperature: missing, need one of 40, 80"),
        (POINT | {"colour": 1}, "got colour, need coordinates of the file: slide_to_roll_ratio, "),
        (POINT | {"realisation": 9}, "realisation: got 9, need 0 to 8"),
    ],
)
def test_an_operating_point_that_does_not_exist_is_refused(folder, asked, expected):
    with pytest.raises(DataError, match=expected):
        explain(folder / "contact.nc", **asked)


def test_files_that_do_not_belong_together_are_refused(copied, study):
    oil = lubricant_table(study.lubricants, [40.0, 60.0, 80.0])
    save(oil, copied.with_name("lubricant.nc"), "lubricant", study)
    with pytest.raises(DataError, match=r"lubricant.nc: not the file that .*film.nc was made from"):
        explain(copied, **POINT)
