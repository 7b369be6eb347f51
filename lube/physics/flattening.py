"""Flattening of roughness in a lubricated contact."""

from lube.types import Values


def amplitude_ratio(wavelength: Values, moes_load: Values, moes_material: Values) -> Values:
    r"""Fraction of its height that a wave keeps in an elastohydrodynamic line contact.

    .. math::

        \frac{A_d}{A_i} = \frac{1}{1 + 0.17\, N + 0.03\, N^2}, \qquad
        N = \frac{\lambda}{a} \frac{M^{3/4}}{L^{1/2}}

    Parameters
    ----------
    wavelength : float or numpy.ndarray
        Wavelength :math:`\lambda` over the half-width a of the contact.
    moes_load, moes_material : float or numpy.ndarray
        Moes numbers M and L.

    Returns
    -------
    float or numpy.ndarray
        The ratio, 1 for short waves, 0 for long ones.

    Notes
    -----
    The formula is for transverse waves in pure rolling, under a full film. It was read in a
    transcription of the source, not in print; its values follow the table of the source, which
    begins at M = 100, L = 11. It is usable from about M = 20 on. Waves of one and half the
    half-width are by the formula 9 to 16 % lower than by Reynolds' equation (`lube.ehl.response`)
    at M = 5 and 10, 6 and 14 % at M = 20, and within 7 % from M = 40 on. Below M = 5 they lose up
    to 22 %, and at most 5 % by Reynolds' equation.

    References
    ----------
    C. H. Venner, F. Couhier, A. A. Lubrecht and J. A. Greenwood, Amplitude reduction of waviness in
    transient EHL line contacts, Proc. 23rd Leeds-Lyon Symposium on Tribology (1996).

    Examples
    --------
    >>> f"{amplitude_ratio(1.0, 100.0, 11.0):.3f}"
    '0.187'
    """
    number = wavelength * moes_load**0.75 / moes_material**0.5
    return 1.0 / (1.0 + 0.17 * number + 0.03 * number**2)
