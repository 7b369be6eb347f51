"""Operating points as rows of the film table, and the speeds of their surfaces."""

import logging
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.grid.gap import Gap
from lube.grid.levels import rolling
from lube.schema import CONTACT_DIMS, EXPERIMENT_DIMS, OPERATING_DIMS, POINT_DIMS, model_dependent

log = logging.getLogger(__name__)


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

    The film depends on it with inlet shear heating, or if the oil answers the roughness.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset.
    slide_to_roll_ratio : float, optional
        One of its slide-to-roll ratios; by default pure rolling if it is one, else the first.

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


def rows_at(film: xr.Dataset, points: Sequence[Mapping[str, Any]]) -> xr.Dataset:
    """Select the rows of a film table at some operating points.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset.
    points : sequence of mapping
        Level of each of `lube.schema.CONTACT_DIMS`; the slide-to-roll ratio is the same at all.

    Returns
    -------
    xarray.Dataset
        Over operating_point.
    """
    columns = {name: [point[name] for point in points] for name in CONTACT_DIMS}
    levels = {name: xr.DataArray(each, dims="operating_point") for name, each in columns.items()}
    rows = at_slip(film, points[0]["slide_to_roll_ratio"])
    rows = rows.sel({name: levels[name] for name in OPERATING_DIMS})
    return rows.assign_coords(slide_to_roll_ratio=levels["slide_to_roll_ratio"])


def by_contact_model(dataset: xr.Dataset) -> xr.Dataset:
    """Give a dataset the dimension contact_model, which it lacks if only lines are asked for.

    Parameters
    ----------
    dataset : xarray.Dataset
        A ``tail`` dataset.

    Returns
    -------
    xarray.Dataset
        The dataset, with ``line`` as the only level if it had none.
    """
    if "contact_model" in dataset.dims:
        return dataset
    return dataset.expand_dims(contact_model=["line"])


def over_contact_models(kind: str, tables: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Join datasets of one kind, each by another contact model.

    Parameters
    ----------
    kind : str
        A key of `lube.schema.FILES`.
    tables : mapping of str to xarray.Dataset
        Datasets by their contact models. What does not depend on the model is the same in all.

    Returns
    -------
    xarray.Dataset
        What depends on the contact model is over contact_model, in the order of the tables.
    """
    first = next(iter(tables.values()))
    names = [name for name in model_dependent(kind) if name in first]
    models = xr.DataArray(list(tables), dims="contact_model", name="contact_model")
    by_model = xr.concat([table[names] for table in tables.values()], models, join="exact")
    return first.drop_vars(names).merge(by_model)


def known_films(film: xr.Dataset, gap: Gap) -> xr.DataArray:
    """Find where the film is known, with its shape and response as far as contact needs them.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset, or rows of one.
    gap : Gap
        Says whether contact needs the film's shape, and its response to the roughness.

    Returns
    -------
    xarray.DataArray
        Over the dimensions of its ``film_thickness``.
    """
    known = film["film_thickness"].notnull()
    if gap.has_shape:
        known = known & film["film_profile"].notnull().all("film_position")
    if gap.is_answered:
        known = known & film["interpolation_error"].notnull().all("roller")
    return known


def operating_points(table: xr.Dataset, slide_to_roll_ratio: float) -> xr.Dataset:
    """List the operating points of a film table.

    Parameters
    ----------
    table : xarray.Dataset
        A ``film`` dataset of one film formula, without that dimension.
    slide_to_roll_ratio : float
        Slide-to-roll ratio of all points.

    Returns
    -------
    xarray.Dataset
        Over operating_point, in the order of lubricant, temperature, speed and force; the force
        changes fastest.

    Examples
    --------
    >>> names = "lubricant", "temperature", "speed", "force"
    >>> levels = ["oil"], [40.0], [100.0], [200.0, 400.0]
    >>> films = {"film_thickness": (names, [[[[1.0e-6, 0.9e-6]]]])}
    >>> table = xr.Dataset(films, dict(zip(names, levels)))
    >>> operating_points(table, 0.0)["force"].values.tolist()
    [200.0, 400.0]
    """
    rows = at_slip(table, slide_to_roll_ratio).stack(operating_point=POINT_DIMS, create_index=False)
    slips = np.full(rows.sizes["operating_point"], slide_to_roll_ratio)
    rows = rows.assign_coords(slide_to_roll_ratio=("operating_point", slips))
    return rows.transpose("operating_point", ...)


def levels_at(points: xr.Dataset, number: int) -> dict[str, float | str]:
    """Return the levels of an operating point, by the names of `lube.schema.EXPERIMENT_DIMS`."""
    return {name: points[name][number].item() for name in EXPERIMENT_DIMS}


def known_rows(film: xr.Dataset, points: Sequence[Mapping[str, Any]], gap: Gap) -> xr.Dataset:
    """Select the rows of a film table at the points of traces, where the film is known.

    Parameters
    ----------
    film, points
        As in `rows_at`.
    gap : Gap
        As in `known_films`.

    Returns
    -------
    xarray.Dataset
        Over operating_point. The log names the points that are left out.

    Raises
    ------
    DataError
        If the film is known at none of the points.
    """
    rows = rows_at(film, points)
    known = known_films(rows, gap).values
    for number in np.flatnonzero(~known):
        log.warning("traces.%d: left out, the film is not known there", number)
    if not known.any():
        raise DataError("traces: the film is known at none of the points, need it at one or more")
    return rows.isel(operating_point=known)
