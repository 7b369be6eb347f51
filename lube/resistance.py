"""Electrical resistance of the metallic contact between the rollers."""

import numpy as np


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
