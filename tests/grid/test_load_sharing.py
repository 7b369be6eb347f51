"""Sharing of the load between oil and asperities."""

import numpy as np
import pytest
import xarray as xr

from lube.grid.load_sharing import MOST, share_load, surface_load_share
from lube.stages.film import film_table
from lube.study.oil_properties import lubricant_table
from lube.surfaces.contact_pressure import contact_pressure


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(points=200_000)


@pytest.fixture(scope="module")
def films(study, spec):
    """Films by two formulas, by shape and sharing of the load."""
    oil = lubricant_table(study.lubricants, [40.0, 80.0])
    levels = study.rollers, [200.0, 1600.0], [100.0], ["paper", "computed"]

    def made(with_shape, load_sharing):
        choices = {"rough_surfaces": spec, "load_sharing": load_sharing}
        return film_table(oil, *levels, with_shape, **choices)

    return {(shape, way): made(shape, way) for shape in (0, 1) for way in ("none", "iterated")}


def test_asperities_under_a_flat_film_carry_their_pressure_on_the_hertz_contact(films, study, spec):
    film = films[0, "none"].isel(film_formula=0, lubricant=0, temperature=1, speed=0, force=1)
    pressure = contact_pressure(spec, study.rollers.reduced_modulus, film["film_thickness"].values)
    area = 2.0 * film["contact_half_width"] * study.rollers.length
    expected = pressure * area / film["force"]
    assert film["surface_load_share"].item() == pytest.approx(expected.item(), rel=1e-9)
    assert 0.05 < expected < 0.5


def test_a_thinner_outlet_carries_more_than_a_flat_film(films):
    flat, shaped = (films[shape, "none"].isel(film_formula=1) for shape in (0, 1))
    ratio = shaped["surface_load_share"] / flat["surface_load_share"]
    assert ratio.sel(force=1600.0, temperature=40.0).item() > 1.2


@pytest.mark.parametrize("shape", [0, 1])
def test_the_film_is_that_of_the_load_that_the_asperities_leave(films, shape, study, spec):
    whole, shared = films[shape, "none"], films[shape, "iterated"]
    share = shared["surface_load_share"]
    again = surface_load_share(shared.drop_attrs(), spec, bool(shape))
    np.testing.assert_allclose(again, share, rtol=1e-9)
    assert share.max() > 0.1
    oil = lubricant_table(study.lubricants, [80.0])
    for formula in ("paper", "computed"):
        here = {"film_formula": formula, "temperature": 80.0, "force": 1600.0}
        left = 1600.0 * (1.0 - share.sel(here).item())
        alone = film_table(oil, study.rollers, [left], [100.0], [formula])
        found = shared["film_thickness"].sel(here).item()
        assert found == pytest.approx(alone["film_thickness"].item(), rel=1e-3)
        assert found != pytest.approx(whole["film_thickness"].sel(here).item(), rel=1e-3)


def test_the_starvation_is_that_of_the_film_which_carries_the_rest_of_the_load(study, spec):
    oil, meniscus = lubricant_table(study.lubricants, [80.0]), {"inlet_meniscus": 0.3e-3}
    levels = [100.0], ["paper", "computed"]
    sharing = {"rough_surfaces": spec, "load_sharing": "iterated"} | meniscus
    shared = film_table(oil, study.rollers, [1600.0], *levels, **sharing)
    for number in range(2):
        left = 1600.0 * (1.0 - shared["surface_load_share"].isel(film_formula=number).item())
        alone = film_table(oil, study.rollers, [left], *levels, **meniscus)
        found, expected = (
            each["starvation_factor"].isel(film_formula=number).item() for each in (shared, alone)
        )
        assert found == pytest.approx(expected, rel=1e-3) and found < 0.97


def test_without_a_balance_the_starvation_is_that_of_the_least_load_on_the_oil(study, spec):
    oil, levels = lubricant_table(study.lubricants, [80.0]), ([0.1], ["paper", "computed"])
    sharing = {"rough_surfaces": spec, "load_sharing": "iterated"}
    films = [
        film_table(oil, study.rollers, [load], *levels, inlet_meniscus=0.3e-3, **more).squeeze()
        for load, more in ((400.0, sharing), (400.0 * (1.0 - MOST), {}))
    ]
    assert (films[0]["surface_load_share"] > 1.0).all()
    shared, alone = (film["starvation_factor"].values for film in films)
    np.testing.assert_allclose(shared, alone, rtol=1e-3)


@pytest.mark.parametrize("formula", ["moes", "computed"])
def test_the_balance_is_found_where_asperities_carry_most_of_the_load(formula, study, spec):
    """With little load left rollers hardly deform, and the film is another power of the load."""
    oil = lubricant_table(study.lubricants, [80.0])
    conditions = oil, study.rollers, [100.0], [10.0, 15.0, 24.0], [formula]
    shared = film_table(*conditions, rough_surfaces=spec, load_sharing="iterated").squeeze()
    share, films = shared["surface_load_share"].values, shared["film_thickness"].values
    assert share[0] > 0.8 > share[-1] > 0.6
    for speed, part, film in zip(conditions[3], share, films, strict=True):
        alone = film_table(oil, study.rollers, [100.0 * (1.0 - part)], [speed], [formula])
        assert film == pytest.approx(alone["film_thickness"].item(), rel=2e-3)


def test_without_the_film_of_the_rest_of_the_load_there_is_no_balance(films, spec):
    whole = films[0, "none"].sel(film_formula="paper").isel(lubricant=0, force=1, speed=0)
    whole = whole.drop_attrs()

    def films_at(part):
        return whole["film_thickness"].where(part > 0.95)

    shared, share = share_load(whole, films_at, spec, False)
    assert whole["surface_load_share"].values[1] > 0.05 > whole["surface_load_share"].values[0]
    assert shared.isnull().values.tolist() == share.isnull().values.tolist() == [False, True]


def test_without_asperities_that_touch_nothing_changes(films):
    thick = {"film_formula": "paper", "temperature": 40.0, "force": 200.0}
    whole, shared = (films[0, way].sel(thick) for way in ("none", "iterated"))
    assert whole["surface_load_share"] < 1e-3
    xr.testing.assert_allclose(shared["film_thickness"], whole["film_thickness"], rtol=1e-3)
