"""Contact by skewness and kurtosis: the ensemble's where heights are Gaussian, then trends."""

import numpy as np
import pytest

from lube.contact.counted import contact_at
from lube.contact.rough_pair import roughness_batch
from lube.stages.height_distribution import LAMBDA_RATIOS, PAIRS, make

NAMES = ("breakthrough_probability", "geometric_contact_probability")


@pytest.fixture(scope="module")
def coarse(study):
    """The study on coarse lines, on which only a weak layer breaks."""
    changes = {
        "roughness": study.roughness.model_copy(update={"points": 50_000}),
        "boundary_layer": study.boundary_layer.model_copy(update={"shear_strength": 1e5}),
        "seed": 11,
    }
    return study.model_copy(update=changes)


@pytest.fixture(scope="module")
def found(coarse, film):
    return make(coarse, {"film": film})


def test_gaussian_heights_have_the_probabilities_of_the_ensemble(found, coarse, film):
    table = film[["reduced_modulus"]].assign(
        film_thickness=("point", LAMBDA_RATIOS * film["composite_rms_roughness"].item()),
        contact_half_width=film["contact_half_width"].max(),
    )
    lines = roughness_batch(coarse.line_spec, coarse.seed, range(PAIRS))
    contact = contact_at(lines, table, coarse.boundary_layer)
    gaussian = found.sel(height_skewness=0.0, height_kurtosis=3.0)
    for name in NAMES:
        expected = contact[name].isel(slide_to_roll_ratio=0).mean("realisation")
        np.testing.assert_allclose(gaussian[f"{name}_mean"], expected, rtol=1e-12)


def test_neither_the_lines_own_heights_nor_threads_matter(found, coarse, film):
    worn = coarse.roughness.model_copy(update={"skewness": -1.0})
    worn = coarse.model_copy(update={"roughness": worn})
    assert make(worn, {"film": film}, threads=3).equals(found)


def test_intervals_enclose_the_mean_and_the_moments_are_attained(found):
    for name in NAMES:
        mean, lower, upper = (found[f"{name}_{end}"] for end in ("mean", "lower", "upper"))
        assert np.all((lower <= mean) & (mean <= upper) & (lower < upper))
    breakthrough, contact = (found[f"{name}_mean"] for name in NAMES)
    assert np.all(breakthrough <= contact)
    np.testing.assert_allclose(
        found["attained_skewness"],
        found["height_skewness"].broadcast_like(breakthrough[..., 0]),
        atol=0.06,
    )
    kurtosis = found["height_kurtosis"].broadcast_like(breakthrough[..., 0]).T
    np.testing.assert_allclose(found["attained_kurtosis"], kurtosis.T, rtol=0.06)


def test_worn_peaks_touch_less_and_high_ones_more(found):
    high = found["geometric_contact_probability_mean"].sel(lambda_ratio=2.5)
    assert np.all(high.sel(height_kurtosis=4.0).diff("height_skewness") > 0.0)
    assert np.all(high.sel(height_skewness=0.0).diff("height_kurtosis") > 0.0)
