r"""Mean pressure of rough elastic surfaces in contact, from the mean gap between them.

In Persson's theory the mean gap is

.. math:: \bar u(p) = \sqrt{\pi} \int dq\, q^2 C(q) w(q) \int_p^\infty \frac{dp'}{p'}
          \left[ \gamma + 3 (1 - \gamma)\, \mathrm{erf}^2 \frac{w p'}{E^*} \right]
          e^{-(w p' / E^*)^2}, \qquad w(q)^{-2} = \pi \int_0^q dq'\, q'^3 C(q') ,

with the spectrum C of the isotropic surface. Surfaces far apart touch at single summits, and the
theory gives too high a pressure. There the real contact area is half of the area above the gap
(Bush, Gibson and Thomas), and

.. math:: p = \frac{E^* g}{\sqrt{2 \pi}}\, \frac12\, Q(\bar u / \sigma)

with the rms gradient g, the rms height :math:`\sigma` and the Gaussian tail Q. This holds beyond
the largest gap at which both give the same pressure. With a narrow band of wavelengths the theory
gives a higher pressure at all gaps. It is then scaled so that the two curves touch.

The sources were not at hand. What decides is the comparison with numerical solutions
(`tests/surfaces/test_contact_pressure.py`).

References
----------
C. Yang and B. N. J. Persson, Contact mechanics: contact area and interfacial separation from small
contact to full contact, J. Phys.: Condens. Matter 20 (2008) 215214.
A. W. Bush, R. D. Gibson and T. R. Thomas, The elastic contact of a rough surface, Wear 35 (1975)
87-111.
"""

import functools

import numpy as np
import scipy

from lube.surfaces.rare_contact import check_stands_for_surface
from lube.surfaces.spectra import wave_powers
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array

STIFFNESS = 0.36
"""The theory's :math:`\\gamma`, chosen so that it differs least from numerical solutions, in which
the longest wave is 8, 16 and 32 times the shortest."""
BANDS = 100
"""Number of bands of wavenumbers in the integral over the spectrum."""
PRESSURES = np.geomspace(1e-7, 5.0, 600)
"""Pressures over E* times the rms gradient."""


def contact_pressure(spec: LineSpecLike, modulus: float, gap: Array) -> Array:
    """Find the mean pressure between both rollers' surfaces at a mean gap.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines that stand for the surfaces.
    modulus : float
        Reduced modulus E*, Pa.
    gap : numpy.ndarray
        Mean gap between the deformed surfaces, any shape, m.

    Returns
    -------
    numpy.ndarray
        Pressure on the nominal area, Pa; NaN where the gap is.

    Raises
    ------
    StudyError
        As from `lube.surfaces.rare_contact.check_stands_for_surface`.
    """
    rms, gradient, gaps, by_theory, meeting = _curve(spec)
    by_summits, by_theory = _by_summits(gap / rms), np.interp(-gap, -gaps, by_theory)
    far_apart = np.minimum(by_summits, by_theory)
    return modulus * gradient * np.exp(np.where(gap > meeting, far_apart, by_theory))


def _by_summits(gap):
    """Logarithm of the pressure over E* g if single summits touch, at a gap over the rms height."""
    return scipy.special.log_ndtr(-gap) - np.log(2.0 * np.sqrt(2.0 * np.pi))


@functools.lru_cache(maxsize=4)
def _curve(spec):
    """Rms height, m, and gradient; gaps, m, with the pressures by the theory; and where it ends, m.

    The pressures are logarithms, over E* times the gradient.
    """
    check_stands_for_surface(spec)
    wavenumber, variance = _waves(spec)
    gradient = np.sqrt(np.sum(variance * wavenumber**2))
    gaps = _mean_gaps(wavenumber, variance, PRESSURES * gradient)
    rms, by_theory = np.sqrt(variance.sum()), np.log(PRESSURES)
    excess = _by_summits(gaps / rms) - by_theory
    scaled = min(excess.max(), 0.0)
    meeting = gaps[np.argmax(excess >= scaled)]  # the largest such gap
    return rms, gradient, gaps, by_theory + scaled, meeting


def _waves(spec):
    """Wavenumbers, rad/m, and variances, m^2, of bands of both surfaces' waves, rising."""
    wavenumber, variance = np.concatenate([wave_powers(spec, r) for r in (0, 1)], axis=1)
    order = np.argsort(wavenumber)
    wavenumber, variance = wavenumber[order], variance[order]
    # Near the longest wave, where w is infinite, bands are narrow.
    even = np.arange(BANDS) / BANDS
    edges = wavenumber[0] * (wavenumber[-1] / wavenumber[0]) ** even**2
    edges = np.unique(np.searchsorted(wavenumber, edges))
    edges = edges[np.add.reduceat(variance, edges) > 0.0]  # with a lay the longest may be 0
    of_bands = np.add.reduceat(variance, edges)
    return np.add.reduceat(variance * wavenumber, edges) / of_bands, of_bands


def _mean_gaps(wavenumber, variance, pressures):
    """Mean gap, m, at rising pressures over E*."""
    slopes = variance * wavenumber**2  # twice the integral in w(q)
    w = np.sqrt(2.0 / (np.cumsum(slopes) - 0.5 * slopes))[:, None]
    at = w * pressures
    integrand = STIFFNESS + 3.0 * (1.0 - STIFFNESS) * scipy.special.erf(at) ** 2
    integrand *= np.exp(-(at**2))
    falling = integrand[:, ::-1], np.log(pressures)[::-1]
    above = -scipy.integrate.cumulative_trapezoid(*falling, initial=0.0)[:, ::-1]
    weights = variance * wavenumber / (2.0 * np.sqrt(np.pi))  # sqrt(pi) q^2 C dq
    return np.sum(weights[:, None] * w * above, axis=0)
