"""Where a result comes from, written so that a stranger can check it years later.

Every file says which values of the study it follows from and their fingerprint, what other files
went into it and theirs, and the code and libraries that made it. No clock time is among it:
the same study makes the same bytes.
"""

import contextlib
import hashlib
import json
from collections import Counter
from importlib.metadata import version
from pathlib import Path

from lube.errors import DataError
from lube.schema import SUMMARIES
from lube.storage.git import commit
from lube.study.metadata import LICENCES, PAPER

CONVENTIONS = "CF-1.11, ACDD-1.3"
LIBRARIES = ("numpy", "scipy", "numba", "CoolProp", "xarray", "netCDF4")
"""Libraries whose version may change the numbers, or the bytes that hold them."""
SHORT = 10
"""Digits of a fingerprint where people read it."""
WAY_OUT = "; take it away and run snakemake again"
"""What to do about a result of other values, at the end of its line."""


def global_attributes(study, kind, inputs=()):
    """Attributes of a file that tell where it comes from.

    Parameters
    ----------
    study : Study
        The study it belongs to.
    kind : str
        A key of `lube.schema.FILES`.
    inputs : iterable of str or Path, optional
        Files that it was made from.

    Returns
    -------
    dict
        Global attributes by CF's and ACDD's names, and the study's own beside them.
    """
    stage = kind.removesuffix("_batch")
    config = config_text(study, kind)
    hashes = fingerprints(inputs)
    made_from = ", ".join(hashes) or "the study's values alone"
    code = f"lube {version('lube')}, commit {commit()}"
    return {
        "Conventions": CONVENTIONS,
        **names_of(study, kind),
        "config": config,
        "config_sha256": digest(config),
        "inputs_sha256": json.dumps(hashes, sort_keys=True),
        "source": _source(study, stage),
        "code_commit": commit(),
        "software": ", ".join(f"{name} {version(name)}" for name in LIBRARIES),
        "history": f"{code}: made from {made_from}",
        "references": f"The model is that of: {PAPER}",
    }


def names_of(study, kind):
    """Attributes of a file that say what it is and whose, whatever code made it.

    Parameters
    ----------
    study : Study
        The study it belongs to.
    kind : str
        A key of `lube.schema.FILES`.

    Returns
    -------
    dict
        Some of those of `global_attributes`.
    """
    stage, about = kind.removesuffix("_batch"), study.about
    return {
        "title": f"{title_of(study)}, {stage}",
        "summary": f"{SUMMARIES[stage]} {about.summary}",
        "keywords": ", ".join(about.keywords),
        "study": study.name,
        "study_seed": study.seed,
        "license": f"{about.licence} {LICENCES[about.licence]}",
        "creator_name": "; ".join(one.name for one in about.creators) or "not named",
        "creator_institution": "; ".join(one.affiliation or "-" for one in about.creators) or "-",
    }


def _source(study, stage):
    """Tell how a file's values came about: CF's word for it."""
    by = f"by lube {version('lube')}"
    if study.experiment.manifest is None or stage not in ("experiment", "comparison", "gauge"):
        return f"simulation {by}"
    evaluated = f"records of a rig, evaluated {by}"
    return evaluated if stage == "experiment" else f"{evaluated}; simulation {by}"


def title_of(study):
    """Title of a study's results."""
    return study.about.title or f"Mixed lubrication study {study.name}"


def config_text(study, kind):
    """Values of a study that a file follows from, in SI units (but rpm and degC).

    Parameters
    ----------
    study : Study
        The study.
    kind : str
        A key of `lube.schema.FILES`.

    Returns
    -------
    str
        JSON: from stage to its values, those of the stages before it included.
    """
    return json.dumps(study.origin(kind.removesuffix("_batch")), sort_keys=True)


def check_config(dataset, study, kind, where):
    """Refuse a file that follows from other values than the study's.

    Parameters
    ----------
    dataset : xarray.Dataset
        The opened file.
    study : Study
        The study that wants to use it.
    kind : str
        A key of `lube.schema.FILES`.
    where : str or Path
        The file's path, for the message.

    Raises
    ------
    DataError
        With the first value that differs, and what to do.
    """
    wanted = config_text(study, kind)
    if dataset.attrs.get("config_sha256") != digest(wanted):
        raise DataError(
            f"{where}: belongs to other values than this study's: "
            f"{_difference(dataset.attrs.get('config'), wanted)}{WAY_OUT}"
        )


