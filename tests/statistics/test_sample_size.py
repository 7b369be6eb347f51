"""Independent windows and the effective sample size of one realisation."""

import numpy as np
import pytest

from lube.statistics.sample_size import effective_sample_size, independent_windows


def test_windows_are_a_longest_wavelength_apart_and_at_least_one():
    found = independent_windows(0.3, np.array([2e-4, 1.0]), 4e-4)
    np.testing.assert_allclose(found, [500.0, 1.0])


def test_effective_sample_size_of_coins_is_their_number():
    shares = np.random.default_rng(4).binomial(50, 0.3, (4000, 1)) / 50
    assert effective_sample_size(shares, 9.0).item() == pytest.approx(50.0, rel=0.05)


def test_without_scatter_the_windows_take_its_place():
    same = np.full((7, 2), 0.1)
    assert effective_sample_size(same, np.array([3.0, 4.0])).tolist() == [3.0, 4.0]
    assert effective_sample_size(np.array([[0.2, 0.9]]), 5.0).tolist() == [5.0, 5.0]
