"""Summary of a study for its report and archive, in Markdown: its numbers and its results."""

import math
import platform
from collections.abc import Mapping
from importlib.metadata import version

import numpy as np
import xarray as xr

from lube.grid import model_limits
from lube.grid.levels import rolling
from lube.grid.operating_points import by_contact_model
from lube.grid.plausibility import unusual
from lube.inference.surface_scatter import revolution_limits
from lube.report.pages import render
from lube.schema import LIMITS, MEAN_LIMITS, REGIMES, values_with_limits
from lube.storage.git import commit
from lube.storage.provenance import LIBRARIES
from lube.study.study import Study

_FREQUENT, _RARE = 0.1, 0.001
"""Shares of time above and below which contact is called frequent and rare."""
_VARIABLES = "force speed temperature slide_to_roll_ratio lubricant".split()
"""Operating variables that the summary states."""


def facts(study: Study, lubricant: xr.Dataset) -> str:
    """Summarise the values of a study.

    Parameters
    ----------
    study : Study
        The study.
    lubricant : xarray.Dataset
        Its dataset of this name.

    Returns
    -------
    str
        Markdown: a table of two columns.
    """
    ends = lubricant.isel(temperature=sorted({0, lubricant.sizes["temperature"] - 1}))
    points = math.prod(map(len, study.operating_grid.model_dump().values()))
    return render("facts.md", study=study, oils=ends, points=points, two_pi=2.0 * math.pi)


def made(study: Study) -> str:
    """Name the authors of a study, the code and the software that made it.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    str
        Markdown: a sentence.
    """
    libraries = [f"{name} {version(name)}" for name in ("lube", *LIBRARIES, "snakemake")]
    software = [*libraries, f"Python {platform.python_version()}"]
    return render("made.md", study=study, commit=commit(), software=software)


def findings(study: Study, results: Mapping[str, xr.Dataset]) -> str:
    """Summarise the results of a study.

    Parameters
    ----------
    study : Study
        The study.
    results : dict of str to xarray.Dataset
        Its datasets `lube.report.SUMMARISED`, by name, and ``sensitivity`` if it was made.

    Returns
    -------
    str
        Markdown: what was found, with the film formula that the study names first; tables of the
        means over each operating variable and of the points of the traces; the refused records.
    """
    film, comparison = map(results.get, ("film", "comparison"))
    first = {"film_formula": study.film_formulas[0]}
    of_first = film.sel(first)
    lines = results["contact"] if "line" in study.contact_model else None
    contacts = {model: _of_model(model, study, results) for model in study.contact_model}
    points = next(iter(contacts.values())).sel(first)["breakthrough_probability_mean"]
    return render(
        "findings.md",
        study=study,
        film=of_first,
        shortest=study.line_spec.shortest_wavelength,
        unusual=unusual(of_first, study.line_spec, study.rough_rollers, study.contact_model),
        **_film(film, first),
        contacts={model: _contact(each.sel(first)) for model, each in contacts.items()},
        trends={model: _trends(each.sel(first)) for model, each in contacts.items()},
        spread=None if lines is None else _spread(film, lines, first),
        held=_held(of_first, None if lines is None else lines.sel(first), points),
        deformed=_deformed(of_first, results.get("tail"), contacts),
        limits=model_limits,
        compared=_compared(comparison, results.get("gauge"), first) if comparison else [],
        traces=_traces(study, film, contacts, comparison),
        refused=_lines(results, "refused"),
        remarks=_lines(results, "remarks"),
    )


def _film(film, first):
    """Points by regime and outside validity ranges, and what the inlet does to the film."""
    invalid = ~film["in_validity_range"].astype(bool)
    starved = film.sel(first).get("starvation_factor")
    counts = np.bincount(film["regime"].values.ravel(), minlength=len(REGIMES)).tolist()
    names = [name.replace("_", " and ") for name in REGIMES]
    return {
        "regimes": {name: count for name, count in zip(names, counts, strict=True) if count},
        "outside": invalid.sum(set(invalid.dims) - {"film_formula"}).to_series().to_dict(),
        "heating": 1.0 - film["inlet_shear_heating_factor"].min().item(),
        "starving": 1.0 - starved.min().item() if starved is not None else None,
    }


