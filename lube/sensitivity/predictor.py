"""Probabilities of many samples at all operating points, by surrogates of films and contact."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.errors import DataError
from lube.schema import POINT_DIMS
from lube.sensitivity.conditions import Deviating, joined
from lube.sensitivity.runs import SEEDS, Model, is_chosen, is_sum, models
from lube.sensitivity.samples import deviations, over_run, quantiles
from lube.sensitivity.shape import effective_ratio
from lube.sensitivity.surrogate import Surrogate, groups, held_out, interpolant
from lube.threads import on_threads
from lube.types import Array, Pair

AT_ONCE = 400
"""Samples whose films are computed together, for the sake of memory."""
LEAST_RUNS = 20
"""Runs with breakthroughs that a surrogate needs."""
BAND = 0.05, 0.95
"""Quantiles of the probability over all that a study does not know exactly."""
COMPUTED = {"film_formula": "computed"}
"""Choice of the computed film."""
FILM_GROUPS = "moes_load", "moes_material", "dynamic_viscosity"
"""On which the ratio of the computed film to that of Moes' formula depends."""


def stacked_points(deviating: Deviating) -> xr.Dataset:
    """Return the operating points of a study, one after the other, over point."""
    levels = deviating.levels
    each = zip(levels, np.meshgrid(*levels.values(), indexing="ij"), strict=True)
    return xr.Dataset({name: ("point", values.ravel()) for name, values in each})


