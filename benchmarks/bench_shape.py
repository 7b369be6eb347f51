"""Contact under the computed film: its cost beside that of flat films and of the literal scan.

Beside them that of lines that the oil flattens by a formula, or answers by computation.

    python benchmarks/bench_shape.py [STUDY] [REALISATIONS]

For the paper's study, if none is named, and 64 realisations:

- time for all operating points on all cores, flat and with the computed shape, flat with lines that
  the oil flattens, and with the computed shape and answer;
- time of one realisation at some points, by the literal scan of every window and by blocks of every
  few windows;
- scatter between realisations with fewer and fewer windows, over that with every window;
- for lines that the oil answers, time beside a scan that builds the gap at every time step, and the
  probability with twice the windows and with half the error of the expansion, over the study's.
"""

import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
from literal import scan_trace, scan_window

from lube.contact import waves, windows
from lube.contact.rough_pair import roughness_batch
from lube.contact.window_films import window_films
from lube.contact.windows import WINDOWS_PER_WIDTH, ContactWindows
from lube.grid.discretise import layer_factor_of, line_pair
from lube.grid.gap import Gap
from lube.kernels.compiler import kernel
from lube.kernels.runs import BLOCK_SHIFT
from lube.kernels.shaped import Window, as_drawn, shaped_trace
from lube.schema import OPERATING_DIMS
from lube.stages.contact import contact_statistics
from lube.stages.film import film_table
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study

SHARE = 200
"""Part of a revolution that the literal scan reads: one in so many time steps."""
ANSWERED = Gap("computed", "computed")
DENSITIES = (5, WINDOWS_PER_WIDTH, 20)
"""Windows per width of the contact."""


def prepared(study_file):
    """Load the study, and its table of computed films with their shape."""
    study = load_study(study_file)
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants[:1], grid.temperature)
    levels = study.rough_rollers, grid.force, grid.speed, ["computed"], True
    film = film_table(oil, *levels, answered_lines=study.line_spec)
    return study, film.squeeze("slide_to_roll_ratio", drop=True).transpose(*OPERATING_DIMS, ...)


def print_ensemble(study, film, lines):
    """Time all operating points on all cores."""
    layer = study.boundary_layer
    for name, gap in (
        ("flat", Gap()),
        ("computed shape", Gap("computed")),
        ("flat, flattened lines", Gap("flat", "venner-1997")),
        ("computed shape and answer", ANSWERED),
    ):
        run = partial(contact_statistics, film=film, boundary_layer=layer, gap=gap)
        run(lines[0], film=film.isel(force=[0]))  # compile
        start = time.perf_counter(), time.process_time()
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(run, lines))
        passed = time.perf_counter() - start[0], time.process_time() - start[1]
        points = film["film_thickness"].size
        print(f"{name}: {points} points, {len(lines)} realisations: {passed[0]:.1f} s", end="")
        print(f" on {os.cpu_count()} cores, {passed[1]:.1f} s of processor time")


