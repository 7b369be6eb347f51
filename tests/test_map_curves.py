"""Curves of a master map whose contacts come independently along the line: there all is exact."""

import numpy as np
import pytest
import xarray as xr

from lube.map_curves import curve_at, curves_at, logits_on

WIDTHS = np.array([0.5e-3, 1e-3, 2e-3])
RATIOS = np.geomspace(0.5, 2.0, 9)


def chance(ratio, width):
    """Probability of a contact within a width, if they come independently."""
    return -np.expm1(-width / 1e-3 * ratio**-2.0)


@pytest.fixture
def master():
    """A map of such contacts, seen in so many windows that nothing is too rare to be known."""
    mean = xr.DataArray(
        chance(RATIOS[:, None], WIDTHS),
        dims=("lambda_ratio", "contact_width"),
        coords={"lambda_ratio": RATIOS, "contact_width": WIDTHS},
    )
    sides = {"mean": 1.0, "lower": 0.9, "upper": 1.05}
    variables = {f"breakthrough_probability_{each}": mean * by for each, by in sides.items()}
    attributes = {"travel": 1e6, "longest_wavelength": 1e-3}
    return xr.Dataset(variables, {"realisation": [0, 1]}, attributes)


@pytest.mark.parametrize("width", [*WIDTHS, 0.7e-3, 1.9e-3])
def test_a_curve_is_right_at_any_width(master, width):
    curve = curve_at(master["breakthrough_probability_mean"], master, width)
    share = chance(RATIOS, width)
    np.testing.assert_allclose(
        curve.logit_at(np.log(RATIOS)), np.log(share / (1.0 - share)), rtol=1e-9
    )


def test_the_limits_have_curves_on_their_sides(master):
    mean, lower, upper = (curve.logit_at(np.log(1.0)) for curve in curves_at(master, 0.5e-3))
    assert lower < mean < upper


def test_what_was_not_seen_in_all_windows_is_not_known(master):
    rare = master.assign_attrs(travel=0.003)  # two windows of each realisation
    mean = rare["breakthrough_probability_mean"]
    known = curve_at(mean, master, 0.5e-3).films.max()
    assert curve_at(mean, rare, 0.5e-3).films.max() < known


def test_each_force_is_read_off_at_its_own_width(master):
    forces = xr.DataArray([100.0, 400.0], dims="force", name="force")
    film = xr.Dataset({"contact_half_width": ("force", WIDTHS[1:] / 2.0)}, {"force": forces})
    levels = {"temperature": [40.0, 80.0], "speed": [60.0], "film_formula": ["paper"]}
    levels |= {"lubricant": ["oil"], "force": forces.values}
    ratios = xr.DataArray(
        np.array([[0.8, 0.9], [1.3, 1.4]])[:, None, None, None, :],
        dims=("temperature", "speed", "film_formula", "lubricant", "force"),
        coords=levels,
    )
    logits = logits_on(lambda width: curves_at(master, width)[0], film, ratios)
    assert logits.dims == ("lubricant", "film_formula", "temperature", "speed", "force")
    for number, width in enumerate(WIDTHS[1:]):
        curve = curves_at(master, width)[0]
        expected = curve.logit_at(np.log(ratios.isel(force=number)))
        np.testing.assert_array_equal(logits.isel(force=number).squeeze(), np.squeeze(expected))
