"""Electrical resistance between the rollers, and the circuit that measures it."""

from typing import Protocol

import numpy as np

from lube.physics.hertz import hertz_gap
from lube.types import Values

VACUUM_PERMITTIVITY = 8.8541878188e-12
"""Electric constant, F/m (CODATA 2022)."""
# Gauss' rule on 25 parts: to find one of 400 points takes each process up to 2.6 s.
_PARTS, _RULE = 25, np.polynomial.legendre.leggauss(16)
_POINTS = ((2.0 * np.arange(_PARTS)[:, None] + 1.0 + _RULE[0]) / _PARTS - 1.0).ravel()
_WEIGHTS = np.tile(_RULE[1] / _PARTS, _PARTS)
_WIDE = 9.0
"""Standard deviations beyond which a normal density is left out."""


class Circuit(Protocol):
    """Voltage divider: a source in series with a resistor, the leads and the contact.

    Attributes
    ----------
    bias_voltage : float
        Voltage U of the source, V.
    series_resistance, lead_resistance : float
        Resistances R_s of the resistor and R_l of the leads, ohm.
    """

    bias_voltage: float
    series_resistance: float
    lead_resistance: float


def contact_resistance(contact_length: Values, resistivity: float) -> Values:
    r"""Resistance of all broken segments in parallel, the paper's equation 1.

    .. math:: \frac{1}{R_c} = \frac{L_{con}}{\rho}

    Parameters
    ----------
    contact_length : float or numpy.ndarray
        Contact length :math:`L_{con}`, the sum of the lengths of all broken segments, m.
    resistivity : float
        Resistivity :math:`\rho` of the rollers' material, ohm m.

    Returns
    -------
    float or numpy.ndarray
        Contact resistance :math:`R_c`, ohm; infinite (an open circuit) without contact.

    Examples
    --------
    >>> contact_resistance([0.0, 4e-6], 0.2e-6).tolist()
    [inf, 0.05]
    """
    with np.errstate(divide="ignore"):
        return resistivity / np.asarray(contact_length, float)


def divider_voltage(resistance: Values, circuit: Circuit) -> Values:
    r"""Voltage logged over leads and contact at a steady contact resistance.

    .. math:: V = U \frac{R_l + R}{R_s + R_l + R}

    Parameters
    ----------
    resistance : float or numpy.ndarray
        Contact resistance :math:`R`, ohm; may be infinite.
    circuit : Circuit
        The voltage divider.

    Returns
    -------
    float or numpy.ndarray
        Voltage :math:`V`, V.

    Examples
    --------
    >>> from lube.study.rig_settings import Rig
    >>> circuit = Rig(bias_voltage="1 V", series_resistance="100 ohm", lead_resistance="0 ohm")
    >>> divider_voltage(np.array([100.0, np.inf]), circuit).tolist()
    [0.5, 1.0]
    """
    ratio = circuit.series_resistance / (np.asarray(resistance, float) + circuit.lead_resistance)
    return circuit.bias_voltage / (1.0 + ratio)


def resistance_from_voltage(voltage: Values, circuit: Circuit) -> Values:
    r"""Contact resistance that follows from a logged voltage; inverse of `divider_voltage`.

    .. math:: R = R_s \frac{V}{U - V} - R_l

    Parameters
    ----------
    voltage : float or numpy.ndarray
        Logged voltage :math:`V`, V.
    circuit : Circuit
        The voltage divider.

    Returns
    -------
    float or numpy.ndarray
        Contact resistance :math:`R`, ohm; infinite at the bias voltage and above. Near zero,
        noise may make it negative.

    Examples
    --------
    >>> from lube.study.rig_settings import Rig
    >>> circuit = Rig(bias_voltage="1 V", series_resistance="100 ohm", lead_resistance="0 ohm")
    >>> resistance_from_voltage(np.array([0.0, 0.5, 1.0]), circuit).tolist()
    [0.0, 100.0, inf]
    """
    voltage = np.asarray(voltage, float)
    drop = np.maximum(circuit.bias_voltage - voltage, 0.0)  # over the series resistor
    with np.errstate(divide="ignore"):
        return circuit.series_resistance * voltage / drop - circuit.lead_resistance


