r"""Fit of a lay to a measured map: how an isotropic surface is stretched into it."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from lube.surfaces.lay import cosine_and_sine, unstretched
from lube.surfaces.measured_waves import BINS_PER_DECADE, LEAST_WAVES, anisotropy, wave_vectors
from lube.surfaces.topography import power_transfer
from lube.types import Array, Pair

REPEATS = 4
"""How often the fit of long ridges is repeated."""

LONG_RIDGES = 0.02
"""Ratio of long ridges, over the number of shortest waves that fit into the map."""

LEAST_ROWS = 8
"""Number of rows of waves along the ridges to which a lay is fitted at least."""

LEAST_PART = 0.05
"""Waves of which the filters leave a smaller part of the power take no part in the fit of a lay."""

NOTHING = 1e-4
"""Part of the power that waves may have that are taken as next to none: a surface without waves as
short shows only noise there."""

BEYOND = 1.15
"""Largest wavenumber in the fit of a lay, over that beyond which next to no power lies: where the
waves end tells the ratio, too."""

RINGS = 200
"""Rings of wavenumbers among which these are sought."""

LEAST_GAIN = 30.0
"""Gain in the logarithm of the likelihood for which a map with a lay counts as blurred."""


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
    shortest = _along_ridges(lengths, lay[1]) * every.q_max / (2.0 * np.pi)
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


def _last_square(square, powers):
    """Square of the wavenumber up to which waves take part, 1 at most."""
    number = (RINGS * np.sqrt(square)).astype(np.int64)
    beyond = np.cumsum(np.bincount(number, powers)[::-1])
    last = RINGS - np.searchsorted(beyond, NOTHING * beyond[-1]) + 1
    return min(BEYOND * last / RINGS, 1.0) ** 2


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
        along, across = np.broadcast_arrays(*wave_vectors(power, lengths))
        square = (along**2 + across**2) / q_max**2
        transfer = power_transfer(q_max * np.sqrt(square), *cutoffs)
        used = (square <= 1.0) & (power > 0.0) & (transfer > LEAST_PART)
        of_waves = along[used], across[used], square[used], power[used] / transfer[used]
        last = _last_square(*of_waves[2:])
        some = of_waves[2] <= last
        along, across, square, powers = (one[some] for one in of_waves)
        return cls(lengths, q_max * math.sqrt(last), along, across, square / last, powers)

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