def check_origin(dataset, where):
    """Refuse a file that does not say where it comes from, or has been given other values.

    Parameters
    ----------
    dataset : xarray.Dataset
        The opened file.
    where : str or Path
        The file's path, for the message.

    Raises
    ------
    DataError
        If an attribute is missing, or ``config`` is not what its fingerprint says.
    """
    for name in _NEEDED:
        if name not in dataset.attrs:
            raise DataError(f"{where}: its attribute {name!r} is missing, so its origin is unknown")
    if digest(dataset.attrs["config"]) != dataset.attrs["config_sha256"]:
        raise DataError(
            f"{where}: damaged or changed by hand: its attribute 'config' is not the text whose "
            "fingerprint is config_sha256"
        )


_NEEDED = ("title", "study", "config", "config_sha256", "inputs_sha256", "source", "code_commit")
_NEEDED += ("software",)


def merged_config(datasets):
    """Values that some files of one study follow from together.

    Parameters
    ----------
    datasets : iterable of xarray.Dataset
        Loaded files, or selections of them.

    Returns
    -------
    str
        JSON as from `config_text`; that of a single file is its own.

    Raises
    ------
    DataError
        If two files disagree about a stage's values, so that they cannot be of one study, or
        one of them tells no values.
    """
    merged, first = {}, {}
    for dataset in datasets:
        title = dataset.attrs.get("title", "a dataset without a title")
        for stage, values in told_by(dataset, "config", title).items():
            if merged.setdefault(stage, values) != values:
                pair = [json.dumps({stage: one}) for one in (merged[stage], values)]
                raise DataError(
                    f"{first[stage]!r} and {title!r} are not of one study: {_difference(*pair)}"
                )
            first.setdefault(stage, title)
    return json.dumps(merged, sort_keys=True)


def told_by(dataset, name, where):
    """Read what a file says of its origin in JSON.

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
        From stage to its values, or from file to its fingerprint.

    Raises
    ------
    DataError
        If it does not say.
    """
    with contextlib.suppress(KeyError, TypeError, ValueError, RecursionError):
        told = json.loads(dataset.attrs[name])
        if isinstance(told, dict):
            return told
    raise DataError(
        f"{where}: its attribute {name!r} is missing or damaged, so its origin is unknown"
    )


def _difference(came, wanted):
    """First value by which two configurations differ, in words."""
    if came is None:
        return "it does not say which"
    came, wanted = (dict(_leaves(json.loads(text))) for text in (came, wanted))
    for key in sorted({*came, *wanted}):
        if came.get(key) != wanted.get(key):
            return f"{key} is {came.get(key, 'not there')}, need {wanted.get(key, 'no such value')}"
    return "its fingerprint config_sha256 is not that of its values"


def _leaves(content, path=""):
    """Single values of nested mappings and lists, by their dotted keys."""
    if isinstance(content, dict):
        parts = content.items()
    elif isinstance(content, list):
        parts = enumerate(content)
    else:
        yield path, content
        return
    for name, value in parts:
        yield from _leaves(value, f"{path}.{name}" if path else str(name))


def digest(content):
    """SHA-256 of a text or bytes, in hexadecimal digits."""
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()


def fingerprint(path):
    """SHA-256 of a file, in hexadecimal digits.

    Parameters
    ----------
    path : str or Path
        The file, of any size: it is streamed.

    Returns
    -------
    str
        64 digits.

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


def fingerprints(paths):
    """SHA-256 of some files, by names that do not depend on where the study lies.

    Parameters
    ----------
    paths : iterable of str or Path
        The files.

    Returns
    -------
    dict
        From file name to digits, in the names' order. Different files of one name bear the
        first digits behind it, as in ``run.csv#1f0c6a97bd``.
    """
    found = sorted({(Path(path).name, fingerprint(path)) for path in paths})
    times = Counter(name for name, _ in found)
    return {
        name if times[name] == 1 else f"{name}#{digits[:SHORT]}": digits for name, digits in found
    }


def told_inputs(dataset, where):
    """Read what a file says of the files that it was made from.

    Parameters
    ----------
    dataset : xarray.Dataset
        The loaded file.
    where : str or Path
        The file's path, for the message.

    Returns
    -------
    dict
        From file name to a set of fingerprints: one for each file of that name.

    Raises
    ------
    DataError
        If it does not say.
    """
    told = {}
    for name, digits in told_by(dataset, "inputs_sha256", where).items():
        digits = str(digits)  # a forged file may say anything
        told.setdefault(name.removesuffix(f"#{digits[:SHORT]}"), set()).add(digits)
    return told
