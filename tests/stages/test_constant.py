"""Contact by both constants of Eq. 3 and by the computed film, from one map."""

import numpy as np
import pytest

from lube.contact.ensemble import gather_map
from lube.contact.rough_pair import roughness_batch
from lube.inference.map_curves import curve_at
from lube.stages.constant import FILMS, constant_effect
from lube.stages.film import film_table
from lube.stages.master import contact_map
from lube.study.line_spec import line_spec
from lube.study.oil_properties import lubricant_table

FORCES, SPEEDS, TEMPERATURES = [400.0, 1600.0], [100.0, 200.0], [50.0, 80.0]


@pytest.fixture(scope="module")
def files(study, make_spec):
    oil = lubricant_table(study.lubricants, TEMPERATURES)
    film = film_table(oil, study.rollers, FORCES, SPEEDS, ["moes", "paper"])
    lines = roughness_batch(make_spec(50_000), 2, range(4))
    return oil, film, gather_map([contact_map(lines, film, study.boundary_layer)])


@pytest.fixture(scope="module")
def effect(files):
    return constant_effect(*files)


def test_films_are_those_of_the_film_stage(effect, study, files):
    """Whatever film formulas the study has."""
    film = film_table(files[0], study.rollers, FORCES, SPEEDS, FILMS)
    for name in ("film_thickness", "lambda_ratio"):
        np.testing.assert_allclose(effect[name], film[name], rtol=1e-5)
    ratio = effect["film_thickness"].sel(film_formula="pan-hamrock") / effect["film_thickness"].sel(
        film_formula="paper"
    )
    np.testing.assert_allclose(ratio, 2.922 / 2.992, rtol=1e-12)


def test_probabilities_lie_on_one_curve_of_each_contact_width(effect, files):
    _, film, master = files
    for force in FORCES:
        here = effect.sel(force=force)
        ratios, found = (
            here[name].values.ravel() for name in ("lambda_ratio", "breakthrough_probability")
        )
        order = np.argsort(ratios)
        seen = np.isfinite(found[order])
        assert seen.sum() > 3
        assert np.all(np.diff(found[order][seen]) <= 0.0)
        # The levels of the map itself.
        curve = curve_at(master, 2 * film["contact_half_width"].sel(force=force).item())
        beyond = (np.log(ratios) < curve.films[0]) | (np.log(ratios) > curve.films[-1])
        np.testing.assert_array_equal(np.isnan(found), beyond)


def test_the_thinner_film_of_the_source_gives_more_contact(effect):
    printed, source = (
        effect["breakthrough_probability"].sel(film_formula=name) for name in FILMS[:2]
    )
    both = (printed.notnull() & source.notnull()).values
    assert both.any() and np.all(source.values[both] > printed.values[both])


def test_a_map_without_contact_gives_no_probability(files):
    oil, film, master = files
    none = master.copy()
    for name in ("breakthrough_probability", "breakthrough_probability_mean"):
        none[name] = 0.0 * master[name]
    assert constant_effect(oil, film, none)["breakthrough_probability"].isnull().all()


def test_where_contact_falls_as_the_film_thins_its_probability_is_known_too(study):
    """Very rough rollers: at the thinnest films segments merge, and more of them hold."""
    rough = {
        name: getattr(study.rollers, name).model_copy(update={"rms_roughness": 2e-6})
        for name in ("first", "second")
    }
    rollers = study.rollers.model_copy(update=rough)
    roughness = study.roughness.model_copy(update={"points": 50_000})
    oil = lubricant_table(study.lubricants, TEMPERATURES)
    film = film_table(oil, rollers, FORCES, SPEEDS, ["paper"])
    lines = roughness_batch(line_spec(rollers, roughness, max(FORCES)), 2, range(4))
    master = gather_map([contact_map(lines, film, study.boundary_layer)])
    assert any(curve_at(master, width).peak for width in master["contact_width"].values)
    found = constant_effect(oil, film, master)
    assert found["breakthrough_probability"].notnull().all()
