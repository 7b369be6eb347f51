r"""Elastic contact of a rough surface with a rigid flat, and of its line with a row of springs.

The surface lies on an elastic half-space, periodic in both directions: a point that is pressed in
takes its surroundings along. The package tamaas solves this (`pip install 'lube[contact]'`). The
method of dimensionality reduction replaces the surface by a line, and the half-space by springs of
the stiffness :math:`E^* \Delta x`, each of which moves alone.

References
----------
L. Frérot, G. Anciaux, V. Rey, S. Pham-Ba and J.-F. Molinari, Tamaas: a library for elastic-plastic
contact of periodic rough surfaces, J. Open Source Softw. 5 (2020) 2121.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import scipy

from lube.errors import DataError, LubeError
from lube.types import Array

TOLERANCE = 1e-4
"""Largest relative error of a solution; a smaller one changes areas by less than a thousandth."""
PIXELS = (math.pi - 1.0 + math.log(2.0)) / 24.0
"""Excess area of a contact on a grid, in grid points, per side of a grid point on its edge."""


class Contact(NamedTuple):
    """Contact of a surface, or of the line that stands for it.

    Attributes
    ----------
    gap : float
        Mean gap between the deformed bodies, m.
    pressure : float
        Mean pressure on the nominal area, Pa.
    area_share : float
        Real contact area over the nominal area.
    contacts : float
        Number of contacts in the nominal area.
    """

    gap: float
    pressure: float
    area_share: float
    contacts: float


def find_tamaas():
    """Import tamaas, an optional dependency.

    Returns
    -------
    module
        The package.

    Raises
    ------
    LubeError
        If it is not installed.
    """
    try:
        import tamaas
    except ModuleNotFoundError:
        raise LubeError(
            "contact of a surface: the package tamaas is not installed, install it by "
            "pip install 'lube[contact]'"
        ) from None
    tamaas.set_log_level(tamaas.LogLevel.error)
    return tamaas


def press_surface(
    heights: Array, side: float, modulus: float, pressures: Sequence[float]
) -> Iterator[Contact]:
    r"""Press a rough surface against a rigid flat (Polonsky and Keer's method, by tamaas).

    A contact is a group of touching points that are neighbours in a row or a column. On a grid it
    is too large at its edge, so the area of n touching points is taken as

    .. math:: A = \Delta x^2 \left( n - \frac{\pi - 1 + \ln 2}{24} \, s \right)

    with the number s of sides between a touching point and one that does not touch (Yastrebov et
    al.).

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (M, M), m, of a periodic square, positive towards the flat.
    side : float
        Side of the square, m.
    modulus : float
        Reduced modulus :math:`E^*`, Pa.
    pressures : sequence of float
        Mean pressures, rising, Pa.

    Yields
    ------
    Contact
        Contact at each pressure.

    Raises
    ------
    LubeError
        If tamaas is not installed.
    DataError
        If no solution is found.

    References
    ----------
    I. A. Polonsky and L. M. Keer, A numerical method for solving rough contact problems based on
    the multi-level multi-summation and conjugate gradient techniques, Wear 231 (1999) 206-219.
    V. A. Yastrebov, G. Anciaux and J.-F. Molinari, On the accurate computation of the true
    contact-area in mechanical contact of random rough surfaces, arXiv 1701.02727.
    """
    tamaas = find_tamaas()
    points = heights.shape[0]
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0] * 2, [points] * 2)
    # Lengths over the side, and pressures over the pressure that deforms as much as the slopes do.
    model.E, model.nu = 1.0, 0.0
    scale = np.std(heights) / side
    surface = heights / (side * scale)
    solver = tamaas.PolonskyKeerRey(model, surface, TOLERANCE)
    for pressure in pressures:
        if not solver.solve(pressure / (modulus * scale)) <= TOLERANCE:
            raise DataError(f"contact of a surface: no solution found at {pressure:.3g} Pa")
        touching = model.traction > 0.0
        contacts = tamaas.FloodFill.getClusters(touching, False)
        sides = sum(contact.perimeter for contact in contacts)
        area = np.count_nonzero(touching) - PIXELS * sides
        gap = side * scale * np.mean(model.displacement - surface)
        yield Contact(gap, pressure, area / points**2, len(contacts))


def press_line(heights: Array, spacing: float, side: float, modulus: float, gap: float) -> Contact:
    r"""Press a line against a rigid flat, as the method of dimensionality reduction does.

    A line as long as the side of a square stands for the square. Springs that overlap by
    :math:`\delta_i` carry

    .. math:: F = E^* \Delta x \sum_i \delta_i ,

    and a segment of the length D stands for a round contact of the area :math:`\pi D^2/4`, as in
    the criterion for its boundary layer (paper, Eq. 6).

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (N,), m, of a periodic line, positive towards the flat. It may be longer than the
        side; it then stands for several squares, and the result is their mean.
    spacing : float
        Distance dx of neighbouring points, m.
    side : float
        Side of the square, m.
    modulus : float
        Reduced modulus :math:`E^*`, Pa.
    gap : float
        Mean gap between the line and the flat, counted as zero where they touch, m.

    Returns
    -------
    Contact
        Contact at this gap.
    """
    distance = scipy.optimize.newton(
        lambda distance: np.mean(np.maximum(distance - heights, 0.0)) - gap,
        gap,
        lambda distance: np.mean(heights < distance),
    )
    touching = np.roll(heights > distance, -np.argmin(heights))  # begins outside a segment
    edges = np.flatnonzero(np.diff(touching, append=False))
    lengths = spacing * (edges[1::2] - edges[::2])
    squares = heights.size * spacing / side
    force = modulus * spacing * np.sum(np.maximum(heights - distance, 0.0))
    area = 0.25 * math.pi * np.sum(lengths**2)
    nominal = squares * side**2
    return Contact(gap, force / nominal, area / nominal, lengths.size / squares)
