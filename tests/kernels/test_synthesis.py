"""Random phases and translated heights."""

import numpy as np

from lube.kernels.synthesis import PHASES, random_phasors, translated_steps


def test_phasors_are_those_of_the_phases_drawn():
    phasors = random_phasors(np.random.default_rng(3), 1000)
    phases = np.random.default_rng(3).integers(0, PHASES, 1000, dtype=np.uint16)
    assert phasors.dtype == np.complex64
    np.testing.assert_allclose(phasors, np.exp(2j * np.pi * phases / PHASES), rtol=0, atol=1e-7)


def test_phases_are_uniform():
    phasors = random_phasors(np.random.default_rng(4), 200_000).astype(complex)
    for harmonic in (1, 2, 3, 4, 8):
        assert abs(np.mean(phasors**harmonic)) < 4.0 / np.sqrt(phasors.size)


def test_translated_heights_are_interpolated_centred_and_scaled():
    heights = np.random.default_rng(5).normal(size=10_000).astype(np.float32)
    curve = np.sinh(np.linspace(-8.0, 8.0, 257) / 2.0)
    steps = translated_steps(heights, curve, 8.0, 2e5)
    expected = np.interp(heights.astype(float), np.linspace(-8.0, 8.0, 257), curve)
    expected -= expected.mean()
    expected *= 2e5 / np.sqrt(np.mean(expected**2))
    assert steps.dtype == np.int32
    np.testing.assert_allclose(steps, expected, rtol=0, atol=2)


def test_heights_beyond_a_curve_are_those_of_its_ends():
    heights = np.array([-9.0, -1.0, 1.0, 9.0], np.float32)
    steps = translated_steps(heights, np.array([-1.0, 1.0]), 1.0, 1e3)
    assert steps.tolist() == [-1000, -1000, 1000, 1000]