def points_often(film, count=5):
    """Operating points from frequent to rare contact, as films of one point each."""
    order = np.argsort(film["lambda_ratio"].values.ravel())[: film["film_thickness"].size // 2]
    chosen = order[np.linspace(0, order.size - 1, count).astype(int)]
    for flat in chosen:
        index = np.unravel_index(flat, film["film_thickness"].shape)
        yield film.isel(
            {dim: [i] for dim, i in zip(film["film_thickness"].dims, index, strict=True)}
        )


def breakthroughs(pairs, film, windows, factor):
    """Breakthrough probability of each realisation at one operating point, from some windows."""
    found = []
    for pair in pairs:
        one = film.below(pair[0].max())
        window = Window(one.film[None], one.before, BLOCK_SHIFT)
        surfaces = tuple(as_drawn(line) for line in pair)
        run = (1.0, 1.0), pair[0].size, windows, window, np.array([factor])
        found.append(np.mean(shaped_trace(surfaces, *run)[0, :, 1] > 0))
    return np.array(found)


@kernel
def scan_of_built_gaps(line, filtered, shapes, film, before, factor, share):
    """Build the gap at every point of every window, and scan it: one of so many time steps."""
    broken, still = 0, np.zeros(film.size, np.int32)
    rough = np.empty(film.size, np.int32)
    for step in range(0, line.size, share):
        for point in range(film.size):
            at, answer = (step - before + point) % line.size, 0.0
            for m in range(shapes.shape[1]):
                answer += shapes[point, m] * filtered[at, m]
            rough[point] = line[at] + np.int32(np.rint(answer))
        broken += scan_window((rough, still), 0, 0, film, factor)[1] > 0
    return broken / (line.size // share)


def built_gaps(study, table, pair):
    """Arguments of `scan_of_built_gaps` at an operating point, with all that it can prepare."""
    spec, line = study.line_spec, sum(pair)
    one, answer = window_films(table, spec)[0], waves.answers_at(table, True).values.flat[0]
    reached = one.below(2.0 * line.max())
    points = np.arange(reached.film.size)
    position = (reached.before - points) * spec.spacing / answer.half_width
    coarse = waves.Waves(line, spec).filtered(answer)
    at = np.arange(line.size) * ((len(coarse) - 1) / line.size)
    filtered = np.array([np.interp(at, np.arange(len(coarse)), row) for row in coarse.T]).T
    return line, np.ascontiguousarray(filtered), answer.at(position), reached.film, reached.before


def print_answered(study, film, pairs):
    """Speed where the oil answers the lines, and what finer windows and expansions change."""
    layer, spec = study.boundary_layer, study.line_spec
    factor = layer_factor_of(spec, film["reduced_modulus"].item(), layer)
    settings = windows.WINDOWS_PER_WIDTH, waves.PRECISION
    finer = (2 * settings[0], settings[1]), (settings[0], settings[1] / 2.0)
    for table in points_often(film):

        def counted(density, precision, table=table):
            windows.WINDOWS_PER_WIDTH, waves.PRECISION = density, precision
            contact = ContactWindows(spec, table, layer, ANSWERED)
            return np.array([contact.count(pair)[0, 1] for pair in pairs])

        scan = partial(scan_of_built_gaps, *built_gaps(study, table, pairs[0]), factor, SHARE)
        literal, passed = timed(scan)
        own, fast = timed(partial(counted, *settings))
        print(f"lambda ratio {table['lambda_ratio'].item():.2f}: P = {own.mean():.2g}", end="")
        print(f"; {passed * SHARE * len(pairs) / fast:.0f} times faster than the built gap", end="")
        print(f" ({literal:.2g} on one pair, here {own[0]:.2g})", end="")
        for what, changed in zip(("windows", "exactness"), finer, strict=True):
            again = counted(*changed)
            error = np.std(again - own, ddof=1) / len(pairs) ** 0.5 / own.mean()
            ratio = again.mean() / own.mean()
            print(f"; twice the {what}: {ratio:.3f} +- {error:.3f}", end="")
        print(flush=True)
    windows.WINDOWS_PER_WIDTH, waves.PRECISION = settings


def print_points(study, film, lines):
    """Speed over the literal scan, and scatter over that of every window, point by point."""
    factor = layer_factor_of(study.line_spec, film["reduced_modulus"].item(), study.boundary_layer)
    zero = np.zeros(1, np.int32)
    pairs = [(sum(line_pair(one, one["realisation"].values[0])), zero) for one in lines]
    steps = pairs[0][0].size
    for table in points_often(film):
        (one,) = window_films(table, study.line_spec)
        half = int(table["contact_half_width"].item() / study.line_spec.spacing)
        reached = one.below(pairs[0][0].max())
        literal = (1.0, 1.0), steps // SHARE, reached.film, reached.before, factor
        _, passed = timed(partial(scan_trace, pairs[0], *literal))
        literal = passed * SHARE
        every = breakthroughs(pairs, one, steps, factor)
        print(f"lambda ratio {table['lambda_ratio'].item():.2f}: P = {every.mean():.2g}", end="")
        for density in DENSITIES:
            number = -(-steps // max(1, (2 * half + 1) // density))
            found, passed = timed(partial(breakthroughs, pairs, one, number, factor))
            scatter = found.std(ddof=1) / every.std(ddof=1)
            speed = literal / (passed / len(pairs))
            print(f"; {density} windows: {speed:.0f} times faster, scatter {scatter:.3f}", end="")
        print(flush=True)


def timed(run):
    """Run and return its result and processor time, s; once before, to compile."""
    run()
    start = time.process_time()
    return run(), time.process_time() - start


def main():
    """Print all figures."""
    study_file = sys.argv[1] if len(sys.argv) > 1 else "workflow/config/paper.yaml"
    study, film = prepared(study_file)
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 64
    lines = [roughness_batch(study.line_spec, study.seed, [number]) for number in range(count)]
    print_ensemble(study, film, lines)
    print_points(study, film, lines)
    print_answered(study, film, [line_pair(one, one["realisation"].values[0]) for one in lines])


if __name__ == "__main__":
    main()
