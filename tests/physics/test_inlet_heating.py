"""Inlet shear heating: none at rest, then a power of the speed."""

import pytest
from paper_grid import log_slope

from lube.physics.inlet_heating import inlet_shear_heating_factor


def test_inlet_shear_heating_vanishes_at_rest_and_grows_with_the_right_power_of_speed():
    assert inlet_shear_heating_factor(0.3, 0.05, 0.0, 0.14) == 1.0

    def loss(speed):
        return 1.0 / inlet_shear_heating_factor(0.3, 0.05, speed, 0.14) - 1.0

    assert log_slope(loss, (1.0,), 0) == pytest.approx(2 * 0.62)
    assert inlet_shear_heating_factor(1.0, 1.0, 1.0, 1.0) == pytest.approx(1 / 1.254)
