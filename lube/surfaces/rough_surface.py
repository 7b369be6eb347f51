r"""The rough surface whose line the model uses.

The method of dimensionality reduction replaces a surface of the power spectrum :math:`C_{2D}` by a
line of :math:`C_{1D} = \pi q\, C_{2D}` (paper, section 2). Backwards, every spectrum of lines
belongs to one isotropic surface. Its waves have the line's distribution of wavenumbers, and run in
all directions:

.. math:: \langle z^2 \rangle = \int_0^\infty 2 \pi q\, C_{2D}(q)\, dq
          = \int_{-\infty}^\infty C_{1D}(q)\, dq

A surface with a lay is stretched along it, see `lube.surfaces.lay`.
"""

import functools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.fft

from lube.errors import DataError
from lube.surfaces.lay import extents, stretched, unstretched
from lube.surfaces.synthetic import LineSpecLike, amplitudes_across_lay
from lube.types import Array, Pair

POINTS_PER_WAVE = 5
"""Grid points in the shortest wavelength."""
LONGEST_WAVES = 4
"""Longest wavelengths along a side of the surface."""
POINTS_PER_CONTACT = 8
"""Grid points across the smallest contacts, unless a side then has more than `LARGE` points."""
LARGE, LARGEST = 4096, 8192
"""Most points along a side to which the grid is refined for small contacts, and most allowed."""
POINTS_FOR_WAVES = 2.5
"""Grid points in the shortest wavelength that are enough to have all waves."""
SIMILAR, DIRECTIONS = 1.08, 16
"""Classes of waves: ratio of the longest to the shortest wavelength in a class, and number of
directions. With far more of them the contacts that theory expects change by 0.2 %."""
UNRESOLVED = math.inf, math.inf
"""The smallest contacts do not matter."""


@dataclass(frozen=True)
class Surface:
    """The sum of both rollers' surfaces, on a periodic rectangle.

    Its rows lie along rolling, and follow one another along the rollers.

    Attributes
    ----------
    spacing : tuple of float
        Distance of neighbouring rows, and of neighbouring points in a row, m.
    points : tuple of int
        Rows M, and points N in a row.
    coarse : tuple of int
        Rows m, and points n in a row, of a coarser grid that has all waves, too.
    rms : float
        Rms height, height steps.
    first_part : numpy.ndarray
        Shape (m, n // 2 + 1), part of the variance of each wave that is the first roller's.
    variances : numpy.ndarray
        Shape (m, n // 2 + 1), variance of the heights by each wave, squared height steps.
    curvatures : numpy.ndarray
        Shape (m, n // 2 + 1), mean curvature of each wave over its height, 1/m^2.
    is_mirrored : bool
        Whether the surface is alike in both directions along the rollers; not if it has a lay at
        an angle.
    diagonal : int
        Direction of its ridges: 1 if along the rollers they run on in the direction of rolling, -1
        if against it, and 0 without such a lay.
    """

    spacing: tuple[float, float]
    points: tuple[int, int]
    coarse: tuple[int, int]
    rms: float
    first_part: Array
    variances: Array
    curvatures: Array
    is_mirrored: bool
    diagonal: int

    @property
    def sides(self) -> tuple[float, float]:
        """Lengths along the rollers and along rolling, m."""
        return self.points[0] * self.spacing[0], self.points[1] * self.spacing[1]

    def draw(self, generator: np.random.Generator) -> tuple[Array, Array, Array]:
        """Draw a realisation.

        Parameters
        ----------
        generator : numpy.random.Generator
            Source of randomness.

        Returns
        -------
        heights, curvatures : numpy.ndarray
            Shape (M, N) each, float32, height steps and height steps per square metre. The
            curvature is the mean of those in two directions, positive at summits.
        waves : numpy.ndarray
            Fourier coefficients of the heights, shape (m, n // 2 + 1), complex64.
        """
        waves = self._waves(generator, self.variances)
        curved = waves * self.curvatures.astype(np.float32)
        return field(waves, self.points), field(curved, self.points), waves

    def of_each(self, waves: Array, generator: np.random.Generator) -> list[Array]:
        """Divide drawn waves among the surfaces of both rollers.

        Parameters
        ----------
        waves : numpy.ndarray
            Waves from `draw`.
        generator : numpy.random.Generator
            Source of randomness.

        Returns
        -------
        list of numpy.ndarray
            Waves of the first and of the second surface, which are independent. Their sum is
            `waves`.
        """
        part = self.first_part
        # The first is the mean that the sum leaves to expect, and a part independent of the sum.
        independent = self._waves(generator, part * (1.0 - part) * self.variances)
        first = part.astype(np.float32) * waves + independent
        return [first, waves - first]

    def _waves(self, generator, variances):
        """Draw independent waves of these variances."""
        noise = generator.standard_normal(self.coarse, dtype=np.float32)
        return scipy.fft.rfft2(noise, norm="ortho") * np.sqrt(variances).astype(np.float32)

    def covariances(self, before: int, after: int, columns: int) -> Iterator[Array]:
        """Covariance of a height with heights and with curvatures around it.

        Parameters
        ----------
        before, after, columns : int
            Numbers of rows B before and A after that of the height, and number of columns C.

        Yields
        ------
        numpy.ndarray
            First the covariance with heights, then with curvatures: shape (B + 1 + A, 2 C - 1),
            float32, over the variance of the heights; at distances of -B .. A rows and of
            -(C - 1) .. C - 1 columns.
        """
        rows = np.arange(-before, after + 1)[:, None]
        for factor in (1.0, self.curvatures):
            around = field(self.variances * factor, self.points)
            yield (around[rows, np.arange(1 - columns, columns)] / self.rms**2).astype(np.float32)


