"""The checks, and how far two results are apart."""

from pathlib import Path

import numpy as np
import pandas as pd

from lube.types import Array

CHECKS = pd.read_csv(Path(__file__).with_name("checks.csv"), index_col="name")
"""All checks, in the order of their numbers: what is compared with what, the kind of check, the
greatest deviation that passes with its unit, and the equation or reference behind it. Nothing is
demanded of deviations without a limit, which are properties of the model."""
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
