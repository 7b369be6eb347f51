"""Table of the page ``docs/verification.md``, from the results of the paper's study.

``python docs/tools/verification_page.py results/paper/verification.nc`` writes it; a slow test
compares the two.
"""

import re
import sys
from pathlib import Path

from lube.report.verification import outcomes
from lube.storage.netcdf import load

PAGE = Path(__file__).parents[1] / "verification.md"


def with_checks(text, found):
    """Write the outcomes of a ``verification`` dataset between the markers of the page."""
    parts = r"(<!-- checks -->\n).*?(?=<!-- end -->)"
    return re.sub(parts, lambda match: f"{match[1]}{outcomes(found)}\n", text, flags=re.DOTALL)


if __name__ == "__main__":
    found = load(sys.argv[1], "verification")
    PAGE.write_text(with_checks(PAGE.read_text(encoding="utf-8"), found), encoding="utf-8")
