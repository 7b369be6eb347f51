r"""Spectrum of a measured topography: the density of the line that stands for it.

A line's density :math:`C(q)` is one-sided over the angular wave vector, and its integral is the
mean square height. It is

- of a map of an isotropic surface: :math:`C = 2 \pi q\, C_{2D}(q)`, where :math:`C_{2D}` is the
  mean over all directions and its integral over the plane of wave vectors is the mean square
  height (in the two-sided convention, :math:`C_{1D} = \pi q\, C_{2D}`);
- of a profile cut from an isotropic surface: the Abel inversion of the profile's density;
- of a map of a surface with a lay: the density of the isotropic surface of which it is a stretched
  one, see `lube.surfaces.lay`;
- of a surface taken along rolling, such as a ground one: the density of its profiles along
  rolling.

Library conventions: SurfaceTopography's densities ``power_spectrum_from_profile`` and
``power_spectrum_from_area`` are two-sided; the mean square height is :math:`1/\pi` times the
integral of the first over :math:`q > 0`, and :math:`1/(2\pi)` times that of :math:`q` times the
second.

Heights are seen through a Hann window (`lube.surfaces.measured_waves`). It gives the middle more
weight than the edges, so that the mean square height of the spectrum differs from that of the
measured heights by chance. The difference is spread over the densities in proportion to their
variance. The few long waves take most of it; the short ones, which are known much better than the
rms height, hardly change.
This is done only after a filter of long waves: without one the rms height is that of the measured
length, which no spectrum of shorter waves can have. In both cases the table has the power of the
waves it is made of, although interpolating the logarithm between scattered values lowers it.
"""

import math

import numpy as np

from lube.errors import DataError
from lube.surfaces.abel import line_of_profile, monotone
from lube.surfaces.lay import unstretched
from lube.surfaces.lay_of_map import lay_of_map
from lube.surfaces.measured_waves import (
    LEAST_WAVES,
    anisotropy,
    map_power,
    profile_density,
    sums_by_bin,
    wave_vectors,
)
from lube.surfaces.spectrum_table import LineSpectrum, with_power
from lube.surfaces.topography import Preparation, Topography, power_transfer, used_directions

LEAST_POINTS_PER_WAVE = 4
"""A wave of fewer points is left out: waves too short for the grid are taken for longer ones, which
adds a twelfth to the density here (H = 0.7), and doubles it at two points a wave."""

BINS_PER_DECADE_INVERTED = 4
"""The Abel inversion takes slopes of a profile's density, whose scatter grows as bins become
narrower. With this width the mean over 40 profiles, each 40 roll-offs long, at H = 0.5, 0.7 and
0.9, is within 3 % of the true density at a third of the roll-off and shorter, 8 to 10 % too low at
the roll-off, and 20 to 70 % too high at two to five times the roll-off, where the line has little;
the rms height is 2 % too high. See ``benchmarks/bench_topography.py``."""

MOST_ANISOTROPY = 0.3
"""Largest `anisotropy` of a surface that counts as isotropic. At H = 0.8 this is a surface whose
asperities are 1.4 times longer than wide; its profiles along both axes differ by the factor 1.7
in density, so that either is within 15 % of the mean in rms height. Scratches five times longer
than wide have 0.9."""

LEAST_RMS_HEIGHT = 1e-13
"""Least rms height, m, a thousandth of an atom: smoother heights are rounding errors."""

_BLUR = 1.0 + 2.0 * ((2.0 / 3.0) ** 2 + (1.0 / 6.0) ** 2)
"""Variance of a mean over neighbouring waves, over that without a Hann window."""

_REPLICATES = 100