def _contact(contact):
    """Where contact is frequent, where rare, and where none was seen."""
    mean, upper = (contact[f"breakthrough_probability_{name}"] for name in ("mean", "upper"))
    seen = mean > 0.0
    found = {
        "points": mean.size,
        "unknown": int(mean.isnull().sum()),
        "touched": int(seen.sum()),
        "frequent": int((mean > _FREQUENT).sum()),
        "rare": int((seen & (mean < _RARE)).sum()),
        "unseen": upper.where(~seen).max().item(),
    }
    if found["touched"]:
        found["alike"] = int((mean == mean.max()).sum())
        found["greatest"] = _values(contact.isel(mean.argmax(mean.dims)))
        found["least"] = _values(contact.isel(mean.where(seen).argmin(mean.dims)))
    return found


def _values(point):
    """Values of a dataset at one point, by their names."""
    return {name: one.item() for name, one in point.variables.items() if one.ndim == 0}


def _trends(contact):
    """Mean probability at each level of the operating variables that have several."""
    mean = contact["breakthrough_probability_mean"]
    several = [name for name in _VARIABLES if mean.sizes[name] > 1]
    return {name: mean.mean(set(mean.dims) - {name}).to_series().to_dict() for name in several}


def _spread(film, contact, first):
    """Differences between the formulas of the central film; None if there is one at most."""
    central = film["film_formula"].values[film["formula_place"].values == "central"]
    if central.size < 2:
        return None
    films = film["film_thickness"].sel(film_formula=central)
    valid = films.where(film["in_validity_range"].sel(film_formula=central).astype(bool))
    mean = contact["breakthrough_probability_mean"]
    most = mean.sel(first, drop=True).fillna(0.0)  # not known where the film is not
    there = mean.isel(most.argmax(most.dims)).sel(film_formula=central)
    return {
        "formulas": central.size,
        "film": _largest_excess(films),
        "valid": _largest_excess(valid),
        "probability": there,
    }


def _of_model(model, study, results):
    """Probabilities by one contact model, with the band of the assumptions if it was made."""
    contact = {"line": _of_lines, "surface": _of_surfaces}[model](results)
    if "sensitivity" in results:
        contact = _assumed(contact, model, study, results["sensitivity"])
    return contact


def _of_lines(results):
    """Probabilities of lines, and the scatter between pairs if there are several."""
    contact = results["contact"]
    pairs = contact["breakthrough_probability"]
    deviation = pairs.std("realisation", ddof=1) if len(pairs) > 1 else pairs[0] * math.nan
    means = contact[[f"breakthrough_probability{end}" for end in MEAN_LIMITS]]
    of_pair = {f"pair{end}": contact[f"breakthrough_probability_pair{end}"] for end in LIMITS[1:]}
    return means.assign(of_pair | {"pair_deviation": deviation})


def _of_surfaces(results):
    """Probabilities of surfaces, named as the means over realisations of lines are."""
    tail = results["tail"].sel(contact_model="surface")
    limits = (tail[f"breakthrough_probability{end}"] for end in LIMITS)
    found = values_with_limits("breakthrough_probability", limits, names=MEAN_LIMITS)
    rolls = tail["slide_to_roll_ratio"] == 0.0
    found["pair_deviation"] = tail["surface_pair_deviation"].where(rolls)
    found |= zip(("pair_lower", "pair_upper"), revolution_limits(tail), strict=True)
    return xr.Dataset(found)


def _assumed(contact, model, study, sensitivity):
    """Add the band of the assumptions: nearest to pure rolling, and of the first contact model."""
    slips = contact["slide_to_roll_ratio"]
    known = slips == rolling(slips.values)
    known &= model == study.contact_model[0] or "contact_model" in sensitivity["factor"].values
    band = {end: sensitivity[f"breakthrough_probability{end}"] for end in LIMITS[1:]}
    return contact.assign({f"assumed{end}": limit.where(known) for end, limit in band.items()})


