"""How the schema describes a variable and a kind of file, with short constructors."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

LIMITS = ("", "_lower", "_upper")
"""Suffixes of the variables that hold an estimate and the limits of its 95 % interval."""


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
        ACDD's ``coverage_content_type``, a term of ISO 19115-1; ``record`` stands for what
        follows from the records, which are measurements or model results.
    attributes : dict
        Further CF attributes.
    """

    dims: tuple[str, ...]
    units: str | None
    long_name: str
    kind: str = "f"
    content: str = "modelResult"
    attributes: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class FileKind:
    """One kind of file.

    Attributes
    ----------
    variables : dict
        From the name of each required variable to its `Variable`.
    summary : str
        What the file contains, in a sentence or two; empty for files that are deleted at the
        end of a run.
    attributes : tuple of str
        Required global attributes.
    """

    variables: dict[str, Variable]
    summary: str = ""
    attributes: tuple[str, ...] = ()


def number(
    dims: Iterable[str],
    units: str,
    long_name: str,
    kind: str = "f",
    content: str = "modelResult",
    **attributes: Any,
) -> Variable:
    """Describe numbers."""
    return Variable(tuple(dims), units, long_name, kind, content, attributes)


count = partial(number, kind="i")
quality = partial(number, content="qualityInformation")
recorded = partial(number, content="record")

# CF cell methods of means; each names the coordinate that is averaged over.
MEAN_OF_RUN = "revolutions: mean"
MEAN_OF_RECORD = "duration: mean"
THEN_REALISATIONS = "(then over the realisations)"
run_mean = partial(number, cell_methods=MEAN_OF_RUN)


def text(dims: Iterable[str], long_name: str) -> Variable:
    """Describe texts."""
    return Variable(tuple(dims), None, long_name, "U", "auxiliaryInformation")


def flag(dims: Iterable[str], long_name: str, meanings: Sequence[str], kind: str = "b") -> Variable:
    """Describe a variable with few integer values, each with a meaning."""
    return number(
        dims,
        "1",
        long_name,
        kind,
        "qualityInformation",
        flag_values=np.arange(len(meanings), dtype="int8"),
        flag_meanings=" ".join(meanings),
    )


def sides(
    dims: Iterable[str], units: str, long_name: str, stem: str, interval: str = "95 % interval"
) -> dict[str, Variable]:
    """Describe the limits of an interval, ``<stem>_lower`` and ``<stem>_upper``."""
    return {
        f"{stem}_{side}": quality(dims, units, f"{long_name}, {side} limit of the {interval}")
        for side in ("lower", "upper")
    }


def with_limits(
    name: str, dims: Iterable[str], units: str, long_name: str, **more: Any
) -> dict[str, Variable]:
    """Describe an estimate and the limits of its 95 % interval."""
    estimate = number(dims, units, long_name, **more)
    return {name: estimate, **sides(dims, units, long_name, name)}
