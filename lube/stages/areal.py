"""The areal stage: contact over the rollers' length of the surface that the lines stand for."""

import xarray as xr

from lube.contact.surface_strip import surface_contact
from lube.grid.film_responses import with_surface_responses
from lube.schema import CONTACT_DIMS, label
from lube.study.study import Study
from lube.types import Datasets

FEWER = 4
"""Surfaces drawn for the first film formula, for each one drawn for the others."""
_SLIP = "slide_to_roll_ratio"


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``areal.nc``: contact of rough surfaces over the whole length of the rollers.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`; of the ``film`` dataset the first film formula is used, or all of them
        if the study asks for contact of surfaces.

    Returns
    -------
    xarray.Dataset
        The ``areal`` file of `lube.schema`, by `lube.contact.surface_strip.surface_contact`.

    Raises
    ------
    StudyError, DataError
        As from `lube.contact.surface_strip.surface_contact`.
    """
    film, length = with_surface_responses(inputs), study.rollers.length
    film = film.transpose(*CONTACT_DIMS, ..., missing_dims="ignore")
    slips = xr.DataArray(list(study.slips), dims=_SLIP, coords={_SLIP: list(study.slips)})

    def contact(formulas, fewer):
        choices = study.boundary_layer, study.seed, study.gap, threads, 1.0, fewer, slips
        return surface_contact(study.line_spec, length, film.isel(film_formula=formulas), *choices)

    found = [contact([0], 1)]
    if study.has_surfaces and film.sizes["film_formula"] > 1:
        found.append(contact(slice(1, None), FEWER))
    found = xr.concat(found, "film_formula", join="exact")
    # If the film is the same at all slips, so is the probability.
    found = xr.broadcast(found.drop_attrs())[0]
    found = found.transpose(*CONTACT_DIMS).copy(deep=True).assign(length=length)
    if study.gap.is_answered:
        found = found.assign(surface_rms_deformation=film["surface_rms_deformation"].drop_attrs())
    return label(found, "areal")
