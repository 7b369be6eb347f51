"""Tables of the documentation that follow from the code: files, variables, keys, film formulas.

``python docs/tools/generated_tables.py docs/*.md`` rewrites them between their markers; a test
compares the documentation with the code.
"""

import re
import sys
from pathlib import Path

from lube.ehl.film_formulas import FORMULAS, TOLERANCE
from lube.recordings.manifest import Row
from lube.report.key_tables import files_table, keys, markdown_table
from lube.schema import COORDINATES, DATASETS, FILES, ON_REQUEST, SUMMARIES
from lube.study.lubricant_record import LubricantRecord
from lube.study.study import Study

TABLES = ("files", "coordinates", "variables", "study", "record", "manifest", "formulas")
"""Names of the tables, as in the markers of the documentation."""


def table(name):
    """Markdown of a table, one of `TABLES`.

    They are the datasets; the coordinates that several of them share; the variables of all datasets
    and benchmarks, each under a heading; the keys of a study, of a lubricant record and of a list
    of measured records; the film formulas.
    """
    match name:
        case "files":
            return files_table()
        case "coordinates":
            return _variables(COORDINATES)
        case "variables":
            return "\n\n".join(
                f"### `{kind}.nc`\n\n{SUMMARIES[kind]}\n\n{_variables(FILES[kind])}"
                for kind in (*DATASETS, *ON_REQUEST)
            )
        case "study":
            return markdown_table(("key", "value", "meaning"), keys(Study))
        case "record":
            return markdown_table(("key", "value", "meaning"), keys(LubricantRecord))
        case "manifest":
            return markdown_table(("column or key", "value", "meaning"), keys(Row))
        case "formulas":
            found = FORMULAS.values()
            rows = [(f"`{row.name}`", row.thickness, row.source, row.validity) for row in found]
            within = f"within {100.0 * TOLERANCE:g} % of the computed film for"
            return markdown_table(("name", "film", "source", within), rows)


def with_tables(text):
    """Rewrite the tables between ``<!-- table: NAME -->`` and ``<!-- end -->`` of a page."""
    return re.sub(
        r"(<!-- table: (\w+) -->\n).*?(?=<!-- end -->)",
        lambda match: f"{match[1]}{table(match[2])}\n",
        text,
        flags=re.DOTALL,
    )


def _dimensions(variable):
    """Names of the dimensions, in brackets those of some studies only."""
    dims = variable.all_dims
    return ", ".join(dim if dim in variable.dims else f"({dim})" for dim in dims)


def _variables(variables):
    rows = [
        (f"`{name}`", _dimensions(one), one.units or "text", one.long_name)
        for name, one in variables.items()
    ]
    return markdown_table(("name", "dimensions", "unit", "meaning"), rows)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        page = Path(name)
        page.write_text(with_tables(page.read_text(encoding="utf-8")), encoding="utf-8")
