"""Resolve a study: its file, the files that it is based on, and changes on top.

A study's file may name another with the key ``based_on`` and then holds only what differs. The
contents are merged from the last base up: mappings key by key; lists and single values are
replaced. Each study needs a different name, so that the results of different values are not mixed
in one folder. The title, summary, date and DOI in ``about`` are not taken over from the base. A
roller's roughness replaces that of the base, even if it is given in another way, such as Ra
instead of rms; and a known rig replaces the circuit of the base.
"""

import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from lube.errors import StudyError, shown
from lube.study.lubricant_record import is_record_path
from lube.study.rig_settings import PRESETS
from lube.study.rollers import ROLLERS, ROUGHNESS_KEYS
from lube.study.text_files import read_yaml
from lube.types import File

_OF_BOTH = "composite_rms_roughness"
"""Key of the roughness of both rollers together."""

_PATHS = {("experiment", "manifest"), *(("rollers", one, "topography", "file") for one in ROLLERS)}
"""Keys whose values are paths, apart from the list of lubricants."""

_OF_ONE_STUDY = {"title", "summary", "date", "doi"}
"""Keys of ``about`` that a study does not take over from its base."""


def study_files(path: File) -> list[Path]:
    """List the file of a study and all files that it is based on.

    Parameters
    ----------
    path : str or Path
        YAML file of the study.

    Returns
    -------
    list of Path
        The study's own file first, the last base last.

    Raises
    ------
    StudyError
        If one of them cannot be read, or they are based on each other in a circle.
    """
    return [file for file, _ in _chain(Path(path))]


def resolved_content(path: File, changes: dict | None = None, folder: File | None = None) -> dict:
    """Merge a study's file with the files that it is based on, and with changes.

    Parameters
    ----------
    path : str or Path
        YAML file of the study.
    changes : dict, optional
        Values to change, nested as in the file, as Snakemake's ``--config`` gives them.
        They must contain a new ``name``. Paths in them start from the study's folder.
    folder : str or Path, optional
        Folder that the relative paths in the result start from; by default the study's folder.

    Returns
    -------
    dict
        The content of the whole study, not yet checked.

    Raises
    ------
    StudyError
        If a file cannot be read, the files are based on each other in a circle, or the changes,
        or a file that is based on another, have no new name.
    """
    here = Path(path).parent
    folder = here if folder is None else Path(folder)
    content = {}
    for file, own in reversed(_chain(Path(path))):
        content = _on_top(content, _with_paths_from(own, file.parent, folder), f"{file}")
    if changes:
        content = _on_top(content, _with_paths_from(changes, here, folder), f"{path}: --config")
    return content


def resolved_text(path: File, changes: dict | None = None, folder: File | None = None) -> str:
    """Write a study as the text of a single file, which is based on no other.

    Parameters
    ----------
    path, changes, folder
        As in `resolved_content`; `folder` is where the text will be saved.

    Returns
    -------
    str
        YAML, which `load_study` reads to the same study.

    Raises
    ------
    StudyError
        As in `resolved_content`.
    """
    names = " based on ".join(file.name for file in study_files(path))
    yaml = YAML()
    yaml.width = 200  # columns, so that no text is wrapped
    yaml.representer.ignore_aliases = lambda _: True
    text = io.StringIO()
    yaml.dump(resolved_content(path, changes, folder), text)
    return f"# Resolved: {names}{', changed by --config' if changes else ''}.\n{text.getvalue()}"


def _chain(path, above=()):
    """Files from the study's own to the last base, each with its content."""
    if path.resolve() in [file.resolve() for file in above]:
        circle = " -> ".join(file.name for file in (*above, path))
        raise StudyError(f"{above[0]}: based_on: got the circle {circle}, need a chain that ends")
    content = read_yaml(path, StudyError)
    base = content.pop("based_on", None)
    if base is None:
        return [(path, content)]
    if not isinstance(base, str) or not (path.parent / base).is_file():
        needed = "need the path from this file to a study's file"
        raise StudyError(f"{path}: based_on: got {shown(base)}, {needed}")
    return [(path, content), *_chain(path.parent / base, (*above, path))]


def _on_top(base, changes, where):
    """Merge changes into the study below, if any; they must have a new name."""
    if base and changes.get("name") in (None, base.get("name")):
        came = f"got {shown(changes['name'])}" if changes.get("name") else "missing"
        needed = f"need one other than {base.get('name')!r}"
        why = "or results of different values would be mixed"
        raise StudyError(f"{where}: name: {came}, {needed}, {why}")
    match base:
        case {"about": dict(about)}:
            kept = {key: value for key, value in about.items() if key not in _OF_ONE_STUDY}
            base = base | {"about": kept}
    match base, changes:
        case {"rollers": dict(below)}, {"rollers": dict(above)}:
            base = base | {"rollers": _without_replaced(below, above)}
    match base, changes:
        case {"rig": dict(below)}, {"rig": {"preset": str(preset)}} if preset in PRESETS:
            kept = {name: below[name] for name in below.keys() - PRESETS[preset].settings.keys()}
            base = base | {"rig": kept}
    return merged(base, changes)


def _without_replaced(below, above):
    """Remove the rollers' roughness from the base where the changes give a roughness."""
    kept = dict(below)
    for name in ROLLERS:
        roller = above.get(name)
        is_given = isinstance(roller, dict) and any(map(roller.get, ROUGHNESS_KEYS))
        if is_given:
            kept.pop(_OF_BOTH, None)
        if (is_given or above.get(_OF_BOTH)) and isinstance(below.get(name), dict):
            others = below[name].items()
            kept[name] = {key: value for key, value in others if key not in ROUGHNESS_KEYS}
    return kept


def merged(base: Any, changes: Any) -> Any:
    """Return a content with changes, which replace values one by one in nested sections."""
    if not (isinstance(base, dict) and isinstance(changes, dict)):
        return changes
    return base | {key: merged(base.get(key), value) for key, value in changes.items()}


def _with_paths_from(content, here, there):
    """Rewrite the relative paths in a study's content from one folder to another."""
    if here.resolve() == there.resolve():
        return content

    def moved(name):
        return name if Path(name).is_absolute() else os.path.relpath(here / name, there)

    return with_paths(content, moved)


def with_paths(content: Any, moved: Callable[[str], str], keys: tuple = ()) -> Any:
    """Rewrite all paths that a study names, except `based_on`.

    Parameters
    ----------
    content : dict
        Content of a study, not yet checked.
    moved : callable
        From path to path.
    keys : tuple of str, optional
        Keys that lead to this part of the study.

    Returns
    -------
    dict
        The same content with other paths.
    """
    match content:
        case dict():
            return {key: with_paths(part, moved, (*keys, key)) for key, part in content.items()}
        case list() if keys == ("lubricants",):
            return [moved(name) if is_record_path(name) else name for name in content]
        case str() if keys in _PATHS:
            return moved(content)
    return content
