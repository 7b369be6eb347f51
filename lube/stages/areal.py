"""The areal stage: contact over the rollers' length of the surface that the lines stand for."""

from collections.abc import Sequence

import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import surface_contact, surface_widths
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
    film = with_surface_responses(inputs)
    if not study.has_surfaces:
        film = film.isel(film_formula=[0])
    found = contact_of_surfaces(RoughPair.of(study), film, study.slips, threads)
    found = found.assign(length=study.rollers.length)
    if study.gap.is_answered:
        found = found.assign(surface_rms_deformation=film["surface_rms_deformation"].drop_attrs())
    return label(found, "areal")


def contact_of_surfaces(
    pair: RoughPair,
    film: xr.Dataset,
    slips: Sequence[float],
    threads: int | None = None,
    wanted: xr.DataArray | None = None,
) -> xr.Dataset:
    """Find how often surfaces touch at operating points, by all film formulas.

    Parameters
    ----------
    pair, film, threads, wanted
        As in `lube.contact.surface_strip.surface_contact`, of a ``film`` dataset.
    slips : sequence of float
        Levels of the slide-to-roll ratio.

    Returns
    -------
    xarray.Dataset
        The variables of `lube.contact.surface_strip.surface_contact` and `surface_widths` there,
        unlabelled.

    Raises
    ------
    StudyError, DataError
        As from `lube.contact.surface_strip.surface_contact`.
    """
    film = film.transpose(*CONTACT_DIMS, ..., missing_dims="ignore")
    levels = xr.DataArray(list(slips), dims=_SLIP, coords={_SLIP: list(slips)})
    found = []
    for formulas, fewer in ((slice(1), 1), (slice(1, None), FEWER)):
        some = film.isel(film_formula=formulas)
        if some.sizes["film_formula"]:
            own = None if wanted is None else wanted.isel(film_formula=formulas)
            contact = surface_contact(pair, some, threads, fewer=fewer, wanted=own)
            found.append(contact.assign(surface_widths(pair, some, levels, own)))
    found = xr.concat(found, "film_formula", join="exact")
    # If the film is the same at all slips, so is the probability.
    return xr.broadcast(found.drop_attrs())[0].transpose(*CONTACT_DIMS).copy(deep=True)
