"""Operating points as plain numbers, and the speeds of their surfaces."""

from dataclasses import dataclass, field
from itertools import product

import numpy as np
import xarray as xr

from lube.grid.levels import rolling
from lube.schema import EXPERIMENT_DIMS


def surface_speeds(entrainment_speed: float, slide_to_roll_ratio: float) -> tuple[float, float]:
    r"""Speeds of the two surfaces under slip.

    .. math::

        v_{1,2} = v \left( 1 \pm \frac{S}{2} \right), \qquad
        v = \frac{v_1 + v_2}{2}, \quad S = \frac{v_1 - v_2}{v}

    Parameters
    ----------
    entrainment_speed : float
        Entrainment speed :math:`v`, the mean of both, in any unit of speed.
    slide_to_roll_ratio : float
        Slide-to-roll ratio :math:`S`, from -2 to 2.

    Returns
    -------
    tuple of float
        :math:`v_1` and :math:`v_2`, in the same unit.

    Examples
    --------
    >>> surface_speeds(1.0, 0.5)
    (1.25, 0.75)
    """
    first, second = 1.0 + slide_to_roll_ratio / 2.0, 1.0 - slide_to_roll_ratio / 2.0
    return entrainment_speed * first, entrainment_speed * second


def at_slip(film: xr.Dataset, slide_to_roll_ratio: float | None = None) -> xr.Dataset:
    """Select one slide-to-roll ratio, if the film depends on it.

    It does with inlet shear heating, or if it answers the roughness.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset.
    slide_to_roll_ratio : float, optional
        One of its slide-to-roll ratios; by default pure rolling, or the first if it has none.

    Returns
    -------
    xarray.Dataset
        The dataset without the dimension ``slide_to_roll_ratio``. Where the film does not depend on
        it, any ratio will do.

    Examples
    --------
    >>> levels = {"slide_to_roll_ratio": [-1.0, 0.0]}
    >>> film = xr.Dataset({"film_thickness": ("slide_to_roll_ratio", [0.9e-6, 1.0e-6])}, levels)
    >>> at_slip(film).film_thickness.item()
    1e-06
    """
    name = "slide_to_roll_ratio"
    if name not in film["film_thickness"].dims:
        return film.drop_dims(name, errors="ignore")
    if slide_to_roll_ratio is None:
        slide_to_roll_ratio = rolling(film[name].values)
    return film.sel({name: slide_to_roll_ratio}, drop=True)


def known_films(film: xr.Dataset) -> xr.DataArray:
    """Where the film is known, with its shape if it has one.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset, or rows of one.

    Returns
    -------
    xarray.DataArray
        Over the dimensions of its ``film_thickness``.
    """
    known = film["film_thickness"].notnull()
    if "film_profile" in film:
        known = known & film["film_profile"].notnull().all("film_position")
    if "interpolation_error" in film:  # of the response to the roughness
        known = known & film["interpolation_error"].notnull().all("roller")
    return known


@dataclass(frozen=True)
class OperatingPoint:
    """An operating point, with its film thickness and contact width.

    Attributes
    ----------
    slide_to_roll_ratio : float
        (v1 - v2) / v, with the surface speeds v1 and v2 and the entrainment speed v.
    lubricant : str
        Name of the lubricant.
    temperature, speed, force : float
        Levels of the study, degC, rpm and N.
    film_thickness, contact_half_width : float
        h0 and a, m.
    entrainment_speed : float
        Entrainment speed v, m/s.
    reduced_modulus : float
        E*, Pa.
    row : xarray.Dataset
        The film table at the point, without coordinates of the operating variables.
    """

    slide_to_roll_ratio: float
    lubricant: str
    temperature: float
    speed: float
    force: float
    film_thickness: float
    contact_half_width: float
    entrainment_speed: float
    reduced_modulus: float
    row: xr.Dataset = field(compare=False, repr=False)

    @property
    def levels(self) -> dict[str, float | str]:
        """Levels of the operating variables, by the names of `lube.schema.EXPERIMENT_DIMS`."""
        return {name: getattr(self, name) for name in EXPERIMENT_DIMS}

    @property
    def is_known(self) -> bool:
        """Whether the film is known here, with its shape if it has one."""
        return bool(known_films(self.row))

    @property
    def faster_speed(self) -> float:
        """Speed of the faster surface, m/s."""
        return max(surface_speeds(self.entrainment_speed, self.slide_to_roll_ratio))


def operating_points(table: xr.Dataset, slide_to_roll_ratio: float) -> list[OperatingPoint]:
    """List the operating points of a film table.

    Parameters
    ----------
    table : xarray.Dataset
        A ``film`` dataset of one film formula, without that dimension.
    slide_to_roll_ratio : float
        Slide-to-roll ratio of all points.

    Returns
    -------
    list of OperatingPoint
        In the order of lubricant, temperature, speed and force; the force changes fastest.

    Examples
    --------
    >>> names = "lubricant", "temperature", "speed", "force"
    >>> levels = ["oil"], [40.0], [100.0], [200.0, 400.0]
    >>> table = xr.Dataset(
    ...     {
    ...         "film_thickness": (names, [[[[1.0e-6, 0.9e-6]]]]),
    ...         "contact_half_width": ("force", [5e-5, 7e-5]),
    ...         "entrainment_speed": ("speed", [0.5]),
    ...         "reduced_modulus": 1.15e11,
    ...     },
    ...     dict(zip(names, levels)),
    ... )
    >>> [point.force for point in operating_points(table, 0.0)]
    [200.0, 400.0]
    """
    names = EXPERIMENT_DIMS[1:]
    table = at_slip(table, slide_to_roll_ratio).transpose(*names, ...)
    every_level = product(*(table[name].values.tolist() for name in names))
    return [
        _point(table.isel(dict(zip(names, index, strict=True))), slide_to_roll_ratio, levels)
        for index, levels in zip(
            np.ndindex(table["film_thickness"].shape), every_level, strict=True
        )
    ]


def _point(row, slide_to_roll_ratio, levels):
    names = "film_thickness", "contact_half_width", "entrainment_speed", "reduced_modulus"
    numbers = (row[name].item() for name in names)
    return OperatingPoint(slide_to_roll_ratio, *levels, *numbers, row.reset_coords(drop=True))
