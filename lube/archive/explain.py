"""Trace a number of contact.nc or areal.nc to what determines it, and compute it again.

The file states the values of the study that determine it. Together with the film table in the same
folder they suffice to draw the roughness again and find its contact, to the last bit.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from lube.contact.ensemble import with_intervals
from lube.contact.rough_pair import RoughPair, roughness_batch
from lube.contact.surface_strip import SURFACES
from lube.errors import DataError
from lube.grid.film_responses import with_surface_responses
from lube.grid.gap import Gap
from lube.grid.levels import level_index
from lube.report.pages import render
from lube.schema import CONTACT_DIMS
from lube.stages.areal import FEWER, contact_of_surfaces
from lube.stages.contact import contact_statistics
from lube.storage.netcdf import load
from lube.storage.provenance import fingerprint, json_attribute
from lube.study.line_spec import LineSpec
from lube.study.rollers import BoundaryLayer
from lube.types import File


@dataclass(frozen=True)
class Explanation:
    """An operating point of a file, what determines it, and the same point computed again.

    Attributes
    ----------
    kind : str
        Kind of the file: ``contact``, of lines, or ``areal``, of surfaces.
    contact : xarray.Dataset
        The operating point as stored in the file, of lines with the realisations computed again.
    lubricant : xarray.Dataset
        The properties of its lubricant at its temperature.
    film : xarray.Dataset
        The film table at the operating point.
    values : dict
        The study's values that determine it, by stage, in SI units (except rpm and degC).
    again : xarray.Dataset
        The same operating point, computed again.
    """

    kind: str
    contact: xr.Dataset
    lubricant: xr.Dataset
    film: xr.Dataset
    values: dict[str, Any]
    again: xr.Dataset

    @property
    def differing(self) -> list[str]:
        """Names of the variables that are not the same to the last bit."""
        pairs = ((name, one.values, self.contact[name].values) for name, one in self.again.items())
        return [name for name, one, other in pairs if one.tobytes() != other.tobytes()]


def explain(path: File, realisation: int | None = 0, **levels: float | str) -> Explanation:
    """Trace an operating point of contact.nc or areal.nc and compute it again.

    Parameters
    ----------
    path : str or Path
        A contact.nc, or an areal.nc for contact of the surfaces, in one folder with the datasets
        that it was made from.
    realisation : int or None, optional
        The realisation to compute again; None for all of them, with their mean and interval.
        Surfaces are always all computed again.
    **levels
        The operating point, by the coordinates of the file, such as ``force=800``; a number
        within half a per cent of a level selects that level. A coordinate with one level may be
        omitted; for lubricant, film_formula and slide_to_roll_ratio the first is the default.

    Returns
    -------
    Explanation
        The operating point, what determines it, and the same point computed again.

    Raises
    ------
    DataError
        If a file cannot be used, the files do not belong together, or there is no such
        operating point or realisation.
    """
    path = Path(path)
    kind = "areal" if path.stem == "areal" else "contact"
    contact = load(path, kind)
    film = _input_of(contact, path, "film")
    lubricant = _input_of(film, path.with_name("film.nc"), "lubricant")
    stored = _operating_point(contact, path, levels)
    point, properties = (_at(stored, table) for table in (film, lubricant))
    values = json_attribute(contact, "config", path)
    run = values["film"] | values[kind]
    pair = _pair(run, path)
    if kind == "areal":
        inputs = {"film": film.isel(film_formula=slice(contact.sizes["film_formula"]))}
        if pair.gap.is_answered:
            inputs["surface_response"] = _input_of(contact, path, "surface_response")
        film, slips = with_surface_responses(inputs), run["slide_to_roll_ratio"]
        again = _surfaces_again(stored, film, pair, slips)
        return Explanation(kind, stored, properties, point, values, again)
    if realisation is not None:
        if realisation not in stored["realisation"]:
            first, last = stored["realisation"].values[[0, -1]]
            raise DataError(f"{path}: realisation: got {realisation}, need {first} to {last}")
        stored = stored.sel(realisation=[realisation])
    again = _lines_again(stored, point, pair, run["revolutions"])
    if realisation is None:
        again = with_intervals(again, point)
    return Explanation(kind, stored, properties, point, values, again)


def _at(point, table):
    """Rows of a table at an operating point; all dimensions are kept."""
    return table.sel({name: point[name].values for name in CONTACT_DIMS if name in table.dims})


def _input_of(dataset, path, kind):
    """Load one of the files that a dataset was made from, from the same folder."""
    other = path.with_name(f"{kind}.nc")
    loaded = load(other, kind)
    if fingerprint(other) not in json_attribute(dataset, "inputs_sha256", path).values():
        raise DataError(f"{other}: not the file that {path} was made from")
    return loaded


def _operating_point(contact, path, levels):
    """Select one operating point; all dimensions are kept."""
    unknown = sorted(set(levels) - set(CONTACT_DIMS))
    if unknown:
        known = ", ".join(CONTACT_DIMS)
        raise DataError(f"{path}: got {unknown[0]}, need coordinates of the file: {known}")
    chosen = {name: [_level(contact[name], path, levels.get(name))] for name in CONTACT_DIMS}
    return contact.isel(chosen)


def _level(coordinate, path, wanted):
    """Index of the level that is asked for."""
    levels, name = coordinate.values.tolist(), coordinate.name
    if wanted is None and (len(levels) == 1 or name not in ("temperature", "speed", "force")):
        return 0
    index = level_index(levels, wanted)
    if index is None:
        came = "missing" if wanted is None else f"got {wanted}"
        known = ", ".join(one if isinstance(one, str) else f"{one:g}" for one in levels)
        raise DataError(f"{path}: {name}: {came}, need one of {known}")
    return index


def _pair(run, path):
    """Rough rollers of a study's values, if their lines were drawn."""
    if any(line.get("heights") for line in run["lines"]["lines"]):
        raise DataError(
            f"{path}: got a line that is a measured profile, need lines drawn from a spectrum: "
            "its heights are in roughness.nc alone"
        )
    layer = BoundaryLayer.model_construct(**run["boundary_layer"])
    gap = Gap(run["film_shape"], run["roughness_deformation"])
    return RoughPair(LineSpec(**run["lines"]), run["rollers"]["length"], layer, run["seed"], gap)


