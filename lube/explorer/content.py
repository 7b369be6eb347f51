"""What the explorer's page holds: a study's values, as plain lists.

Every number comes from a dataset, unrounded, at the study's levels. Only traces are thinned out:
of several neighbouring steps the extreme value stays.
"""

import numpy as np
import xarray as xr
from pydantic_core import to_jsonable_python

from lube.contact.ensemble import PROBABILITIES
from lube.ehl.film_formulas import FORMULAS
from lube.grid.model_limits import deformed, merged, overloaded, rubbing, separated
from lube.inference.surface_scatter import revolution_limits
from lube.schema import COORDINATES, FILES, LIMITS, MEAN_LIMITS
from lube.units import with_unit

CHOICES = tuple("lubricant film_formula force speed temperature slide_to_roll_ratio".split())
"""Coordinates that a reader chooses; together they make one operating point."""
MODEL = "contact_model"
"""A further one, of studies that ask for contact of surfaces."""
SHOWN = {
    "lubricant": ("dynamic_viscosity", "pressure_viscosity_coefficient"),
    "film": (
        "film_thickness lambda_ratio regime formula_place formula_source in_validity_range "
        "moes_load moes_material contact_half_width hertz_pressure entrainment_speed "
        "inlet_shear_heating_factor"
    ).split(),
    "contact": [
        *(f"{kind}{limit}" for kind in PROBABILITIES for limit in MEAN_LIMITS),
        *(f"breakthrough_probability_pair{limit}" for limit in LIMITS[1:]),
    ],
    "tail": [
        f"{kind}{limit}" for kind in (*PROBABILITIES, "breakthrough_rate") for limit in LIMITS
    ],
    "sensitivity": [f"breakthrough_probability{limit}" for limit in LIMITS[1:]],
}
"""Variables of each dataset that the page holds, all of them over some of `CHOICES`."""
TRACES = {"contact_length": np.maximum, "contact_resistance": np.minimum}
"""Variables of a trace, each with the function that thins out its neighbouring steps."""
NO_RECORDS = {"origin": "", "by_model": False, "rows": []}
TRACE_PIECES = 1000
"""Largest number of pieces in a drawn trace: about one for each pixel."""
CLOSE_UP = 3.0
"""Time on either side of a trace's peak that its close-up shows, in crossings of the contact."""


def page_content(datasets: dict[str, xr.Dataset]) -> dict:
    """Collect what the page holds.

    Parameters
    ----------
    datasets : dict of str to xarray.Dataset
        The study's datasets from `lube.explorer.explored`.

    Returns
    -------
    dict
        Fit for JSON, with None for NaN and infinity:

        - ``levels``: for each of `CHOICES`, and for `MODEL` if ``tail`` has it, its values, and
          their names for a reader;
        - ``variables``: for each of `SHOWN`, by `page_name`, its dimensions, unit, meaning, and
          values in the order of the dimensions, the last one fastest;
        - ``marks``: points outside the model, those with less contact than at a thicker film, and
          those where the oil may keep lines apart that touch here, of lines; those where the linear
          response to roughness is not valid, and those where asperities of the surfaces carry much
          of the load;
        - ``factors``: what the band of the assumptions is over;
        - ``sampled``: whether the study has probabilities by importance sampling;
        - ``regimes``: names of the regimes of lubrication;
        - ``validity``: limits of the Moes numbers within which each film formula was validated;
        - ``master``: the master map, or None;
        - ``records``: conditions and contact shares of the rig's records;
        - ``conducts``: whether contact has a resistance;
        - ``traces``: the traces of lines and of surfaces, each with the indices of its levels.
    """
    film, tail, uncertain = map(datasets.get, ("film", "tail", "sensitivity"))
    levels = {name: tail[name].values.tolist() for name in (*CHOICES, MODEL) if name in tail.dims}
    traces = list(_traces(datasets, levels))
    return {
        "study": film.attrs["study"],
        "levels": {
            name: {"values": values, "names": level_names(name, values)}
            for name, values in levels.items()
        },
        "variables": _variables(datasets) | _further_variables(datasets),
        "marks": _marks(film, tail, datasets.get("contact")),
        "factors": [] if uncertain is None else uncertain["factor"].values.tolist(),
        "sampled": not tail.attrs["remarks"],
        "regimes": film["regime"].attrs["flag_meanings"].split(),
        "validity": {
            name: {moes: getattr(FORMULAS[name], moes) for moes in ("moes_load", "moes_material")}
            for name in levels["film_formula"]
        },
        "master": _master(datasets["master"]) if "master" in datasets else None,
        "records": _records(datasets["comparison"]) if "comparison" in datasets else NO_RECORDS,
        "conducts": any(one["conducts"] for one in traces),
        "traces": traces,
    }


def _marks(film, tail, contact):
    """Describe the points where the model does not hold, by what it leaves out."""
    marks = {"deformed": _deformed(film, tail), "rubbing": rubbing(film)}
    if contact is not None:
        marks |= {"overloaded": overloaded(contact), "merged": merged(contact, film)}
        marks["separated"] = separated(film)
    return {
        name: {"dims": list(where.dims), "values": _plain(where.values.ravel())}
        for name, where in marks.items()
    }


