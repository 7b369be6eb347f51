"""Tables of the documentation that follow from the code: files, variables, keys, film formulas.

``python -m lube.report.key_tables docs/*.md`` rewrites them between their markers; a test
compares the documentation with the code.
"""

import re
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from lube.physics.film_formulas import FORMULAS, TOLERANCE
from lube.recordings.manifest import manifest_schema
from lube.schema import COORDINATES, DATASETS, FILES, MEASURED, SUMMARIES
from lube.study.lubricant_record import LubricantRecord
from lube.study.study import Study


def file_table() -> str:
    """Table of the datasets.

    Returns
    -------
    str
        Markdown.
    """
    rows = [(f"`{kind}.nc`", SUMMARIES[kind]) for kind in DATASETS]
    return _table(("file", "content"), rows)


def coordinate_table() -> str:
    """Table of the coordinates that several files share.

    Returns
    -------
    str
        Markdown.
    """
    return _variables(COORDINATES)


def variable_tables() -> str:
    """Tables of the variables of all datasets and benchmarks, each under a heading.

    Returns
    -------
    str
        Markdown.
    """
    return "\n\n".join(
        f"### `{kind}.nc`\n\n{SUMMARIES[kind]}\n\n{_variables(FILES[kind])}"
        for kind in (*DATASETS, *MEASURED)
    )


def formula_table() -> str:
    """Table of the film formulas.

    Returns
    -------
    str
        Markdown.
    """
    rows = [(f"`{row.name}`", row.thickness, row.source, row.validity) for row in FORMULAS.values()]
    range_ = f"within {100.0 * TOLERANCE:g} % of the computed film for"
    return _table(("name", "film", "source", range_), rows)


def study_table() -> str:
    """Table of the keys of a study.

    Returns
    -------
    str
        Markdown.
    """
    return _table(("key", "value", "meaning"), study_keys())


def record_table() -> str:
    """Table of the keys of a lubricant record.

    Returns
    -------
    str
        Markdown.
    """
    return _table(("key", "value", "meaning"), record_keys())


def manifest_table() -> str:
    """Table of the columns, or keys, of a list of measured records.

    Returns
    -------
    str
        Markdown.
    """
    return _table(("column or key", "value", "meaning"), _keys(manifest_schema()))


def study_keys() -> list[tuple[str, str, str]]:
    """Keys of a study.

    Returns
    -------
    list of tuple of str
        Dotted key between backticks; allowed value; meaning.
    """
    return _keys(Study.model_json_schema())


def record_keys() -> list[tuple[str, str, str]]:
    """Keys of a lubricant record.

    Returns
    -------
    list of tuple of str
        As of `study_keys`.
    """
    return _keys(LubricantRecord.model_json_schema())


TABLES = {
    "files": file_table,
    "coordinates": coordinate_table,
    "variables": variable_tables,
    "study": study_table,
    "record": record_table,
    "manifest": manifest_table,
    "formulas": formula_table,
}
"""Functions that write the tables, by the names in the markers."""


def with_tables(text: str) -> str:
    """Rewrite the tables of a text.

    Parameters
    ----------
    text : str
        Markdown with pairs of lines ``<!-- table: NAME -->`` and ``<!-- end -->``.

    Returns
    -------
    str
        The text with the present tables between the markers.
    """
    return re.sub(
        r"(<!-- table: (\w+) -->\n).*?(?=<!-- end -->)",
        lambda match: f"{match[1]}{TABLES[match[2]]()}\n",
        text,
        flags=re.DOTALL,
    )


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _variables(variables):
    rows = [
        (f"`{name}`", ", ".join(one.dims), one.units or "text", one.long_name)
        for name, one in variables.items()
    ]
    return _table(("name", "dimensions", "unit", "meaning"), rows)


def _keys(schema, path="", definitions=None, section=""):
    """Rows (key, value, meaning) of all keys below a schema, nested ones with dots."""
    definitions = definitions or schema.get("$defs", {})
    rows = []
    for name, field in schema["properties"].items():
        inner, many = _resolve(field, definitions)
        required = name in schema.get("required", [])
        if name == "lubricants":  # records have a table of their own
            rows.append((f"`{path}{name}`", "list of names or paths", field["description"]))
        elif "properties" in inner:
            optional = "" if required else " (section optional)"
            key = f"{path}{name}{'[]' if many else ''}."
            rows += _keys(inner, key, definitions, section or optional)
        else:
            value = _value(field, inner) + (section if required else _default(field))
            meaning = field.get("description", inner.get("description", ""))
            rows.append((f"`{path}{name}`", value, meaning))
    return rows


def _resolve(field, definitions):
    """Follow references, optional fields and lists to the innermost field; and whether a list."""
    many = False
    while True:
        if "$ref" in field:
            field = definitions[field["$ref"].split("/")[-1]]
        elif "anyOf" in field:
            field = next(choice for choice in field["anyOf"] if choice.get("type") != "null")
        elif field.get("type") == "array" and isinstance(field.get("items"), dict):
            field, many = field["items"], True
        else:
            return field, many


def _value(field, inner):
    if "enum" in inner:
        return " or ".join(f"`{choice}`" for choice in inner["enum"])
    value = inner.get("format") or {"integer": "whole number", "string": "text"}[inner["type"]]
    return f"list of {value}s" if field.get("type") == "array" else value


def _default(field):
    """Say that a key is optional, with its default if that is short."""
    default = field.get("default")
    if isinstance(default, dict):
        default = f"{', '.join(map(str, default['values']))} {default['units']}"
    elif isinstance(default, list):
        default = ", ".join(default)
    elif isinstance(default, float):
        default = f"{default:g}"
    # A summary of several lines would fill the table.
    shown = default not in (None, "") and len(str(default)) <= 60
    return f" (by default {default})" if shown else " (optional)"


if __name__ == "__main__":
    for name in sys.argv[1:]:
        page = Path(name)
        page.write_text(with_tables(page.read_text(encoding="utf-8")), encoding="utf-8")
