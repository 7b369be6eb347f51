"""One check, and how its outcome is written."""

from dataclasses import dataclass

import numpy as np

from lube.types import Array

CLOSE = 3.5
"""Standard errors within which two estimates agree, the largest of several distances."""


@dataclass(frozen=True)
class Check:
    """What was compared, with what, and how far they differ.

    Attributes
    ----------
    subject : str
        What was computed.
    against : str
        With what it was compared.
    kind : str
        One of `KINDS`.
    seen, allowed : float
        The deviation that was seen, and the greatest that passes; NaN if the deviation is a
        property of the grid or the model, of which nothing is demanded.
    unit : str
        Unit of both: ``%``, ``standard errors`` or ``values``, a number of values that differ.
    source : str
        Equation or reference behind it.
    """

    subject: str
    against: str
    kind: str
    seen: float
    allowed: float
    unit: str
    source: str


KINDS = {
    "exact": "Exact theory and identities",
    "method": "Other methods",
    "same": "The same calculation, divided or arranged otherwise",
    "print": "Printed numbers and fits of others",
    "grid": "Other grids",
}
"""Kinds of checks, in words."""


def percent_off(found: Array | float, expected: Array | float) -> float:
    """Largest relative deviation, per cent."""
    return float(100.0 * np.max(np.abs(np.asarray(found) / expected - 1.0)))


def errors_apart(first: Array, second: Array) -> float:
    """Largest distance of two means over independent samples, in standard errors.

    Parameters
    ----------
    first, second : numpy.ndarray
        Shape (samples, values); places where neither scatters are left out.

    Returns
    -------
    float
        The largest over the values.
    """
    variance = sum(each.var(axis=0, ddof=1) / len(each) for each in (first, second))
    scatters = variance > 0.0
    apart = np.abs(first.mean(axis=0) - second.mean(axis=0))[scatters]
    return float(np.max(apart / np.sqrt(variance[scatters]), initial=0.0))