def film_capacitance(
    film_thickness: Values, half_width: Values, length: float, permittivity: float
) -> Values:
    r"""Capacitance of the oil film, modelled as a plate capacitor over the contact strip.

    .. math:: C = \varepsilon_0 \varepsilon_r \frac{2 a L'}{h_0}

    Parameters
    ----------
    film_thickness, half_width : float or numpy.ndarray
        :math:`h_0` and :math:`a`, m.
    length : float
        Length :math:`L'` of the line contact, m.
    permittivity : float
        Relative permittivity :math:`\varepsilon_r` of the oil.

    Returns
    -------
    float or numpy.ndarray
        Capacitance :math:`C`, F.

    Examples
    --------
    >>> f"{film_capacitance(1e-6, 0.21e-3, 0.01, 2.2):.3g}"
    '8.18e-11'
    """
    return VACUUM_PERMITTIVITY * permittivity * 2.0 * half_width * length / film_thickness


def mean_inverse_gap(film_thickness: Values, rms: Values, layer: float) -> Values:
    r"""Mean of one over the gap between rough surfaces, to which their capacitance is proportional.

    The gap g is Gaussian with the film as its mean. Where the surfaces would come closer than the
    boundary layer is thick, the layer is between them; without it the mean would be infinite. With
    :math:`t = h / \sigma` and :math:`c = h_c / \sigma`,

    .. math::

        \left\langle \frac{1}{\max(g, h_c)} \right\rangle = \frac{1}{\sigma} \left[
        \frac{\Phi(c - t)}{c} + \int_{\ln c}^\infty \varphi(e^s - t)\, ds \right]

    Parameters
    ----------
    film_thickness : float or numpy.ndarray
        Mean gap h, m.
    rms : float or numpy.ndarray
        Rms height :math:`\sigma` of both surfaces together, m; they broadcast.
    layer : float
        Thickness :math:`h_c` of the boundary layer, m.

    Returns
    -------
    float or numpy.ndarray
        1/m. Between smooth surfaces it is one over the film thickness, and between rough ones more,
        if the layer is thin compared with the film.

    Examples
    --------
    >>> float(mean_inverse_gap(1e-6, 0.0, 5e-9))
    1000000.0
    >>> f"{mean_inverse_gap(1e-6, 0.28e-6, 5e-9):.4g}"
    '1.155e+06'
    """
    from scipy.special import ndtr  # slow to import

    film, rms = np.broadcast_arrays(np.asarray(film_thickness, float), np.asarray(rms, float))
    with np.errstate(divide="ignore", invalid="ignore"):
        height, least = film / rms, layer / rms
        low = np.log(np.maximum(least, height - _WIDE))
        high = np.log(np.maximum(least, height + _WIDE))
        half = 0.5 * (high - low)[..., None]
        gaps = np.exp(low[..., None] + half * (1.0 + _POINTS))
        density = np.exp(-0.5 * (gaps - height[..., None]) ** 2) / np.sqrt(2.0 * np.pi)
        parts = half[..., 0] * np.sum(_WEIGHTS * density, axis=-1)
        rough = (ndtr(least - height) / least + parts) / rms
        smooth = 1.0 / np.maximum(film, layer)
    return np.where(rms > 0.0, rough, smooth)[()]