def field(waves: Array, points: tuple[int, int]) -> Array:
    """Sum waves on a grid at least as fine as the coarsest that has them all.

    Parameters
    ----------
    waves : numpy.ndarray
        Fourier coefficients, shape (m, n // 2 + 1), as from `scipy.fft.rfft2` on m by n points with
        ``norm="forward"``; 0 at the shortest waves of an even number.
    points : tuple of int
        Rows M and points N in a row of the grid.

    Returns
    -------
    numpy.ndarray
        Shape (M, N).
    """
    half = (waves.shape[0] - 1) // 2
    rows = np.arange(-half, half + 1)
    # Columns without waves are not transformed.
    sums = np.zeros((points[0], waves.shape[1]), np.result_type(waves, np.complex64))
    sums[rows] = waves[rows]
    sums = scipy.fft.ifft(sums, axis=0, norm="forward", overwrite_x=True)
    return scipy.fft.irfft(sums, points[1], norm="forward", overwrite_x=True)


def longest_waves(spec: LineSpecLike) -> Pair:
    """Longest wavelengths of both rollers' surfaces along the rollers and along rolling, m."""
    waves = [
        np.multiply(line.longest_across_lay, extents(line.lay_ratio, line.lay_angle))
        for line in spec.lines
    ]
    along, across = np.max(waves, axis=0).tolist()
    return across, along


def shortest_waves(spec: LineSpecLike) -> Pair:
    """Shortest wavelengths of both rollers' surfaces along the rollers and along rolling, m."""
    # A cut through a ridge along one side, over its reach along the other.
    waves = []
    for line in spec.lines:
        reach = np.array(extents(line.lay_ratio, line.lay_angle))
        waves.append(line.shortest_wavelength * line.lay_ratio / reach)
    return tuple(np.min(waves, axis=0).tolist())


def surface_grid(
    spec: LineSpecLike, width: float, contact: Pair = UNRESOLVED, waves: int = LONGEST_WAVES
) -> tuple[Pair, Pair]:
    """Choose the grid of a surface.

    Parameters
    ----------
    spec, width, contact, waves
        As in `rough_surface`.

    Returns
    -------
    sides, spacing : tuple of float
        Least lengths of the sides, and distances of neighbouring points, along the rollers and
        along rolling, m.

    Raises
    ------
    DataError
        If the band of wavelengths is too wide for the grid.
    """
    sides, spacings = [], []
    of_sides = zip(longest_waves(spec), shortest_waves(spec), contact, strict=True)
    for longest, shortest, own in of_sides:
        side, spacing = max(waves * longest, width + longest), shortest / POINTS_PER_WAVE
        spacing = min(spacing, max(own / POINTS_PER_CONTACT, side / LARGE))
        times = side / spacing / LARGEST
        if times > 1.0:
            lay = ", or shorter ridges" * any(line.lay_ratio > 1.0 for line in spec.lines)
            # The side decreases with the longest wave, unless the contact is far wider than it.
            most = min(side / times / waves, side / times - width) / longest
            own = max(line.longest_across_lay for line in spec.lines)
            given = min(line.shortest_wavelength for line in spec.lines)
            # Rounded down, so that the length does.
            shorter = f", or a longest of {995.0 * most * own:.3g} mm" if most > 0.1 else ""
            raise DataError(
                f"roughness: got a shortest wavelength of {1e6 * given:.3g} µm, too short for a "
                f"surface of {1e3 * side:.3g} mm, need one {times:.3g} times as long{lay}{shorter}"
            )
        sides.append(side)
        spacings.append(spacing)
    return tuple(sides), tuple(spacings)


