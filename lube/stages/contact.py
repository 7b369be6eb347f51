"""The contact stage: probability and extent of contact of the rough lines (MDR model).

The compiled kernels work on whole height steps and grid points; here film thicknesses,
half-widths and counts are converted to them and back. An operating point reaches the kernels
only as its film thickness and contact window, so any dimension of the film table passes through
unchanged.
"""

import logging
from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.grid.contact_runs import ContactRuns
from lube.grid.discretise import line_pair, revolution, speed_ratios
from lube.grid.operating_points import at_slip
from lube.schema import LAYER_DIMS, MASTER_DIMS, OPERATING_DIMS, label
from lube.study.rollers import BoundaryLayer

log = logging.getLogger(__name__)

LAYER_FACTORS = 2.0 ** np.arange(-3, 4)
"""Strengths of the boundary layer in the coarse map, relative to the study's."""
LAYER_LEVELS = (12, 3)
"""Numbers of levels of the lambda ratio and of the contact width in the coarse map."""
THINNER_FILMS = np.geomspace(0.3, 1.0, 5)[:-1]
"""Lambda ratios of the map below the lowest of the film table, relative to it."""


def contact_statistics(
    lines: xr.Dataset,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    slide_to_roll_ratio: Sequence[float] = (0.0,),
    revolutions: int = 1,
    flattened: bool = False,
) -> xr.Dataset:
    r"""Run the contact model for all realisations and operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    film : xarray.Dataset
        A ``film`` dataset.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).
    slide_to_roll_ratio : sequence of float, optional
        Levels of the slide-to-roll ratio; the default is pure rolling.
    revolutions : int, optional
        Revolutions of the roller with the faster surface.
    flattened : bool, optional
        Whether the oil flattens the lines (`lube.physics.flattening`).

    Returns
    -------
    xarray.Dataset
        The ``contact_batch`` file of `lube.schema`: probabilities, mean contact length (m),
        mean contact force (N) and its share of the load, over (realisation,
        slide_to_roll_ratio, lubricant, film_formula, temperature, speed, force).

    Notes
    -----
    The force (Eq. 5) is that of one line, which represents a patch as long as it is wide: the
    springs of a contact window together have the stiffness of a disc of diameter 2a pressed into
    a half-space, :math:`2 a E^*`, and about that of a square of side 2a. The share of the load is
    therefore the force over the load that a patch 2a x 2a carries on average,

    .. math:: F_N \frac{2 a}{L'}

    The film formulas ignore the asperities and let the film carry all of :math:`F_N`. Where the
    share is not small, film and asperities together carry more than the applied load.
    """
    film = film.transpose(*OPERATING_DIMS, ...)
    results = _at_slips(lines, film, boundary_layer, slide_to_roll_ratio, revolutions, flattened)
    # F_N 2a/L' by Hertz: the maximum pressure is 4/pi times the mean one, F_N / (2a L').
    width = 2.0 * film["contact_half_width"]
    patch_load = np.pi / 4.0 * film["hertz_pressure"] * width * width
    results["contact_load_share"] = results["mean_contact_force"] / patch_load
    levels = {name: film[name] for name in OPERATING_DIMS} | {"revolutions": revolutions}
    levels["slide_to_roll_ratio"] = np.asarray(slide_to_roll_ratio, float)
    return label(results.assign_coords(levels), "contact_batch")


def _at_slips(lines, film, boundary_layer, slide_to_roll_ratio, *run):
    """Results at each slip, with a film of its own if inlet shear heating thins it."""
    if "slide_to_roll_ratio" not in film["film_thickness"].dims:
        return contact_at(lines, film, boundary_layer, slide_to_roll_ratio, *run)
    results = [
        contact_at(lines, at_slip(film, ratio), boundary_layer, [ratio], *run)
        for ratio in slide_to_roll_ratio
    ]
    options = {"join": "exact", "data_vars": "minimal", "combine_attrs": "override"}
    return xr.concat(results, "slide_to_roll_ratio", **options)


def contact_map(
    lines: xr.Dataset,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    lambda_levels: int = 40,
    width_levels: int = 9,
) -> xr.Dataset:
    """Map the probabilities in pure rolling over lambda ratio and contact width.

    The probabilities of a realisation depend on the operating conditions only through the film
    thickness and the contact width, so one map serves all of a study. A few films thinner than
    the study's are added, for records with more contact than the study predicts; there the
    probabilities change little with the film. A coarser map covers boundary layers weaker and
    stronger than the study's by `LAYER_FACTORS`.

    Parameters
    ----------
    lines, film, boundary_layer
        As in `contact_statistics`.
    lambda_levels, width_levels : int, optional
        Numbers of levels over the range of the film table, of the lambda ratio at equal
        ratios, of the contact width at equal steps.

    Returns
    -------
    xarray.Dataset
        The ``master_batch`` file of `lube.schema`: probabilities over (realisation,
        lambda_ratio, contact_width), and of breakthrough over (realisation, layer_strength,
        layer_lambda_ratio, layer_contact_width).
    """
    ratios, widths = _levels(film, lambda_levels, width_levels)
    ratios = np.concatenate([ratios[0] * THINNER_FILMS, ratios])
    mapped = _map(lines, film, boundary_layer, (ratios, widths), MASTER_DIMS)
    mapped["layer_breakthrough_probability"] = _layer_map(lines, film, boundary_layer)
    return label(mapped.assign_coords(revolutions=1), "master_batch")


