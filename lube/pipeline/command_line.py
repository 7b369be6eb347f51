"""The study that a Snakemake command asks for, or another workflow that uses this one."""

import argparse
import json
import os
from collections.abc import Sequence
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

from lube.errors import StudyError, located, shown
from lube.pipeline.sources import from_here
from lube.pipeline.study_files import one_line_errors
from lube.study.resolve import merged, study_files
from lube.study.study import Study, load_study
from lube.types import File

PAPER = "workflow/config/paper.yaml"
"""Study file of a command without ``--configfile``, below the folder of the workflow."""

_WORDS = {"true": True, "false": False, "null": None}


@one_line_errors()
def check_command_line(arguments: Sequence[str]) -> None:
    """End Snakemake with one line if it would fail to read the study's options.

    Snakemake reads ``--configfile`` and ``--config`` before the Snakefile, and answers a missing
    file or a misplaced target with a traceback. The profiles call this function first.

    Parameters
    ----------
    arguments : sequence of str
        Arguments of the command ``snakemake``.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="+", default=[])
    parser.add_argument("--config", "-C", nargs="*", default=[])
    options, others = parser.parse_known_args(arguments)
    _check_targets(others)
    _check_number(options.configfile)
    for file in options.configfile:
        study_files(file)  # refuses what it cannot read
    for entry in options.config:
        _check_entry(entry)


def _check_targets(words):
    """Refuse a study given as a target; results, such as ``study.yaml``, are targets."""
    for before, word in pairwise(["", *words]):
        is_target = word.endswith((".yaml", ".yml")) and not before.startswith("--")
        if is_target and "results" not in Path(word).parts:
            raise StudyError(f"got the target {word}, need `--configfile {word}` for a study")


def _check_number(files):
    if len(files) > 1:
        study, *others = files
        advice = f"put targets before it, as in `snakemake {' '.join(others)} --configfile {study}`"
        if others[0].endswith((".yaml", ".yml")):
            advice = f"a study that changes another begins with `based_on: {study}`"
        raise StudyError(f"--configfile takes one study, got {' '.join(files)}: {advice}")


def _check_entry(entry):
    key, equals, value = entry.partition("=")
    if not equals:
        advice = f"put targets before it, as in `snakemake {entry} --config key=value`"
        raise StudyError(f"--config: got {entry}, need key=value; {advice}")
    if "." in key:
        outer, *inner = key.split(".")
        for name in reversed(inner):
            value = f"{{{name}: {value}}}"
        raise StudyError(f"--config: got {entry}, need '{outer}={value}' for a nested key")


def changes_of(entries: Sequence[str]) -> dict[str, Any]:
    """Read changes of a study from a command line, as Snakemake reads its ``--config``.

    Parameters
    ----------
    entries : sequence of str
        Such as ``realisations=8`` or ``rollers={first: {radius: 30 mm}}``.

    Returns
    -------
    dict
        From key to value, for `study_of_command`.

    Raises
    ------
    StudyError
        At the first entry that is not of that form.
    """
    import yaml

    changes = {}
    for entry in entries:
        _check_entry(entry)
        key, _, value = entry.partition("=")
        with suppress(yaml.YAMLError):  # a value that is not YAML is text
            value = yaml.load(value, Loader=yaml.BaseLoader)
        changes = merged(changes, {key: value or None})
    return changes


def study_of_command(files: Sequence[File], config: dict) -> tuple[Study, dict[str, Any]]:
    """Load the study that a Snakemake command asks for.

    Parameters
    ----------
    files : sequence of str or Path
        Files of ``--configfile``: one, or none for the paper's study.
    config : dict
        Values of ``--config``, as Snakemake parsed them.

    Returns
    -------
    study : Study
        The study.
    arguments : dict
        Arguments of `load_study` for the same study: ``path`` and ``changes``.

    Raises
    ------
    LubeError
        If the study cannot be loaded, or ``--config`` changes it without a new name.
    """
    _check_number([str(file) for file in files])
    path = files[0] if files else from_here(PAPER)
    return _checked(path, {key: _typed(value) for key, value in config.items()})


def same_study(path: str, changes: dict) -> list[str]:
    """Write the options of a Snakemake command that asks for the same study.

    Parameters
    ----------
    path, changes
        As from `study_of_command`.

    Returns
    -------
    list of str
        ``--configfile``, and ``--config`` if there are changes.

    Examples
    --------
    >>> same_study("mine.yaml", {"rollers": {"length": "8 mm"}})
    ['--configfile', 'mine.yaml', '--config', 'rollers={"length": "8 mm"}']
    """
    values = [f"{key}={json.dumps(value)}" for key, value in changes.items()]
    return ["--configfile", path, *(["--config", *values] if values else [])]


def study_of_module(config: dict) -> tuple[Study, dict[str, Any]]:
    """Load the study that another workflow asks for when it uses this one as a module.

    Parameters
    ----------
    config : dict
        The ``config`` of its ``module`` statement: the path of the study's file under ``study``,
        and values to change, as for ``--config``.

    Returns
    -------
    study : Study
        The study.
    arguments : dict
        As from `study_of_command`.

    Raises
    ------
    LubeError
        If no file is named, or as from `study_of_command`.
    """
    changes, study = dict(config), config.get("study")
    if not isinstance(study, str):
        came = f"config of the module: study: got {shown(study)}"
        raise StudyError(f"{came}, need the path of a study's file")
    return _checked(changes.pop("study"), changes)


def _checked(path, changes):
    """Load a study; also make the slow checks, which the start of each job leaves out."""
    path = os.path.relpath(path)
    study = load_study(path, changes)
    with located(f"{path}: lubricants"):
        for record in study.lubricants:
            record.check_fluid(study.operating_grid.temperature)
    return study, {"path": path, "changes": changes}


def _typed(value):
    """Give numbers in a nested value their type: Snakemake leaves all of them as text."""
    match value:
        case dict():
            return {key: _typed(one) for key, one in value.items()}
        case list():
            return [_typed(one) for one in value]
        case str():
            for read in (int, float, _WORDS.__getitem__):
                with suppress(ValueError, KeyError):
                    return read(value)
    return value
