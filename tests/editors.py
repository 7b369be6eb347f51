"""What an editor says of a YAML file, by the JSON Schemas of the package."""

import functools
import json

from jsonschema import Draft7Validator

from lube.study.schema_files import schema_file


@functools.cache
def validator(kind):
    schema = json.loads(schema_file(kind).read_text(encoding="utf-8"))
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


def complaints(kind, content):
    """Keys at which an editor marks a mistake."""
    found = validator(kind).iter_errors(content)
    return sorted(".".join(map(str, error.absolute_path)) for error in found)


def check_schema(kind, content):
    assert not complaints(kind, content), content
