"""A polynomial that stands for the probability of breakthrough between direct runs.

Under flat films the probability depends on few dimensionless groups: the lambda ratio, the contact
width over the longest wavelength, the Hurst exponent, the width of the band and the strength of the
layer; with a shape or an answer of the oil also on Moes' numbers. Its normal quantile is nearly
linear in the lambda ratio, so a polynomial of these groups serves all operating points at once.
"""

from dataclasses import dataclass, replace
from itertools import chain, combinations_with_replacement

import numpy as np
import scipy.linalg
import scipy.special
import xarray as xr

from lube.sensitivity.conditions import Deviating
from lube.types import Array

NEGLIGIBLE = 1e-6
"""Combinations of terms that vary less than this, relative to the most varied, are left out."""


def held_out(count: int) -> int:
    """Return how many of some runs are left out to find the error of a fit."""
    return max(min(200, count // 4), 1)


def groups(deviating: Deviating, film: xr.Dataset, values: dict, is_shaped: bool) -> xr.DataArray:
    """Form the dimensionless groups on which the probability depends.

    Parameters
    ----------
    deviating : Deviating
        The study.
    film : xarray.Dataset
        From `Deviating.film`.
    values : dict of str to xarray.DataArray
        From `lube.sensitivity.samples.deviations`.
    is_shaped : bool
        Whether the probability depends on Moes' numbers, too.

    Returns
    -------
    xarray.DataArray
        The groups, over group and the dimensions of the film.
    """
    spec = deviating.study.line_spec
    rms = deviating.rms_roughness(values)
    longest = spec.longest_wavelength * (1.0 + values.get("longest_wavelength", 0.0))
    shortest = 2.0 * np.pi / spec.q_max * (1.0 + values.get("shortest_wavelength", 0.0))
    hurst = values.get("hurst_exponent", spec.lines[0].hurst_exponent or 0.5)
    layer = deviating.layer(values)
    strength = layer.shear_strength / layer.critical_thickness / film["reduced_modulus"]
    found = [
        film["film_thickness"] / rms,
        np.log(film["contact_half_width"] / longest),
        np.log(shortest / longest),
        np.log(strength * shortest ** (2.0 - hurst) * longest**hurst / rms),
        hurst,
    ]
    if is_shaped:
        found += [np.log(film["moes_load"]), np.log(film["moes_material"])]
    each = xr.broadcast(*(xr.DataArray(one, name="groups") for one in found))
    return xr.concat(each, "group", coords="minimal", compat="override", join="exact")


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A polynomial of some variables.

    Attributes
    ----------
    middle, scale : numpy.ndarray, shape (variables, 1)
        By which the variables are moved and divided.
    powers : list of tuple of int
        Variables that each term multiplies.
    coefficients : numpy.ndarray, shape (terms, columns)
        Coefficients of several polynomials.
    """

    middle: Array
    scale: Array
    powers: list
    coefficients: Array

    @classmethod
    def fitted(
        cls, degree: int, variables: Array, values: Array, weight: Array | float = 1.0
    ) -> "Polynomial":
        """Fit by least squares.

        Parameters
        ----------
        degree : int
            Total degree.
        variables : numpy.ndarray
            Shape (variables, points).
        values : numpy.ndarray
            Shape (points, columns).
        weight : numpy.ndarray or float, optional
            Weight of each point's deviation, shape (points,).

        Returns
        -------
        Polynomial
            The polynomial.
        """
        varied = np.ptp(variables, axis=1) > 1e-9 * np.abs(variables).max(axis=1)
        lowest, highest = variables.min(axis=1), variables.max(axis=1)
        middle, scale = 0.5 * (lowest + highest), np.where(varied, 0.5 * (highest - lowest), np.inf)
        numbers = np.flatnonzero(varied).tolist()
        orders = (combinations_with_replacement(numbers, order) for order in range(degree + 1))
        powers = list(chain.from_iterable(orders))
        empty = cls(middle[:, None], scale[:, None], powers, np.empty((len(powers), 0)))
        terms = empty.terms(variables) * np.broadcast_to(weight, len(values))
        weighted = values * np.broadcast_to(weight, len(values))[:, None]
        coefficients = scipy.linalg.lstsq(terms.T, weighted, cond=NEGLIGIBLE)[0]
        return cls(middle[:, None], scale[:, None], powers, coefficients)

    def terms(self, variables: Array) -> Array:
        """Compute the terms at some points, shape (terms, points)."""
        scaled, terms = (variables - self.middle) / self.scale, {}
        for power in self.powers:
            terms[power] = (
                terms[power[:-1]] * scaled[power[-1]] if power else np.ones(variables.shape[1])
            )
        return np.stack(list(terms.values()))

    def __call__(self, variables: Array) -> Array:
        """Evaluate all columns at some points, shape (points, columns)."""
        return np.einsum("tp,tc->pc", self.terms(variables), self.coefficients)


@dataclass(frozen=True)
class Surrogate:
    """The probability of breakthrough by one model.

    Its normal quantile is the sum of polynomials. The first is that of lines under flat films.
    Every choice that is made otherwise adds one, which is smoother than the whole, and so do two
    such choices together.

    Attributes
    ----------
    parts : tuple of Polynomial
        Polynomials of as many of the groups as each has variables.
    missed : numpy.ndarray
        Error of the logarithm of the probability of each run, if the run is left out of the fit;
        NaN if it never was.
    """

    parts: tuple[Polynomial, ...]
    missed: Array | None = None

    @classmethod
    def of(
        cls, degree: int, variables: Array, probability: Array, parts: tuple[Polynomial, ...] = ()
    ) -> "Surrogate":
        """Fit the runs of a model.

        Errors count as much as they change the logarithm of the probability.

        Parameters
        ----------
        degree : int
            Degree of the last polynomial.
        variables : numpy.ndarray
            Groups of each run, shape (groups, runs).
        probability : numpy.ndarray
            Shape (runs, seeds); runs with NaN are left out.
        parts : tuple of Polynomial, optional
            The other polynomials.

        Returns
        -------
        Surrogate
            Fitted to all runs; its errors are those of a fit to all but the last ones.
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
            fitted = Polynomial.fitted(degree, variables[:, some], rest[some], weight[some])
            return cls((*parts, fitted))

        last = slice(-held_out(len(typical)), None)
        trial = fit(slice(last.start)).log_probability(variables[:, last])
        missed = np.full(known.shape, np.nan)
        found = np.log(probability[last]).mean(axis=1)
        missed[np.flatnonzero(known)[last]] = trial.mean(axis=1) - found
        return replace(fit(slice(None)), missed=missed)

    def quantile(self, variables: Array) -> Array:
        """Compute the normal quantile at some groups, shape (points, seeds)."""
        return sum(part(variables[: len(part.middle)]) for part in self.parts)

    def log_probability(self, variables: Array) -> Array:
        """Compute the logarithm of the probability at some groups, shape (points, seeds)."""
        return scipy.special.log_ndtr(self.quantile(variables))
