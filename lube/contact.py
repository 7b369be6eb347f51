"""The MDR stage: how often and how long the rough lines touch in the contact window.

The compiled kernels work on whole height steps and grid points; here films, half-widths and
counts are turned into them and back. An operating point reaches the kernels only as its film
thickness and window, so any dimension of the film table passes through unchanged.
"""

import logging

import numpy as np
import xarray as xr

from lube.kernels.strips import strip_statistics
from lube.schema import OPERATING_DIMS, label
from lube.steps import layer_factor_of, line_pair, revolution, speed_ratios, whole_numbers

log = logging.getLogger(__name__)


def contact_statistics(lines, film, boundary_layer, slide_to_roll_ratio=(0.0,), revolutions=1):
    """Run the model for all realisations and operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    film : xarray.Dataset
        A ``film`` dataset.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).
    slide_to_roll_ratio : sequence of float, optional
        Levels of the slide-to-roll ratio; pure rolling if not given.
    revolutions : int, optional
        Revolutions of the roller with the faster surface.

    Returns
    -------
    xarray.Dataset
        The ``contact_batch`` file of `lube.schema`: probabilities, mean contact length (m)
        and mean contact force (N) over (realisation, slide_to_roll_ratio, lubricant,
        film_formula, temperature, speed, force).
    """
    thickness, half_width = (
        array.transpose(*OPERATING_DIMS)
        for array in xr.broadcast(film["film_thickness"], film["contact_half_width"])
    )
    results = _run(
        lines, film, boundary_layer, thickness, half_width, slide_to_roll_ratio, revolutions
    )
    ratios = np.asarray(slide_to_roll_ratio, float)
    dataset = results.assign_coords(
        slide_to_roll_ratio=ratios, **{name: film[name] for name in OPERATING_DIMS}
    )
    return label(dataset, "contact_batch")


def contact_map(lines, film, boundary_layer, lambda_levels=40, width_levels=9):
    """Run the model in pure rolling over all films and windows that a study spans.

    A realisation's answer depends on the film thickness and the window alone, whatever force,
    speed, temperature and oil are behind them: this maps it.

    Parameters
    ----------
    lines, film, boundary_layer
        As in `contact_statistics`.
    lambda_levels, width_levels : int, optional
        Numbers of levels between the film table's least and greatest, of the lambda ratio in
        equal proportions, of the contact width in equal steps.

    Returns
    -------
    xarray.Dataset
        The ``master_batch`` file of `lube.schema`: probabilities over (realisation,
        lambda_ratio, contact_width).
    """
    ratio, half_width = film["lambda_ratio"], film["contact_half_width"]
    lambda_ratio = _levels("lambda_ratio", np.geomspace, ratio, lambda_levels)
    contact_width = _levels("contact_width", np.linspace, 2.0 * half_width, width_levels)
    thickness = lambda_ratio * film["composite_rms_roughness"].item()
    thickness, half_width = xr.broadcast(thickness, contact_width / 2.0)
    results = _run(lines, film, boundary_layer, thickness, half_width, (0.0,), 1)
    mapped = results[["breakthrough_probability", "geometric_contact_probability"]]
    return label(mapped.isel(slide_to_roll_ratio=0), "master_batch")


def _levels(name, between, values, count):
    """Levels over the range of some values; one where they are all the same."""
    levels = np.unique(between(values.min().item(), values.max().item(), count))
    return xr.DataArray(levels, dims=name, coords={name: levels})


def _run(lines, film, boundary_layer, thickness, half_width, slide_to_roll_ratio, revolutions):
    """Statistics over (realisation, slide_to_roll_ratio, dimensions of the film thickness)."""
    reduced_modulus = film["reduced_modulus"].item()
    factor = layer_factor_of(lines, reduced_modulus, boundary_layer)
    films, half_windows, back = _distinct_points(thickness, half_width, lines)
    counts = np.empty((lines.sizes["realisation"], len(slide_to_roll_ratio), films.size, 4))
    for r, realisation in enumerate(lines["realisation"].values):
        pair = line_pair(lines, realisation)
        for s, ratio in enumerate(slide_to_roll_ratio):
            ratios = speed_ratios(ratio)
            steps = revolutions * revolution(pair, ratios)
            counts[r, s] = strip_statistics(*pair, ratios, steps, films, half_windows, factor)
            counts[r, s] /= steps
            log.info("realisation %d, slide-to-roll ratio %g: done", realisation, ratio)
    touching, breaking, points, overlap = np.moveaxis(counts[:, :, back], -1, 0)
    spacing = lines.attrs["spacing"]
    stiffness = reduced_modulus * spacing  # of one spring, Eq. 5
    results = {
        "geometric_contact_probability": touching,
        "breakthrough_probability": breaking,
        "mean_contact_length": points * spacing,
        "mean_contact_force": overlap * lines.attrs["height_step"] * stiffness,
    }
    dims = ("realisation", "slide_to_roll_ratio", *thickness.dims)
    shape = counts.shape[:2] + thickness.shape
    dataset = xr.Dataset(
        {name: (dims, values.reshape(shape)) for name, values in results.items()},
        coords={"realisation": lines["realisation"].values, **thickness.coords},
        attrs={
            "travel": spacing * min(lines.attrs["points"]),
            "longest_wavelength": 2.0 * np.pi / lines.attrs["q_min"],
        },
    )
    dataset["critical_thickness"] = boundary_layer.critical_thickness
    dataset["shear_strength"] = boundary_layer.shear_strength
    return dataset


def _distinct_points(thickness, half_width, lines):
    """Points as distinct (film, half-window) pairs, and the way back to all of them."""
    wholes = whole_numbers(thickness.values.ravel(), half_width.values.ravel(), lines)
    (films, half_windows), back = np.unique(np.stack(wholes), axis=1, return_inverse=True)
    return films, half_windows, back.ravel()
