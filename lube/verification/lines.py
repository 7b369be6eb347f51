"""Checks of contact on rough lines."""

import math
from typing import NamedTuple

import numpy as np
import scipy.special
import xarray as xr

from lube.contact.counted import contact_at
from lube.contact.rough_pair import roughness_batch
from lube.contact.windows import ContactWindows
from lube.grid.discretise import layer_factor_of
from lube.grid.films import film_at
from lube.kernels.layer import layer_breaks
from lube.physics.excursions import crossing_rate
from lube.physics.summits import breaking_curvature, sharp_summit_share
from lube.study.line_spec import LineSpec
from lube.study.rollers import ROLLERS
from lube.study.study import Study
from lube.surfaces.spectra import pair_moments
from lube.surfaces.synthetic import draw_realisation
from lube.threads import on_threads
from lube.types import Array
from lube.verification.check import errors_apart, percent_off

PAIRS = 40
"""Pairs of lines on which contact is counted, and others on which it is sampled."""
LAMBDA_RATIOS = np.arange(1.0, 8.5, 0.5)
"""Lambda ratios of the curves."""
FEW = np.flatnonzero(np.isin(LAMBDA_RATIOS, (1.0, 2.0, 3.0, 4.0)))
"""Those at which the slower checks are made."""
SLIP = 0.5
"""Slide-to-roll ratio at which the probability is compared with that in pure rolling."""
CROSSED = np.array([1.0, 2.0, 3.0])
"""Levels at which crossings are counted, over the rms height."""
COUNTED = "geometric_contact_probability", "breakthrough_probability"
STEPS = 400
"""Time steps at which whole windows are looked at, one by one."""
LARGER, LONGER = 2.0, 1.5
"""Radius and length of other rollers with the same films and contact widths, over the study's."""
SEARCHES = 20
"""Steps of the search for their speed, each of which makes the error four times smaller or more."""
_SAME = "film_thickness", "contact_half_width"
GRIDS = {
    "the study's": (1, 1.0),
    "twice the points": (2, 1.0),
    "four times the points": (4, 1.0),
    "shortest wave twice as long": (1, 0.5),
    "twice as long, twice the points": (2, 0.5),
    "half as long, twice the points": (2, 2.0),
}
"""Other grids: factors of the number of points, and of the largest wavenumber."""


class Curves(NamedTuple):
    """Probabilities over the lambda ratio.

    Attributes
    ----------
    counted, sampled : numpy.ndarray
        Shape (pairs, lambda ratios, 2): of touching, and of a breakthrough.
    runs : numpy.ndarray
        Sampled numbers of runs of touching points, and of those that break, per length, of the same
        shape, 1/m.
    bound : numpy.ndarray
        Expected number of runs in a window, which the probability of touching tends to from below
        as the film rises; shape (lambda ratios,).
    """

    counted: Array
    sampled: Array
    runs: Array
    bound: Array


