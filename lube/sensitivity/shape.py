"""The flat film that contact sees in a film with a shape."""

import logging
from collections.abc import Callable

import numpy as np
import scipy.special
from scipy.interpolate import RegularGridInterpolator

from lube.ehl.line_contact import ConvergenceError, LineContact, solve
from lube.sensitivity.conditions import Deviating
from lube.types import Array

log = logging.getLogger(__name__)

NODES = 12, 7, 30
"""Levels of Moes' numbers M and L, and of the lambda ratio."""
WINDOW = np.linspace(-1.2, 1.2, 241)
"""Positions over the half-width at which roughness may touch."""


def effective_ratio(deviating: Deviating, ranges: Array) -> Callable[[Array, Array, Array], Array]:
    """Tabulate the lambda ratio of the flat film in which as many points of the contact touch.

    A film with a shape is thinner at the outlet, so points touch there first. The share of points
    that touch, of Gaussian heights, gives the ratio; the rest of what a shape does is smooth.

    Parameters
    ----------
    deviating : Deviating
        The study, for the modulus of its rollers and a typical oil.
    ranges : numpy.ndarray
        Shape (3, 2): least and greatest M, L and lambda ratio, between which films are solved. A
        film that does not converge is that of the next smaller M.

    Returns
    -------
    callable
        Effective ratios from lambda ratios, M and L, arrays of the same shape.
    """
    levels = [np.geomspace(*ends, count) for ends, count in zip(ranges, NODES, strict=True)]
    oil = np.exp(deviating.oils.isel(lubricant=0).median())
    modulus = 2.0 * deviating.study.rollers.reduced_modulus
    material = oil["pressure_viscosity_coefficient"].item() * modulus
    viscosity = oil["dynamic_viscosity"].item()
    values = np.empty(NODES)
    for column, moes_material in enumerate(levels[1]):
        shape = np.ones(WINDOW.size)
        for row, moes_load in enumerate(levels[0]):
            speed = 0.5 * (moes_material / material) ** 4
            load = moes_load * np.sqrt(2.0 * speed)
            try:
                film = solve(LineContact(load, speed, material, viscosity, modulus))
                shape = film.scaled_gap(WINDOW) / film.central_gap
            except ConvergenceError as error:
                # The shape changes little from one level to the next.
                log.warning("M = %.3g, L = %.3g: %s", moes_load, moes_material, error)
            values[row, column] = _ratio(levels[2][:, None], shape) / levels[2]
    logarithms = tuple(np.log(each) for each in levels)
    options = {"bounds_error": False, "fill_value": None}
    table = RegularGridInterpolator(logarithms, values, "cubic", **options)

    def effective(ratio, moes_load, moes_material):
        axes = zip(logarithms, (moes_load, moes_material, ratio), strict=True)
        points = [np.clip(np.log(values), axis[0], axis[-1]) for axis, values in axes]
        return ratio * table(np.stack(points, axis=-1))

    return effective


def _ratio(ratios, shape):
    """Flat film in which as many points touch within the contact."""
    touching = scipy.special.log_ndtr(-ratios * shape)
    inside = np.count_nonzero(np.abs(WINDOW) <= 1.0)
    mean = scipy.special.logsumexp(touching, axis=1) - np.log(inside)
    return -scipy.special.ndtri_exp(np.minimum(mean, -1e-12))
