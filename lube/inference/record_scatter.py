r"""The scatter of a record's contact share between pairs of rollers.

The probability is a mean over all pairs of rollers; a record comes from one pair, and its share
deviates from that mean. The variance of the deviation depends on how the record sees the pair:

- *One alignment.* Equal rollers in pure rolling repeat themselves in each revolution. The variance
  is that between the realisations of the ensemble, and longer records do not reduce it.
- *Several alignments.* With slip, or rollers of different size, the two lines meet in a new
  alignment in each revolution. The joint effect of the two lines is then averaged out; the effect
  of each line alone, against any other line, persists.
- *Short records.* Less than one revolution shows only a part of the lines, and the parts differ
  more than the whole lines; so does the part of a slow or long line.
"""

import logging
from collections import deque

import numpy as np
import xarray as xr

from lube.contact.rough_pair import drawn
from lube.contact.windows import ContactWindows, study_windows
from lube.grid.discretise import revolution, speed_ratios
from lube.grid.gap import Gap
from lube.statistics.confidence import mean_over_first
from lube.statistics.line_effects import line_effects
from lube.statistics.one_pair import persistent_share, scatter_ratio
from lube.study.study import Study
from lube.surfaces.synthetic import LineSpecLike, draw_realisation
from lube.types import Array, Pair

log = logging.getLogger(__name__)

Data = xr.Dataset

MOST_PAIRS = 64
"""Largest number of pairs of lines that are run to estimate a scatter."""
SHAPED_PAIRS = 32
"""As `MOST_PAIRS`, if lines are paired crosswise under films with a shape, where each pairing takes
20 times as long."""
LINES_IN_MEMORY = 16
"""Number of first lines kept in memory while all second lines are drawn."""
PAIRINGS = 4
"""Number of second lines that each first line is paired with for the mean probability."""
MOST_STRETCHES = 8
"""Largest number of stretches of one realisation that serve as short records."""
MOST_TURNS = 8.0
"""Largest number of revolutions that are run for the slower line to pass wholly."""
ALIGNMENT_RATIOS = np.linspace(1.0, 3.75, 12)
"""Lambda ratios at which lines are paired crosswise; at higher ones contact is too rare. With fewer
levels interpolation would make the effects of single lines at neighbouring films too alike."""


def record_scatter(
    model: Data, experiment: Data, probability: Array, study: Study
) -> dict[str, Array]:
    """Scatter of the contact share of each record between pairs of rollers, and its mean.

    Parameters
    ----------
    model : xarray.Dataset
        Films at the records, from `lube.inference.at_records.film_at_records`.
    experiment : xarray.Dataset
        With the slide-to-roll ratio and the number of revolutions of each record.
    probability : numpy.ndarray
        Probability of each realisation in one revolution of pure rolling, shape (R, P); the P
        operating points are all records by the first film formula, by the second, and so on.
    study : Study
        Its rollers, roughness lines, boundary layer and drift.

    Returns
    -------
    dict of str to numpy.ndarray
        ``scatter_ratio``, variance of the record's share over that of one revolution of pure
        rolling, shape (P,).

        ``record_deviation``, deviation of each realisation in such a record, shape (R, P). They
        give the correlation between records; their size has no meaning. NaN for realisations
        beyond `MOST_PAIRS` where they were not run.

        ``pooled_probability``, mean over the realisations, shape (P,), and ``pooled_error``, its
        variance over that of the mean of R independent realisations. If records have several
        alignments, each first line is paired with several second lines for this mean: otherwise
        the error of the mean is a large part of the small scatter of such records.
    """
    windows = study_windows(study, model)
    formulas = windows.size // model.sizes["record"]
    slips = np.tile(experiment["slide_to_roll_ratio"].values, formulas)
    turns = np.tile(experiment["turns"].values, formulas)
    variance = _variance(probability)
    persistent, of_lines = _line_effects(model, study, slips, turns, len(probability))
    ratio, deviation = 1.0 / turns, probability - probability.mean(axis=0)
    runs = np.minimum(turns, [_whole_turns(study, slip) for slip in slips])
    for slip, run in sorted(set(zip(slips[turns >= 1.0], runs[turns >= 1.0], strict=True))):
        here = np.flatnonzero((slips == slip) & (runs == run))
        shares = _revolutions(study, windows[here], slip, run, probability[:, here])
        by_slip = _variance_ratio(_variance(shares), variance[here])
        alone, together = _components(study, slip, turns[here], persistent[:, here] / by_slip, run)
        ratio[here] = by_slip * (alone + together)
        if of_lines is not None:
            shares = combined_deviations(alone, together, of_lines[:, here], shares)
        deviation[: len(shares), here] = shares - shares.mean(axis=0)
        deviation[len(shares) :, here] = np.nan
    short = (turns < 1.0) & (variance > 0.0)
    scatter = _short_variance(study, windows[short], slips[short], turns[short], len(probability))
    ratio[short] = np.where(scatter > 0.0, scatter / variance[short], ratio[short])
    mean, error = mean_over_first(probability), np.ones(turns.size)
    if of_lines is not None and len(probability) <= MOST_PAIRS:
        mean, error = _pooled(study, windows, len(probability), mean, persistent)
    return {
        "scatter_ratio": ratio,
        "record_deviation": deviation,
        "pooled_probability": mean,
        "pooled_error": error,
    }


