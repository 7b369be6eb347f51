"""The surface stage: measured topographies by their spectra, roll-offs and heights."""

from collections.abc import Mapping

import numpy as np
import scipy.special
import xarray as xr

from lube.schema import label, values_with_limits
from lube.study.line_spec import LineSpec
from lube.study.roller_topography import RollerTopography
from lube.study.rollers import ROLLERS
from lube.study.study import Study
from lube.study.topography_lines import preparation, prepared
from lube.surfaces import surface_statistics as statistics
from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.synthetic import ROLLER_NUMBERS
from lube.types import Datasets
from lube.units import with_unit

STANDARD_HEIGHTS = np.linspace(-6.0, 6.0, 61)
"""Middles of the bins of heights, in rms heights."""

_UNKNOWN = (np.nan, np.nan, np.nan)


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``surface.nc``; see `lube.stages`."""
    return measured_surfaces(study.topographies, study.line_spec, study.roughness.hurst_exponent)


def measured_surfaces(
    topographies: Mapping[str, RollerTopography], spec: LineSpec, hurst: float | None
) -> xr.Dataset:
    """Describe the measured topographies of a study.

    Parameters
    ----------
    topographies : dict of str to RollerTopography
        By roller; `Study.topographies` of a study.
    spec : LineSpec
        Parameters of the lines; `Study.line_spec` of a study.
    hurst : float or None
        Hurst exponent of the study's section `roughness`, for comparison.

    Returns
    -------
    xarray.Dataset
        The ``surface`` file of `lube.schema`. Its attribute ``remarks`` names waves that show the
        instrument, spikes, and surfaces that are not self-affine.

    Raises
    ------
    DataError
        If a file cannot be read.
    """
    parts, remarks, known = [], [], {}
    for name, topography in topographies.items():
        line = spec.lines[ROLLERS.index(name)]
        # Both rollers may have the same topography.
        key = topography.key, line.q_min, line.q_max, line.rms_height
        if key not in known:
            surface = _surface(topography, line, hurst)
            known[key] = surface, [*_remarks(surface, line), *_spikes(topography)]
        surface, texts = known[key]
        parts.append(surface)
        remarks += [f"{name} roller: {text}" for text in texts]
    rollers = [ROLLER_NUMBERS[ROLLERS.index(name)] for name in topographies]
    # Spectra have different numbers of waves; NaN stands for the missing ones.
    table = xr.concat(parts, xr.Variable("roller", rollers), join="outer")
    return label(table.assign_attrs(remarks="\n".join(remarks)), "surface")


def _surface(topography, line, hurst):
    """Describe the surface of a roller; fits use the waves in the band of its line."""
    surface = prepared(topography)
    spectrum = line_spectrum(surface, preparation(topography))
    longest = line.longest_across_lay
    waves = statistics.waves_of_surface(spectrum, longest, line.shortest_wavelength)
    bend = statistics.roll_off(spectrum, waves)
    shorter = waves if bend is None else waves._replace(longest=bend.value)
    exponent = statistics.hurst_exponent(spectrum, shorter)
    table = {
        "wave_vector": ("wave", spectrum.wave_vector),
        "filter_transfer": ("wave", spectrum.transfer),
        "self_affine_density": ("wave", _self_affine(spectrum.wave_vector, line, hurst)),
        "height_density": ("standard_height", _histogram(surface.heights)),
        "line_rms_height": line.rms_height,
        "resolved_wavelength": waves.resolution,
        "texture": topography.texture,
        "lay_ratio": spectrum.lay_ratio,
        "lay_angle": spectrum.lay_angle if spectrum.lay_ratio > 1.0 else np.nan,
        "use": topography.use,
        **values_with_limits("density", _density(spectrum), "wave"),
        **values_with_limits("roll_off_wavelength", bend or _UNKNOWN),
        **values_with_limits("hurst_exponent", exponent or _UNKNOWN),
    }
    for name, estimate in statistics.height_distribution(surface.heights).items():
        table |= values_with_limits(name, estimate)
    levels = {"wave": np.arange(spectrum.wave_vector.size), "standard_height": STANDARD_HEIGHTS}
    return xr.Dataset(table, levels)


def _remarks(surface, line):
    """Yield remarks on the limits of the measurement and of the fits."""
    resolved, shortest = surface["resolved_wavelength"].item(), line.shortest_wavelength
    if resolved > shortest:
        yield (
            f"waves shorter than {with_unit(resolved, 'm', 2)} show the instrument and not the "
            f"surface, and the line has waves down to {with_unit(shortest, 'm', 2)}: set a "
            f"shortest_wavelength above {with_unit(resolved, 'm', 2)}"
        )
    hurst = surface["hurst_exponent"].item()
    if hurst <= 0.0 or hurst >= 1.0:
        yield f"its Hurst exponent, {hurst:.2g}, is not between 0 and 1: it is not self-affine"


def _spikes(topography):
    """Yield a remark on spikes, which are sought before waves are taken out."""
    as_measured = topography.model_copy(update={"long_cutoff": None, "short_cutoff": None})
    found = statistics.spikes(prepared(as_measured).heights)
    if found.size:
        yield (
            f"{found.size} points stick out of their neighbours, by up to "
            f"{with_unit(found.max(), 'm', 2)}: if they are spikes of the instrument, they count "
            "as short waves; make them holes, and set holes: interpolate"
        )


def _density(spectrum):
    """Density with its limits: a mean of exponentially distributed powers is gamma distributed."""
    count = spectrum.estimates
    limits = (count / scipy.special.gammaincinv(count, share) for share in (0.975, 0.025))
    return (spectrum.density * factor for factor in (1.0, *limits))


def _self_affine(wave_vector, line, hurst):
    """Density of the self-affine line of the same band and rms height, else NaN."""
    if hurst is None:
        return np.full_like(wave_vector, np.nan)
    exponent = -2.0 * hurst
    whole = (line.q_min**exponent - line.q_max**exponent) / -exponent
    inside = (line.q_min <= wave_vector) & (wave_vector <= line.q_max)
    density = line.rms_height**2 / whole * wave_vector ** (exponent - 1.0)
    return np.where(inside, density, np.nan)


def _histogram(heights):
    """Probability density of the heights over the rms height, at `STANDARD_HEIGHTS`."""
    step = STANDARD_HEIGHTS[1] - STANDARD_HEIGHTS[0]
    edges = np.append(STANDARD_HEIGHTS - step / 2.0, STANDARD_HEIGHTS[-1] + step / 2.0)
    centred = heights - heights.mean()
    return np.histogram(centred / np.std(centred), edges)[0] / (heights.size * step)
