"""Summary of a study on the report's start page: its numbers and its results."""

import math
import platform
from importlib.metadata import version

import numpy as np
import xarray as xr

from lube.report.pages import render
from lube.storage.git import commit
from lube.storage.provenance import LIBRARIES
from lube.study.study import Study

_AGREEMENT = (
    *("bias", "rms_difference", "overlap_share", "compared_records", "pairs", "origin"),
    *("overlap_share_expected_lower", "overlap_share_expected_upper"),
)
"""Measures of agreement between simulation and rig that the start page states."""
_LIMITS = ("mean", "lower", "upper")


def facts(study: Study) -> str:
    """Summarise the configuration of a study.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    str
        HTML: a table of two columns.
    """
    libraries = [f"{name} {version(name)}" for name in ("lube", *LIBRARIES, "snakemake")]
    return render(
        "facts.html",
        study=study,
        points=math.prod(len(levels) for levels in study.operating_grid.model_dump().values()),
        shortest=2.0 * math.pi / study.line_spec.q_max,
        longest=2.0 * math.pi / study.line_spec.q_min,
        commit=commit(),
        software=[*libraries, f"Python {platform.python_version()}"],
    )


def findings(study: Study, film: xr.Dataset, contact: xr.Dataset, comparison: xr.Dataset) -> str:
    """Summarise the results of a study.

    Parameters
    ----------
    study : Study
        The study.
    film, contact, comparison : xarray.Dataset
        Its datasets of these names.

    Returns
    -------
    str
        HTML: sentences, and a table of the operating points that the study names for its traces.
    """
    chosen = {
        "lubricant": study.lubricants[0].name,
        "film_formula": study.film_formulas[0],
        "slide_to_roll_ratio": study.rig_slip,
    }
    mean = contact["breakthrough_probability_mean"].sel(chosen)
    greatest = mean.isel(mean.argmax(mean.dims))
    inside = _at(film["in_validity_range"], chosen).values.astype(bool)
    return render(
        "findings.html",
        lubricant=study.lubricants[0].title,
        film_formula=study.film_formulas[0],
        slip=study.rig_slip,
        points=mean.size,
        touched=int((mean > 0.0).sum()),
        greatest=greatest.item(),
        greatest_at={name: float(greatest[name]) for name in mean.dims},
        outside=int((~inside).sum()),
        film_points=inside.size,
        agreement=_agreement(comparison, chosen),
        traces=[_trace(point, film, contact, comparison) for point in study.trace_points],
    )


def notes(experiment: xr.Dataset, comparison: xr.Dataset) -> str:
    """List the refused records, and the remarks on the others.

    Parameters
    ----------
    experiment, comparison : xarray.Dataset
        The study's datasets of these names.

    Returns
    -------
    str
        HTML: a list under each heading; empty if there is nothing to list.
    """
    lists = {
        "Records that were refused, and are in no result": experiment.attrs["refused"].splitlines(),
        "Remarks on records": [
            *experiment.attrs["remarks"].splitlines(),
            *comparison.attrs["remarks"].splitlines(),
        ],
    }
    return render("notes.html", lists=lists)


def _at(variable, point):
    """Select a point along those of its coordinates that are dimensions of the variable."""
    return variable.sel({name: level for name, level in point.items() if name in variable.dims})


def _agreement(comparison, chosen):
    """Measures of agreement between simulation and rig; None if there is no record."""
    chosen = chosen | {"threshold": comparison["comparison_threshold"].item()}
    measures = {name: _at(comparison[name], chosen).item() for name in _AGREEMENT}
    return measures if math.isfinite(measures["bias"]) else None


def _trace(point, film, contact, comparison):
    """Values at one operating point."""
    shares = _measured_near(comparison, point)
    probability = {limit: contact[f"breakthrough_probability_{limit}"] for limit in _LIMITS}
    return {
        **point,
        **{limit: values.sel(point).item() for limit, values in probability.items()},
        "film": _at(film["film_thickness"], point).item(),
        "lambda_ratio": _at(film["lambda_ratio"], point).item(),
        "records": shares.size,
        "shares": [shares.min(), shares.max()] if shares.size else [],
    }


def _measured_near(comparison, point):
    """Finite contact shares of the records near an operating point."""
    names = {name: f"{name}_level" for name in ("force", "speed", "temperature")}
    names |= {name: name for name in ("lubricant", "slide_to_roll_ratio")}
    near = np.logical_and.reduce(
        [comparison[name].values == point[level] for level, name in names.items()]
    )
    shares = comparison["measured_share"].values[near]
    return shares[np.isfinite(shares)]
