"""Speed of the study beside plain versions of the same work, in the same run.

    snakemake benchmark                                        # measures, saves and draws
    python benchmarks/bench_speed.py [STUDY [SPEED.NC]]  # measures and prints

On a shared machine only the ratios of times are meaningful. Each time is the shortest of several
runs; the sides of a ratio run alternately.
"""

import functools
import multiprocessing
import os
import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
import scipy.fft
import xarray as xr
from literal import scan_trace

from lube.grid.discretise import revolution, speed_ratios
from lube.kernels.layer import layer_factor
from lube.kernels.strips import strip_statistics
from lube.schema import label
from lube.stages.film import film_table
from lube.storage.netcdf import save
from lube.study.oil_properties import lubricant_table
from lube.study.roller_lines import line_spec
from lube.study.study import load_study
from lube.surfaces.synthetic import draw_line, draw_realisation

SLIPS = (0.0, 0.01, 0.1, 0.5, 1.0, 2.0)
LEAST_LAMBDAS = (0.0, 3.0)
SCAN_SHARE = 50
"""The literal scan runs over 1/50 of a revolution; its cost is linear in the steps."""

FINER_GRIDS = (1, 2, 4, 8)
OPERATING_POINTS = (1, 8, 25, 125, 500)
REALISATIONS = (125, 250, 500, 1000)


def best_times(*sides, runs):
    """Shortest time of each function, run alternately."""
    times = np.empty((runs, len(sides)))
    for run in range(runs):
        for number, side in enumerate(sides):
            begin = time.perf_counter()
            side()
            times[run, number] = time.perf_counter() - begin
    return times.min(axis=0)


def points_of(study, spec):
    """Films and half-windows of a study's operating points, thinnest first, and the factor."""
    grid, layer = study.operating_grid, study.boundary_layer
    oil = lubricant_table(study.lubricants[:1], grid.temperature)
    film = film_table(oil, study.rollers, grid.force, grid.speed, study.film_formulas[:1])
    thickness, half_width = np.broadcast_arrays(film.film_thickness, film.contact_half_width)
    order = np.argsort(thickness, axis=None)
    films = np.rint(thickness.ravel()[order] / spec.height_step).astype(np.int64)
    half_windows = np.floor(half_width.ravel()[order] / spec.spacing).astype(np.int64)
    factor = layer_factor(
        study.rollers.reduced_modulus,
        layer.critical_thickness,
        layer.shear_strength,
        spec.spacing,
        spec.height_step,
    )
    return films, half_windows, factor


def literal_scan(pair, ratios, steps, films, half_windows, factor):
    """Scan every window of all operating points."""
    for film, half_window in zip(films, half_windows, strict=True):
        window = np.full(2 * half_window + 1, film)
        scan_trace(pair, ratios, steps, window, half_window, factor)


