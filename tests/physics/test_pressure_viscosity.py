"""Gold's form; definitions of the coefficient, and conversion between them."""

from functools import partial

import numpy as np
import pytest
from scipy.integrate import quad

from lube.errors import RangeError
from lube.physics.pressure_laws import ROELANDS_PRESSURE, ROELANDS_VISCOSITY
from lube.physics.pressure_viscosity import (
    DEFINITIONS,
    GOLD_BASES,
    fit_mcewen,
    gold_pressure_viscosity,
    mcewen_coefficient,
    mcewen_log_ratio,
    roelands_coefficient,
    roelands_slope,
)
from lube.physics.viscosity_laws import evaluate_astm_d341, fit_astm_d341


def test_gold_gives_the_coefficients_of_physics_section_2_for_xmp_320():
    temperature = np.array([40.0, 50.0, 60.0, 70.0, 80.0]) + 273.15
    parameters = fit_astm_d341(np.array([313.15, 373.15]), np.array([335.0, 38.3]))
    viscosity = evaluate_astm_d341(temperature, *parameters)
    found = gold_pressure_viscosity(viscosity, "polyalphaolefin") * 1e9
    np.testing.assert_allclose(found, [16.0, 15.1, 14.3, 13.6, 13.0], atol=0.05)


def test_gold_at_1_mm2_per_s_is_s_and_grows_by_ten_to_the_t_a_decade():
    for base, (s, t) in GOLD_BASES.items():
        at_1, at_10 = gold_pressure_viscosity(np.array([1.0, 10.0]), base)
        assert at_1 == pytest.approx(s * 1e-9, rel=1e-12)
        assert np.log10(at_10 / at_1) == pytest.approx(t, rel=1e-12)
        assert t < 1.0 < s


# Slopes in 1/Pa and viscosities in Pa s, from thin pure liquids to cylinder oils.
OILS = [(8e-9, 1e-3), (13e-9, 0.02), (20e-9, 0.1), (30e-9, 0.8), (60e-9, 3.0)]
SPAN = 200e6


def roelands_log_ratio(pressure, slope, viscosity):
    """Roelands' law as it is printed, with the temperature's factor left out."""
    z = slope * ROELANDS_PRESSURE / (np.log(viscosity) + 9.67)
    log_viscosity = np.log(viscosity)
    return (log_viscosity + 9.67) * (-1.0 + (1.0 + pressure / 1.962e8) ** z)


def by_definition(log_ratio, definition):
    """Coefficient straight from its definition, for any law ln(eta / eta0) of the pressure."""
    match definition:
        case "slope-at-atmospheric":
            return (log_ratio(1e3) - log_ratio(0.0)) / 1e3
        case "secant":
            return log_ratio(SPAN) / SPAN
        case _:
            scale = 1.0 / by_definition(log_ratio, "slope-at-atmospheric")
            return 1.0 / (scale * quad(lambda x: np.exp(-log_ratio(x * scale)), 0.0, np.inf)[0])


def test_for_an_oil_of_barus_all_definitions_agree_exactly():
    viscosity = 0.1
    slope = np.log(viscosity / ROELANDS_VISCOSITY) / ROELANDS_PRESSURE  # Z = 1
    for definition in DEFINITIONS:
        assert roelands_coefficient(slope, viscosity, definition, SPAN) == pytest.approx(
            slope, rel=1e-12
        )
        assert mcewen_coefficient(20e-9, 0.0, definition, SPAN) == 20e-9


@pytest.mark.parametrize("definition", DEFINITIONS)
def test_coefficients_are_those_of_their_definitions(definition):
    for slope, viscosity in OILS:
        direct = by_definition(
            partial(roelands_log_ratio, slope=slope, viscosity=viscosity), definition
        )
        found = roelands_coefficient(slope, viscosity, definition, SPAN)
        assert found == pytest.approx(direct, rel=1e-4)
        direct = by_definition(partial(mcewen_log_ratio, slope=slope, curvature=0.2), definition)
        assert mcewen_coefficient(slope, 0.2, definition, SPAN) == pytest.approx(direct, rel=1e-4)


@pytest.mark.parametrize("definition", DEFINITIONS)
def test_conversion_to_the_slope_is_the_inverse(definition):
    for slope, viscosity in OILS:
        coefficient = roelands_coefficient(slope, viscosity, definition, SPAN)
        back = roelands_slope(coefficient, viscosity, definition, SPAN)
        assert back == pytest.approx(slope, rel=1e-9)


def test_definitions_differ_in_the_order_of_the_pressures_they_weigh():
    for slope, viscosity in OILS[1:4]:  # Z below 1: the viscosity rises more slowly than Barus'
        asymptotic = roelands_coefficient(slope, viscosity, "reciprocal-asymptotic")
        far = roelands_coefficient(slope, viscosity, "secant", 1e9)
        near = roelands_coefficient(slope, viscosity, "secant", 1e6)
        assert far < asymptotic < near < slope
        assert near == pytest.approx(slope, rel=0.01)


def test_a_liquid_too_thin_for_roelands_and_a_coefficient_of_no_oil_are_refused():
    with pytest.raises(RangeError, match=r"got a viscosity of 5e-05 Pa s, .* more than 6.3e-05"):
        roelands_slope(10e-9, 5e-5, "secant", SPAN)
    with pytest.raises(RangeError, match=r"got .* of -0\.3 1/GPa, which no oil of 0\.1 Pa s has"):
        roelands_slope(-0.3e-9, 0.1, "secant", SPAN)


def test_mcewens_law_is_recovered_from_its_values_and_barus_from_his():
    pressure = np.array([20e6, 50e6, 100e6, 200e6, 400e6])
    for slope, curvature in [(13e-9, 0.3), (25e-9, 0.05), (20e-9, 0.0)]:
        ratio = np.exp(mcewen_log_ratio(pressure, slope, curvature))
        found = fit_mcewen(pressure, ratio)
        assert found[0] == pytest.approx(slope, rel=1e-5)
        assert found[1] == pytest.approx(curvature, abs=1e-5)


def test_a_viscosity_that_rises_faster_than_exponentially_is_fitted_by_barus():
    pressure = np.array([20e6, 50e6, 100e6, 200e6])
    _, curvature = fit_mcewen(pressure, np.exp(20e-9 * pressure + (pressure / 400e6) ** 2))
    assert curvature == pytest.approx(0.0, abs=1e-4)


def test_mcewen_fits_golds_modulus_equation_of_measured_oils():
    # M100 and PAO100 at 40 degC: Arana, Larranaga & Ulacia, Proc. IMechE J 233 (2019), Table 3.
    pressure = np.array([25e6, 50e6, 100e6, 150e6, 200e6, 300e6, 400e6])
    for a1, a2, b1, b2 in [
        (-2.28e7, 2.26e5, -6.82e-2, 2.768e-4),
        (-5.73e7, 3.9e5, -3.95e-2, 2.354e-4),
    ]:
        a, b = a1 + a2 * 313.15, b1 + b2 * 313.15
        logarithm = pressure / (a + b * pressure)
        slope, curvature = fit_mcewen(pressure, np.exp(logarithm))
        assert slope == pytest.approx(1.0 / a, rel=0.01)
        assert np.abs(mcewen_log_ratio(pressure, slope, curvature) - logarithm).max() < 0.005


def test_without_a_reciprocal_asymptotic_pressure_it_is_refused():
    with pytest.raises(RangeError, match="rises too slowly with pressure"):
        mcewen_coefficient(10e-9, 1.0, "reciprocal-asymptotic")
