"""From SI units to the kernels' whole numbers: height steps, grid points and time steps."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.grid.operating_points import surface_speeds
from lube.kernels.layer import layer_factor
from lube.types import Pair, Ratios, Values


@dataclass(frozen=True)
class LineGrid:
    """Points and heights of roughness lines; a `lube.study.line_spec.LineSpec` serves as well.

    Attributes
    ----------
    spacing : float
        Distance dx of neighbouring points, m.
    height_step : float
        Height of one step of the whole-number heights, m.
    q_max : float
        Largest wave number of both lines, rad/m.
    """

    spacing: float
    height_step: float
    q_max: float = np.inf

    @classmethod
    def of(cls, lines: xr.Dataset) -> "LineGrid":
        """Grid of a ``roughness`` dataset."""
        attrs = lines.attrs
        return cls(attrs["spacing"], attrs["height_step"], float(np.max(attrs["q_max"])))


UNKNOWN_FILM = 2**40
"""Height steps that stand for an unknown film: more than any sum of two lines, and few enough not
to overflow int64."""


def speed_ratios(slide_to_roll_ratio: float) -> Ratios:
    r"""Speeds of the two surfaces over that of the faster one.

    .. math:: \frac{v_i}{\max(v_1, v_2)}

    Parameters
    ----------
    slide_to_roll_ratio : float
        As in `lube.grid.operating_points.surface_speeds`.

    Returns
    -------
    tuple of float
        Ratios of the first and the second surface; one of them is 1.

    Examples
    --------
    >>> speed_ratios(0.0), speed_ratios(1.0)
    ((1.0, 1.0), (1.0, 0.3333333333333333))
    """
    first, second = surface_speeds(1.0, slide_to_roll_ratio)
    return first / max(first, second), second / max(first, second)


def revolution(pair: Pair, ratios: Ratios) -> int:
    """Count the time steps in one revolution of the roller with the faster surface.

    Parameters
    ----------
    pair : tuple of numpy.ndarray
        The two lines, shapes (N1,) and (N2,).
    ratios : tuple of float
        From `speed_ratios`.

    Returns
    -------
    int
        Points around that roller; around the first roller if both are equally fast.

    Examples
    --------
    >>> revolution((np.zeros(100), np.zeros(80)), speed_ratios(-0.1))
    80
    """
    return pair[0].size if ratios[0] == 1.0 else pair[1].size


def line_pair(lines: xr.Dataset, realisation: int) -> Pair:
    """Extract the two lines of a realisation in whole height steps.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    realisation : int
        Number of the realisation.

    Returns
    -------
    tuple of numpy.ndarray
        Two int32 lines, shapes (N1,) and (N2,), height steps.

    Raises
    ------
    DataError
        If the dataset does not hold the realisation.

    Examples
    --------
    Lines of three and two points, with height steps of 1 pm:

    >>> heights = [[[1e-9, 0.0, 0.0], [0.0, 2e-9, np.nan]]]
    >>> lines = xr.Dataset(
    ...     {"height": (("realisation", "roller", "position"), heights)},
    ...     {"realisation": [7]},
    ...     {"points": [3, 2], "height_step": 1e-12},
    ... )
    >>> line_pair(lines, 7)
    (array([1000,    0,    0], dtype=int32), array([   0, 2000], dtype=int32))
    """
    if realisation not in lines["realisation"].values:
        raise DataError(f"realisation {realisation} is not among the roughness lines")
    heights = lines["height"].sel(realisation=realisation).values
    pair = [row[:points] for row, points in zip(heights, lines.attrs["points"], strict=True)]
    if heights.dtype.kind == "f":
        pair = [np.rint(line / lines.attrs["height_step"]).astype(np.int32) for line in pair]
    return tuple(map(np.ascontiguousarray, pair))


def layer_factor_of(grid: LineGrid, reduced_modulus: float, boundary_layer) -> float:
    """Compute `lube.kernels.layer.layer_factor` on the grid of some lines.

    Parameters
    ----------
    grid : LineGrid
        Grid of the lines.
    reduced_modulus : float
        E*, Pa.
    boundary_layer : lube.study.rollers.BoundaryLayer
        The boundary layer, or an object with the same attributes.

    Returns
    -------
    float
        The factor, per height step of overlap.
    """
    thickness, strength = boundary_layer.critical_thickness, boundary_layer.shear_strength
    return layer_factor(reduced_modulus, thickness, strength, grid.spacing, grid.height_step)


def whole_numbers(film_thickness: Values, half_width: Values, grid: LineGrid) -> Pair:
    r"""Express films in height steps and half-windows in grid points.

    Parameters
    ----------
    film_thickness, half_width : float or numpy.ndarray
        :math:`h_0` and :math:`a`, m, of equal shape.
    grid : LineGrid
        Grid of the lines.

    Returns
    -------
    films, half_windows : numpy.ndarray
        int64: :math:`h_0 / q` rounded, with the height step :math:`q`, and
        :math:`\lfloor a / \Delta x \rfloor`. An unknown film (NaN) becomes `UNKNOWN_FILM`.

    Examples
    --------
    >>> whole_numbers([1e-9], [3.9e-6], LineGrid(spacing=1e-6, height_step=1e-12))
    (array([1000]), array([3]))
    """
    films = np.rint(np.fmin(np.asarray(film_thickness) / grid.height_step, UNKNOWN_FILM))
    half_windows = np.floor(np.asarray(half_width) / grid.spacing)
    return films.astype(np.int64), half_windows.astype(np.int64)
