"""The contact model, counted: probability and extent of contact of rough lines (MDR model).

The kernels know an operating point only by its film and its contact window, so any dimension of the
film table passes through unchanged.
"""

import logging
from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.contact.windows import ContactWindows
from lube.grid.discretise import LineGrid, line_pair
from lube.grid.gap import PLAIN, Gap
from lube.grid.operating_points import at_slip
from lube.study.rollers import BoundaryLayer

log = logging.getLogger(__name__)


def contact_at(
    lines: xr.Dataset,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    slide_to_roll_ratio: Sequence[float] = (0.0,),
    revolutions: int = 1,
    gap: Gap = PLAIN,
) -> xr.Dataset:
    """Run the contact model over the dimensions that the films and contact widths have.

    Parameters
    ----------
    lines, boundary_layer, slide_to_roll_ratio, revolutions, gap
        As in `lube.stages.contact.contact_statistics`.
    film : xarray.Dataset
        As in `lube.contact.windows.ContactWindows`; the films may depend on slip.

    Returns
    -------
    xarray.Dataset
        The results of `lube.stages.contact.contact_statistics` except the share of the load, over
        (realisation, slide_to_roll_ratio, dimensions of the films), and the properties of the
        boundary layer; the variables have no attributes. The dataset's attributes are ``travel``
        and ``longest_wavelength`` of a realisation, both m.
    """
    grid, realisations = LineGrid.of(lines), lines["realisation"].values
    films = [at_slip(film, ratio) for ratio in slide_to_roll_ratio]
    windows = [ContactWindows(grid, one, boundary_layer, gap) for one in films]
    counts = []
    for realisation in realisations:
        pair = line_pair(lines, realisation)
        for ratio, at_ratio in zip(slide_to_roll_ratio, windows, strict=True):
            counts.append(at_ratio.count(pair, ratio, revolutions))
            log.info("realisation %d, slide-to-roll ratio %g: done", realisation, ratio)
    thickness, _ = xr.broadcast(films[0]["film_thickness"], film["contact_half_width"])
    counts = np.reshape(counts, (realisations.size, len(windows), *thickness.shape, 4))
    touching, breaking, points, overlap = np.moveaxis(counts, -1, 0)
    spacing = lines.attrs["spacing"]
    stiffness = film["reduced_modulus"].item() * spacing  # of one spring, Eq. 5
    dims = ("realisation", "slide_to_roll_ratio", *thickness.dims)
    results = {
        "geometric_contact_probability": (dims, touching),
        "breakthrough_probability": (dims, breaking),
        "mean_contact_length": (dims, points * spacing),
        "mean_contact_force": (dims, overlap * lines.attrs["height_step"] * stiffness),
        "critical_thickness": boundary_layer.critical_thickness,
        "shear_strength": boundary_layer.shear_strength,
    }
    coords = {"realisation": realisations, **thickness.coords}
    # NaN if both lines are measured: one pair has no ensemble, hence no interval.
    longest = 2.0 * np.pi / np.fmin.reduce(np.atleast_1d(lines.attrs["q_min"]))
    travel = spacing * min(lines.attrs["points"])
    return xr.Dataset(results, coords, {"travel": travel, "longest_wavelength": longest})
