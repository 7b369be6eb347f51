"""Roughness lines: periodic, self-affine, and the same wherever and whenever they are drawn.

A line is a sum of waves with fixed amplitudes, set by the power spectrum C1D ~ q^(-2H - 1)
between q_min and q_max, and random phases. Fixed amplitudes make the rms height of every
line exactly that of the roller (up to the rounding to height steps); with random amplitudes
it would be so on average only. The paper does not say which it used.
"""

import functools

import numpy as np
import scipy.fft

from lube.kernels.synthesis import random_phasors, whole_steps

ROLLERS = (1, 2)


def wave_amplitudes(spec, roller):
    """Amplitudes of the waves around one roller (paper, section 2).

    Parameters
    ----------
    spec : LineSpec
        What determines the lines.
    roller : int
        0 for the first roller, 1 for the second.

    Returns
    -------
    first_wave : int
        Number of waves around the circumference that the first amplitude belongs to.
    amplitudes : numpy.ndarray
        Shape (modes,), m; half the sum of their squares is the mean square height.
    """
    perimeter = spec.points[roller] * spec.spacing
    turn = perimeter / (2.0 * np.pi)
    # Limits that fall on a whole number of waves belong to the band in spite of rounding.
    first_wave = int(np.ceil(spec.q_min * turn * (1.0 - 1e-9)))
    last_wave = int(np.floor(spec.q_max * turn * (1.0 + 1e-9)))
    # A wave of two points is no wave: its height on the grid would hang on its phase.
    last_wave = min(last_wave, (spec.points[roller] - 1) // 2)
    waves = np.arange(first_wave, last_wave + 1)
    shape = (waves / first_wave) ** (-spec.hurst_exponent - 0.5)
    rms = np.sqrt(0.5 * np.sum(shape**2))
    return first_wave, spec.rms_height[roller] / rms * shape


@functools.lru_cache(maxsize=4)
def _spectrum(spec, roller):
    """Amplitudes as an inverse real FFT wants them, in height steps, single precision."""
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    points = spec.points[roller]
    scaled = 0.5 * points / spec.height_step * amplitudes
    return first_wave, scaled.astype(np.float32)


def draw_line(spec, roller, seed):
    """Draw one roughness line.

    Parameters
    ----------
    spec : LineSpec
        What determines the lines.
    roller : int
        0 for the first roller, 1 for the second.
    seed : numpy.random.SeedSequence
        Seed of this line alone.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32: heights in steps of `spec.height_step`, positive towards the
        other roller.
    """
    first_wave, amplitudes = _spectrum(spec, roller)
    points = spec.points[roller]
    waves = np.zeros(points // 2 + 1, np.complex64)
    directions = random_phasors(np.random.default_rng(seed), amplitudes.size)
    np.multiply(amplitudes, directions, out=waves[first_wave : first_wave + amplitudes.size])
    return whole_steps(scipy.fft.irfft(waves, points, overwrite_x=True))


def draw_realisation(spec, seed, realisation):
    """Draw the two independent lines of one realisation.

    Parameters
    ----------
    spec : LineSpec
        What determines the lines.
    seed : int
        Seed of the study.
    realisation : int
        Number of the realisation; it alone, with the seed, decides what is drawn.

    Returns
    -------
    tuple of numpy.ndarray
        The lines of the first and second roller, shapes (N1,) and (N2,), int32 steps.
    """
    children = np.random.SeedSequence((seed, realisation)).spawn(len(ROLLERS))
    return tuple(draw_line(spec, roller, child) for roller, child in enumerate(children))


def line_moments(line, spacing):
    """Moments of one periodic line.

    Slope and curvature are differences of neighbouring points, as the contact sees them.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), m.
    spacing : float
        Distance dx of neighbouring points, m.

    Returns
    -------
    dict of str to float
        ``rms_height`` (m), ``rms_slope``, ``rms_curvature`` (1/m), ``skewness``, ``kurtosis``
        (3 for a Gaussian line).
    """
    before = np.roll(line, 1)
    slope = (line - before) / spacing
    curvature = (np.roll(slope, -1) - slope) / spacing
    variance = np.mean(line**2)
    return {
        "rms_height": np.sqrt(variance),
        "rms_slope": np.sqrt(np.mean(slope**2)),
        "rms_curvature": np.sqrt(np.mean(curvature**2)),
        "skewness": np.mean(line**3) / variance**1.5,
        "kurtosis": np.mean(line**4) / variance**2,
    }


def power_spectrum(line, spacing):
    """One-sided power spectral density of a periodic line.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), m.
    spacing : float
        Distance dx of neighbouring points, m.

    Returns
    -------
    wave_vector : numpy.ndarray
        Shape (N // 2,), rad/m.
    density : numpy.ndarray
        Shape (N // 2,), m^3; its integral over the wave vector is the mean square height.
    """
    step = 2.0 * np.pi / (line.size * spacing)
    power = 2.0 * np.abs(scipy.fft.rfft(line)[1:] / line.size) ** 2
    if line.size % 2 == 0:
        power[-1] /= 2.0  # the wave of two points stands for itself, all others for a pair
    return step * np.arange(1, power.size + 1), power / step


def spectrum_moments(spec, roller):
    """Moments that the spectrum promises for the same differences of neighbouring points.

    A wave of wave vector q loses the factor (2 sin(q dx / 2) / dx)^2 q^-2 of its mean square
    slope to the difference over dx, and its square for the curvature.

    Parameters
    ----------
    spec : LineSpec
        What determines the lines.
    roller : int
        0 for the first roller, 1 for the second.

    Returns
    -------
    dict of str to float
        ``rms_height`` (m), ``rms_slope``, ``rms_curvature`` (1/m).
    """
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    waves = np.arange(first_wave, first_wave + amplitudes.size)
    difference = 2.0 * np.sin(np.pi * waves / spec.points[roller]) / spec.spacing
    names = ("rms_height", "rms_slope", "rms_curvature")
    return {
        name: np.sqrt(0.5 * np.sum(amplitudes**2 * difference ** (2 * order)))
        for order, name in enumerate(names)
    }


def line_attributes(spec):
    """Global attributes of a roughness file: the spectrum and the height step.

    Parameters
    ----------
    spec : LineSpec
        What determines the lines.

    Returns
    -------
    dict
        Attribute names and values; lengths in m, wave vectors in rad/m.
    """
    return {
        "hurst": spec.hurst_exponent,
        "q_min": spec.q_min,
        "q_max": spec.q_max,
        "rms": np.array(spec.rms_height),
        "spacing": spec.spacing,
        "points": np.array(spec.points),
        "height_step": spec.height_step,
    }