def line_spectrum(surface: Topography, settings: Preparation) -> LineSpectrum:
    """Compute the density of the line that stands for a surface.

    Parameters
    ----------
    surface : Topography
        As `lube.surfaces.topography.prepare` returns it.
    settings : Preparation
        Settings with which it was prepared.

    Returns
    -------
    LineSpectrum
        The density of waves from half the measured length down to four points a wave, the
        instrument's resolution or the cutoff of short waves, whichever is longest.

    Raises
    ------
    DataError
        If the surface is flat, too small, or not as isotropic as the settings say.
    """
    finest = LEAST_POINTS_PER_WAVE * max(used_directions(surface.spacing, settings))
    shortest = max(finest, surface.resolution, settings.short_cutoff or 0.0)
    cutoffs = settings.long_cutoff, settings.short_cutoff
    of_surface, lay = settings.texture != "along rolling", (1.0, 90.0)
    mean_square = np.mean(np.square(surface.heights))
    if mean_square < LEAST_RMS_HEIGHT**2:
        raise DataError(f"{surface.name}: got heights that are all alike, need rough ones")
    if surface.heights.ndim == 1:
        if settings.texture == "lay":
            raise DataError(f"{surface.name}: got a profile, need a map for the texture `lay`")
        bins = _profile_bins(surface, 2.0 * np.pi / shortest)
    else:
        *bins, lay = _map_bins(surface, 2.0 * np.pi / shortest, settings.texture, cutoffs)
    wave_vector, density, estimates, inside, windowed = bins
    if wave_vector.size < 3 or not np.all(density > 0.0):
        raise DataError(f"{surface.name}: its spectrum is empty, need rough heights on more points")
    whole = windowed if settings.long_cutoff is None else mean_square
    density = with_power(wave_vector, density, estimates, whole - (windowed - inside))
    transfer = power_transfer(wave_vector, *cutoffs)
    if lay[0] > 1.0:
        transfer = _ring_transfer(surface, 2.0 * np.pi / shortest, cutoffs, lay)
    if of_surface and surface.heights.ndim == 1:
        # A profile's filter acts on the profile, a surface's on the surface.
        density, estimates = _inverted(wave_vector, density / transfer, estimates)
        density = density * transfer
    length = min(used_directions(surface.lengths, settings))
    limits = min(2.0 * np.pi * LEAST_WAVES / length, wave_vector[0]), 2.0 * np.pi / shortest
    return LineSpectrum(
        surface.name, wave_vector, density, estimates, transfer, of_surface, limits, *lay
    )


def _profile_bins(surface, q_max):
    """Means of a profile's density over bins, and the number of independent estimates."""
    wave_vector, density = profile_density(surface.heights, surface.spacing[0])
    sums = sums_by_bin(wave_vector, surface.lengths[0], q_max)
    counts, total, places = map(sums, (None, density, wave_vector**-2.0))
    # The wave vector at which a power law of the exponent -2 has its mean over the bin.
    middle, estimates = (places / counts) ** -0.5, np.maximum(counts / _BLUR, 1.0)
    powers = (np.sum(part) * wave_vector[0] for part in (total, density))
    return middle, total / counts, estimates, *powers


def _map_bins(surface, q_max, texture, cutoffs):
    """Means over rings of a map's waves, or over its waves of equal wave vector along rolling.

    The last value is the ratio and the angle of the lay.
    """
    power, lay = map_power(surface.heights), (1.0, 90.0)
    if texture == "along rolling":
        return *_column_means(power, surface.lengths[0], q_max), power.sum(), lay
    if texture == "lay":
        lay = lay_of_map(power, surface.lengths, q_max, cutoffs)
        return *_ring_means(power, surface.lengths, q_max, *lay), power.sum(), lay
    measure, direction = anisotropy(power, surface.lengths, q_max)
    if measure > MOST_ANISOTROPY:
        raise DataError(
            f"{surface.name}: got an anisotropy of {measure:.2f}, the lay at "
            f"{90.0 - abs(math.degrees(direction)):.0f} degrees to rolling, need at most "
            f"{MOST_ANISOTROPY} for `isotropic`, or else `lay` or `along rolling`"
        )
    return *_ring_means(power, surface.lengths, q_max), power.sum(), lay


