"""Viscosity and density under pressure: limits, and how the laws are related."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.physics.pressure_laws import (
    PRESSURE_LAWS,
    ROELANDS_PRESSURE,
    ROELANDS_VISCOSITY,
    barus,
    dowson_higginson_density,
    roelands,
)

pressures = st.floats(0.0, 3e9)
coefficients = st.floats(5e-9, 40e-9)
viscosities = st.floats(1e-3, 10.0)


@pytest.mark.parametrize("law", PRESSURE_LAWS.values(), ids=PRESSURE_LAWS)
@given(coefficients, viscosities)
def test_ambient_oil_has_its_viscosity_and_the_slope_alpha(law, alpha, viscosity):
    logarithm, slope = law(0.0, alpha, viscosity)
    assert logarithm == 0.0
    assert slope == pytest.approx(alpha, rel=1e-12)


def test_slopes_are_the_derivatives():
    """Against complex steps, which have no error of cancellation."""
    p = np.array([0.0, 1e7, 5e8, 2e9])
    laws = [lambda p, law=law: law(p, 2e-8, 0.1) for law in PRESSURE_LAWS.values()]
    for law in (*laws, dowson_higginson_density):
        np.testing.assert_allclose(law(p + 1e-20j)[0].imag / 1e-20, law(p)[1], rtol=1e-12)


@given(pressures, viscosities)
def test_roelands_law_is_that_of_barus_where_its_exponent_is_one(pressure, viscosity):
    """Z = 1: the logarithm of the viscosity is linear in the pressure."""
    alpha = np.log(viscosity / ROELANDS_VISCOSITY) / ROELANDS_PRESSURE
    found, expected = roelands(pressure, alpha, viscosity), barus(pressure, alpha, viscosity)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


@given(st.floats(1e6, 3e9), coefficients, viscosities)
def test_roelands_law_lies_below_that_of_barus_where_its_exponent_is_below_one(
    pressure, alpha, viscosity
):
    exponent = alpha * ROELANDS_PRESSURE / np.log(viscosity / ROELANDS_VISCOSITY)
    difference = roelands(pressure, alpha, viscosity)[0] - alpha * pressure
    assert difference * (exponent - 1.0) >= -1e-9


def test_all_oils_meet_at_one_viscosity_at_the_pole_of_roelands_law():
    """Towards the pressure -p0, at which no oil exists, ln viscosity tends to -9.67."""
    near = -ROELANDS_PRESSURE * (1.0 - 1e-12)
    for alpha, viscosity in [(20e-9, 0.1), (40e-9, 0.01), (40e-9, 1.0)]:
        logarithm, _ = roelands(near, alpha, viscosity)
        assert np.log(viscosity) + logarithm == pytest.approx(-9.67, abs=1e-3)


def test_density_rises_from_one_to_134_percent_with_the_initial_compressibility():
    """0.34 / 0.59 GPa: Dowson and Higginson (1966)."""
    assert dowson_higginson_density(0.0) == pytest.approx((1.0, 0.34 / 0.59e9))
    density, slope = dowson_higginson_density(np.geomspace(1e5, 1e15, 50))
    assert np.all(np.diff(density) > 0.0) and np.all(slope > 0.0)
    assert density[-1] == pytest.approx(1.34, abs=1e-5)
