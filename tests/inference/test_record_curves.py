"""Curves of a master map whose contacts come independently along the line: there all is exact."""

import numpy as np
import pytest
import xarray as xr
from scipy.special import expit, logit

from lube.inference.record_curves import curve_at, map_curves

WIDTHS = np.array([0.5e-3, 1e-3, 2e-3])
RATIOS = np.geomspace(0.5, 2.0, 9)
DIMS = ("lambda_ratio", "contact_width")


def chance(ratio, width):
    """Probability of a contact within a width, if they come independently."""
    return -np.expm1(-width / 1e-3 * ratio**-2.0)


@pytest.fixture
def master():
    """A map of such contacts, from two realisations that differ by a tenth."""
    mean = chance(RATIOS[:, None], WIDTHS)
    values = np.stack([0.95 * mean, 1.05 * mean])
    coords = {"realisation": [0, 1], "lambda_ratio": RATIOS, "contact_width": WIDTHS}
    variables = {
        "breakthrough_probability": (("realisation", *DIMS), values),
        "breakthrough_probability_mean": (DIMS, mean),
    }
    return xr.Dataset(variables, coords, {"travel": 1e6, "longest_wavelength": 1e-3})


def test_a_curve_is_right_at_any_width_between_and_beyond_the_maps(master):
    for width in (*WIDTHS, 0.7e-3, 1.9e-3, 0.3e-3, 3e-3):
        found = expit(curve_at(master, width).logit_at(np.log(RATIOS)))
        np.testing.assert_allclose(found, chance(RATIOS, width), rtol=1e-9)
    curve = curve_at(master.isel(contact_width=[1]), 0.6e-3)  # a map of one width
    np.testing.assert_allclose(curve.logit_at(np.log(RATIOS)), logit(chance(RATIOS, 0.6e-3)))


@pytest.mark.parametrize("at_edges", [0.3, -0.2])
def test_beyond_the_maps_widths_the_edges_of_the_window_add_what_they_add_within(master, at_edges):
    """What they cut off holds more easily or breaks more easily, however wide the window is."""

    def mean(width):
        return -np.expm1(-np.maximum(width / 1e-3 + at_edges, 0.0) * RATIOS**-2.0)

    values = np.stack([mean(width) for width in WIDTHS], axis=1)
    own = master.assign(breakthrough_probability_mean=(DIMS, values))
    for width in (0.3e-3, 0.7e-3, 3e-3):
        found = expit(curve_at(own, width).logit_at(np.log(RATIOS)))
        np.testing.assert_allclose(found, mean(width), rtol=1e-9)
    assert curve_at(own, 1e-5).films.size == (RATIOS.size if at_edges > 0.0 else 0)


def test_the_sample_size_is_that_of_the_scatter_between_realisations(master):
    curve = curve_at(master, WIDTHS[1])
    mean = chance(RATIOS, WIDTHS[1])
    variance = 2.0 * (0.05 * mean) ** 2  # of two values, on either side of their mean
    np.testing.assert_allclose(curve.sample_size, mean * (1.0 - mean) / variance)
    # Beyond the map's widths it is that of the nearest.
    wide, widest = curve_at(master, WIDTHS[-1]), curve_at(master, 2.0 * WIDTHS[-1])
    np.testing.assert_allclose(widest.sample_size, wide.sample_size[: widest.sample_size.size])


def test_another_layers_curve_has_no_known_scatter(master):
    layer = master["breakthrough_probability_mean"].rename(
        lambda_ratio="layer_lambda_ratio", contact_width="layer_contact_width"
    )
    curve = curve_at(master, 0.7e-3, layer)
    np.testing.assert_array_equal(curve.logits, curve_at(master, 0.7e-3).logits)
    assert np.isnan(curve.sample_size).all()


def test_what_was_not_seen_in_all_windows_is_not_known(master):
    rare = master.assign_attrs(travel=0.003)  # two windows of each realisation
    assert curve_at(rare, WIDTHS[0]).films.max() < curve_at(master, WIDTHS[0]).films.max()


def test_each_record_is_read_off_at_its_own_width(master):
    widths = [1e-3, 0.7e-3, 1e-3]
    ratios = np.array([[0.8, 0.9, 1.0], [1.3, 1.4, 1.5]])
    records = xr.Dataset(
        {
            "contact_half_width": ("record", np.array(widths) / 2.0),
            "film_thickness": (("film_formula", "record"), ratios),
        }
    )
    layer = master["breakthrough_probability"].expand_dims(layer_strength=[1.0])
    names = {"lambda_ratio": "layer_lambda_ratio", "contact_width": "layer_contact_width"}
    whole = master.assign(layer_breakthrough_probability=layer.rename(names))
    logits = map_curves(whole, records).logits(records["film_thickness"].T)
    assert logits.dims == ("film_formula", "record")
    for number, width in enumerate(widths):
        expected = curve_at(master, width).logit_at(np.log(ratios[:, number]))
        np.testing.assert_array_equal(logits.values[:, number], expected)
