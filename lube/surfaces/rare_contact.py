r"""Contact of Gaussian lines at any rarity, by importance sampling.

An ensemble sees no contact that is rarer than one in its number of windows. Here every window
touches: one of its points is chosen and raised above the film, with the probability and the height
that it would have there by itself, and the rest of the window follows as the Gaussian line through
that point. With the film
:math:`h_j` at the points of the window, the rms height :math:`\sigma` of the sum of both lines and
the Gaussian tail Q,

.. math:: P = \sum_j Q(h_j / \sigma) \; \left\langle \frac{X}{n} \right\rangle ,

where n counts the points of a window that touch, and X is one if the window counts: always for
geometric contact, and for breakthrough if the boundary layer breaks on a segment. The estimate has
no bias at any rarity, and its relative error hardly depends on the rarity.

The amplitudes of the lines are random, so that the lines are exactly Gaussian. Lines of another
skewness or kurtosis are refused: their tail is not Gaussian.

References
----------
R. J. Adler, J. H. Blanchet and J. Liu, Efficient Monte Carlo for high excursions of Gaussian
random fields, Ann. Appl. Probab. 22 (2012) 1167-1214.
"""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.special

from lube.errors import StudyError
from lube.kernels.shaped import Surface
from lube.kernels.tail import touching_runs, touching_windows
from lube.kernels.uneven_tail import answered_windows, touching_runs_under
from lube.surfaces.spectra import autocovariance
from lube.surfaces.synthetic import ROLLER_NUMBERS, LineSpecLike, draw_gaussian_line
from lube.types import Array, Pair, Values

WINDOWS = 800
"""Windows along each pair of lines."""
RUNS = 400
"""Runs along each pair of lines."""
FOLLOWED = 60
"""Most of these runs that are followed through an uneven window."""
LOOKS = 64
"""Number of moments at which such a run is looked at, in pure rolling."""
RUN_NUMBERS = 10
"""Number of sums over runs that `rare_contact` returns."""
NEGLIGIBLE = 1e-9
"""Points are left out where contact is less likely than this, relative to the likeliest point."""
_NO_ANSWERS = np.zeros((0, 0))


@functools.lru_cache(maxsize=4)
def sum_of_lines(spec: LineSpecLike, lags: int) -> tuple[float, Pair]:
    """Compute the second moments of the sum of both lines.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    lags : int
        Number of distances.

    Returns
    -------
    rms : float
        Rms height, height steps.
    covariances : tuple of numpy.ndarray
        Autocovariance of each line over the variance of the sum, for distances of 0, 1, ...
        points.
    """
    lines = [autocovariance(spec, roller, lags) for roller in range(len(ROLLER_NUMBERS))]
    variance = lines[0][0] + lines[1][0]
    return np.sqrt(variance), tuple(line / variance for line in lines)


def check_gaussian(
    spec: LineSpecLike, why: str = "importance sampling is for Gaussian lines"
) -> None:
    """Refuse lines whose heights are not Gaussian.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    why : str, optional
        What needs such lines, for the message.

    Raises
    ------
    StudyError
        If a line is measured, or its skewness is not 0 or its kurtosis not 3.
    """
    for line in spec.lines:
        if line.heights is not None:
            raise StudyError(
                f"rollers: got a measured line, need lines drawn from a spectrum: {why}"
            )
        if not line.is_gaussian:
            raise StudyError(
                f"roughness: got a skewness of {line.skewness:g} and a kurtosis of "
                f"{line.kurtosis:g}, need 0 and 3: {why}"
            )


def check_stands_for_surface(spec: LineSpecLike) -> None:
    """Refuse lines that do not stand for a Gaussian surface.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.

    Raises
    ------
    StudyError
        As from `check_gaussian`, or if a line was measured along rolling.
    """
    check_gaussian(spec, "the surfaces that lines stand for are Gaussian")
    if not all(line.isotropic for line in spec.lines):
        raise StudyError(
            "rollers: got a topography taken along rolling, need an isotropic one or one with a "
            "lay: profiles along rolling do not say how long the ridges are"
        )


def draw_pair(spec: LineSpecLike, seed: int, number: int) -> tuple[Pair, np.random.Generator]:
    """Draw a pair of Gaussian lines.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    seed : int
        Seed of the study.
    number : int
        Number of the pair.

    Returns
    -------
    lines : tuple of numpy.ndarray
        Shapes (N1,) and (N2,), float32 height steps.
    generator : numpy.random.Generator
        Source of all other random choices on this pair.
    """
    # The first two children draw the lines of the realisation of this number.
    children = np.random.SeedSequence((seed, number)).spawn(5)[2:]
    *drawing, choosing = map(np.random.default_rng, children)
    return tuple(draw_gaussian_line(spec, r, one) for r, one in enumerate(drawing)), choosing


