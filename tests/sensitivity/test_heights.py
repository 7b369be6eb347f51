"""The Gaussian roughness that touches as often as one with other heights."""

import functools

import numpy as np
import pytest
import scipy.special
from made import made
from scipy.interpolate import PchipInterpolator
from studies import CONFIG

from lube.sensitivity.heights import RATIOS, equivalent_ratio
from lube.study.study import load_study
from lube.surfaces.translation import REACH, johnson_curve, lognormal_kurtosis


@functools.cache
def table(rms_height):
    return equivalent_ratio((-1.0, 1.0), (3.0, 6.0), rms_height)


def equivalent(ratio, skewness, kurtosis, rms_height=(1.0, 1.0)):
    return table(rms_height)(*np.broadcast_arrays(np.asarray(ratio, float), skewness, kurtosis))


def test_gaussian_heights_are_their_own():
    np.testing.assert_allclose(equivalent(RATIOS, 0.0, 3.0), RATIOS, rtol=0.05)


@pytest.mark.parametrize(("skewness", "kurtosis"), [(-1.0, 6.0), (0.5, 3.75), (1.0, 6.0)])
@pytest.mark.parametrize("rms_height", [(1.0, 1.0), (3.0, 1.0)])
def test_as_many_points_touch(skewness, kurtosis, rms_height):
    """Against heights that are drawn."""
    gaussian = np.random.default_rng(1).standard_normal((2, 1_000_000))
    curve = johnson_curve(skewness, kurtosis)
    heights = np.interp(gaussian, np.linspace(-REACH, REACH, curve.size), curve)
    height = np.array(rms_height) @ heights / np.hypot(*rms_height)
    ratio = np.array([0.5, 1.0, 2.0, 3.0])
    touching = (height > ratio[:, None]).mean(axis=1)
    found = scipy.special.ndtr(-equivalent(ratio, skewness, kurtosis, rms_height))
    np.testing.assert_allclose(found, touching, atol=4e-4, rtol=0.01)


def test_heights_with_less_kurtosis_than_lognormal_ones_end_nowhere():
    found = equivalent(RATIOS, -1.0, 3.0)
    np.testing.assert_allclose(found, equivalent(RATIOS, -1.0, 4.5), rtol=1e-9)
    assert (found <= RATIOS[-1]).all()


def test_an_unknown_film_has_no_equivalent_and_leaves_those_of_others():
    found = equivalent([2.0, np.nan], 0.5, 4.0)
    assert found[0] == equivalent(2.0, 0.5, 4.0) and np.isnan(found[1])


@pytest.fixture(scope="module")
def counted():
    """Contact of drawn lines with other heights, over skewness, kurtosis and lambda ratio."""
    study = load_study(CONFIG / "paper.yaml")
    return made(study, ["lubricant", "film", "height_distribution"])["height_distribution"]


@pytest.mark.parametrize(
    ("name", "error"), [("geometric_contact_probability", 0.1), ("breakthrough_probability", 0.25)]
)
def test_gaussian_lines_touch_as_often_as_drawn_lines_with_these_heights(counted, name, error):
    """Where contact is frequent enough for eight pairs to show how frequent."""
    probability, ratio = counted[f"{name}_mean"], counted["lambda_ratio"].values
    gaussian = probability.sel(height_skewness=0.0, height_kurtosis=3.0).values
    quantile = PchipInterpolator(ratio, scipy.special.ndtri(np.minimum(gaussian, 1.0 - 1e-9)))
    compared = 0
    for skewness in counted["height_skewness"].values:
        least = max(3.0, lognormal_kurtosis(abs(skewness)))
        for kurtosis in counted.sel(height_kurtosis=slice(least, None))["height_kurtosis"].values:
            own = equivalent(ratio, skewness, kurtosis)
            level = {"height_skewness": skewness, "height_kurtosis": kurtosis}
            found = probability.sel(level).values
            some = (found > 0.05) & (own >= ratio[0]) & (own <= ratio[-1])
            expected = scipy.special.ndtr(quantile(own[some]))
            np.testing.assert_allclose(found[some], expected, rtol=error)
            compared += some.sum()
    assert compared > 40
