"""Outcomes of a study's checks, as a table."""

import xarray as xr

from lube.report.pages import render
from lube.verification.check import KINDS


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
    of = found["check_kind"].values
    kinds = {words: found.isel(check=of == kind) for kind, words in KINDS.items()}
    return render("verification.md", kinds=kinds).strip()
