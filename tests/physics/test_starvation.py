"""Starvation: limits of the inlet's integral, then the solution of Reynolds' equation."""

import itertools

import numpy as np
import pytest
import scipy.integrate
from paper_grid import contact_at
from refusals import one_line

from lube.ehl.film_formulas import formula
from lube.ehl.line_contact import LineContact, solve
from lube.errors import RangeError
from lube.grid.films import FilmGroups
from lube.physics.hertz import hertz_gap
from lube.physics.starvation import starvation_factor

FILMS = np.geomspace(1e-3, 1e3, 13)


def test_a_far_meniscus_leaves_the_film_as_it_is():
    np.testing.assert_allclose(starvation_factor(FILMS, 1e7), 1.0, rtol=1e-10)


def test_the_film_falls_to_nothing_as_the_meniscus_nears_the_contact():
    menisci = 1.0 + np.geomspace(1e-6, 1e6, 61)
    for film in FILMS:
        factor = starvation_factor(film, menisci)
        assert np.all(np.diff(factor) > -1e-12)
        assert 0.0 < factor[0] < 0.01 and np.all(factor < 1.0 + 1e-9)


def test_thicker_films_starve_first():
    assert np.all(np.diff(starvation_factor(FILMS, 3.0)) < 0.0)


def test_the_inlet_builds_up_the_same_pressure():
    """The integral by an adaptive rule, up to the meniscus and up to infinity."""

    def inlet(film, meniscus):
        def share(x):
            return hertz_gap(x) / (film + hertz_gap(x)) ** 3

        ends = [1.0, *(x for x in (1.01, 1.1, 2.0, 5.0, 20.0) if x < meniscus), meniscus]
        parts = itertools.pairwise(ends)
        return sum(scipy.integrate.quad(share, *part, epsrel=1e-10)[0] for part in parts)

    for film, meniscus in [(0.1, 1.3), (1.0, 2.0), (1.0, 8.0), (10.0, 4.0)]:
        starved = film * starvation_factor(film, meniscus)
        assert inlet(starved, meniscus) == pytest.approx(inlet(film, np.inf), rel=1e-7)


def test_where_film_or_contact_is_not_known_the_factor_is_not_either():
    film, meniscus = np.array([1.0, np.nan, 1.0]), np.array([3.0, 3.0, np.nan])
    found = starvation_factor(film, meniscus)
    assert found[0] == starvation_factor(1.0, 3.0) and np.isnan(found[1:]).all()


def test_a_meniscus_inside_the_contact_is_refused():
    line = one_line(RangeError, starvation_factor, np.array([1.0, 2.0]), np.array([3.0, 0.9]))
    assert "got 0.9 half-widths before the line of centres, inside the contact, need more" in line


# At M 1.2, 1.9, 9.4 and 2.7.
POINTS = [
    ((400, 150, 60), 0.09),
    ((800, 100, 40), 0.02),
    ((1600, 600 / 7, 80), 0.007),
    ((1600, 200, 40), 0.004),
]


@pytest.mark.parametrize(("point", "bound"), POINTS)
def test_elastic_rollers_starve_as_by_reynolds_equation(point, bound):
    """At a meniscus from 2 to 10 half-widths, in parts of the flooded film."""
    contact = contact_at(*point)
    flooded = solve(contact).central_film
    for meniscus in (2.0, 3.0, 5.0, 10.0):
        computed = solve(contact, meniscus=meniscus).central_film / flooded
        found = starvation_factor(flooded / contact.half_width**2, meniscus)
        assert found == pytest.approx(computed, abs=bound)


@pytest.mark.parametrize(("moes_load", "most"), [(1.9, 0.07), (3.0, 0.025)])
def test_it_starves_the_film_of_less_piezoviscous_oils_too_much(moes_load, most):
    """At L = 5."""
    material = 3693.0
    speed = 0.5 * (5.0 / material) ** 4
    contact = LineContact(moes_load * np.sqrt(2.0 * speed), speed, material, 0.28, 2.308e11)
    flooded = solve(contact).central_film
    computed = solve(contact, meniscus=2.0).central_film / flooded
    found = starvation_factor(flooded / contact.half_width**2, 2.0)
    assert computed - most < found < computed - 0.9 * most


def test_between_rigid_rollers_it_starves_the_film_too_little():
    """At M 0.17, beyond the range of every formula, by up to 0.23 of the flooded film."""
    contact = contact_at(100, 200, 40)
    flooded = solve(contact).central_film
    for meniscus in (3.0, 10.0, 30.0):
        computed = solve(contact, meniscus=meniscus).central_film / flooded
        found = starvation_factor(flooded / contact.half_width**2, meniscus)
        assert computed + 0.08 < found < computed + 0.23


def test_the_computed_film_is_solved_for_with_its_meniscus():
    contact = contact_at(800, 100, 40)
    groups = contact.load, contact.speed, contact.material, contact.viscosity, contact.film_modulus
    meniscus = 3.0 * contact.half_width
    found = FilmGroups(*groups, meniscus).film(formula("computed"))
    assert found == float(f"{solve(contact, meniscus=3.0).central_film:.6g}")
    row = formula("paper")
    film = FilmGroups(*groups, None).film(row)
    factor = starvation_factor(film / contact.half_width**2, 3.0)
    assert FilmGroups(*groups, meniscus).film(row) == pytest.approx(film * factor, rel=1e-12)
