"""The areal stage: contact of a surface over the rollers' length, beside its line and theory."""

import numpy as np
import pytest

from lube.errors import DataError
from lube.schema import CONTACT_DIMS
from lube.stages import areal, tail

SEED = 2
SLIPS = (0.0, 0.1)


@pytest.fixture(scope="module")
def make_areal(study):
    """Make the dataset of rollers of a length, on coarse lines; by another stage that of it."""

    # By default it is the contact width, which depends on the length.
    longest = study.line_spec.longest_wavelength
    roughness = {"points": 50_000, "longest_wavelength": longest}

    def make(film, length=0.01, slips=(0.0,), threads=1, stage=areal):
        grid = study.operating_grid.model_copy(update={"slide_to_roll_ratio": slips})
        changes = {
            "rollers": study.rollers.model_copy(update={"length": length}),
            "roughness": study.roughness.model_copy(update=roughness),
            "operating_grid": grid,
            "seed": SEED,
        }
        return stage.make(study.model_copy(update=changes), {"film": film}, threads)

    return make


@pytest.fixture(scope="module")
def few(film):
    return film.isel(film_formula=[0], temperature=[0, 2], speed=[1], force=[2, 4])


@pytest.fixture(scope="module")
def contacts(make_areal, few):
    return make_areal(few, slips=SLIPS)


# --- Theory and limits -------------------------------------------------------------------


def test_results_have_the_dimensions_of_the_contact_model_and_do_not_depend_on_slip(contacts):
    for name, array in contacts.data_vars.items():
        if name != "length":
            assert array.dims == CONTACT_DIMS
            if not name.endswith("_width"):
                assert np.all(array == array.isel(slide_to_roll_ratio=0))
    width = contacts["passage_width"]
    assert np.all(width.min("slide_to_roll_ratio") < width.sel(slide_to_roll_ratio=0.0))
    shorter = contacts["breakthrough_width"] / width
    assert np.all(shorter.sel(slide_to_roll_ratio=0.0) == 1.0)
    assert np.all(shorter <= 1.0) and shorter.min() < 0.9


def test_a_surface_touches_more_often_than_its_line_and_the_longer_the_more(
    contacts, few, make_areal
):
    line = make_areal(few, slips=SLIPS, stage=tail)
    short = make_areal(few, 0.001, SLIPS)
    name = "geometric_contact_probability"
    assert np.all(contacts[name] > line[name])
    rare = contacts[name] < 0.1
    assert rare.any()
    ratio = (contacts[name] / short[name]).where(rare)
    assert ratio.min() > 5.0 and ratio.max() < 11.0


def test_counted_contacts_are_those_of_theory_where_they_are_few(make_areal, few):
    """Theory counts contacts less the holes in them, which high films do not have."""
    rare = few.isel(temperature=[0], force=[0])
    contacts = make_areal(rare)
    half = (contacts["contacts_upper"] - contacts["contacts"]).item()
    deviation = (contacts["contacts"] - contacts["expected_contacts"]).item()
    assert abs(deviation) < 2.0 * half < 0.2 * contacts["contacts"].item()


def test_threads_do_not_change_a_bit(make_areal, few, contacts):
    other = make_areal(few, slips=SLIPS, threads=3)
    assert other.identical(contacts)


def test_rollers_shorter_than_the_contact_is_wide_are_refused(make_areal, few):
    with pytest.raises(DataError, match=r"rollers\.length: got 0\.0001 m, need the contact width"):
        make_areal(few, 1e-4)
