"""Electrical resistance between the rollers, and the circuit that measures it."""

import numpy as np

VACUUM_PERMITTIVITY = 8.8541878188e-12
"""Electric constant, F/m (CODATA 2022)."""


def contact_resistance(contact_length, resistivity):
    """Resistance of the contact spots in parallel, 1/R_c = L_con / rho (paper, Eq. 1).

    Parameters
    ----------
    contact_length : numpy.ndarray
        Sum of the contact diameters L_con, m.
    resistivity : float
        Resistivity rho of the rollers' material, ohm m.

    Returns
    -------
    numpy.ndarray
        Contact resistance R_c, ohm; infinite (an open circuit) where nothing touches.
    """
    with np.errstate(divide="ignore"):
        return resistivity / np.asarray(contact_length, float)


def divider_voltage(resistance, rig):
    """Voltage that the rig logs over a steady resistance between the rollers.

    Parameters
    ----------
    resistance : numpy.ndarray
        Resistance R of the contact, ohm; may be infinite.
    rig : Rig
        The circuit.

    Returns
    -------
    numpy.ndarray
        U (R_leads + R) / (R_series + R_leads + R), V.
    """
    past = rig.series_resistance / (np.asarray(resistance, float) + rig.lead_resistance)
    return rig.bias_voltage / (1.0 + past)


def resistance_from_voltage(voltage, rig):
    """Resistance between the rollers that a logged voltage tells of, the leads' subtracted.

    Parameters
    ----------
    voltage : numpy.ndarray
        Logged voltage, V.
    rig : Rig
        The circuit.

    Returns
    -------
    numpy.ndarray
        Ohm; infinite at the bias voltage and above. Noise may make it negative near zero.
    """
    voltage = np.asarray(voltage, float)
    rest = np.maximum(rig.bias_voltage - voltage, 0.0)
    with np.errstate(divide="ignore"):
        return rig.series_resistance * voltage / rest - rig.lead_resistance


def film_capacitance(film_thickness, half_width, length, permittivity):
    """Capacitance of the flat oil film in the contact.

    Parameters
    ----------
    film_thickness, half_width : numpy.ndarray
        h0 and a, m.
    length : float
        Length L' of the line contact, m.
    permittivity : float
        Relative permittivity of the oil.

    Returns
    -------
    numpy.ndarray
        eps0 eps_r 2 a L' / h0, F.
    """
    return VACUUM_PERMITTIVITY * permittivity * 2.0 * half_width * length / film_thickness
