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

A Hann window of mean square one keeps the jump between opposite edges out of the spectrum. It
blurs the two or three longest waves, so the spectrum begins at two waves on the measured length.
The window also gives the middle more weight than the edges, so that the mean square height of the
spectrum differs from that of the measured heights by chance. The difference is spread over the
densities in proportion to their variance. The few long waves take most of it; the short ones, which
are known much better than the rms height, hardly change.
This is done only after a filter of long waves: without one the rms height is that of the measured
length, which no spectrum of shorter waves can have. In both cases the table has the power of the
waves it is made of, although interpolating the logarithm between scattered values lowers it.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from lube.errors import DataError
from lube.surfaces.abel import line_of_profile, monotone
from lube.surfaces.lay import cosine_and_sine, unstretched
from lube.surfaces.spectra import power_spectrum
from lube.surfaces.spectrum_table import LineSpectrum, with_power
from lube.surfaces.topography import Preparation, Topography, power_transfer, used_directions
from lube.types import Array, Pair

LEAST_POINTS_PER_WAVE = 4
"""A wave of fewer points is left out: waves too short for the grid are taken for longer ones, which
adds a twelfth to the density here (H = 0.7), and doubles it at two points a wave."""

LEAST_WAVES = 2
"""A wave that fits fewer times into the measured length is left out."""

REPEATS = 4
"""How often the fit of long ridges is repeated."""

LONG_RIDGES = 0.02
"""Ratio of long ridges, over the number of shortest waves that fit into the map."""

LEAST_ROWS = 8
"""Number of rows of waves along the ridges to which a lay is fitted at least."""

BINS_PER_DECADE = 20
"""Densities are means over bins of this width, or of one wave where waves are fewer."""

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

LEAST_WAVES_OF_RING = 50
"""Fewest waves of a ring that counts for the `anisotropy`."""

LEAST_PART = 0.05
"""Waves of which the filters leave a smaller part of the power take no part in the fit of a lay."""

LEAST_GAIN = 30.0
"""Gain in the logarithm of the likelihood for which a map with a lay counts as blurred."""

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


def profile_density(heights: Array, spacing: float) -> Pair:
    """One-sided density of a profile, through a Hann window.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,), m, of mean zero.
    spacing : float
        Distance of neighbouring points, m.

    Returns
    -------
    wave_vector, density : numpy.ndarray
        Shape (n // 2,), rad/m and m^3.

    Examples
    --------
    >>> wave = np.sin(2 * np.pi * np.arange(1000) / 50)
    >>> wave_vector, density = profile_density(wave, 1.0)
    >>> f"{np.sum(density) * wave_vector[0]:.4f}"
    '0.5000'
    """
    return power_spectrum(hann(heights.size) * heights, spacing)


