"""The model at the conditions of each record: its film, and what single pairs of rollers do there.

A record is made at a force, a speed and a temperature of its own. The film there follows from
the formulas themselves and the probability from the study's own realisations, run at that film
and window: nothing is taken from the nearest level of the grid.
"""

import logging

import numpy as np
import xarray as xr

from lube.grid.discretise import layer_factor_of, revolution, speed_ratios, whole_numbers
from lube.kernels.motion import surface_position
from lube.kernels.strips import strip_statistics
from lube.schema import OPERATING_DIMS
from lube.statistics.one_pair import persistent_share, scatter_ratio
from lube.surfaces.synthetic import draw_realisation, line_attributes

log = logging.getLogger(__name__)

PROBABILITY = "breakthrough_probability"
POINT_VALUES = ("film_thickness", "contact_half_width")

MOST_PAIRS = 64
"""Pairs of lines whose scatter is learnt from runs of their own, at most."""
AT_ONCE = 16
"""First lines that are kept while all second ones pass: a matter of memory."""
STRETCHES = 8
"""Stretches of each realisation that a record of less than a turn is tried on, at most."""
ALIGNMENT_RATIOS = np.linspace(1.0, 3.5, 6)
"""Lambda ratios at which the lines are paired crosswise: where contact is not too rare to scatter
among so many."""


def model_at_records(at_records, experiment, film, contact, study):
    """Film and probability at the conditions of each record, and the scatter of one pair there.

    Parameters
    ----------
    at_records : xarray.Dataset
        Film of each record, as from `lube.stages.film.film_at_records`.
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    film, contact : xarray.Dataset
        The datasets of these names of the study. Where a record's film and window are among
        their own in rolling, the probabilities are taken from there.
    study : Study
        Its rollers, lubricants, film formulas, roughness lines, boundary layer and drift.

    Returns
    -------
    xarray.Dataset
        ``film_thickness`` (m), ``lambda_ratio``, ``moes_load``, ``moes_material`` and
        ``contact_half_width`` (m) of each record, ``breakthrough_probability`` over
        (realisation, film_formula, record), ``scatter_ratio`` over (film_formula, record), and
        ``record_deviation`` over all three;
        the attributes ``travel`` and ``longest_wavelength``, both m, of one realisation.

        The probabilities are those of one revolution of pure rolling: in expectation slip does
        not change them. What it changes, the scatter of one record, is in ``scatter_ratio``,
        the variance of the record's share over that of one revolution in rolling.
    """
    model = at_records.copy()
    lines = xr.Dataset(attrs=line_attributes(study.line_spec))
    points = _whole(model, lines)
    realisations = range(contact.sizes["realisation"])
    known = _known(film, contact, lines)
    rolling = _probabilities(study, lines, points, realisations, known)
    dims = ("realisation", "film_formula", "record")
    model[PROBABILITY] = dims, rolling.reshape(-1, *model["film_thickness"].shape)
    ratio, deviation = _scatter(experiment, model, study, lines, points, rolling)
    model["scatter_ratio"] = dims[1:], ratio.reshape(model["film_thickness"].shape)
    model["record_deviation"] = dims, deviation.reshape(model[PROBABILITY].shape)
    model = model.assign_coords(realisation=contact["realisation"].values)
    return model.assign_attrs(
        {name: contact.attrs[name] for name in ("travel", "longest_wavelength")}
    )


def _whole(table, lines):
    """Films in height steps and half-windows in grid points, shape (2, P), of all points."""
    values = xr.broadcast(*(table[name] for name in POINT_VALUES))
    return np.stack(whole_numbers(*(each.values.ravel() for each in values), lines))


def _known(film, contact, lines):
    """Films and half-windows that contact.nc has in rolling, with the probabilities there."""
    rolling = contact["slide_to_roll_ratio"].values == 0.0
    if not rolling.any() or contact["revolutions"].item() != 1:
        return np.empty((2, 0), np.int64), np.empty((contact.sizes["realisation"], 0))
    film = film[list(POINT_VALUES)].transpose(..., *OPERATING_DIMS, missing_dims="ignore")
    found = contact[PROBABILITY].isel(slide_to_roll_ratio=int(np.argmax(rolling)))
    return _whole(film, lines), found.values.reshape(found.shape[0], -1)


