"""The share of the load that asperities carry, as theory has it and as counted."""

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad
from scipy.stats import norm

from lube.grid.plausibility import expected_load_share, overview, remarks
from lube.physics.excursions import mean_overlap
from lube.stages import contact_statistics, roughness_lines


@pytest.mark.parametrize("level", [0.0, 0.3, 2.0, 5.0])
def test_the_mean_overlap_is_that_of_a_quadrature(level):
    expected, _ = quad(lambda z: (z - level) * norm.pdf(z, scale=1.4), level, np.inf, epsabs=1e-13)
    assert mean_overlap(level, 1.4) == pytest.approx(expected, rel=1e-9)


def test_the_contact_model_finds_the_expected_share_of_the_load(study, film, make_spec):
    spec = make_spec(100_000)
    counted = contact_statistics(roughness_lines(spec, 1, range(24)), film, study.boundary_layer)
    counted = counted["contact_load_share"].isel(slide_to_roll_ratio=0)
    # The grid's windows are a little narrower than the contact.
    half_width = film["contact_half_width"]
    window = (2.0 * np.floor(half_width / spec.spacing) + 1.0) * spec.spacing
    expected = expected_load_share(film, study.rollers) * window / (2.0 * half_width)
    counted, expected = xr.align(counted, expected, join="exact")
    error = counted.std("realisation", ddof=1) / 24**0.5
    frequent = (expected > 1e-3).transpose(*error.dims).values
    assert frequent.sum() > 10
    distance = ((counted.mean("realisation") - expected) / error).values[frequent]
    assert np.abs(distance).max() < 4.0


def test_rollers_shorter_than_the_contact_is_wide_are_remarked(study, film):
    widest = 2.0 * film["contact_half_width"].max().item()
    for part, is_said in ((0.99, True), (1.01, False)):
        short = study.rollers.model_copy(update={"length": part * widest})
        found = remarks(film, study.line_spec, short)
        assert any(line.startswith("length of the rollers: ") for line in found) == is_said


@pytest.mark.parametrize("name", ["rms_deformation", "surface_rms_deformation"])
def test_roughness_that_the_oil_changes_too_much_is_remarked(study, film, name):
    question = study.line_spec, study.rollers
    assert not any("the oil changes it" in line for line in remarks(film, *question))
    one = film["film_thickness"].isel(film_formula=0)
    changed = xr.zeros_like(one)
    changed[dict.fromkeys(one.dims, 0)] = 0.2 * one.max()
    lines = remarks(film.assign({name: changed}), *question)
    said = f"roughness: at 1 of {one.size} operating points the oil changes it"
    assert any(line.startswith(said) for line in lines)


@pytest.mark.parametrize("name", ["film_thickness", "film_profile"])
def test_films_that_are_not_known_are_remarked(study, film, name):
    question, one = (study.line_spec, study.rollers), film["film_thickness"].isel(film_formula=0)
    assert not any("unknown" in line for line in remarks(film, *question))
    found = film["film_thickness"] if name == "film_thickness" else one.expand_dims(film_position=9)
    unsolved = found.copy(deep=True)
    unsolved[dict.fromkeys(one.dims, 0)] = np.nan
    found = remarks(film.assign({name: unsolved}), *question)
    said = f"film: unknown at 1 of {one.size} operating points"
    assert any(line.startswith(said) for line in found)


def test_no_load_on_the_line_is_stated_where_no_line_stands_for_the_surfaces(study, film):
    thin = film.assign(film_thickness=0.1 * film["film_thickness"])
    thin["surface_load_share"] = xr.full_like(film["film_thickness"], 0.123)
    lay = {"lay_ratio": 5.0, "lay_angle": 0.0}
    ground = study.roughness.model_copy(update=lay)
    ground = study.model_copy(update={"roughness": ground, "contact_model": ("surface",)})
    said = {}
    for name, each in (("isotropic", study), ("ground", ground)):
        question = thin, each.line_spec, each.rollers
        shares = overview(*question)["load share"]
        said[name] = shares, any("the line's asperities" in line for line in remarks(*question))
    assert said["ground"] == ("at most 12 % by asperities of the surface", False)
    assert said["isotropic"][0].endswith(
        "% by asperities of the line, 12 % by asperities of the surface"
    )
    assert said["isotropic"][1]
    thin["surface_load_share"] *= 10.0
    found = remarks(thin, ground.line_spec, ground.rollers)
    points = thin["film_thickness"].isel(film_formula=0).size
    most = f"a tenth of the load, at {points} more than all of it, where the film"
    assert any(f"the surfaces' asperities carry more than {most}" in line for line in found)


def test_the_grid_matters_only_where_a_line_stands_for_the_surfaces(study, film):
    short = {"shortest_wavelength": 8.0 * study.line_spec.spacing}
    for lay, is_said in ((1.0, True), (5.0, False)):
        update = short | {"lay_ratio": lay, "lay_angle": 0.0}
        roughness = study.roughness.model_copy(update=update)
        update = {"roughness": roughness, "contact_model": ("surface",)}
        lines = study.model_copy(update=update).line_spec
        question = film, lines, study.rollers
        found = remarks(*question)
        assert any(line.startswith("grid: 8 points") for line in found) == is_said
        assert ("grid" in overview(*question)) == is_said


def test_nothing_is_said_of_lines_where_contact_is_of_surfaces_alone(study, film):
    thin = film.assign(film_thickness=0.1 * film["film_thickness"])
    thin["rms_deformation"] = 0.0 * thin["film_thickness"].isel(film_formula=0, drop=True)
    question = thin, study.line_spec, study.rollers
    of_lines = {"the line's asperities", "lines that touch there by the linear response"}
    for models, is_said in ((("line",), True), (("line", "surface"), True), (("surface",), False)):
        found = "\n".join(remarks(*question, models))
        assert all((words in found) == is_said for words in of_lines)
