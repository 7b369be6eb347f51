"""Electrical resistance between the rollers, and the circuit that measures it."""

from typing import Protocol

import numpy as np

from lube.types import Values

VACUUM_PERMITTIVITY = 8.8541878188e-12
"""Electric constant, F/m (CODATA 2022)."""


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
    >>> from types import SimpleNamespace
    >>> circuit = SimpleNamespace(bias_voltage=1.0, series_resistance=100.0, lead_resistance=0.0)
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
    >>> from types import SimpleNamespace
    >>> circuit = SimpleNamespace(bias_voltage=1.0, series_resistance=100.0, lead_resistance=0.0)
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
