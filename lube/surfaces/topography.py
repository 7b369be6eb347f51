r"""A measured topography: profile or map, without form, tilt and holes, and filtered as stated.

Heights are in metres, on an even grid. A hole, where the instrument measured nothing, is NaN.

The Gaussian filters are those of ISO 16610-21 (profiles, and maps along rolling) and of
ISO 16610-61 (isotropic maps; it is separable in both directions). Their weighting function and
their transmission of a wave of length :math:`\lambda` are

.. math::

    s(x) = \frac{1}{\alpha \lambda_c} e^{-\pi (x / \alpha \lambda_c)^2}, \qquad
    T(\lambda) = e^{-\pi (\alpha \lambda_c / \lambda)^2}, \qquad
    \alpha = \sqrt{\ln 2 / \pi}

so half the amplitude passes at the cutoff. Near the edges the weights are divided by their sum
over the measured length.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.fft

from lube.errors import DataError
from lube.types import Array

FORMS = ("none", "tilt", "curvature")
"""What is removed: the mean, a straight line or plane, or a polynomial of the second order."""

MOST_HOLES = 0.05
"""Largest fraction of points in holes that are interpolated. The heights filled in are smoother
than measured ones: at most this fraction of the mean square height is lost, and half as much of
the rms height."""

USUAL_STEPS = 3.0
"""If the step from the last point of a closed profile to the first exceeds this many times the rms
step between neighbours, the ends do not meet."""

LEAST_POINTS = 64
"""Fewest points of a profile, or along either side of a map."""

_ALPHA = math.sqrt(math.log(2.0) / math.pi)
_ROWS = 256  # filtered at a time, to save memory


@dataclass(frozen=True, eq=False)
class Topography:
    """Heights of a profile or a map, on an even grid.

    Attributes
    ----------
    name : str
        File or other name, for messages.
    heights : numpy.ndarray
        Shape (n,) or (nx, ny), m, positive outwards; NaN in holes.
    spacing : tuple of float
        Distance of neighbouring points in each direction, m.
    resolution : float
        Shortest wavelength that the instrument resolves, m; 0 if unknown.
    """

    name: str
    heights: Array
    spacing: tuple[float, ...]
    resolution: float = 0.0

    @property
    def lengths(self) -> tuple[float, ...]:
        """Measured length in each direction, m."""
        sides = zip(self.heights.shape, self.spacing, strict=True)
        return tuple(points * spacing for points, spacing in sides)


@dataclass(frozen=True)
class Preparation:
    """What is done to a topography before its spectrum is computed.

    Attributes
    ----------
    texture : str
        ``isotropic``: the surface is the same in all directions; or ``along rolling``: only its
        profiles along rolling are used.
    form : str
        One of `FORMS`.
    long_cutoff : float or None
        Cutoff of the Gaussian filter that removes long waves, m.
    short_cutoff : float or None
        Cutoff of the Gaussian filter that removes short waves, m.
    holes : str
        ``refuse`` or ``interpolate``.
    rolling : str
        Direction of rolling on a map, ``x`` or ``y``.
    closed : bool
        Whether a profile is one turn around the circumference. Its ends meet: instead of a tilt
        the step between them is removed as the instrument's drift, and the filters go on across
        the join.
    """

    texture: str
    form: str = "tilt"
    long_cutoff: float | None = None
    short_cutoff: float | None = None
    holes: str = "refuse"
    rolling: str = "x"
    closed: bool = False

    def __post_init__(self):
        if self.closed and self.form == "curvature":
            raise DataError("form: got 'curvature', need none or tilt for a closed profile")


def prepare(topography: Topography, settings: Preparation) -> Topography:
    """Turn a topography to the direction of rolling, remove form and holes, and filter it.

    Parameters
    ----------
    topography : Topography
        As measured.
    settings : Preparation
        What is to be done.

    Returns
    -------
    Topography
        Its first direction is along rolling; it has no holes and a mean of about zero.

    Raises
    ------
    DataError
        If the topography has holes although none are allowed, too many holes or too few points, if
        a map is to be closed, or if a cutoff does not suit the topography.

    Examples
    --------
    >>> x = np.arange(1000) * 1e-6
    >>> profile = Topography("a", 1e-6 * np.sin(x / 1e-5) + 0.01 * x, (1e-6,))
    >>> f"{np.std(prepare(profile, Preparation('isotropic')).heights):.1e}"
    '7.1e-07'
    """
    if topography.heights.ndim == 2 and settings.rolling == "y":
        # Turned, not mirrored: rolling is along y, and the rollers' axis against x.
        heights, spacing = topography.heights[::-1].T, topography.spacing[::-1]
        topography = replace(topography, heights=heights, spacing=spacing)
    _check_points(topography, settings)
    _check_cutoffs(topography, settings)
    form = "none" if settings.closed else settings.form
    heights = fill_holes(remove_form(topography.heights, form))
    if settings.closed and settings.form == "tilt":
        # The drift is a straight line.
        heights = heights + step_at_join(heights) * np.linspace(-0.5, 0.5, heights.size)
    spacing = used_directions(topography.spacing, settings)
    filtered = gaussian_filter(
        heights, spacing, settings.long_cutoff, settings.short_cutoff, settings.closed
    )
    return replace(topography, heights=filtered)


def used_directions(sides: tuple[float, ...], settings: Preparation) -> tuple[float, ...]:
    """Return the sides of a map that are used: if it is taken along rolling, only the first.

    Examples
    --------
    >>> used_directions((1e-3, 2e-3), Preparation("along rolling"))
    (0.001,)
    """
    return sides[:1] if settings.texture == "along rolling" else sides


def _check_points(topography, settings):
    name, heights = topography.name, topography.heights
    if min(heights.shape) < LEAST_POINTS:
        raise DataError(f"{name}: got {heights.shape} points, need {LEAST_POINTS} or more a side")
    if settings.closed and heights.ndim == 2:
        raise DataError(f"{name}: got a map, need a profile if it is closed")
    holes = np.count_nonzero(~np.isfinite(heights)) / heights.size
    if holes > 0.0 and settings.holes == "refuse":
        raise DataError(
            f"{name}: got holes, {holes:.2%} of the points, need no holes or `holes: interpolate`"
        )
    if holes > MOST_HOLES:
        raise DataError(f"{name}: got {holes:.2%} of holes, need at most {MOST_HOLES:.0%}")


def _check_cutoffs(topography, settings):
    name = topography.name
    longest = min(used_directions(topography.lengths, settings))
    finest = max(used_directions(topography.spacing, settings))
    long_cutoff, short_cutoff = settings.long_cutoff, settings.short_cutoff
    if long_cutoff is not None and not 4.0 * finest <= long_cutoff <= longest:
        raise DataError(
            f"{name}: got a cutoff of long waves of {long_cutoff:.3g} m, need {4 * finest:.3g} to "
            f"{longest:.3g} m, four spacings to the measured length"
        )
    below = long_cutoff or longest
    if short_cutoff is not None and not 2.0 * finest <= short_cutoff < below:
        raise DataError(
            f"{name}: got a cutoff of short waves of {short_cutoff:.3g} m, need "
            f"{2 * finest:.3g} m, two spacings, or more, and less than {below:.3g} m"
        )


def remove_form(heights: Array, form: str) -> Array:
    r"""Subtract the polynomial that fits the measured points best, by least squares.

    For a map :math:`z(x, y)` the tilt has the terms :math:`1, x, y`, and the curvature also
    :math:`x^2, x y, y^2`.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,) or (nx, ny); NaN in holes.
    form : str
        One of `FORMS`.

    Returns
    -------
    numpy.ndarray
        Same shape, of mean zero over the measured points.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 5)
    >>> remove_form(1.0 + 2.0 * x + 3.0 * x**2, "curvature").round(12) + 0.0
    array([0., 0., 0., 0., 0.])
    """
    order = FORMS.index(form)
    columns = heights.reshape(len(heights), -1)
    orders = (order, order if heights.ndim == 2 else 0)
    places = (np.linspace(-1.0, 1.0, points) for points in columns.shape)
    along, across = map(np.polynomial.legendre.legvander, places, orders)
    measured = np.isfinite(columns)
    terms = [(a, b) for a in range(orders[0] + 1) for b in range(orders[1] + 1) if a + b <= order]
    first, second = np.array(terms).T
    # By einsum, as sums of BLAS have other last bits with another number of threads.
    sums = np.einsum("xa,xy->ay", along, np.where(measured, columns, 0.0))
    right = np.einsum("ay,yb->ab", sums, across)[first, second]
    # Sums over the measured points of the products of any two terms.
    of_rows, of_columns = (each[:, :, None] * each[:, None, :] for each in (along, across))
    normal = np.einsum("iab,icd->abcd", of_rows, np.einsum("xy,ycd->xcd", measured, of_columns))
    matrix = normal[first[:, None], first[None, :], second[:, None], second[None, :]]
    coefficients = np.zeros((orders[0] + 1, orders[1] + 1))
    coefficients[first, second] = np.linalg.lstsq(matrix, right, rcond=None)[0]
    fitted = np.einsum("xa,ya->xy", along, np.einsum("ab,yb->ya", coefficients, across))
    return (columns - fitted).reshape(heights.shape)


def step_at_join(heights: Array) -> float:
    """Step from the last to the first point of a closed profile, zero if it is a usual one.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,), m.

    Returns
    -------
    float
        The step, m; zero up to `USUAL_STEPS` times the rms step between neighbours.

    Examples
    --------
    >>> turn = np.sin(2 * np.pi * np.arange(100) / 100)
    >>> float(step_at_join(turn)), float(step_at_join(turn + np.arange(100))) < -98
    (0.0, True)
    """
    step, usual = heights[0] - heights[-1], np.sqrt(np.mean(np.diff(heights) ** 2))
    return step if abs(step) > USUAL_STEPS * usual else 0.0


def fill_holes(heights: Array) -> Array:
    """Interpolate holes by the smoothest surface between the points around them.

    The heights filled in solve the discrete Laplace equation; on a profile they lie on straight
    lines. At the edges they are level.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,) or (nx, ny); NaN in holes.

    Returns
    -------
    numpy.ndarray
        Same shape, without NaN.

    Examples
    --------
    >>> fill_holes(np.array([0.0, np.nan, np.nan, 3.0])).round(12)
    array([0., 1., 2., 3.])
    """
    holes = ~np.isfinite(heights)
    if not holes.any():
        return heights
    # Imported on first use: it takes two seconds.
    from SurfaceTopography import Topography, UniformLineScan

    kind = UniformLineScan if heights.ndim == 1 else Topography
    surface = kind(np.ma.masked_array(heights, holes), heights.shape)
    return np.asarray(surface.interpolate_undefined_data().heights())


def gaussian_filter(
    heights: Array,
    spacing: tuple[float, ...],
    long_cutoff: float | None,
    short_cutoff: float | None,
    closed: bool = False,
) -> Array:
    """Filter heights by the Gaussian filters of ISO 16610-21 and -61.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,) or (nx, ny).
    spacing : tuple of float
        Distance of neighbouring points in each direction, m; with the first only, a map is filtered
        along it alone.
    long_cutoff, short_cutoff : float or None
        Cutoffs of long and of short waves, m; with None that filter is not applied.
    closed : bool, optional
        Whether the last point is followed by the first.

    Returns
    -------
    numpy.ndarray
        Same shape.

    Examples
    --------
    >>> wave = np.cos(2 * np.pi * np.arange(4000) / 100)
    >>> f"{gaussian_filter(wave, (1.0,), 100.0, None)[1950:2050].max():.3f}"
    '0.500'
    """
    if short_cutoff is not None:
        heights = _smoothed(heights, spacing, short_cutoff, closed)
    if long_cutoff is not None:
        heights = heights - _smoothed(heights, spacing, long_cutoff, closed)
    return heights


def power_transfer(
    wave_vector: Array, long_cutoff: float | None, short_cutoff: float | None
) -> Array:
    """Fraction of a wave's power that passes the Gaussian filters.

    Parameters
    ----------
    wave_vector : numpy.ndarray
        Shape (n,), rad/m.
    long_cutoff, short_cutoff : float or None
        As in `gaussian_filter`.

    Returns
    -------
    numpy.ndarray
        Shape (n,), between 0 and 1.

    Examples
    --------
    >>> power_transfer(2 * np.pi / np.array([1e-3, 1e-4]), 1e-3, None).round(3)
    array([0.25, 1.  ])
    """
    passed = np.ones_like(wave_vector)
    if short_cutoff is not None:
        passed = passed * _transmission(wave_vector, short_cutoff)
    if long_cutoff is not None:
        passed = passed * -np.expm1(-np.log(2.0) * (long_cutoff * wave_vector / (2 * np.pi)) ** 2)
    return passed**2


def _transmission(wave_vector, cutoff):
    """Fraction of a wave's amplitude that a smoothing Gaussian filter passes."""
    return np.exp(-np.pi * (_ALPHA * cutoff * wave_vector / (2.0 * np.pi)) ** 2)


def _smoothed(heights, spacing, cutoff, closed):
    """Weighted means over the points around each point."""
    smooth = np.array(heights, float, order="C")
    columns = smooth.reshape(len(smooth), -1)
    for lines, step in zip((columns.T, columns), spacing, strict=False):
        _smooth_lines(lines, step, cutoff, closed)
    return smooth


def _smooth_lines(lines, step, cutoff, closed):
    """Smooth lines in place, shape (m, n), by Fourier transforms padded with zeros."""
    points = lines.shape[-1]
    # At one cutoff from the centre the weight is 7e-7 of the largest.
    padded = scipy.fft.next_fast_len(points + math.ceil(cutoff / step), real=True)
    padded = points if closed else padded
    passed = _transmission(2.0 * np.pi * scipy.fft.rfftfreq(padded, step), cutoff)

    def smooth(part):
        spectrum = scipy.fft.rfft(part, padded)
        return scipy.fft.irfft(spectrum * passed, padded, overwrite_x=True)[..., :points]

    weights = smooth(np.ones(points))
    for begin in range(0, len(lines), _ROWS):
        part = lines[begin : begin + _ROWS]
        part[...] = smooth(part) / weights
