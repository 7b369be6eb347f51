"""What the schema says of a variable and of a kind of file, and short ways to say it."""

from dataclasses import dataclass, field

import numpy as np

LIMITS = ("", "_lower", "_upper")
"""What the names of a value and of the limits of its 95 % interval end with."""


@dataclass(frozen=True)
class Variable:
    """One variable or coordinate of a file.

    Attributes
    ----------
    dims : tuple of str
        Its dimensions, in order.
    units : str or None
        Unit in UDUNITS notation, ``"1"`` for a pure number or a flag, None for text.
    long_name : str
        What it is, in words fit for an axis.
    kind : str
        Allowed NumPy kinds: ``f`` float64, ``i`` integer, ``b`` true/false (stored as int8),
        ``U`` text.
    content : str
        What it is by ACDD's and ISO 19115-1's words for ``coverage_content_type``; ``record``
        stands for what the rig's records tell, measured or simulated.
    attributes : dict
        Further CF attributes.
    """

    dims: tuple
    units: str | None
    long_name: str
    kind: str = "f"
    content: str = "modelResult"
    attributes: dict = field(default_factory=dict)


@dataclass(frozen=True)
class FileKind:
    """One kind of file.

    Attributes
    ----------
    variables : dict
        From the name of each variable that must be there to its `Variable`.
    summary : str
        What is in it, in a sentence or two; empty for what only passes from job to job.
    attributes : tuple of str
        Global attributes that the stages read from it.
    """

    variables: dict
    summary: str = ""
    attributes: tuple = ()


def number(dims, units, long_name, **more):
    """Describe numbers."""
    return Variable(tuple(dims), units, long_name, **more)


def text(dims, long_name):
    """Describe texts."""
    return Variable(tuple(dims), None, long_name, kind="U", content="auxiliaryInformation")


def flag(dims, long_name, meanings, kind="b"):
    """Describe a variable of few whole values, each with its meaning."""
    attributes = {
        "flag_values": np.arange(len(meanings), dtype="int8"),
        "flag_meanings": " ".join(meanings),
    }
    return Variable(tuple(dims), "1", long_name, kind, "qualityInformation", attributes)


def limited(name, dims, units, long_name, value="", meaning="", **more):
    """Describe a value, whose name may end in `value`, and the limits of its 95 % interval."""
    return {
        name + value: number(dims, units, long_name + meaning, **more),
        **{
            name + limit: number(
                dims,
                units,
                f"{long_name}, {limit[1:]} limit of the 95 % interval",
                content="qualityInformation",
            )
            for limit in LIMITS[1:]
        },
    }


# What is a mean says over what, by CF's cell methods, which name a coordinate of the variable.
OVER_RUN = {"cell_methods": "revolutions: mean"}
OVER_ALL = {"cell_methods": "revolutions: mean (then over the realisations)"}
OVER_RECORD = {"cell_methods": "duration: mean"}
OVER_RECORDS = {"cell_methods": "duration: mean (then over the realisations)"}


def run_mean(dims, units, long_name, **attributes):
    """Describe a mean over the revolutions of a run."""
    return number(dims, units, long_name, attributes=OVER_RUN | attributes)