def measure_slip(study):
    """Measure the strips against the compiled literal scan, one realisation, at several slips."""
    spec = study.line_spec
    pair = draw_realisation(spec, study.seed, 0)
    films, half_windows, factor = points_of(study, spec)
    ratio = films * spec.height_step / study.rollers.composite_rms_roughness
    times = np.full((2, len(LEAST_LAMBDAS), len(SLIPS)), np.nan)
    counts = [np.count_nonzero(ratio >= least) for least in LEAST_LAMBDAS]
    for row, count in enumerate(counts):
        for column, slip in enumerate(SLIPS if count else ()):
            ratios = speed_ratios(slip)
            steps = revolution(pair, ratios)
            chosen = films[-count:], half_windows[-count:], factor  # the thickest
            strips = partial(strip_statistics, pair, ratios, steps, *chosen)
            scan = partial(literal_scan, pair, ratios, steps // SCAN_SHARE, *chosen)
            fast, slow = best_times(strips, scan, runs=2) * (1, SCAN_SHARE)
            times[:, row, column] = fast, slow
            print(
                f"slide-to-roll ratio {slip:<4g} {count:3d} points of lambda > "
                f"{LEAST_LAMBDAS[row]:g}: scan {slow:6.1f} s, strips {fast:7.3f} s, "
                f"{slow / fast:.0f} times faster",
                flush=True,
            )
    dims = ("least_lambda", "slide_to_roll_ratio")
    return {
        "points_above": ("least_lambda", np.array(counts)),
        "strip_time": (dims, times[0]),
        "scan_time": (dims, times[1]),
        "speedup": (dims, times[1] / times[0]),
        "least_lambda": np.array(LEAST_LAMBDAS),
        "slide_to_roll_ratio": np.array(SLIPS),
    }


def measure_synthesis(study):
    """Measure the drawing of a line against its FFT alone, and against reading it once."""
    spec = study.line_spec
    points, seed = spec.points[0], np.random.SeedSequence(1)
    waves = np.zeros(points // 2 + 1, np.complex64)
    waves[1:100] = 1.0
    drawn, fft, read = best_times(
        lambda: draw_line(spec, 0, seed),
        lambda: scipy.fft.irfft(waves, points),
        np.ones(points, np.int32).max,
        runs=15,
    )
    print(
        f"line of {points} points: bare inverse FFT {1e3 * fft:.2f} ms, "
        f"whole line {1e3 * drawn:.2f} ms, {drawn / fft:.2f} times as long"
    )
    return {"line_time": drawn, "transform_time": fft, "reading_time": read}


def measure_realisation(study, spec, films, half_windows, factor, realisation=0):
    """Draw one realisation, and run all operating points in pure rolling."""
    pair = draw_realisation(spec, study.seed, realisation)
    ratios = speed_ratios(0.0)
    return strip_statistics(pair, ratios, pair[0].size, films, half_windows, factor)


def measure_grids(study):
    """Measure the cost of a realisation against the number of points around the roller."""
    times = []
    for finer in FINER_GRIDS:
        finer_roughness = study.roughness.model_copy(
            update={"points": study.roughness.points * finer}
        )
        spec = line_spec(study.rollers, finer_roughness, max(study.operating_grid.force))
        run = partial(measure_realisation, study, spec, *points_of(study, spec))
        times.append(best_times(run, runs=3)[0])
        print(f"realisation of {spec.points[0]:8d} points: {1e3 * times[-1]:.1f} ms", flush=True)
    counts = study.roughness.points * np.array(FINER_GRIDS)
    return {"grid_time": ("line_points", times), "line_points": counts}


def measure_operating_points(study):
    """Measure the cost of the contact runs against the number of operating points."""
    pair = draw_realisation(study.line_spec, study.seed, 0)
    films, half_windows, factor = points_of(study, study.line_spec)
    times = []
    for count in OPERATING_POINTS:
        # Spread evenly over the study's own films, interpolated between them.
        index = (np.arange(count) + 0.5) / count * films.size - 0.5
        chosen = [np.interp(index, range(films.size), of) for of in (films, half_windows)]
        chosen = [np.rint(values).astype(np.int64) for values in chosen]
        steps = pair[0].size
        run = partial(strip_statistics, pair, speed_ratios(0.0), steps, *chosen, factor)
        times.append(best_times(run, runs=5)[0])
        print(f"{count:3d} operating points: {1e3 * times[-1]:.1f} ms", flush=True)
    counts = np.array(OPERATING_POINTS)
    return {"operating_points_time": ("operating_points", times), "operating_points": counts}


@functools.cache
def _prepared(study_file):
    """Load the study and its operating points, once in each process."""
    study = load_study(study_file)
    return study, points_of(study, study.line_spec)


def _run_one(study_file, realisation):
    """Run one realisation in a process of a pool; return that process's peak memory, bytes."""
    study, points = _prepared(study_file)
    measure_realisation(study, study.line_spec, *points, realisation)
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def measure_ensemble(study_file):
    """Measure synthesis and contact of up to a thousand realisations, on all cores."""
    cores, times, memory = os.cpu_count(), [], 0
    with ProcessPoolExecutor(cores, multiprocessing.get_context("spawn")) as pool:
        run = partial(_run_one, study_file)
        list(pool.map(run, [0] * 4 * cores))  # starts the processes and loads the kernels
        for count in REALISATIONS:
            begin = time.perf_counter()
            memory = max(memory, *pool.map(run, range(count), chunksize=5))
            times.append(time.perf_counter() - begin)
            print(f"{count:4d} realisations on {cores} cores: {times[-1]:.1f} s", flush=True)
    print(f"peak memory of a process: {memory / 2**20:.0f} MiB")
    return {
        "ensemble_time": ("realisations", times),
        "realisations": np.array(REALISATIONS),
        "processes": cores,
        "peak_memory": float(memory),
    }


def measure(study_file):
    """Measure everything, as the ``speed`` file of `lube.schema`."""
    study, (films, half_windows, factor) = _prepared(study_file)
    # Compiled, or loaded, before any measurement.
    pair = draw_realisation(study.line_spec, study.seed, 0)
    for kernel in (strip_statistics, literal_scan):
        for slip in (0.0, 1.0):
            kernel(pair, speed_ratios(slip), 10, films, half_windows, factor)
    parts = (
        measure_synthesis(study),
        measure_slip(study),
        measure_grids(study),
        measure_operating_points(study),
        measure_ensemble(study_file),
    )
    dataset = xr.Dataset({name: values for part in parts for name, values in part.items()})
    coords = list(dataset.dims)
    return label(dataset.set_coords(coords), "speed")


if __name__ == "__main__":
    study_file, *output = sys.argv[1:] or ["workflow/config/paper.yaml"]
    speed = measure(study_file)
    if output:
        save(speed, output[0], "speed", load_study(study_file))