def rare_contact(
    spec: LineSpecLike, seed: int, number: int, films: Array, widths: Array, factor: Values
) -> Pair:
    r"""Estimate probabilities and rates of contact from one pair of lines.

    Parameters
    ----------
    spec, seed, number
        As in `draw_pair`.
    films : numpy.ndarray
        Shape (P,), film thickness, height steps, above zero.
    widths : numpy.ndarray
        Shape (P,), points in the contact window.
    factor : float or numpy.ndarray
        From `lube.kernels.layer.layer_factor`, for all films or for each.

    Returns
    -------
    windows : numpy.ndarray
        Shape (2, P): probabilities of geometric contact and of breakthrough in a window.
    runs : numpy.ndarray
        Shape (10, P), expected numbers per point of the line, in the order of
        `lube.kernels.tail.touching_runs`: runs of touching points; runs whose boundary layer
        breaks; groups of broken runs, a longest wavelength apart; broken runs that appear in a
        relative step of one point; and the points of these runs and between them.

    Raises
    ------
    StudyError
        If the lines are not Gaussian.
    """
    drawn = RarePair(spec, seed, number, int(widths.max()))
    windows, runs = np.empty((2, films.size)), np.empty((RUN_NUMBERS, films.size))
    factors = np.broadcast_to(factor, films.shape)
    for i, (film, width, own) in enumerate(zip(films, widths, factors, strict=True)):
        log_tail = scipy.special.log_ndtr(-film / drawn.rms)
        touching = (drawn.place * width).astype(np.int64), drawn.heights(log_tail, drawn.rms)
        shape = np.full(width, film, np.float32)
        windows[:, i] = drawn.windows(shape, touching, own) * (width * np.exp(log_tail))
        heights = touching[1][:RUNS]
        found = touching_runs(
            drawn.lines, drawn.places, drawn.covariances, heights, film, width, own
        )
        runs[:, i] = found * (np.exp(log_tail) / RUNS)
    return windows, runs


@dataclass(frozen=True)
class UnevenWindow:
    """Contact window along which the film or the roughness changes.

    Attributes
    ----------
    film : numpy.ndarray
        Film thickness at each point, shape (W,), height steps, above zero.
    rms : float or numpy.ndarray
        Rms height of the sum of the lines in the gap at each point, over that of the lines as
        drawn.
    shapes : tuple of numpy.ndarray
        The `shapes` of `lube.kernels.shaped.Surface`, of both surfaces.
    at_once : numpy.ndarray
        The `covariances` of `lube.kernels.uneven_tail.answered_windows`.
    covariances : numpy.ndarray
        As in `lube.kernels.uneven_tail.touching_runs_under`.
    shift : int
        The `shift` of `lube.kernels.shaped.Window`.
    """

    film: Array
    rms: Values = 1.0
    shapes: Pair = (_NO_ANSWERS, _NO_ANSWERS)
    at_once: Array = field(default_factory=lambda: np.zeros((2, 2), np.float32))
    covariances: Array = field(default_factory=lambda: np.zeros((2, 5, 1, 1)))
    shift: int = 30


def rare_contact_under(
    pair: "RarePair",
    windows: Sequence[UnevenWindow],
    filtered: Sequence[Pair],
    factors: Array,
    speed_ratios: Array,
) -> Pair:
    """Estimate probabilities and rates in uneven windows, from one pair of lines.

    Parameters
    ----------
    pair : RarePair
        The lines.
    windows : sequence of UnevenWindow
        The window of each operating point.
    filtered : sequence of tuple of numpy.ndarray
        The filtered lines at each point, as in `lube.kernels.shaped.Surface`.
    factors : numpy.ndarray
        As in `rare_contact`, shape (P,).
    speed_ratios : numpy.ndarray
        Surface speeds over that of the faster surface, at S slide-to-roll ratios of each point,
        shape (P, S, 2). Without any, probabilities alone are found.

    Returns
    -------
    windows : numpy.ndarray
        Shape (2, P): probabilities of geometric contact and of breakthrough in a window.
    runs : numpy.ndarray
        Shape (1 + S, P): expected number of runs in a window whose boundary layer breaks, and of
        breakthroughs per time step at each slide-to-roll ratio, as
        `lube.kernels.uneven_tail.touching_runs_under` counts them.
    """
    levels = speed_ratios.shape[1]
    shares, runs = np.empty((2, len(windows))), np.full((1 + levels, len(windows)), np.nan)
    for i, (window, own, lines) in enumerate(zip(windows, factors, filtered, strict=True)):
        rms = np.broadcast_to(pair.rms * window.rms, window.film.shape)
        log_tails, part = likely_part(window.film, rms)
        # The known point of a window lies where contact is likely.
        share = np.cumsum(np.exp(log_tails - log_tails.max()))
        known = np.searchsorted(share, pair.place * share[-1])
        touching = known, pair.heights(log_tails[known], rms[part][known])
        expected = share[-1] * np.exp(log_tails.max())
        each = zip(pair.lines, lines, window.shapes, strict=True)
        answered = tuple(Surface(line, line, *answers) for line, *answers in each)
        film, answers = window.film[part].astype(np.float32), (window.at_once, window.shift)
        shares[:, i] = pair.windows(film, touching, own, answered, answers) * expected
        if levels:
            above = part.start + known[:RUNS], touching[1][:RUNS]
            found = pair.runs_under(window, answered, above, speed_ratios[i], own)
            runs[:, i] = found * (expected / RUNS)
    return shares, runs


