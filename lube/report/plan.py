"""What to measure next, as tables for the laboratory."""

import numpy as np
import xarray as xr

from lube.grid.operating_points import by_contact_model
from lube.report.key_tables import markdown_table
from lube.report.pages import count, percent, render
from lube.schema import POINT_DIMS
from lube.study.uncertainty import spoken

MOST = 5
"""Rows of each table."""
_POINT = ("force [N]", "speed [r/min]", "temperature [°C]", "expected contact share")


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
    """Tables by one contact model."""
    once = points.sel(turns=1.0, method="nearest")
    records = {name: _records(once.sel(quantity=name)) for name in once["quantity"].values}
    return {"points": points, "records": records, "durations": _durations(points)}


def _records(of_quantity):
    """Tabulate the records that tell most about a quantity; nothing if none tells enough."""
    keys = {"one pair": "half_width", "other quantities uncertain": "half_width_assumed"}
    columns = {words: of_quantity[key].values for words, key in keys.items() if key in of_quantity}
    widths = columns["one pair"]
    order = [one for one in np.argsort(np.nan_to_num(widths, nan=np.inf)) if widths[one] < np.inf]
    rows = []
    for place in order[:MOST]:
        one = of_quantity.isel(point=place)
        temperature, speed, force = one["point"].item()
        share = percent(one["breakthrough_probability"].item())
        row = [f"{force:g}", f"{speed:.4g}", f"{temperature:g}", share]
        rows.append(row + [_plus(values[place]) for values in columns.values()])
    return markdown_table([*_POINT, *columns], rows) if rows else ""


def _plus(width):
    return f"± {percent(width)}" if np.isfinite(width) else "no bound"


def _durations(points):
    """Tabulate the best interval of each quantity by the duration of the record."""
    least = points["half_width"].min("point").transpose("quantity", "turns")
    each = zip(least["quantity"].values, least.values, strict=True)
    rows = [(name, *map(_plus, widths)) for name, widths in each]
    durations = (count(turns, "revolution") for turns in least["turns"].values)
    return markdown_table(["best interval by duration", *durations], rows)


def _others(points):
    """Tabulate which quantities to measure otherwise, and how well; nothing if there is none."""
    gain = points["narrowing"].mean("point")
    best = [one for one in np.argsort(-gain.values)[:MOST] if gain.values[one] > 0.0]
    names = map(spoken, gain["factor"].values[best])
    known = (points[f"{key}_of_factor"].values[best] for key in ("range", "accuracy"))
    rows = zip(names, *known, map(percent, gain.values[best]), strict=True)
    headings = "measure otherwise", "now uncertain by", "measured to", "narrows the band by"
    return markdown_table(headings, rows) if best else ""