def mean_inverse_open_gap(film_thickness: Values, rms: Values, layer: float) -> Values:
    r"""Mean of one over the gap where it is wider than the boundary layer.

    A circuit charges this gap when a contact has ended. As `mean_inverse_gap`, without the part
    :math:`\Phi(c - t)` of the gap that the layer alone fills.

    Parameters
    ----------
    film_thickness, rms, layer
        As for `mean_inverse_gap`.

    Returns
    -------
    float or numpy.ndarray
        1/m.

    Examples
    --------
    >>> f"{mean_inverse_open_gap(1e-6, 0.28e-6, 5e-9):.4g}"
    '1.117e+06'
    """
    from scipy.special import ndtr  # slow to import

    with np.errstate(divide="ignore", invalid="ignore"):
        filled = ndtr((layer - np.asarray(film_thickness)) / rms)
    inverse = mean_inverse_gap(film_thickness, rms, layer)
    return np.where(np.asarray(rms) > 0.0, (inverse - filled / layer) / (1.0 - filled), inverse)[()]


def surrounding_capacitance(
    film_thickness: Values, half_width: Values, reduced_radius: Values, length: float, oil: float
) -> Values:
    r"""Capacitance of the gap beside a dry line contact, lifted by the film.

    The inlet is full of oil, the outlet empty. With the gap :math:`g(X)` of `lube.physics.hertz`,

    .. math::

        C = \varepsilon_0 (\varepsilon_r + 1) L'
        \int_1^\infty \frac{a\, dX}{h_0 + g(X)\, a^2 / R^*}

    Parameters
    ----------
    film_thickness, half_width, reduced_radius : float or numpy.ndarray
        :math:`h_0`, :math:`a` and :math:`R^*`, m; they broadcast.
    length : float
        Length :math:`L'` of the line contact, m.
    oil : float
        Relative permittivity :math:`\varepsilon_r` of the oil.

    Returns
    -------
    float or numpy.ndarray
        Capacitance, F.

    Examples
    --------
    >>> f"{surrounding_capacitance(1e-6, 0.21e-3, 0.025, 0.01, 2.2):.3g}"
    '7.53e-11'
    """
    # Evenly over the logarithm of the distance from the edge, from a millionth on.
    nodes, weights = 14.0 * _POINTS, 14.0 * _WEIGHTS
    beyond = np.exp(nodes)
    gap = hertz_gap(1.0 + beyond)
    film, half_width, radius = np.broadcast_arrays(film_thickness, half_width, reduced_radius)
    height = np.asarray(film, float)[..., None] + gap * (half_width**2 / radius)[..., None]
    integral = half_width * np.sum(weights * beyond / height, axis=-1)
    return (VACUUM_PERMITTIVITY * (oil + 1.0) * length * integral)[()]


def read_impedance(
    share: Values, resistance: Values, capacitance: Values, frequency: float, series: float
) -> Values:
    r"""Impedance that a bridge reads of a contact that is closed for a share of the time.

    The bridge averages the current over many contacts and subtracts the series resistance, which
    limits the current while the contact is closed:

    .. math::

        Z = \left[ \frac{P}{R_s + R_c} + \frac{1 - P}{R_s + 1 / (i \omega C)} \right]^{-1} - R_s

    Parameters
    ----------
    share : float or numpy.ndarray
        Share P of time in contact.
    resistance, capacitance : float or numpy.ndarray
        Resistance :math:`R_c` in contact (ohm), and capacitance C without it (F).
    frequency : float
        Frequency :math:`\omega / 2 \pi`, Hz.
    series : float
        Series resistance :math:`R_s` of bridge and leads, ohm.

    Returns
    -------
    complex or numpy.ndarray
        Impedance Z, ohm. Its phase is -90 degrees for a capacitor, 0 for a resistor.

    Examples
    --------
    >>> open_, closed = read_impedance(np.array([0.0, 1.0]), 0.5, 1e-10, 1e6, 100.0)
    >>> f"{open_.imag:.0f} {closed.real:.1f}"
    '-1592 0.5'
    """
    capacitor = 1.0 / (2j * np.pi * frequency * np.asarray(capacitance))
    closed = share / (series + resistance)
    return 1.0 / (closed + (1.0 - share) / (series + capacitor)) - series
