r"""The isotropic rough surface whose line the model uses.

The method of dimensionality reduction replaces a surface of the power spectrum :math:`C_{2D}` by a
line of :math:`C_{1D} = \pi q\, C_{2D}` (paper, section 2). Backwards, every spectrum of lines
belongs to one isotropic surface. Its waves have the line's distribution of wavenumbers, and run in
all directions:

.. math:: \langle z^2 \rangle = \int_0^\infty 2 \pi q\, C_{2D}(q)\, dq
          = \int_{-\infty}^\infty C_{1D}(q)\, dq
"""

import functools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.fft

from lube.errors import DataError
from lube.surfaces.synthetic import ROLLER_NUMBERS, LineSpecLike, wave_amplitudes
from lube.types import Array

POINTS_PER_WAVE = 5
"""Grid points in the shortest wavelength."""
LONGEST_WAVES = 4
"""Longest wavelengths along a side of the surface."""
POINTS_PER_CONTACT = 6
"""Grid points across the smallest contacts, unless a side then has more than `LARGE` points."""
LARGE, LARGEST = 4096, 8192
"""Most points along a side to which the grid is refined for small contacts, and most allowed."""


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
    first_part : numpy.ndarray
        Part of the variance that is the first roller's, by the number of waves along a side,
        rounded to 0, 1, 2, ...
    variances : numpy.ndarray
        Shape (M, M // 2 + 1), variance of the heights by each wave, squared height steps.
    curvatures : numpy.ndarray
        Shape (M, M // 2 + 1), mean curvature of each wave over its height, 1/m^2.
    """

    spacing: float
    points: int
    rms: float
    first_part: Array
    variances: Array
    curvatures: Array

    @property
    def side(self) -> float:
        """Length of a side, m."""
        return self.points * self.spacing

    def draw(self, generator: np.random.Generator, coarser: int = 1) -> tuple[Array, Array, Array]:
        """Draw a realisation.

        Parameters
        ----------
        generator : numpy.random.Generator
            Source of randomness.
        coarser : int, optional
            Points along a side of a coarser grid, on which the long waves are wanted too.

        Returns
        -------
        heights, curvatures : numpy.ndarray
            Shape (M, M) each, float32, height steps and height steps per square metre. The
            curvature is the mean of those in two directions, positive at summits.
        long_waves : numpy.ndarray
            Fourier coefficients of the heights on the coarser grid, as from `scipy.fft.rfft2`.
        """
        noise = generator.standard_normal((self.points, self.points), dtype=np.float32)
        waves = scipy.fft.rfft2(noise)
        waves *= self.points * np.sqrt(self.variances).astype(np.float32)
        shape = noise.shape
        heights, long_waves = scipy.fft.irfft2(waves, shape), on_coarser_grid(waves, coarser)
        waves *= self.curvatures.astype(np.float32)
        return heights, scipy.fft.irfft2(waves, shape, overwrite_x=True), long_waves

    def of_each(self, waves: Array, generator: np.random.Generator) -> list[Array]:
        """Divide drawn waves among the surfaces of both rollers.

        Parameters
        ----------
        waves : numpy.ndarray
            Long waves from `draw`.
        generator : numpy.random.Generator
            Source of randomness.

        Returns
        -------
        list of numpy.ndarray
            Waves of the first and of the second surface, which are independent. Their sum is
            `waves`.
        """
        points = waves.shape[0]
        variances = on_coarser_grid(self.variances, points) * (self.points / points) ** 2
        numbers = np.fft.fftfreq(points, 1.0 / points)[:, None], np.arange(points // 2 + 1)
        part = self.first_part[np.rint(np.hypot(*numbers)).astype(np.int64)]
        # The first is the mean that the sum leaves to expect, and a part independent of the sum.
        noise = scipy.fft.rfft2(generator.standard_normal((points, points), dtype=np.float32))
        noise *= points * np.sqrt(part * (1.0 - part) * variances).astype(np.float32)
        first = part.astype(np.float32) * waves + noise
        return [first, waves - first]

    def covariances(self, rows: int, columns: int) -> Iterator[Array]:
        """Covariance of a height with heights and with curvatures around it.

        Parameters
        ----------
        rows, columns : int
            Numbers of distances R + 1 and C.

        Yields
        ------
        numpy.ndarray
            First the covariance with heights, then with curvatures: shape (R + 1, 2 C - 1),
            float32, over the variance of the heights; at distances of 0 .. R rows and of
            -(C - 1) .. C - 1 columns.
        """
        shape = (self.points, self.points)
        for factor in (1.0, self.curvatures):
            quarter = scipy.fft.irfft2(self.variances * factor, shape, norm="forward")
            quarter = quarter[:rows, :columns] / self.rms**2
            yield np.hstack([quarter[:, :0:-1], quarter]).astype(np.float32)


def on_coarser_grid(waves: Array, points: int) -> Array:
    """Fourier coefficients of the same surface on a coarser grid, without waves too short for it.

    Parameters
    ----------
    waves : numpy.ndarray
        Coefficients as from `scipy.fft.rfft2`, shape (M, M // 2 + 1).
    points : int
        Points along a side of the coarser grid, at most M.

    Returns
    -------
    numpy.ndarray
        Coefficients, shape (points, points // 2 + 1).
    """
    coarser = np.zeros((points, points // 2 + 1), waves.dtype)
    half = (points - 1) // 2
    scale = (points / waves.shape[0]) ** 2
    rows = np.arange(-half, half + 1)
    coarser[rows, : half + 1] = scale * waves[rows, : half + 1]
    return coarser


def surface_grid(
    spec: LineSpecLike, width: float, contact: float = math.inf, waves: int = LONGEST_WAVES
) -> tuple[float, float]:
    """Choose the grid of a surface.

    Parameters
    ----------
    spec, width, contact, waves
        As in `isotropic_surface`.

    Returns
    -------
    side, spacing : float
        Least length of a side, and distance of neighbouring points, m.

    Raises
    ------
    DataError
        If the band of wavelengths is too wide for a square grid.
    """
    longest, shortest = spec.longest_wavelength, 2.0 * np.pi / spec.q_max
    side, spacing = max(waves * longest, width + longest), shortest / POINTS_PER_WAVE
    spacing = min(spacing, max(contact / POINTS_PER_CONTACT, side / LARGE))
    times = side / spacing / LARGEST
    if times > 1.0:
        raise DataError(
            f"roughness: got a shortest wavelength of {shortest:.3g} m, too short for a surface of "
            f"{side:.3g} m, need one {times:.3g} times as long"
        )
    return side, spacing


@functools.lru_cache(maxsize=1)
def isotropic_surface(
    spec: LineSpecLike,
    width: float = 0.0,
    contact: float = math.inf,
    waves: int = LONGEST_WAVES,
    multiple: int = 1,
) -> Surface:
    """Find the isotropic surface that a pair of lines stands for.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    width : float, optional
        Contact width, m; the surface is wider by a longest wavelength at least.
    contact : float, optional
        Length of the smallest contacts, m.
    waves : int, optional
        Least number of longest wavelengths along a side.
    multiple : int, optional
        The number of points along a side is a multiple of this.

    Returns
    -------
    Surface
        The sum of both rollers' surfaces.

    Raises
    ------
    DataError
        If the band of wavelengths is too wide for a square grid.
    """
    side, spacing = surface_grid(spec, width, contact, waves)
    least = side / spacing
    points = multiple * scipy.fft.next_fast_len(math.ceil(least / multiple), real=True)
    waves = np.hypot(np.fft.fftfreq(points, 1.0 / points)[:, None], np.arange(points // 2 + 1))
    step = 2.0 * np.pi / (points * spacing)
    # The variance of the lines' waves is divided among the surface's waves of the same length.
    shell = np.rint(waves).astype(np.int64)
    powers = [_power(spec, roller, step, shell.max() + 1) for roller in range(len(ROLLER_NUMBERS))]
    power = powers[0] + powers[1]
    # The first column, and the last of an even number, hold a wave and its mirror image.
    number = np.full(waves.shape, 2)
    number[:, 0] = 1
    number[:, -1] -= 1 - points % 2
    number = np.bincount(shell.ravel(), number.ravel())
    variances = (power / number)[shell]
    first_part = powers[0] / np.where(power > 0.0, power, 1.0)
    curvatures = 0.5 * (step * waves) ** 2
    return Surface(spacing, points, np.sqrt(power.sum()), first_part, variances, curvatures)


def _power(spec, roller, step, shells):
    """Variance of a line's waves in each shell of wavenumbers, squared height steps."""
    first, amplitudes = wave_amplitudes(spec, roller)
    own_step = 2.0 * np.pi / (spec.points[roller] * spec.spacing)
    shell = np.rint(own_step / step * np.arange(first, first + amplitudes.size)).astype(np.int64)
    return np.bincount(shell, 0.5 * (amplitudes / spec.height_step) ** 2, minlength=shells)
