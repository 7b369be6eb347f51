"""What to measure next, as tables for the laboratory."""

import numpy as np
import xarray as xr

from lube.grid.operating_points import by_contact_model
from lube.report.key_tables import markdown_table
from lube.report.pages import count, percent
from lube.schema import POINT_DIMS
from lube.study.uncertainty import spoken

MOST = 5
"""Rows of each table."""
_NARROWER = (
    "The band is that of the assumptions, all choices of the model being open: narrower is the "
    "standard deviation of the logarithm of the probability, on average over the operating points. "
    "Where a quantity's index is not above that of the random numbers it counts as none."
)
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
    models = by_contact_model(found)
    several, parts = models.sizes["contact_model"] > 1, []
    for model in models["contact_model"].values:
        points = models.sel(contact_model=model).isel(lubricant=0).stack(point=POINT_DIMS[1:])
        once = points.sel(turns=1.0, method="nearest")
        parts += [f"**By contact of the {model}**"] if several else []
        parts += [_records(once.sel(quantity=name), name) for name in found["quantity"].values]
        parts.append(_durations(points))
    if "narrowing" in found:
        parts.append(_others(found.isel(lubricant=0).stack(point=POINT_DIMS[1:])))
    return "\n\n".join(parts)


def _records(of_quantity, name):
    """Tabulate the records that tell most about a quantity."""
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
    title = f"**{name.capitalize()}**: expected 95 % interval from one record of a revolution"
    if not rows:
        return f"{title}: none tells enough."
    return f"{title}\n\n{markdown_table([*_POINT, *columns], rows)}"


def _plus(width):
    return f"± {percent(width)}" if np.isfinite(width) else "no bound"


def _durations(points):
    """Tabulate the best interval of each quantity by the duration of the record."""
    least = points["half_width"].min("point").transpose("quantity", "turns")
    each = zip(least["quantity"].values, least.values, strict=True)
    rows = [(name, *map(_plus, widths)) for name, widths in each]
    durations = (count(turns, "revolution") for turns in least["turns"].values)
    threshold = points["best_threshold"].item()
    error = percent(points["reading_error"].median().item())
    way = f"below {threshold:g} Ω" if threshold > 0.0 else "from the mean voltage"
    said = f"Read the share {way}: the rig then misreads it by {error} (median)."
    table = markdown_table(["best interval by duration", *durations], rows)
    return f"{table}\n\n{said}"


def _others(points):
    """Tabulate which quantities to measure otherwise, and how well."""
    gain = points["narrowing"].mean("point")
    best = [one for one in np.argsort(-gain.values)[:MOST] if gain.values[one] > 0.0]
    if not best:
        return "No quantity narrows the band of the assumptions by more than the noise."
    names = map(spoken, gain["factor"].values[best])
    known = (points[f"{key}_of_factor"].values[best] for key in ("range", "accuracy"))
    rows = zip(names, *known, map(percent, gain.values[best]), strict=True)
    headings = "measure otherwise", "now uncertain by", "measured to", "narrows the band by"
    return f"{markdown_table(headings, rows)}\n\n{_NARROWER}"