def _variance(shares):
    """Variance between realisations, shape (P,); 0 with a single realisation."""
    return shares.var(axis=0, ddof=1) if len(shares) > 1 else np.zeros(shares.shape[1])


# One alignment


def _whole_turns(study, slip):
    """Revolutions of the faster line in which all of either moving line passes; at least one."""
    points, ratios = np.array(study.line_spec.points), np.array(speed_ratios(slip))
    each = points[ratios > 0.0] / ratios[ratios > 0.0]
    return min(np.max(each) / points[np.argmax(ratios)], MOST_TURNS)


def _revolutions(study, windows, slip, turns, rolling):
    """Share of every realisation in some revolutions, shape (R, P)."""
    if slip == 0.0 and turns == 1.0:
        return rolling
    shares = np.empty((min(len(rolling), MOST_PAIRS), windows.size))
    for realisation, row in enumerate(shares):
        row[:] = windows.count(drawn(study, realisation), slip, turns)[:, 1]
        log.info("records with slip %g: realisation %d: done", slip, realisation)
    return shares


def _variance_ratio(slipping, rolling):
    """Variance of some turns over that of one in pure rolling, 1 where one of them is 0.

    Slip changes the alignment during the passage of a contact. So there are more and shorter
    contacts, and their share of time scatters less.
    """
    known = (rolling > 0.0) & (slipping > 0.0)
    return np.where(known, slipping / np.where(known, rolling, 1.0), 1.0)


# Several alignments


def _components(study, slip, turns, persistent, run):
    """Scatter ratios due to each line alone, and due to both together, shape (P,) each."""
    spec, drift = study.line_spec, study.rig.drift
    reach, ratios = spec.longest_wavelength / spec.spacing, speed_ratios(slip)
    alone, together = np.empty((2, turns.size))
    for point, (length, part) in enumerate(zip(turns, persistent.T, strict=True)):
        whole = scatter_ratio(length, ratios, spec.points, reach, part, drift, run)
        renewed = scatter_ratio(length, ratios, spec.points, reach, np.zeros(2), drift, run)
        together[point] = min(max(1.0 - np.sum(part), 0.0) * renewed, whole)
        alone[point] = whole - together[point]
    return alone, together


