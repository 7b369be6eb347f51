"""Regimes: their films follow from Reynolds' equation, and the thickest one names the regime."""

import numpy as np
import pytest
from hypothesis import given
from paper_grid import groups_of_the_grid, loads, materials, speeds
from scipy.integrate import quad
from scipy.optimize import brentq

from lube import formulas, groups, regimes
from lube.schema import REGIMES

# --- The limits --------------------------------------------------------------------------


def test_moes_asymptotes_have_their_constants():
    """physics.md, section 3."""
    assert regimes.moes_asymptotes(1.0, 1.0) == (3.0, 1.287, 2.621, 1.311)


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


def test_rigid_isoviscous_limits_follow_from_reynolds_equation(rigid_parabola):
    """w' = 24 eta v R/h0 times the load number: Martin's 4.9 U/W, and Moes' 3/M at h_m."""
    ratio, _, load = rigid_parabola
    moes_load = groups.moes_numbers(1.0, 1.0, 1.0)[0]
    rigid = regimes.moes_asymptotes(moes_load, 1.0)[0] * np.sqrt(2.0)
    assert rigid == pytest.approx(24.0 * load * ratio, rel=1e-4)
    assert regimes.regime_films(1.0, 1.0, 1.0)[0] == pytest.approx(24.0 * load, rel=2e-3)


def test_rigid_piezoviscous_limits_follow_from_reynolds_equation(rigid_parabola):
    """Barus: the reduced pressure reaches 1/alpha, so h0/R = 1.666 (GU)^(2/3), h_m 2.04.

    The chart's 1.05 is this 1.666 with the sum of the speeds for the mean.
    """
    ratio, pressure, _ = rigid_parabola
    constant = (12.0 * np.sqrt(2.0) * pressure) ** (2.0 / 3.0)
    moes_material = groups.moes_numbers(1.0, 1.0, 1.0)[1]
    rigid = regimes.moes_asymptotes(1.0, moes_material)[1] * np.sqrt(2.0)
    assert rigid == pytest.approx(ratio * constant, rel=1e-3)
    chart = regimes.regime_films(1.0, 1.0, 1.0)[1]
    assert chart * 2.0 ** (2.0 / 3.0) == pytest.approx(constant, rel=1e-3)


# --- The chart ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("viscosity_number", "elasticity_number", "expected"),
    [
        (1e-3, 1e-3, "isoviscous_rigid"),
        (1e4, 1e-1, "piezoviscous_rigid"),
        (1e-1, 1e2, "isoviscous_elastic"),
        (1e4, 1e2, "piezoviscous_elastic"),
    ],
)
def test_regime_corners(viscosity_number, elasticity_number, expected):
    speed = 1e-11
    load = elasticity_number * np.sqrt(speed)
    material = viscosity_number * np.sqrt(speed) / load**1.5
    assert REGIMES[regimes.regime(load, speed, material)] == expected


@given(loads, speeds, materials)
def test_regime_films_are_films_over_r_times_w_over_u(load, speed, material):
    films = regimes.regime_films(load, speed, material)
    elastic = formulas.dowson_higginson_minimum(load, speed, material) * load / speed
    assert films[3] == pytest.approx(elastic, rel=1e-9)
    assert films[2] == pytest.approx(3.10 * speed**-0.4 * load**0.8, rel=1e-9)


def test_regimes_of_the_papers_grid():
    """At 100 N the rollers hardly flatten (but at 80 degC and 86 r/min); else elastic."""
    found = regimes.regime(*groups_of_the_grid())
    assert found.shape == (5, 5, 5)
    rigid = found == REGIMES.index("isoviscous_rigid")
    assert np.all(rigid | (found == REGIMES.index("piezoviscous_elastic")))
    assert rigid[..., 0].sum() == 24
    assert rigid.sum() == 25
