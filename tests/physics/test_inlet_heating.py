"""Inlet shear heating: none at rest, powers of speed and slip, and the equation behind a fit."""

import numpy as np
import pytest
from paper_grid import log_slope
from scipy.integrate import quad, solve_ivp

from lube.physics.hertz import hertz_gap
from lube.physics.inlet_heating import (
    INLET_HEATING,
    heating_factor,
    inlet_equation,
    thermal_loading,
    wilson_sheu,
    zhu_cheng,
)

SLIP = np.linspace(0.0, 2.0, 11)
MODELS = [name for name in INLET_HEATING if name != "none"]
everywhere = pytest.mark.parametrize("model", MODELS)


@everywhere
def test_at_rest_nothing_is_heated(model):
    assert heating_factor(model, 0.0, 2.0, 2e-3, 0.3) == pytest.approx(1.0, abs=1e-12)


@everywhere
def test_the_factor_falls_with_loading_and_with_slip_either_way(model):
    factor = heating_factor(model, 0.1, SLIP, 2e-3, 0.3)
    assert np.all(np.diff(factor) < 0.0)
    np.testing.assert_array_equal(heating_factor(model, 0.1, -SLIP, 2e-3, 0.3), factor)
    by_loading = heating_factor(model, np.geomspace(1e-4, 1.0, 9), 0.5, 2e-3, 0.3)
    assert np.all(np.diff(by_loading) < 0.0) and by_loading[0] < 1.0


@everywhere
def test_in_pure_rolling_all_agree(model):
    loading = np.geomspace(1e-3, 1.0, 7)
    found = heating_factor(model, loading, 0.0, 0.0, 0.05)
    np.testing.assert_allclose(found, zhu_cheng(loading, 0.0, 0.0), rtol=0.03)


def test_without_load_and_slip_the_loss_is_a_power_of_the_speed():
    def loss(speed):
        return 1.0 / zhu_cheng(thermal_loading(0.3, 0.05, speed, 0.14), 0.0, 0.0) - 1.0

    assert log_slope(loss, (1.0,), 0) == pytest.approx(2 * 0.64)
    assert zhu_cheng(1.0, 0.0, 0.0) == pytest.approx(1 / 1.213)
    assert zhu_cheng(1.0, 0.0, 0.01) == pytest.approx(0.868 / 1.213)
    assert wilson_sheu(1.0, 0.0) == pytest.approx(1 / 1.241)
    assert wilson_sheu(1.0, 2.0) == pytest.approx(1 / (1 + 0.241 * 15.8))


def test_beyond_the_formulas_range_there_is_no_factor():
    """At Q = 1, p_H / E' = 1 / 13.2 brings the numerator to zero."""
    found = zhu_cheng(1.0, 0.0, np.array([0.075, 0.0758, 0.1]))
    assert found[0] > 0.0 and np.isnan(found[1:]).all()


# The inlet equation


def grows_beyond_all_bounds(heated, film, loading, slip):
    """Whether alpha p does so before the edge of the contact, by the equation as it reads."""

    def cold(logarithm, gap_and_film):
        distance = np.exp(-logarithm)
        gap = hertz_gap(1.0 + distance)
        return distance * gap / (gap_and_film + gap) ** 3

    def hot(logarithm, pressure):
        viscosity = np.exp(pressure[0])
        gap = hertz_gap(1.0 + np.exp(-logarithm))
        rolling = loading * viscosity * (gap / (heated + gap)) ** 2
        sliding = loading * viscosity * slip**2
        thinner = 1.0 + 0.5 * rolling**0.85 + 0.2 * sliding**0.9
        return [cold(logarithm, heated) * viscosity / thinner / scale]

    def unbounded(logarithm, pressure):
        return pressure[0] - 150.0

    unbounded.terminal = True
    ends = -np.log(1e4), -np.log(1e-9)
    scale = quad(cold, *ends, args=(film,), limit=500)[0]
    options = {"rtol": 1e-8, "atol": 1e-10, "method": "LSODA", "events": unbounded}
    return solve_ivp(hot, ends, [0.0], **options).status == 1


@pytest.mark.parametrize("loading", [0.1, 1.0])
@pytest.mark.parametrize("slip", [0.0, 0.5, 2.0])
@pytest.mark.parametrize("film", [0.05, 1.0])
def test_the_factor_solves_the_equation(loading, slip, film):
    factor = inlet_equation(loading, slip, film)
    assert grows_beyond_all_bounds(0.99 * factor * film, film, loading, slip)
    assert not grows_beyond_all_bounds(1.01 * factor * film, film, loading, slip)


@pytest.mark.parametrize(
    ("loading", "slip", "expected"),
    [(1.0, 0.0, 0.815), (1.0, 0.5, 0.538), (1.0, 2.0, 0.190), (0.1, 0.5, 0.914)],
)
def test_another_integration_finds_the_same(loading, slip, expected):
    """The study's design notes, physics beyond the paper, § 16."""
    assert inlet_equation(loading, slip, 0.05) == pytest.approx(expected, rel=0.01)


def test_a_point_of_which_something_is_unknown_has_no_factor():
    found = inlet_equation(np.array([np.nan, 0.1]), 0.5, 0.3)
    assert np.isnan(found[0]) and found[1] == inlet_equation(0.1, 0.5, 0.3)


def test_paper_at_the_largest_force_and_speed():
    """0.80 at a slide-to-roll ratio of 2, 1600 N, 200 r/min, 40 degC: physics-beyond.md, 10.

    Without slip 0.944 by the formula of Murch and Wilson (1975), 1 / (1 + 0.254 Q^0.62).
    """
    loading = thermal_loading(0.28349, 0.049725, 2 * np.pi * 0.05 * 200 / 60, 0.16)
    assert zhu_cheng(loading, 2.0, 4.848e8 / 2.308e11) == pytest.approx(0.8, abs=0.0005)
    murch_wilson = 1.0 / (1.0 + 0.254 * loading**0.62)
    rolling = zhu_cheng(loading, 0.0, 4.848e8 / 2.308e11)
    assert rolling == pytest.approx(murch_wilson, abs=0.005)
