"""The four regimes of lubrication: the film that each alone would give, and which one holds.

Rollers stay rigid or flatten, and the oil's viscosity rises with pressure or not. Which of it
matters follows from Moes' M and L alone (`lube.physics.dimensionless`).
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


def regime(moes_load, moes_material):
    """Regime of lubrication: the one whose asymptote the film follows.

    Parameters
    ----------
    moes_load, moes_material : float or numpy.ndarray
        M and L.

    Returns
    -------
    numpy.ndarray of int64
        Index into `lube.schema.REGIMES`.

    Notes
    -----
    Of the asymptotes IR, PR, IE and PE, the film follows max(max(IR, IE), min(PR, PE)).
    Flattening *adds* to the film of an oil whose viscosity does not rise with pressure, but
    *limits* that of one whose viscosity does: the rigid film does not depend on the load, the
    elastic one falls with it. Moes' own formula joins the asymptotes the same way, by a positive
    power of the isoviscous ones and a negative power of the piezoviscous ones.
    """
    rigid_iso, rigid_piezo, elastic_iso, elastic_piezo = moes_asymptotes(moes_load, moes_material)
    isoviscous = np.maximum(rigid_iso, elastic_iso)
    piezoviscous = np.minimum(rigid_piezo, elastic_piezo)
    return np.where(
        isoviscous >= piezoviscous,
        np.where(rigid_iso >= elastic_iso, 0, 2),
        np.where(rigid_piezo <= elastic_piezo, 1, 3),
    )
