"""The study whose results a notebook shows."""

import os
from pathlib import Path

from lube.errors import DataError, right_one, shown
from lube.pipeline.stamps import DRAWN_BY
from lube.schema import DATASETS
from lube.storage.git import ROOT
from lube.types import File

CHOSEN = "LUBE_STUDY"
"""Environment variable that chooses the study."""


def results_folder(study: File | None = None, default: str = "paper") -> Path:
    """Find the results of a study, from any working folder.

    Parameters
    ----------
    study : str or Path, optional
        Name of the study, such as ``slip``, or the folder of its results. If it is not given:
        within a study's results or an archive, that study; else the one that the environment
        variable ``LUBE_STUDY`` names; else `default`.
    default : str, optional
        The study that is shown where none is chosen.

    Returns
    -------
    Path
        Folder of the study's datasets, absolute. A study's name is looked for in the folder
        ``results`` of the working folder, of the folders above it, and of the repository. In a
        notebook that the workflow executes, the folder has no meaning, because the workflow gives
        the datasets.

    Raises
    ------
    DataError
        If there is no such folder with a dataset.
    """
    here = Path.cwd()
    if DRAWN_BY in os.environ:
        return here
    bases = [folder / "results" for folder in (here, *here.parents, ROOT)]  # the nearest first
    places = []
    if study is None:
        places = [here, here / "data", here.parent, here.parent / "data"]
        study = os.environ.get(CHOSEN, default)
    for folder in (*places, Path(study).absolute(), *(base / study for base in bases)):
        if _holds_results(folder):
            return folder
    folders = [folder for base in bases for folder in sorted(base.glob("*"))]
    there = list(dict.fromkeys(folder.name for folder in folders if _holds_results(folder)))
    needed = "which has no results yet: run snakemake first"
    if there:
        needed = f"{right_one(study, there)} ({CHOSEN} chooses the study)"
    raise DataError(f"study: got {shown(str(study))}, {needed}")


def _holds_results(folder):
    return any((folder / f"{kind}.nc").is_file() for kind in DATASETS)
