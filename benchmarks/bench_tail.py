"""Importance sampling of rare contact: its stated errors, the ensemble beside it, its cost.

    python benchmarks/bench_tail.py [STUDY]    # some ten minutes on two cores

For the first film formula of a study (the paper's, if none is named):

- the stated standard error of each operating point against the scatter over seeds;
- the difference from an ensemble of a thousand realisations, where it sees enough contact: a
  chi-square of all points together. One realisation's lines serve all points, so these are strongly
  correlated;
- processor time and error against rarity, and the peak memory.

Both count pieces of contact that the window's edge cuts off, as the paper does: the same quantity.
"""

import multiprocessing
import os
import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import scipy.special
import scipy.stats

from lube.contact.rough_pair import roughness_batch
from lube.contact.windows import study_windows
from lube.grid.operating_points import at_slip
from lube.schema import OPERATING_DIMS
from lube.stages.contact import contact_statistics
from lube.stages.film import film_table
from lube.stages.tail import FEWER_PAIRS, PAIRS, make
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study
from lube.surfaces.rare_contact import draw_pair

PROBABILITIES = ("breakthrough_probability", "geometric_contact_probability")
SEEDS = 20
REALISATIONS = 1000
LEAST = 1e-4
"""Lowest probability at which the ensemble is held against."""
QUANTILE = scipy.special.stdtrit(PAIRS - 1, 0.975)
POINTS = 120
"""Operating points of one rarity together, repeated, whose time is taken."""
MAIN_DIRECTIONS = 1e-2
"""Least variance, over the mean one, of the directions in the second chi-square."""


def prepared(study_file):
    """Load the study, and its film table."""
    study = load_study(study_file)
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants[:1], grid.temperature)
    levels = grid.force, grid.speed, study.film_formulas
    film = film_table(oil, study.rough_rollers, *levels, **study.film_model)
    return study, at_slip(film).transpose(*OPERATING_DIMS, ...)


# Stated errors


def pairs_of_lines(study, film, seeds):
    """Importance sampling by single pairs, shape (seeds, pairs, probabilities, points)."""
    windows = study_windows(study, film)

    def one(seed, number):
        return windows.sample(study.line_spec, seed, number)[0][::-1]

    seeds, numbers = np.repeat(seeds, PAIRS), np.tile(range(PAIRS), len(seeds))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return np.array(list(pool.map(one, seeds, numbers))).reshape(-1, PAIRS, 2, windows.size)


def limits_of_stage(study, film):
    """Means and lower limits by the stage, shape (2, probabilities, points)."""
    tail = make(study, {"film": film}, os.cpu_count()).isel(slide_to_roll_ratio=0)
    return [[tail[name + end].values.ravel() for name in PROBABILITIES] for end in ("", "_lower")]


def scatter_ratios(values, errors):
    """Scatter of the values over the seeds, over the stated errors (root mean square)."""
    return np.std(values, axis=0, ddof=1) / np.sqrt(np.mean(errors**2, axis=0))


def print_errors(values, errors):
    """Compare the stated errors with the scatter over the seeds."""
    seeds = len(values)
    relative, ratios = errors / values, scatter_ratios(values, errors)
    chi = scipy.stats.chi2(seeds - 1)
    low, high = np.sqrt(chi.ppf([0.025, 0.975]) / (seeds - 1))
    # The mean over the seeds stands for the truth; its own error widens the deviations' scale.
    deviation = (values - values.mean(axis=0)) / errors / np.sqrt(1.0 - 1.0 / seeds)
    inside = np.abs(deviation) < QUANTILE
    for row, name in enumerate(PROBABILITIES):
        one, mean = ratios[row], values[:, row].mean(axis=0)
        print(f"{name}: {mean.size} points, {mean.max():.2g} to {mean.min():.1e}, {seeds} seeds")
        stated = 100.0 * relative[:, row]
        print(f"  stated standard error {stated.min():.2f} to {stated.max():.2f} %", end="")
        print(f", in the mean over the seeds at most {stated.mean(axis=0).max():.2f} %")
        print(f"  scatter over stated error {np.sqrt(np.mean(one**2)):.3f}", end="")
        print(
            f" ({one.min():.2f} to {one.max():.2f} by point; by chance {low:.2f} to {high:.2f} ",
            end="",
        )
        print(f"for 95 % of points, here {100 * np.mean((low < one) & (one < high)):.0f} %)")
        print(f"  the 95 % interval holds the mean in {100 * inside[:, row].mean():.1f} % of cases")


# The ensemble


def ensemble(study, film, realisations):
    """Probabilities of single realisations, shape (realisations, probabilities, points)."""

    def one(number):
        lines = roughness_batch(study.line_spec, study.seed, [number])
        found = contact_statistics(lines, film, study.boundary_layer, gap=study.gap)
        return [found[name].values.ravel() for name in PROBABILITIES]

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return np.array(list(pool.map(one, range(realisations))))


def chi_square(difference, covariance):
    """Squared length of a difference in units of its standard errors."""
    return float(difference @ np.linalg.solve(covariance, difference))


