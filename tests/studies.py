"""The paper's study, and its content with values exchanged or removed."""

import copy
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "workflow" / "config"
PAPER = CONFIG / "paper.yaml"
SMOKE = CONFIG / "smoke.yaml"
PAPER_CONTENT = yaml.safe_load(PAPER.read_text(encoding="utf-8"))
OIL = "mobilgear-shc-xmp-320"
REMOVED = object()


def with_value(content, key, value):
    """A copy of a study's content with the value of one dotted key exchanged, or removed."""
    content = copy.deepcopy(content)
    *path, last = [int(part) if part.isdigit() else part for part in key.split(".")]
    place = content
    for part in path:
        place = place[part]
    if value is REMOVED:
        del place[last]
    else:
        place[last] = value
    return content
