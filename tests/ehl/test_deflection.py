"""Deflection of the rollers: Hertz' contact, exact integrals, limits, symmetry."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0

from lube.ehl.deflection import deflection_matrix

# Finer towards the ends, where Hertz' pressure falls as a root.
NODES = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 2001))
HERTZ = np.sqrt(1.0 - NODES**2)


def test_hertz_pressure_flattens_the_contact():
    """Parabola and deflection together are constant inside, and rise outside as Hertz' gap."""
    inside = np.linspace(-0.99, 0.99, 100)
    gap = 0.5 * inside**2 + deflection_matrix(inside, NODES) @ HERTZ
    np.testing.assert_allclose(gap, 0.25 + np.log(2.0) / 2.0, atol=2e-6)
    outside = np.array([-5.0, -1.2, 1.01, 3.0])
    gap = 0.5 * outside**2 + deflection_matrix(outside, NODES) @ HERTZ
    x = np.abs(outside)
    hertz_gap = 0.5 * (x * np.sqrt(x**2 - 1.0) - np.log(x + np.sqrt(x**2 - 1.0)))
    np.testing.assert_allclose(gap - 0.25 - np.log(2.0) / 2.0, hertz_gap, atol=2e-6)


def test_far_away_the_pressure_acts_as_a_point_load():
    """A load of pi/2 deflects by -ln|X| / 2."""
    far = np.array([-1e4, -300.0, 300.0])
    deflection = deflection_matrix(far, NODES[::10]) @ HERTZ[::10]
    np.testing.assert_allclose(deflection, -0.5 * np.log(np.abs(far)), rtol=2e-4)


@pytest.mark.parametrize("across", [0.0, 0.05, 3.0, 30.0])
def test_each_column_is_the_integral_of_a_hat(across):
    nodes = np.array([-3.0, -1.0, -0.5, 0.7, 1.1])
    matrix = deflection_matrix(np.array([-2.0, 0.7, 0.9]), nodes, across)
    kernel = (lambda x: k0(across * x)) if across else (lambda x: -np.log(x))
    assert np.all(matrix[:, [0, -1]] == 0.0)
    for row, position in enumerate((-2.0, 0.7, 0.9)):
        for column in (1, 2, 3):
            hat = np.eye(nodes.size)[column]

            def density(x, hat=hat, position=position):
                return np.interp(x, nodes, hat) * kernel(abs(x - position)) / np.pi

            kinks = sorted({*nodes[1:-1], position})
            integral, _ = quad(density, -3.0, 1.1, points=kinks, epsabs=1e-12, epsrel=1e-10)
            assert matrix[row, column] == pytest.approx(integral, abs=2e-9)


def test_a_pressure_that_hardly_changes_along_the_rollers_deflects_as_one_that_does_not():
    """For a small wavenumber k, K0(k X) is -ln X and a constant."""
    at, small = np.linspace(-2.0, 2.0, 9), 1e-5
    constant = -np.log(small / 2.0) - np.euler_gamma
    expected = deflection_matrix(at, NODES) @ HERTZ + 0.5 * constant
    found = deflection_matrix(at, NODES, small) @ HERTZ
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_a_fast_wave_along_the_rollers_deflects_as_its_own_pressure():
    """A half-space under a wave of pressure deflects by the pressure over the wavenumber."""
    inside = np.linspace(-0.5, 0.5, 9)
    fast = 200.0
    found = deflection_matrix(inside, NODES, fast) @ HERTZ
    np.testing.assert_allclose(found, np.sqrt(1.0 - inside**2) / fast, rtol=1e-4)


def test_mirrored_pressure_deflects_in_the_mirror():
    nodes = np.cumsum(np.random.default_rng(1).uniform(0.05, 0.2, 30))
    pressure = np.random.default_rng(2).uniform(0.0, 1.0, 30)
    at = np.linspace(0.0, 4.0, 9)
    there = deflection_matrix(-at[::-1], -nodes[::-1]) @ pressure[::-1]
    np.testing.assert_allclose(there[::-1], deflection_matrix(at, nodes) @ pressure, atol=1e-13)


def test_rollers_as_a_whole_are_not_pushed_sideways():
    r"""The pressure's force along the deflected surface vanishes: reciprocity, for any pressure.

    .. math:: \int P \frac{dD}{dX} dX = \frac{1}{\pi} \iint \frac{P(X) P(X')}{X' - X} dX' dX = 0

    because the integrand changes its sign when X and X' are exchanged.
    """
    rng = np.random.default_rng(3)
    nodes = np.cumsum(rng.uniform(0.05, 0.2, 40))
    pressure = np.append(np.append(0.0, rng.uniform(0.0, 1.0, 38)), 0.0)
    points, weights = np.polynomial.legendre.leggauss(40)
    step = np.diff(nodes)
    inside = 0.5 * (nodes[1:] + nodes[:-1])[:, None] + 0.5 * step[:, None] * points
    deflection = (deflection_matrix(inside.ravel(), nodes) @ pressure).reshape(inside.shape)
    # By parts, in every cell: the slope of the pressure is constant there.
    parts = np.diff(pressure) * (deflection @ weights) / 2.0
    assert np.abs(parts).max() > 1e-2
    assert parts.sum() == pytest.approx(0.0, abs=1e-7)
