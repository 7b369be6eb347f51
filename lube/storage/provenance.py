"""Provenance: what a result was computed from, stored in its file for checks years later.

Every file states the values of the study that determine it, the SHA-256 sums of the files it was
made from, and the code and libraries that made it. It holds no clock time: the same study gives
the same bytes.
"""

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from lube.errors import DataError, shown
from lube.schema import SUMMARIES
from lube.storage.git import commit
from lube.study.metadata import LICENCES, PAPER
from lube.types import File, Files

if TYPE_CHECKING:
    from lube.study.study import Study

CONVENTIONS = "CF-1.11, ACDD-1.3"
LIBRARIES = ("numpy", "scipy", "numba", "CoolProp", "xarray", "netCDF4")
"""Libraries whose version may change the numbers, or the bytes that hold them."""
SHORT = 10
"""Digits of a fingerprint where people read it."""
REMEDY = "; delete it and run snakemake again"
"""End of a message about a result that does not belong to the study: what to do."""
_OF_RECORDS = "experiment", "comparison", "gauge", "areal_gauge", "record_bands"
"""Stages whose files have values of the records."""


def global_attributes(study: "Study", kind: str, inputs: Files = ()) -> dict[str, Any]:
    """Global attributes of a file, by the names of CF and ACDD where they have one.

    Parameters
    ----------
    study : Study
        The study.
    kind : str
        A key of `lube.schema.FILES`.
    inputs : iterable of str or Path, optional
        Files that it was made from.

    Returns
    -------
    dict
        From attribute to value.
    """
    config = config_text(study, kind)
    sums = fingerprints(inputs)
    made_from = ", ".join(sums) or "the study's values alone"
    return {
        "Conventions": CONVENTIONS,
        **descriptive_attributes(study, kind),
        "config": config,
        "config_sha256": digest(config),
        "inputs_sha256": json.dumps(sums, sort_keys=True),
        "source": _source(study, _stage(kind)),
        "code_commit": commit(),
        "software": ", ".join(f"{name} {version(name)}" for name in LIBRARIES),
        "history": f"lube {version('lube')}, commit {commit()}: made from {made_from}",
        "references": f"The model is that of: {PAPER}",
    }


def descriptive_attributes(study: "Study", kind: str) -> dict[str, Any]:
    """Global attributes that follow from the study alone, whatever code made the file.

    Parameters
    ----------
    study, kind
        As in `global_attributes`.

    Returns
    -------
    dict
        Title, summary, study, licence and creators: a part of `global_attributes`.
    """
    about = study.about
    return {
        "title": f"{study.title}, {_stage(kind)}",
        "summary": f"{SUMMARIES[_stage(kind)]} {about.summary}",
        "keywords": ", ".join(about.keywords),
        "study": study.name,
        "study_seed": study.seed,
        "license": f"{about.licence} {LICENCES[about.licence]}",
        "creator_name": "; ".join(one.name for one in about.creators) or "not named",
        "creator_institution": "; ".join(one.affiliation or "-" for one in about.creators) or "-",
    }


def _stage(kind):
    """Name of the stage of a kind of file, which may be a batch."""
    return kind.removesuffix("_batch")


def _source(study, stage):
    """CF attribute `source`: how the values were produced."""
    by = f"by lube {version('lube')}"
    if study.experiment.manifest is None or stage not in _OF_RECORDS:
        return f"simulation {by}"
    evaluated = f"records of a rig, evaluated {by}"
    return evaluated if stage == "experiment" else f"{evaluated}; simulation {by}"


def config_text(study: "Study", kind: str) -> str:
    """Values of a study that determine a file, as JSON.

    Parameters
    ----------
    study, kind
        As in `global_attributes`.

    Returns
    -------
    str
        A mapping from stage to its values, in SI units (except rpm and degC): this stage and
        those it depends on.
    """
    return json.dumps(study.origin(_stage(kind)), sort_keys=True)


