"""Tables of the README that follow from the code: files, keys, columns of a manifest, formulas.

``python -m lube.report.key_tables README.md`` writes them anew between their markers; a test
holds the README to them.
"""

import re
import sys
from pathlib import Path

from lube.physics.film_formulas import FORMULAS, TOLERANCE
from lube.recordings.manifest import manifest_schema
from lube.schema import MEASURED, SUMMARIES
from lube.study.lubricant_record import LubricantRecord
from lube.study.study import Study


def study_table():
    """Table of the keys of a study, from its schema.

    Returns
    -------
    str
        Markdown.
    """
    return _table(("key", "value", "meaning"), study_keys())


def record_table():
    """Table of the keys of a lubricant record, from its schema.

    Returns
    -------
    str
        Markdown.
    """
    return _table(("key", "value", "meaning"), record_keys())


def manifest_table():
    """Table of the columns, or keys, of a manifest, from its schema.

    Returns
    -------
    str
        Markdown.
    """
    return _table(("column or key", "value", "meaning"), _keys(manifest_schema()))


def formula_table():
    """Table of the film formulas, from their registry.

    Returns
    -------
    str
        Markdown.
    """
    rows = [(f"`{row.name}`", row.thickness, row.source, row.validity) for row in FORMULAS.values()]
    held = f"within {100.0 * TOLERANCE:g} % of the computed film for"
    return _table(("name", "film", "source", held), rows)


def file_table():
    """Table of the datasets, from the schema.

    Returns
    -------
    str
        Markdown.
    """
    rows = [
        (f"`{kind}.nc`", summary) for kind, summary in SUMMARIES.items() if kind not in MEASURED
    ]
    return _table(("file", "what is in it"), rows)


def study_keys():
    """Keys of a study, from its schema.

    Returns
    -------
    list of tuple of str
        Key with dots, between backticks; what may stand there; meaning.
    """
    return _keys(Study.model_json_schema(), skip="lubricants")


def record_keys():
    """Keys of a lubricant record, from its schema.

    Returns
    -------
    list of tuple of str
        As of `study_keys`.
    """
    return _keys(LubricantRecord.model_json_schema())


TABLES = {
    "files": file_table,
    "study": study_table,
    "record": record_table,
    "manifest": manifest_table,
    "formulas": formula_table,
}


def with_tables(text):
    """Fill the tables into a text that holds their markers.

    Parameters
    ----------
    text : str
        With pairs of lines ``<!-- table: NAME -->`` and ``<!-- end -->``.

    Returns
    -------
    str
        The text with the present tables between the markers.
    """

    def fill(match):
        return f"{match[1]}\n{TABLES[match[2]]()}\n<!-- end -->"

    return re.sub(r"(<!-- table: (\w+) -->)\n.*?<!-- end -->", fill, text, flags=re.DOTALL)


def _table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)


def _keys(schema, path="", definitions=None, skip=None, section=""):
    """Rows (key, value, meaning) of all keys below a schema, nested ones with dots."""
    definitions = definitions or schema.get("$defs", {})
    rows = []
    for name, field in schema["properties"].items():
        inner, many = _resolve(field, definitions)
        key = f"{path}{name}{'[]' if many else ''}"
        if "properties" in inner and name != skip:
            optional = "" if name in schema.get("required", []) else " (section optional)"
            rows += _keys(inner, f"{key}.", definitions, section=section or optional)
        else:
            meaning = field.get("description", inner.get("description", ""))
            value = "list of names or paths" if name == skip else _value(field, inner)
            optional = section if name in schema.get("required", []) else _by_default(field)
            rows.append((f"`{path}{name}`", value + optional, meaning))
    return rows


_LONGEST = 60  # letters of a default that is told


def _by_default(field):
    """Say that a key may be left out, and what then stands for it."""
    default = field.get("default")
    if isinstance(default, list):
        default = ", ".join(default) or None
    if isinstance(default, float):
        default = f"{default:g}"
    if default is None or len(str(default)) > _LONGEST:
        return " (optional)"
    if isinstance(default, dict):
        default = f"{', '.join(str(value) for value in default['values'])} {default['units']}"
    return f" (by default {default})"


def _resolve(field, definitions):
    """Follow references and look through optional fields and lists to what they hold."""
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
    """Say what may stand there."""
    if "enum" in inner:
        return " or ".join(f"`{choice}`" for choice in inner["enum"])
    words = {"integer": "whole number", "string": "text"}
    value = inner.get("format") or words[inner["type"]]
    return f"list of {value}s" if field.get("type") == "array" else value


if __name__ == "__main__":
    page = Path(sys.argv[1])
    page.write_text(with_tables(page.read_text(encoding="utf-8")), encoding="utf-8")
