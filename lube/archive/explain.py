"""Where a number of contact.nc comes from, and the same number made again, to the last bit.

The file itself says which values of the study it follows from; with the film table beside it
that is all it takes to draw the roughness anew and run the model on it.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import xarray as xr
from pydantic import BaseModel, Field, ValidationError

from lube.errors import DataError
from lube.grid.levels import format_levels, level_index
from lube.schema import CONTACT_DIMS
from lube.stages.contact import contact_statistics
from lube.stages.ensemble import with_intervals
from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import load
from lube.storage.provenance import fingerprint, told_by, told_inputs
from lube.study.rollers import BoundaryLayer, LineSpec


class _Layer(BaseModel):
    critical_thickness: float
    shear_strength: float


class _Run(BaseModel):
    """How the model was run for a contact.nc, as the file tells it."""

    lines: LineSpec
    boundary_layer: _Layer
    reduced_modulus: float
    seed: Annotated[int, Field(ge=0)]
    revolutions: Annotated[int, Field(ge=1)]


@dataclass(frozen=True)
class Explanation:
    """A cell of contact.nc, what it follows from, and what comes out when it is made again.

    Attributes
    ----------
    contact : xarray.Dataset
        The cell as it stands in the file, its realisations those that were made again.
    lubricant : xarray.Dataset
        The properties of its lubricant at its temperature.
    film : xarray.Dataset
        The film table at the operating point.
    values : dict
        The study's values behind it, from stage to values, in SI units (but rpm and degC).
    again : xarray.Dataset
        The same cell, made again.
    """

    contact: xr.Dataset
    lubricant: xr.Dataset
    film: xr.Dataset
    values: dict
    again: xr.Dataset

    @property
    def differing(self):
        """Names of the variables that are not the same to the last bit."""
        return [
            name
            for name in self.again.data_vars
            if self.again[name].values.tobytes() != self.contact[name].values.tobytes()
        ]


def explain(path, realisation=0, **levels):
    """Trace a cell of contact.nc, and make it again.

    Parameters
    ----------
    path : str or Path
        A contact.nc; the film.nc and lubricant.nc that it follows from lie beside it.
    realisation : int or None, optional
        Which realisation is made again; None for all of them, and then their mean and interval
        as well.
    **levels
        Operating point, by the coordinates of the file, such as ``force=800``; a number within
        half a per cent of a level means that level. A coordinate of one level may be left out;
        of lubricant, film_formula and slide_to_roll_ratio the first stands if none is named.

    Returns
    -------
    Explanation
        The cell, what is behind it, and the same cell made again.

    Raises
    ------
    DataError
        If a file cannot be used, they do not belong together, or there is no such cell.
    """
    path = Path(path)
    if path.is_dir():
        raise DataError(f"{path}: got a folder, need a contact.nc; an archive's is in its data")
    contact = load(path, "contact")
    film = _beside(path, contact, "film")
    lubricant = _beside(path.with_name("film.nc"), film, "lubricant")
    cell = _cell(contact, path, levels)
    if realisation is not None:
        if realisation not in cell["realisation"]:
            known = f"{cell['realisation'].values[0]} to {cell['realisation'].values[-1]}"
            raise DataError(f"{path}: realisation: got {realisation}, need {known}")
        cell = cell.sel(realisation=[realisation])
    values = told_by(contact, "config", path)
    try:
        run = _Run.model_validate(values.get("contact"))
    except ValidationError:
        raise DataError(f"{path}: its attribute 'config' does not tell how it was made") from None
    oil, point = (
        table.sel({name: cell[name].values for name in CONTACT_DIMS if name in table.dims})
        for table in (lubricant, film)
    )
    # Only the names of the realisations and the slip: the stored results stay out of its reach.
    realisations, ratios = (
        cell[name].values.tolist() for name in ("realisation", "slide_to_roll_ratio")
    )
    again = _made_again(realisations, ratios, point, run)
    if realisation is None:
        again = with_intervals(again, point)
    return Explanation(cell, oil, point, values, again)


def _beside(path, dataset, kind):
    """Load the file beside another, which must be the one that the other was made from."""
    other = path.with_name(f"{kind}.nc")
    loaded = load(other, kind)
    if fingerprint(other) not in told_inputs(dataset, path).get(other.name, ()):
        raise DataError(f"{other}: not the file that {path} was made from")
    return loaded


def _cell(contact, path, levels):
    """Select one operating point, all dimensions kept."""
    unknown = sorted(set(levels) - set(CONTACT_DIMS))
    if unknown:
        raise DataError(f"{path}: got {unknown[0]}, need names among {', '.join(CONTACT_DIMS)}")
    chosen = {name: [_level(contact[name], path, levels.get(name))] for name in CONTACT_DIMS}
    return contact.isel(chosen)


def _level(coordinate, path, wanted):
    """Index of the level that is wanted."""
    levels, name = coordinate.values.tolist(), coordinate.name
    if wanted is None and (len(levels) == 1 or name not in ("temperature", "speed", "force")):
        return 0
    index = level_index(levels, wanted)
    if index is None:
        came = "missing" if wanted is None else f"got {wanted}"
        raise DataError(f"{path}: {name}: {came}, need one of {format_levels(levels)}")
    return index


def _made_again(realisations, ratios, film, run):
    """Draw the roughness of some realisations anew, and run the model on it."""
    layer = BoundaryLayer.model_construct(**dict(run.boundary_layer))
    parts = []
    for realisation in realisations:
        lines = roughness_batch(run.lines, run.seed, [realisation])
        parts.append(contact_statistics(lines, film, layer, ratios, run.revolutions))
    return xr.concat(
        parts, "realisation", join="exact", data_vars="minimal", combine_attrs="override"
    )


def in_words(explanation):
    """Tell an explanation as text.

    Parameters
    ----------
    explanation : Explanation
        From `explain`.

    Returns
    -------
    str
        Several lines.
    """
    contact, run = explanation.contact, explanation.values["contact"]
    sections = {
        contact.attrs["title"]: [
            (name, contact.attrs[name])
            for name in ("study", "config_sha256", "source", "code_commit", "software")
        ],
        "Operating point": [_told(contact, name) for name in CONTACT_DIMS],
        "Lubricant": [_told(explanation.lubricant, name) for name in _OIL],
        "Film": [_told(explanation.film, name) for name in _FILM],
        "Roughness": _lines_told(contact, run),
        "Contact": [
            ("critical thickness of the layer", f"{run['boundary_layer']['critical_thickness']} m"),
            ("limiting shear stress", f"{run['boundary_layer']['shear_strength']} Pa"),
            ("reduced modulus E*", f"{run['reduced_modulus']} Pa"),
            ("revolutions", run["revolutions"]),
        ],
        "In the file, and made again": list(_results_told(explanation)),
    }
    width = max(len(name) for rows in sections.values() for name, _ in rows)
    return "\n\n".join(
        "\n".join([title, *(f"  {name:{width}}  {value}" for name, value in rows)])
        for title, rows in sections.items()
    )


_OIL = ("kinematic_viscosity", "density", "dynamic_viscosity", "pressure_viscosity_coefficient")
_FILM = (
    *("film_thickness", "lambda_ratio", "contact_half_width", "hertz_pressure"),
    *("entrainment_speed", "moes_load", "moes_material", "in_validity_range", "formula_source"),
)


def _told(dataset, name):
    """Name and value of a variable that has one value."""
    array = dataset[name]
    value = array.values.item()
    if "flag_meanings" in array.attrs:
        value = array.attrs["flag_meanings"].split()[int(value)]
    return array.attrs["long_name"], _with_units(value, array)


def _with_units(value, array):
    units = array.attrs.get("units", "1")
    return f"{value}" if units == "1" else f"{value} {units}"


def _lines_told(contact, run):
    realisations = contact["realisation"].values.tolist()
    last = realisations[-1]
    which, each = (last, last) if len(realisations) == 1 else (f"r = 0 to {last}", "r")
    spec = run["lines"]
    return [
        ("realisation", which),
        ("seeds of the two lines", f"numpy.random.SeedSequence(({run['seed']}, {each})).spawn(2)"),
        ("points of either line", ", ".join(str(points) for points in spec["points"])),
        ("spacing", f"{spec['spacing']} m"),
        ("rms heights", ", ".join(f"{height} m" for height in spec["rms_height"])),
        ("Hurst exponent", spec["hurst_exponent"]),
        ("wave vectors", f"{spec['q_min']} to {spec['q_max']} rad/m"),
    ]


def _results_told(explanation):
    for name, again in explanation.again.data_vars.items():
        if again.size > 1 or not again.dims:
            continue  # of many realisations only the mean and its interval fit a line
        stored, made = (one.values.item() for one in (explanation.contact[name], again))
        verdict = "the same bits" if name not in explanation.differing else f"NOT THE SAME: {made}"
        yield again.attrs["long_name"], f"{_with_units(stored, again)}: {verdict}"
    count = explanation.contact.sizes["realisation"]
    if count > 1:
        differing = [
            name for name in explanation.differing if "realisation" in explanation.again[name].dims
        ]
        yield f"all {count} realisations", "NOT THE SAME" if differing else "the same bits"
