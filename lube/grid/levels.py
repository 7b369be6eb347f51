"""Which level of a study a number or a name means."""

NEAR = 0.005
"""Relative distance within which what people write means a level: 86 r/min is 600/7."""
SAME = 1e-9
"""Relative distance of levels that are the same but for rounding."""


def level_index(levels, wanted, within=NEAR):
    """Find the level that a number or a name means.

    Parameters
    ----------
    levels : sequence of float or of str
        The levels there are.
    wanted : float or str
        What is asked for.
    within : float, optional
        Relative distance that numbers may have, `NEAR` or `SAME`.

    Returns
    -------
    int or None
        Index of the first level that is meant; None if there is none.
    """
    for index, level in enumerate(levels):
        numbers = isinstance(level, int | float) and isinstance(wanted, int | float)
        if level == wanted or (numbers and abs(level - wanted) <= within * abs(level)):
            return index
    return None


def level_near(levels, value, tolerance):
    """Find the level that a measured value means.

    Parameters
    ----------
    levels : sequence of float
        The levels there are.
    value : float
        The value.
    tolerance : float
        How far it may be from a level, in their unit.

    Returns
    -------
    float or None
        The nearest level; None if it is farther away than that.
    """
    nearest = min(levels, key=lambda level: abs(level - value))
    return nearest if abs(nearest - value) <= tolerance else None


def levels_told(levels):
    """Tell levels in a line, such as ``800, 1600``.

    Parameters
    ----------
    levels : sequence of float or of str
        The levels there are.

    Returns
    -------
    str
        Numbers to six digits, names as they are.
    """
    return ", ".join(level if isinstance(level, str) else f"{level:g}" for level in levels)
