"""The film stage: film thickness, lambda ratio and regime at every operating point."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from lube.grid.films import film_at
from lube.schema import CONTACT_DIMS, label
from lube.study.line_spec import LineSpec
from lube.study.rollers import RollerPair
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``film.nc``; see `lube.stages`."""
    oil, rollers, grid = inputs["lubricant"], study.rough_rollers, study.operating_grid
    choices = study.film_model | {"slide_to_roll_ratio": study.slips}
    return film_table(oil, rollers, grid.force, grid.speed, study.film_formulas, **choices)


def film_table(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: npt.ArrayLike,
    speed: npt.ArrayLike,
    formulas: Sequence[str],
    with_shape: bool = False,
    slide_to_roll_ratio: npt.ArrayLike = (0.0,),
    inlet_shear_heating: str = "none",
    inlet_meniscus: float | None = None,
    answered_lines: LineSpec | None = None,
    rough_surfaces: LineSpec | None = None,
    load_sharing: str = "none",
) -> xr.Dataset:
    """Tabulate the film thickness of a pair of rollers over the operating grid.

    Parameters
    ----------
    lubricant : xarray.Dataset
        A ``lubricant`` dataset, with ``dynamic_viscosity`` (Pa s),
        ``pressure_viscosity_coefficient`` (1/Pa), ``temperature_viscosity_coefficient`` (1/K)
        and ``thermal_conductivity`` (W/(m K)) over lubricant and temperature.
    rollers : RollerPair
        Geometry, elasticity and roughness of the two rollers.
    force : array_like, shape (force,)
        Normal forces F_N, N.
    speed : array_like, shape (speed,)
        Rotation speeds n of the first roller in pure rolling, rpm. Slip leaves the entrainment
        speed unchanged, so the film thickness depends on slip only with inlet shear heating.
    formulas : sequence of str
        Names of film formulas, keys of `lube.ehl.film_formulas.FORMULAS`.
    with_shape : bool, optional
        Whether the film has the shape of the computed one; by default it is flat.
    slide_to_roll_ratio : array_like, shape (slide_to_roll_ratio,), optional
        Levels of the slide-to-roll ratio; the default is pure rolling.
    inlet_shear_heating : str, optional
        One of `lube.physics.inlet_heating.INLET_HEATING`; by default the film is not reduced. The
        factor is a variable of the result in any case.
    inlet_meniscus : float, optional
        Distance before the line of centres at which the oil begins, m; by default the contact is
        fully flooded.
    answered_lines : LineSpec, optional
        Roughness lines that the film answers: its response to their waves becomes part of the
        result. By default lines enter the gap as drawn.
    rough_surfaces : LineSpec, optional
        Lines that stand for the rollers' rough surfaces: the result has the share of the load that
        their asperities carry.
    load_sharing : str, optional
        With "iterated" the oil carries only what these asperities leave of the load; by default
        the oil carries all of it.

    Returns
    -------
    xarray.Dataset
        The ``film`` file of `lube.schema`. With inlet shear heating the film thickness depends on
        slip; it is NaN, and the log says so, where there is no factor. If the film answers
        roughness lines, its response depends on slip, so the films are given for each slip.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    DataError
        If a dimension of the lubricant dataset has no coordinate.
    RangeError
        If the meniscus lies inside a contact.

    Examples
    --------
    >>> from lube.stages import film_table, load_study, lubricant_table
    >>> study = load_study("workflow/config/paper.yaml")
    >>> oil = lubricant_table(study.lubricants, [40.0])
    >>> film = film_table(oil, study.rollers, [800.0], [100.0], ["paper"])
    >>> f"{1e6 * film.film_thickness.item():.3f} um"
    '1.070 um'
    >>> f"lambda ratio {film.lambda_ratio.item():.2f}"
    'lambda ratio 3.78'
    """
    levels = {"force": force, "speed": speed, "slide_to_roll_ratio": slide_to_roll_ratio}
    axes = xr.Dataset(coords={name: np.asarray(each, float) for name, each in levels.items()})
    forces, speeds, slips = (axes[name] for name in levels)
    inlet = {"inlet_shear_heating": inlet_shear_heating, "inlet_meniscus": inlet_meniscus}
    surfaces = {"rough_surfaces": rough_surfaces, "load_sharing": load_sharing}
    choices = inlet | surfaces | {"answered_lines": answered_lines}
    table = film_at(lubricant, rollers, forces, speeds, formulas, with_shape, slips, **choices)
    dims = CONTACT_DIMS[0], "roller", *CONTACT_DIMS[1:]
    return label(table.transpose(*dims, ..., missing_dims="ignore"), "film")
