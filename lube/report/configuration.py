"""The configuration of a study for the report: as written, and with all values filled in."""

import re
from collections.abc import Iterator

from lube.report.key_tables import record_keys, study_keys
from lube.report.pages import render
from lube.schema import DATASETS
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
    content = study.model_dump(mode="json")
    stages = {stage: list(_stage_values(study.stage_inputs(stage))) for stage in DATASETS}
    return render(
        "configuration.html",
        written=[_without_comment(line) for line in text.rstrip("\n").split("\n")],
        study=list(_values(content, study_keys())),
        lubricants=[
            (record.title, list(_values(values, record_keys())))
            for record, values in zip(study.lubricants, content["lubricants"], strict=True)
        ],
        # The other stages follow from these.
        stages={stage: rows for stage, rows in stages.items() if rows},
    )


def _without_comment(line):
    """Split a line of YAML before its comment."""
    match = re.search(r"(?:^|(?<=\s))#", line)
    return (line[: match.start()], line[match.start() :]) if match else (line, "")


def _values(content, keys):
    """Rows (key, value, meaning) of the keys that are set."""
    for key, kind, meaning in keys:
        value = _printed(_at_key(content, key.strip("`").split(".")), _unit(kind))
        if value:
            yield key, value, meaning


def _unit(kind):
    match = re.match(r"(?:quantity|values and units) in ([^\s,]+)", kind)
    return match[1] if match else ""


def _at_key(content, path):
    """Value at a dotted key; a list of values where the key goes through a list."""
    for number, name in enumerate(path):
        if content is None:
            return None
        if name.endswith("[]"):
            rest = path[number + 1 :]
            return [_at_key(one, rest) for one in content[name.removesuffix("[]")] or ()]
        content = content[name]
    return content


def _printed(value, unit):
    if isinstance(value, list):
        return ", ".join(filter(None, (_printed(one, unit) for one in value)))
    if isinstance(value, dict):  # a lubricant record, which has a table of its own
        return value["name"]
    if isinstance(value, float):
        return with_unit(value, unit)
    return "" if value is None else str(value)


def _stage_values(values) -> Iterator[tuple[str, str]]:
    return ((key, _in_si(value)) for key, value in _flat(values) if value is not None)


def _flat(value, path=""):
    """Each plain value, or list of plain values, with its dotted key."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flat(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and any(isinstance(one, dict) for one in value):
        for number, inner in enumerate(value):
            yield from _flat(inner, f"{path}[{number}]")
    else:
        yield path, value


def _in_si(value):
    if isinstance(value, list):
        return ", ".join(map(_in_si, value))
    return f"{value:.9g}" if isinstance(value, float) else str(value)