@functools.lru_cache(maxsize=1)
def rough_surface(
    spec: LineSpecLike,
    width: float = 0.0,
    contact: Pair = UNRESOLVED,
    waves: int = LONGEST_WAVES,
    multiple: int = 1,
) -> Surface:
    """Find the surface that a pair of lines stands for.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    width : float, optional
        Contact width, m; the surface is wider by a longest wavelength at least.
    contact : tuple of float, optional
        Lengths of the smallest contacts along the rollers and along rolling, m.
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
        If the band of wavelengths is too wide for the grid.
    """
    sides, spacing = surface_grid(spec, width, contact, waves)
    points = tuple(
        multiple * scipy.fft.next_fast_len(math.ceil(side / one / multiple), real=True)
        for side, one in zip(sides, spacing, strict=True)
    )
    sides = [number * one for number, one in zip(points, spacing, strict=True)]
    coarse = tuple(
        scipy.fft.next_fast_len(math.ceil(POINTS_FOR_WAVES * side / shortest), real=True)
        for side, shortest in zip(sides, shortest_waves(spec), strict=True)
    )
    steps = [2.0 * np.pi / side for side in sides]
    down = steps[0] * np.fft.fftfreq(coarse[0], 1.0 / coarse[0])[:, None]
    along = steps[1] * np.arange(coarse[1] // 2 + 1)
    # The first column holds a wave and its mirror image.
    number = np.full((coarse[0], along.size), 2)
    number[:, 0] = 1
    first, second = (_variances(spec, roller, steps, (down, along), number) for roller in range(2))
    variances = first + second
    rms = math.sqrt(np.sum(variances * number))
    first = first / np.where(variances > 0.0, variances, 1.0)
    curvatures = 0.5 * (along**2 + down**2)
    is_mirrored = all(line.lay_angle % 90.0 == 0.0 or line.lay_ratio == 1.0 for line in spec.lines)
    mixed = 0.0 if is_mirrored else np.sum(variances * number * along * down)
    diagonal = -int(np.sign(mixed))
    return Surface(
        spacing, points, coarse, rms, first, variances, curvatures, is_mirrored, diagonal
    )


def _variances(spec, roller, steps, waves, number):
    """Variance of the heights of one roller's surface by each wave, squared height steps.

    The variance of the line's waves is divided among the surface's waves of the same length, in
    shells of a width at which none is empty.
    """
    line, (down, along) = spec.lines[roller], waves
    lay = line.lay_ratio, line.lay_angle
    step = max(unstretched(steps[1], 0.0, *lay), unstretched(0.0, steps[0], *lay))
    shell = np.rint(unstretched(along, down, *lay) / step).astype(np.int64)
    power = _power(spec, roller, step, shell.max() + 1)
    return (power / np.bincount(shell.ravel(), number.ravel()))[shell]


@functools.lru_cache(maxsize=2)
def surface_waves(spec: LineSpecLike, roller: int) -> tuple[Array, Array, Array]:
    """Waves of one roller's surface, in classes of similar wavelengths and directions.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    roller : int
        0 for the first roller, 1 for the second.

    Returns
    -------
    along, across : numpy.ndarray
        Wavenumbers along rolling, not below zero, and along the rollers, rad/m, shape (waves,).
    power : numpy.ndarray
        Mean square height of each class, m^2, shape (waves,).
    """
    line = spec.lines[roller]
    first, amplitudes = amplitudes_across_lay(spec, roller)
    number = np.arange(first, first + amplitudes.size)
    power = 0.5 * amplitudes**2
    classes = (np.log(number / first) / np.log(SIMILAR)).astype(np.int64)
    powers = np.bincount(classes, power)
    some = powers > 0.0
    number = np.sqrt(np.bincount(classes, power * number**2)[some] / powers[some])
    wavenumber = spec.wave_step(roller) * number[:, None]
    psi = np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    along, across = stretched(wavenumber, psi, line.lay_ratio, line.lay_angle)
    sign, power = np.where(along < 0.0, -1.0, 1.0), np.broadcast_to(powers[some, None], along.shape)
    return (sign * along).ravel(), (sign * across).ravel(), power.ravel() / DIRECTIONS


def _power(spec, roller, step, shells):
    """Variance of a line's waves in each shell of wavenumbers, squared height steps."""
    first, amplitudes = amplitudes_across_lay(spec, roller)
    own_step = spec.wave_step(roller)
    shell = np.rint(own_step / step * np.arange(first, first + amplitudes.size)).astype(np.int64)
    return np.bincount(shell, 0.5 * (amplitudes / spec.height_step) ** 2, minlength=shells)
