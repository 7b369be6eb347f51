"""Break-up of the boundary layer: Eq. 6 in exact arithmetic, and the theorem of the parabola."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.kernels.layer import layer_breaks, layer_factor

STEEL = 210e9 / 0.91 / 2.0  # E*, Pa
PAPER = {"critical_thickness": 5e-9, "shear_strength": 1e6}  # paper, section 2


def exact_layer_thickness(points, overlap, modulus, strength, spacing, height_step):
    """h_l = (pi tau0 / 12) D^3 / F (paper, Eq. 6), as a fraction of the very floats."""
    modulus, strength, spacing, height_step = map(
        Fraction, (modulus, strength, spacing, height_step)
    )
    length = points * spacing
    force = modulus * spacing * overlap * height_step  # Eq. 5
    return Fraction(math.pi) * strength / 12 * length**3 / force


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
    remaining = exact_layer_thickness(points, overlap, modulus, strength, spacing, height_step)
    if abs(remaining / Fraction(thickness) - 1) > Fraction(1, 10**13):  # else: a tie in floats
        assert layer_breaks(points, overlap, factor) == (remaining < Fraction(thickness))


def test_layer_of_exactly_the_critical_thickness_holds():
    assert not layer_breaks(2, 8, 1.0)
    assert layer_breaks(2, 9, 1.0)
    assert not layer_breaks(4, 128, 0.5)
    assert layer_breaks(4, 129, 0.5)


def parabola(curvature, depth, spacing, height_step):
    """Number of points and summed overlap of depth - curvature x^2 / 2, in height steps."""
    reach = int(math.sqrt(2.0 * depth / curvature) / spacing) + 1
    x = spacing * np.arange(-reach, reach + 1)
    overlap = np.rint((depth - curvature * x**2 / 2.0) / height_step).astype(np.int64)
    return np.count_nonzero(overlap > 0), overlap[overlap > 0].sum()


@pytest.mark.parametrize("depth", [3e-9, 3e-8, 3e-7, 3e-6])
@pytest.mark.parametrize(("relative_curvature", "breaks"), [(0.99, False), (1.01, True)])
def test_layer_on_a_parabola_breaks_by_its_curvature_whatever_its_depth(
    depth, relative_curvature, breaks
):
    critical = math.pi * PAPER["shear_strength"] / (STEEL * PAPER["critical_thickness"])
    curvature = relative_curvature * critical
    spacing = math.sqrt(2.0 * depth / curvature) / 3000.3  # the limit of a fine grid
    height_step = depth / 1e7
    points, overlap = parabola(curvature, depth, spacing, height_step)
    factor = layer_factor(STEEL, **PAPER, spacing=spacing, height_step=height_step)
    assert layer_breaks(points, overlap, factor) is breaks


def test_critical_curvature_of_the_papers_layer():
    # physics.md, section 5: 5.4e3 1/m, a radius under 184 um.
    critical = math.pi * PAPER["shear_strength"] / (STEEL * PAPER["critical_thickness"])
    assert critical == pytest.approx(5.4e3, rel=0.01)
    assert 1.0 / critical == pytest.approx(184e-6, rel=0.005)


def test_only_strength_over_critical_thickness_enters():
    grid = {"spacing": 3e-7, "height_step": 1e-12}
    assert layer_factor(STEEL, 5e-9, 1e6, **grid) == pytest.approx(
        layer_factor(STEEL, 1e-8, 2e6, **grid), rel=1e-15
    )
