"""The configuration of a study for the report: as written, and with all values filled in."""

import re
from typing import Any

from lube.report.key_tables import keys
from lube.report.pages import render
from lube.storage.provenance import single_values
from lube.study.lubricant_record import LubricantRecord
from lube.study.study import Study
from lube.units import with_unit


def configuration(study: Study, text: str) -> str:
    """Show the configuration as written and as understood, and what each stage depends on.

    Parameters
    ----------
    study : Study
        The study.
    text : str
        Its YAML file, as written.

    Returns
    -------
    str
        HTML.
    """
    content = study.model_dump(mode="json", by_alias=True)
    stages = {
        stage: [(key, _in_si(value)) for key, value in single_values(inputs) if value is not None]
        for stage in study.datasets
        if (inputs := study.stage_inputs(stage))  # the other stages follow from these
    }
    return render(
        "configuration.html",
        written=[_without_comment(line) for line in text.rstrip("\n").split("\n")],
        study=list(_values(content, keys(Study))),
        lubricants=[
            (record.title, list(_values(values, keys(LubricantRecord))))
            for record, values in zip(study.lubricants, content["lubricants"], strict=True)
        ],
        stages=stages,
    )


def _without_comment(line):
    """Split a line of YAML before its comment."""
    match = re.search(r"(?:^|(?<=\s))#", line)
    return (line[: match.start()], line[match.start() :]) if match else (line, "")


def _values(content, keys):
    """Rows (key, value, meaning) of the keys that are set."""
    for key, kind, meaning in keys:
        unit = re.match(r"(?:quantity|values and units) in ([^\s,]+)", kind)
        value = _printed(at_key(content, key.strip("`")), unit[1] if unit else "")
        if value:
            yield key, value, meaning


def at_key(content: Any, key: str) -> Any:
    """Value at a dotted key; a list of values where the key goes through a list."""
    name, _, rest = key.partition(".")
    if not name or content is None:
        return content
    if name.endswith("[]"):
        return [at_key(one, rest) for one in content[name.removesuffix("[]")] or ()]
    return at_key(content[name], rest)


def _printed(value, unit):
    if isinstance(value, list):
        return ", ".join(filter(None, (_printed(one, unit) for one in value)))
    if isinstance(value, dict):  # a lubricant record, which has a table of its own
        return value["name"]
    if isinstance(value, float):
        return with_unit(value, unit)
    return "" if value is None else str(value)


def _in_si(value):
    if isinstance(value, list):
        return ", ".join(map(_in_si, value))
    return f"{value:.9g}" if isinstance(value, float) else str(value)
