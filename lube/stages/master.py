"""The master stage: probabilities over lambda ratio and contact width."""

import numpy as np
import xarray as xr

from lube.contact.counted import contact_at
from lube.contact.ensemble import gather_map
from lube.schema import label
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.types import Datasets

LAYER_FACTORS = 2.0 ** np.arange(-3, 4)
"""Strengths of the boundary layer in the coarse map, relative to the study's."""
LEVELS = (40, 9)
"""Numbers of levels over the range of the film table: of the lambda ratio at equal ratios, and of
the contact width at equal steps."""
LAYER_LEVELS = (12, 3)
"""The same in the coarse map."""
THINNER_FILMS = np.geomspace(0.3, 1.0, 13)[:-1]
"""Lambda ratios of the map below the lowest of the film table, relative to it."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``master.nc``; see `lube.stages`."""
    return gather_map(inputs["batches"])


def make_batch(study: Study, film: xr.Dataset, lines: xr.Dataset) -> xr.Dataset:
    """Make a batch of ``master.nc``; see `lube.stages`."""
    return contact_map(lines, film, study.boundary_layer)


def contact_map(lines: xr.Dataset, film: xr.Dataset, boundary_layer: BoundaryLayer) -> xr.Dataset:
    """Map the probabilities in pure rolling over lambda ratio and contact width.

    The probabilities of a realisation depend on the operating conditions only through the film
    thickness and the contact width, so one map serves a whole study. Films thinner than the
    study's are added, for records with more contact than the study predicts. A coarser map covers
    boundary layers weaker and stronger than the study's by `LAYER_FACTORS`.

    Parameters
    ----------
    lines, film, boundary_layer
        As in `lube.stages.contact.contact_statistics`.

    Returns
    -------
    xarray.Dataset
        The ``master_batch`` file of `lube.schema`: probabilities over (realisation,
        lambda_ratio, contact_width), and of breakthrough over (realisation, layer_strength,
        layer_lambda_ratio, layer_contact_width).
    """
    ratios, widths = _levels(film, *LEVELS)
    ratios = np.concatenate([ratios[0] * THINNER_FILMS, ratios])
    mapped = _map(lines, film, boundary_layer, (ratios, widths), ("lambda_ratio", "contact_width"))
    mapped["layer_breakthrough_probability"] = _layer_map(lines, film, boundary_layer)
    return label(mapped.assign_coords(revolutions=1), "master_batch")


def _levels(film, lambda_levels, width_levels):
    """Lambda ratios and contact widths over the range of a film table."""
    ratio, width = film["lambda_ratio"].values, 2.0 * film["contact_half_width"].values
    # Some films may not be known. Unique, because all values of a film table may be the same.
    ratios = np.unique(np.geomspace(np.nanmin(ratio), np.nanmax(ratio), lambda_levels))
    return ratios, np.unique(np.linspace(width.min(), width.max(), width_levels))


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
        mapped = _map(lines, film, layer, levels, ("layer_lambda_ratio", "layer_contact_width"))
        maps.append(mapped["breakthrough_probability"])
    strengths = LAYER_FACTORS * boundary_layer.strength
    strengths = xr.DataArray(strengths, dims="layer_strength", name="layer_strength")
    return xr.concat(maps, strengths, join="exact").transpose("realisation", ...)
