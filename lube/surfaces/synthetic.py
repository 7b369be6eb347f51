r"""Roughness lines drawn from a power spectrum: periodic, self-affine and reproducible.

A line is a sum of waves with random phases :math:`\varphi_k` and fixed amplitudes :math:`a_k`, set
by the power spectrum (paper, section 2):

.. math::

    z(x) = \sum_k a_k \cos(q_k x + \varphi_k), \qquad
    a_k^2 \propto C_{1D}(q_k) \propto q_k^{-2H - 1}, \qquad
    q_{min} \le q_k = \frac{2 \pi k}{N \Delta x} \le q_{max}

With fixed amplitudes the rms height of every line is exactly that of the roller, up to the
rounding to height steps; with random amplitudes it would be that of the roller in expectation
only. The paper does not say which of the two it uses.

Lines whose skewness or kurtosis is not that of Gaussian heights are translations of such a line,
see `lube.surfaces.translation`.
"""

import functools
from typing import Any, Protocol

import numpy as np
import scipy.fft

from lube.kernels.synthesis import gaussian_phasors, random_phasors, translated_steps
from lube.surfaces.lay import waves_of_line
from lube.surfaces.translation import REACH, gaussian_power, johnson_curve
from lube.types import Array, Pair

ROLLER_NUMBERS = (1, 2)
"""Labels of the two rollers in files."""


class LineSpecLike(Protocol):
    """Parameters of a pair of roughness lines, such as `lube.study.line_spec.LineSpec`; hashable.

    Attributes
    ----------
    lines : tuple
        Parameters of either line, such as `lube.study.line_spec.RoughLine`.
    points : tuple of int
        Points N around each roller.
    longest_wavelength, shortest_wavelength : float
        Longest and shortest wavelength of both lines, m.
    spacing : float
        Distance dx of neighbouring points, m.
    height_step : float
        Height step, m.
    """

    lines: tuple[Any, Any]
    points: tuple[int, int]
    longest_wavelength: float
    shortest_wavelength: float
    spacing: float
    height_step: float

    def wave_step(self, roller: int) -> float:
        """Wavenumber of a wave as long as the perimeter of a roller, 0 or 1, rad/m."""


def wave_amplitudes(spec: LineSpecLike, roller: int) -> tuple[int, Array]:
    r"""Amplitudes of the waves around one roller (paper, section 2).

    .. math::

        a_k \propto q_k^{-H - 1/2}, \qquad \frac12 \sum_k a_k^2 = h_{rms}^2

    Below the roll-off wavenumber the isotropic surface's density :math:`C_{2D}` is constant, so
    that :math:`C_{1D} = \pi q\, C_{2D}` and :math:`a_k \propto q_k^{1/2}`. With a measured spectrum
    :math:`a_k \propto C(q_k)^{1/2}`. The amplitudes of a measured line follow from its heights.
    If the surface has a lay, this is the spectrum across it, and `lube.surfaces.lay` explains that
    of the line.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    roller : int
        0 for the first roller, 1 for the second.

    Returns
    -------
    first_wave : int
        Number of waves around the circumference for the first amplitude; the others follow in
        steps of one.
    amplitudes : numpy.ndarray
        Shape (modes,), m.

    Examples
    --------
    >>> from lube.stages import LineSpec, RoughLine
    >>> band = {"q_min": 2 * np.pi / 1e-4, "q_max": 2 * np.pi / 1e-5}
    >>> line = RoughLine(points=1000, rms_height=2e-7, hurst_exponent=0.7, **band)
    >>> spec = LineSpec(lines=(line, line), spacing=1e-6, height_step=1e-12)
    >>> first_wave, amplitudes = wave_amplitudes(spec, 0)
    >>> first_wave, amplitudes.size
    (10, 91)
    >>> f"{np.sqrt(0.5 * np.sum(amplitudes**2)):.3g}"
    '2e-07'
    """
    first_wave, amplitudes = amplitudes_across_lay(spec, roller)
    ratio = spec.lines[roller].lay_ratio
    if ratio == 1.0:
        return first_wave, amplitudes
    first_wave, squares = waves_of_line(first_wave, amplitudes**2, ratio)
    return first_wave, np.sqrt(squares)


def amplitudes_across_lay(spec: LineSpecLike, roller: int) -> tuple[int, Array]:
    """Amplitudes of the waves across the lay of one roller's surface, as from `wave_amplitudes`.

    Without a lay they are those of the line.
    """
    line = spec.lines[roller]
    # Leave out the wave of two points: its rms height on the grid would depend on its phase.
    last_wave = (line.points - 1) // 2
    if line.heights is not None:
        waves = scipy.fft.rfft(_measured_steps(line) * spec.height_step, norm="forward")
        return 1, 2.0 * np.abs(waves[1 : last_wave + 1])
    turn = line.points * spec.spacing / (2.0 * np.pi)
    # A limit that is a whole number of waves belongs to the band, despite rounding.
    first_wave = int(np.ceil(line.q_min * turn * (1.0 - 1e-9)))
    last_wave = min(int(np.floor(line.q_max * turn * (1.0 + 1e-9))), last_wave)
    waves = np.arange(first_wave, last_wave + 1)
    if line.spectrum is None:
        shape = _self_affine(line, waves, turn)
    else:  # the measured density is a power law between its values
        known, density = np.log(line.spectrum)
        shape = np.exp(0.5 * np.interp(np.log(waves / turn), known, density))
    rms = np.sqrt(0.5 * np.sum(shape**2))
    return first_wave, line.rms_height / rms * shape


