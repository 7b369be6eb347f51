r"""Indicators of lubrication that engineers know, by their published formulas.

They are kept for comparison: no result of a study uses them. W, U and G are the groups of
`lube.physics.dimensionless`. Each formula is used with its own lambda ratio; one whose range is
published, within that range only.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from lube.types import Values

AIHARA_PRESSURE = 0.4e9
"""Largest Hertzian pressure of Aihara's formula, Pa."""


def micropitting_film(load: Values, speed: Values, material: Values) -> Values:
    r"""Film of the micropitting calculation of gears, over R*.

    .. math:: 1.6\, G^{0.6}\, U^{0.7}\, W^{-0.13}

    The film is one at a single point of the contact path, at the temperature of the teeth: the
    factor for the flash temperature, :math:`S_{GF}^{0.22}`, is 1 without sliding.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film over R*.

    References
    ----------
    ISO/TR 15144-1, Calculation of micropitting load capacity of cylindrical spur and helical gears,
    part 1, method B. In its units the factor is 1600.

    Examples
    --------
    >>> f"{micropitting_film(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '3.61e-05'
    """
    return 1.6 * material**0.6 * speed**0.7 * load**-0.13


def viscosity_ratio(kinematic_viscosity: Values, speed: Values, pitch_diameter: float) -> Values:
    r"""Viscosity ratio of a rolling bearing.

    .. math:: \kappa = \frac{\nu}{\nu_1}, \qquad
        \nu_1 = 45000\, n^{-0.83} D_{pw}^{-0.5}, \quad n < 1000; \qquad
        \nu_1 = 4500\, n^{-0.5} D_{pw}^{-0.5}, \quad n \ge 1000

    with :math:`\nu_1` in mm^2/s, the speed n in r/min and the diameter in mm.

    Parameters
    ----------
    kinematic_viscosity : float or numpy.ndarray
        Of the oil at the bearing's temperature, m^2/s.
    speed : float or numpy.ndarray
        Rotation speed of the bearing, rpm.
    pitch_diameter : float
        Pitch diameter of its rolling elements, m.

    Returns
    -------
    float or numpy.ndarray
        Viscosity ratio.

    References
    ----------
    ISO 281, Rolling bearings: dynamic load ratings and rating life.

    Examples
    --------
    >>> f"{viscosity_ratio(32e-6, 1500.0, 0.065):.2f}"
    '2.22'
    """
    slow, fast = 45000.0 * speed**-0.83, 4500.0 * speed**-0.5
    needed = np.where(speed < 1000.0, slow, fast) * (1e3 * pitch_diameter) ** -0.5
    return 1e6 * kinematic_viscosity / needed


def bearing_speed(entrainment: Values, pitch_diameter: float, element_diameter: float) -> Values:
    r"""Rotation speed of a rolling bearing, one ring of which stands still.

    .. math:: n = \frac{4 u}{2 \pi D_{pw} (1 - \gamma^2)}, \qquad \gamma = \frac{D_w}{D_{pw}}

    The rollers go round, too, so the ring turns nearly twice as fast as before a roller in a fixed
    place.

    Parameters
    ----------
    entrainment : float or numpy.ndarray
        Entrainment speed u between ring and rolling element, m/s.
    pitch_diameter, element_diameter : float
        Pitch diameter, and diameter of the rolling elements, m.

    Returns
    -------
    float or numpy.ndarray
        Speed of the turning ring, rpm.

    Examples
    --------
    An inner ring of 80 mm, seen from the cage:

    >>> speed = bearing_speed(3.0, 0.096, 0.016)
    >>> cage = 0.5 * speed * (1.0 - 16.0 / 96.0)
    >>> f"{speed:.0f} rpm, {(speed - cage) / 60.0 * math.pi * 0.08:.2f} m/s"
    '1228 rpm, 3.00 m/s'
    """
    gamma = element_diameter / pitch_diameter
    return 60.0 * 2.0 * entrainment / (math.pi * pitch_diameter * (1.0 - gamma**2))


