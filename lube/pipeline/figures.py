"""A figure of a study: how it is drawn, and the file that states its origin.

A file beside the pictures of a figure states its origin, such as ``figures/fig02_film.json``: the
SHA-256 sums of the datasets that it was drawn from and of the files that were made. It shows
whether the files are still as the workflow made them.
"""

import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from lube.errors import DataError, LubeError
from lube.pipeline.cells import datasets_of
from lube.pipeline.figure_files import origin, products
from lube.pipeline.notebooks import execute_notebook
from lube.pipeline.stamps import drawn_by
from lube.storage.files import write_text
from lube.storage.git import ROOT
from lube.storage.netcdf import opened
from lube.storage.provenance import REMEDY, fingerprint
from lube.types import File, Files


def paths_for(notebook: File, datasets: Files) -> dict[str, str]:
    """Assign datasets to the parameters of a notebook.

    Parameters
    ----------
    notebook : str or Path
        The notebook.
    datasets : iterable of str or Path
        Datasets, each for the parameter whose path names the same kind of dataset.

    Returns
    -------
    dict
        From parameter to path.

    Raises
    ------
    LubeError
        If a dataset that the notebook names is not among them.
    """
    paths = {Path(path).stem: str(path) for path in datasets}
    kinds = datasets_of(notebook)
    for kind in kinds.values():
        if kind not in paths:
            raise LubeError(f"{notebook}: needs {kind}.nc, which is missing")
    return {parameter: paths[kind] for parameter, kind in kinds.items()}


def draw_figure(notebook: File, datasets: list[str], code: list[str], results: File) -> None:
    """Execute a notebook on a study's datasets and write the origin of its figure.

    Parameters
    ----------
    notebook : str or Path
        The notebook.
    datasets : list of str
        Paths of the datasets that it names.
    code : list of str
        Paths of the files of code that the figure depends on.
    results : str or Path
        Folder of the study's results.

    Raises
    ------
    LubeError
        If the notebook fails, or saves no figure.
    """
    results, figure = Path(results), Path(notebook).stem
    before = _last_changes(results, figure)
    parameters = {**paths_for(notebook, datasets), "figure": str(results / "figures" / figure)}
    names = [Path(os.path.relpath(file, ROOT)).as_posix() for file in code]
    changes = drawn_by(map(_commit_of, datasets), names, notebook)
    execute_notebook(notebook, results / "notebooks" / f"{figure}.ipynb", parameters, changes)
    # Snakemake keeps the old pictures until new ones replace them.
    if not before.isdisjoint(_last_changes(results, figure)):
        raise LubeError(f"{notebook}: saved no figure, need plots.save_figure(..., figure, ...)")
    content = {
        "datasets": {Path(path).stem: fingerprint(path) for path in sorted(datasets)},
        "products": {name: fingerprint(results / name) for name in products(figure)},
        "drawn_by": changes,
    }
    write_text(results / origin(figure), json.dumps(content, indent=1) + "\n")


def _commit_of(path):
    """Commit of the code that made a dataset."""
    with opened(path) as dataset:
        return dataset.code_commit


def _last_changes(results, figure):
    """Return the pictures of a figure with the times of their last changes."""
    paths = [results / name for name in products(figure)[:2]]
    return {(path, path.stat().st_mtime_ns if path.exists() else None) for path in paths}


def read_origin(figure: str, folder: File) -> dict[str, Any]:
    """Read the origin of a figure.

    Parameters
    ----------
    figure : str
        Its name.
    folder : str or Path
        Folder of a study's results, or an archive.

    Returns
    -------
    dict
        ``datasets``, the SHA-256 sums by kind; ``products``, the SHA-256 sums by path; and
        ``drawn_by``.

    Raises
    ------
    DataError
        If the file is missing or damaged.
    """
    path = Path(folder) / origin(figure)
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return content | {name: dict(content[name]) for name in ("datasets", "products")}
    except (OSError, ValueError, KeyError, TypeError):
        raise DataError(f"{path}: missing or damaged") from None


def wrong_figures(figures: Iterable[str], folder: File, data: File) -> Iterator[str]:
    """Check that figures are as the workflow drew them from the present datasets.

    Parameters
    ----------
    figures : iterable of str
        Their names.
    folder : str or Path
        Folder of a study's results, or an archive.
    data : str or Path
        Folder of the datasets.

    Yields
    ------
    str
        What is wrong and what to do, one line each.
    """
    for figure in figures:
        try:
            made = read_origin(figure, folder)
            for name, expected in made["products"].items():
                if fingerprint(Path(folder) / name) != expected:
                    yield f"{Path(folder) / name}: not as the workflow made it{REMEDY}"
            for kind, expected in made["datasets"].items():
                if fingerprint(Path(data) / f"{kind}.nc") != expected:
                    picture = Path(folder) / products(figure)[0]
                    yield f"{picture}: was drawn from another {kind}.nc{REMEDY}"
        except DataError as error:
            yield f"{error}{REMEDY}"
