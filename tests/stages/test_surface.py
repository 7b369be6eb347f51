"""Measured surfaces described: what the fits say of surface, instrument and band."""

import numpy as np
import pytest
import xarray as xr
import yaml
from example_surface import rolled_off_surface
from studies import PAPER

from lube.stages.surface import measured_surfaces
from lube.study.study import load_study

POINTS, LENGTH = 512, 8e-4


def described(folder, heights, shortest="7 um"):
    """A study whose rollers have a map, without a Hurst exponent, and what is said of the map."""
    position = np.arange(POINTS) * LENGTH / POINTS
    coords = {name: ((name), position, {"units": "m"}) for name in ("x", "y")}
    xr.Dataset({"height": (("x", "y"), heights, {"units": "m"})}, coords).to_netcdf(
        folder / "map.nc"
    )
    one = {"topography": {"file": "map.nc", "texture": "isotropic"}}
    study = {
        "based_on": str(PAPER),
        "name": "mine",
        "rollers": {"first": one, "second": one},
        "roughness": {
            "hurst_exponent": None,
            "longest_wavelength": "0.2 mm",
            "shortest_wavelength": shortest,
        },
    }
    (folder / "study.yaml").write_text(yaml.safe_dump(study), encoding="utf-8")
    study = load_study(folder / "study.yaml")
    hurst = study.roughness.hurst_exponent
    return measured_surfaces(study.topographies, study.line_spec, hurst)


def blurred(heights):
    """A map as an optical instrument of a resolution of 7 um sees it."""
    waves = np.fft.fftfreq(POINTS, LENGTH / POINTS)
    squared = waves[:, None] ** 2 + waves[: POINTS // 2 + 1] ** 2
    return np.fft.irfft2(np.fft.rfft2(heights) * np.exp(-squared * 7e-6**2))


@pytest.fixture(scope="module")
def heights():
    return rolled_off_surface(POINTS, LENGTH, 0.8, 6e-5, 2e-7, np.random.default_rng(3))


def test_waves_that_show_the_instrument_are_named(tmp_path, heights):
    found = described(tmp_path, blurred(heights)).isel(roller=1)
    assert found["hurst_exponent_lower"] <= 0.8 <= found["hurst_exponent_upper"]
    assert found["roll_off_wavelength"].item() == pytest.approx(6e-5, rel=0.2)
    assert found["resolved_wavelength"].item() == pytest.approx(8.4e-6, rel=0.1)
    assert found.attrs["remarks"].count("show the instrument and not the surface") == 2
    assert np.isnan(found["self_affine_density"]).all()  # no Hurst exponent to compare with


def test_a_band_that_the_instrument_resolves_needs_no_remark(tmp_path, heights):
    found = described(tmp_path, heights)
    assert found.attrs["remarks"] == "" and np.isnan(found["resolved_wavelength"]).all()


def test_spikes_are_counted(tmp_path, heights):
    spiked = heights.copy()
    spiked[[30, 200, 301], [77, 400, 511]] += 3e-6
    remarks = described(tmp_path, spiked).attrs["remarks"]
    assert "first roller: 3 points stick out of their neighbours, by up to 3" in remarks


def test_a_band_of_few_densities_has_no_fits(tmp_path, heights):
    found = described(tmp_path, heights, "190 um")
    assert np.isnan(found["hurst_exponent"]).all() and found.attrs["remarks"] == ""


def test_what_is_not_self_affine_is_said(tmp_path):
    smooth = rolled_off_surface(POINTS, LENGTH, 2.0, 6e-5, 2e-7, np.random.default_rng(3))
    remarks = described(tmp_path, smooth).attrs["remarks"]
    assert "is not between 0 and 1: it is not self-affine" in remarks
