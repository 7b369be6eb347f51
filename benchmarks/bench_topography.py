"""Time and memory of reading and reducing a measured map, and the error of a profile's inversion.

    PYTHONPATH=tests python benchmarks/bench_topography.py [POINTS]

Writes an X3P file of POINTS x POINTS heights (4096 by default) with holes to a folder that is
deleted, and reads, prepares and reduces it in a fresh process.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from example_surface import rolled_off_surface

from lube.study.topography_files import read_topography
from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.spectrum_table import power_law_integral
from lube.surfaces.surface_statistics import height_distribution
from lube.surfaces.topography import Preparation, Topography, prepare
from profiles import profile_of_line, rms_height

SPACING = 0.2e-6
PROFILES = 40


def write_map(path, points):
    import SurfaceTopography

    generator = np.random.default_rng(1)
    heights = rolled_off_surface(points, points * SPACING, 0.8, 50e-6, 0.2e-6, generator)
    for row, column in generator.integers(0, points - 40, (50, 2)):
        heights[row : row + 40, column : column + 30] = np.nan
    size = (points * SPACING,) * 2
    surface = SurfaceTopography.Topography(np.ma.masked_invalid(heights), size, unit="m")
    surface.to_x3p(str(path), dtype="I")


def reduce_map(path):
    begin = time.perf_counter()
    settings = Preparation("isotropic", "curvature", 80e-6, 0.8e-6, "interpolate")
    measured = read_topography(path)
    read = time.perf_counter()
    surface = prepare(measured, settings)
    del measured
    prepared = time.perf_counter()
    spectrum = line_spectrum(surface, settings)
    reduced = time.perf_counter()
    height_distribution(surface.heights)
    end = time.perf_counter()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"read {read - begin:.1f} s, prepared {prepared - read:.1f} s, spectrum ", end="")
    print(f"{reduced - prepared:.1f} s, distribution {end - reduced:.1f} s, ", end="")
    print(f"in all {end - begin:.1f} s and {peak:.2f} GB; rms {rms_height(spectrum):.4g} m")


def inversion_errors():
    """Mean and scatter of the inverted density over the true one, of profiles of 4 mm."""
    points, spacing = 8000, 0.5e-6
    settings = Preparation("isotropic")
    for hurst in (0.5, 0.7, 0.9):
        wave_vector = np.geomspace(1e2, 1e8, 3000)
        shape = wave_vector * np.maximum(wave_vector * 100e-6 / (2 * np.pi), 1.0) ** (
            -2 * hurst - 2
        )
        line = 0.04e-12 * shape / power_law_integral(wave_vector, shape)
        length = 8 * points * spacing
        waves = 2 * np.pi / length * np.arange(1, 4 * points)
        profile = np.interp(waves, wave_vector, profile_of_line(wave_vector, line))
        ratios, rms = [], []
        for seed in range(PROFILES):
            normal = np.random.default_rng(seed).standard_normal((waves.size, 2)) @ [1.0, 1.0j]
            amplitudes = np.sqrt(profile * waves[0] / 4) * normal
            heights = np.fft.irfft(np.append(0, amplitudes), 8 * points, norm="forward")[:points]
            cut = prepare(Topography("profile", heights, (spacing,)), settings)
            spectrum = line_spectrum(cut, settings)
            true = np.interp(spectrum.wave_vector, wave_vector, line)
            ratios.append(spectrum.density / true)
            rms.append(
                rms_height(spectrum) / np.sqrt(power_law_integral(spectrum.wave_vector, true))
            )
        mean, scatter = np.mean(ratios, axis=0), np.std(ratios, axis=0)
        pick = np.linspace(0, mean.size - 1, 8).astype(int)
        print(f"H = {hurst}: rms ratio {np.mean(rms):.3f} +- {np.std(rms):.3f}")
        for number in pick:
            stated = 1 / np.sqrt(spectrum.estimates[number])
            wavelength = 2e6 * np.pi / spectrum.wave_vector[number]
            print(f"  {wavelength:8.2f} um: {mean[number]:.3f} +- {scatter[number]:.3f}, ", end="")
            print(f"stated {stated:.3f}")


if __name__ == "__main__":
    if len(sys.argv) == 3:
        reduce_map(sys.argv[2])
    else:
        inversion_errors()
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "map.x3p"
            write_map(file, int(sys.argv[1]) if len(sys.argv) == 2 else 4096)
            subprocess.run([sys.executable, __file__, "--reduce", file], check=True)
