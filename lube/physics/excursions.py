r"""Theory of a Gaussian line or surface that rises above a high film.

A stationary Gaussian line z(x) is described by its moments :math:`m_0 = \langle z^2 \rangle`,
:math:`m_2 = \langle z'^2 \rangle` and :math:`m_4 = \langle z''^2 \rangle`.

References
----------
S. O. Rice, Mathematical analysis of random noise, Bell Syst. Tech. J. 23 (1944) 282-332 and
24 (1945) 46-156.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.special

from lube.types import Array, Values


class SurfaceMoments(NamedTuple):
    """Moments of a stationary Gaussian surface.

    Attributes
    ----------
    height : float
        Mean square height, m^2.
    along, across : float
        Mean square slopes along rolling and along the rollers.
    mixed : float
        Mean product of both slopes.
    curvature : float
        Mean square of the sum of both curvatures, 1/m^2.
    """

    height: float
    along: float
    across: float
    mixed: float
    curvature: float


class PassingContacts(NamedTuple):
    """Expected contacts of a strip through which a surface passes.

    Attributes
    ----------
    density : numpy.ndarray
        Contacts per length along rolling, 1/m, at each column of the strip.
    number : float
        Contacts in the strip.
    appearing : float
        Contacts that appear per rolled distance, the mean motion along rolling, 1/m.
    """

    density: Array
    number: float
    appearing: float


def crossing_rate(level: Values, moments: Sequence[float]) -> Values:
    r"""Upward crossings of a level per unit length (Rice).

    .. math:: \nu = \frac{1}{2 \pi} \sqrt{\frac{m_2}{m_0}} \exp\left( -\frac{h^2}{2 m_0} \right)

    Parameters
    ----------
    level : float or numpy.ndarray
        Level h, m.
    moments : sequence of float
        :math:`m_0` (m^2), :math:`m_2` and :math:`m_4` (1/m^2).

    Returns
    -------
    float or numpy.ndarray
        1/m.

    Examples
    --------
    >>> f"{crossing_rate(0.0, (1.0, 4.0, 100.0)):.4f}"
    '0.3183'
    """
    m0, m2, _ = moments
    return math.sqrt(m2 / m0) / (2.0 * math.pi) * np.exp(-0.5 * np.square(level) / m0)


def mean_overlap(level: Values, rms: Values) -> Values:
    r"""Mean of a Gaussian height above a level, counted as zero where it is below.

    .. math:: \sigma \left( \varphi(t) - t\, Q(t) \right), \qquad t = h / \sigma

    Parameters
    ----------
    level : float or numpy.ndarray
        Level h, m.
    rms : float or numpy.ndarray
        Rms height :math:`\sigma`, m.

    Returns
    -------
    float or numpy.ndarray
        m.

    Examples
    --------
    >>> f"{mean_overlap(0.0, 1.0):.4f}"
    '0.3989'
    """
    height = level / rms
    density = np.exp(-0.5 * np.square(height)) / math.sqrt(2.0 * math.pi)
    return rms * (density - height * scipy.special.ndtr(-height))


def expected_contacts(level: Array, moments: SurfaceMoments, length: float, width: Array) -> Array:
    r"""Compute the expected number of contacts of a surface above a level.

    The surface is a rectangle.

    The formula gives the expected Euler characteristic: the number of contacts less the holes in
    them. At high levels contacts have no holes. With :math:`u = h / \sqrt{m_0}`, the sides a along
    rolling and b along the rollers, and the matrix :math:`\Sigma` of the mean squares :math:`m_a`
    and :math:`m_b` and the mean product of both slopes,

    .. math::

        Q(u) + \frac{a \sqrt{m_a} + b \sqrt{m_b}}{2 \pi \sqrt{m_0}}\, e^{-u^2/2}
        + a b \frac{u}{(2 \pi)^{3/2}} \frac{\sqrt{\det \Sigma}}{m_0}\, e^{-u^2/2}

    Parameters
    ----------
    level : numpy.ndarray
        Levels h, m.
    moments : SurfaceMoments
        Moments of the surface.
    length : float
        Side along the rollers, m.
    width : numpy.ndarray
        Side along rolling, m; it broadcasts against the levels.

    Returns
    -------
    numpy.ndarray
        Expected number.

    References
    ----------
    R. J. Adler and J. E. Taylor, Random Fields and Geometry, Springer, 2007, chapter 11.

    Examples
    --------
    >>> moments = SurfaceMoments(1.0, along=4.0, across=4.0, mixed=0.0, curvature=100.0)
    >>> expected_contacts(np.array([4.0]), moments, 10.0, 20.0).round(3)
    array([0.071])
    """
    height = np.asarray(level) / math.sqrt(moments.height)
    slopes = math.sqrt(moments.along * moments.across - moments.mixed**2)
    area = length * width * height * slopes / moments.height / (2.0 * math.pi) ** 1.5
    edges = length * math.sqrt(moments.across) + width * math.sqrt(moments.along)
    edges = edges / (2.0 * math.pi * math.sqrt(moments.height))
    return scipy.special.ndtr(-height) + (edges + area) * np.exp(-0.5 * height**2)


def passing_contacts(
    level: Array, changes: Array, length: float, spacing: float, has_edges: bool
) -> PassingContacts:
    r"""Compute how many contacts are expected in a strip, and how many appear in it.

    At column x of the strip the height over its rms value exceeds the level u(x) where the surface
    touches. With the mean squares and products of the changes of this height along rolling (x),
    along the rollers (y) and in the motion (t), at a given slope along the rollers

    .. math::

        a = m_{xx} - \frac{m_{xy}^2}{m_{yy}}, \quad p = m_{xt} - \frac{m_{xy} m_{yt}}{m_{yy}}, \quad
        c = m_{tt} - \frac{m_{yt}^2}{m_{yy}} ,

    and a normal variable :math:`\xi`, a strip of the length L has the contacts

    .. math::

        \int n\, dx + \sum_\text{edges} \frac{L \sqrt{m_{yy}}}{4 \pi} e^{-u^2/2} , \qquad
        n(x) = \frac{L u \sqrt{m_{yy}}}{4 \pi}\, e^{-u^2/2}
        \left\langle \left| \sqrt{a}\, \xi - u' \right| \right\rangle .

    The surface begins to touch on one side of a contact, and ends on the other. Contacts appear
    where a summit rises above the level in the course of the motion, or where the strip's edge cuts
    a flank that rises. With :math:`n_0` for n without the slope u', there are per rolled distance

    .. math::

        \int n_0 \left( u - \frac1u \right) \left\langle \left( \frac{p}{a} u'
        + \sqrt{c - \frac{p^2}{a}}\, \xi \right)^+ \right\rangle dx
        + \sum_\text{edges} \frac{n_0}{2 \sqrt a} \left( \sqrt{c} \mp \frac{p}{\sqrt a} \right),

    the upper sign where the strip begins. The ends of the rollers add the same without y: there
    :math:`L u (m_{yy} / 2 \pi)^{1/2}` and :math:`u - 1/u` become 1 and u.

    Parameters
    ----------
    level : numpy.ndarray
        Levels u, above zero, shape (columns,).
    changes : numpy.ndarray
        Covariances of the changes of the height over its rms value along rolling, along the
        rollers, and per rolled distance, 1/m^2, shape (columns, 3, 3).
    length, spacing : float
        Length of the strip along the rollers, and distance of its columns, m.
    has_edges : bool
        Whether contacts are cut where the strip ends.

    Returns
    -------
    PassingContacts
        The numbers are those of bodies without holes: contacts that merge count as several.

    References
    ----------
    R. J. Adler and J. E. Taylor, Random Fields and Geometry, Springer, 2007, chapters 11 and 12.

    Examples
    --------
    Without slip a contact passes the width and its own extent:

    >>> moments = SurfaceMoments(1.0, along=4.0, across=4.0, mixed=0.0, curvature=100.0)
    >>> rolling = np.array([[4.0, 0.0, -4.0], [0.0, 4.0, 0.0], [-4.0, 0.0, 4.0]])
    >>> found = passing_contacts(np.full(40, 4.0), np.tile(rolling, (40, 1, 1)), 10.0, 0.5, True)
    >>> f"{found.number:.4f} {found.appearing:.4f}"
    '0.0714 0.0035'
    >>> wider = expected_contacts(np.array([4.0]), moments, 10.0, np.array([21.0, 20.0]))
    >>> f"{wider[1]:.4f} {wider[0] - wider[1]:.4f}"
    '0.0714 0.0035'
    """
    decay = np.exp(-0.5 * np.square(level)) / (2.0 * math.pi)
    pairs = (0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)
    xx, yy, tt, xy, xt, yt = (changes[:, i, j] for i, j in pairs)
    sides = length * np.sqrt(yy)
    within = sides * level / math.sqrt(2.0 * math.pi), level - 1.0 / level
    within = *within, xx - xy**2 / yy, xt - xy * yt / yy, tt - yt**2 / yy
    density, appearing, slope = 0.0, 0.0, np.gradient(level, spacing)
    for weight, order, a, p, c in (within, (1.0, level, xx, xt, tt)):
        spread = np.sqrt(a)
        begin, end = (mean_overlap(sign * slope, spread) for sign in (1.0, -1.0))
        density += weight * decay * math.sqrt(0.5 * math.pi) * (begin + end)
        # At a column a summit rises above the level by its own change and along the level's slope.
        rising = mean_overlap(-p / a * slope, np.sqrt(np.maximum(c - p**2 / a, 1e-24 * c)))
        more = weight * spread * decay * np.maximum(order, 0.0) * rising
        appearing += spacing * np.sum(more)
        if has_edges:
            scale, own = 0.5 * weight * decay, np.sqrt(c)
            first, last = scale * (own - p / spread), scale * (own + p / spread)
            appearing += first[0] + last[-1]
    number = spacing * np.sum(density)
    if has_edges:
        number += 0.5 * np.sum((sides * decay + scipy.special.ndtr(-level))[[0, -1]])
    return PassingContacts(density, number, appearing)
