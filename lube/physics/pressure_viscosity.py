"""Pressure-viscosity coefficient of an oil, estimated from its viscosity and kind of base oil."""

import numpy as np

from lube.types import Values

GOLD_BASES = {
    "mineral": (9.904, 0.1390),
    "polyalphaolefin": (7.382, 0.1335),
    "ester": (6.605, 0.1360),
    "polyglycol": (5.489, 0.1485),
}
"""Gold's s and t by base oil."""


def gold_pressure_viscosity(kinematic_viscosity: Values, base: str) -> Values:
    r"""Pressure-viscosity coefficient by Gold's form.

    .. math:: \alpha = s\, \nu^t \times 10^{-9}\ \mathrm{Pa}^{-1}

    Parameters
    ----------
    kinematic_viscosity : float or numpy.ndarray
        Kinematic viscosity :math:`\nu` at the temperature of interest, mm2/s, not SI.
    base : str
        A key of `GOLD_BASES`.

    Returns
    -------
    float or numpy.ndarray
        Pressure-viscosity coefficient :math:`\alpha`, 1/Pa.

    References
    ----------
    P. W. Gold, A. Schmidt, H. Dicke, J. Loos and C. Assmann, Viscosity-pressure-temperature
    behaviour of mineral and synthetic oils, J. Synth. Lubr. 18 (2001) 51-79.

    Examples
    --------
    >>> f"{gold_pressure_viscosity(335.0, 'polyalphaolefin'):.3g}"
    '1.6e-08'
    """
    s, t = GOLD_BASES[base]
    return s * np.asarray(kinematic_viscosity, dtype=float) ** t * 1e-9
