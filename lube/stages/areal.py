"""The areal stage: contact over the rollers' length of the surface that the lines stand for."""

import math
from functools import partial

import numpy as np
import scipy.special
import xarray as xr

from lube.errors import DataError
from lube.kernels.areal import BLOCK, touching_strips
from lube.physics.excursions import (
    breaking_curvature,
    expected_contacts,
    sharp_surface_summit_share,
)
from lube.schema import CONTACT_DIMS, OPERATING_DIMS, label, values_with_limits
from lube.statistics.confidence import jackknife_interval, mean_interval
from lube.study.study import Study
from lube.surfaces.isotropic import isotropic_surface
from lube.surfaces.rare_contact import check_isotropic
from lube.surfaces.spectra import pair_moments
from lube.threads import on_threads
from lube.types import Datasets

SURFACES = 24
"""Surfaces drawn; the errors follow from the scatter between them."""
STRIPS = 400
"""Strips on each surface."""
FEWER_STRIPS = 40
"""Strips on each surface where theory expects more contacts than `MANY`: contact is certain."""
MANY = 30.0
_NAMES = {"geometric_contact_probability": "contacts", "breakthrough_probability": "breakthroughs"}
AROUND = 100
"""Rows beyond a known point in which its contact is followed; a first contact begins within as many
before it."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    r"""Make ``areal.nc``: contact of rough surfaces over the whole length of the rollers.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`; of the ``film`` dataset the first film formula is used.

    Returns
    -------
    xarray.Dataset
        The ``areal`` file of `lube.schema`.

    Raises
    ------
    StudyError
        If the heights of a line are not Gaussian, or a line was measured along rolling.
    DataError
        If the rollers are shorter than the contact is wide, or the band of wavelengths is too wide
        for a surface.

    Notes
    -----
    The strip 2a x L' is followed row by row along the rollers. Row j is the first of the strip that
    touches with the probability :math:`g_j`, so that a strip of n rows touches with

    .. math:: P = \sum_{j=0}^{n-1} g_j

    Importance sampling finds :math:`g_0` from rows that touch, and the other :math:`g_j` from
    contacts that begin in row j while no row of the strip before it touches. Rows further apart
    than a longest wavelength are independent, so from there on a row is the first with the same
    probability if none before it has touched.

    A contact breaks its boundary layer if the mean curvature of its highest point exceeds
    :math:`\pi \tau_0/(2 E^* h_c)`. The line's criterion is twice that, because the mapping doubles
    the curvature of a summit.
    """
    spec, length = study.line_spec, study.rollers.length
    check_isotropic(spec)
    film = inputs["film"].isel(film_formula=[0])
    film = film.transpose(*CONTACT_DIMS, ..., missing_dims="ignore")
    thickness, half_width = xr.broadcast(film["film_thickness"], film["contact_half_width"])
    widest = 2.0 * half_width.max().item()
    if length < widest:
        raise DataError(
            f"rollers.length: got {length:g} m, need the contact width of {widest:g} m or more"
        )
    layer, modulus = study.boundary_layer, film["reduced_modulus"].item()
    sharp = 0.5 * breaking_curvature(modulus, layer.critical_thickness, layer.shear_strength)
    moments = pair_moments(spec)
    films, widths = thickness.values.ravel(), 2.0 * half_width.values.ravel()
    contacts = expected_contacts(films, moments, length, widths)
    broken = contacts * sharp_surface_summit_share(films, moments, sharp)
    found = {"expected_contacts": contacts, "expected_breakthroughs": broken}
    strips = np.where(contacts > MANY, FEWER_STRIPS, STRIPS)
    # Size of the smallest contact: a parabola as high as the mean summit above the film.
    smallest = math.sqrt(8.0 / moments[1]) * moments[0] / films.max()
    surface = isotropic_surface(spec, widths.max(), smallest)
    columns = np.maximum(np.floor(widths / surface.spacing).astype(np.int64), 1)
    points = list(zip(films / spec.height_step, columns, strips, strict=True))
    found |= _sampled(spec, surface, points, sharp, length, study.seed, threads)
    slips = np.asarray(study.slips, float)
    shape = (slips.size, *thickness.shape[-len(OPERATING_DIMS) :])
    variables = {
        name: (CONTACT_DIMS, np.broadcast_to(values.reshape(thickness.shape), shape).copy())
        for name, values in found.items()
    }
    levels = {name: film[name] for name in OPERATING_DIMS} | {"slide_to_roll_ratio": slips}
    return label(xr.Dataset(variables, levels).assign(length=length), "areal")


def _sampled(spec, surface, points, sharp, length, seed, threads=1):
    """Probabilities and numbers of contacts, with their intervals, shape (points,) each.

    A point is a film (height steps), a contact width (columns) and a number of strips.
    """
    longest = math.ceil(spec.longest_wavelength / surface.spacing)
    reach = longest, min(AROUND, longest)
    covariances = tuple(surface.covariances(sum(reach) + 1, max(point[1] for point in points)))

    def on_one_surface(number):
        # The first two children draw the lines of the realisation of this number, the next three
        # are those of `lube.surfaces.rare_contact`.
        seeds = np.random.SeedSequence((seed, number)).spawn(7)[5:]
        known = surface, covariances, points, sharp / spec.height_step, reach
        return _on_one_surface(seeds, *known)

    found = on_threads(on_one_surface, range(SURFACES), threads)
    first, numbers = map(np.stack, zip(*found, strict=True))
    rows = max(int(length / surface.spacing), 1)
    results = {}
    for which, (name, counts) in enumerate(_NAMES.items()):
        limits = jackknife_interval(first[:, :, which], partial(strip_probability, rows=rows), 1.0)
        results |= values_with_limits(name, limits)
        results |= values_with_limits(counts, mean_interval(rows * numbers[:, :, which]))
    return results


def _on_one_surface(seeds, surface, covariances, points, sharp, reach):
    """Probability of first rows, shape (points, 2, R + 1), and contacts per row, (points, 2)."""
    drawing, choosing = map(np.random.default_rng, seeds)
    fields, chosen = surface.draw(drawing), choosing.random((4, STRIPS))
    tops = np.maximum.reduceat(fields[0], np.arange(0, surface.points, BLOCK), axis=1)
    longest, around = reach
    first, numbers = [], []
    for film, width, count in points:
        # Known points of strips, and the weight of each strip, as in `lube.surfaces.rare_contact`.
        log_tail = scipy.special.log_ndtr(-film / surface.rms)
        heights = -surface.rms * scipy.special.ndtri_exp(np.log(chosen[2, :count]) + log_tail)
        touching = (chosen[3, :count] * width).astype(np.int64), heights.astype(np.float32)
        share = width * np.exp(log_tail) / count
        room = surface.points - longest - 2 * around, surface.points - width + 1
        row, column = ((room[side] * chosen[side, :count]).astype(np.int64) for side in range(2))
        places = longest + around + row, column
        *each, contacts = touching_strips(
            fields, tops, covariances, places, touching, film, sharp, width, around
        )
        first.append(share * np.stack(each))
        numbers.append(share * contacts)
    return np.stack(first), np.stack(numbers)


def strip_probability(first: np.ndarray, rows: int) -> np.ndarray:
    """Compute the probability that any row of a strip touches.

    Parameters
    ----------
    first : numpy.ndarray
        Shape (..., R + 1): probability that a row touches while none of the 0, 1, ... R rows
        before it does.
    rows : int
        Rows of the strip.

    Returns
    -------
    numpy.ndarray
        Shape (...).

    Examples
    --------
    Independent rows, one in ten of which touches:

    >>> first = 0.1 * 0.9 ** np.arange(4)
    >>> [f"{strip_probability(first, rows):.6f}" for rows in (2, 10)]
    ['0.190000', '0.651322']
    """
    touched = np.cumsum(first, axis=-1)
    if rows <= first.shape[-1]:
        return np.minimum(touched[..., rows - 1], 1.0)
    # After R rows, or once half of the strips have touched, the probability that a row touches if
    # none before it has is taken as constant: its mean over the second half of the rows so far.
    before = np.concatenate([np.zeros_like(touched[..., :1]), touched[..., :-1]], axis=-1)
    counted = np.minimum(np.sum(before < 0.5, axis=-1), first.shape[-1] - 1)[..., None]
    number = np.arange(first.shape[-1])
    late = (number >= counted // 2) & (number <= counted)
    hazard = np.sum(first * late, axis=-1) / np.sum((1.0 - before) * late, axis=-1)
    here = np.take_along_axis(before, counted, axis=-1)[..., 0]
    further = (rows - counted[..., 0]) * np.log1p(-np.minimum(hazard, 1.0 - 1e-12))
    return -np.expm1(np.log1p(-np.minimum(here, 1.0 - 1e-12)) + further)