def _self_affine(line, waves, turn):
    """Amplitudes relative to that of the first wave if there were no roll-off."""
    shape = (waves / waves[0]) ** (-line.hurst_exponent - 0.5)
    roll_off = line.q_roll_off * turn
    below = waves < roll_off * (1.0 - 1e-9)
    shape[below] = (roll_off / waves[0]) ** (-line.hurst_exponent - 0.5)
    shape[below] *= np.sqrt(waves[below] / roll_off)
    return shape


def _measured_steps(line):
    return np.frombuffer(line.heights, np.int32)


@functools.lru_cache(maxsize=4)
def _spectrum(spec, roller):
    """Amplitudes scaled for the inverse real FFT, in height steps, single precision."""
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    scaled = 0.5 * spec.points[roller] / spec.height_step * amplitudes
    return first_wave, scaled.astype(np.float32)


@functools.lru_cache(maxsize=32)
def _translation(spec, roller):
    """Spectrum, as from `_spectrum` but of rms one, of the line to translate, and the curve."""
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    line = spec.lines[roller]
    curve = johnson_curve(line.skewness, line.kurtosis)
    power = gaussian_power(amplitudes**2, first_wave, line.points, curve)
    scaled = 0.5 * line.points * np.sqrt(2.0 * power)
    return (first_wave, scaled.astype(np.float32)), curve


def draw_line(spec: LineSpecLike, roller: int, seed: np.random.SeedSequence) -> Array:
    """Draw one roughness line, or return the measured one.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    roller : int
        0 for the first roller, 1 for the second.
    seed : numpy.random.SeedSequence
        Seed of this line.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32: heights in height steps, positive towards the other roller.
    """
    generator, line = np.random.default_rng(seed), spec.lines[roller]
    if line.heights is not None:
        return _measured_steps(line)
    if line.is_gaussian:
        heights = _superposition(_spectrum(spec, roller), line.points, random_phasors, generator)
        return np.rint(heights).astype(np.int32)
    same = spec.lines.index(line)  # the first of two equal rollers
    spectrum, curve = _translation(spec, same)
    gaussian = _superposition(spectrum, line.points, random_phasors, generator)
    return translated_steps(gaussian, curve, REACH, line.rms_height / spec.height_step)


def draw_gaussian_line(spec: LineSpecLike, roller: int, generator: np.random.Generator) -> Array:
    """Draw one line with random amplitudes, which is exactly Gaussian.

    Parameters
    ----------
    spec, roller
        As in `draw_line`.
    generator : numpy.random.Generator
        Source of randomness.

    Returns
    -------
    numpy.ndarray
        Shape (N,), float32: heights in height steps, not rounded. Their rms is that of the
        roller in expectation only.
    """
    return _superposition(_spectrum(spec, roller), spec.points[roller], gaussian_phasors, generator)


def _superposition(spectrum, points, phasors, generator):
    """Sum of the waves, each times a random complex number."""
    first_wave, amplitudes = spectrum
    waves = np.zeros(points // 2 + 1, np.complex64)
    band = waves[first_wave : first_wave + amplitudes.size]
    np.multiply(amplitudes, phasors(generator, amplitudes.size), out=band)
    return scipy.fft.irfft(waves, points, overwrite_x=True)


def draw_realisation(spec: LineSpecLike, seed: int, realisation: int) -> Pair:
    """Draw the two independent lines of one realisation.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    seed : int
        Seed of the study.
    realisation : int
        Number of the realisation. The lines depend on it and the seed only, not on the batch
        or the order in which they are drawn.

    Returns
    -------
    tuple of numpy.ndarray
        Lines of the first and the second roller, shapes (N1,) and (N2,), int32 height steps.

    Examples
    --------
    >>> from lube.stages import LineSpec, RoughLine
    >>> band = {"q_min": 2 * np.pi / 1e-4, "q_max": 2 * np.pi / 1e-5}
    >>> one = RoughLine(points=1000, rms_height=2e-7, hurst_exponent=0.7, **band)
    >>> other = RoughLine(points=800, rms_height=1e-7, hurst_exponent=0.8, **band)
    >>> spec = LineSpec(lines=(one, other), spacing=1e-6, height_step=1e-12)
    >>> [f"{line.size}: {np.std(line) * 1e-12:.3g}" for line in draw_realisation(spec, 1, 0)]
    ['1000: 2e-07', '800: 1e-07']
    """
    children = np.random.SeedSequence((seed, realisation)).spawn(len(ROLLER_NUMBERS))
    return tuple(draw_line(spec, roller, child) for roller, child in enumerate(children))
