"""Direct runs: the probability of breakthrough for samples of the uncertain quantities.

All runs draw the same random numbers, so that they differ by the quantities alone. Lines are
Gaussian; if heights are not, the film is that in which Gaussian ones touch as often.
"""

from dataclasses import replace
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import surface_contact
from lube.contact.windows import ContactWindows
from lube.grid.gap import Gap
from lube.sensitivity.conditions import Deviating, joined
from lube.sensitivity.responses import slips_of, solve_responses, with_responses
from lube.sensitivity.samples import deviations, over_run, quantiles
from lube.study.uncertainty import SAMPLE_BATCHES
from lube.threads import on_threads
from lube.types import Array

SEEDS = 4
"""Independent sets of random numbers."""
PAIRS = 3
"""Pairs of lines in each set."""
NOISY = 0.1
"""Relative standard error of a probability above which more pairs are sampled."""
TIMES = 9
"""How many times as many they then are."""
SURFACE_SEEDS = 2
"""Sets that have surfaces of their own; the others share these."""
FEWER_SURFACES = 16, 2
"""Surfaces in each set are this many times fewer than elsewhere: first, and then where that does
not tell how often the layer breaks."""
APART = 2.0
"""Ratio of the probabilities of two sets above which they differ."""
FEW_BREAK = 0.3
"""Part of the contacts that break their layer below which more surfaces are sampled."""
RAREST = 1e-3
"""Part of the contacts that break their layer below which a run takes no part in a surrogate."""
SIZES = {"line": (1024, 2), "answered line": (256, 2), "surface": (32, 12), "sum": (4, 24)}
"""Numbers of samples of a model, and of operating points of each.

Surfaces are slow to draw, but once drawn they serve many operating points. The response of the
film takes half a second a run. Runs of a sum, as in `is_sum`, only test it."""


class Model(NamedTuple):
    """A way from film to probability.

    Attributes
    ----------
    contact_model, film_shape, roughness_deformation : str
        As in a study.
    """

    contact_model: str
    film_shape: str
    roughness_deformation: str

    def deviations(self) -> int:
        """Count the choices that are not the paper's."""
        return sum(one != other for one, other in zip(self, PLAIN_LINE, strict=True))

    def is_nearer(self, other: "Model") -> bool:
        """Whether its choices are those of another model or the paper's."""
        each = zip(self, other, PLAIN_LINE, strict=True)
        return self != other and all(own in choices for own, *choices in each)

    @property
    def gap(self) -> Gap:
        """How film and roughness make up the gap."""
        return Gap(self.film_shape, self.roughness_deformation)


PLAIN_LINE = Model("line", "flat", "none")
"""The paper's way."""


def models(deviating: Deviating) -> list[Model]:
    """Return all ways from film to probability that a study leaves open."""
    study = deviating.study
    own = study.contact_model[0], study.film_shape, study.roughness_deformation
    choices = map(deviating.choices, Model._fields, own)
    return [Model(*chosen) for chosen in product(*choices)]


def is_sum(deviating: Deviating, model: Model) -> bool:
    """Whether the surrogate of a model is the sum of those of models nearer to the paper's.

    It is for surfaces with further choices made otherwise, if the study leaves all of them open.
    """
    nearer = [other for other in models(deviating) if other.is_nearer(model)]
    others = model.deviations()
    return model.contact_model == "surface" and others > 1 and len(nearer) == 2**others - 1


def is_chosen(deviating: Deviating, made: dict, numbers: dict, count: int) -> Array:
    """Find which of some samples make some choices; `numbers` are their deviations."""
    chosen = np.ones(count, bool)
    for name, choice in made.items():
        if name in numbers:
            choices = getattr(deviating.study.uncertainty, name).choices
            chosen &= numbers[name] == choices.index(choice)
    return chosen


def _sizes(deviating, model):
    if is_sum(deviating, model):
        return SIZES["sum"]
    is_answered_line = model.gap.is_answered and model.contact_model == "line"
    return SIZES["answered line" if is_answered_line else model.contact_model]


