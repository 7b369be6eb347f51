"""What the explorer's page holds: a study's values, as plain lists.

Every number is one of a dataset, unrounded, and all are at the study's own levels. Only traces
are thinned out: of several neighbouring steps the extreme values stay.
"""

import numpy as np
import xarray as xr

from lube import schema
from lube.ehl.film_formulas import FORMULAS
from lube.grid.model_limits import merged, overloaded
from lube.schema import COORDINATES, FILES
from lube.units import with_unit

CHOICES = tuple("lubricant film_formula force speed temperature slide_to_roll_ratio".split())
"""What a reader chooses; together they make one operating point."""
PROBABILITIES = ("breakthrough_probability", "geometric_contact_probability")
LIMITS = ("mean", "lower", "upper")
SHOWN = {
    "lubricant": ("dynamic_viscosity", "pressure_viscosity_coefficient"),
    "film": (
        "film_thickness lambda_ratio regime formula_place formula_source in_validity_range "
        "moes_load moes_material contact_half_width hertz_pressure entrainment_speed "
        "inlet_shear_heating_factor"
    ).split(),
    "contact": [f"{kind}_{limit}" for kind in PROBABILITIES for limit in LIMITS],
    "tail": [
        f"{kind}{limit}"
        for kind in (*PROBABILITIES, "breakthrough_rate")
        for limit in schema.LIMITS
    ],
}
"""Variables that the page holds of each dataset, all of them over some of `CHOICES`."""
TRACES = {"contact_length": np.maximum, "contact_resistance": np.minimum}
"""Variables of a trace, each with what stays of several neighbouring steps."""
NO_RECORDS = {"origin": "", "rows": []}
TRACE_PIECES = 1000
"""Greatest number of pieces that a trace is drawn of: about one for each pixel."""
CLOSE_UP = 3.0
"""Time on either side of a trace's peak that its close-up shows, in crossings of the contact."""


def page_content(datasets: dict[str, xr.Dataset]) -> dict:
    """Collect what the page holds.

    Parameters
    ----------
    datasets : dict of str to xarray.Dataset
        The study's ``lubricant``, ``film``, ``contact``, ``tail`` and ``trace``, and its
        ``master`` and ``comparison`` if it has them.

    Returns
    -------
    dict
        Fit for JSON, with None for NaN and infinity:

        - ``levels``: for each of `CHOICES` its values, and their names for a reader;
        - ``variables``: for each of `SHOWN`, by `page_name`, its dimensions, unit, meaning, and
          values in the order of the dimensions, the last one fastest;
        - ``marks``: points outside the model, and those where merged segments hold;
        - ``sampled``: whether there is contact at any rarity, by importance sampling;
        - ``regimes``: names of the regimes of lubrication;
        - ``validity``: limits of the Moes numbers within which each film formula was validated;
        - ``master``: the master map, or None;
        - ``records``: conditions and contact shares of the rig's records;
        - ``conducts``: whether contact has a resistance;
        - ``traces``: the traces, each with its place in the levels.
    """
    contact = datasets["contact"]
    levels = {name: contact[name].values.tolist() for name in CHOICES}
    marks = {"overloaded": overloaded(contact), "merged": merged(contact, datasets["film"])}
    load_share = contact["contact_load_share"].mean("realisation", keep_attrs=True)
    return {
        "study": contact.attrs["study"],
        "levels": {
            name: {"values": values, "names": level_names(name, values)}
            for name, values in levels.items()
        },
        "variables": {
            page_name(kind, name): _variable(datasets[kind][name], kind)
            for kind, names in SHOWN.items()
            for name in names
        }
        | {"contact_load_share": _variable(load_share, "contact")},
        "marks": {
            name: {"dims": list(where.dims), "values": _plain(where.values.ravel())}
            for name, where in marks.items()
        },
        "sampled": not datasets["tail"].attrs["remarks"],
        "regimes": datasets["film"]["regime"].attrs["flag_meanings"].split(),
        "validity": {name: _validity(FORMULAS[name]) for name in levels["film_formula"]},
        "master": _master(datasets["master"]) if "master" in datasets else None,
        "records": _records(datasets["comparison"]) if "comparison" in datasets else NO_RECORDS,
        "conducts": bool(datasets["trace"]["contact_resistance"].notnull().any()),
        "traces": [_trace(point, levels) for point in _points(datasets["trace"])],
    }


