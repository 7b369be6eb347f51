"""Between labelled metres and the kernels' whole numbers: height steps, grid points, time steps."""

import numpy as np

from lube.errors import DataError
from lube.kernels.layer import layer_factor


def speed_ratios(slide_to_roll_ratio):
    """Speeds of the two surfaces, over the faster one's.

    Parameters
    ----------
    slide_to_roll_ratio : float
        (v1 - v2) / v with the mean surface speed v = (v1 + v2) / 2.

    Returns
    -------
    tuple of float
        v1 / max(v1, v2) and v2 / max(v1, v2).
    """
    first, second = 1.0 + slide_to_roll_ratio / 2.0, 1.0 - slide_to_roll_ratio / 2.0
    return first / max(first, second), second / max(first, second)


def revolution(pair, ratios):
    """Time steps in one revolution of the roller with the faster surface.

    Parameters
    ----------
    pair : tuple of numpy.ndarray
        The two lines.
    ratios : tuple of float
        From `speed_ratios`.

    Returns
    -------
    int
        Points around that roller; the first roller's where both are equally fast.
    """
    return pair[0].size if ratios[0] == 1.0 else pair[1].size


def line_pair(lines, realisation):
    """Pick the two lines of a realisation as whole height steps.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    realisation : int
        Which realisation.

    Returns
    -------
    tuple of numpy.ndarray
        Two int32 lines, shapes (N1,) and (N2,).

    Raises
    ------
    DataError
        If the dataset does not hold the realisation.
    """
    if realisation not in lines["realisation"].values:
        raise DataError(f"realisation {realisation} is not among the roughness lines")
    heights = lines["height"].sel(realisation=realisation).values
    pair = []
    for row, points in zip(heights, lines.attrs["points"], strict=True):
        line = row[: int(points)]
        if line.dtype.kind == "f":
            line = np.rint(line / lines.attrs["height_step"]).astype(np.int32)
        pair.append(np.ascontiguousarray(line))
    return tuple(pair)


def layer_factor_of(lines, reduced_modulus, boundary_layer):
    """Factor of `lube.kernels.layer.layer_factor` for labelled lines.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    reduced_modulus : float
        E*, Pa.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).

    Returns
    -------
    float
        The factor, per height step of overlap.
    """
    return layer_factor(
        reduced_modulus,
        boundary_layer.critical_thickness,
        boundary_layer.shear_strength,
        lines.attrs["spacing"],
        lines.attrs["height_step"],
    )


def whole_numbers(film_thickness, half_width, lines):
    """Film in height steps and half-window in grid points, as the kernels take them.

    Parameters
    ----------
    film_thickness, half_width : array_like
        h0 and a, m, of equal shape.
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.

    Returns
    -------
    films, half_windows : numpy.ndarray
        h0 rounded to height steps, and floor(a / dx); int64.
    """
    # Lines never reach through so many steps, and more than 2**63 would wrap round to few.
    steps = np.minimum(np.asarray(film_thickness) / lines.attrs["height_step"], 2.0**40)
    films = np.rint(steps)
    half_windows = np.floor(np.asarray(half_width) / lines.attrs["spacing"])
    return films.astype(np.int64), half_windows.astype(np.int64)
