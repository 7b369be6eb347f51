"""Viscosity laws, viscosity index, density and Gold's form against theory and print."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.errors import RangeError
from lube.physics.viscosity import (
    GOLD_BASES,
    PARAMETER_UNITS,
    VISCOSITY_LAWS,
    evaluate_andrade,
    evaluate_astm_d341,
    evaluate_vogel,
    fit_andrade,
    fit_astm_d341,
    fit_vogel,
    gold_pressure_viscosity,
    linear_density,
    reference_oils,
    viscosity_index,
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


@every_law
def test_data_to_which_no_law_can_be_fitted_are_refused(law):
    for temperature, viscosity, message in (
        ([313.15], [335.0], "one temperature"),
        ([313.15, 313.15], [335.0, 330.0], "one temperature"),
        ([313.15, 373.15], [335.0, 0.0], "got 0 mm2/s"),
        ([313.15, 373.15], [335.0, -38.3], "got -38.3 mm2/s"),
    ):
        with pytest.raises(RangeError, match=message):
            law.fit(temperature, viscosity)


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
    with pytest.raises(RangeError, match=r"got 0\.2 mm2/s, .* more than 0\.21 mm2/s"):
        fit_astm_d341(TWO, np.array([1.0, 0.2]))


@given(a=st.floats(0.01, 1.0), b=st.floats(500.0, 1500.0), c=st.floats(120.0, 200.0))
def test_vogel_fit_recovers_the_law_behind_exact_data(a, b, c):
    temperature = np.array([283.15, 303.15, 323.15, 343.15, 373.15])
    fitted = fit_vogel(temperature, evaluate_vogel(temperature, a, b, c))
    np.testing.assert_allclose(fitted, (a, b, c), rtol=1e-3)
    middle = np.linspace(283.15, 373.15, 7)
    np.testing.assert_allclose(
        evaluate_vogel(middle, *fitted), evaluate_vogel(middle, a, b, c), rtol=1e-6
    )


def test_vogel_through_two_points_has_camerons_pole_and_needs_to_lie_above_it():
    a, b, c = fit_vogel(TWO, XMP_320)
    assert c == pytest.approx(178.15, abs=1e-12)
    # ln(335/38.3) = b (1/135 - 1/195)
    assert b == pytest.approx(np.log(335.0 / 38.3) / (1.0 / 135.0 - 1.0 / 195.0), rel=1e-12)
    assert a == pytest.approx(335.0 / np.exp(b / 135.0), rel=1e-12)
    with pytest.raises(RangeError, match=r"got -100 degC, .* above -95 degC"):
        fit_vogel(np.array([173.15, 313.15]), XMP_320)


def test_vogel_is_infinite_up_to_its_pole_and_is_andrades_law_with_a_pole_at_zero():
    assert np.isinf(evaluate_vogel(np.array([178.15, 100.0]), 0.3, 950.0, 178.15)).all()
    temperature = np.linspace(280.0, 370.0, 5)
    np.testing.assert_array_equal(
        evaluate_vogel(temperature, 0.1, 2000.0, 0.0), evaluate_andrade(temperature, 0.1, 2000.0)
    )


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


def test_reference_oils_meet_the_table_of_astm_d2270_and_join_smoothly():
    table = [  # KV100, L and H, mm2/s
        *((2.0, 7.994, 6.394), (3.0, 15.49, 12.15), (4.1, 26.50, 20.37), (4.7, 35.13, 25.63)),
        *((5.7, 52.64, 35.29), (6.7, 71.29, 45.33), (7.3, 84.53, 51.78), (8.0, 100.0, 59.60)),
        *((10.0, 147.7, 82.87), (13.0, 231.9, 121.5), (16.0, 331.9, 164.6), (20.0, 493.2, 229.5)),
        *((25.0, 736.5, 320.9), (38.5, 1613.0, 615.0), (50.0, 2618.0, 919.6)),
        *((60.0, 3676.0, 1222.0), (70.0, 4905.0, 1558.0)),
    ]
    for viscosity_100, low, high in table:
        assert reference_oils(viscosity_100) == pytest.approx((low, high), rel=5e-4)
    for joint in (3.8, 4.4, 5.0, 6.4, 7.0, 7.7, 9, 12, 15, 18, 22, 28, 40, 55, 70):
        below, above = reference_oils(joint * (1 - 1e-9)), reference_oils(joint)
        assert below == pytest.approx(above, rel=2e-3)


def test_viscosity_index_rounds_to_the_printed_figure():
    for viscosity_40, viscosity_100, printed in (
        (73.30, 8.86, 92),  # ASTM D2270, example of procedure A
        (22.83, 5.05, 156),  # ASTM D2270, examples of procedure B
        (53.47, 7.80, 111),
        (335.0, 38.3, 164),  # Mobilgear SHC XMP 320, physics.md section 2
        (320.0, 38.3, 170),
    ):
        assert round(viscosity_index(viscosity_40, viscosity_100)) == printed
    assert viscosity_index(335.0, 38.3) == pytest.approx(164.4, abs=0.05)


@given(st.floats(2.0, 200.0))
def test_reference_oils_have_the_viscosity_indices_0_and_100(viscosity_100):
    low, high = reference_oils(viscosity_100)
    assert viscosity_index(low, viscosity_100) == pytest.approx(0.0, abs=1e-9)
    assert viscosity_index(high, viscosity_100) == pytest.approx(100.0, abs=1e-9)
    # Procedures A and B meet at 100.
    assert viscosity_index(high * (1 - 1e-9), viscosity_100) == pytest.approx(100.0, abs=1e-4)


def test_viscosity_index_of_thin_liquids_is_refused():
    for viscosity_100 in (1.99, 0.0, float("nan")):
        with pytest.raises(RangeError, match="needs 2 mm2/s or more"):
            viscosity_index(5.0, viscosity_100)


def test_gold_gives_the_coefficients_of_physics_section_2_for_xmp_320():
    temperature = np.array([40.0, 50.0, 60.0, 70.0, 80.0]) + 273.15
    viscosity = evaluate_astm_d341(temperature, *fit_astm_d341(TWO, XMP_320))
    found = gold_pressure_viscosity(viscosity, "polyalphaolefin") * 1e9
    np.testing.assert_allclose(found, [16.0, 15.1, 14.3, 13.6, 13.0], atol=0.05)


def test_gold_at_1_mm2_per_s_is_s_and_grows_by_ten_to_the_t_a_decade():
    for base, (s, t) in GOLD_BASES.items():
        at_1, at_10 = gold_pressure_viscosity(np.array([1.0, 10.0]), base)
        assert at_1 == pytest.approx(s * 1e-9, rel=1e-12)
        assert np.log10(at_10 / at_1) == pytest.approx(t, rel=1e-12)
        assert t < 1.0 < s


def test_density_is_linear_about_15_degc():
    density = linear_density(np.array([288.15, 298.15, 308.15]), 860.0, 6.4e-4)
    np.testing.assert_allclose(density, [860.0, 860.0 * 0.9936, 860.0 * 0.9872], rtol=1e-12)
