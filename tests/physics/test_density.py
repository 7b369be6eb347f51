"""Density of an oil over temperature."""

import numpy as np

from lube.physics.density import linear_density


def test_density_is_linear_about_15_degc():
    density = linear_density(np.array([288.15, 298.15, 308.15]), 860.0, 6.4e-4)
    np.testing.assert_allclose(density, [860.0, 860.0 * 0.9936, 860.0 * 0.9872], rtol=1e-12)
