"""Crossings of a Gaussian line, and contacts of a surface: limits."""

import numpy as np
import pytest
import scipy.stats

from lube.physics.excursions import SurfaceMoments, crossing_rate, expected_contacts

MOMENTS = 2.0, 3.0, 40.0
SURFACE = SurfaceMoments(2.0, along=1.5, across=1.5, mixed=0.0, curvature=40.0)


def test_a_narrow_band_crosses_zero_once_a_wave():
    wavenumber = 5.0
    moments = tuple(wavenumber**order for order in (0, 2, 4))
    assert crossing_rate(0.0, moments) == pytest.approx(wavenumber / (2.0 * np.pi))


def test_crossings_fall_as_the_density_of_heights_does():
    ratio = crossing_rate(3.0, MOMENTS) / crossing_rate(1.0, MOMENTS)
    assert ratio == pytest.approx(np.exp(-(9.0 - 1.0) / (2.0 * MOMENTS[0])))


def test_contacts_of_a_point_a_line_and_a_large_area():
    height = 3.0
    level, tail = height * np.sqrt(MOMENTS[0]), scipy.stats.norm.sf(height)
    moments = SurfaceMoments(MOMENTS[0], along=0.9, across=2.1, mixed=0.4, curvature=40.0)
    assert expected_contacts(level, moments, 0.0, 0.0) == pytest.approx(tail)
    for slope, *sides in ((moments.across, 5.0, 0.0), (moments.along, 0.0, 5.0)):
        edge = 5.0 * crossing_rate(level, (MOMENTS[0], slope, 0.0))
        assert expected_contacts(level, moments, *sides) == pytest.approx(tail + edge)
    # Adler & Taylor: (2 pi)^(-3/2) (det lambda)^(1/2) u exp(-u^2/2) per area.
    dense = height * np.exp(-(height**2) / 2.0) / (2.0 * np.pi) ** 1.5
    dense *= np.sqrt(np.linalg.det([[0.9, 0.4], [0.4, 2.1]])) / MOMENTS[0]
    assert expected_contacts(level, moments, 1e4, 1e4) == pytest.approx(1e8 * dense, rel=1e-3)