def _ring_means(power, lengths, q_max, ratio=1.0, angle=90.0):
    """Density of the isotropic surface's line, by rings of the half plane of wave vectors."""
    along, across = wave_vectors(power, lengths)
    wave_vector = unstretched(along, across, ratio, angle)
    sums = sums_by_bin(wave_vector, min(lengths), q_max)
    # Each wave of the half plane stands for two, but not those of the first column.
    waves = 2 * sums() - sums(np.broadcast_to(across == 0.0, power.shape))
    wave_vector[0, 0] = 1.0
    wave_vector **= -3.0
    # The wave vector at which a power law of the exponent -3 has its mean over the ring.
    filled = sums() > 0  # with a lay, some of the first rings have no wave
    waves = waves[filled]
    middle = (sums(wave_vector)[filled] / sums()[filled]) ** (-1.0 / 3.0)
    cell = (2.0 * np.pi) ** 2 / (lengths[0] * lengths[1])
    surface_density = sums(power)[filled] / (waves * cell)
    estimates = np.maximum(0.5 * waves / _BLUR**2, 1.0)
    inside = np.sum(surface_density * waves) * cell
    # The waves of the isotropic surface lie in a plane that is stretched across the lay.
    return middle, 2.0 * np.pi * middle * surface_density / ratio, estimates, inside


def _ring_transfer(surface, q_max, cutoffs, lay):
    """Fraction of power that filters leave of a ring's waves, which differ in length with a lay."""
    along, across = wave_vectors(map_power(surface.heights), surface.lengths)
    sums = sums_by_bin(unstretched(along, across, *lay), min(surface.lengths), q_max)
    filled = sums() > 0
    return sums(power_transfer(np.hypot(along, across), *cutoffs))[filled] / sums()[filled]


def _column_means(power, length, q_max):
    """Density of the profiles along the first axis, by bins of the wave vector along it."""
    last = (power.shape[0] - 1) // 2
    step = 2.0 * np.pi / length
    wave_vector = step * np.arange(1, last + 1)
    of_rows = (np.sum(part, axis=1) for part in (power, power**2))
    powers, squares = (part[1 : last + 1] + part[: -last - 1 : -1] for part in of_rows)
    sums = sums_by_bin(wave_vector, length, q_max)
    counts, total, places = map(sums, (None, powers, wave_vector**-2.0))
    middle = (places / counts) ** -0.5
    # The variance of a sum of exponentially distributed powers P is half the sum of P^2.
    with np.errstate(invalid="ignore"):
        estimates = 2.0 * total**2 / sums(squares)
    most = 2.0 * counts * power.shape[1]
    estimates = np.maximum(np.minimum(estimates, most) / _BLUR**2, 1.0)
    return middle, total / (counts * step), estimates, total.sum()


def _inverted(wave_vector, density, estimates):
    """Density of the line from that of a profile, and its estimates by parametric bootstrap."""
    decades = np.log10(wave_vector / wave_vector[0])
    knot = np.unique((decades * BINS_PER_DECADE_INVERTED).astype(int), return_inverse=True)[1]
    number = np.bincount(knot, estimates)
    # Means as of a power law of the exponent -2, so that wide bins do not change its level.
    places = np.exp(np.bincount(knot, estimates * np.log(wave_vector)) / number)
    means = np.bincount(knot, estimates * density * (wave_vector / places[knot]) ** 2) / number

    def invert(values):
        return line_of_profile(places, monotone(values, number), wave_vector)

    fit = monotone(means, number)
    noise = np.random.default_rng(0).gamma(number, 1.0 / number, (_REPLICATES, number.size))
    replicates = [invert(fit * factors) for factors in noise]
    spread = np.std(replicates, axis=0) / np.mean(replicates, axis=0)
    return invert(means), np.maximum(spread**-2.0, 1.0)
