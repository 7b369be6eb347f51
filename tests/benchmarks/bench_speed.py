"""How fast the study is, beside the plain versions of the same work in the same run.

    python tests/benchmarks/bench_speed.py

Times of a shared machine mean little by themselves; the ratios do. Each figure is the best of
several runs, the two sides taking turns.
"""

import time

import numpy as np
import scipy.fft

from lube.film import film_table
from lube.kernels.layer import layer_factor
from lube.kernels.rolling import composite_line, rolling_statistics
from lube.kernels.scan import scan_statistics
from lube.lubricant import lubricant_table
from lube.roughness import draw_line, draw_realisation
from lube.study import load_study

SCAN_SHARE = 50
"""The literal scan runs over this fraction of a revolution; its cost is linear in the steps."""


def best_times(*sides, runs=5):
    """Shortest time of each function, taking turns, after one run to compile and warm up."""
    for side in sides:
        side()
    times = np.full((runs, len(sides)), np.inf)
    for run in range(runs):
        for number, side in enumerate(sides):
            begin = time.perf_counter()
            side()
            times[run, number] = time.perf_counter() - begin
    return times.min(axis=0)


def paper_points(study):
    """Films and half-windows of the paper's 125 operating points, and the layer's factor."""
    grid, spec = study.operating_grid, study.line_spec
    oil = lubricant_table(study.lubricants, grid.temperature)
    film = film_table(oil, study.rollers, grid.force, grid.speed, ["paper"])
    thickness, half_width = np.broadcast_arrays(film.film_thickness, film.contact_half_width)
    films = np.rint(thickness.ravel() / spec.height_step).astype(np.int64)
    half_windows = np.floor(half_width.ravel() / spec.spacing).astype(np.int64)
    factor = layer_factor(
        study.rollers.reduced_modulus,
        study.boundary_layer.critical_thickness,
        study.boundary_layer.shear_strength,
        spec.spacing,
        spec.height_step,
    )
    return films, half_windows, factor


def bench_contact(study):
    """The O(N) method against the compiled literal scan, one realisation, 125 points."""
    pair = draw_realisation(study.line_spec, study.seed, 0)
    films, half_windows, factor = paper_points(study)
    steps, margin = pair[0].size, int(half_windows.max())

    def rolling():
        line = composite_line(*pair, steps, margin)
        return rolling_statistics(line, margin, films, half_windows, factor)

    def scan():
        part = steps // SCAN_SHARE
        return scan_statistics(*pair, (1.0, 1.0), part, films, half_windows, factor)

    fast, slow = best_times(rolling, scan, runs=3)
    slow *= SCAN_SHARE
    print(f"contact, {films.size} points of {steps} steps:")
    print(f"  literal scan {slow:8.2f} s   (1/{SCAN_SHARE} of the revolution, times {SCAN_SHARE})")
    print(f"  O(N) method  {fast:8.4f} s   {slow / fast:.0f} times faster")


def bench_synthesis(study):
    """Drawing one line against a bare single-precision inverse FFT of its size."""
    spec = study.line_spec
    seed = np.random.SeedSequence(1)
    waves = np.zeros(spec.points[0] // 2 + 1, np.complex64)
    waves[1:100] = 1.0
    line, fft = best_times(
        lambda: draw_line(spec, 0, seed), lambda: scipy.fft.irfft(waves, spec.points[0]), runs=15
    )
    print(f"synthesis of one line of {spec.points[0]} points:")
    print(f"  bare inverse FFT {1e3 * fft:6.2f} ms")
    print(f"  whole line       {1e3 * line:6.2f} ms   {line / fft:.2f} times the FFT")


if __name__ == "__main__":
    paper = load_study("workflow/config/paper.yaml")
    bench_contact(paper)
    bench_synthesis(paper)
