r"""A measured profile as the line around a roller, without drawing another.

The line is the profile's Fourier series at the points of the roller: smooth between the measured
points, where a piecewise linear line would have kinks that break the boundary layer. Waves shorter
than the study's shortest are left out. Two cases:

- The profile covers the circumference, so its ends meet; it is prepared as a closed one. Its
  length is made the circumference, from which it may differ by 1 %.
- The profile is repeated, a whole number of times around the roller, as few as its length allows.
  Its ends do not meet. Its first part is used as the repeat, and a surplus of `FADED` times the
  repeat is kept. At the beginning of the repeat the surplus is faded out and the beginning is
  faded in, by weights :math:`\cos` and :math:`\sin` of a quarter turn, which keep the mean square
  of independent heights. The line is then scaled to the rms height of the profile.
"""

import math

import numpy as np
import scipy.fft

from lube.errors import DataError
from lube.surfaces.topography import Topography, step_at_join
from lube.types import Array

FADED = 0.02
"""Length over which the ends of a repeated profile are joined, over the length of the repeat."""

CLOSED_TO = 0.01
"""Largest relative difference between the length of a closed profile and the circumference."""


def closed_line(
    profile: Topography, points: int, point_spacing: float, shortest: float, height_step: float
) -> Array:
    """Turn a profile that covers the circumference into the line around a roller.

    Parameters
    ----------
    profile : Topography
        Closed profile, as `lube.surfaces.topography.prepare` returns it: one turn, the last point
        one spacing before the first.
    points : int
        Points N around the roller.
    point_spacing : float
        Their distance, m.
    shortest : float
        Shortest wavelength of the study, m.
    height_step : float
        Height of one step of the whole-number heights, m.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32: heights in height steps, of the profile's rms height except for the waves
        left out.

    Raises
    ------
    DataError
        If the surface is a map, or its length is not the circumference, or its ends do not meet,
        or its points are too few for the shortest wavelength.

    Examples
    --------
    >>> turn = Topography("turn", 1e-6 * np.sin(2 * np.pi * np.arange(100) / 20), (1e-6,))
    >>> closed_line(turn, 50, 2e-6, 5e-6, 1e-9)[:6].tolist()
    [0, 588, 951, 951, 588, 0]
    """
    _check(profile, shortest)
    length, needed = profile.lengths[0], points * point_spacing
    if abs(length - needed) > CLOSED_TO * needed:
        raise DataError(
            f"{profile.name}: got a profile of {1e3 * length:.4g} mm, need the "
            f"circumference, {1e3 * needed:.4g} mm, to {CLOSED_TO:.0%}"
        )
    if step := step_at_join(profile.heights):
        raise DataError(
            f"{profile.name}: got a step of {1e6 * abs(step):.3g} µm from the last point to the "
            "first, need one turn whose ends meet, prepared as a closed profile"
        )
    return _resampled(profile.heights, points, point_spacing, shortest, height_step)


def repeated_line(
    profile: Topography, points: int, point_spacing: float, shortest: float, height_step: float
) -> Array:
    """Turn a profile into a line that repeats it around a roller without a step.

    Parameters
    ----------
    profile : Topography
        As `lube.surfaces.topography.prepare` returns it.
    points, point_spacing, shortest, height_step
        As in `closed_line`.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32: heights in height steps, of the profile's rms height except for the waves
        left out.

    Raises
    ------
    DataError
        If the surface is a map, or its points are too few for the shortest wavelength.

    Examples
    --------
    >>> profile = Topography("a", 1e-6 * np.sin(np.arange(2000) / 5), (1e-6,))
    >>> line = repeated_line(profile, 2850, 2e-6, 1e-5, 1e-9)  # three times around the roller
    >>> f"{np.std(line) * 1e-9:.2e}", np.array_equal(line[:950], line[950:1900])
    ('7.07e-07', True)
    """
    _check(profile, shortest)
    turn = points * point_spacing / profile.spacing[0]
    repeats = math.ceil(turn * (1.0 + FADED) / profile.heights.size)
    count = round(turn / repeats)
    faded = min(round(FADED * count), profile.heights.size - count)
    line = profile.heights[:count].copy()
    rms = np.std(line)
    angle = 0.5 * np.pi * (np.arange(faded) + 0.5) / faded
    line[:faded] *= np.sin(angle)
    line[:faded] += np.cos(angle) * profile.heights[count : count + faded]
    line -= line.mean()
    line *= rms / np.std(line)
    return _resampled(line, points, point_spacing, shortest, height_step, repeats)


def _check(profile, shortest):
    if profile.heights.ndim != 1:
        raise DataError(f"{profile.name}: got a map, need a profile to use it directly")
    finest = max(2.0 * profile.spacing[0], profile.resolution)
    if finest > shortest * (1.0 + 1e-9):
        raise DataError(
            f"{profile.name}: got waves down to {1e6 * finest:.3g} µm, need waves down to "
            f"{1e6 * shortest:.3g} µm, the shortest wavelength of the study"
        )


def _resampled(heights, points, point_spacing, shortest, height_step, repeats=1):
    """Evaluate the Fourier series of a profile, repeated, at the points of a roller."""
    spectrum = scipy.fft.rfft(heights, norm="forward")
    last_wave = min(int(points * point_spacing / shortest * (1.0 + 1e-9)), (points - 1) // 2)
    kept = min(last_wave // repeats, (heights.size - 1) // 2) + 1
    waves = np.zeros(points // 2 + 1, complex)
    waves[repeats : repeats * kept : repeats] = spectrum[1:kept]
    line = scipy.fft.irfft(waves, points, norm="forward") / height_step
    return np.rint(line.astype(np.float32)).astype(np.int32)
