"""Regimes: their films follow from Reynolds' equation, and together they say which one holds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from paper_grid import groups_of_the_grid
from scipy.integrate import quad
from scipy.optimize import brentq
from studies import PAPER

from lube.ehl import film_formulas
from lube.physics import dimensionless
from lube.physics.regimes import moes_asymptotes, regime
from lube.schema import REGIMES
from lube.stages import load_study
from lube.stages.film import film_table
from lube.study.oil_properties import lubricant_table

ISO_RIGID, PIEZO_RIGID, ISO_ELASTIC, PIEZO_ELASTIC = range(4)

# --- The limits --------------------------------------------------------------------------


@pytest.fixture(scope="module")
def rigid_parabola():
    """Reynolds' equation for a rigid parabola h = h0 (1 + t^2), x = t (2 R h0)^0.5.

    Pressure is greatest at t = -c and vanishes with its slope at t = c; returned are
    h_m/h0 = 1 + c^2, the greatest reduced pressure and the load, both as pure numbers.
    """

    def slope(t, c):
        return (t**2 - c**2) / (1.0 + t**2) ** 3

    def pressure(t, c):
        return quad(slope, -np.inf, t, args=(c,))[0]

    c = brentq(lambda c: pressure(c, c), 0.1, 1.0)
    load = -quad(lambda t: t * slope(t, c), -np.inf, c)[0]
    return 1.0 + c**2, pressure(-c, c), load


def test_rigid_isoviscous_limit_follows_from_reynolds_equation(rigid_parabola):
    """w' = 24 eta v R/h0 times the load number: Martin's 4.9 U/W at h0, Moes' 3/M at h_m."""
    ratio, _, load = rigid_parabola
    assert 24.0 * load == pytest.approx(4.9, rel=2e-3)
    moes_load = dimensionless.moes_numbers(1.0, 1.0, 1.0)[0]
    rigid = moes_asymptotes(moes_load, 1.0)[ISO_RIGID] * np.sqrt(2.0)
    assert rigid == pytest.approx(24.0 * load * ratio, rel=1e-4)


def test_rigid_piezoviscous_limit_follows_from_reynolds_equation(rigid_parabola):
    """Barus: the reduced pressure reaches 1/alpha, so h0/R = 1.666 (GU)^(2/3), h_m 2.04."""
    ratio, pressure, _ = rigid_parabola
    constant = (12.0 * np.sqrt(2.0) * pressure) ** (2.0 / 3.0)
    moes_material = dimensionless.moes_numbers(1.0, 1.0, 1.0)[1]
    rigid = moes_asymptotes(1.0, moes_material)[PIEZO_RIGID] * np.sqrt(2.0)
    assert rigid == pytest.approx(ratio * constant, rel=1e-3)


# --- Which one holds ---------------------------------------------------------------------

moes_loads = st.floats(-6.0, 12.0).map(lambda power: 10.0**power)
moes_materials = st.floats(-9.0, 9.0).map(lambda power: 10.0**power)


def test_flags_stand_in_the_order_of_the_asymptotes():
    oils, rollers = zip(*(name.split("_") for name in REGIMES), strict=True)
    assert oils == ("isoviscous", "piezoviscous") * 2
    assert rollers == ("rigid", "rigid", "elastic", "elastic")


def test_each_regime_holds_in_its_corner():
    for at, expected in [
        ((1e-6, 1.0), ISO_RIGID),
        ((1e-6, 1e-6), ISO_RIGID),
        ((1e-3, 1e12), PIEZO_RIGID),
        ((1e9, 1e-6), ISO_ELASTIC),
        ((1e9, 1.0), PIEZO_ELASTIC),
        ((1e9, 1e3), PIEZO_ELASTIC),
    ]:
        assert regime(*at) == expected
    # The largest of the four asymptotes would be the wrong rule: far too stiff a contact here.
    assert np.argmax(moes_asymptotes(0.5, 8.0)) == PIEZO_ELASTIC
    assert regime(0.5, 8.0) == ISO_RIGID


@given(moes_loads, moes_materials)
def test_regime_is_the_asymptote_that_the_film_follows_as_moes_formula_does(load, material):
    """Where asymptotes meet they add up with the powers 7/5 or more, and 7/3; or with -7/2."""
    films = moes_asymptotes(load, material)
    asymptote = max(max(films[0], films[2]), min(films[1], films[3]))
    assert films[regime(load, material)] == asymptote
    root = np.sqrt(2e-11)
    film = film_formulas.moes(load * root, 1e-11, material / np.sqrt(root)) / root
    assert 2.0 ** (-2.0 / 7.0) < film / asymptote < 2.0 ** (5.0 / 7.0 + 3.0 / 7.0)


def test_regimes_change_where_two_asymptotes_are_equal():
    def rigid_stiffens(moes_material):  # 3/M = 1.287 L^(2/3)
        return 3.0 / (1.287 * moes_material ** (2.0 / 3.0))

    def piezo_deforms(moes_material):  # 1.287 L^(2/3) = 1.311 M^(-1/8) L^(3/4)
        return (1.311 / 1.287) ** 8 * moes_material ** (2.0 / 3.0)

    def elastic_stiffens(moes_material):  # 2.621 M^(-1/5) = 1.311 M^(-1/8) L^(3/4)
        return (2.621 / (1.311 * moes_material**0.75)) ** (40.0 / 3.0)

    iso_deforms = (3.0 / 2.621) ** (5.0 / 4.0)  # 3/M = 2.621 M^(-1/5)
    for moes_load, moes_material, before, after in [
        (iso_deforms, 0.1, ISO_RIGID, ISO_ELASTIC),
        (piezo_deforms(8.0), 8.0, PIEZO_RIGID, PIEZO_ELASTIC),
        (piezo_deforms(1e3), 1e3, PIEZO_RIGID, PIEZO_ELASTIC),
        (rigid_stiffens(8.0), 8.0, ISO_RIGID, PIEZO_RIGID),
        (rigid_stiffens(1e3), 1e3, ISO_RIGID, PIEZO_RIGID),
        (elastic_stiffens(0.5), 0.5, ISO_ELASTIC, PIEZO_ELASTIC),
    ]:
        films = moes_asymptotes(moes_load, moes_material)
        assert films[before] == pytest.approx(films[after], rel=1e-9)
        assert regime(moes_load * (1.0 - 1e-6), moes_material) == before
        assert regime(moes_load * (1.0 + 1e-6), moes_material) == after


def test_regimes_of_the_papers_grid():
    """32 points isoviscous-rigid, 73 piezoviscous-rigid, 20 -elastic: physics-beyond.md, 10."""
    study = load_study(PAPER)
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants, grid.temperature)
    film = film_table(oil, study.rollers, grid.force, grid.speed, study.film_formulas)
    counts = np.bincount(film["regime"].values.ravel(), minlength=4)
    assert counts.tolist() == [32, 73, 0, 20]
    plain = regime(*dimensionless.moes_numbers(*groups_of_the_grid()))
    np.testing.assert_array_equal(film["regime"].isel(lubricant=0), plain)
