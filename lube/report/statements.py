"""Statements of the documentation on the paper's study, reduced to those that hold for another.

A section of the documentation under the heading ``In the paper's study`` is about its values.
"""

import re

from lube.report.configuration import at_key
from lube.study.study import Study

_HEADING = "## In the paper's study\n"
_EFFECTS = "<!-- effects -->\n"


def limits_of(study: Study, paper: Study, text: str) -> str:
    """Reduce the limits to those that hold for a study.

    Parameters
    ----------
    study, paper : Study
        The study, and that of the paper.
    text : str
        ``docs/limits.md``.

    Returns
    -------
    str
        The text; without the numbers of the paper's study if the study's probabilities follow from
        other values.
    """
    same = study.origin("contact") == paper.origin("contact")
    return text if same else text.partition(_HEADING)[0].rstrip()


def assumptions_of(study: Study, paper: Study, text: str) -> str:
    """Reduce the assumptions to those of a study.

    Parameters
    ----------
    study, paper : Study
        The study, and that of the paper.
    text : str
        ``docs/assumptions.md``. The last column of the table below the heading names the keys of a
        study that a line is about.

    Returns
    -------
    str
        The text, with those lines whose values the study shares with the paper's, and without
        what they do to the probability of the paper's study.
    """
    text = text.partition(_EFFECTS)[0]
    general, _, table = text.partition(_HEADING)
    values = [one.model_dump(mode="json", by_alias=True) for one in (study, paper)]

    def shared(row):
        keys = re.findall(r"`([\w.]+)`", row.rpartition(" | ")[2])
        if not study.has("experiment") and keys[0].startswith(("experiment", "rig")):
            return False
        return all(at_key(values[0], key) == at_key(values[1], key) for key in keys)

    *head, body = table.strip().split("\n", 2)
    rows = body.split("\n")
    kept = [row for row in rows if shared(row)]
    if kept == rows:
        return text
    section = ["## The same as in the paper's study", "", *head, *kept] if kept else []
    return "\n".join([general, *section])
