"""Hertzian line contact: identities of the theory, then the figures of the paper's grid."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from lube.physics import hertz

STEEL = (210e9, 0.3)
LENGTH, RADIUS = 0.01, 0.025

radii = st.floats(1e-3, 1.0)
moduli = st.floats(1e9, 1e12)
ratios = st.floats(0.0, 0.49)


@given(radii, radii)
def test_reduced_radius_is_symmetric_and_smaller_than_either(first, second):
    radius = hertz.reduced_radius(first, second)
    assert radius == hertz.reduced_radius(second, first) < min(first, second)
    assert hertz.reduced_radius(first, np.inf) == pytest.approx(first)


@given(moduli, ratios, moduli, ratios)
def test_reduced_modulus_is_symmetric_and_half_or_all_of_the_plane_strain_modulus(
    e_1, n_1, e_2, n_2
):
    reduced, plane_strain = hertz.reduced_modulus, e_1 / (1.0 - n_1**2)
    assert reduced(e_1, n_1, e_2, n_2) == pytest.approx(reduced(e_2, n_2, e_1, n_1))
    assert reduced(e_1, n_1, e_1, n_1) == pytest.approx(plane_strain / 2.0)  # a like pair
    assert reduced(e_1, n_1, np.inf, n_2) == pytest.approx(plane_strain)  # on a rigid body


@given(st.floats(1.0, 1e4), st.floats(1e-3, 0.1), radii, moduli)
def test_elliptic_pressure_carries_the_load_and_flattens_the_cylinder(
    force, length, radius, modulus
):
    half_width = hertz.contact_half_width(force, length, radius, modulus)
    pressure = hertz.maximum_pressure(force, half_width, length)
    carried, _ = quad(lambda x: np.sqrt(1.0 - x**2), -1.0, 1.0)
    assert pressure * half_width * length * carried == pytest.approx(force)
    assert pressure / half_width == pytest.approx(modulus / (2.0 * radius))


def test_surfaces_of_the_elastic_half_space_fit_the_cylinder():
    """The deflection under the elliptic pressure falls off as x^2/2R*, from its integral."""
    modulus, force = hertz.reduced_modulus(*STEEL, *STEEL), 800.0
    half_width = hertz.contact_half_width(force, LENGTH, RADIUS, modulus)
    pressure = hertz.maximum_pressure(force, half_width, LENGTH)
    edges = half_width * np.cos(np.linspace(np.pi, 0.0, 4001))
    middle = (edges[1:] + edges[:-1]) / 2.0
    load = pressure * np.sqrt(1.0 - (middle / half_width) ** 2) * np.diff(edges)
    x = half_width * np.array([0.0, 0.3, 0.6, 0.9])
    deflection = [-2.0 / (np.pi * modulus) * np.sum(load * np.log(np.abs(p - middle))) for p in x]
    np.testing.assert_allclose(
        deflection[0] - np.array(deflection[1:]), x[1:] ** 2 / (2 * RADIUS), rtol=1e-2
    )


def test_the_papers_grid():
    """121..485 MPa and 2a = 0.105..0.420 mm over 100..1600 N: physics.md, section 1."""
    modulus = hertz.reduced_modulus(*STEEL, *STEEL)
    force = np.array([100.0, 1600.0])
    width = 2.0 * hertz.contact_half_width(force, LENGTH, RADIUS, modulus)
    np.testing.assert_allclose(width, [0.105e-3, 0.420e-3], rtol=2e-3)
    pressure = hertz.maximum_pressure(force, 0.5 * width, LENGTH)
    np.testing.assert_allclose(pressure, [121e6, 485e6], rtol=3e-3)
    assert int(width[1] / (2.0 * np.pi * 0.05 / 1e6)) == 1337


def test_the_gap_is_the_parabola_far_away_and_the_integral_of_its_slope():
    distance = np.linspace(1.0, 3.0, 20001)
    slope = np.sqrt(distance**2 - 1.0)  # of a half-plane beside Hertz' pressure
    steps = 0.5 * (slope[1:] + slope[:-1]) * np.diff(distance)
    assert hertz.hertz_gap(distance)[-1] == pytest.approx(steps.sum(), rel=1e-5)
    assert hertz.hertz_gap(np.array([-1e4]))[0] == pytest.approx(0.5e8, rel=1e-6)
    assert np.all(hertz.hertz_gap(np.linspace(-1.0, 1.0, 11)) == 0.0)
