"""A figure of a study: how it is drawn, and the file that says of what it was drawn.

Beside the pictures of a figure lies its origin, such as ``figures/fig02_film.json``: the
fingerprints of the datasets that it was drawn from and of the files that were made. By it the
archive knows whether the files are still what the workflow made.
"""

import json
from pathlib import Path

import netCDF4

from lube.errors import DataError, LubeError
from lube.storage.files import written_whole
from lube.storage.provenance import WAY_OUT, fingerprint
from lube.storage.seals import holds
from lube.workflow.cells import datasets_of
from lube.workflow.notebooks import execute_notebook
from lube.workflow.stamps import drawn_by


def products(figure):
    """Files that are made of a figure.

    Parameters
    ----------
    figure : str
        Its name, such as ``fig02_film``.

    Returns
    -------
    list of str
        Paths below the folder of a study's results, or below an archive: the pictures and the
        executed notebook.
    """
    return [f"figures/{figure}.png", f"figures/{figure}.pdf", f"notebooks/{figure}.ipynb"]


def origin(figure):
    """Path of the file that says of what a figure was drawn, as in `products`."""
    return f"figures/{figure}.json"


def paths_for(notebook, datasets):
    """Values for the variables of a notebook that name datasets.

    Parameters
    ----------
    notebook : str or Path
        The notebook.
    datasets : iterable of str or Path
        Files to take the place of those that its parameters cell names.

    Returns
    -------
    dict
        From variable to path.

    Raises
    ------
    LubeError
        If there is no file of a kind that it names.
    """
    paths = {Path(path).stem: str(path) for path in datasets}
    named = datasets_of(notebook)
    for kind in named.values():
        if kind not in paths:
            raise LubeError(f"{notebook}: needs {kind}.nc, which is not there")
    return {variable: paths[kind] for variable, kind in named.items()}


def draw_figure(notebook, datasets, code, results):
    """Execute a notebook on a study's datasets, and say of what its figure was drawn.

    Parameters
    ----------
    notebook : str or Path
        The notebook.
    datasets : sequence of str or Path
        The datasets that it names.
    code : sequence of str
        Files of code behind the figure, below the folder of the Snakefile.
    results : str or Path
        Folder of the study's results.

    Raises
    ------
    LubeError
        If the notebook fails, or saves no figure.
    """
    results, figure = Path(results), Path(notebook).stem
    stem, executed = results / "figures" / figure, results / "notebooks" / f"{figure}.ipynb"
    told = drawn_by(_commits(datasets), code, notebook)
    pictures = [stem.with_name(f"{figure}.{suffix}") for suffix in ("png", "pdf")]
    before = [_state(picture) for picture in pictures]
    execute_notebook(
        notebook, executed, {**paths_for(notebook, datasets), "figure": str(stem)}, told
    )
    # Snakemake lets old ones stand.
    if any(_state(picture) == old for picture, old in zip(pictures, before, strict=True)):
        raise LubeError(
            f"{notebook}: saved no figure, need plots.save_figure(..., figure, ...) in its cells"
        )
    content = {
        "datasets": {Path(path).stem: fingerprint(path) for path in sorted(datasets)},
        "products": {name: fingerprint(results / name) for name in products(figure)},
        "drawn_by": told,
    }
    with written_whole(results / origin(figure)) as part:
        part.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def _commits(datasets):
    """Yield the commits of the code that made some datasets; damage is for the notebook to tell."""
    for path in datasets:
        if holds(path):
            with netCDF4.Dataset(path) as dataset:
                yield dataset.getncattr("code_commit")


def _state(path):
    """State of a file that changes whenever it is written, even with the same content."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def read_origin(figure, folder):
    """Read what a figure was drawn from.

    Parameters
    ----------
    figure : str
        Its name.
    folder : str or Path
        Folder of a study's results, or an archive.

    Returns
    -------
    dict
        ``datasets`` and ``products``, their fingerprints by kind and by name, and ``drawn_by``.

    Raises
    ------
    DataError
        If it is not there or damaged.
    """
    path = Path(folder) / origin(figure)
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return {
            "datasets": dict(content["datasets"]),
            "products": dict(content["products"]),
            "drawn_by": str(content["drawn_by"]),
        }
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        raise DataError(f"{path}: missing or damaged") from None


def wrong_figures(figures, folder, data):
    """Compare figures with what the workflow made, from the datasets that are there.

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
        What is wrong and what to do, a line each.
    """
    for figure in figures:
        try:
            made = read_origin(figure, folder)
            for name in products(figure):
                path = Path(folder) / name
                if fingerprint(path) != made["products"].get(name):
                    yield f"{path}: not as the workflow made it{WAY_OUT}"
            for kind, digits in made["datasets"].items():
                if fingerprint(Path(data) / f"{kind}.nc") != digits:
                    path = Path(folder) / products(figure)[0]
                    yield f"{path}: was drawn from another {kind}.nc{WAY_OUT}"
        except DataError as error:
            yield f"{error}{WAY_OUT}"
