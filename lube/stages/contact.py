"""The MDR stage: how often and how long the rough lines touch in the contact window.

The compiled kernels work on whole height steps and grid points; here films, half-widths and
counts are turned into them and back. An operating point reaches the kernels only as its film
thickness and window, so any dimension of the film table passes through unchanged.
"""

import logging

import numpy as np
import xarray as xr

from lube.grid.discretise import layer_factor_of, line_pair, revolution, speed_ratios, whole_numbers
from lube.kernels.strips import strip_statistics
from lube.schema import LAYER_DIMS, MASTER_DIMS, OPERATING_DIMS, label

log = logging.getLogger(__name__)

LAYER_FACTORS = 2.0 ** np.arange(-3, 4)
"""Strengths of the boundary layer that are mapped too, over the study's."""
LAYER_LEVELS = (12, 3)
"""Levels of the lambda ratio and of the contact width at which they are."""
THINNER_FILMS = np.geomspace(0.3, 1.0, 5)[:-1]
"""Lambda ratios that are mapped below the film table's least, over that one."""


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
        The ``contact_batch`` file of `lube.schema`: probabilities, mean contact length (m),
        mean contact force (N) and its share of the load, over (realisation,
        slide_to_roll_ratio, lubricant, film_formula, temperature, speed, force).

    Notes
    -----
    The force is that of one line. A line stands for a patch as long and as wide as itself: the
    springs of a window are as stiff together as a disc of diameter 2a pressed in (E* 2a), or a
    square of about that side. So the share is the force over what a patch 2a x 2a carries on
    average, F_N 2a/L'. The film formula knows nothing of the asperities and lets the film carry
    all of F_N; where the share is not small, the two together carry more than there is.
    """
    thickness, half_width = (
        array.transpose(*OPERATING_DIMS)
        for array in xr.broadcast(film["film_thickness"], film["contact_half_width"])
    )
    results = _run(
        lines, film, boundary_layer, thickness, half_width, slide_to_roll_ratio, revolutions
    )
    results["contact_load_share"] = results["mean_contact_force"] / _patch_load(film)
    ratios = np.asarray(slide_to_roll_ratio, float)
    dataset = results.assign_coords(
        slide_to_roll_ratio=ratios,
        revolutions=revolutions,
        **{name: film[name] for name in OPERATING_DIMS},
    )
    return label(dataset, "contact_batch")


def _patch_load(film):
    """Nominal load of a patch 2a x 2a, F_N 2a/L' in N: pi/4 of the Hertzian maximum, over it."""
    width = 2.0 * film["contact_half_width"]
    return np.pi / 4.0 * film["hertz_pressure"] * width * width


def contact_map(lines, film, boundary_layer, lambda_levels=40, width_levels=9):
    """Run the model in pure rolling over all films and windows that a study spans.

    A realisation's answer depends on the film thickness and the window alone, whatever force,
    speed, temperature and oil are behind them: this maps it. Some films thinner than all of the
    study's are added, so that a record with more contact than the study foresees can be gauged;
    few, because there the answer hardly changes. A coarser map holds layers weaker and stronger
    than the study's, `LAYER_FACTORS` times as strong.

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
        lambda_ratio, contact_width), and of breakthrough over (realisation, layer_strength,
        layer_lambda_ratio, layer_contact_width).
    """
    ratio, width = film["lambda_ratio"], 2.0 * film["contact_half_width"]
    ratios = _levels(np.geomspace, ratio, lambda_levels)
    ratios = np.concatenate([ratios[0] * THINNER_FILMS, ratios])
    widths = _levels(np.linspace, width, width_levels)
    mapped = _map(lines, film, boundary_layer, ratios, widths, MASTER_DIMS)
    coarse = (
        _levels(np.geomspace, ratio, LAYER_LEVELS[0]),
        _levels(np.linspace, width, LAYER_LEVELS[1]),
    )
    mapped["layer_breakthrough_probability"] = _layer_map(lines, film, boundary_layer, *coarse)
    return label(mapped.assign_coords(revolutions=1), "master_batch")


def _levels(between, values, count):
    """Levels over the range of some values; one where they are all the same."""
    return np.unique(between(values.min().item(), values.max().item(), count))


def _map(lines, film, boundary_layer, ratios, widths, dims):
    """Probabilities in pure rolling over (realisation, lambda ratio, contact width)."""
    ratios, widths = (
        xr.DataArray(levels, dims=name, coords={name: levels})
        for name, levels in zip(dims, (ratios, widths), strict=True)
    )
    thickness = ratios * film["composite_rms_roughness"].item()
    thickness, half_width = xr.broadcast(thickness, widths / 2.0)
    results = _run(lines, film, boundary_layer, thickness, half_width, (0.0,), 1)
    probabilities = results[["breakthrough_probability", "geometric_contact_probability"]]
    return probabilities.isel(slide_to_roll_ratio=0)


def _layer_map(lines, film, boundary_layer, ratios, widths):
    """Breakthrough probability over (realisation, layer strength, lambda ratio, width)."""
    maps = []
    for factor in LAYER_FACTORS:
        # Only tau0 / h_c matters, so the shear strength stands for both.
        strength = factor * boundary_layer.shear_strength
        layer = boundary_layer.model_copy(update={"shear_strength": strength})
        maps.append(_map(lines, film, layer, ratios, widths, LAYER_DIMS[1:]))
    study = boundary_layer.shear_strength / boundary_layer.critical_thickness
    strengths = xr.DataArray(LAYER_FACTORS * study, dims="layer_strength", name="layer_strength")
    mapped = xr.concat([each["breakthrough_probability"] for each in maps], strengths, join="exact")
    return mapped.transpose("realisation", *LAYER_DIMS)


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