def map_power(heights: Array) -> Array:
    """Mean square height of every wave of a map, through a Hann window in both directions.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (nx, ny), m, of mean zero.

    Returns
    -------
    numpy.ndarray
        Shape (nx, ny // 2 + 1), m^2, in the order of ``numpy.fft.rfft2``; each value of the half
        plane stands for both waves of opposite wave vectors, and their sum is the mean square
        height seen through the window.

    Examples
    --------
    >>> wave = np.add.outer(np.zeros(60), np.sin(2 * np.pi * np.arange(80) / 10))
    >>> f"{map_power(wave).sum():.4f}"
    '0.5000'
    """
    rows, columns = heights.shape
    spectrum = scipy.fft.rfft2(
        heights * hann(rows)[:, None] * hann(columns), overwrite_x=True, norm="forward"
    )
    power = spectrum.real**2
    power += spectrum.imag**2
    power[:, 1 : (columns + 1) // 2] *= 2.0
    power[0, 0] = 0.0
    return power


def hann(points: int) -> Array:
    """Hann window of mean square one, shape (points,).

    Examples
    --------
    >>> f"{np.mean(hann(100) ** 2):.12f}"
    '1.000000000000'
    """
    return math.sqrt(8.0 / 3.0) * np.sin(np.pi * np.arange(points) / points) ** 2


def anisotropy(power: Array, lengths: Pair, q_max: float) -> tuple[float, float]:
    r"""Measure how far the spectrum of a map depends on the direction.

    .. math:: A\, e^{2 i \theta_0} = \left\langle \frac{\sum P e^{2 i \theta}}{\sum P}
        \right\rangle

    The sums are over the waves of directions :math:`\theta` in a ring of wave vectors, and the
    mean is over rings of equal logarithmic width.

    Parameters
    ----------
    power : numpy.ndarray
        From `map_power`, shape (nx, ny // 2 + 1).
    lengths : tuple of float
        Measured length in both directions, m.
    q_max : float
        Largest wave vector, rad/m, at most pi over the wider spacing.

    Returns
    -------
    measure : float
        0 if isotropic, 1 if all waves have one direction.
    direction : float
        Direction of the strongest waves from the first axis, rad, between -pi/2 and pi/2; the
        lay is perpendicular to it.

    Examples
    --------
    >>> rows = np.random.default_rng(1).normal(size=128)
    >>> power = map_power(np.outer(rows, np.ones(128)))
    >>> "{:.2f} {:.2f}".format(*anisotropy(power, (128.0, 128.0), 1.5))
    '1.00 0.00'
    """
    along, across = _wave_vectors(power, lengths)
    sums = _sums_by_bin(np.hypot(along, across), min(lengths), q_max)
    total, cosine, sine = map(sums, _double_angle(power, along, across))
    # Rings of few waves are left out: their scatter alone looks like a direction.
    many = (sums() >= LEAST_WAVES_OF_RING) & (total > 0)
    if not many.any():
        return 0.0, 0.0
    cosine, sine = (np.mean(part[many] / total[many]) for part in (cosine, sine))
    return float(np.hypot(cosine, sine)), 0.5 * float(np.arctan2(sine, cosine))


def _profile_bins(surface, q_max):
    """Means of a profile's density over bins, and the number of independent estimates."""
    wave_vector, density = profile_density(surface.heights, surface.spacing[0])
    sums = _sums_by_bin(wave_vector, surface.lengths[0], q_max)
    counts, total, places = map(sums, (None, density, wave_vector**-2.0))
    # The wave vector at which a power law of the exponent -2 has its mean over the bin.
    middle, estimates = (places / counts) ** -0.5, np.maximum(counts / _BLUR, 1.0)
    powers = (np.sum(part) * wave_vector[0] for part in (total, density))
    return middle, total / counts, estimates, *powers


def lay_of_map(
    power: Array, lengths: Pair, q_max: float, cutoffs: tuple[float | None, float | None]
) -> tuple[float, float]:
    r"""Fit the lay of a map, that is how an isotropic surface is stretched into it.

    The powers of the waves are exponentially distributed. Their mean is any function of the
    wavenumber q' of the isotropic surface, a constant in each bin, times the part
    :math:`t\, e^{-b q^2}` that the filters, and a blur by the instrument, leave of a wave of the
    map. The fit of ratio, angle and b has the greatest likelihood, the least

    .. math:: \sum n \ln \bar P - b \sum q^2

    over bins with n waves, and with the mean :math:`\bar P` of :math:`P e^{b q^2} / t`. Unless this
    gains more than `LEAST_GAIN`, b is 0.

    Of ridges longer than the map, the window leaves some among the waves that fit into it. Where
    the surface itself has no such waves, as q' lies beyond its band, the ratio found is far too
    large. So a fit of long ridges is repeated, with those waves alone whose q' by the last fit is
    not above `q_max`. These are fewer, and the first fit counts unless it is that much less likely
    for them.

    Parameters
    ----------
    power, lengths, q_max
        As in `anisotropy`.
    cutoffs : tuple
        As in `lube.surfaces.topography.power_transfer`.

    Returns
    -------
    ratio : float
        Length of the ridges over their width, to three digits.
    angle : float
        Angle between the ridges and the first axis, to a tenth of a degree.
    """
    _, direction = anisotropy(power, lengths, q_max)
    first = math.degrees(direction) + 90.0
    every = _Waves.of_map(power, lengths, q_max, cutoffs)
    lay, _ = every.inside(1.0, first).likeliest(first)
    shortest = _along_ridges(lengths, lay[1]) * q_max / (2.0 * np.pi)
    if _ratio(lay) > LONG_RIDGES * shortest:
        last = lay
        for _ in range(REPEATS):
            waves = every.inside(min(_ratio(last), shortest / LEAST_ROWS), last[1])
            last, misfit = waves.likeliest(last[1])
        lay = last if waves.least_misfit(lay) > misfit + LEAST_GAIN else lay
    angle = (lay[1] + 90.0) % 180.0 - 90.0  # ridges at 100 degrees are at -80
    # A rounded angle just below 0 is no "-0" in messages.
    return float(f"{_ratio(lay):.3g}"), round(float(angle), 1) + 0.0


def _along_ridges(lengths, angle):
    """Length of a map along ridges at an angle to its first axis."""
    return math.hypot(*np.multiply(cosine_and_sine(angle), lengths))


def _ratio(lay):
    """Ratio of a lay, which is fitted as its logarithm and its angle."""
    return math.exp(abs(lay[0]))


@dataclass(frozen=True)
class _Waves:
    """Waves of a map to which a lay is fitted.

    Attributes
    ----------
    lengths : tuple of float
        Measured length in both directions, m.
    q_max : float
        Largest wavenumber, rad/m.
    along, across : numpy.ndarray
        Wave vectors along both axes, rad/m.
    square : numpy.ndarray
        Square of the wavenumber over its largest.
    powers : numpy.ndarray
        Powers before the filters.
    """

    lengths: Pair
    q_max: float
    along: Array
    across: Array
    square: Array
    powers: Array

    @classmethod
    def of_map(cls, power, lengths, q_max, cutoffs):
        """Take the waves of a map of which the filters leave enough."""
        along, across = np.broadcast_arrays(*_wave_vectors(power, lengths))
        square = (along**2 + across**2) / q_max**2
        transfer = power_transfer(q_max * np.sqrt(square), *cutoffs)
        used = (square <= 1.0) & (power > 0.0) & (transfer > LEAST_PART)
        of_waves = along[used], across[used], square[used], power[used] / transfer[used]
        return cls(lengths, q_max, *of_waves)

    def inside(self, ratio, angle):
        """Choose waves that are those of the isotropic surface up to `q_max`, by some lay."""
        # The window blurs ridges longer than half of the map.
        cosine, sine = cosine_and_sine(angle)
        ridges = np.abs(self.along * cosine + self.across * sine)
        used = ridges >= 2.0 * np.pi * LEAST_WAVES / _along_ridges(self.lengths, angle)
        used &= unstretched(self.along, self.across, ratio, angle) <= self.q_max
        of_waves = (self.along, self.across, self.square, self.powers)
        return _Waves(self.lengths, self.q_max, *(one[used] for one in of_waves))

    def misfit(self, lay, blur=0.0):
        """Misfit of a lay, with the part b that a blur has, over the largest wavenumber squared."""
        own, blur = unstretched(self.along, self.across, _ratio(lay), lay[1]), abs(blur)
        inside = (np.log10(own / own.min()) * BINS_PER_DECADE).astype(np.int64)
        total = np.bincount(inside, self.powers * np.exp(blur * self.square))
        counts = np.bincount(inside)
        filled = counts > 0
        levels = np.sum(counts[filled] * np.log(total[filled] / counts[filled]))
        return levels - blur * np.sum(self.square)

    def least_misfit(self, lay):
        """Misfit of a lay with the likeliest blur."""
        return self._least(lambda blur: self.misfit(lay, blur[0]), [(0.0,), (0.3,)], (0.5,)).fun

    def likeliest(self, angle):
        """Find the likeliest lay and its misfit, from an angle near it."""
        starts = [(math.log(ratio), angle) for ratio in (1.2, 3.0, 8.0, 20.0)]
        sharp = self._least(self.misfit, starts, (0.3, 5.0))
        starts = [(*lay, blur) for lay in (*starts, sharp.x) for blur in (0.3, 3.0)]
        blurred = self._least(lambda lay: self.misfit(lay[:2], lay[2]), starts, (0.3, 5.0, 0.5))
        found = blurred if blurred.fun < sharp.fun - LEAST_GAIN else sharp
        return found.x[:2], found.fun

    def _least(self, function, starts, steps):
        begin = np.array(min(starts, key=function))
        simplex = begin + np.vstack([np.zeros(begin.size), np.diag(steps)])
        options = {"initial_simplex": simplex, "xatol": 1e-3, "fatol": 1e-9 * self.powers.size}
        return scipy.optimize.minimize(function, begin, method="Nelder-Mead", options=options)


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
    along, across = _wave_vectors(power, lengths)
    wave_vector = unstretched(along, across, ratio, angle)
    sums = _sums_by_bin(wave_vector, min(lengths), q_max)
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
    along, across = _wave_vectors(map_power(surface.heights), surface.lengths)
    sums = _sums_by_bin(unstretched(along, across, *lay), min(surface.lengths), q_max)
    filled = sums() > 0
    return sums(power_transfer(np.hypot(along, across), *cutoffs))[filled] / sums()[filled]


def _column_means(power, length, q_max):
    """Density of the profiles along the first axis, by bins of the wave vector along it."""
    last = (power.shape[0] - 1) // 2
    step = 2.0 * np.pi / length
    wave_vector = step * np.arange(1, last + 1)
    of_rows = (np.sum(part, axis=1) for part in (power, power**2))
    powers, squares = (part[1 : last + 1] + part[: -last - 1 : -1] for part in of_rows)
    sums = _sums_by_bin(wave_vector, length, q_max)
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


def _wave_vectors(power, lengths):
    """Wave vectors along both axes, shapes (nx, 1) and (ny // 2 + 1,), rad/m."""
    rows, columns = power.shape
    along = 2.0 * np.pi / lengths[0] * scipy.fft.fftfreq(rows, 1.0 / rows)
    return along[:, None], 2.0 * np.pi / lengths[1] * np.arange(columns)


def _double_angle(power, along, across):
    """Yield power, and power times the cosine and the sine of twice the direction."""
    yield power
    square = along**2 + across**2
    square[0, 0] = 1.0
    weighted = power / square
    yield weighted * (along**2 - across**2)
    yield weighted * (2.0 * along * across)


def _sums_by_bin(wave_vector, length, q_max):
    """Return a function that sums values, or counts them, in bins of the wave vector.

    At least one multiple of 2 pi / length lies in each bin. Values outside all bins are left out.
    """
    step, growth = 2.0 * np.pi / length, 10.0 ** (1.0 / BINS_PER_DECADE)
    edges = [(LEAST_WAVES - 0.5) * step]
    while (following := max(edges[-1] + step, edges[-1] * growth)) <= q_max * (1.0 + 1e-9):
        edges.append(following)
    inside = np.digitize(wave_vector, edges).ravel()

    def sums(values=None):
        values = None if values is None else values.ravel()
        return np.bincount(inside, values, len(edges) + 1)[1:-1]

    return sums