def check_config(dataset: xr.Dataset, study: "Study", kind: str, where: File) -> None:
    """Check that a file was computed from a study's values.

    Parameters
    ----------
    dataset : xarray.Dataset
        The opened file.
    study : Study
        The study that is to use it.
    kind : str
        A key of `lube.schema.FILES`.
    where : str or Path
        The file's path, for the message.

    Raises
    ------
    DataError
        With the first value that differs, and what to do.
    """
    came = json_attribute(dataset, "config", where)
    wanted = json.loads(config_text(study, kind))
    if came != wanted:
        difference = _difference(came, wanted)
        raise DataError(f"{where}: made from other values than this study's: {difference}{REMEDY}")


def merged_config(datasets: Iterable[xr.Dataset]) -> str:
    """Values that together determine several files of one study, as JSON.

    Parameters
    ----------
    datasets : iterable of xarray.Dataset
        Loaded files, or selections of them.

    Returns
    -------
    str
        As from `config_text`; for a single file, its attribute ``config``.

    Raises
    ------
    DataError
        If two files have different values for a stage, so that they are not of one study, or a
        file does not state its values.
    """
    merged = {}
    for dataset in datasets:
        title = dataset.attrs.get("title", "a dataset without a title")
        for stage, values in json_attribute(dataset, "config", title).items():
            if merged.setdefault(stage, values) != values:
                difference = _difference({stage: values}, {stage: merged[stage]})
                raise DataError(f"{title}: the datasets are not of one study: {difference}")
    return json.dumps(merged, sort_keys=True)


def json_attribute(dataset: xr.Dataset, name: str, where: File) -> dict[str, Any]:
    """Read an attribute that holds a JSON mapping.

    Parameters
    ----------
    dataset : xarray.Dataset
        The loaded file.
    name : str
        ``config`` or ``inputs_sha256``.
    where : str or Path
        The file's path or title, for the message.

    Returns
    -------
    dict
        From stage to its values, or from file name to SHA-256.

    Raises
    ------
    DataError
        If the attribute is missing or not JSON.
    """
    try:
        return json.loads(dataset.attrs[name])
    except (KeyError, ValueError):
        message = f"{where}: its attribute {name!r} is missing or damaged, so its origin is unknown"
        raise DataError(message) from None


def _difference(came, wanted):
    """First value by which two configurations differ, in words."""
    came, wanted = dict(single_values(came)), dict(single_values(wanted))
    key = min(key for key in {*came, *wanted} if came.get(key) != wanted.get(key))
    stated, needed = (
        shown(values[key]) if key in values else "missing" for values in (came, wanted)
    )
    return f"{key} is {stated}, need {needed}"


def single_values(content: object, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of nested mappings, and lists of plain values, with their dotted keys.

    Examples
    --------
    >>> list(single_values({"film": {"force": [1.0, 2.0]}, "traces": [{"speed": 3.0}]}))
    [('film.force', [1.0, 2.0]), ('traces[0].speed', 3.0)]
    """
    if isinstance(content, dict):
        for name, value in content.items():
            yield from single_values(value, f"{path}.{name}" if path else name)
    elif isinstance(content, list) and any(isinstance(one, dict) for one in content):
        for number, value in enumerate(content):
            yield from single_values(value, f"{path}[{number}]")
    else:
        yield path, content


def digest(text: str) -> str:
    """SHA-256 of a text, in hexadecimal digits.

    Examples
    --------
    >>> digest("film")[:10]
    'd0607f7ad2'
    """
    return hashlib.sha256(text.encode()).hexdigest()


def fingerprint(path: File) -> str:
    """SHA-256 of a file, in hexadecimal digits.

    Raises
    ------
    DataError
        If it cannot be read.
    """
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}") from None


def fingerprints(paths: Files) -> dict[str, str]:
    """SHA-256 of several files, by names that do not depend on the folder of the study.

    Parameters
    ----------
    paths : iterable of str or Path
        The files.

    Returns
    -------
    dict
        From file name to SHA-256, sorted by name. Where different files have the same
        name, the first digits of the sum follow it, as in ``run.csv#1f0c6a97bd``.
    """
    found = sorted({(Path(path).name, fingerprint(path)) for path in paths})
    count = Counter(name for name, _ in found)
    return {name if count[name] == 1 else f"{name}#{sha[:SHORT]}": sha for name, sha in found}
