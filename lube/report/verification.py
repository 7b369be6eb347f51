"""Outcomes of a study's checks, as a table."""

import xarray as xr

from lube.report.key_tables import markdown_table
from lube.verification.check import KINDS

_HEADINGS = "", "computed", "compared with", "deviation", "passes up to", "source"
_NUMBERS = "check_deviation", "check_allowed"


def outcomes(found: xr.Dataset) -> str:
    """Tabulate the checks of a study, by their kind.

    Parameters
    ----------
    found : xarray.Dataset
        A ``verification`` dataset.

    Returns
    -------
    str
        Markdown.
    """
    parts = []
    for kind, words in KINDS.items():
        some = found.isel(check=found["check_kind"].values == kind)
        rows = [_row(some.sel(check=number)) for number in some["check"].values]
        if rows:
            parts.append(f"**{words}**\n\n{markdown_table(_HEADINGS, rows)}")
    return "\n\n".join(parts)


def _row(one):
    unit = one["check_unit"].item()
    is_judged = one["check_allowed"].notnull().item()
    texts = (one[f"check_{name}"].item() for name in ("subject", "against"))
    deviation, allowed = (f"{one[name].item():.2g} {unit}" for name in _NUMBERS)
    failed = " (**differs**)" if one["check_outcome"].item() == "differs" else ""
    number, source = f"{one['check'].item()}", one["check_source"].item()
    return number, *texts, deviation + failed, allowed if is_judged else "", source
