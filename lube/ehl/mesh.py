"""Nodes of the computed film: a first mesh, and one fitted to a solution."""

import numpy as np

from lube.types import Array

_FIRST_SIZE, _FIRST_GROWTH = 0.05, 1.12
_LARGEST = 0.1
"""Largest cell, over the contact's width by `breadth`, and over the distance from it."""
_GROWTH = 0.1
"""Largest growth of the cell size per length."""
_PRESSURE_STEP, _FILM_STEP, _VISCOSITY_STEP = 0.03, 0.08, 0.35
"""Largest steps of P, ln H and ln viscosity from node to node."""
_MARGIN = 0.3
"""Length of the mesh beyond the end of the film, over the contact's width by `breadth`."""
_SAMPLES = 8
"""Samples of the cell size per cell of the former mesh."""


def breadth(film: float) -> float:
    """Half-width of the pressure: Hertz' 1 if the central film H is thin, more if it is thick."""
    return np.sqrt(1.0 + 2.0 * film)


def inlet_end(offset: float, gap: float) -> float:
    """Position in the inlet at which the gap has a certain height.

    Parameters
    ----------
    offset : float
        Offset of the rollers: the gap less its parabola and the deflection.
    gap : float
        Height of the gap; large.

    Returns
    -------
    float
        Position X < 0. Far away the rollers bulge as under a point load: the gap is
        X^2/2 - ln|X|/2 + offset.

    Examples
    --------
    >>> position = inlet_end(0.0, 1000.0)
    >>> f"{position**2 / 2 - np.log(-position) / 2:.4f}"
    '1000.0000'
    """
    distance = np.sqrt(2.0 * gap)
    for _ in range(8):
        distance = np.sqrt(2.0 * (gap - offset) + np.log(distance))
    return -float(distance)


def first_mesh(film: float, end: float) -> Array:
    """Nodes for a film of which only a guess of the thickness is known.

    Parameters
    ----------
    film : float
        Guess of the central film H.
    end : float
        Position X < 0 at which the oil begins.

    Returns
    -------
    numpy.ndarray
        Positions X of the nodes, rising: evenly spaced in the contact, farther and farther apart
        towards the inlet.

    Examples
    --------
    >>> nodes = first_mesh(0.1, -50.0)
    >>> nodes.size, float(nodes[0])
    (99, -50.0)
    """
    core = np.arange(-1.6, 1.3, _FIRST_SIZE) * breadth(film)
    steps = (core[1] - core[0]) * _FIRST_GROWTH ** np.arange(1, 200)
    inlet = core[0] - np.cumsum(steps)
    inlet = inlet[inlet > end + 0.5 * steps]
    return np.concatenate([[end], inlet[::-1], core[core > end + 0.5 * _FIRST_SIZE]])


def fitted_mesh(profile, end: float, fineness: float) -> Array:
    """Nodes on which pressure, film and viscosity change little from one to the next.

    Parameters
    ----------
    profile : lube.ehl.line_contact.FilmProfile
        A solution on other nodes.
    end : float
        Position X < 0 at which the oil begins.
    fineness : float
        The number of nodes grows in proportion.

    Returns
    -------
    numpy.ndarray
        Positions X of the new nodes, rising.
    """
    nodes, middle, step = profile.nodes, profile.middle, np.diff(profile.nodes)
    width = breadth(profile.central_gap)
    logarithm, _ = profile.contact.log_viscosity(profile.pressure)
    driven = np.abs(profile.flow.pressure_flow / profile.flow.flux)
    density = np.max(
        [
            np.abs(np.diff(_smooth(profile.pressure))) / step * width / _PRESSURE_STEP,
            np.abs(np.gradient(np.log(profile.flow.gap), middle)) / _FILM_STEP,
            # Where no oil is driven by pressure, its viscosity does not matter.
            (driven > 1e-3) * np.abs(np.diff(_smooth(logarithm))) / step / _VISCOSITY_STEP,
            1.0 / (_LARGEST * np.hypot(width, middle)),
        ],
        axis=0,
    )
    high = nodes[profile.end] + _MARGIN * width
    samples = np.interp(np.arange(0, nodes.size, 1 / _SAMPLES), np.arange(nodes.size), nodes)
    samples = np.concatenate([[end], samples[(samples > end) & (samples < high)], [high]])
    size = (1.0 / density + _GROWTH * np.abs(samples[:, None] - middle)).min(axis=1) / fineness
    cells = 2.0 * np.diff(samples) / (size[1:] + size[:-1])
    count = np.append(0.0, np.cumsum(cells))
    return np.interp(np.linspace(0.0, count[-1], int(np.ceil(count[-1])) + 1), count, samples)


def _smooth(values):
    """Remove oscillations from node to node.

    Such an oscillation of the pressure does not deflect the rollers midway between the nodes. Where
    the oil is almost solid it drives no oil either, so it is no reason for a finer mesh.
    """
    smooth = values.copy()
    smooth[1:-1] = 0.25 * (values[:-2] + 2.0 * values[1:-1] + values[2:])
    return smooth
