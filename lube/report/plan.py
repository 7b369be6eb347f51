"""What to measure next, as tables for the laboratory."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from lube.grid.operating_points import by_contact_model
from lube.report.pages import render
from lube.schema import POINT_DIMS

MOST = 5
"""Rows of each table."""


def tables(found: xr.Dataset, doubts: Mapping[str, Mapping] | None = None) -> str:
    """Tabulate the best records of each quantity, durations, and other measurements.

    Parameters
    ----------
    found : xarray.Dataset
        A ``plan`` dataset.
    doubts : dict, optional
        From the name of a contact model to its `lube.grid.model_limits.doubts` of the first
        lubricant, by temperature, speed and force in this order. The tables then name them.

    Returns
    -------
    str
        Markdown, for the first lubricant and each contact model.
    """
    points = found.isel(lubricant=0).stack(point=POINT_DIMS[1:])
    models = by_contact_model(points)
    names = models["contact_model"].values
    parts = [_part(models.sel(contact_model=name), (doubts or {}).get(name, {})) for name in names]
    others = _others(points) if "narrowing" in found else None
    return render("plan.md", parts=parts, others=others).strip()


def _part(points, doubts):
    """Best records of each quantity and least intervals by duration, by one contact model."""
    numbers, rows = range(points.sizes["point"]), doubts.items()
    doubt = [", ".join(words for words, (_, where) in rows if where[one]) for one in numbers]
    points = points.assign(doubt=("point", doubt))
    once = points.sel(turns=1.0, method="nearest")
    records = {name: _best(once.sel(quantity=name)) for name in once["quantity"].values}
    least = points["half_width"].min("point").transpose("quantity", "turns")
    is_useful = np.isfinite(once["half_width"]).any("quantity")
    typical_error = points["reading_error"].where(is_useful).median().item()
    return {"points": points, "records": records, "least": least, "typical_error": typical_error}


def _best(of_quantity):
    """Return the records that tell most about a quantity, the best first."""
    known = of_quantity.isel(point=np.isfinite(of_quantity["half_width"].values))
    return known.sortby("half_width").isel(point=slice(MOST))


def _others(points):
    """Return the quantities to measure otherwise, with the gain of each, the best first."""
    gain = points["narrowing"].mean("point")
    best = [one for one in np.argsort(-gain.values)[:MOST] if gain.values[one] > 0.0]
    return points.assign(gain=gain).isel(factor=best)
