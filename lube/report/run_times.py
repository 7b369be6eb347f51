"""Time and memory of a study's jobs, for the report.

Clock times are in this page only, so that all other results are the same bytes in every run.
"""

import csv
import os
import platform
from collections.abc import Iterable, Mapping
from pathlib import Path

from lube.report.pages import render


def run_times(jobs: Mapping[str, Iterable[str]]) -> str:
    """List how long the jobs of a study took, and how much memory.

    Parameters
    ----------
    jobs : dict
        From the name of a step to the files that Snakemake's benchmarks wrote of its jobs. A
        missing file is left out.

    Returns
    -------
    str
        HTML: a paragraph and two tables.
    """
    steps = {
        step: [_measured(Path(file)) for file in files if Path(file).exists()]
        for step, files in jobs.items()
    }
    return render(
        "run_times.html",
        steps=steps,
        cores=os.cpu_count(),
        python=platform.python_version(),
        platform=platform.platform(),
    )


def _measured(file):
    with file.open(encoding="utf-8", newline="") as lines:
        values = next(csv.DictReader(lines, delimiter="\t"))
    # In MB; Snakemake writes NA if the job was too short.
    memory = 0.0 if values["max_rss"] == "NA" else float(values["max_rss"])
    return {"name": file.stem, "seconds": float(values["s"]), "memory": memory}
