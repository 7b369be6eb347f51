"""The flat film that contact sees in a film with a shape, or in one that deforms the roughness."""

import numpy as np
import pytest
import scipy.special
import xarray as xr
from studies import CONFIG

from lube.ehl.line_contact import LineContact, solve
from lube.grid.film_responses import line_heights, surface_heights
from lube.grid.gap import Gap
from lube.sensitivity import responses
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.responses import solve_responses
from lube.sensitivity.runs import Model, design
from lube.sensitivity.samples import deviations, over_run
from lube.sensitivity.shape import WINDOW, _ratio, effective_ratio
from lube.study.study import load_study
from lube.study.uncertainty import Uncertainty, deviating_lines

RATIOS = np.array([[1.0], [3.0], [6.0]])
RANGES = xr.Dataset(
    {
        "moes_load": ("run", [1.0, 4.0]),
        "moes_material": ("run", [6.0, 10.0]),
        "contact_half_width": ("run", [1e-4, 2e-4]),
        "lambda_ratio": ("run", [1.0, 7.0]),
    }
)


def flat(dent=1.0):
    """A flat film in the contact, which is open outside, and thinner over the last tenth."""
    film = np.where(np.abs(WINDOW) <= 1.0, 1.0, 99.0)
    return np.where((WINDOW > 0.8) & (WINDOW <= 1.0), dent, film)


def test_a_flat_film_is_its_own():
    np.testing.assert_allclose(_ratio(RATIOS, flat()), RATIOS[:, 0], rtol=1e-9)


def test_as_many_points_touch_in_both_films():
    ratio = _ratio(RATIOS, flat(dent=0.8))
    assert (0.8 * RATIOS[:, 0] < ratio).all() and (ratio < RATIOS[:, 0]).all()
    inside = np.abs(WINDOW) <= 1.0
    expected = scipy.special.ndtr(-RATIOS * flat(dent=0.8))[:, inside].mean(axis=1)
    np.testing.assert_allclose(scipy.special.ndtr(-ratio), expected, rtol=1e-9)


@pytest.fixture(scope="module")
def table():
    deviating = Deviating.of(load_study(CONFIG / "paper.yaml"))
    return effective_ratio(deviating, RANGES, Gap("computed"), "line")


def film_of(moes_load, moes_material):
    return xr.Dataset(
        {"moes_load": moes_load, "moes_material": moes_material, "contact_half_width": 1.5e-4}
    )


def test_between_its_levels_the_table_is_a_solved_film(table):
    study = load_study(CONFIG / "paper.yaml")
    deviating = Deviating.of(study)
    modulus = 2.0 * study.rollers.reduced_modulus
    oil = np.exp(deviating.oils.isel(lubricant=0).median())
    material = oil["pressure_viscosity_coefficient"].item() * modulus
    for moes_load, moes_material, ratio in ((1.7, 7.3, 3.1), (3.2, 9.1, 5.2)):
        speed = 0.5 * (moes_material / material) ** 4
        load = moes_load * np.sqrt(2.0 * speed)
        viscosity = oil["dynamic_viscosity"].item()
        film = solve(LineContact(load, speed, material, viscosity, modulus))
        expected = _ratio(np.array([[ratio]]), film.scaled_gap(WINDOW) / film.central_gap)
        found = table(xr.DataArray(ratio), film_of(moes_load, moes_material), {})
        np.testing.assert_allclose(found, expected[0], rtol=0.005)
        # The outlet is thinner than the centre.
        assert film.minimum_film / film.central_film * ratio < found < ratio


def test_beyond_its_levels_it_is_that_of_the_last(table):
    ratio = xr.DataArray(3.0)
    # Levels go on by a tenth beyond the films of the runs.
    far, last = (table(ratio, film_of(load, 8.0), {}) for load in (9.0, 1.1 * 4.0))
    np.testing.assert_allclose(far, last)


SECTION = {
    "force": {"range": "+- 5 %", "source": "assumed"},
    "longest_wavelength": {"range": "-30 % to 0 %", "source": "assumed"},
    "hurst_exponent": {"range": "0.6 to 0.8", "source": "assumed"},
}


@pytest.mark.parametrize(
    ("contact_model", "heights_of", "uncertain"),
    [("line", line_heights, SECTION), ("surface", surface_heights, {"force": SECTION["force"]})],
)
def test_where_the_oil_deforms_the_roughness_as_many_points_touch_as_under_the_film_itself(
    contact_model, heights_of, uncertain, monkeypatch
):
    monkeypatch.setattr("lube.grid.film_responses.ANGLES", np.array([0.0, 60.0, 90.0]))
    monkeypatch.setattr(
        "lube.sensitivity.runs.SIZES", {contact_model: (4, 1), "answered line": (4, 1)}
    )
    own = load_study(CONFIG / "smoke.yaml")
    update = {
        "roughness_deformation": "computed",
        "contact_model": (contact_model,),
        "uncertainty": Uncertainty.model_validate(uncertain),
    }
    deviating = Deviating.of(own.model_copy(update=update))
    spec = deviating.study.line_spec
    model = Model(contact_model, "flat", "computed")
    unit, points = design(deviating, model)
    solved = solve_responses(deviating, [contact_model], unit, points)
    values = over_run(deviations(deviating.factors, unit))
    kind = {"line": "answered_lines", "surface": "answered_surfaces"}[contact_model]
    ((_, film),) = deviating.films(values, points, **{kind: spec})
    table = effective_ratio(deviating, film, model.gap, contact_model, solved)
    ratio = xr.full_like(film["lambda_ratio"], 3.0)
    found = table(ratio, film, values)
    name = responses.NAMES[contact_model]
    expected = []
    for number in range(len(unit)):
        one = film.isel(run=number)
        lines = deviating_lines(spec, {name: each[number].item() for name, each in values.items()})
        heights = heights_of(lines, one["wavelength"].values)
        square = abs(one[f"{name}_real"] + 1j * one[f"{name}_imaginary"]) ** 2
        square = square.interp(response_position=WINDOW)
        square = square.transpose("roller", ..., "wavelength", "response_position").values
        square = square.reshape(*heights.shape, WINDOW.size)
        rough = np.sqrt(np.einsum("raw,rawx->x", heights / heights.sum(), square))
        expected += [_ratio(RATIOS[1:2], np.where(np.abs(WINDOW) <= 1.0, 1.0, np.inf) / rough)[0]]
    assert np.abs(np.array(expected) / 3.0 - 1.0).max() > 0.05
    np.testing.assert_allclose(found, expected, rtol=0.005)
