"""Time and memory of a study's jobs, for the report.

Clock times are in this page only, so that all other results are the same bytes in every run.
"""

import os
import platform
from collections.abc import Iterable, Mapping
from pathlib import Path

import pandas as pd

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
    machine = {"python": platform.python_version(), "platform": platform.platform()}
    return render("run_times.html", steps=steps, cores=os.cpu_count(), **machine)


def _measured(file):
    # Snakemake writes NA for the memory, in MB, of a job that was too short.
    values = pd.read_csv(file, sep="\t").fillna(0.0).iloc[0]
    return {"name": file.stem, "seconds": values["s"], "memory": values["max_rss"]}
