"""The contact stage: probability and extent of contact of the rough lines (MDR model)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.contact.counted import contact_at
from lube.contact.ensemble import gather
from lube.grid.gap import PLAIN, Gap
from lube.schema import OPERATING_DIMS, label
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``contact.nc``; see `lube.stages`."""
    return gather(inputs["batches"], inputs["film"])


def make_batch(study: Study, film: xr.Dataset, lines: xr.Dataset) -> xr.Dataset:
    """Make a batch of ``contact.nc``; see `lube.stages`."""
    layer, slips = study.boundary_layer, study.slips
    return contact_statistics(lines, film, layer, slips, study.revolutions, study.gap)


def contact_statistics(
    lines: xr.Dataset,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    slide_to_roll_ratio: Sequence[float] = (0.0,),
    revolutions: int = 1,
    gap: Gap = PLAIN,
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
    gap : Gap, optional
        How film and roughness make up the gap; by default flat films, and lines as drawn.

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
    results = contact_at(lines, film, boundary_layer, slide_to_roll_ratio, revolutions, gap)
    # F_N 2a/L' by Hertz: the maximum pressure is 4/pi times the mean one, F_N / (2a L').
    width = 2.0 * film["contact_half_width"]
    patch_load = np.pi / 4.0 * film["hertz_pressure"] * width * width
    results["contact_load_share"] = results["mean_contact_force"] / patch_load
    levels = {name: film[name] for name in OPERATING_DIMS} | {"revolutions": revolutions}
    levels["slide_to_roll_ratio"] = np.asarray(slide_to_roll_ratio, float)
    return label(results.assign_coords(levels), "contact_batch")
