"""Heating at the inlet over loading and slip: the factors themselves, at the middle point."""

import numpy as np
import pytest
from made import made

from lube.ehl.line_contact import LineContact
from lube.grid.films import FilmGroups
from lube.physics.inlet_heating import heating_factor
from lube.stages.heating_plane import LOADINGS, SLIPS


@pytest.fixture(scope="module")
def files(busy_study):
    return made(busy_study, ("lubricant", "film", "heating_plane"))


def test_each_factor_is_that_of_its_model(files):
    plane = files["heating_plane"]
    pressure, film = (plane[f"relative_{name}"].item() for name in ("hertz_pressure", "film"))
    for model in plane["heating_model"].values:
        found = plane["inlet_shear_heating_factor"].sel(heating_model=model)
        for at in ((0, 0), (20, 10), (-1, -1)):
            expected = heating_factor(model, LOADINGS[at[0]], SLIPS[at[1]], pressure, film)
            np.testing.assert_allclose(found.values[at], expected, rtol=1e-12)


def test_pressure_and_film_are_those_of_the_middle_point(busy_study, files):
    film, oil = (files[name].isel(lubricant=0) for name in ("film", "lubricant"))
    at = {name: film[name].values[film.sizes[name] // 2] for name in ("speed", "force")}
    point, oil = film.sel(**at, temperature=80.0), oil.sel(temperature=80.0)
    groups = FilmGroups.at(oil, busy_study.rollers, at["force"], point)
    values = groups.load, groups.speed, groups.material, groups.viscosity, groups.film_modulus
    contact = LineContact(*map(float, values))
    plane = files["heating_plane"]
    assert plane["relative_film"].item() == pytest.approx(contact.film_guess, rel=1e-9)
    pressure = contact.hertz_pressure / contact.film_modulus
    assert plane["relative_hertz_pressure"].item() == pytest.approx(pressure, rel=1e-9)


def test_the_loading_of_the_operating_points_gives_the_films_own_factor(files):
    film, plane = files["film"].isel(slide_to_roll_ratio=0), files["heating_plane"]
    pressure = film["hertz_pressure"] / (2.0 * film["reduced_modulus"])
    loading = plane["operating_loading"].sel(temperature=60.0, speed=60.0).item()
    found = film["inlet_shear_heating_factor"].sel(temperature=60.0, speed=60.0).squeeze()
    expected = heating_factor("zhu-cheng-1988", loading, 0.0, pressure.values, np.nan)
    np.testing.assert_allclose(found, expected, rtol=1e-9)
