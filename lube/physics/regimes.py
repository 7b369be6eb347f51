"""The four regimes of lubrication: the asymptotic film of each, and the regime that holds.

The rollers stay rigid or deform elastically, and the oil's viscosity rises with pressure or not.
Which of the four combinations holds depends on the Moes numbers alone
(`lube.physics.dimensionless`).
"""

import numpy as np

from lube.types import Values


def moes_asymptotes(moes_load: Values, moes_material: Values) -> tuple[Values, ...]:
    r"""Moes' asymptotic films in the four corners of the (M, L) plane.

    .. math::

        H_{RI} = \frac{3}{M}, \quad
        H_{RP} = 1.287\, L^{2/3}, \quad
        H_{EI} = 2.621\, M^{-1/5}, \quad
        H_{EP} = 1.311\, M^{-1/8} L^{3/4}

    Parameters
    ----------
    moes_load, moes_material : float or numpy.ndarray
        :math:`M` and :math:`L`.

    Returns
    -------
    tuple of float or numpy.ndarray
        Film thickness over :math:`R^* \sqrt{2U}`: isoviscous-rigid, piezoviscous-rigid,
        isoviscous-elastic and piezoviscous-elastic, in the order of `lube.schema.REGIMES`.

    Notes
    -----
    The film is the one at the maximum of pressure. In the rigid limits that is 1.226 times the
    film at the line of centres, where 3/M becomes 2.447/M, Martin's 4.9 U/W.

    References
    ----------
    H. Moes, Optimum similarity analysis with applications to elastohydrodynamic lubrication,
    Wear 159 (1992) 57-66.

    Examples
    --------
    >>> moes_asymptotes(1.0, 1.0)
    (3.0, 1.287, 2.621, 1.311)
    """
    return (
        3.0 / moes_load,
        1.287 * moes_material ** (2.0 / 3.0),
        2.621 * moes_load**-0.2,
        1.311 * moes_load**-0.125 * moes_material**0.75,
    )


def asymptotic_film(moes_load: Values, moes_material: Values) -> Values:
    """Film of the asymptote that holds, over R* (2U)^0.5; arguments as in `moes_asymptotes`.

    Examples
    --------
    >>> float(asymptotic_film(1.0, 1.0))
    3.0
    """
    rigid_iso, rigid_piezo, elastic_iso, elastic_piezo = moes_asymptotes(moes_load, moes_material)
    piezoviscous = np.minimum(rigid_piezo, elastic_piezo)
    return np.maximum(np.maximum(rigid_iso, elastic_iso), piezoviscous)[()]


def asymptotic_gap(moes_load: Values, moes_material: Values) -> Values:
    r"""Film of the asymptote that holds, over a^2 / R*; arguments as in `moes_asymptotes`.

    .. math:: \frac{a^2}{R^{*2}} = \frac{8 W}{\pi}, \qquad M = \frac{W}{\sqrt{2U}}

    Examples
    --------
    >>> f"{asymptotic_gap(1.0, 1.0):.3f}"
    '1.178'
    """
    return asymptotic_film(moes_load, moes_material) * np.pi / (8.0 * moes_load)


def regime(moes_load: Values, moes_material: Values) -> np.ndarray:
    r"""Regime of lubrication: the one whose asymptote the film follows.

    .. math:: H = \max(\max(H_{RI}, H_{EI}), \min(H_{RP}, H_{EP}))

    Parameters
    ----------
    moes_load, moes_material : float or numpy.ndarray
        :math:`M` and :math:`L`.

    Returns
    -------
    numpy.ndarray of int64
        Index into `lube.schema.REGIMES`.

    Notes
    -----
    Elastic deformation *raises* the film of an oil whose viscosity does not rise with pressure. It
    *limits* the film of an oil whose viscosity does: the rigid film does not depend on the load,
    the elastic film falls with it. Moes' own formula joins the asymptotes in the same way, by a
    positive power of the isoviscous ones and a negative power of the piezoviscous ones.

    Examples
    --------
    >>> regime(np.array([0.2, 1.0, 50.0]), 8.0).tolist()
    [0, 1, 3]
    """
    rigid_iso, rigid_piezo, elastic_iso, _ = moes_asymptotes(moes_load, moes_material)
    film = asymptotic_film(moes_load, moes_material)  # exactly one of them
    return np.select([film == rigid_iso, film == elastic_iso, film == rigid_piezo], [0, 2, 1], 3)