@dataclass(frozen=True)
class Predictor:
    """Surrogates of a study.

    Attributes
    ----------
    deviating : Deviating
        The study.
    surrogates : dict
        Surrogate of each `lube.sensitivity.runs.Model`.
    film : callable or None
        Logarithm of the computed film over that of Moes' formula, over the logarithms of M, L and
        the viscosity; None if the study does not choose it.
    film_error : float
        Its rms error at runs that were left out of the fit.
    effective : dict
        Lambda ratios that contact sees, of each model whose gap is not plain.
    """

    deviating: Deviating
    surrogates: dict[Model, Surrogate]
    film: Callable | None
    film_error: float
    effective: dict[Model, Callable]

    @classmethod
    def of(
        cls, deviating: Deviating, runs: xr.Dataset, responses: xr.Dataset | None = None
    ) -> "Predictor":
        """Fit surrogates to the runs of all models.

        Parameters
        ----------
        deviating : Deviating
            The study.
        runs : xarray.Dataset
            A ``sensitivity_runs`` dataset.
        responses : xarray.Dataset, optional
            The ``sensitivity_responses`` dataset, if the oil answers the roughness in some runs.

        Raises
        ------
        DataError
            If the boundary layer breaks in fewer than `LEAST_RUNS` runs of a model.
        """
        surrogates = {}
        effective = {
            model: effective_ratio(deviating, runs, model.gap, model.contact_model, responses)
            for model in models(deviating)
            if not model.gap.is_uniform
        }
        for model in sorted(models(deviating), key=Model.deviations):
            own = _of_model(runs, model)
            values = over_run(deviations(deviating.factors, own["factor_quantile"].values))
            variables = groups(deviating, own, values, model.gap, effective.get(model))
            variables = variables.transpose("group", "run").values
            found = own["breakthrough_probability"].transpose("run", "seed").values
            broken = np.count_nonzero(np.isfinite(found).all(axis=1))
            if broken < LEAST_RUNS:
                raise DataError(
                    f"sensitivity: the boundary layer breaks in {broken} of {len(found)} runs of "
                    f"the model '{', '.join(model)}', need {LEAST_RUNS} or more: the films are too "
                    "thick, or the grid of the lines is too coarse"
                )
            nearer = [one.parts for other, one in surrogates.items() if other.is_nearer(model)]
            parts = tuple(dict.fromkeys(chain.from_iterable(nearer)))
            surrogates[model] = Surrogate.of(variables, found, parts, is_sum(deviating, model))
        return cls(deviating, surrogates, *_film(deviating, runs), effective)

    def errors(self, runs: xr.Dataset, deviation: Array) -> dict:
        """Find the errors of the surrogates at runs that were left out of their fits.

        Parameters
        ----------
        runs : xarray.Dataset
            A ``sensitivity_runs`` dataset.
        deviation : numpy.ndarray
            Standard deviation of the logarithm of the probability at each point, shape (points,).

        Returns
        -------
        dict
            Variables of ``sensitivity.nc``.
        """
        points = stacked_points(self.deviating).to_dataframe().assign(deviation=deviation)
        known = points.set_index(list(POINT_DIMS))["deviation"]
        rows = []
        for model, surrogate in self.surrogates.items():
            own = _of_model(runs, model)
            left_out = np.isfinite(surrogate.missed)
            at = own[list(POINT_DIMS)].isel(run=left_out).to_dataframe()[list(POINT_DIMS)]
            missed = surrogate.missed[left_out]
            scaled = missed / known.loc[list(at.itertuples(index=False, name=None))].to_numpy()
            errors = (np.sqrt(np.mean(each**2)) for each in (missed, scaled))
            fitted = np.isfinite(own["breakthrough_probability"].values).all(axis=1)
            rows.append((*errors, fitted.sum(), left_out.sum()))
        absolute, relative, run_counts, left_out_counts = zip(*rows, strict=True)
        return {
            "surrogate_model": [", ".join(model) for model in self.surrogates],
            "surrogate_error": six_digits(absolute),
            "relative_surrogate_error": six_digits(relative),
            "run_count": list(run_counts),
            "left_out_count": list(left_out_counts),
            "film_surrogate_error": six_digits(self.film_error).item(),
        }

    def log_probability(
        self, unit: Array, points: xr.Dataset | None = None, threads: int = 1
    ) -> Array:
        """Predict the logarithm of the probability of breakthrough.

        Parameters
        ----------
        unit : numpy.ndarray
            Samples of the study's factors and, as the last column, of the seed; shape
            (samples, factors + 1), numbers from 0 to 1.
        points : xarray.Dataset, optional
            ``lubricant``, ``temperature``, ``speed`` and ``force`` over point; by default all
            operating points of the study.
        threads : int, optional
            Threads that share the work; they do not change the results.

        Returns
        -------
        numpy.ndarray
            Shape (samples, points); NaN where the film is not known.
        """
        parts = np.array_split(unit, -(-len(unit) // AT_ONCE))
        points = stacked_points(self.deviating) if points is None else points
        # Options of xarray are those of all threads: set here, none changes them for the others.
        with xr.set_options(arithmetic_join="exact", keep_attrs=False):
            found = on_threads(lambda part: self._of_part(part, points), parts, threads)
        return np.concatenate(found)

    def draws(self, points: xr.Dataset, samples: int = 1024) -> Pair:
        """Draw probabilities at some operating points, and for each a place among pairs of rollers.

        Parameters
        ----------
        points : xarray.Dataset
            As in `log_probability`.
        samples : int, optional
            Number of samples, a power of 2.

        Returns
        -------
        probabilities : numpy.ndarray
            Means over pairs, shape (samples, points).
        places : numpy.ndarray
            Part of the pairs whose share is less, from 0 to 1, shape (samples, 1).
        """
        columns = len(self.deviating.factors) + 2  # the seed, and the pair
        unit = quantiles(samples, columns, self.deviating.study.seed)
        return np.exp(self.log_probability(unit[:, :-1], points)), unit[:, -1:]

    def _of_part(self, unit, points):
        deviating = self.deviating
        seed = np.minimum((unit[:, -1] * SEEDS).astype(int), SEEDS - 1)
        numbers = deviations(deviating.factors, unit[:, :-1])
        values = over_run(numbers)
        film = self._with_computed(joined(deviating.films(values, points)), numbers)
        found = np.full((len(unit), points.sizes["point"]), np.nan)
        for model, surrogate in self.surrogates.items():
            some = np.flatnonzero(is_chosen(deviating, model._asdict(), numbers, len(unit)))
            if some.size == 0:
                continue
            own = {name: each.isel(run=some) for name, each in values.items()}
            here = film.isel(run=some)
            variables = groups(deviating, here, own, model.gap, self.effective.get(model))
            variables = variables.transpose("group", "run", "point").values
            shape = variables.shape[1:]
            logarithm = surrogate.log_probability(variables.reshape(len(variables), -1))
            by_seed = logarithm.reshape(*shape, SEEDS)
            found[some] = by_seed[np.arange(some.size), :, seed[some]]
        return found

    def _with_computed(self, film, numbers):
        """Replace Moes' film by the computed one, where it is chosen."""
        if self.film is None:
            return film
        chosen = is_chosen(self.deviating, COMPUTED, numbers, film.sizes["run"])
        is_computed = np.flatnonzero(chosen)
        some = film.isel(run=is_computed)
        variables = np.log([some[name].values.ravel() for name in FILM_GROUPS])
        ratio = np.exp(self.film(variables)[:, 0])
        thickness = film["film_thickness"].copy()
        thickness[{"run": is_computed}] *= ratio.reshape(some["film_thickness"].shape)
        return film.assign(film_thickness=thickness)


def _of_model(runs, model):
    """Select the runs of a model."""
    same = [runs[name].values == choice for name, choice in model._asdict().items()]
    return runs.isel(run=np.all(same, axis=0))


def _film(deviating, runs):
    """Interpolate the ratio of the computed film, and find its error."""
    if COMPUTED["film_formula"] not in deviating.formulas:
        return None, 0.0
    values = deviations(deviating.factors, runs["factor_quantile"].values)
    chosen = is_chosen(deviating, COMPUTED, values, runs.sizes["run"])
    computed = runs.isel(run=chosen & runs["film_thickness"].notnull())
    values = over_run(deviations(deviating.factors, computed["factor_quantile"].values))
    points = computed.reset_coords()[list(POINT_DIMS)]
    moes = joined(deviating.films(values, points))["film_thickness"]
    ratio = np.log(computed["film_thickness"] / moes).values[:, None]
    variables = np.log([computed[name].values for name in FILM_GROUPS])
    last = slice(-held_out(len(ratio)), None)
    trial = interpolant(variables[:, : last.start], ratio[: last.start])
    missed = trial(variables[:, last]) - ratio[last]
    return interpolant(variables, ratio), float(np.sqrt(np.mean(missed**2)))
