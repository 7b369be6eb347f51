"""Inlet shear heating: none at rest, then powers of speed and slip."""

import numpy as np
import pytest
from paper_grid import log_slope

from lube.physics.inlet_heating import inlet_shear_heating_factor

OIL = 0.3, 0.05, 1.0, 0.14  # viscosity, its coefficient, speed, conductivity
SLIP = np.linspace(0.0, 2.0, 41)


def test_at_rest_nothing_is_heated():
    assert inlet_shear_heating_factor(0.3, 0.05, 0.0, 0.14, 2e-3, 2.0) == 1.0


def test_without_load_and_slip_the_loss_is_a_power_of_the_speed():
    def loss(speed):
        return 1.0 / inlet_shear_heating_factor(0.3, 0.05, speed, 0.14, 0.0, 0.0) - 1.0

    assert log_slope(loss, (1.0,), 0) == pytest.approx(2 * 0.64)
    assert inlet_shear_heating_factor(1.0, 1.0, 1.0, 1.0, 0.0, 0.0) == pytest.approx(1 / 1.213)
    assert inlet_shear_heating_factor(1.0, 1.0, 1.0, 1.0, 0.01, 0.0) == pytest.approx(0.868 / 1.213)


def test_the_factor_falls_with_slip_either_way_and_with_pressure():
    factor = inlet_shear_heating_factor(*OIL, 2e-3, SLIP)
    assert np.all(np.diff(factor) < 0.0)
    np.testing.assert_array_equal(inlet_shear_heating_factor(*OIL, 2e-3, -SLIP), factor)
    by_pressure = inlet_shear_heating_factor(*OIL, np.linspace(0.0, 5e-3, 9), 1.0)
    assert np.all(np.diff(by_pressure) < 0.0)


def test_beyond_the_formulas_range_there_is_no_factor():
    """At Q = 1, p_H / E' = 1 / 13.2 brings the numerator to zero."""
    found = inlet_shear_heating_factor(1.0, 1.0, 1.0, 1.0, np.array([0.075, 0.0758, 0.1]), 0.0)
    assert found[0] > 0.0 and np.isnan(found[1:]).all()


def test_paper_at_the_largest_force_and_speed():
    """0.80 at a slide-to-roll ratio of 2, 1600 N, 200 r/min, 40 degC: physics-beyond.md, 10.

    Without slip 0.944 by the formula of Murch and Wilson (1975), 1 / (1 + 0.254 Q^0.62).
    """
    oil = 0.28349, 0.049725, 2 * np.pi * 0.05 * 200 / 60, 0.16
    loading = oil[0] * oil[1] * oil[2] ** 2 / oil[3]
    sliding = inlet_shear_heating_factor(*oil, 4.848e8 / 2.308e11, 2.0)
    assert sliding == pytest.approx(0.8, abs=0.0005)
    murch_wilson = 1.0 / (1.0 + 0.254 * loading**0.62)
    rolling = inlet_shear_heating_factor(*oil, 4.848e8 / 2.308e11, 0.0)
    assert rolling == pytest.approx(murch_wilson, abs=0.005)