@dataclass(frozen=True)
class LoadShare:
    """A published curve of the share of the load that asperities carry.

    Attributes
    ----------
    share : callable
        Share from the lambda ratio.
    roughness : str
        What the film is divided by: the property ``composite_rms_roughness`` of the rollers, or
        ``mean_ra_roughness``.
    pressure : float
        Largest Hertzian pressure for which the curve is meant, Pa; by default any.
    """

    share: Callable[[Values], Values]
    roughness: str = "composite_rms_roughness"
    pressure: float = np.inf


LOAD_SHARES = {
    # R. S. Zhou, M. R. Hoeprich, J. Tribol. 113 (1991) 590, Eq. 29, first and second pair of the
    # constants of Lubricants 11 (2023) 369, Table 4.
    "zhou-hoeprich-1991": LoadShare(lambda ratio: np.exp(-2.32 * ratio**0.97)),
    "zhou-hoeprich-1991-second": LoadShare(lambda ratio: np.exp(-1.90 * ratio**0.99)),
    # S. Aihara, J. Tribol. 109 (1987) 471, after Patir and Cheng.
    "aihara-1987": LoadShare(lambda ratio: np.exp(-1.8 * ratio**1.2), pressure=AIHARA_PRESSURE),
    # A. Doleschel, thesis, TU Munich, as in A. Arana et al., Proc. IMechE J 233 (2019) 303.
    "doleschel": LoadShare(
        lambda ratio: np.clip(1.0 - 0.5 * ratio, 0.0, None) ** 2, "mean_ra_roughness"
    ),
}
"""Published curves of the load that asperities carry, by name."""


def _biboulet(load, speed, material):
    """Resistance for Moes' numbers M from 0.2 to 200 and L from 4 to 16."""
    moes_load, moes_material = load / np.sqrt(speed), material * speed**0.25
    joined = (1.0 + (1.4 / 1.45 * np.sqrt(moes_load)) ** 10) ** 0.1
    of_load = (moes_load >= 0.2) & (moes_load <= 200.0)
    of_material = (moes_material >= 4.0) & (moes_material <= 16.0)
    return np.where(of_load & of_material, load**1.5 * 1.4 / (moes_load * joined), np.nan)[()]


def _powers(factor, of_speed, of_load, of_material, load, speed, material):
    """Resistance by powers of U, W and G."""
    return factor * speed**of_speed * load**of_load * material**of_material


_DOUBLED = {
    "biboulet-houpert-2010": _biboulet,
    "pan-hamrock": partial(_powers, 1.16, 0.638, 0.019, -0.358),
    "goksem-hargreaves": partial(_powers, 2.74, 0.658, 0.0126, -0.342),
    "zhou-hoeprich-1991": partial(_powers, 18.62, 0.648, 0.246, -0.352),
}
RESISTANCE_FORMULAS = tuple(_DOUBLED)
"""Published formulas of the rolling resistance, by name."""


def rolling_resistance(name: str, load: Values, speed: Values, material: Values) -> Values:
    """Compute the rolling resistance of either surface by a published formula, over E' R*.

    The formulas are printed with a speed parameter twice our U. That of Biboulet and Houpert joins
    the limits of rigid and of elastic rollers.

    Parameters
    ----------
    name : str
        One of `RESISTANCE_FORMULAS`.
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Force per length over E' R*; NaN outside the published range of the formula.

    References
    ----------
    N. Biboulet and L. Houpert, Hydrodynamic force and moment in pure rolling lubricated contacts,
    part 1: line contacts, Proc. IMechE J 224 (2010) 765-775, with the other three in its units.

    Examples
    --------
    >>> [f"{rolling_resistance(one, 1.39e-5, 2.52e-11, 3696.0):.3g}" for one in RESISTANCE_FORMULAS]
    ['2.73e-08', '1.33e-08', '2.4e-08', '1.4e-08']
    """
    return _DOUBLED[name](load, 2.0 * speed, material)
