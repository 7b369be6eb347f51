"""The configuration of a study as the report shows it: as written, and as it was understood."""

import re
from html import escape

from lube.report.key_tables import record_keys, study_keys
from lube.report.markdown import inline
from lube.report.pages import html_table
from lube.units import with_unit

STAGES = ("lubricant", "film", "roughness", "contact", "master", "trace", "rig", "experiment")
"""Stages that take values of the study; the others follow from these alone."""


def configuration(study, text):
    """Show the configuration as written, and as it was understood.

    Parameters
    ----------
    study : lube.study.study.Study
        The study.
    text : str
        Its file, as written.

    Returns
    -------
    str
        HTML.
    """
    content = study.model_dump(mode="json")
    parts = ["<h2>As written</h2>", f'<pre class="file">{_with_comments_marked(text)}</pre>']
    parts += ["<h2>As understood</h2>", "<p>Every value that is set, defaults filled in.</p>"]
    parts += [_values(content, study_keys())]
    for record, values in zip(study.lubricants, content["lubricants"], strict=True):
        parts += [f"<h3>Lubricant: {escape(record.title)}</h3>", _values(values, record_keys())]
    parts += ["<h2>What each stage was given</h2>",
              "<p>In SI units; speeds in r/min, temperatures in °C. A change of one of these makes "
              "the stage anew, and what follows from it.</p>"]  # fmt: skip
    parts += [_stage(stage, study.stage_inputs(stage)) for stage in STAGES]
    return "\n".join(parts)


def _with_comments_marked(text):
    """YAML with its comments in a span, for the style."""
    comment = re.compile(r"(^|\s)(#.*)$", re.MULTILINE)
    marked = comment.sub(r'\1<span class="comment">\2</span>', escape(text, quote=False))
    return marked.rstrip("\n")


def _values(content, keys):
    rows = []
    for key, kind, meaning in keys:
        told = _told(_found(content, key.strip("`").split(".")), _unit(kind))
        if told:
            rows.append((inline(key), escape(told), inline(meaning)))
    return html_table(("key", "value", "meaning"), rows, kind="keys")


def _unit(kind):
    match = re.match(r"(?:quantity|values and units) in ([^\s,]+)", kind)
    return match[1] if match else ""


def _found(content, path):
    """Value behind a key with dots; a list of them where the key goes through a list."""
    for number, name in enumerate(path):
        if content is None:
            return None
        if name.endswith("[]"):
            rest = path[number + 1 :]
            return [_found(one, rest) for one in content[name.removesuffix("[]")] or ()]
        content = content[name]
    return content


def _told(value, unit):
    if isinstance(value, list):
        return ", ".join(filter(None, (_told(one, unit) for one in value)))
    if isinstance(value, dict):
        return value["name"]
    if value is None:
        return ""
    if isinstance(value, float):
        return with_unit(value, unit)
    return str(value)


def _stage(stage, values):
    rows = [
        (f"<code>{escape(key)}</code>", escape(_in_short(value)))
        for key, value in _flat(values)
        if value is not None
    ]
    table = html_table(("key", "value"), rows, kind="keys")
    return f"<details><summary>{escape(stage)}</summary>\n{table}\n</details>"


def _flat(value, path=""):
    """All values behind a nested one, with their keys; only lists of plain values stay lists."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flat(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and any(isinstance(one, dict) for one in value):
        for number, inner in enumerate(value):
            yield from _flat(inner, f"{path}[{number}]")
    else:
        yield path, value


def _in_short(value):
    if isinstance(value, list):
        return ", ".join(map(_in_short, value))
    return f"{value:.9g}" if isinstance(value, float) else str(value)