def combined_deviations(alone: Array, together: Array, of_lines: Array, shares: Array) -> Array:
    """Deviations of each realisation in records of several alignments, shape (R, P).

    The effect of each line alone is more alike at neighbouring films than the effect of both
    lines together. So the correlation between records depends on the size of the two parts: they
    are added here, each with its variance in such a record.

    Parameters
    ----------
    alone, together : numpy.ndarray
        Variance due to each line alone, and due to both together, shape (P,).
    of_lines : numpy.ndarray
        Effect of the lines alone, shape (R, P).
    shares : numpy.ndarray
        Shares in one revolution, which have both effects, shape (R, P) or more realisations.

    Returns
    -------
    numpy.ndarray
        Shape (R, P).
    """
    effects, shares = _standardised(of_lines), _standardised(shares[: len(of_lines)])
    rest = _standardised(shares - effects * np.mean(effects * shares, axis=0))
    return np.sqrt(alone) * effects + np.sqrt(together) * rest


def _standardised(values):
    """Values with mean 0 and variance 1 over the realisations, or all 0."""
    offsets = values - values.mean(axis=0)
    scale = offsets.std(axis=0)
    return offsets / np.where(scale > 0.0, scale, 1.0)


def _line_effects(model, study, slips, turns, realisations):
    """Part of the scatter that is due to each line alone, and persists in all alignments.

    If any record has several alignments, it is estimated from the ensemble's lines as drawn, paired
    crosswise.

    Returns
    -------
    share : numpy.ndarray
        This part over the variance in pure rolling, by either line, shape (2, P).
    effects : numpy.ndarray or None
        Effect of each realisation's lines, up to `MOST_PAIRS`, under films with a shape up to
        `SHAPED_PAIRS`, shape (R, P); None if none were run.
    """
    ratio = model["lambda_ratio"].values.ravel()
    equal = study.line_spec.points[0] == study.line_spec.points[1]
    one_alignment = equal and not slips.any()
    if one_alignment or not (turns > 1.0).any() or realisations < 2:
        return (np.zeros if one_alignment else np.ones)((2, ratio.size)), None
    most = SHAPED_PAIRS if study.gap.has_shape else MOST_PAIRS
    levels, windows = alignment_windows(model, study)
    count = min(realisations, most)
    in_first, in_second = crosswise(windows, study.line_spec, study.seed, count)
    persistent = persistent_share(in_first, in_second)
    known = np.isfinite(persistent).all(axis=0)
    if not known.any():
        return np.ones((2, ratio.size)), None
    effects = line_effects(in_first[..., known], in_second[..., known])
    rows = [np.interp(ratio, levels[known], row) for row in (*effects, *persistent[:, known])]
    return np.array(rows[-2:]), np.array(rows[:-2])


def alignment_windows(model: Data, study: Study) -> tuple[Array, ContactWindows]:
    """Find the contact windows in which lines are paired crosswise.

    They are flat, and as wide as the mean contact. If films have a shape, they are those of the
    records with the nearest lambda ratios, on lines as drawn: there single lines have about twice
    the effect.

    Parameters
    ----------
    model : xarray.Dataset
        Films at the records.
    study : Study
        Its roughness lines, boundary layer and gap.

    Returns
    -------
    ratios : numpy.ndarray
        Their lambda ratios, shape (P,), rising.
    windows : ContactWindows
        The P windows.
    """
    if not study.gap.has_shape:
        thickness = ALIGNMENT_RATIOS * model["composite_rms_roughness"].item()
        width = model["contact_half_width"].mean()
        films = {"film_thickness": ("level", thickness), "contact_half_width": width}
        films = model[["reduced_modulus"]].assign(films)
        return ALIGNMENT_RATIOS, ContactWindows(study.line_spec, films, study.boundary_layer)
    windows = ContactWindows(study.line_spec, model, study.boundary_layer, Gap(study.film_shape))
    ratios = np.where(windows.unknown, np.inf, model["lambda_ratio"].values.ravel())
    nearest = {int(np.argmin(np.abs(ratios - ratio))) for ratio in ALIGNMENT_RATIOS}
    nearest = sorted(nearest, key=ratios.__getitem__)
    return ratios[nearest], windows[nearest]


