"""Random phases and whole heights."""

import numpy as np
import pytest

from lube.kernels.synthesis import PHASES, random_directions, whole_steps


def test_directions_are_the_phasors_of_the_phases_drawn():
    directions = random_directions(np.random.default_rng(3), 1000)
    phases = np.random.default_rng(3).integers(0, PHASES, 1000, dtype=np.uint16)
    expected = np.exp(2j * np.pi * phases / PHASES)
    assert directions.dtype == np.complex64
    np.testing.assert_allclose(directions, expected, rtol=0, atol=1e-7)


@pytest.mark.parametrize("harmonic", [1, 2, 3, 4, 8])
def test_directions_favour_no_phase(harmonic):
    count = 200_000
    mean = np.mean(random_directions(np.random.default_rng(4), count).astype(complex) ** harmonic)
    assert abs(mean) < 4.0 / np.sqrt(count)


def test_heights_are_rounded_to_the_nearest_step():
    heights = np.array([-1.6, -1.4, -0.5, 0.49, 0.5, 1.5, 2.51, 654321.0], np.float32)
    steps = whole_steps(heights)
    assert steps.dtype == np.int32
    assert steps.tolist() == [-2, -1, 0, 0, 0, 2, 3, 654321]
