"""From a roller's topography to its roughness line: reading, spectrum and heights."""

import dataclasses
import functools
import os

import numpy as np

from lube.digits import six_digits
from lube.study.roller_topography import RollerTopography
from lube.study.topography_files import read_topography
from lube.surfaces.measured_line import closed_line, repeated_line
from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.spectrum_table import LineSpectrum, band_table, power_law_integral
from lube.surfaces.topography import Preparation, Topography, prepare


def preparation(settings: RollerTopography) -> Preparation:
    """State what is done to a topography before it is used."""
    names = {field.name for field in dataclasses.fields(Preparation)}
    return Preparation(**settings.model_dump(include=names), closed=settings.use == "closed line")


def prepared(settings: RollerTopography) -> Topography:
    """Read a roller's topography, and remove form, holes and waves as the study says.

    Parameters
    ----------
    settings : RollerTopography
        From the study.

    Returns
    -------
    Topography
        Along rolling first.

    Raises
    ------
    DataError
        If the file cannot be read, or does not suit the settings.
    """
    return prepare(read_topography(settings.file), preparation(settings))


def measured(settings: RollerTopography, known: dict | None) -> LineSpectrum | Topography:
    """Read what a study needs of a topography: its spectrum, or the profile that is the line.

    Parameters
    ----------
    settings : RollerTopography
        From the study.
    known : dict or None
        From `RollerTopography.reading`, if the spectrum was read before.

    Returns
    -------
    LineSpectrum or Topography
        The spectrum or the profile.

    Raises
    ------
    DataError
        As `prepared`, or if the surface has no such spectrum.
    """
    if known is not None:
        arrays = ("wave_vector", "density", "estimates", "transfer")
        return LineSpectrum(**(known | {name: np.array(known[name]) for name in arrays}))
    time = os.stat(settings.file).st_mtime_ns if os.path.exists(settings.file) else None
    return _read(settings.file, preparation(settings), settings.is_line, time)


@functools.lru_cache(maxsize=2)
def _read(file, preparation, is_line, _time):
    """Read a topography once for both rollers, and again when the file has changed."""
    surface = prepare(read_topography(file), preparation)
    return surface if is_line else line_spectrum(surface, preparation)


def table(
    spectrum: LineSpectrum, band: tuple[float, float]
) -> tuple[float, tuple[tuple[float, ...], tuple[float, ...]]]:
    """Tabulate a spectrum within a band, for drawing lines.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum.
    band : tuple of float
        Longest and shortest wavelength, m.

    Returns
    -------
    rms_height : float
        Rms height of the waves in the band, m.
    table : tuple
        Wave vectors, rad/m, and densities, m^3.

    Raises
    ------
    DataError
        If the spectrum does not cover the band.
    """
    limits = (2.0 * np.pi / wave for wave in band)
    wave_vector, density = map(six_digits, band_table(spectrum, *limits))
    rms = six_digits(power_law_integral(wave_vector, density) ** 0.5)
    return rms.item(), (tuple(wave_vector.tolist()), tuple(density.tolist()))


@functools.lru_cache(maxsize=4)
def measured_line(
    use: str, profile: Topography, points: int, spacing: float, shortest: float, height_step: float
) -> tuple[float, bytes]:
    """Turn a profile into the line around a roller.

    Parameters
    ----------
    use : str
        ``closed line`` or ``repeated line``.
    profile : Topography
        From `prepared`.
    points : int
        Points around the roller.
    spacing, shortest : float
        Distance of the points, and shortest wavelength, m.
    height_step : float
        Height of one step of the whole-number heights, m.

    Returns
    -------
    rms_height : float
        Rms height of the line, m.
    heights : bytes
        As in `lube.study.line_spec.RoughLine`.

    Raises
    ------
    DataError
        If the profile cannot be such a line.
    """
    line = closed_line if use == "closed line" else repeated_line
    steps = line(profile, points, spacing, shortest, height_step)
    return float(np.std(steps)) * height_step, steps.tobytes()
