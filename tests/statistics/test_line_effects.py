"""Effects of single lines, for lines whose effects are known."""

import numpy as np
import pytest

from lube.statistics.line_effects import line_effects

ALONE = np.array([[1.0, 0.97, 0.9], [0.97, 1.0, 0.95], [0.9, 0.95, 1.0]])
JOINT = np.array([[1.0, 0.5, 0.1], [0.5, 1.0, 0.5], [0.1, 0.5, 1.0]])
LINES = 32


def shares(rng, alone, joint):
    """Shares of lines paired crosswise, by standard deviations of both kinds of effects."""
    first, second = rng.multivariate_normal(np.zeros(3), ALONE, (2, LINES))
    together = rng.multivariate_normal(np.zeros(3), JOINT, (LINES, LINES))
    return alone * (first[:, None] + second) + joint * together


def test_without_joint_effects_they_are_the_means_over_the_partners():
    found = shares(np.random.default_rng(1), 0.2, 0.0)
    means = found.mean(axis=1) + found.mean(axis=0)
    expected = (means - means.mean(axis=0)) / means.std(axis=0, ddof=1)
    np.testing.assert_allclose(line_effects(found, found), expected, atol=1e-5)


def test_they_are_as_alike_as_the_effects_of_single_lines():
    rng, many = np.random.default_rng(2), 100
    drawn = [shares(rng, 0.2, 1.0) for _ in range(many)]
    found = np.mean([np.corrcoef(line_effects(one, one).T) for one in drawn], axis=0)
    means = [np.corrcoef((one.mean(axis=1) + one.mean(axis=0)).T) for one in drawn]
    assert np.abs(found - ALONE).max() < 0.05
    assert np.abs(np.mean(means, axis=0) - ALONE).max() > 0.2


def test_their_variance_is_that_without_the_part_of_the_pairs():
    rng = np.random.default_rng(3)
    found = np.mean([line_effects(*[shares(rng, 0.2, 1.0)] * 2).var(axis=0) for _ in range(100)])
    # 2 x 0.04 of single lines, and 2 / 32 of pairs in the means.
    assert found == pytest.approx(0.08 / (0.08 + 2.0 / LINES), abs=0.05)
