"""Viscosity-temperature laws: exact fits, recovered parameters, then printed figures."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.errors import RangeError
from lube.physics.viscosity_laws import (
    PARAMETER_UNITS,
    VISCOSITY_LAWS,
    evaluate_astm_d341,
    evaluate_vogel,
    fit_andrade,
    fit_astm_d341,
    fit_vogel,
)

TWO = np.array([40.0, 100.0]) + 273.15
XMP_320 = np.array([335.0, 38.3])
every_law = pytest.mark.parametrize("law", VISCOSITY_LAWS.values(), ids=VISCOSITY_LAWS)


def scattered(points, scatter, seed):
    """Temperatures and viscosities about a Vogel law."""
    generator = np.random.default_rng(seed)
    temperature = np.linspace(290.0, 400.0, points)
    viscosity = evaluate_vogel(temperature, 0.3, 950.0, 178.0)
    return temperature, viscosity * np.exp(scatter * generator.standard_normal(points))


@every_law
@given(
    thick=st.floats(2.0, 5000.0),
    ratio=st.floats(1.05, 50.0),
    cold=st.floats(250.0, 350.0),
    step=st.floats(5.0, 120.0),
)
def test_two_point_fit_goes_through_both_points(law, thick, ratio, cold, step):
    temperature = np.array([cold, cold + step])
    viscosity = np.array([thick, max(thick / ratio, 1.5)])
    parameters = law.fit(temperature, viscosity)
    np.testing.assert_allclose(law.evaluate(temperature, *parameters), viscosity, rtol=1e-9)


@every_law
def test_many_points_on_a_law_give_back_its_parameters_in_any_order(law):
    truth = law.fit(TWO, XMP_320)
    assert len(truth) == len(law.parameters)
    assert set(law.parameters) <= set(PARAMETER_UNITS)
    temperature = np.linspace(290.0, 400.0, 9)
    fitted = law.fit(temperature, law.evaluate(temperature, *truth))
    np.testing.assert_allclose(fitted, truth, rtol=1e-6)
    temperature, viscosity = scattered(12, 0.01, seed=7)
    order = np.random.default_rng(8).permutation(12)
    forwards = law.evaluate(320.0, *law.fit(temperature, viscosity))
    shuffled = law.evaluate(320.0, *law.fit(temperature[order], viscosity[order]))
    assert forwards == pytest.approx(shuffled, rel=1e-7)


def test_astm_d341_gives_the_figures_of_physics_section_2():
    parameters = fit_astm_d341(TWO, XMP_320)
    for celsius, printed in ((50.0, 210.665), (70.0, 95.806), (80.0, 68.451)):
        found = evaluate_astm_d341(celsius + 273.15, *parameters)
        assert found == pytest.approx(printed, abs=5e-4)
    found = evaluate_astm_d341(333.15, *parameters)
    assert found == pytest.approx(139.1001950405, abs=5e-11)


@given(st.floats(0.22, 5000.0))
def test_astm_d341_inverts_its_own_low_viscosity_term(viscosity):
    # With B = 0 the law is constant: A alone holds Z(nu).
    z = viscosity + 0.7 + np.exp(-1.47 - 1.84 * viscosity - 0.51 * viscosity**2)
    a = np.log10(np.log10(z))
    assert evaluate_astm_d341(300.0, a, 0.0) == pytest.approx(viscosity, rel=1e-11)


def test_astm_d341_term_is_by_the_natural_base_not_by_ten():
    # Z(1) = 1.7 + exp(-3.82); with base ten it would be 1.7 + 10^-3.82, and the fit through
    # 1 mm2/s at 300 K would give back another viscosity there.
    a, b = fit_astm_d341(np.array([300.0, 350.0]), np.array([1.0, 0.6]))
    z = 10.0 ** (10.0 ** (a - b * np.log10(300.0)))
    assert z == pytest.approx(1.7 + np.exp(-3.82), rel=1e-12)


def test_astm_d341_refuses_viscosities_below_its_scope():
    with pytest.raises(RangeError, match=r"got 0\.2 mm2/s, .* above 0\.21 mm2/s"):
        fit_astm_d341(TWO, np.array([1.0, 0.2]))


@given(a=st.floats(0.01, 1.0), b=st.floats(500.0, 1500.0), c=st.floats(120.0, 200.0))
def test_vogel_fit_recovers_the_parameters_of_exact_data(a, b, c):
    temperature = np.array([283.15, 303.15, 323.15, 343.15, 373.15])
    fitted = fit_vogel(temperature, evaluate_vogel(temperature, a, b, c))
    np.testing.assert_allclose(fitted, (a, b, c), rtol=1e-3)
    middle = np.linspace(283.15, 373.15, 7)
    np.testing.assert_allclose(
        evaluate_vogel(middle, *fitted), evaluate_vogel(middle, a, b, c), rtol=1e-6
    )


def test_vogel_through_two_points_has_camerons_pole_and_refuses_temperatures_below_it():
    a, b, c = fit_vogel(TWO, XMP_320)
    assert c == pytest.approx(178.15, abs=1e-12)
    # ln(335/38.3) = b (1/135 - 1/195)
    assert b == pytest.approx(np.log(335.0 / 38.3) / (1.0 / 135.0 - 1.0 / 195.0), rel=1e-12)
    assert a == pytest.approx(335.0 / np.exp(b / 135.0), rel=1e-12)
    with pytest.raises(RangeError, match=r"got -100 degC, .* above -95 degC"):
        fit_vogel(np.array([173.15, 313.15]), XMP_320)


def test_vogel_is_infinite_up_to_its_pole():
    assert np.isinf(evaluate_vogel(np.array([178.15, 100.0]), 0.3, 950.0, 178.15)).all()


def test_vogel_fits_scattered_data_better_than_andrade():
    temperature, viscosity = scattered(20, 0.02, seed=3)
    squared = []
    for law in (VISCOSITY_LAWS["vogel"], VISCOSITY_LAWS["andrade"]):
        fitted = law.evaluate(temperature, *law.fit(temperature, viscosity))
        squared.append(np.sum(np.log(fitted / viscosity) ** 2))
    assert squared[0] < 0.2 * squared[1]


def test_andrade_is_the_least_squares_line_of_log_viscosity_in_reciprocal_temperature():
    temperature, viscosity = scattered(15, 0.05, seed=5)
    slope, intercept = np.polyfit(1.0 / temperature, np.log(viscosity), 1)
    a, b = fit_andrade(temperature, viscosity)
    assert (np.log(a), b) == pytest.approx((intercept, slope), rel=1e-9)
