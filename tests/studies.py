"""The paper's study and the smoke study: their content, with values exchanged or removed."""

import copy
from pathlib import Path

from lube.study.resolve import resolved_content
from lube.study.study import load_study

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "workflow" / "config"
PAPER = CONFIG / "paper.yaml"
SMOKE = CONFIG / "smoke.yaml"
PAPER_CONTENT = resolved_content(PAPER)
SMOKE_CONTENT = resolved_content(SMOKE)
SMOKE_DATASETS = load_study(SMOKE).datasets
OIL = "mobilgear-shc-xmp-320"
REMOVED = object()


def with_value(content, key, value):
    """A copy of a study's content with the value of one dotted key exchanged, or removed."""
    content = copy.deepcopy(content)
    *path, last = [int(part) if part.isdigit() else part for part in key.split(".")]
    section = content
    for part in path:
        section = section.setdefault(part, {}) if isinstance(section, dict) else section[part]
    if value is REMOVED:
        del section[last]
    else:
        section[last] = value
    return content
