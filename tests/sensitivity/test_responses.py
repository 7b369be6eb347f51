"""Responses of the film between levels of M and L, against those of the film itself."""

import numpy as np
import pytest
import xarray as xr
from studies import CONFIG

from lube.sensitivity import runs
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.responses import (
    NAMES,
    NUMBERS,
    slips_of,
    solve_responses,
    typical_films,
    with_responses,
)
from lube.sensitivity.runs import Model, design, run
from lube.sensitivity.samples import deviations, over_run
from lube.study.study import load_study
from lube.study.uncertainty import Uncertainty

SOME = 6
RANGES = {
    "viscosity": {"range": "+- 10 %"},
    "temperature": {"range": "+- 1 K"},
    "force": {"range": "+- 5 %"},
}
RANGES = {name: given | {"source": "assumed"} for name, given in RANGES.items()}


def deviating(speed_factor=1.0, **choices):
    """A study with slip, at its speeds times a factor."""
    own = load_study(CONFIG / "smoke.yaml")
    speeds = tuple(speed_factor * each for each in own.operating_grid.speed)
    faster = {"speed": speeds, "slide_to_roll_ratio": (0.3,)}
    update = {
        "operating_grid": own.operating_grid.model_copy(update=faster),
        "roughness_deformation": "computed",
        "uncertainty": Uncertainty.model_validate(RANGES),
    }
    return Deviating.of(own.model_copy(update=update | choices))


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr("lube.grid.film_responses.ANGLES", np.array([0.0, 60.0, 90.0]))
    monkeypatch.setattr(runs, "SIZES", dict.fromkeys(runs.SIZES, (8, 2)))


@pytest.mark.parametrize("contact_model", ["line", pytest.param("surface", marks=pytest.mark.slow)])
def test_responses_are_those_of_the_heated_and_sliding_films_themselves(contact_model):
    study = deviating(3.0, inlet_shear_heating="zhu-cheng-1988")
    model = Model(contact_model, "flat", "computed")
    unit, points = design(study, model)
    solved = solve_responses(study, [contact_model], unit, points)
    values, points = (
        over_run(deviations(study.factors, unit[:SOME])),
        points.isel(run=slice(SOME)),
    )
    ((_, film),) = study.films(values, points)
    assert film["inlet_shear_heating_factor"].min() < 0.95
    found = with_responses(film, solved, contact_model, slips_of(study, points))
    kind = {"line": "answered_lines", "surface": "answered_surfaces"}[contact_model]
    ((_, exact),) = study.films(values, points, **{kind: study.study.line_spec})
    name = NAMES[contact_model]
    own, other = (each[f"{name}_real"] + 1j * each[f"{name}_imaginary"] for each in (found, exact))
    drawn = own["wavelength"] <= study.study.line_spec.longest_wavelength
    own = own.isel(wavelength=drawn).sel(response_position=slice(-1.0, 1.0))
    other = other.interp(wavelength=own["wavelength"], kwargs={"fill_value": None})
    other = other.sel(response_position=own["response_position"])
    assert np.abs(other - 1.0).max() > 0.3
    assert np.sqrt((np.abs(own - other) ** 2).mean()) < 0.02


@pytest.mark.slow
def test_probabilities_are_those_with_the_films_own_responses():
    finer = load_study(CONFIG / "smoke.yaml").roughness.model_copy(update={"points": 300_000})
    study = deviating(roughness=finer)
    model = Model("line", "computed", "computed")
    unit, points = design(study, model)
    values = over_run(deviations(study.factors, unit))
    exact = {"with_shape": True, "answered_lines": study.study.line_spec}
    ((_, film),) = study.films(values, points, **exact)
    found = run(study, model, unit, points)["breakthrough_probability"].mean("seed").values
    expected = [
        runs._probabilities(
            study,
            model,
            {name: value[number].item() for name, value in values.items()},
            film.isel(run=[number]),
        )[0].mean()
        for number in range(len(unit))
    ]
    known = np.array(expected) > 0.0
    assert known.sum() > 10
    np.testing.assert_allclose(np.log(found[known] / np.array(expected)[known]), 0.0, atol=0.08)


def test_a_film_that_does_not_converge_is_that_of_the_next_smaller_load(monkeypatch):
    profiles = xr.DataArray(np.array([["first", "second"], ["", "third"]], object), dims=NUMBERS)
    profiles.values[1, 0] = None
    monkeypatch.setattr("lube.sensitivity.responses.FilmGroups.profiles", profiles)
    found = typical_films(deviating(), np.array([1.0, 2.0]), np.array([5.0, 6.0]))
    assert found.values.tolist() == [["first", "second"], ["first", "third"]]


def test_some_runs_have_the_responses_that_they_have_among_all():
    study = deviating()
    model = Model("line", "flat", "computed")
    unit, points = design(study, model)
    solved = solve_responses(study, ["line"], unit, points)
    every, some = (
        run(study, model, unit[:count], points.isel(run=slice(count)), None, solved)
        for count in (2 * SOME, SOME)
    )
    name = "breakthrough_probability"
    np.testing.assert_array_equal(every[name][:SOME], some[name])