def _deformed(film, tail):
    """Points where the linear response to roughness is not valid, of each contact model."""
    if MODEL not in tail.dims:
        return deformed(film)
    by_model = {"line": deformed(film), "surface": deformed(film, tail)}
    by_model = xr.broadcast(*(by_model[model] for model in tail[MODEL].values))
    return xr.concat(by_model, tail[MODEL], join="exact")


def page_name(kind: str, name: str) -> str:
    """Name of a variable on the page: those of ``tail.nc`` and ``sensitivity.nc`` have a prefix.

    Some variables of ``contact.nc`` have the same names.
    """
    return f"{kind}.{name}" if kind in ("tail", "sensitivity") else name


def level_names(name: str, values: list) -> list[str]:
    """Name the levels of a choice for a reader.

    Parameters
    ----------
    name : str
        One of `CHOICES`, or `MODEL`.
    values : list
        Its levels.

    Returns
    -------
    list of str
        Their names, such as ``85.71 r/min``.
    """
    if name in ("lubricant", "film_formula", MODEL):
        return values
    unit = COORDINATES[name].units
    rounded = [value if value == round(value) else float(f"{value:.4g}") for value in values]
    return [with_unit(value, "" if unit == "1" else unit) for value in rounded]


def _variables(datasets):
    """Describe the variables `SHOWN` of the datasets that the study has."""
    return {
        page_name(kind, name): _variable(datasets[kind][name], kind)
        for kind, names in SHOWN.items()
        if kind in datasets
        for name in names
    }


def _variable(array, kind):
    """Describe one variable, with its dimensions in the order of its values."""
    return {
        "file": f"{kind}.nc",
        "dims": list(array.dims),
        "units": array.attrs.get("units", ""),
        "long_name": FILES[kind][array.name].long_name,
        "values": _plain(array.values.ravel()),
    }


def _master(master):
    """List the master map; each row of its probabilities belongs to one contact width."""
    axes = {name: _plain(master[name]) for name in ("lambda_ratio", "contact_width")}
    rows = master.transpose("contact_width", ...)
    ends = ("mean", "lower", "upper")
    return axes | {end: _plain(rows[f"breakthrough_probability_{end}"]) for end in ends}


def _records(comparison):
    """List the records that have a contact share.

    Values for each film formula are lists, for each contact model lists of these.
    """
    names = (
        "record lubricant slide_to_roll_ratio force speed temperature "
        "force_level speed_level temperature_level "
        "measured_share measured_share_lower measured_share_upper "
        "lambda_ratio predicted_share_lower predicted_share_upper"
    ).split()
    counted = comparison.isel(record=np.isfinite(comparison["measured_share"].values))
    columns = {name: _plain(counted[name].transpose("record", ...)) for name in names}
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    by_model = MODEL in comparison.dims
    return {"origin": comparison["origin"].item(), "by_model": by_model, "rows": rows}


def _further_variables(datasets):
    """Describe shares of the load on asperities, and limits for one pair in a revolution."""
    film, tail, described = datasets["film"], datasets["tail"], {}
    if "contact" in datasets:
        share = datasets["contact"]["contact_load_share"].mean("realisation", keep_attrs=True)
        described["contact_load_share"] = _variable(share, "contact")
    if "surface_load_share" in film:
        described["surface_load_share"] = _variable(film["surface_load_share"], "film")
    if "surface_pair_deviation" in tail:
        limits = revolution_limits(tail.sel({MODEL: "surface"}))
        for end, limit in zip(LIMITS[1:], limits, strict=True):
            of_lines = _variable(limit.rename(f"breakthrough_probability_pair{end}"), "contact")
            described[f"surface_pair{end}"] = of_lines | {"file": "tail.nc"}
    return described


def _traces(datasets, levels):
    """Describe the traces of lines and of surfaces, as far as the study asks for their contact."""
    for kind, model in (("trace", "line"), ("surface_trace", "surface")):
        if kind in datasets and model in levels.get(MODEL, ["line"]):
            for row in range(datasets[kind].sizes["operating_point"]):
                yield _trace(datasets[kind].isel(operating_point=row), levels, model)


def _trace(point, levels, model):
    """Describe one trace: its operating point, all of it, and of lines a close-up of its peak."""
    time, length = point["time"].values, point["contact_length"].values
    speed = point["entrainment_speed"].item()
    crossing = 2.0 * point["contact_half_width"].item() / speed
    reach = round(CLOSE_UP * crossing / (time[1] - time[0]))
    peak = int(length.argmax())
    close = slice(max(peak - reach, 0), peak + reach + 1)
    at = {name: point[name].item() for name in CHOICES} | {MODEL: model}
    return {
        "at": {name: values.index(at[name]) for name, values in levels.items()},
        "share": float(np.mean(length > 0.0)),
        "crossing": crossing,
        "way": float(speed * (time[-1] + time[1])),
        "contacts": float(point["contacts"].mean()) if model == "surface" else None,
        "conducts": bool(point["contact_resistance"].notnull().any()),
        "whole": _thinned(point, slice(None)),
        "close": _thinned(point, close) if model == "line" else None,
    }


def _thinned(point, part):
    """Thin out a part of a trace: keep the extreme value of each group of neighbouring steps."""
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
    """Turn an array into nested lists, with None for NaN and infinity."""
    return to_jsonable_python(np.asarray(values).tolist(), inf_nan_mode="null")
