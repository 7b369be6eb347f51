"""JSON Schemas of the files that people write, by which editors complete and check them.

They follow from the models and lie in ``lube/study/json``, for editors and ``lube schema``.
``python docs/tools/editor_schemas.py`` writes them; a test compares them with the models.
"""

import json
from typing import Any

from pydantic import BaseModel
from written_forms import with_form

from lube.errors import RecordError
from lube.recordings.manifest import Row
from lube.storage.git import ROOT
from lube.study.lubricant_record import SHIPPED_FOLDER, LubricantRecord
from lube.study.resolve import resolved_content
from lube.study.schema_files import KINDS, schema_file
from lube.study.study import Study
from lube.study.text_files import read_yaml

_DIALECT = "http://json-schema.org/draft-07/schema#"  # the one that all editors know
_BASED_ON = {
    "type": "string",
    "description": "path of another study, from this file's folder; this one then holds only what "
    "differs, and a new name",
    "examples": ["paper.yaml"],
}


def editor_schema(kind: str) -> dict[str, Any]:
    """Make the JSON Schema of a kind of file.

    Parameters
    ----------
    kind : str
        ``study``, ``lubricant`` or ``manifest``.

    Returns
    -------
    dict
        JSON Schema, draft 7, without references. Examples are values of the shipped files.
    """
    match kind:
        case "study":
            content = _study_schema()
        case "lubricant":
            content = _plain_schema(LubricantRecord)
            for path in sorted(SHIPPED_FOLDER.glob("*.yaml"), reverse=True):
                _give_examples(content, read_yaml(path, RecordError))
        case _:
            content = {"type": "array", "items": _row_schema()}
    return {"$schema": _DIALECT, "title": f"A {kind} of lube", **content}


def _study_schema():
    """Require all keys of a whole study; of one with `based_on` its name alone."""
    whole = _plain_schema(Study)
    _give_examples(whole, resolved_content(ROOT / "workflow/config/paper.yaml"))
    whole["properties"] = {"based_on": _BASED_ON | {"type": ["string", "null"]}} | whole[
        "properties"
    ]
    changes = _nothing_required(whole) | {"required": ["based_on", "name"]}
    is_based = {"properties": {"based_on": {"type": "string"}}, "required": ["based_on"]}
    return {"type": "object", "if": is_based, "then": changes, "else": whole}


def _row_schema():
    """Allow decimal commas and empty cells in a row of a manifest."""
    row = _plain_schema(Row)
    text = json.dumps(row).replace(r"\\.", "[.,]").replace(r"[\\d.]", r"[\\d.,]")
    row = json.loads(text.replace(r"[\\d._eE+-]", r"[\\d.,_eE+-]"))
    for name, field in row["properties"].items():
        if name not in row["required"] and "null" not in field.get("type", []):
            row["properties"][name] = _or_null(field)
    return row | {"anyOf": [{"required": ["file"]}, {"required": ["probability"]}]}


def _plain_schema(model: type[BaseModel]):
    schema = model.model_json_schema()
    return _simplified(schema, schema.pop("$defs", {}))


def _simplified(schema, definitions):
    """Put definitions in place of references, and what is needed, in words, in place of titles."""
    if "$ref" in schema:
        schema = definitions[schema["$ref"].split("/")[-1]] | schema
    schema = with_form(schema)
    schema = {key: value for key, value in schema.items() if key not in ("$ref", "title")}
    if "default" in schema and schema["default"] in (None, {}):
        del schema["default"]
    if "description" in schema:
        schema["description"] = " ".join(schema["description"].split())
    if "format" in schema:
        schema = {"title": schema.pop("format")} | schema
    if "properties" in schema:
        inner = schema["properties"].items()
        schema["properties"] = {name: _simplified(one, definitions) for name, one in inner}
    if "items" in schema:
        schema["items"] = _simplified(schema["items"], definitions)
    if "anyOf" in schema:
        choices = [_simplified(one, definitions) for one in schema.pop("anyOf")]
        if choices[1:] == [{"type": "null"}]:
            return _or_null(choices[0] | schema)
        schema["anyOf"] = choices
    return schema


def _or_null(schema):
    """Allow null besides; one type with two names is reported better than a choice of two."""
    if "anyOf" in schema:
        return schema | {"anyOf": [*schema["anyOf"], {"type": "null"}]}
    if "enum" in schema:
        schema = schema | {"enum": [*schema["enum"], None]}
    types = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
    return schema | {"type": [*types, "null"]}


def _nothing_required(schema):
    """Copy a schema for changes: mappings are merged key by key, lists are replaced."""
    if "properties" not in schema:
        return schema
    inner = schema["properties"].items()
    kept = {key: value for key, value in schema.items() if key != "required"}
    return kept | {"properties": {name: _nothing_required(one) for name, one in inner}}


def _give_examples(schema, content):
    """Give the values of a shipped file as examples."""
    for name, value in content.items():
        inner = schema["properties"][name]
        if "properties" in inner:
            _give_examples(inner, value)
        elif isinstance(value, list) and isinstance(value[0], dict):
            _give_examples(inner["items"], value[0])
        else:
            inner["examples"] = [value]


def written(kind: str) -> str:
    """Text of the file of a JSON Schema."""
    return json.dumps(editor_schema(kind), indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    for name in KINDS:
        schema_file(name).write_text(written(name), encoding="utf-8")