def _levels(film, lambda_levels, width_levels):
    """Lambda ratios and contact widths over the range of a film table."""
    ratio, width = film["lambda_ratio"].values, 2.0 * film["contact_half_width"].values
    # Some films may not be known. Unique, because all values of a film table may be the same.
    return (
        np.unique(np.geomspace(np.nanmin(ratio), np.nanmax(ratio), lambda_levels)),
        np.unique(np.linspace(width.min(), width.max(), width_levels)),
    )


def _map(lines, film, boundary_layer, levels, dims):
    """Probabilities in pure rolling over (realisation, lambda ratio, contact width)."""
    points = xr.Dataset(coords=dict(zip(dims, levels, strict=True)))
    table = film[["reduced_modulus"]].assign(
        film_thickness=points[dims[0]] * film["composite_rms_roughness"].item(),
        contact_half_width=points[dims[1]] / 2.0,
    )
    results = contact_at(lines, table, boundary_layer).isel(slide_to_roll_ratio=0)
    return results[["breakthrough_probability", "geometric_contact_probability"]]


def _layer_map(lines, film, boundary_layer):
    """Breakthrough probability over (realisation, layer strength, lambda ratio, width)."""
    levels, maps = _levels(film, *LAYER_LEVELS), []
    for factor in LAYER_FACTORS:
        # The model depends on tau0 / h_c only, so changing the shear strength is enough.
        strength = factor * boundary_layer.shear_strength
        layer = boundary_layer.model_copy(update={"shear_strength": strength})
        mapped = _map(lines, film, layer, levels, LAYER_DIMS[1:])
        maps.append(mapped["breakthrough_probability"])
    study = boundary_layer.shear_strength / boundary_layer.critical_thickness
    strengths = xr.DataArray(LAYER_FACTORS * study, dims="layer_strength", name="layer_strength")
    return xr.concat(maps, strengths, join="exact").transpose("realisation", *LAYER_DIMS)


def contact_at(
    lines: xr.Dataset,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    slide_to_roll_ratio: Sequence[float] = (0.0,),
    revolutions: int = 1,
    flattened: bool = False,
) -> xr.Dataset:
    """Run the contact model over the dimensions that the films and contact widths have.

    Parameters
    ----------
    lines, boundary_layer, slide_to_roll_ratio, revolutions, flattened
        As in `contact_statistics`.
    film : xarray.Dataset
        With ``film_thickness`` and ``contact_half_width``, m, over any dimensions, and
        ``reduced_modulus``, Pa. With ``film_profile`` the film has the computed shape, else it is
        flat and ends at the edges of the contact.

    Returns
    -------
    xarray.Dataset
        The results of `contact_statistics` but the share of the load, over (realisation,
        slide_to_roll_ratio, dimensions of the films), without attributes of their variables.
        Its own are ``travel`` and ``longest_wavelength``, both m, of a realisation.
    """
    thickness, _ = xr.broadcast(film["film_thickness"], film["contact_half_width"])
    runs = ContactRuns(lines, film, boundary_layer, flattened)
    counts = np.empty((lines.sizes["realisation"], len(slide_to_roll_ratio), thickness.size, 4))
    for r, realisation in enumerate(lines["realisation"].values):
        pair = line_pair(lines, realisation)
        for s, ratio in enumerate(slide_to_roll_ratio):
            ratios = speed_ratios(ratio)
            counts[r, s] = runs.statistics(pair, ratios, revolutions * revolution(pair, ratios))
            log.info("realisation %d, slide-to-roll ratio %g: done", realisation, ratio)
    touching, breaking, points, overlap = np.moveaxis(counts, -1, 0)
    spacing = lines.attrs["spacing"]
    stiffness = film["reduced_modulus"].item() * spacing  # of one spring, Eq. 5
    results = {
        "geometric_contact_probability": touching,
        "breakthrough_probability": breaking,
        "mean_contact_length": points * spacing,
        "mean_contact_force": overlap * lines.attrs["height_step"] * stiffness,
    }
    dims = ("realisation", "slide_to_roll_ratio", *thickness.dims)
    shape = counts.shape[:2] + thickness.shape
    variables = {name: (dims, values.reshape(shape)) for name, values in results.items()}
    for name in ("critical_thickness", "shear_strength"):
        variables[name] = ((), getattr(boundary_layer, name))
    coords = {"realisation": lines["realisation"].values, **thickness.coords}
    # NaN if both lines are measured: one pair has no ensemble, hence no interval.
    longest = 2.0 * np.pi / np.fmin.reduce(np.atleast_1d(lines.attrs["q_min"]))
    travel = spacing * min(lines.attrs["points"])
    return xr.Dataset(variables, coords, {"travel": travel, "longest_wavelength": longest})