def page_name(kind: str, name: str) -> str:
    """Name of a variable on the page: its own, but ``tail.`` before those of ``tail.nc``.

    Some of ``contact.nc`` have the same names.
    """
    return f"tail.{name}" if kind == "tail" else name


def level_names(name: str, values: list) -> list[str]:
    """Name the levels of a choice for a reader.

    Parameters
    ----------
    name : str
        One of `CHOICES`.
    values : list
        Its levels.

    Returns
    -------
    list of str
        Different names, such as ``85.71 r/min``.
    """
    if name in ("lubricant", "film_formula"):
        return values
    unit = COORDINATES[name].units
    rounded = [value if value == round(value) else float(f"{value:.4g}") for value in values]
    names = [with_unit(value, "" if unit == "1" else unit) for value in rounded]
    if len(set(names)) == len(names):
        return names
    return [str(value) for value in values]


def _variable(array, kind):
    """One variable, its dimensions in the order of its values."""
    return {
        "file": f"{kind}.nc",
        "dims": list(array.dims),
        "units": array.attrs.get("units", ""),
        "long_name": FILES[kind][array.name].long_name,
        "values": _plain(array.values.ravel()),
    }


def _validity(formula):
    return {"moes_load": list(formula.moes_load), "moes_material": list(formula.moes_material)}


def _master(master):
    """List the master map, its probabilities as rows of one contact width."""
    limits = {
        limit: _plain(master[f"breakthrough_probability_{limit}"].transpose("contact_width", ...))
        for limit in LIMITS
    }
    return {name: _plain(master[name]) for name in ("lambda_ratio", "contact_width")} | limits


def _records(comparison):
    """List the records with a contact share as dicts; their values by formula are lists."""
    names = (
        "record lubricant slide_to_roll_ratio force speed temperature "
        "force_level speed_level temperature_level "
        "measured_share measured_share_lower measured_share_upper "
        "lambda_ratio predicted_share_lower predicted_share_upper"
    ).split()
    counted = comparison.isel(record=np.isfinite(comparison["measured_share"].values))
    columns = {name: _plain(counted[name].transpose("record", ...)) for name in names}
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return {"origin": comparison["origin"].item(), "rows": rows}


def _points(trace):
    return [trace.isel(operating_point=row) for row in range(trace.sizes["operating_point"])]


def _trace(point, levels):
    """One trace: where it was kept, its whole revolution, and a close-up of its peak."""
    time, length = point["time"].values, point["contact_length"].values
    crossing = 2.0 * point["contact_half_width"].item() / point["entrainment_speed"].item()
    reach = round(CLOSE_UP * crossing / (time[1] - time[0]))
    peak = int(length.argmax())
    close = slice(max(peak - reach, 0), peak + reach + 1)
    return {
        "at": {name: levels[name].index(point[name].item()) for name in CHOICES},
        "share": float(np.mean(length > 0.0)),
        "crossing": crossing,
        "whole": _thinned(point, slice(None)),
        "close": _thinned(point, close),
    }


def _thinned(point, part):
    """Extreme values of neighbouring steps of a part of a trace, and how many steps they are."""
    part = point.isel(time=part)
    time = part["time"].values
    steps = -(-time.size // TRACE_PIECES)
    starts = np.arange(0, time.size, steps)
    return {
        "steps": steps,
        "time": _plain(time[starts]),
        **{name: _plain(best.reduceat(part[name].values, starts)) for name, best in TRACES.items()},
    }


def _plain(values):
    """Nested lists of an array, with None for what JSON has no number for."""
    values = np.asarray(values)
    if values.dtype.kind == "f":
        values = np.where(np.isfinite(values), values.astype(object), None)
    return values.tolist()
