"""The four regimes of lubrication: the film that each alone would give, and which one holds.

Rollers stay rigid or flatten, and the oil's viscosity rises with pressure or not. W, U and G,
M and L are those of `lube.groups`.
"""

import numpy as np


def moes_asymptotes(moes_load, moes_material):
    """Moes' film parameter in the four corners of the (M, L) plane.

    Parameters
    ----------
    moes_load, moes_material : float or numpy.ndarray
        M and L.

    Returns
    -------
    tuple of float or numpy.ndarray
        Rigid-isoviscous 3/M, rigid-piezoviscous 1.287 L^(2/3), elastic-isoviscous
        2.621 M^(-1/5), elastic-piezoviscous 1.311 M^(-1/8) L^(3/4), in the order of
        `lube.schema.REGIMES`. Each is film thickness over R* (2U)^(1/2).

    Notes
    -----
    The film meant is the one where the pressure is greatest. In the rigid limits that is
    1.226 times the film at the line of centres: 3/M is 2.447/M there, Martin's 4.9 U/W.
    """
    return (
        3.0 / moes_load,
        1.287 * moes_material ** (2.0 / 3.0),
        2.621 * moes_load**-0.2,
        1.311 * moes_load**-0.125 * moes_material**0.75,
    )


def regime_films(load, speed, material):
    """Film parameter H W/U that each of the four regimes alone would give.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    numpy.ndarray
        Shape (4, ...), in the order of `lube.schema.REGIMES`: 4.9, 1.05 g_V^(2/3),
        3.10 g_E^0.8 and 2.65 g_V^0.54 g_E^0.06 with the viscosity number
        g_V = W^1.5 G U^-0.5 and the elasticity number g_E = W U^-0.5.

    References
    ----------
    Johnson, J. Mech. Eng. Sci. 12 (1970), for the chart; the last constants are those of Martin,
    Herrebrugh and Dowson and Higginson.

    Notes
    -----
    4.9, 3.10 and 2.65 belong to the mean speed. Reynolds' equation for a rigid cylinder and a
    Barus oil gives 1.666 g_V^(2/3) with the mean speed; 1.05 is that constant for the sum of
    the speeds. It is kept because the greatest-of-four rule needs it: 2.65 g_V^0.54 g_E^0.06
    falls behind 1.666 g_V^(2/3) as the load rises, and heavily loaded contacts would be
    called rigid.
    """
    viscosity_number = load**1.5 * material / np.sqrt(speed)
    elasticity_number = load / np.sqrt(speed)
    films = (
        np.full_like(elasticity_number * viscosity_number, 4.9),
        1.05 * viscosity_number ** (2.0 / 3.0),
        3.10 * elasticity_number**0.8,
        2.65 * viscosity_number**0.54 * elasticity_number**0.06,
    )
    return np.stack(np.broadcast_arrays(*films))


def regime(load, speed, material):
    """Regime of lubrication: the one whose formula gives the thickest film.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    numpy.ndarray of int64
        Index into `lube.schema.REGIMES`. It sorts the contacts roughly; whether a formula
        may be used is decided by its limits in M and L, not by the regime.
    """
    return np.argmax(regime_films(load, speed, material), axis=0)
