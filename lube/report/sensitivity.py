"""What the probability of a study rests on, as a table of the report."""

import numpy as np
import xarray as xr

from lube.grid.operating_points import by_contact_model
from lube.report.key_tables import markdown_table
from lube.report.pages import percent, rounded
from lube.schema import POINT_DIMS
from lube.sensitivity.findings import LEFT, above_noise, narrowing
from lube.sensitivity.samples import SEED
from lube.study.uncertainty import CHOICES, spoken

_BANDS = {
    "mean": "within the interval of the mean over pairs of rollers",
    "pair": "within the band of one pair only",
    "assumptions": "within that of the assumptions only",
    "none": "in none of the bands",
    "": "not judged, as a film or a band is not known",
}
_PLACES = 0.9, 0.5, 0.1
"""Places of the operating points shown, in the order of their probability."""
_MEASURED = (
    f"Of the quantities, this is the one of which a measurement that leaves {percent(LEFT)} of its "
    "variance would lessen the standard deviation of the logarithm of the probability most, all "
    "choices of the model being open:"
)
_UNITS = {"force": "N", "speed": "r/min", "temperature": "°C"}
_WORDS = """
## What this does to the probability

By what the probability of breakthrough is multiplied, or divided, as each quantity goes through its
range, or a choice is made otherwise: means over random values of all others, at three operating
points (`sensitivity.nc`). Deviations are from the study's values. A dash is for what is not told
from the effect of the random numbers.
"""


def rests_on(found: xr.Dataset, records: xr.Dataset | None = None) -> str:
    """Tabulate what each factor does to the probability.

    Parameters
    ----------
    found : xarray.Dataset
        A ``sensitivity`` dataset.
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
    places = (np.array(_PLACES) * (order.size - 1)).round().astype(int)
    shown = points.isel(point=order[places]).reset_index("point")
    factors = [name for name in shown["factor"].values.tolist() if name != SEED]
    strength = shown["elementary_effect"].sel(factor=factors).mean("point")
    conditions = [
        ", ".join(f"{one[name].item():.4g} {unit}" for name, unit in _UNITS.items())
        for one in (points.isel(point=order[place]) for place in places)
    ]
    rows, is_told = [], above_noise(shown, "elementary_effect")
    for name in strength["factor"].values[np.argsort(-strength.values)]:
        one = shown.sel(factor=name)
        effects = np.exp(one["elementary_effect"].where(is_told.sel(factor=name)).values)
        changes = ["–" if np.isnan(each) else f"{rounded(each):g}" for each in effects]
        words = (one[f"{key}_of_factor"].item() for key in ("range", "source"))
        rows.append((spoken(name), *words, *changes))
    ends = (shown[f"breakthrough_probability_{end}"].values for end in ("lower", "upper"))
    band = (f"{rounded(low):g} to {rounded(high):g}" for low, high in zip(*ends, strict=True))
    rows.append(("probability, 5 to 95 % of the samples", "", "", *band))
    table = markdown_table(("uncertain", "range or choices", "source", *conditions), rows)
    measured = _to_measure(shown, factors, conditions)
    return "\n\n".join([f"{_WORDS}\n{table}", measured, *_explained(records)]) + "\n"


def _explained(records):
    """Say how many records each band explains, by each contact model."""
    if records is None:
        return
    origin, is_exact = records["origin"].item(), records["measured_share_lower"].isnull()
    for model, of_model in by_contact_model(records)["band_needed"].groupby("contact_model"):
        counts = ((words, np.sum(of_model.values == name)) for name, words in _BANDS.items())
        said = "; ".join(f"{number} {words}" for words, number in counts if number)
        by = f"Of {of_model.size} {origin} records by contact of the {model}"
        yield f"{by}: {said} (`record_bands.nc`)."
    if is_exact.any():
        yield f"{is_exact.sum().item()} of them have no interval: they are taken as exact."


def _to_measure(shown, factors, conditions):
    """Say which quantity, if it were measured well, would narrow the band most."""
    measurable = [name for name in factors if name not in CHOICES]
    if not measurable:
        return ""
    gains = narrowing(shown, measurable).transpose("point", "factor").values
    said = [
        f"the {spoken(measurable[gain.argmax()])} at {where}, by {percent(gain.max())}"
        for gain, where in zip(gains, conditions, strict=True)
        if gain.max() > 0.0
    ]
    return f"{_MEASURED} {'; '.join(said)}." if said else ""
