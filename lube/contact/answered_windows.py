"""Statistics of rough lines in a contact window, as the oil answers them: rms heights, covariances.

They are sums over the waves of the lines, which are taken together in narrow bands.
"""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from lube.contact.waves import Answer
from lube.ehl.line_contact import one_blas_thread
from lube.surfaces.rare_contact import UnevenWindow, likely_part, sum_of_lines
from lube.surfaces.synthetic import wave_amplitudes
from lube.types import Array

_IN_PHASE = 0.2
"""Difference of phase of neighbouring bands of waves, over the window, rad."""


def _nodes_of(part, before, answers, spacing):
    """Nodes of a part of a window, from its first point on, and the shapes of both answers."""
    shift = answers[0].shift(spacing)
    nodes = part.start + (np.arange((part.stop - part.start >> shift) + 2) << shift)
    return nodes - part.start, [answer.at_points(before - nodes, spacing) for answer in answers]


def rms_along(spec, points: int, before: int, answers: tuple[Answer, Answer]) -> Array:
    """Rms height of the roughness in the gap along a contact window.

    Parameters
    ----------
    spec, before, answers
        As in `answered_windows`.
    points : int
        Points of the window.

    Returns
    -------
    numpy.ndarray
        Over that of the lines as drawn, shape (points,).
    """
    rms, _ = sum_of_lines(spec, 1)
    bands = [_bands(spec, roller, one, points) for roller, one in enumerate(answers)]
    nodes, shapes = _nodes_of(slice(0, points), before, answers, spec.spacing)

    def added_by(roller):
        power, _, filters = bands[roller]
        return (np.abs(1.0 + shapes[roller] @ filters) ** 2 - 1.0) @ power

    with one_blas_thread():
        added = sum(_of_both(added_by, spec, answers))
    return np.sqrt(1.0 + np.interp(np.arange(points), nodes, added) / rms**2)


@lru_cache(maxsize=4)
def answered_windows(
    spec, points: int, before: int, answers: tuple[Answer, Answer]
) -> Callable[[Array], UnevenWindow]:
    """Prepare contact windows under films to which the oil answers alike.

    Parameters
    ----------
    spec : lube.study.line_spec.LineSpec
        Parameters of the lines.
    points : int
        Points W of the window.
    before : int
        Points of the window before its centre.
    answers : tuple of Answer
        Answers to both surfaces.

    Returns
    -------
    callable
        From the film thickness at each point of the window, height steps, shape (W,), to the part
        of it in which contact is likely, an `UnevenWindow` for
        `lube.surfaces.rare_contact.rare_contact_under`.
    """
    shift = answers[0].shift(spec.spacing)
    rms, _ = sum_of_lines(spec, 1)
    bands = [_bands(spec, roller, one, points) for roller, one in enumerate(answers)]
    ratio = rms_along(spec, points, before, answers)
    reach = math.ceil(spec.longest_wavelength / spec.spacing)
    lags = np.arange((max(points, reach) >> shift) + 3) << shift
    most = 1 + max(len(filters) for _, _, filters in bands)

    def at_lags(roller):
        return _at_lags(lags, bands[roller], most, rms**2)

    with one_blas_thread():
        covariances = np.stack(_of_both(at_lags, spec, answers))

    def under(film):
        _, part = likely_part(film, rms * ratio)
        nodes, shapes = _nodes_of(part, before, answers, spec.spacing)

        def added_at_nodes(roller):
            power, by_point, filters = bands[roller]
            drawn = np.exp(1j * nodes[:, None] * by_point)
            changed = (1.0 + shapes[roller] @ filters) * drawn
            found = _covariance(changed, power) - _covariance(drawn, power)
            return (found / rms**2).astype(np.float32)

        with one_blas_thread():
            at_once = sum(_of_both(added_at_nodes, spec, answers))
        return UnevenWindow(film[part], ratio[part], tuple(shapes), at_once, covariances, shift)

    return under


def _at_lags(lags, bands, most, variance):
    """Covariance of a line and its filtered lines at some lags and their opposites."""
    power, by_point, filters = bands
    both = np.concatenate([np.ones((1, power.size)), filters])
    one, other = np.triu_indices(len(both))
    products = power * both[one] * both[other].conj() / variance
    phase, last = lags[:, None] * by_point, lags.size - 1
    even, odd = np.cos(phase) @ products.real.T, np.sin(phase) @ products.imag.T
    found = np.zeros((2 * last + 1, most, most))
    # At the opposite lag the two lines change places.
    for first, second, values in ((one, other, even - odd), (other, one, even + odd)):
        found[last:, first, second] = values
        found[last::-1, second, first] = values
    found[:, 0, 0] = 0.0
    return found


def _of_both(function, spec, answers):
    """Values of a function of the roller for both of them, found once if they are alike."""
    first, second = spec.lines
    alike = first == second and answers[0] is answers[1]
    found = function(0)
    return [found, found if alike else function(1)]


def _covariance(waves, power):
    """Covariance at nodes of waves with some powers: the real part of their products."""
    each = waves.real, waves.imag
    return sum((part * power) @ part.T for part in each)


@lru_cache(maxsize=4)
def _bands(spec, roller, answer, points):
    """Bands of a line's waves: their power, phase from point to point, and filters by an answer."""
    first, amplitudes = wave_amplitudes(spec, roller)
    unit = spec.wave_step(roller)
    amplitudes = amplitudes[: max(int(answer.wavenumber[-1] / unit) - first + 1, 0)]
    # So few waves in a band that they are in phase over the window.
    band = max(1, int(_IN_PHASE / (unit * spec.spacing * points)))
    edges = np.arange(0, amplitudes.size, band)
    waves = first + np.arange(amplitudes.size)
    powers = (amplitudes / spec.height_step) ** 2 / 2.0
    edges = edges[np.add.reduceat(powers, edges) > 0.0]  # with a lay the longest wave may be 0
    power = np.add.reduceat(powers, edges)
    middle = np.add.reduceat(powers * waves, edges) / power
    numbers = np.log(answer.wavenumber)
    filters = [np.interp(np.log(unit * middle), numbers, each) for each in answer.filters.T]
    # The lines pass against the direction in which positions are counted, so conjugate.
    filters = np.reshape(filters, (-1, middle.size)).conj()
    return power, unit * spec.spacing * middle, filters
