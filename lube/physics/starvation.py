"""Starvation: how an inlet with too little oil thins the film."""

import numpy as np

from lube.errors import RangeError
from lube.physics.hertz import hertz_gap
from lube.types import Array, Values

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
_REACH = 12.0
"""Range of the integral on either side of its scales, in the logarithm of the distance."""
_STEPS = 40


def starvation_factor(film: Values, meniscus: Values) -> Values:
    r"""Factor by which starvation thins the film if the oil begins at a meniscus near the contact.

    In the inlet analysis of Ertel and Grubin the pressure at the edge of Hertz' contact is the
    same at any load, and it is built up in the gap of the dry contact, lifted by the film:

    .. math::

        \int_1^{X_m} \frac{G}{(H + G)^3} \, dX = \int_1^\infty \frac{G}{(H_\infty + G)^3} \, dX,
        \qquad C = \frac{H}{H_\infty}

    with the gap G(X) of `hertz_gap`. The film H and the flooded film H_inf are scaled as the gap
    is. Speed, viscosity and the pressure-viscosity coefficient act through the flooded film alone.

    Parameters
    ----------
    film : float or numpy.ndarray
        Flooded film over a^2 / R*, with the half-width a of the contact.
    meniscus : float or numpy.ndarray
        Distance from the line of centres to the meniscus, over a; broadcasts against the film.

    Returns
    -------
    float or numpy.ndarray
        The factor, between 0 and 1; NaN where the film or the meniscus is.

    Raises
    ------
    RangeError
        If a meniscus lies inside the contact.

    References
    ----------
    A. N. Grubin, Central Sci. Res. Inst. Technol. Mech. Eng., Book 30 (1949), here with an inlet
    of finite length. Against the solution of Reynolds' equation the factor is right to 0.02 at
    M = 3 and above; at M = 1.9 to 0.02 at L = 10 and to 0.07 at L = 5:
    ``tests/physics/test_starvation.py``.

    Examples
    --------
    >>> starvation_factor(1.16, np.array([2.0, 5.0, 50.0])).round(3).tolist()
    [0.663, 0.962, 1.0]
    """
    film, meniscus = np.broadcast_arrays(np.asarray(film, float), np.asarray(meniscus, float))
    if np.any(meniscus <= 1.0):
        raise RangeError(
            f"meniscus: got {np.nanmin(meniscus):g} half-widths before the line of centres, inside "
            "the contact, need more than 1 half-width"
        )
    wanted, _ = inlet_integral(np.log(film), film, np.inf)
    log_film = np.log(film)
    # The integral's logarithm is concave in the film's, so Newton's steps do not overshoot.
    for _ in range(_STEPS):
        found, slope = inlet_integral(log_film, film, meniscus)
        step = (wanted - found) / slope
        log_film = log_film + step
        if np.nanmax(np.abs(step), initial=0.0) < 1e-12:
            break
    return (np.exp(log_film) / film)[()]


def inlet_integral(log_film: Array, flooded: Array, meniscus: Values) -> tuple[Array, Array]:
    """Logarithm of the inlet's integral, and its slope against the film's logarithm."""
    # Distances at which gap and film are equal: the gap grows as d^1.5 near, as d^2 far off.
    scales = np.log(flooded) * np.array([[2.0 / 3.0], [0.5]]).reshape(2, *(1,) * flooded.ndim)
    last = np.minimum(np.log(meniscus - 1.0), scales.max(axis=0) + _REACH)
    first = np.minimum(scales.min(axis=0), last) - _REACH
    half = 0.5 * (last - first)[..., None]
    distance = np.exp(last[..., None] - half * (1.0 - _NODES))
    gap, film = hertz_gap(1.0 + distance), np.exp(log_film)[..., None]
    share = _WEIGHTS * half * distance * gap / (film + gap) ** 3
    total = share.sum(axis=-1)
    slope = -3.0 * (share * film / (film + gap)).sum(axis=-1) / total
    return np.log(total), slope
