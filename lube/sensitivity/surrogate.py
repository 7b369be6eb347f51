"""Interpolation of the probability of breakthrough, and of films, between direct runs.

Under flat films the probability depends on few dimensionless groups: the lambda ratio, the contact
width over the longest wavelength, the Hurst exponent, the width of the band and the strength of the
layer. It also depends on the first roller's part of the roughness if the rollers differ in more
than its height, on the longest wavelength itself if there is a roll-off, and on Moes' numbers with
a shape or an answer of the oil. Its normal quantile is nearly linear in the lambda ratio, so one
function of these groups serves all operating points.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.special
import xarray as xr
from scipy.interpolate import RBFInterpolator

from lube.grid.gap import Gap
from lube.sensitivity.conditions import Deviating
from lube.study.uncertainty import deviating_heights
from lube.types import Array

SMOOTHING = 0.1
"""How much less than exactly runs are met, since they are not exact either."""
LEAST_WEIGHT = 1e-4
"""Weight of runs in which contact is certain, so that their quantile counts for nothing."""


def held_out(count: int) -> int:
    """Return how many of some runs are left out to find the error of a fit."""
    return max(min(200, count // 4), 1)


def groups(
    deviating: Deviating, film: xr.Dataset, values: dict, gap: Gap, effective: Callable | None
) -> xr.DataArray:
    """Form the dimensionless groups on which the probability depends.

    Parameters
    ----------
    deviating : Deviating
        The study.
    film : xarray.Dataset
        From `lube.sensitivity.conditions.joined`.
    values : dict of str to xarray.DataArray
        From `lube.sensitivity.samples.deviations`.
    gap : Gap
        If it is not plain, the probability depends on Moes' numbers, too.
    effective : callable or None
        The lambda ratios that contact sees, from `lube.sensitivity.shape.effective_ratio`; None in
        a plain gap.

    Returns
    -------
    xarray.DataArray
        The groups, over group and the dimensions of the film.
    """
    spec = deviating.study.line_spec
    rms = deviating.rms_roughness(values)
    longest = spec.longest_wavelength * (1.0 + values.get("longest_wavelength", 0.0))
    shortest = spec.shortest_wavelength * (1.0 + values.get("shortest_wavelength", 0.0))
    hurst = values.get("hurst_exponent", spec.lines[0].hurst_exponent or 0.5)
    layer = deviating.study.boundary_layer
    strength = layer.shear_strength / layer.critical_thickness / film["reduced_modulus"]
    strength = strength * (1.0 + values.get("shear_strength", 0.0))
    strength = strength / (1.0 + values.get("critical_thickness", 0.0))
    ratio = deviating.equivalent(film["film_thickness"] / rms, values)
    if effective:
        ratio = effective(ratio, film, values)
    found = [ratio, np.log(film["contact_half_width"] / longest), np.log(shortest / longest)]
    found += [np.log(strength * shortest ** (2.0 - hurst) * longest**hurst / rms), hurst]
    if not spec.has_like_lines:
        found += [(deviating_heights(spec, values)[0] / rms) ** 2]
    if any(line.has_roll_off for line in spec.lines):
        found += [np.log(longest)]
    if not gap.is_plain:
        found += [np.log(film[name]) for name in ("moes_load", "moes_material")]
    each = xr.broadcast(*(xr.DataArray(one, name="groups") for one in found))
    return xr.concat(each, "group", coords="minimal", compat="override", join="exact")


def interpolant(
    variables: Array, values: Array, weight: Array | float = 1.0
) -> Callable[[Array], Array]:
    """Interpolate by radial basis functions between points with variables of alike scatter.

    Parameters
    ----------
    variables : numpy.ndarray
        Shape (variables, points); those that do not vary are left out. Of equal points the first
        counts.
    values : numpy.ndarray
        Shape (points, columns).
    weight : numpy.ndarray or float, optional
        How much a deviation counts at each point, shape (points,).

    Returns
    -------
    callable
        All columns at other points, shape (points, columns), from their variables; further
        variables do not count.
    """
    middle, scale = variables.mean(axis=1)[:, None], variables.std(axis=1)[:, None]
    varied = (scale > 1e-9 * np.abs(middle))[:, 0]

    def scaled(variables):
        return ((variables[: len(middle)] - middle)[varied] / scale[varied]).T

    # Points that differ by rounding alone would make the equations singular.
    points = scaled(variables)
    first = np.unique(points.round(9), axis=0, return_index=True)[1]
    weight = np.maximum(np.broadcast_to(weight, len(values)), LEAST_WEIGHT)[first]
    # Cubic functions of the distance, and a linear one.
    options = {"kernel": "cubic", "degree": 1, "smoothing": SMOOTHING / weight**2}
    functions = RBFInterpolator(points[first], values[first], **options)
    return lambda variables: functions(scaled(variables))


@dataclass(frozen=True)
class Surrogate:
    """The probability of breakthrough by one model.

    Its normal quantile is a sum. The first part is that of lines under flat films. Every choice
    that is made otherwise adds one, which is smoother than the whole.

    Attributes
    ----------
    parts : tuple of callable
        Functions of as many of the groups as each has variables.
    missed : numpy.ndarray
        Error of the logarithm of the probability of each run, if the run is left out of the fit;
        NaN if it never was.
    """

    parts: tuple[Callable, ...]
    missed: Array | None = None

    @classmethod
    def of(
        cls, variables: Array, probability: Array, parts: tuple[Callable, ...], is_sum: bool
    ) -> "Surrogate":
        """Fit the runs of a model.

        Errors count as much as they change the logarithm of the probability, in proportion to its
        scatter, which grows with the quantile.

        Parameters
        ----------
        variables : numpy.ndarray
            Groups of each run, shape (groups, runs).
        probability : numpy.ndarray
            Shape (runs, seeds); runs with NaN are left out.
        parts : tuple of callable
            Parts that are known already.
        is_sum : bool
            Whether these parts are all; the runs then only show the error. Otherwise one part is
            fitted to what they leave.

        Returns
        -------
        Surrogate
            Fitted to all runs; its errors are those of a fit to all but the last ones. Those of a
            sum are those at all runs.
        """
        known = np.isfinite(probability).all(axis=1)
        variables, probability = variables[:, known], probability[known]
        quantile = scipy.special.ndtri_exp(np.log(np.minimum(probability, 1.0 - 1e-12)))
        typical = quantile.mean(axis=1)
        # How much the logarithm of the probability changes with its quantile.
        weight = scipy.special.log_ndtr(typical) + 0.5 * typical**2
        weight = np.exp(-weight) / np.sqrt(2.0 * np.pi * (1.0 + typical**2))
        rest = quantile - cls(parts).quantile(variables)

        def fit(some):
            return cls((*parts, interpolant(variables[:, some], rest[some], weight[some])))

        last = slice(0 if is_sum else -held_out(len(typical)), None)
        trial = cls(parts) if is_sum else fit(slice(last.start))
        missed = np.full(known.shape, np.nan)
        found = np.log(probability[last]).mean(axis=1)
        predicted = trial.log_probability(variables[:, last]).mean(axis=1)
        missed[np.flatnonzero(known)[last]] = predicted - found
        return replace(trial if is_sum else fit(slice(None)), missed=missed)

    def quantile(self, variables: Array) -> Array | float:
        """Compute the normal quantile at some groups, shape (points, seeds)."""
        return sum(part(variables) for part in self.parts)

    def log_probability(self, variables: Array) -> Array:
        """Compute the logarithm of the probability at some groups, shape (points, seeds)."""
        return scipy.special.log_ndtr(self.quantile(variables))
