"""The patch stage: contact mechanics of the isotropic surface and of its line.

A square as wide as the longest wavelength of the roughness, which is the largest contact width
unless the study says otherwise, is pressed against a rigid flat, without oil. The line that stands
for it is pressed until the gap is the same.
"""

import logging

import numpy as np
import xarray as xr

from lube.schema import label, with_dims
from lube.study.line_spec import LineSpec
from lube.study.study import Study
from lube.surfaces.elastic_contact import find_tamaas, press_line, press_surface
from lube.surfaces.rough_surface import rough_surface
from lube.surfaces.spectra import spectrum_moments
from lube.surfaces.synthetic import ROLLER_NUMBERS, draw_realisation
from lube.types import Datasets

log = logging.getLogger(__name__)

REALISATIONS = 4
"""Number of surfaces drawn."""
PRESSURES = (0.001, 0.003, 0.01, 0.03, 0.1)
"""Pressures on the nominal area, over E* times the rms gradient."""
LEAST_POINTS = 256
"""Least number of points along a side."""
_OF_SURFACE = ("gap", "contact_area_share", "contacts")
_OF_LINE = ("line_pressure", "line_contact_area_share", "line_contacts")


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``patch.nc``; see `lube.stages`."""
    return patch_contact(study.line_spec, study.rollers.reduced_modulus, study.seed)


def patch_contact(spec: LineSpec, reduced_modulus: float, seed: int) -> xr.Dataset:
    """Press surfaces and their lines against a rigid flat.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines, which stand for isotropic surfaces; `Study.line_spec` of a study.
    reduced_modulus : float
        Reduced modulus, Pa.
    seed : int
        Seed of the study.

    Returns
    -------
    xarray.Dataset
        The ``patch`` file of `lube.schema`.

    Raises
    ------
    LubeError
        If tamaas is not installed.
    DataError
        If the band of wavelengths is too wide for a surface, or tamaas finds no solution.
    """
    find_tamaas()
    smallest = 4.0 * spec.longest_wavelength / LEAST_POINTS
    surface = rough_surface(spec, contact=(smallest, smallest), waves=1)
    lines = [spectrum_moments(spec, roller) for roller in range(len(ROLLER_NUMBERS))]
    rms_height = np.sqrt(sum(np.square(line["rms_height"]) for line in lines))
    gradient = np.sqrt(sum(np.square(line["rms_slope"]) for line in lines))
    values = {
        "relative_pressure": np.array(PRESSURES),
        "pressure": reduced_modulus * gradient * np.array(PRESSURES),
        "realisation": np.arange(REALISATIONS),
        "side": surface.sides[0],
        "rms_height": rms_height,
        "rms_gradient": gradient,
        "reduced_modulus": reduced_modulus,
    }
    pressed = [_pressed(spec, surface, values, seed, number) for number in range(REALISATIONS)]
    # Reorder to surface or line, quantity, realisation, pressure.
    of_surface, of_line = np.moveaxis(np.array(pressed), (1, 3), (0, 1))
    values |= zip(_OF_SURFACE, of_surface[[0, 2, 3]], strict=True)
    values |= zip(_OF_LINE, of_line[1:], strict=True)
    return label(xr.Dataset(with_dims("patch", values)), "patch")


def _pressed(spec, surface, values, seed, number):
    """Contacts of a surface and of a line, shape (2, pressures, quantities)."""
    log.info("surface %d of %d", number + 1, REALISATIONS)
    side, modulus = values["side"], values["reduced_modulus"]
    # The first seven children belong to the lines and to the stages tail and areal.
    child = np.random.SeedSequence((seed, number)).spawn(8)[7]
    heights = surface.draw(np.random.default_rng(child))[0].astype(float) * spec.height_step
    of_surface = list(press_surface(heights, side, modulus, values["pressure"]))
    size = min(spec.points)
    line = sum(each[:size].astype(float) for each in draw_realisation(spec, seed, number))
    line *= spec.height_step
    of_line = [press_line(line, spec.spacing, side, modulus, one.gap) for one in of_surface]
    return of_surface, of_line