def hold_against(sampled, counted):
    """Compare means of two samples at several points, correlations included.

    Both covariances of the means come from their samples, of which there must be many more than
    points, so that nothing is shrunk. Hotelling's statistic allows for their being estimated: the
    larger sample counts. It does not depend on the points' scale, or on how strongly they are
    correlated. Differences of neighbouring points have almost no scatter, though, so the second
    chi-square is of the directions with much of it.

    Parameters
    ----------
    sampled, counted : tuple
        Means, shape (points,), the sample for their covariance, shape (number, points), and the
        number of values in the mean.

    Returns
    -------
    dict
        Chi-square, its directions and the probability of a larger one, of all directions and
        of those with most scatter.
    """
    difference = sampled[0] - counted[0]
    covariance = sum(np.cov(values.T) / number for _, values, number in (sampled, counted))
    scale = np.sqrt(np.diag(covariance))
    variance, direction = np.linalg.eigh(covariance / np.outer(scale, scale))
    squares = (direction.T @ (difference / scale)) ** 2 / variance
    degrees = len(counted[1]) - 1
    found = {"deviations": difference / scale}
    for name, least in (("all", 0.0), ("main", MAIN_DIRECTIONS)):
        kept = squares[variance > least]
        count = kept.size
        share = kept.sum() * (degrees - count + 1) / (degrees * count)
        larger = float(scipy.stats.f.sf(share, count, degrees - count + 1))
        found[name] = float(kept.sum()), count, larger
    return found


def print_held(pairs, counted):
    """Hold the first seed, and all seeds together, against the ensemble."""
    everyone = pairs.reshape(-1, *pairs.shape[2:])
    for row, name in enumerate(PROBABILITIES):
        often = everyone[:, row].mean(axis=0) > LEAST
        ensemble = counted[:, row][:, often]
        for title, sample in (("first seed", pairs[0]), ("all seeds", everyone)):
            chosen = sample[:, row][:, often]
            sampled = chosen.mean(axis=0), everyone[:, row][:, often], len(sample)
            found = hold_against(sampled, (ensemble.mean(axis=0), ensemble, len(ensemble)))
            deviations = found["deviations"]
            print(f"{name}, {title} ({len(sample)} pairs), {often.sum()} points:", end="")
            print(f" deviations {deviations.min():.2f} to {deviations.max():.2f} standard errors")
            for part, (chi, count, larger) in list(found.items())[1:]:
                print(f"  {part} directions: chi-square {chi:.1f} for {count}, ", end="")
                print(f"a larger one with probability {larger:.2f}", flush=True)


# Cost


def print_cost(study, film, values, errors):
    """Processor time of the sampling and stated error by decades of rarity."""
    spec, windows = study.line_spec, study_windows(study, film)
    widths = 2 * windows.half_windows + 1
    probability = values[:, 0].mean(axis=0)
    relative = np.sqrt(np.mean((errors[:, 0] / values[:, 0]) ** 2, axis=0))
    decade = np.floor(np.log10(probability) / 2.0).astype(int)
    draw_pair(spec, study.seed, 0)  # compiled, or loaded, before any measurement
    for one in np.unique(decade)[::-1]:
        here = np.resize(np.flatnonzero(decade == one), POINTS)
        times = []
        for number in range(4):
            begin = time.process_time()
            windows[here].sample(spec, study.seed, number)
            times.append(time.process_time() - begin)
        print(f"P from 1e{2 * one} to 1e{2 * one + 2}: {np.sum(decade == one)} points, ", end="")
        print(f"{np.mean(widths[here]):.0f} window points wide on average, ", end="")
        print(f"{1e3 * PAIRS * min(times) / POINTS:.0f} ms per point, ", end="")
        print(f"standard error {100 * relative[decade == one].mean():.2f} %", flush=True)


def _cost_of(study_file, formulas, threads):
    """Wall time (s), processor time (s) and peak memory (MiB), compiled before."""
    study, film = prepared(study_file)
    one = film.isel(film_formula=[0], temperature=[0], speed=[0], force=[0])
    make(study, {"film": one}, threads)
    begin, busy = time.perf_counter(), time.process_time()
    make(study, {"film": film.isel(film_formula=slice(formulas))}, threads)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return time.perf_counter() - begin, time.process_time() - busy, peak


def print_time(study_file):
    """Time and memory of the stage in a process of its own."""
    _, film = prepared(study_file)
    for formulas in sorted({1, film.sizes["film_formula"]}):
        for threads in (1, 2):
            with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
                wall, busy, peak = pool.submit(_cost_of, study_file, formulas, threads).result()
            pairs = f"{PAIRS} pairs" + (f", {FEWER_PAIRS} for others" if formulas > 1 else "")
            print(f"{formulas} formulas ({pairs}), {threads} threads: {wall:.1f} s, ", end="")
            print(f"{busy:.1f} s of processor time, {peak:.0f} MiB", flush=True)


def main(study_file="workflow/config/paper.yaml"):
    study, film = prepared(study_file)
    first = film.isel(film_formula=[0])
    print_time(study_file)
    pairs = pairs_of_lines(study, first, range(study.seed, study.seed + SEEDS))
    values = pairs.mean(axis=1)
    errors = np.std(pairs, axis=1, ddof=1) / np.sqrt(PAIRS)
    stated = np.minimum(values[0], 1.0), values[0] - QUANTILE * errors[0]
    np.testing.assert_allclose(limits_of_stage(study, first), stated, rtol=1e-9)
    print_errors(values, errors)
    print_cost(study, first, values, errors)
    print_held(pairs, ensemble(study, first, REALISATIONS))


if __name__ == "__main__":
    main(*sys.argv[1:])
