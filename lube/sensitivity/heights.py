r"""The Gaussian roughness that touches as often as one whose heights have another distribution.

A point of two lines touches if the sum of their heights exceeds the film, which it does with a
probability Q. Gaussian heights exceed a film of the lambda ratio :math:`-\Phi^{-1}(Q)` as often.
Gaussian lines with the same spectrum then touch as often in the whole contact, too. Counted with
drawn lines they do within 9 %, errors of counting included, at skewness from -1 to 1 and kurtosis
up to 6. The layer breaks as often within 25 %, since peaks of another shape load it otherwise.
"""

from collections.abc import Callable

import numpy as np
import scipy.special
from scipy.interpolate import RegularGridInterpolator

from lube.surfaces.translation import REACH, johnson_curve, lognormal_kurtosis
from lube.types import Array

LEVELS = 9
"""Levels of skewness and of kurtosis."""
RATIOS = np.linspace(0.25, 12.0, 48)
"""Lambda ratios; beyond them the result grows in proportion."""
LEAST_EXCESS = 1e-3
"""By how much the kurtosis exceeds that of lognormal heights at least."""


def equivalent_ratio(
    skewness: tuple[float, float], kurtosis: tuple[float, float], rms_height: tuple[float, float]
) -> Callable[[Array, Array, Array], Array]:
    """Tabulate the lambda ratio of the Gaussian roughness that touches as often.

    The heights have at least the kurtosis of lognormal ones with the same skewness. With less they
    would end at a bound, and would never touch from some lambda ratio on.

    Parameters
    ----------
    skewness, kurtosis : tuple of float
        Least and greatest value, of both lines alike.
    rms_height : tuple of float
        Rms heights of the lines, of which only the ratio counts.

    Returns
    -------
    callable
        Equivalent ratios from lambda ratios, skewness and kurtosis, arrays of the same shape; NaN
        where the lambda ratio is.
    """
    axes = [np.linspace(*ends, LEVELS) for ends in (skewness, kurtosis)]
    parts = np.array(rms_height) / np.hypot(*rms_height)
    values = [[_ratios(skew, each, parts) / RATIOS for each in axes[1]] for skew in axes[0]]
    table = RegularGridInterpolator((*axes, RATIOS), values)

    def equivalent(ratio, skewness, kurtosis):
        inside = np.clip(np.nan_to_num(ratio), RATIOS[0], RATIOS[-1])
        return ratio * table(np.stack([skewness, kurtosis, inside], axis=-1))

    return equivalent


def _ratios(skewness, kurtosis, parts):
    """Equivalent of all `RATIOS`, for lines that have these parts of the rms height."""
    least = lognormal_kurtosis(abs(skewness)) + LEAST_EXCESS
    curve = johnson_curve(skewness, max(kurtosis, least))
    gaussian = np.linspace(-REACH, REACH, curve.size)
    weight = np.exp(-0.5 * gaussian**2)
    # The second line must be this high where the first one has one of its heights.
    needed = (RATIOS[:, None] - parts[0] * curve) / parts[1]
    above = scipy.special.ndtr(-np.interp(needed, curve, gaussian, right=np.inf))
    touching = np.sum(above * weight, axis=1) / weight.sum()
    rarest = scipy.special.ndtr(-RATIOS[-1])
    return -scipy.special.ndtri_exp(np.log(np.maximum(touching, rarest)))