def _surfaces_again(stored, film, pair, slips):
    """Draw the surfaces again and sample their contact at one operating point.

    The grid of the surfaces depends on the films of all points.
    """
    wanted = xr.ones_like(film["film_thickness"], bool)
    for name in wanted.dims:
        wanted = wanted & (film[name] == stored[name].values)
    return _at(stored, contact_of_surfaces(pair, film, slips, wanted=wanted.drop_attrs()))


def _lines_again(stored, film, pair, revolutions):
    """Draw the roughness again and run the contact model on it; use only the levels of `stored`."""
    ratios, parts = stored["slide_to_roll_ratio"].values.tolist(), []
    numbers = stored["realisation"].values.tolist()
    for first in range(0, len(numbers), 8):  # a few at a time, for the memory that lines take
        lines = roughness_batch(pair.spec, pair.seed, numbers[first : first + 8])
        parts.append(contact_statistics(lines, film, pair.layer, ratios, revolutions, pair.gap))
    options = {"join": "exact", "data_vars": "minimal", "combine_attrs": "override"}
    return xr.concat(parts, "realisation", **options)


def in_words(explanation: Explanation) -> str:
    """Format an explanation as text.

    Parameters
    ----------
    explanation : Explanation
        From `explain`.

    Returns
    -------
    str
        Several lines.
    """
    again, formulas = explanation.again, explanation.values["film"]["film_formulas"]
    is_first = explanation.contact["film_formula"].item() == formulas[0]
    return render(
        "explanation.txt",
        **vars(explanation),
        dims=CONTACT_DIMS,
        differing=explanation.differing,
        surfaces=SURFACES // (1 if is_first else FEWER),
        realised=[name for name in again if "realisation" in again[name].dims],
        stated=_stated,
    ).strip()


def _stated(array):
    """Return the single value of a variable, in words or with its unit."""
    value, unit = array.values.item(), array.attrs.get("units", "1")
    if "flag_meanings" in array.attrs:
        value = array.attrs["flag_meanings"].split()[int(value)]
    return f"{value}" if unit == "1" else f"{value} {unit}"