def _probabilities(study, lines, points, realisations, known):
    """Probability of every realisation in rolling, shape (R, P)."""
    known_points, known_values = known
    column = {tuple(point): number for number, point in enumerate(known_points.T.tolist())}
    wanted, back = np.unique(points, axis=1, return_inverse=True)
    values = np.empty((len(realisations), wanted.shape[1]))
    new = [number for number, point in enumerate(wanted.T.tolist()) if tuple(point) not in column]
    old = np.setdiff1d(np.arange(wanted.shape[1]), new)
    values[:, old] = known_values[:, [column[tuple(point)] for point in wanted.T[old].tolist()]]
    if new:
        for realisation in realisations:
            pair = draw_realisation(study.line_spec, study.seed, realisation)
            values[realisation, new] = _run(study, lines, pair, 0.0, wanted[:, new])
            log.info("records: realisation %d of %d: done", realisation + 1, len(realisations))
    return values[:, back.ravel()]


def _run(study, lines, pair, slide_to_roll_ratio, points, turns=1.0):
    """Probability of breakthrough over one revolution, or a part of it, shape (P,)."""
    ratios = speed_ratios(slide_to_roll_ratio)
    steps = max(round(turns * revolution(pair, ratios)), 1)
    factor = layer_factor_of(lines, study.rollers.reduced_modulus, study.boundary_layer)
    films, half_windows = np.ascontiguousarray(points)
    return strip_statistics(*pair, ratios, steps, films, half_windows, factor)[:, 1] / steps


def _scatter(experiment, model, study, lines, points, rolling):
    """How far each record's share lies from the mean over pairs.

    Returns
    -------
    ratios : numpy.ndarray
        Shape (P,), variance over that of one revolution in rolling.
    deviations : numpy.ndarray
        Shape (R, P), of each realisation in such a record, from which the correlation between
        records of one pair follows; their size means nothing. NaN for realisations beyond
        `MOST_PAIRS` where they have not been run.
    """
    slips, turns = experiment["slide_to_roll_ratio"].values, experiment["turns"].values
    times = points.shape[1] // model.sizes["record"]  # all records by each film formula
    slips, turns = np.tile(slips, times), np.tile(turns, times)
    variance = rolling.var(axis=0, ddof=1) if len(rolling) > 1 else np.zeros(turns.size)
    persistent, effects = _persistent(study, lines, model, slips, turns)
    ratios, deviations = 1.0 / turns, rolling - rolling.mean(axis=0)
    for slip in np.unique(slips):
        long = np.flatnonzero((slips == slip) & (turns >= 1.0))
        turn = _one_turn(study, lines, points[:, long], rolling[:, long], slip)
        change = _change(turn, variance[long])
        part = np.minimum(persistent[long] / change, 1.0)
        parts = [
            _parts(study, slip, turns[place], of) for place, of in zip(long, part, strict=True)
        ]
        alone, together = np.reshape(parts, (-1, 2)).T
        ratios[long] = change * (alone + together)
        if effects is not None:
            turn = _mixed(alone, together, effects[:, long], turn)
        deviations[: len(turn), long] = turn - turn.mean(axis=0)
        deviations[len(turn) :, long] = np.nan
    short = (turns < 1.0) & (variance > 0.0)
    scatter = _short_scatter(
        study, lines, points[:, short], slips[short], turns[short], len(rolling)
    )
    ratios[short] = np.where(scatter > 0.0, scatter / variance[short], ratios[short])
    return ratios, deviations


def _parts(study, slip, turns, persistent):
    """Scatter ratio of a record by what its lines do alone, and by what they do together."""
    motion = speed_ratios(slip), study.line_spec.points, _reach(study)
    whole, renewed = (
        scatter_ratio(turns, *motion, part, study.rig.drift) for part in (persistent, 0.0)
    )
    together = min((1.0 - persistent) * renewed, whole)
    return whole - together, together


def _mixed(alone, together, effects, turn):
    """Deviations of each realisation in records of several alignments, shape (R, P).

    What its lines do alone, whatever they meet, differs between pairs in other proportions from
    point to point than what they do together: contact at neighbouring films is more alike. So
    the two are added, each as large as in such a record.

    Parameters
    ----------
    alone, together : numpy.ndarray
        Shape (P,), both parts of the variance.
    effects : numpy.ndarray
        Shape (R, P), of the lines alone.
    turn : numpy.ndarray
        Shape (R, P) or more realisations, of one turn, which holds both.
    """
    effects, turn = _standardised(effects), _standardised(turn[: len(effects)])
    rest = _standardised(turn - effects * np.mean(effects * turn, axis=0))
    return np.sqrt(alone) * effects + np.sqrt(together) * rest


def _standardised(values):
    """Values with the mean 0 and the variance 1 over the realisations, or all 0."""
    offsets = values - values.mean(axis=0)
    scale = offsets.std(axis=0)
    return offsets / np.where(scale > 0.0, scale, 1.0)


