"""What to measure next, as tables for the laboratory."""

import numpy as np
import xarray as xr

from lube.grid.operating_points import by_contact_model
from lube.report.pages import render
from lube.schema import POINT_DIMS

MOST = 5
"""Rows of each table."""


def tables(found: xr.Dataset) -> str:
    """Tabulate the best records of each quantity, durations, and other measurements.

    Parameters
    ----------
    found : xarray.Dataset
        A ``plan`` dataset.

    Returns
    -------
    str
        Markdown, for the first lubricant and each contact model.
    """
    points = found.isel(lubricant=0).stack(point=POINT_DIMS[1:])
    models = by_contact_model(points)
    parts = [_part(models.sel(contact_model=model)) for model in models["contact_model"].values]
    others = _others(points) if "narrowing" in found else None
    return render("plan.md", parts=parts, others=others).strip()


def _part(points):
    """Best records of each quantity and least intervals by duration, by one contact model."""
    once = points.sel(turns=1.0, method="nearest")
    records = {name: _best(once.sel(quantity=name)) for name in once["quantity"].values}
    least = points["half_width"].min("point").transpose("quantity", "turns")
    return {"points": points, "records": records, "least": least}


def _best(of_quantity):
    """Return the records that tell most about a quantity, the best first."""
    known = of_quantity.isel(point=np.isfinite(of_quantity["half_width"].values))
    return known.sortby("half_width").isel(point=slice(MOST))


def _others(points):
    """Return the quantities to measure otherwise, with the gain of each, the best first."""
    gain = points["narrowing"].mean("point")
    best = [one for one in np.argsort(-gain.values)[:MOST] if gain.values[one] > 0.0]
    return points.assign(gain=gain).isel(factor=best)
