"""Break-up of the boundary layer: Eq. 6 in exact arithmetic, and the theorem of the parabola."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.kernels.layer import layer_breaks, layer_factor

STEEL = 210e9 / 0.91 / 2.0  # E*, Pa
THICKNESS, STRENGTH = 5e-9, 1e6  # paper, section 2
critical_curvature = math.pi * STRENGTH / (STEEL * THICKNESS)


@given(
    points=st.integers(1, 5000),
    off_the_tie=st.integers(-3, 3),
    modulus=st.floats(1e9, 1e12),
    thickness=st.floats(1e-9, 1e-8),
    strength=st.floats(1e5, 1e7),
    spacing=st.floats(1e-8, 1e-5),
    height_step=st.sampled_from([1e-12, 1e-13, 2.5e-12]),
)
def test_layer_breaks_where_equation_6_in_exact_arithmetic_says_so(
    points, off_the_tie, modulus, thickness, strength, spacing, height_step
):
    factor = layer_factor(modulus, thickness, strength, spacing, height_step)
    overlap = max(1, round(points**3 / factor) + off_the_tie)
    length = points * Fraction(spacing)
    force = Fraction(modulus) * Fraction(spacing) * overlap * Fraction(height_step)  # Eq. 5
    remaining = Fraction(math.pi) * Fraction(strength) / 12 * length**3 / force
    if abs(remaining / Fraction(thickness) - 1) > Fraction(1, 10**13):  # else: a tie in floats
        assert layer_breaks(points, overlap, factor) == (remaining < Fraction(thickness))


def test_layer_of_exactly_the_critical_thickness_holds():
    assert not layer_breaks(2, 8, 1.0) and layer_breaks(2, 9, 1.0)
    assert not layer_breaks(4, 128, 0.5) and layer_breaks(4, 129, 0.5)


def test_layer_on_a_parabola_breaks_by_its_curvature_at_any_depth():
    for depth in (3e-9, 3e-8, 3e-7, 3e-6):
        for relative_curvature, breaks in ((0.99, False), (1.01, True)):
            curvature = relative_curvature * critical_curvature
            spacing = math.sqrt(2.0 * depth / curvature) / 3000.3  # the limit of a fine grid
            x = spacing * np.arange(-3001, 3002)
            overlap = np.rint((depth - curvature * x**2 / 2.0) / (depth / 1e7)).astype(np.int64)
            overlap = overlap[overlap > 0]
            factor = layer_factor(STEEL, THICKNESS, STRENGTH, spacing, depth / 1e7)
            assert layer_breaks(overlap.size, overlap.sum(), factor) is breaks


def test_critical_curvature_of_the_papers_layer():
    # physics.md, section 5: 5.4e3 1/m, a radius under 184 um.
    assert critical_curvature == pytest.approx(5.4e3, rel=0.01)
    assert 1.0 / critical_curvature == pytest.approx(184e-6, rel=0.005)
