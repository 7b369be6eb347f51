"""The surface stage: measured topographies by their spectra, roll-offs and heights."""

from collections.abc import Mapping

import numpy as np
import scipy.special
import xarray as xr

from lube.schema import label, values_with_limits
from lube.study.line_spec import LineSpec
from lube.study.roller_topography import RollerTopography
from lube.study.rollers import ROLLERS as NAMES
from lube.study.topography_lines import preparation, prepared
from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.spectrum_table import LineSpectrum
from lube.surfaces.surface_statistics import height_distribution, hurst_exponent, roll_off
from lube.surfaces.synthetic import ROLLERS

STANDARD_HEIGHTS = np.linspace(-6.0, 6.0, 61)
"""Middles of the bins of heights, in rms heights."""

_UNKNOWN = (np.nan, np.nan, np.nan)


def measured_surfaces(
    topographies: Mapping[str, RollerTopography], spec: LineSpec, hurst: float
) -> xr.Dataset:
    """Describe the measured topographies of a study.

    Parameters
    ----------
    topographies : dict of str to RollerTopography
        By roller; `Study.topographies` of a study.
    spec : LineSpec
        Parameters of the lines; `Study.line_spec` of a study.
    hurst : float
        Hurst exponent of the study's section `roughness`, for comparison.

    Returns
    -------
    xarray.Dataset
        The ``surface`` file of `lube.schema`.

    Raises
    ------
    DataError
        If a file cannot be read.
    """
    # Both rollers may have the same one.
    distinct = {topography.key: topography for topography in topographies.values()}
    described = {key: _described(topography) for key, topography in distinct.items()}
    parts = [
        _surface(topography, described[topography.key], spec.lines[NAMES.index(name)], hurst)
        for name, topography in topographies.items()
    ]
    rollers = [ROLLERS[NAMES.index(name)] for name in topographies]
    waves = max(part.sizes["wave"] for part in parts)
    parts = [part.pad(wave=(0, waves - part.sizes["wave"])) for part in parts]
    table = xr.concat(parts, "roller", join="exact")
    coordinates = {
        "roller": np.asarray(rollers, np.int64),
        "wave": np.arange(waves),
        "standard_height": STANDARD_HEIGHTS,
    }
    return label(table.assign_coords(coordinates), "surface")


def _described(topography):
    """Spectrum of a topography, density of its heights, and its numbers with their limits."""
    surface = prepared(topography)
    spectrum = line_spectrum(surface, preparation(topography))
    bend = roll_off(spectrum)
    longest = 2.0 * np.pi / spectrum.wave_vector[0] if bend is None else bend.value
    shortest = 2.0 * np.pi / spectrum.wave_vector[-1]
    numbers = values_with_limits("roll_off_wavelength", bend or _UNKNOWN)
    numbers |= values_with_limits("hurst_exponent", hurst_exponent(spectrum, longest, shortest))
    for name, estimate in height_distribution(surface.heights).items():
        numbers |= values_with_limits(name, estimate)
    return spectrum, _histogram(surface.heights), numbers


def _surface(topography, described, line, hurst):
    spectrum, height_density, numbers = described
    table = {
        "wave_vector": ("wave", spectrum.wave_vector),
        "filter_transfer": ("wave", spectrum.transfer),
        "self_affine_density": ("wave", _self_affine(spectrum.wave_vector, line, hurst)),
        "height_density": ("standard_height", height_density),
        "line_rms_height": line.rms_height,
        **values_with_limits("density", _density(spectrum)),
    }
    words = {"texture": topography.texture, "use": topography.use}
    return xr.Dataset(table | numbers | words)


def _density(spectrum: LineSpectrum):
    """Density with its limits: a mean of exponentially distributed powers has a gamma one."""
    count = spectrum.estimates
    for share in (None, 0.975, 0.025):
        factor = 1.0 if share is None else count / scipy.special.gammaincinv(count, share)
        yield "wave", spectrum.density * factor


def _self_affine(wave_vector, line, hurst):
    """Density of the self-affine line of the same band and rms height, else NaN."""
    exponent = -2.0 * hurst
    whole = (line.q_min**exponent - line.q_max**exponent) / -exponent
    inside = (line.q_min <= wave_vector) & (wave_vector <= line.q_max)
    density = line.rms_height**2 / whole * wave_vector ** (exponent - 1.0)
    return np.where(inside, density, np.nan)


def _histogram(heights):
    """Density of the heights over the rms height."""
    step = STANDARD_HEIGHTS[1] - STANDARD_HEIGHTS[0]
    edges = np.append(STANDARD_HEIGHTS - step / 2.0, STANDARD_HEIGHTS[-1] + step / 2.0)
    centred = heights - heights.mean()
    return np.histogram(centred / np.std(centred), edges)[0] / (heights.size * step)
