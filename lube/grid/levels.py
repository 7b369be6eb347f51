"""The level of a study that a given number or name stands for."""

from collections.abc import Sequence

NEAR = 0.005
"""Relative tolerance for numbers that people write: 86 r/min stands for 600/7 r/min."""
SAME = 1e-9
"""Relative tolerance for numbers that differ by rounding only."""


def level_index(
    levels: Sequence[float | str], wanted: float | str, within: float = NEAR
) -> int | None:
    """Find the level that a number or a name stands for.

    Parameters
    ----------
    levels : sequence of float or of str
        Levels of the study.
    wanted : float or str
        Number or name to look up.
    within : float, optional
        Relative tolerance of numbers, `NEAR` or `SAME`.

    Returns
    -------
    int or None
        Index of the first level that matches; None if there is none.

    Examples
    --------
    >>> level_index([60.0, 600.0 / 7.0, 100.0], 86)
    1
    """
    for index, level in enumerate(levels):
        numbers = isinstance(level, int | float) and isinstance(wanted, int | float)
        if level == wanted or (numbers and abs(level - wanted) <= within * abs(level)):
            return index
    return None


def level_near(levels: Sequence[float], value: float, tolerance: float) -> float | None:
    """Find the level nearest to a measured value.

    Parameters
    ----------
    levels : sequence of float
        Levels of the study.
    value : float
        Measured value.
    tolerance : float
        Largest distance from a level, in the unit of the levels.

    Returns
    -------
    float or None
        The nearest level; None if it is farther away than the tolerance.

    Examples
    --------
    >>> level_near([40.0, 80.0], 79.2, tolerance=1.0)
    80.0
    """
    nearest = min(levels, key=lambda level: abs(level - value))
    return nearest if abs(nearest - value) <= tolerance else None


def rolling(slide_to_roll_ratio: Sequence[float]) -> float:
    """Return the slide-to-roll ratio nearest to pure rolling, of two the positive one.

    Examples
    --------
    >>> rolling([-1.0, -0.1, 0.1, 0.3])
    0.1
    """
    return min(slide_to_roll_ratio, key=lambda ratio: (abs(ratio), -ratio))
