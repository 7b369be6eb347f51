"""The flat film that contact sees where a film has a shape, or the oil deforms the roughness."""

import itertools
from collections.abc import Callable, Mapping

import numpy as np
import scipy.special
import xarray as xr
from scipy.interpolate import NdBSpline, make_interp_spline

from lube.grid.gap import Gap
from lube.grid.levels import rolling
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.responses import HEIGHTS, NUMBERS, response_table, typical_films
from lube.study.uncertainty import deviating_lines

NODES = {"moes_load": 12, "moes_material": 7, "contact_half_width": 6, "lambda_ratio": 20}
"""Numbers of levels, evenly spaced in the logarithm."""
BAND = "longest_wavelength", "shortest_wavelength", "hurst_exponent"
"""Factors on which it depends how much of the roughness the oil leaves."""
BAND_NODES = 3
"""Number of levels of each, evenly spaced."""
WINDOW = np.linspace(-1.2, 1.2, 121)
"""Positions over the half-width at which roughness may touch."""
INSIDE = np.abs(WINDOW) <= 1.0
"""Those in the contact."""


def effective_ratio(
    deviating: Deviating, runs: xr.Dataset, gap: Gap, contact_model: str, solved=None
) -> Callable[[xr.DataArray, xr.Dataset, Mapping], xr.DataArray]:
    """Tabulate lambda ratios of the flat films in which as many points of the contact touch.

    A film with a shape is thinner at the outlet, so points touch there first. Where the oil deforms
    the roughness, each position has an rms height of its own. The share of points that touch, of
    Gaussian heights, gives the ratio; the rest of what shape and deformation do is smooth.

    Parameters
    ----------
    deviating : Deviating
        The study, for the modulus of its rollers and a typical oil.
    runs : xarray.Dataset
        Variables `NODES`. The table covers their films, and some more.
    gap : Gap
        With a shape of the film, a deformation of the roughness, or both.
    contact_model : str
        As in a study.
    solved : xarray.Dataset, optional
        From `lube.sensitivity.responses.solve_responses`, with a deformation; its levels of
        Moes' numbers are then those of the table.

    Returns
    -------
    callable
        Ratio by the table, from the lambda ratios of films, the films, and the deviations of the
        lines.
    """
    levels = {
        name: np.geomspace(0.9 * runs[name].min().item(), 1.1 * runs[name].max().item(), count)
        for name, count in NODES.items()
    }
    if gap.is_answered:
        levels |= {name: solved[name].values for name in NUMBERS}
    numbers = {name: levels[name] for name in NUMBERS}
    shapes = _shapes(deviating, numbers) if gap.has_shape else np.where(INSIDE, 1.0, np.inf)
    # Variables and their levels; of films the logarithms, the last is the lambda ratio.
    axes = {name: np.log(each) for name, each in numbers.items()}
    if gap.is_answered:
        half_widths = levels["contact_half_width"]
        uncertain = {name: getattr(deviating.study.uncertainty, name) for name in BAND}
        band = {name: np.linspace(*one.ends, BAND_NODES) for name, one in uncertain.items() if one}
        rough = _deformed(deviating, solved, contact_model, half_widths, band)
        shapes = shapes.reshape(*shapes.shape[:-1], *(1,) * (1 + len(band)), -1) / rough
        axes |= {"contact_half_width": np.log(half_widths)} | band
    ratios = levels["lambda_ratio"]
    found = [_ratio(ratios[:, None], one) / ratios for one in shapes.reshape(-1, WINDOW.size)]
    axes["lambda_ratio"] = np.log(ratios)
    multiple = _spline(axes, np.reshape(found, [each.size for each in axes.values()]))

    def effective(ratio, film, values):
        given = {**{name: np.log(film[name]) for name in NODES if name != "lambda_ratio"}, **values}
        given = xr.broadcast(np.log(ratio), *(given[name] for name in list(axes)[:-1]))
        each = zip((*given[1:], given[0]), axes.values(), strict=True)
        points = np.stack([np.clip(one.values, *axis[[0, -1]]) for one, axis in each], axis=-1)
        return given[0].copy(data=np.exp(given[0].values) * multiple(points))

    return effective


def _shapes(deviating, numbers):
    """Film at the window over that at the centre, at levels of M and L."""
    films = typical_films(deviating, **numbers)
    shapes = [film.scaled_gap(WINDOW) / film.central_gap for film in films.values.flat]
    return np.reshape(shapes, (*films.shape, WINDOW.size))


def _deformed(deviating, solved, contact_model, half_widths, band):
    """Rms heights over those drawn: over M, L, half-width, the factors of the band, and window."""
    table, wavelength = response_table(solved, contact_model)
    table = table.sel(slide_to_roll_ratio=rolling(deviating.study.slips))
    square = (np.abs(table) ** 2).interp(response_position=WINDOW).values
    found = []
    for half_width, *values in itertools.product(half_widths, *band.values()):
        lines = deviating_lines(deviating.study.line_spec, dict(zip(band, values, strict=True)))
        heights = HEIGHTS[contact_model](lines, half_width * wavelength)
        found.append(np.einsum("raw,mlrawx->mlx", heights / heights.sum(), square))
    found = np.sqrt(np.stack(found, axis=2))
    levels = [each.size for each in (half_widths, *band.values())]
    return found.reshape(*found.shape[:2], *levels, WINDOW.size)


def _spline(axes, values):
    """Tensor product of splines through values at the levels of all axes."""
    knots, degrees = [], []
    for axis, levels in enumerate(axes.values()):
        degrees.append(min(3, levels.size - 1))
        spline = make_interp_spline(levels, values, degrees[-1], axis=axis)
        knots.append(spline.t)
        values = np.moveaxis(spline.c, 0, axis)
    return NdBSpline(tuple(knots), np.ascontiguousarray(values), tuple(degrees))


def _ratio(ratios, shape):
    """Flat film in which as many points touch within the contact."""
    touching = scipy.special.log_ndtr(-ratios * shape)
    most = touching.max(axis=1)  # so that the smallest probabilities do not underflow
    mean = most + np.log(np.exp(touching - most[:, None]).sum(axis=1) / np.count_nonzero(INSIDE))
    return -scipy.special.ndtri_exp(np.minimum(mean, -1e-12))
