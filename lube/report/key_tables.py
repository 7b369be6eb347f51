"""Tables of the documentation that follow from the code: files, variables, keys, film formulas.

``docs/tools/generated_tables.py`` rewrites them between their markers; a test compares the
documentation with the code.
"""

from lube.ehl.film_formulas import FORMULAS, TOLERANCE
from lube.recordings.manifest import manifest_schema
from lube.schema import COORDINATES, DATASETS, FILES, ON_REQUEST, SUMMARIES
from lube.study.lubricant_record import LubricantRecord
from lube.study.study import Study

TABLES = ("files", "coordinates", "variables", "study", "record", "manifest", "formulas")
"""Names of the tables, as in the markers of the documentation."""


def table(name: str) -> str:
    """Write a table of the documentation.

    Parameters
    ----------
    name : str
        One of `TABLES`: the datasets; the coordinates that several of them share; the variables
        of all datasets and benchmarks, each under a heading; the keys of a study, of a lubricant
        record, and of a list of measured records; the film formulas.

    Returns
    -------
    str
        Markdown.
    """
    match name:
        case "files":
            rows = [(f"`{kind}.nc`", SUMMARIES[kind]) for kind in DATASETS]
            return _table(("file", "content"), rows)
        case "coordinates":
            return _variables(COORDINATES)
        case "variables":
            return "\n\n".join(
                f"### `{kind}.nc`\n\n{SUMMARIES[kind]}\n\n{_variables(FILES[kind])}"
                for kind in (*DATASETS, *ON_REQUEST)
            )
        case "study":
            return _table(("key", "value", "meaning"), study_keys())
        case "record":
            return _table(("key", "value", "meaning"), record_keys())
        case "manifest":
            return _table(("column or key", "value", "meaning"), _keys(manifest_schema()))
        case "formulas":
            found = FORMULAS.values()
            rows = [(f"`{row.name}`", row.thickness, row.source, row.validity) for row in found]
            within = f"within {100.0 * TOLERANCE:g} % of the computed film for"
            return _table(("name", "film", "source", within), rows)


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


def _table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _dimensions(variable):
    """Names of the dimensions, in brackets those of some studies only."""
    dims = variable.all_dims
    return ", ".join(dim if dim in variable.dims else f"({dim})" for dim in dims)


def _variables(variables):
    rows = [
        (f"`{name}`", _dimensions(one), one.units or "text", one.long_name)
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
        if "properties" in inner and "format" not in inner:
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
        if "format" in field:  # says in words what is needed
            return field, many
        if "$ref" in field:
            field = definitions[field["$ref"].split("/")[-1]]
        elif "anyOf" in field:
            field = next(choice for choice in field["anyOf"] if choice.get("type") != "null")
        elif field.get("type") == "array" and isinstance(field.get("items"), dict):
            field, many = field["items"], True
        else:
            return field, many


def _value(field, inner):
    if "enum" in inner and "format" not in inner:
        return " or ".join(f"`{choice}`" for choice in inner["enum"])
    value = inner.get("format") or {"integer": "whole number", "string": "text"}[inner["type"]]
    return f"list of {value}s" if field.get("type") == "array" and inner is not field else value


def _default(field):
    """Say that a key is optional, with its default if that is short."""
    match default := field.get("default"):
        case {"values": values, "units": units}:
            default = f"{', '.join(map(str, values))} {units}"
        case list():
            default = ", ".join(default)
        case float():
            default = f"{default:g}"
    # A summary of several lines would fill the table.
    shown = default not in (None, "") and len(str(default)) <= 60
    return f" (by default {default})" if shown else " (optional)"