def _short_scatter(study, lines, points, slips, turns, realisations):
    """Variance between the shares of records of less than a turn, shape (P,).

    It is not in proportion to 1 / turns: the waves of a whole line have their amplitudes by the
    study's spectrum, those of a part of it have not, so that parts differ the more. So it is
    taken from stretches of the ensemble's own lines.
    """
    motions = sorted(set(zip(slips.tolist(), turns.tolist(), strict=True)))
    shares = [[] for _ in motions]
    for realisation in range(min(realisations, MOST_PAIRS)) if motions else ():
        pair = draw_realisation(study.line_spec, study.seed, realisation)
        for (slip, part), found in zip(motions, shares, strict=True):
            here = points[:, (slips == slip) & (turns == part)]
            found += _stretches(study, lines, pair, slip, part, here)
        log.info("short records: realisation %d: done", realisation)
    scatter = np.zeros(turns.size)
    for (slip, part), found in zip(motions, shares, strict=True):
        scatter[(slips == slip) & (turns == part)] = np.var(found, axis=0, ddof=1)
    return scatter


def _stretches(study, lines, pair, slip, turns, points):
    """Shares of one pair's records that begin at several places, a list of shape (P,) each."""
    ratios = speed_ratios(slip)
    count = min(int(1.0 / turns), STRETCHES)
    shares = []
    for begin in np.arange(count) * revolution(pair, ratios) // count:
        begun = [
            np.roll(line, -surface_position(begin, ratio))
            for line, ratio in zip(pair, ratios, strict=True)
        ]
        shares.append(_run(study, lines, begun, slip, points, turns))
    return shares


def _reach(study):
    """Points that two alignments must be apart to share no roughness: a longest wavelength."""
    spec = study.line_spec
    return 2.0 * np.pi / spec.q_min / spec.spacing


def _one_turn(study, lines, points, rolling, slip):
    """Probability of every realisation over one turn with slip, shape (R, P)."""
    if slip == 0.0 or not points.size:
        return rolling
    slipping = np.empty((min(len(rolling), MOST_PAIRS), points.shape[1]))
    for realisation, row in enumerate(slipping):
        pair = draw_realisation(study.line_spec, study.seed, realisation)
        row[:] = _run(study, lines, pair, slip, points)
        log.info("records with slip %g: realisation %d: done", slip, realisation)
    return slipping


def _change(turn, variance):
    """Variance between realisations over one turn with slip over that in rolling, shape (P,).

    With slip an alignment changes while the contact is passed, so that contacts are shorter and
    more, and their share scatters less.
    """
    slipping = turn.var(axis=0, ddof=1) if len(turn) > 1 else np.zeros(variance.size)
    seen = (variance > 0.0) & (slipping > 0.0)
    return np.where(seen, slipping / np.where(seen, variance, 1.0), 1.0)


def _persistent(study, lines, model, slips, turns):
    """Tell what no new alignment averages out: either line by itself, whatever it meets.

    Taken from the ensemble's own lines, paired crosswise; only where a record has several
    alignments.

    Returns
    -------
    share : numpy.ndarray
        Shape (P,), its part of the scatter in rolling.
    effects : numpy.ndarray or None
        Shape (R, P), of each realisation, up to `MOST_PAIRS` of them; None if none were run.
    """
    ratio = model["lambda_ratio"].values.ravel()
    alike = study.line_spec.points[0] == study.line_spec.points[1]
    one_alignment = alike and not slips.any()
    if one_alignment or not (turns > 1.0).any() or model.sizes["realisation"] < 2:
        return (np.zeros if one_alignment else np.ones)(ratio.size), None
    thickness = ALIGNMENT_RATIOS * model["composite_rms_roughness"].item()
    half_width = model["contact_half_width"].mean().item()
    levels = np.stack(whole_numbers(thickness, np.full(thickness.size, half_width), lines))
    shares = _crossed(study, lines, min(model.sizes["realisation"], MOST_PAIRS), levels)
    found = persistent_share(shares)
    known = np.isfinite(found)
    if not known.any():
        return np.ones(ratio.size), None
    effects = _standardised(shares.mean(axis=1) + shares.mean(axis=0))
    *effects, share = (
        np.interp(ratio, ALIGNMENT_RATIOS[known], row[known]) for row in (*effects, found)
    )
    return share, np.array(effects)


def _crossed(study, lines, count, levels):
    """Probability of each first line with each second one, shape (count, count, levels)."""
    shares = np.empty((count, count, levels.shape[1]))
    for begin in range(0, count, AT_ONCE):
        numbers = range(begin, min(begin + AT_ONCE, count))
        firsts = [draw_realisation(study.line_spec, study.seed, number)[0] for number in numbers]
        for other in range(count):
            _, second = draw_realisation(study.line_spec, study.seed, other)
            for number, first in zip(numbers, firsts, strict=True):
                shares[number, other] = _run(study, lines, (first, second), 0.0, levels)
        log.info("lines %d to %d, paired with all others: done", begin, numbers[-1])
    return shares