def films_of(study: Study, ratios: Array) -> xr.Dataset:
    """Flat films of some lambda ratios, at the contact width of the study's middle force."""
    forces = study.operating_grid.force
    half_width = study.rollers.contact_half_width(sorted(forces)[len(forces) // 2])
    films = "lambda_ratio", ratios * math.hypot(*study.line_spec.rms_height)
    table = {"film_thickness": films, "contact_half_width": half_width}
    return xr.Dataset(table | {"reduced_modulus": study.rollers.reduced_modulus})


def curves(study: Study, threads: int | None) -> Curves:
    """Count and sample contact on independent pairs of lines, and compute what theory expects."""
    spec, windows = study.line_spec, _windows(study)

    def counted(number):
        return windows.count(draw_realisation(spec, study.seed, number))[:, :2]

    def sampled(number):
        return np.concatenate(windows.sample(spec, study.seed, number))[:4].T

    moments = pair_moments(spec)
    level = windows.thickness * spec.height_step
    width = 2.0 * windows.half_windows * spec.spacing
    first = scipy.special.ndtr(-level / math.sqrt(moments[0]))
    bound = first + width * crossing_rate(level, moments)
    counts = np.array(on_threads(counted, range(PAIRS), threads))
    samples = np.array(on_threads(sampled, range(PAIRS), threads))
    return Curves(counts, samples[..., :2], samples[..., 2:] / spec.spacing, bound)


def _windows(study, spec=None, ratios=LAMBDA_RATIOS):
    return ContactWindows(spec or study.line_spec, films_of(study, ratios), study.boundary_layer)


def line_checks(study: Study, found: Curves, threads: int | None) -> dict[str, float]:
    """Make all checks of lines.

    Parameters
    ----------
    study : Study
        A study with Gaussian lines.
    found : Curves
        From `curves`.
    threads : int, optional
        Threads that share the work.

    Returns
    -------
    dict of str to float
        Deviation of each check of `lube.verification.check.CHECKS`, negative below a bound.
    """
    spec = study.line_spec
    pairs = on_threads(lambda number: draw_realisation(spec, study.seed, number), range(PAIRS))
    windows = _windows(study)
    seen = (found.counted > 0.0).mean(axis=0) > 0.5
    level = windows.thickness * spec.height_step
    moments = pair_moments(spec)
    runs, broken = np.moveaxis(found.runs.mean(axis=0), 1, 0)
    sharp = sharp_summit_share(level, moments, _curvature_limit(study))
    touching = found.sampled[..., 0]
    error = touching.std(axis=0, ddof=1) / math.sqrt(PAIRS)
    drawn = [[line.std() * spec.height_step for line in pair] for pair in pairs]
    return {
        "counted": errors_apart(found.counted[:, seen], found.sampled[:, seen]),
        "runs": percent_off(runs, crossing_rate(level, moments)),
        "sharp_runs": percent_off(broken[-1] / runs[-1], sharp[-1]),
        "bound": float(np.max((touching.mean(axis=0) - found.bound) / error)),
        "crossings": _crossings(spec, pairs),
        "rms": percent_off(drawn, spec.rms_height),
        "curvature": _curvature(study),
        "whole_windows": _whole_windows(study, pairs[0], windows),
        "slip": _slip(found, pairs, windows, threads),
        "time_steps": _time_steps(pairs, windows),
        "batches": _batches(study),
    }


def _curvature_limit(study):
    layer = study.boundary_layer
    return breaking_curvature(
        study.rollers.reduced_modulus, layer.critical_thickness, layer.shear_strength
    )


def _crossings(spec, pairs):
    """Compare the runs above some levels with Rice's rate."""
    moments = pair_moments(spec)
    rms = math.sqrt(moments[0]) / spec.height_step
    counts = []
    for first, second in pairs:
        line = first + np.resize(second, first.size)
        above = line > (CROSSED * rms)[:, None]
        counts.append(np.count_nonzero(above & ~np.roll(above, 1, axis=1), axis=1))
    rate = np.mean(counts, axis=0) / (spec.points[0] * spec.spacing)
    return percent_off(rate, crossing_rate(CROSSED * rms * spec.height_step, moments))


def _curvature(study):
    """Compare the curvature at which a parabolic summit breaks with theory."""
    spec, layer = study.line_spec, study.boundary_layer
    factor = layer_factor_of(spec, study.rollers.reduced_modulus, layer)
    points = 20_001
    distance = spec.spacing * (np.arange(points) - points // 2)
    parabola = 0.5 * (distance[-1] ** 2 - distance**2) / spec.height_step

    least, most = 1e-6, 1e9
    for _ in range(100):
        middle = math.sqrt(least * most)
        breaks = layer_breaks(points, (middle * parabola).sum(), factor)
        least, most = (least, middle) if breaks else (middle, most)
    return percent_off(most, _curvature_limit(study))


def _whole_windows(study, pair, windows):
    """Compare traces with whole windows, looked at point by point."""
    factor = layer_factor_of(study.line_spec, study.rollers.reduced_modulus, study.boundary_layer)
    some = windows[FEW]
    traced = some.trace(pair)
    steps = np.random.default_rng(study.seed).integers(traced.shape[1], size=STEPS)
    wrong = 0
    for row, (film, half, *_) in enumerate(some.keys):
        around = np.arange(-half, half + 1)
        for step in steps.tolist():
            heights = sum(line.take(step + around, mode="wrap").astype(np.int64) for line in pair)
            wrong += traced[row, step] != _broken(heights - film, factor)
    return float(wrong)


def _broken(overlap, factor):
    """Count the points of broken runs in a window."""
    edges = np.flatnonzero(np.diff(overlap > 0, prepend=False, append=False))
    runs = zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    return sum(b - a for a, b in runs if layer_breaks(b - a, int(overlap[a:b].sum()), factor))


def _slip(found, pairs, windows, threads):
    """Compare the probability with slip on some pairs with that without, on others."""
    half = PAIRS // 2
    some = windows[FEW]
    slipping = on_threads(lambda pair: some.count(pair, SLIP)[:, :2], pairs[:half], threads)
    rolling_there = found.counted[half:, FEW].reshape(PAIRS - half, -1)
    return errors_apart(np.reshape(slipping, (half, -1)), rolling_there)


def _time_steps(pairs, windows):
    """Compare a tenth of a window between time steps with every step."""
    some, shares = windows[FEW[:3]], []
    for pair in pairs[:8]:
        touching = some.trace(pair) > 0
        stride = max(1, 2 * some.half_windows[0] // 10)
        shares.append([touching.mean(axis=1), touching[:, ::stride].mean(axis=1)])
    every, few = np.mean(shares, axis=0)
    return percent_off(few, every)


def _batches(study):
    """Compare a realisation in a batch of two with the same realisation alone."""
    film = films_of(study, LAMBDA_RATIOS)
    batches = (roughness_batch(study.line_spec, study.seed, some) for some in ([0, 1], [1]))
    two, alone = (contact_at(batch, film, study.boundary_layer) for batch in batches)
    pairs = [(two[name].sel(realisation=1), alone[name].sel(realisation=1)) for name in COUNTED]
    return float(sum(np.sum(first.values != second.values) for first, second in pairs))


def scaled_checks(study: Study, lubricant: xr.Dataset) -> dict[str, float]:
    """Compare contact with that of other rollers, which have the same films and contact widths.

    The other rollers have `LARGER` times the radius and `LONGER` times the length, and run at
    another temperature. Their force follows from the contact width, their speed is searched for.

    Parameters
    ----------
    study : Study
        The study.
    lubricant : xarray.Dataset
        Its ``lubricant`` dataset.

    Returns
    -------
    dict of str to float
        Deviations at all forces and the middle speed.
    """
    rollers, grid = study.rough_rollers, study.operating_grid
    force = xr.DataArray(list(grid.force), dims="force")
    speed = xr.full_like(force, sorted(grid.speed)[len(grid.speed) // 2])
    oil, formula = lubricant.isel(lubricant=0), study.film_formulas[:1]
    own = film_at(oil.isel(temperature=-1), rollers, force, speed, formula)
    others, their_force = _other_rollers(rollers), force * LONGER / LARGER
    for _ in range(SEARCHES):
        film = film_at(oil.isel(temperature=0), others, their_force, speed, formula)
        thicker = own["film_thickness"] / film["film_thickness"]
        speed = speed * thicker.isel(film_formula=0, drop=True) ** 1.25  # films as speed^0.6 to 1
    known = np.isfinite(thicker.values[0])
    own, film = own.isel(force=known), film.isel(force=known)
    lines = roughness_batch(study.line_spec, study.seed, [0])
    first, second = (contact_at(lines, each, study.boundary_layer) for each in (own, film))
    names = *COUNTED, "mean_contact_length"
    same = [np.isclose(first[name], second[name], rtol=1e-3, atol=1e-12) for name in names]
    return {
        # Less depends on the processor.
        "scaled_films": round(max(percent_off(film[name], own[name]) for name in _SAME), 7),
        "scaled_contact": float(np.sum(~np.array(same))),
    }


def _other_rollers(rollers):
    radii = (LARGER * getattr(rollers, name).radius for name in ROLLERS)
    return rollers.with_radii(*radii).model_copy(update={"length": LONGER * rollers.length})


def on_grids(study: Study, threads: int | None) -> dict[str, Array]:
    """Sample contact on lines with more points, and with narrower and wider bands.

    Returns
    -------
    dict of str to numpy.ndarray
        For each of `GRIDS` that the lines can have, the probabilities of touching and of a
        breakthrough, shape (pairs, lambda ratios, 2), at the lambda ratios of `FEW`.
    """
    found = {}
    for name, (points, wider) in GRIDS.items():
        if all(_can_have(line, wider) for line in study.line_spec.lines):
            spec = _other_grid(study.line_spec, points, wider)
            windows = _windows(study, spec, LAMBDA_RATIOS[FEW])
            found[name] = np.moveaxis(windows.on_pairs(spec, study.seed, PAIRS, threads), 1, 2)
    return found


def _can_have(line, wider):
    """Whether a line has waves left in a narrower band, and known ones in a wider band."""
    return wider * line.q_max > 1.1 * line.q_roll_off and (wider <= 1.0 or line.spectrum is None)


def _other_grid(spec: LineSpec, points: int, wider: float) -> LineSpec:
    lines = tuple(
        line.model_copy(update={"points": points * line.points, "q_max": wider * line.q_max})
        for line in spec.lines
    )
    return spec.model_copy(update={"lines": lines, "spacing": spec.spacing / points})
