"""Flattening of waves: limits, then the table of the source."""

import numpy as np
import pytest

from lube.ehl.line_contact import LineContact, solve
from lube.ehl.response import WaveResponse
from lube.physics.flattening import amplitude_ratio


def test_short_waves_are_kept_and_long_ones_flattened():
    wavelength = np.geomspace(1e-6, 1e6, 200)
    ratio = amplitude_ratio(wavelength, 5.0, 8.0)
    assert np.all(np.diff(ratio) < 0.0)
    assert ratio[0] == pytest.approx(1.0, abs=1e-5) and ratio[-1] < 1e-9


def test_only_one_number_matters():
    one = amplitude_ratio(0.5, 16.0, 9.0)
    assert amplitude_ratio(0.5 * 8.0 / 3.0, 1.0, 1.0) == pytest.approx(one, rel=1e-12)


# M = 100 and L = 11: ratio by the formula and as computed in the source, physics-beyond.md, 11.
TABLE = {
    4.0: (0.020, 0.030),
    2.0: (0.066, 0.073),
    1.0: (0.187, 0.183),
    0.5: (0.401, 0.394),
    0.25: (0.635, 0.660),
    0.125: (0.803, 0.839),
}


@pytest.mark.parametrize("wavelength", TABLE)
def test_values_of_the_source(wavelength):
    formula, computed = TABLE[wavelength]
    assert amplitude_ratio(wavelength, 100.0, 11.0) == pytest.approx(formula, abs=6e-4)
    assert amplitude_ratio(wavelength, 100.0, 11.0) == pytest.approx(computed, abs=0.04)


@pytest.mark.parametrize(
    ("load", "deviations"),
    [
        (5.0, (-0.16, -0.09)),
        (10.0, (-0.14, -0.13)),
        (20.0, (-0.06, -0.14)),
        (40.0, (0.03, -0.07)),
        (100.0, (0.06, 0.04)),
    ],
)
def test_only_at_high_loads_it_agrees_with_reynolds_equation(load, deviations):
    """At L = 11, for waves of one and half the half-width, as the documentation says."""
    material = 2e-8 * 2.308e11
    speed = 0.5 * (11.0 / material) ** 4
    contact = LineContact(load * np.sqrt(2.0 * speed), speed, material, 0.1, 2.308e11)
    profile = solve(contact)
    for wavelength, deviation in zip((1.0, 0.5), deviations, strict=True):
        solved = abs(WaveResponse(profile, wavelength).transfer(1.0, np.zeros(1)).item())
        by_formula = amplitude_ratio(wavelength, load, 11.0)
        assert by_formula / solved - 1.0 == pytest.approx(deviation, abs=0.008)
