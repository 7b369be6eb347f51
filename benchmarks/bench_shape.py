"""Contact under the computed film: its cost beside that of flat films and of the literal scan.

Beside them that of lines that the oil flattens.

    python benchmarks/bench_shape.py [STUDY] [REALISATIONS]

For the paper's study, if none is named, and 64 realisations:

- time for all operating points on all cores, flat and with the computed shape, and flat with lines
  that the oil flattens;
- time of one realisation at some points, by the literal scan of every window and by blocks of every
  few windows;
- scatter between realisations with fewer and fewer windows, over that with every window.
"""

import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
from literal import scan_trace

from lube.contact.rough_pair import roughness_batch
from lube.contact.window_films import window_films
from lube.contact.windows import WINDOWS_PER_WIDTH
from lube.grid.discretise import layer_factor_of, line_pair
from lube.grid.gap import Gap
from lube.kernels.shaped import shaped_statistics
from lube.schema import OPERATING_DIMS
from lube.stages.contact import contact_statistics
from lube.stages.film import film_table
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study

SHARE = 200
"""Part of a revolution that the literal scan reads: one in so many time steps."""
DENSITIES = (5, WINDOWS_PER_WIDTH, 20)
"""Windows per width of the contact."""


def prepared(study_file):
    """Load the study, and its table of computed films with their shape."""
    study = load_study(study_file)
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants[:1], grid.temperature)
    film = film_table(oil, study.rough_rollers, grid.force, grid.speed, ["computed"], True)
    return study, film.transpose(*OPERATING_DIMS, ...)


def print_ensemble(study, film, lines):
    """Time all operating points on all cores."""
    layer = study.boundary_layer
    for name, gap in (
        ("flat", Gap()),
        ("computed shape", Gap("computed")),
        ("flat, flattened lines", Gap("flat", "venner-1997")),
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
        films = one.film, np.array([0, one.film.size]), np.array([one.before])
        steps = pair[0].size
        found.append(
            shaped_statistics(pair, (1.0, 1.0), steps, np.array([windows]), films, factor)[0, 1]
        )
    return np.array(found)


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
            windows = -(-steps // max(1, (2 * half + 1) // density))
            found, passed = timed(partial(breakthroughs, pairs, one, windows, factor))
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


if __name__ == "__main__":
    main()
