"""The README of an archive, for a reader who has nothing else."""

from collections.abc import Mapping

import xarray as xr

from lube.report.pages import render
from lube.report.summary import facts, findings
from lube.schema import SUMMARIES
from lube.storage.git import changed_code, commit
from lube.study.metadata import LICENCES, PAPER
from lube.study.study import Study


def archive_page(
    study: Study, study_file: str, kinds: list[str], results: Mapping[str, xr.Dataset]
) -> str:
    """Write the README.md of an archive.

    Parameters
    ----------
    study : Study
        The study.
    study_file : str
        Path of its file below the archive's folder ``study``, with slashes.
    kinds : list of str
        Its datasets in the archive.
    results : dict of str to xarray.Dataset
        Its datasets `lube.report.SUMMARISED`, by name.

    Returns
    -------
    str
        Markdown.
    """
    return render(
        "archive.md",
        study=study,
        licence=LICENCES[study.about.licence],
        paper=PAPER,
        datasets={kind: SUMMARIES[kind] for kind in kinds},
        study_file=study_file,
        commit=commit(),
        changed=changed_code(),
        facts=facts(study, results["lubricant"]),
        findings=findings(study, results),
    )