def _deformed(film, tail, models):
    """Count the points where the oil changes the roughness by too large a part of the film."""
    surfaces = {"line": None, "surface": tail}
    return {model: int(model_limits.deformed(film, surfaces[model]).sum()) for model in models}


def _held(film, contact, points):
    """Load on the asperities, and the numbers of points where the model does not hold.

    Like `points` of contact, they are counted at each slip.
    """
    found = {"share": math.nan, "overloaded": 0, "merged": 0, "separated": 0}
    if contact is not None:
        touched = contact["breakthrough_probability_mean"] > 0.0
        found = {
            "share": contact["contact_load_share"].mean("realisation").max().item(),
            "overloaded": int(model_limits.overloaded(contact).sum()),
            "merged": int(model_limits.merged(contact, film).sum()),
            "separated": int((model_limits.separated(film) & touched).sum()),
        }
    parts = {"rubbing": model_limits.LARGEST_SHARE, "overrubbing": 1.0}
    rubs = (model_limits.rubbing(film, part).broadcast_like(points) for part in parts.values())
    return found | {name: int(flags.sum()) for name, flags in zip(parts, rubs, strict=True)}


def _largest_excess(films):
    """Largest difference of two formulas at one point, relative to the smaller film."""
    return (films.max("film_formula") / films.min("film_formula") - 1.0).max().item()


def _compared(comparison, gauge, first):
    """Agreement between simulation and rig, and the films gauged, for each contact model."""
    rows = []
    for model in by_contact_model(comparison)["contact_model"].values:
        chosen = first | {"contact_model": model}
        at = chosen | {"threshold": comparison["comparison_threshold"].item()}
        gauged = _gauged(_at(gauge, chosen)) if gauge else None
        rows.append(_values(_at(comparison, at)) | {"gauged": gauged})
    return rows


def _gauged(gauge):
    """Count the records with both limits of their film, or one; and fits of the coefficient."""
    lower, upper = (gauge[f"gauged_film_thickness_{end}"].values for end in ("lower", "upper"))
    fits = zip(*(gauge[f"alpha_factor{what}"].values for what in ("", "_explained")), strict=True)
    return {
        "fits": list(zip(gauge["fitted_lubricant"].values, fits, strict=True)),
        "records": upper.size,
        "closed": int((np.isfinite(upper) & (lower > 0.0)).sum()),
        "thicker": int(np.isposinf(upper).sum()),
        "thinner": int((lower == 0.0).sum()),
    }


def _at(variable, point):
    """Select a point along those of its coordinates that are dimensions of the values."""
    return variable.sel({name: level for name, level in point.items() if name in variable.dims})


def _traces(study, film, contacts, comparison):
    """Values at each operating point with a trace, by each contact model."""
    # A simulated rig may run with lines.
    compared = study.contact_model if study.compares_surfaces else ("line",)
    traces = []
    for point in study.trace_points:
        near = _measured_near(comparison, point) if comparison else np.array([])
        for model, contact in contacts.items():
            values = _values(_at(film, point)) | _values(contact.sel(point))
            shares = near if model in compared else near[:0]
            traces.append({"model": model, **values, "shares": shares})
    return traces


def _measured_near(comparison, point):
    """Finite contact shares of the records near an operating point."""
    names = {name: f"{name}_level" for name in ("force", "speed", "temperature")}
    names |= {name: name for name in ("lubricant", "slide_to_roll_ratio")}
    near = [comparison[name].values == point[level] for level, name in names.items()]
    shares = comparison["measured_share"].values[np.all(near, axis=0)]
    return shares[np.isfinite(shares)]


def _lines(results, attribute):
    """Lines about records, from the experiment and the comparison."""
    made = [results[kind] for kind in ("experiment", "comparison") if kind in results]
    return [line for one in made for line in one.attrs.get(attribute, "").splitlines()]
