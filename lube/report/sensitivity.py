"""What the probability of a study rests on, as a table of the report."""

from collections import Counter

import numpy as np
import xarray as xr

from lube.grid.operating_points import by_contact_model
from lube.physics.pressure_viscosity import FORMULA_DEFINITION
from lube.report.pages import percent, render
from lube.schema import POINT_DIMS
from lube.sensitivity.findings import LEFT, above_noise, narrowing
from lube.sensitivity.samples import SEED
from lube.study.oil_properties import lubricant_table
from lube.study.study import Study
from lube.study.uncertainty import CHOICES, UNITS, spoken
from lube.units import with_unit

_PLACES = 0.9, 0.5, 0.1
"""Places of the operating points shown, in the order of their probability."""
_LEVELS = {"force": "N", "speed": "rpm", "temperature": "degC"}
_AT_ENDS = *_LEVELS, "viscosity", "pressure_viscosity_coefficient"
"""Quantities that are given at the ends of the operating grid."""


def rests_on(study: Study, found: xr.Dataset, records: xr.Dataset | None = None) -> str:
    """Tabulate what each factor is taken as, and what it does to the probability.

    Parameters
    ----------
    study : Study
        The study.
    found : xarray.Dataset
        Its ``sensitivity`` dataset.
    records : xarray.Dataset, optional
        A ``record_bands`` dataset, if there are records.

    Returns
    -------
    str
        Markdown: a section with a table, for the first lubricant; nothing if no film is known.
    """
    points = found.isel(lubricant=0).stack(point=POINT_DIMS[1:])
    known = np.flatnonzero(points["elementary_effect"].notnull().all("factor"))
    if known.size == 0:
        return ""
    points = points.isel(point=known)
    order = np.argsort(points["breakthrough_probability_median"].values)
    places = np.unique((np.array(_PLACES) * (order.size - 1)).round().astype(int))[::-1]
    shown = points.isel(point=order[places]).reset_index("point")
    factors = [name for name in shown["factor"].values.tolist() if name != SEED]
    strength = shown["elementary_effect"].sel(factor=factors).mean("point")
    conditions = [
        ", ".join(with_unit(one[name].item(), unit, 4) for name, unit in _LEVELS.items())
        for one in (points.isel(point=order[place]) for place in places)
    ]
    effects = np.exp(shown["elementary_effect"].where(above_noise(shown, "elementary_effect")))
    ordered = strength["factor"].values[np.argsort(-strength.values)]
    parts = {"shown": shown.assign(effect=effects).sel(factor=ordered), "conditions": conditions}
    parts |= {"left": LEFT, "gains": [*_gains(shown, factors, conditions)]}
    parts |= {"records": records, "explained": _explained(records)}
    return render("sensitivity.md", study=study, taken=values_taken(study), **parts)


def values_taken(study: Study) -> dict[str, str]:
    """Say which value each quantity and choice of the section ``uncertainty`` has in a study.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    dict of str to str
        By the name of the factor; the properties of oils are those of the first lubricant at the
        lowest and the highest temperature.
    """
    ends = {name: np.array(getattr(study.operating_grid, name))[[0, -1]] for name in _LEVELS}
    oil = lubricant_table(study.lubricants[:1], np.unique(ends["temperature"])).isel(lubricant=0)
    rms = study.line_spec.rms_height
    numbers = ends | {"rms_roughness": rms, "first_rms_roughness": rms[:1]}
    numbers |= {"second_rms_roughness": rms[1:], "viscosity": oil["kinematic_viscosity"].values}
    numbers["pressure_viscosity_coefficient"] = oil["pressure_viscosity_coefficient"].values
    parts = *study.line_spec.lines, study.rollers.first, study.rollers.second, study.boundary_layer
    numbers["resistivity"] = [study.resistivity] if study.conducts else []
    own = {"film_formula": study.film_formulas[0], "contact_model": ", ".join(study.contact_model)}
    own["pressure_viscosity_definition"] = FORMULA_DEFINITION
    words = {name: own.get(name) or getattr(study, name) for name in CHOICES}
    for name, unit in UNITS.items():
        values = numbers.get(name, [getattr(one, name) for one in parts if hasattr(one, name)])
        each = [with_unit(one, unit, 3) for one in values if one is not None]
        words[name] = (" to " if name in _AT_ENDS else " and ").join(dict.fromkeys(each))
    return words


def _explained(records):
    """Count the records that each band explains, by each contact model."""
    models = by_contact_model(records)["band_needed"].groupby("contact_model") if records else ()
    return {model: Counter(needed.values.ravel().tolist()) for model, needed in models}


def _gains(shown, factors, conditions):
    """Say which quantity, if it were measured well, would narrow the band most at each point."""
    measurable = [name for name in factors if name not in CHOICES]
    if not measurable:
        return
    gains = narrowing(shown, measurable).transpose("point", "factor").values
    for gain, where in zip(gains, conditions, strict=True):
        if gain.max() > 0.0:
            yield f"at {where} the {spoken(measurable[gain.argmax()])}, by {percent(gain.max())}"
