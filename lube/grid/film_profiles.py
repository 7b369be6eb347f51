"""Computed films across the contact, on positions that all operating points share."""

import numpy as np

from lube.types import Array

_STEP, _EVEN, _GROWTH = 0.01, 1.5, 1.03
"""Distance of positions in the contact, up to where they are even, and their growth beyond."""
_REACH = 12.0
"""Height of the undeformed gap at the last position, over the composite roughness: no roughness
line is so high."""


def film_positions(
    half_width: float,
    reduced_radius: float,
    roughness: float,
    step: float = _STEP,
    growth: float = _GROWTH,
) -> Array:
    """Positions at which the computed films of a study are kept.

    Parameters
    ----------
    half_width : float
        Least half-width of the contact, m.
    reduced_radius : float
        R*, m.
    roughness : float
        Composite rms roughness, m.
    step, growth : float, optional
        Distance of positions in the contact, and their growth beyond.

    Returns
    -------
    numpy.ndarray
        Positions over the half-width, rising, symmetric about 0: even in the contact, farther and
        farther apart outside, up to where no roughness reaches across the gap.

    Examples
    --------
    >>> positions = film_positions(50e-6, 0.025, 0.28e-6)
    >>> positions.size, float(positions[-1])
    (425, 9.375603)
    """
    farthest = 1.0 + np.sqrt(2.0 * reduced_radius * _REACH * roughness) / half_width
    even = np.arange(0.0, _EVEN + step / 2, step)
    count = max(1, int(np.ceil(np.log(farthest / _EVEN) / np.log(growth))))
    half = np.concatenate([even, _EVEN * growth ** np.arange(1, count + 1)]).round(6)
    return np.concatenate([-half[:0:-1], half])


def six_digits(values: Array) -> Array:
    """Round to six digits: further ones depend on the processor.

    Parameters
    ----------
    values : numpy.ndarray
        Values, finite.

    Returns
    -------
    numpy.ndarray
        Their nearest numbers of six decimal digits.

    Examples
    --------
    >>> six_digits(np.array([0.0, 1.23456789e-6])).tolist()
    [0.0, 1.23457e-06]
    """
    return np.vectorize(lambda value: float(f"{value:.6g}"), otypes=[float])(values)


def sampled(profiles: Array, sample, positions: Array) -> Array:
    """Sample a quantity of every film at some positions.

    Parameters
    ----------
    profiles : numpy.ndarray of object
        From `lube.ehl.line_contact.profiles_of`.
    sample : callable
        Values of a `FilmProfile` at positions.
    positions : numpy.ndarray
        Positions over the half-width.

    Returns
    -------
    numpy.ndarray
        Six digits each, with one more dimension; NaN where there is no film.
    """
    missing = np.full(positions.size, np.nan)
    rows = [six_digits(sample(one, positions)) if one else missing for one in profiles.ravel()]
    return np.stack(rows).reshape(*profiles.shape, positions.size)