def _pooled(study, windows, count, mean, persistent):
    """Mean over several pairings of the lines, the first of them known, and its variance ratio."""
    pairings = min(PAIRINGS, count)
    shares, firsts = np.zeros(windows.size), deque(maxlen=pairings - 1)
    for number in range(count + pairings - 1):
        first, second = drawn(study, number % count)
        if number >= pairings - 1:
            shares += sum(windows.count((other, second))[:, 1] for other in firsts)
        firsts.append(first)
    log.info("each line paired with %d others: done", pairings - 1)
    mean = (mean + shares / count) / pairings
    kept = np.minimum(persistent.sum(axis=0), 1.0)
    return mean, kept + (1.0 - kept) / pairings


def crosswise(windows: ContactWindows, spec: LineSpecLike, seed: int, count: int) -> Pair:
    """Find the contact share of each of some first lines with each second line.

    Parameters
    ----------
    windows : ContactWindows
        Contact windows at P points.
    spec : LineSpecLike
        Parameters of the lines.
    seed : int
        Seed of the lines.
    count : int
        Number of lines of either roller, the first realisations.

    Returns
    -------
    in_first, in_second : numpy.ndarray
        Shape (count, count, P). The first is over a whole turn of the first line, the other over a
        whole turn of the second. In a turn of a line of another size, part of a line passes more
        often than the rest: this adds to the line's effect, but does not persist.
    """
    in_first, in_second = np.empty((2, count, count, windows.size))
    for begin in range(0, count, LINES_IN_MEMORY):
        numbers = range(begin, min(begin + LINES_IN_MEMORY, count))
        firsts = [draw_realisation(spec, seed, number)[0] for number in numbers]
        for other in range(count):
            _, second = draw_realisation(spec, seed, other)
            for number, first in zip(numbers, firsts, strict=True):
                shares = _shares_of_each((first, second), windows)
                in_first[number, other], in_second[number, other] = shares
        log.info("lines %d to %d, paired with all others: done", begin, numbers[-1])
    return in_first, in_second


def _shares_of_each(pair, windows):
    """Shares in a turn of the first and of the second line."""
    first, second = (line.size for line in pair)
    turns = 1.0, second / first
    begun = windows.count(pair, turns=min(turns))[:, 1]
    if first == second:
        return begun, begun
    shorter, longer = sorted((first, second))
    rest = windows.count(pair, turns=max(turns) - min(turns), begin=shorter)[:, 1]
    # Rounded to whole numbers of time steps again.
    whole = (np.rint(begun * shorter) + np.rint(rest * (longer - shorter))) / longer
    return (begun, whole) if first == shorter else (whole, begun)


# Short records


def _short_variance(study, windows, slips, turns, realisations):
    """Variance between the shares of records of less than one revolution, shape (P,).

    It is not in proportion to 1 / turns: a whole line has exactly the amplitudes of the study's
    spectrum, but a part of the line has not, so parts differ more. Therefore stretches of the
    ensemble's lines serve as records.
    """
    motions = sorted(set(zip(slips.tolist(), turns.tolist(), strict=True)))
    shares = {motion: [] for motion in motions}
    at = {motion: (slips == motion[0]) & (turns == motion[1]) for motion in motions}
    for realisation in range(min(realisations, MOST_PAIRS)) if motions else ():
        pair = drawn(study, realisation)
        for motion in motions:
            shares[motion] += _stretches(pair, *motion, windows[at[motion]])
        log.info("short records: realisation %d: done", realisation)
    variance = np.zeros(turns.size)
    for motion in motions:
        variance[at[motion]] = np.var(shares[motion], axis=0, ddof=1)
    return variance


def _stretches(pair, slip, turns, windows):
    """Shares of one pair in separate stretches of its lines, a list of arrays of shape (P,)."""
    count = min(int(1.0 / turns), MOST_STRETCHES)
    begins = np.arange(count) * revolution(pair, speed_ratios(slip)) // count
    return [windows.count(pair, slip, turns, begin)[:, 1] for begin in begins]
