"""The MDR stage: how often and how long the rough lines touch in the contact window.

The compiled kernels work on whole height steps and grid points; here films, half-widths and
counts are turned into them and back. An operating point reaches the kernels only as its film
thickness and window, so any dimension of the film table passes through unchanged.
"""

import logging

import numpy as np
import xarray as xr

from lube.kernels.strips import strip_statistics
from lube.schema import CONTACT_DIMS, OPERATING_DIMS, label
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
    reduced_modulus = film["reduced_modulus"].item()
    factor = layer_factor_of(lines, reduced_modulus, boundary_layer)
    films, half_windows, back = _distinct_points(film, lines)
    counts = np.empty((lines.sizes["realisation"], len(slide_to_roll_ratio), films.size, 4))
    for r, realisation in enumerate(lines["realisation"].values):
        pair = line_pair(lines, realisation)
        for s, ratio in enumerate(slide_to_roll_ratio):
            ratios = speed_ratios(ratio)
            steps = revolutions * revolution(pair, ratios)
            counts[r, s] = strip_statistics(*pair, ratios, steps, films, half_windows, factor)
            counts[r, s] /= steps
            log.info("realisation %d, slide-to-roll ratio %g: done", realisation, ratio)
    shape = counts.shape[:2] + tuple(film.sizes[name] for name in OPERATING_DIMS)
    touching, breaking, points, overlap = np.moveaxis(counts[:, :, back], -1, 0)
    spacing = lines.attrs["spacing"]
    stiffness = reduced_modulus * spacing  # of one spring, Eq. 5
    results = {
        "geometric_contact_probability": touching,
        "breakthrough_probability": breaking,
        "mean_contact_length": points * spacing,
        "mean_contact_force": overlap * lines.attrs["height_step"] * stiffness,
    }
    dims = ("realisation", *CONTACT_DIMS)
    dataset = xr.Dataset(
        {name: (dims, values.reshape(shape)) for name, values in results.items()},
        coords={
            "realisation": lines["realisation"].values,
            "slide_to_roll_ratio": np.asarray(slide_to_roll_ratio, float),
            **{name: film[name] for name in OPERATING_DIMS},
        },
        attrs={
            "travel": spacing * min(lines.attrs["points"]),
            "longest_wavelength": 2.0 * np.pi / lines.attrs["q_min"],
        },
    )
    dataset["critical_thickness"] = boundary_layer.critical_thickness
    dataset["shear_strength"] = boundary_layer.shear_strength
    return label(dataset, "contact_batch")


def _distinct_points(film, lines):
    """Operating points as distinct (film, half-window) pairs, and the way back to all points."""
    thickness, half_width = (
        array.transpose(*OPERATING_DIMS).values.ravel()
        for array in xr.broadcast(film["film_thickness"], film["contact_half_width"])
    )
    points = np.stack(whole_numbers(thickness, half_width, lines))
    (films, half_windows), back = np.unique(points, axis=1, return_inverse=True)
    return films, half_windows, back.ravel()