def design(deviating: Deviating, model: Model) -> tuple[Array, xr.Dataset]:
    """Choose samples and operating points at random, for the runs of a model.

    Parameters
    ----------
    deviating : Deviating
        The study.
    model : Model
        The way from film to probability.

    Returns
    -------
    unit : numpy.ndarray
        Samples of the study's factors, numbers from 0 to 1, shape (runs, factors). Runs of the same
        sample follow one another.
    points : xarray.Dataset
        As for `run`.
    """
    study, (samples, points) = deviating.study, _sizes(deviating, model)
    unit = quantiles(samples, len(deviating.factors), study.seed)
    generator = np.random.default_rng((study.seed, samples))
    levels = deviating.levels.items()
    chosen = {name: ("run", generator.choice(each, samples * points)) for name, each in levels}
    return np.repeat(unit, points, axis=0), xr.Dataset(chosen)


def runs_of_batch(unit: Array, number: int) -> Array:
    """Find the runs of one of `SAMPLE_BATCHES` batches of samples, of about the same size.

    Parameters
    ----------
    unit : numpy.ndarray
        As from `design`.
    number : int
        Number of the batch, from 0.

    Returns
    -------
    numpy.ndarray
        Numbers of the runs, in their order; none if there are fewer samples than batches.
    """
    sample = np.cumsum(np.diff(unit, axis=0, prepend=-1.0).any(axis=1)) - 1
    return np.flatnonzero(sample * SAMPLE_BATCHES // (sample[-1] + 1) == number)


def run(
    deviating: Deviating,
    model: Model,
    unit: Array,
    points: xr.Dataset,
    threads: int | None = None,
    responses: xr.Dataset | None = None,
) -> xr.Dataset:
    """Compute the probability of breakthrough for some samples, each at an operating point.

    Parameters
    ----------
    deviating : Deviating
        The study.
    model : Model
        The way from film to probability.
    unit : numpy.ndarray
        As from `design`.
    points : xarray.Dataset
        ``lubricant``, ``temperature``, ``speed`` and ``force`` of each run, over run, and what else
        `Deviating.films` takes.
    threads : int, optional
        Threads that share the work; they do not change the results.
    responses : xarray.Dataset, optional
        From `lube.sensitivity.responses.solve_responses`, for these runs and others; by default for
        these runs, if they need it.

    Returns
    -------
    xarray.Dataset
        Variables of the films over run, and ``breakthrough_probability`` over run and seed; NaN
        where the film is not known, or the layer holds in all contacts that were sampled; of
        surfaces also if it breaks in less than `RAREST` of the contacts, or if the sets differ.
    """
    films, found, is_clear = _runs(deviating, model, unit, points, threads, responses)
    known = np.where((found > 0.0) & is_clear, found, np.nan)
    return films.assign(breakthrough_probability=(("run", "seed"), known))


def _runs(deviating, model, unit, points, threads=None, responses=None):
    """Films of `run`, its probabilities, shape (runs, seeds), and whether they are clear."""
    values = deviations(deviating.factors, unit)
    films = deviating.films(over_run(values), points, with_shape=model.gap.has_shape)
    if model.gap.is_answered:
        contact_model, slips = model.contact_model, slips_of(deviating, points)
        if responses is None:
            responses = solve_responses(deviating, [contact_model], unit, points, threads)
        films = [
            (at, with_responses(film, responses, contact_model, slips[at])) for at, film in films
        ]
    parts = ((runs, film, same) for runs, film in films for same in _same_samples(unit[runs]))
    of_samples = [(runs[same], film.isel(run=same)) for runs, film, same in parts]

    found, is_clear = np.empty((len(unit), SEEDS)), np.empty((len(unit), SEEDS), bool)

    def of_sample(sample):
        runs, film = sample
        own = {name: column[runs[0]].item() for name, column in values.items()}
        found[runs], is_clear[runs] = _probabilities(deviating, model, own, film)

    # Options of xarray are those of all threads: set here, none changes them for the others.
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        on_threads(of_sample, of_samples, threads, "direct runs")
    return joined(films), found, is_clear


def run_all(deviating: Deviating, unit: Array, points: xr.Dataset) -> Array:
    """Compute the probability of breakthrough for some samples, each at all operating points.

    Parameters
    ----------
    deviating : Deviating
        The study.
    unit : numpy.ndarray
        Samples of all factors, from 0 to 1, shape (samples, factors).
    points : xarray.Dataset
        Operating points as in `run`, over point.

    Returns
    -------
    numpy.ndarray
        Shape (samples, points), by the model that each sample chooses; NaN where its film is not
        known.
    """
    number = points.sizes["point"]
    samples = np.repeat(unit, number, axis=0)
    runs = points.isel(point=np.tile(np.arange(number), len(unit))).rename(point="run")
    values, found = deviations(deviating.factors, samples), np.full(len(samples), np.nan)
    for model in models(deviating):
        some = np.flatnonzero(is_chosen(deviating, model._asdict(), values, len(samples)))
        if some.size:
            table, sampled, _ = _runs(deviating, model, samples[some], runs.isel(run=some))
            is_known = table["film_thickness"].notnull().values
            found[some] = np.where(is_known, np.minimum(sampled.mean(axis=1), 1.0), np.nan)
    return found.reshape(len(unit), number)


def _same_samples(unit):
    """Slices of rows that are alike and follow one another."""
    first = np.flatnonzero(np.diff(unit, axis=0, prepend=-1.0).any(axis=1)).tolist()
    return [slice(*ends) for ends in pairwise([*first, len(unit)])]


def _probabilities(deviating, model, values, film):
    """Probability of breakthrough at some points, by each set of random numbers.

    The second value says whether it is clear enough for a surrogate.
    """
    study, spec, layer = deviating.study, deviating.lines(values), deviating.layer(values)
    film["reduced_modulus"] = film["reduced_modulus"].values.flat[0]
    ratio = film["film_thickness"] / deviating.rms_roughness(values)
    thicker = deviating.equivalent(ratio, values) / ratio
    film["film_thickness"] = film["film_thickness"] * thicker
    # Under films that are over a factor, lines break as higher ones do if their layer is weaker.
    weaker = film.get("roughness_factor", 1.0)
    if model.contact_model == "surface":
        pair = RoughPair(spec, study.rollers.length, layer, study.seed, model.gap)
        found, is_clear = _of_surfaces(pair, film, weaker)
        return found[:, np.arange(SEEDS) % SURFACE_SEEDS], is_clear
    windows = ContactWindows(spec, film, layer, model.gap, weaker)

    def sampled(some, numbers):
        found = [some.sample(spec, study.seed, number)[0][1] for number in numbers]
        return np.transpose(found).reshape(some.size, SEEDS, -1)

    found = sampled(windows, range(SEEDS * PAIRS))
    mean = found.mean(axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        error = found.std(axis=(1, 2), ddof=1) / np.sqrt(SEEDS * PAIRS) / found.mean(axis=(1, 2))
    # Without a breakthrough on any pair the error is not known.
    noisy = np.flatnonzero(~(error <= NOISY) & ~windows.unknown)
    if noisy.size:
        more = sampled(windows[noisy], range(SEEDS * PAIRS, SEEDS * PAIRS * TIMES))
        mean[noisy] = np.concatenate([found[noisy], more], axis=2).mean(axis=2)
    return mean, True


def _of_surfaces(pair, film, weaker):
    """Probability of breakthrough of surfaces at some points, by each set that has its own.

    The second value says whether it is clear, shape (points, 1).
    """
    pairs = [replace(pair, seed=pair.seed + number) for number in range(SURFACE_SEEDS)]

    def sampled(wanted, fewer):
        # The scatter between so few surfaces is not needed.
        with np.errstate(invalid="ignore", divide="ignore"):
            each = [surface_contact(one, film, 1, weaker, fewer, wanted) for one in pairs]
        return xr.concat(each, "set")

    few, more = FEWER_SURFACES
    contact = sampled(None, few)
    noisy = ~_is_clear(contact, FEW_BREAK) & film["film_thickness"].notnull().values
    if noisy.any():
        wanted = film["film_thickness"].copy(data=noisy)
        contact = contact.where(~wanted, sampled(wanted, more))
    found = contact["breakthrough_probability"].transpose(..., "set").values
    return found, _is_clear(contact, RAREST)[:, None]


def _is_clear(contact, least):
    """Whether sets of surfaces agree, and the layer breaks in that part of the contacts or more."""
    found = contact["breakthrough_probability"]
    agree = found.max("set") <= APART * found.min("set")
    breaks = (contact["breakthroughs"] >= least * contact["contacts"]).all("set")
    return (agree & breaks).values
