"""Stamps: a short line on each figure that states its study, its values and the code."""

import os
import sys
from collections.abc import Iterable
from pathlib import Path

import xarray as xr

from lube.errors import DataError
from lube.pipeline.cells import cells_of, reduced
from lube.storage.git import ROOT, changed_since, commit, text_in
from lube.storage.provenance import SHORT, digest, merged_config
from lube.types import File

DRAWN_BY = "LUBE_DRAWN_BY"
"""Environment variable by which the workflow passes the text of `drawn_by` to a notebook."""


def stamp(datasets: list[xr.Dataset]) -> str:
    """Compose the stamp of a figure.

    Parameters
    ----------
    datasets : list of xarray.Dataset
        What the figure shows.

    Returns
    -------
    str
        For each study its name, the fingerprint of the values behind the figure, and the commit
        of the code; then the text of `drawn_by`. In a notebook run by hand that text covers
        the code only, because the notebook's file is unknown.

    Raises
    ------
    DataError
        If there is no dataset, or as from `merged_config`.
    """
    if not datasets:
        raise DataError("got no dataset, a figure needs the loaded datasets that it shows")
    studies = {}
    for dataset in datasets:
        studies.setdefault(dataset.attrs.get("study"), []).append(dataset)
    line = "; ".join(
        f"study {name} · config {digest(merged_config(shown))[:SHORT]} · "
        f"commit {', '.join(sorted({_short_commit(dataset) for dataset in shown}))}"
        for name, shown in studies.items()
    )
    changes = os.environ.get(DRAWN_BY)
    if changes is None:
        changes = drawn_by([dataset.attrs["code_commit"] for dataset in datasets], _loaded_code())
    return f"{line} · {changes}" if changes else line


def drawn_by(commits: Iterable[str], code: list[str], notebook: File | None = None) -> str:
    """State how the code that draws a figure differs from the commits that made its datasets.

    Parameters
    ----------
    commits : iterable of str
        Those commits, from the datasets' attributes.
    code : list of str
        Files of code that the figure depends on, below the folder of the Snakefile.
    notebook : str or Path, optional
        Its notebook; its cells are compared, not their outputs.

    Returns
    -------
    str
        Such as ``drawn at commit 0123456789 · changed notebook``: the current commit, if it is not
        among them, and what differs from it. Empty if notebook and code are as in one of the
        commits, or if this is unknown, as in an unpacked archive.
    """
    head = commit().partition("+")[0]
    made_at = {name.partition("+")[0] for name in commits}
    changes = {name: _changes(name, code, notebook) for name in (*made_at, head)}
    if changes[head] is None or any(changes[name] == [] for name in made_at):
        return ""
    at = [] if head in made_at else [f"drawn at commit {head[:SHORT]}"]
    return " · ".join([*at, *changes[head]])


def _changes(name, code, notebook):
    """List in words what differs from a commit; None if unknown."""
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
