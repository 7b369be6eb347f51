r"""The isotropic rough surface whose line the model uses.

The method of dimensionality reduction replaces a surface of the power spectrum :math:`C_{2D}` by a
line of :math:`C_{1D} = \pi q\, C_{2D}` (paper, section 2). Backwards, every spectrum of lines
belongs to one isotropic surface. Its waves have the line's distribution of wavenumbers, and run in
all directions:

.. math:: \langle z^2 \rangle = \int_0^\infty 2 \pi q\, C_{2D}(q)\, dq
          = \int_{-\infty}^\infty C_{1D}(q)\, dq
"""

import functools
from dataclasses import dataclass

import numpy as np
import scipy.fft

from lube.errors import DataError
from lube.surfaces.synthetic import ROLLERS, LineSpecLike, wave_amplitudes
from lube.types import Array, Pair

POINTS_PER_WAVE = 5
"""Grid points in the shortest wavelength."""
LONGEST_WAVES = 3
"""Longest wavelengths along a side of the surface."""
LARGEST = 8192
"""Largest number of points along a side."""


@dataclass(frozen=True)
class Surface:
    """The sum of both rollers' isotropic surfaces, on a periodic square.

    Attributes
    ----------
    spacing : float
        Distance of neighbouring points, m.
    points : int
        Points M along a side.
    rms : float
        Rms height, height steps.
    variances : numpy.ndarray
        Shape (M, M // 2 + 1), variance of the heights by each wave, squared height steps.
    curvatures : numpy.ndarray
        Shape (M, M // 2 + 1), mean curvature of each wave over its height, 1/m^2.
    """

    spacing: float
    points: int
    rms: float
    variances: Array
    curvatures: Array

    def draw(self, generator: np.random.Generator) -> Pair:
        """Draw a realisation.

        Parameters
        ----------
        generator : numpy.random.Generator
            Source of randomness.

        Returns
        -------
        heights, curvatures : numpy.ndarray
            Shape (M, M) each, float32, height steps and height steps per square metre. The
            curvature is the mean of those in two directions, positive at summits.
        """
        noise = generator.standard_normal((self.points, self.points), dtype=np.float32)
        waves = scipy.fft.rfft2(noise)
        waves *= self.points * np.sqrt(self.variances).astype(np.float32)
        shape = noise.shape
        heights = scipy.fft.irfft2(waves, shape)
        waves *= self.curvatures.astype(np.float32)
        return heights, scipy.fft.irfft2(waves, shape, overwrite_x=True)

    def covariances(self, rows: int, columns: int) -> Pair:
        """Covariance of a height with heights and with curvatures around it.

        Parameters
        ----------
        rows, columns : int
            Numbers of distances R + 1 and C.

        Returns
        -------
        tuple of numpy.ndarray
            Shape (R + 1, 2 C - 1) each, float32, over the variance of the heights; at distances
            of 0 .. R rows and of -(C - 1) .. C - 1 columns.
        """
        shape = (self.points, self.points)
        for factor in (1.0, self.curvatures):
            quarter = scipy.fft.irfft2(self.variances * factor, shape, norm="forward")
            quarter = quarter[:rows, :columns] / self.rms**2
            yield np.hstack([quarter[:, :0:-1], quarter]).astype(np.float32)


@functools.lru_cache(maxsize=1)
def isotropic_surface(spec: LineSpecLike) -> Surface:
    """Find the isotropic surface that a pair of lines stands for.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.

    Returns
    -------
    Surface
        The sum of both rollers' surfaces.

    Raises
    ------
    DataError
        If the band of wavelengths is too wide for a square grid.
    """
    spacing = 2.0 * np.pi / spec.q_max / POINTS_PER_WAVE
    least = LONGEST_WAVES * 2.0 * np.pi / spec.q_min / spacing
    if least > LARGEST:
        raise DataError(
            f"roughness: got a longest wavelength {spec.q_max / spec.q_min:.0f} times the "
            f"shortest, need at most {LARGEST / LONGEST_WAVES / POINTS_PER_WAVE:.0f} for a surface"
        )
    points = scipy.fft.next_fast_len(int(np.ceil(least)), real=True)
    step = 2.0 * np.pi / (points * spacing)
    waves = np.fft.fftfreq(points, 1.0 / points)[:, None], np.arange(points // 2 + 1)
    wavenumber = step * np.hypot(*waves)
    density = sum(line_density(spec, roller, wavenumber) for roller in range(len(ROLLERS)))
    with np.errstate(divide="ignore", invalid="ignore"):
        variances = np.where(density > 0.0, density / (2.0 * np.pi * wavenumber), 0.0)
    # All waves but the first and, of an even number, the last column stand for their mirror image.
    mirrored = np.full(points // 2 + 1, 2.0)
    mirrored[0] = 1.0
    mirrored[-1] = 2.0 if points % 2 else 1.0
    variance = sum(rms**2 for rms in spec.rms_height) / spec.height_step**2
    variances *= variance / np.sum(variances * mirrored)
    return Surface(spacing, points, np.sqrt(variance), variances, 0.5 * wavenumber**2)


def line_density(spec: LineSpecLike, roller: int, wavenumber: Array) -> Array:
    r"""One-sided power spectral density of a line at any wavenumber.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    roller : int
        0 for the first roller, 1 for the second.
    wavenumber : numpy.ndarray
        rad/m, any shape.

    Returns
    -------
    numpy.ndarray
        m^3, zero outside the band.
    """
    first, amplitudes = wave_amplitudes(spec, roller)
    step = 2.0 * np.pi / (spec.points[roller] * spec.spacing)
    known = step * np.arange(first, first + amplitudes.size)
    return np.interp(wavenumber, known, amplitudes**2 / (2.0 * step), left=0.0, right=0.0)
