"""Stamps: one short line on a figure that leads back to what it was drawn from."""

import os
import sys
from pathlib import Path

from lube.errors import DataError
from lube.storage.git import ROOT, changed_since, commit, text_in
from lube.storage.provenance import SHORT, digest, merged_config
from lube.workflow.cells import cells_of, reduced

DRAWN_BY = "LUBE_DRAWN_BY"
"""Variable of the environment that tells a notebook's stamps what `drawn_by` says."""


def stamp(datasets):
    """One short line that leads from a figure back to what it was made from.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        What the figure shows.

    Returns
    -------
    str
        For each study: its name, the fingerprint of its values behind the figure, and the
        code's commit. Behind them, what `drawn_by` adds: of a notebook that the workflow
        executes, as it was told; of one run by hand, whose file nobody knows, for the code.

    Raises
    ------
    DataError
        If there is none, or as `merged_config`.
    """
    if not datasets:
        raise DataError("a figure needs the datasets that it shows, as loaded: got none")
    studies = {}
    for dataset in datasets:
        studies.setdefault(dataset.attrs.get("study"), []).append(dataset)
    line = "; ".join(
        f"study {name} · config {digest(merged_config(of))[:SHORT]} · "
        f"commit {', '.join(sorted({_short_commit(dataset) for dataset in of}))}"
        for name, of in studies.items()
    )
    told = os.environ.get(DRAWN_BY)
    if told is None:
        told = drawn_by([dataset.attrs["code_commit"] for dataset in datasets], _loaded_code())
    return f"{line} · {told}" if told else line


def drawn_by(commits, code, notebook=None):
    """Tell what a figure was drawn by, if not as in the commits of the code behind its datasets.

    Parameters
    ----------
    commits : iterable of str
        Those commits, as the datasets tell them.
    code : iterable of str
        Files of code behind the figure, below the folder of the Snakefile.
    notebook : str or Path, optional
        Its notebook; what counts are its cells, not their outputs.

    Returns
    -------
    str
        Such as ``drawn at commit 0123456789 · changed notebook``: the clone's commit, if another,
        and what differs from it. Empty if notebook and code are as in one of the commits, or
        nobody knows, as in an unpacked archive.
    """
    code, head = list(code), commit().partition("+")[0]
    made_at = {name.partition("+")[0] for name in commits}
    since = {name: _changes(name, code, notebook) for name in (*made_at, head)}
    if since[head] is None or any(since[name] == [] for name in made_at):
        return ""
    place = [] if head in made_at else [f"drawn at commit {head[:SHORT]}"]
    return " · ".join([*place, *since[head]])


def _changes(name, code, notebook):
    """Tell what is not as in a commit, in words; None if nobody knows."""
    changed = changed_since(name, code)
    if changed is None:
        return None
    words = ["changed code"] if changed else []
    if notebook is None:
        return words
    before = text_in(name, Path(os.path.relpath(notebook, ROOT)).as_posix())
    if before is None:
        return ["new notebook", *words]
    return ["changed notebook", *words] if reduced(before) != cells_of(notebook) else words


def _loaded_code():
    """Files of lube that this process has loaded, below the folder of the Snakefile."""
    loaded = [module for name, module in sys.modules.items() if name.split(".")[0] == "lube"]
    return sorted(Path(module.__file__).relative_to(ROOT).as_posix() for module in loaded)


def _short_commit(dataset):
    name, plus, _ = dataset.attrs["code_commit"].partition("+")
    return name[:SHORT] + plus
