"""Tables of the documentation that follow from results of the paper's study.

``python docs/tools/result_tables.py results/paper/sensitivity.nc`` writes the table of effects in
``docs/assumptions.md``, and ``python docs/tools/result_tables.py results/paper/verification.nc``
that of the checks in ``docs/verification.md``. A test compares the effects with the ranges in the
study; a slow one compares the checks with the results.
"""

import re
import sys
from pathlib import Path

from lube.report.sensitivity import rests_on
from lube.report.verification import outcomes
from lube.storage.git import ROOT
from lube.storage.netcdf import load
from lube.study.study import load_study

PLACES = {"sensitivity": ("assumptions", "effects"), "verification": ("verification", "checks")}
"""Page of the table of each dataset, and the marker above it."""


def table(kind, found):
    """Write what the assumptions of the paper's study do, or the outcomes of its checks."""
    if kind == "verification":
        return f"{outcomes(found)}\n"
    return rests_on(load_study(ROOT / "workflow/config/paper.yaml"), found)


def with_table(text, marker, rows):
    """Write a table between its markers on a page."""
    parts = rf"(?<=<!-- {marker} -->\n).*?(?=<!-- end -->)"
    return re.sub(parts, lambda _: rows, text, flags=re.DOTALL)


if __name__ == "__main__":
    for path in map(Path, sys.argv[1:]):
        name, marker = PLACES[path.stem]
        page, rows = ROOT / f"docs/{name}.md", table(path.stem, load(path, path.stem))
        page.write_text(with_table(page.read_text("utf-8"), marker, rows), "utf-8")