def likely_part(film: Array, rms: Array) -> tuple[Array, slice]:
    """Find the part of a window in which contact is likely.

    Parameters
    ----------
    film, rms : numpy.ndarray, shape (W,)
        Film thickness and rms height of the sum of the lines, height steps.

    Returns
    -------
    log_tails : numpy.ndarray
        Logarithm of the probability of contact at each point of the part.
    part : slice
        The part, from the first to the last likely point.
    """
    log_tails = scipy.special.log_ndtr(-film / rms)
    likely = np.flatnonzero(log_tails > log_tails.max() + np.log(NEGLIGIBLE))
    part = slice(int(likely[0]), int(likely[-1]) + 1)
    return log_tails[part], part


class RarePair:
    """A pair of Gaussian lines, and the points and heights chosen at random on it.

    Parameters
    ----------
    spec, seed, number
        As in `draw_pair`.
    widest : int
        Points in the widest contact window.

    Raises
    ------
    StudyError
        If the lines are not Gaussian.
    """

    def __init__(self, spec, seed, number, widest):
        check_gaussian(spec)
        self.lines, generator = draw_pair(spec, seed, number)
        self.size = min(spec.points)
        self.line = self.lines[0][: self.size] + self.lines[1][: self.size]
        self.log_chosen, self.place = np.log(generator.random(WINDOWS)), generator.random(WINDOWS)
        reach = math.ceil(spec.longest_wavelength / spec.spacing)
        self.rms, covariances = sum_of_lines(spec, max(reach + 1, widest))
        self.correlation = covariances[0] + covariances[1]
        self.covariances = tuple(_both_sides(each, reach + 1) for each in covariances)
        self.places = _spread(self.size, 2 * reach + 1, RUNS) + reach

    def heights(self, log_tail, rms):
        """Heights of points that touch a film: the inverse of the Gaussian tail."""
        return (-rms * scipy.special.ndtri_exp(self.log_chosen + log_tail)).astype(np.float32)

    def windows(self, film, touching, factor, surfaces=(), answers=()):
        """Mean weights of windows with contact and with a breakthrough."""
        starts = _spread(self.size, film.size, WINDOWS)
        correlation = _both_sides(self.correlation, film.size)
        if any(surface.shapes.size for surface in surfaces):
            return np.array(
                answered_windows(surfaces, starts, correlation, touching, film, *answers, factor)
            )
        return np.array(touching_windows(self.line, starts, correlation, touching, film, factor))

    def runs_under(self, window, surfaces, touching, speed_ratios, factor):
        """Sum the weights of runs through an uneven window, each with a known point."""
        # From one look to the next the surfaces shift against each other by a point at most.
        shift = np.abs(np.diff(speed_ratios)[:, 0])
        most = window.film.size // LOOKS
        strides = np.maximum(most / np.maximum(most * shift, 1.0), 1.0).astype(np.int64)
        return touching_runs_under(
            surfaces,
            self.places,
            self.covariances,
            touching,
            window.film.astype(np.float32),
            window.covariances,
            window.shift,
            speed_ratios,
            strides,
            factor,
            FOLLOWED,
        )


def _both_sides(covariance, lags):
    """Covariance at the lags -(n - 1) .. n - 1 points, single precision."""
    return np.concatenate([covariance[lags - 1 : 0 : -1], covariance[:lags]]).astype(np.float32)


def _spread(size, width, count):
    """First points of pieces of equal width, evenly spread over a line."""
    return np.arange(count) * (size - width) // (count - 1)
