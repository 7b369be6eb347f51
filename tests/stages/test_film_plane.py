"""The plane of computed films: Moes' numbers, errors of the formulas, films that are not found."""

import numpy as np
import pytest
from paper_grid import MODULUS

from lube.ehl import line_contact
from lube.ehl.film_formulas import FORMULAS
from lube.ehl.line_contact import LineContact, solve
from lube.physics.dimensionless import moes_numbers
from lube.stages import film_plane as stage
from lube.study.lubricant_record import load_record
from lube.study.oil_properties import lubricant_table

OILS = ("mobilgear-shc-xmp-320", "n-dodecane")


@pytest.fixture
def few_levels(monkeypatch):
    monkeypatch.setattr(stage, "MOES_LOADS", np.array([0.1, 2.0, 30.0]))
    monkeypatch.setattr(stage, "MOES_MATERIALS", np.array([2.0, 8.0]))


@pytest.fixture
def oils():
    return lubricant_table([load_record(name) for name in OILS], [80.0, 40.0, 60.0, 70.0])


def contact_of(plane, lubricant, moes_load, moes_material):
    """Line contact at a place of the plane, from its Hertz pressure and the oil."""
    here = plane.sel(lubricant=lubricant)
    pressure = here["hertz_pressure"].sel(moes_load=moes_load, moes_material=moes_material).item()
    material = here["pressure_viscosity_coefficient"].item() * 2 * MODULUS
    load = 2 * np.pi * (pressure / (2 * MODULUS)) ** 2
    speed = 0.5 * (moes_material / material) ** 4
    viscosity = here["dynamic_viscosity"].item()
    return LineContact(load, speed, material, viscosity, 2 * MODULUS)


def test_films_and_errors_are_those_of_single_contacts(few_levels, oils, study):
    plane = stage.make(study, {"lubricant": oils})
    assert plane["temperature"].item() == 70.0
    assert plane.attrs["not_converged"] == 0
    for lubricant, at in [(OILS[0], (30.0, 8.0)), (OILS[1], (0.1, 2.0))]:
        contact = contact_of(plane, lubricant, *at)
        groups = contact.load, contact.speed, contact.material
        assert moes_numbers(*groups) == pytest.approx(at)
        profile, scale = solve(contact), np.sqrt(2 * contact.speed)
        here = plane.sel(lubricant=lubricant, moes_load=at[0], moes_material=at[1])
        for place in ("central", "minimum", "mean"):
            film = here[f"{place}_film_parameter"].item() * scale
            assert film == pytest.approx(getattr(profile, f"{place}_film"), rel=5e-6)
        for name in plane["film_formula"].values:
            row = FORMULAS[name]
            error = here["film_error"].sel(film_formula=name).item()
            found = row.evaluate(*groups) / getattr(profile, f"{row.thickness}_film") - 1.0
            assert error == pytest.approx(found, abs=1e-5)
    assert set(plane["film_formula"].values) == set(FORMULAS) - {"computed"}


def test_places_of_the_film(few_levels, oils, study):
    """The least film is the least; between flat rollers the mean is the central film."""
    plane = stage.make(study, {"lubricant": oils})
    least, mean, central = (
        plane[f"{place}_film_parameter"] for place in ("minimum", "mean", "central")
    )
    assert np.all(least < mean) and np.all(least < central)
    heavy = {"moes_load": 30.0}
    np.testing.assert_allclose(mean.sel(heavy), central.sel(heavy), rtol=0.05)
    # Rollers that hardly deform: the parabola x^2/2 is a^2/6 on average.
    light = {"moes_load": 0.1}
    parabola = 8.0 * 0.1 / np.pi / 6.0  # a^2 = 8 W/pi, and W = M (2U)^0.5
    rise = (mean - central).sel(light)
    assert np.all(rise > 0.8 * parabola) and np.all(rise < 1.01 * parabola)


def test_a_film_that_is_not_found_is_not_a_number_named_and_counted(
    few_levels, oils, study, monkeypatch, caplog
):
    def refuse_some(contact, meniscus):
        if contact.material > 3000.0:
            monkeypatch.setattr(line_contact, "_MOST_STEPS", 2)
        return solve(contact, meniscus)

    monkeypatch.setattr(line_contact, "solve", refuse_some)
    found = stage.make(study, {"lubricant": oils.isel(lubricant=[1, 0])})
    assert found.attrs["not_converged"] == len(caplog.records) == 6
    assert all("did not converge: mass flux" in each.getMessage() for each in caplog.records)
    lost = found.sel(lubricant=OILS[0])
    for name in ("central_film_parameter", "mean_film_parameter", "film_error"):
        assert lost[name].isnull().all()
        assert found[name].sel(lubricant=OILS[1]).notnull().all()
