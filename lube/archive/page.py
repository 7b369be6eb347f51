"""The README of an archive, for a reader who has nothing else."""

from lube.report.pages import render
from lube.schema import DATASETS, SUMMARIES
from lube.storage.git import changed_code, commit
from lube.study.metadata import LICENCES, PAPER
from lube.study.study import Study


def archive_page(study: Study, study_file: str, refused: list[str]) -> str:
    """Write the README.md of an archive.

    Parameters
    ----------
    study : Study
        The study.
    study_file : str
        Path of its file below the archive's folder ``study``, with slashes.
    refused : list of str
        Lines about measured records that were not used, and why.

    Returns
    -------
    str
        Markdown.
    """
    grid = study.operating_grid
    return render(
        "archive.md",
        title=study.title,
        about=study.about,
        licence=LICENCES[study.about.licence],
        paper=PAPER,
        datasets={kind: SUMMARIES[kind] for kind in DATASETS},
        study_file=study_file,
        commit=commit(),
        changed=changed_code(),
        measured=study.experiment.manifest is not None,
        refused=refused,
        example={name: getattr(grid, name)[-1] for name in ("force", "speed", "temperature")},
    )
