"""Tables of the keys that people write, and of a study's files, for the report."""

from collections.abc import Iterable, Sequence

from pydantic import BaseModel

from lube.schema import DATASETS, SUMMARIES


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table.

    Parameters
    ----------
    head : sequence of str
        Names of the columns.
    rows : iterable of sequence of str
        Their cells, row by row.

    Returns
    -------
    str
        Markdown.

    Examples
    --------
    >>> print(markdown_table(["key", "value"], [["name", "text"]]))
    | key | value |
    | --- | --- |
    | name | text |
    """
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def files_table(datasets: Iterable[str] = DATASETS) -> str:
    """Write the table of a study's files, by default of all, with their content, as Markdown."""
    rows = [(f"`{kind}.nc`", SUMMARIES[kind]) for kind in datasets]
    return markdown_table(("file", "content"), rows)


def keys(model: type[BaseModel]) -> list[tuple[str, str, str]]:
    """List all keys of a kind of file, nested ones with dots.

    Parameters
    ----------
    model : type
        Model of its content, such as `lube.study.study.Study`.

    Returns
    -------
    list of tuple of str
        Dotted key between backticks; allowed value; meaning.
    """
    schema = model.model_json_schema()
    return _keys(schema, schema.get("$defs", {}))


def _keys(schema, definitions, path="", section=""):
    """Keys of a model, or of the section of it that `path` leads to; a remark if it is optional."""
    rows = []
    for name, field in schema["properties"].items():
        inner, many = _resolve(field, definitions)
        required = name in schema.get("required", [])
        if "properties" in inner and "format" not in inner:
            optional = "" if required else " (section optional)"
            key = f"{path}{name}{'[]' if many else ''}."
            rows += _keys(inner, definitions, key, section or optional)
        else:
            value = _value(field, inner) + (section if required else _default(field))
            meaning = field.get("description", inner.get("description", ""))
            rows.append((f"`{path}{name}`", value, " ".join(meaning.split())))
    return rows


def _resolve(field, definitions):
    """Follow references, optional fields and lists to the innermost field; and whether a list."""
    many = False
    while "format" not in field:  # it says in words what is needed
        if "$ref" in field:
            field = definitions[field["$ref"].split("/")[-1]]
        elif "anyOf" in field:
            field = next(choice for choice in field["anyOf"] if choice.get("type") != "null")
        elif field.get("type") == "array" and isinstance(field.get("items"), dict):
            field, many = field["items"], True
        else:
            break
    return field, many


def _value(field, inner):
    is_list = field.get("type") == "array" and inner is not field
    if "enum" in inner and "format" not in inner:
        choices = [f"`{choice}`" for choice in inner["enum"]]
        return f"list of {' and '.join(choices)}" if is_list else " or ".join(choices)
    value = inner.get("format") or {"integer": "whole number", "string": "text"}[inner["type"]]
    return f"list of {value}s" if is_list else value


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
