"""Table of effects in ``docs/assumptions.md``, from the results of the paper's study.

``python docs/tools/assumptions_page.py results/paper/sensitivity.nc`` writes it; a test compares
its rows with the ranges in the study.
"""

import re
import sys
from pathlib import Path

from lube.report.sensitivity import rests_on
from lube.storage.netcdf import load
from lube.study.study import load_study

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/assumptions.md"


def with_effects(text, study, found):
    """Write what the assumptions of a study do between the markers of the page."""
    parts = r"(<!-- effects -->\n).*?(?=<!-- end -->)"
    return re.sub(parts, lambda match: match[1] + rests_on(study, found), text, flags=re.DOTALL)


if __name__ == "__main__":
    study = load_study(ROOT / "workflow/config/paper.yaml")
    found = load(sys.argv[1], "sensitivity")
    PAGE.write_text(with_effects(PAGE.read_text(encoding="utf-8"), study, found), encoding="utf-8")
