"""Dimensionless groups: independent of units, and made of mean or sum of the speeds."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.physics import dimensionless

scales = st.floats(1e-3, 1e3)


def groups_of(load_per_length, modulus, radius, viscosity, speed, alpha):
    return (
        dimensionless.dimensionless_load(load_per_length, modulus, radius),
        dimensionless.dimensionless_speed(viscosity, speed, modulus, radius),
        dimensionless.dimensionless_material(alpha, modulus),
    )


@given(scales, scales, scales)
def test_other_units_of_length_force_and_time_change_nothing(length, force, time):
    pressure = force / length**2
    units = (force / length, pressure, length, pressure * time, length / time, 1.0 / pressure)
    quantities = (8e4, 4.6e11, 0.025, 0.28, 0.52, 16e-9)
    scaled = [quantity * unit for quantity, unit in zip(quantities, units, strict=True)]
    assert groups_of(*scaled) == pytest.approx(groups_of(*quantities), rel=1e-12)


def test_groups_of_ones_are_ones():
    assert groups_of(1.0, 1.0, 1.0, 1.0, 1.0, 1.0) == (1.0, 1.0, 1.0)


def test_moes_numbers_are_made_with_the_sum_of_the_speeds():
    moes_load, moes_material = dimensionless.moes_numbers(1e-5, 0.5e-12, 1e3)
    assert moes_load == pytest.approx(10.0)
    assert moes_material == pytest.approx(1.0)
