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
from lube.kernels.scan import scan_statistics
from lube.kernels.strips import strip_statistics
from lube.lubricant import lubricant_table
from lube.roughness import draw_line, draw_realisation
from lube.steps import revolution, speed_ratios
from lube.study import load_study

SCAN_SHARE = 50
"""The literal scan runs over 1/50 of a revolution; its cost is linear in the steps."""


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


def bench_contact(study, slide_to_roll_ratio, least_lambda=0.0):
    """The strips against the compiled literal scan, one realisation, many points."""
    pair = draw_realisation(study.line_spec, study.seed, 0)
    films, half_windows, factor = paper_points(study)
    composite = study.rollers.composite_rms_roughness / study.roughness.height_step
    chosen = films >= least_lambda * composite
    films, half_windows = films[chosen], half_windows[chosen]
    ratios = speed_ratios(slide_to_roll_ratio)
    steps = revolution(pair, ratios)
    # Slip costs the strips more, and is as linear in the steps.
    share = 1 if slide_to_roll_ratio == 0.0 else SCAN_SHARE

    def strips():
        return strip_statistics(*pair, ratios, steps // share, films, half_windows, factor)

    def scan():
        part = steps // SCAN_SHARE
        return scan_statistics(*pair, ratios, part, films, half_windows, factor)

    fast, slow = best_times(strips, scan, runs=2) * (share, SCAN_SHARE)
    print(
        f"slide-to-roll ratio {slide_to_roll_ratio:g}, {films.size:3d} points"
        f"{f' of lambda above {least_lambda:g}' if least_lambda else ''}: "
        f"scan {slow:.1f} s, strips {fast:.3f} s, {slow / fast:.0f} times faster"
    )


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
    bench_synthesis(paper)
    bench_contact(paper, 0.0)
    for slip in (0.01, 0.1, 0.5, 1.0, 2.0):
        bench_contact(paper, slip)
        bench_contact(paper, slip, least_lambda=3.0)
