"""Response of the film to waves of surfaces, and contact of surfaces that the oil answers."""

import numpy as np
import pytest
from made import made

from lube.grid.film_responses import SURFACE_VARIABLES
from lube.schema import CONTACT_DIMS
from lube.stages import areal

pytestmark = pytest.mark.usefixtures("few_surfaces")

GRID = {"force": (400.0, 1600.0), "speed": (100.0,), "temperature": (40.0,)}
KINDS = ("lubricant", "film", "surface_response", "areal")


@pytest.fixture(scope="module")
def few(busy_study):
    """A study of two operating points and two slips, whose oil answers the roughness."""
    grid = busy_study.operating_grid.model_copy(update=GRID | {"slide_to_roll_ratio": (0.0, 0.5)})
    changes = {"operating_grid": grid, "roughness_deformation": "computed"}
    return busy_study.model_copy(update=changes)


@pytest.fixture(scope="module")
def files(few):
    return made(few, KINDS)


def test_waves_across_rolling_have_the_response_that_the_film_file_has(files):
    found = files["surface_response"].sel(wave_angle=0.0)
    film = files["film"].rename(response_position="film_position")
    for name in SURFACE_VARIABLES[:2]:
        expected = film[name.removeprefix("surface_")]
        np.testing.assert_array_equal(found[name], expected.transpose(*found[name].dims))


def test_the_oil_makes_contact_of_surfaces_rarer_and_the_more_with_slip(few, files):
    found = files["areal"]
    drawn = few.model_copy(update={"roughness_deformation": "none"})
    other = made(drawn, KINDS)["areal"]
    probability = found["geometric_contact_probability"]
    assert probability.dims == CONTACT_DIMS
    assert (probability.squeeze() < other["geometric_contact_probability"].squeeze()).all()
    rolling, sliding = (probability.sel(slide_to_roll_ratio=slip) for slip in (0.0, 0.5))
    assert (sliding < 0.9 * rolling).isel(force=-1).all()
    assert (found["expected_contacts"] < other["expected_contacts"]).all()


def test_threads_do_not_change_a_bit(few, files):
    assert areal.make(few, files, threads=1).identical(files["areal"])
