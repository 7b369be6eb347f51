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
    steps, every = [], []
    for name, files in jobs.items():
        found = [_measured(Path(file)) for file in files if Path(file).exists()]
        if found:
            seconds = [job["seconds"] for job in found]
            steps.append(
                {
                    "name": name,
                    "jobs": len(found),
                    "seconds": sum(seconds),
                    "longest": max(seconds),
                    "memory": max(job["memory"] for job in found),
                }
            )
            every += found
    return render(
        "run_times.html",
        steps=steps,
        jobs=sorted(every, key=lambda job: -job["seconds"]),
        total=sum(job["seconds"] for job in every),
        largest=max(every, key=lambda job: job["memory"], default=None),
        cores=os.cpu_count(),
        python=platform.python_version(),
        platform=platform.platform(),
    )


def _measured(file):
    with file.open(encoding="utf-8", newline="") as lines:
        values = next(csv.DictReader(lines, delimiter="\t"))
    return {
        "name": file.stem,
        "seconds": float(values["s"]),
        "memory": _number(values["max_rss"]),
    }


def _number(text):
    """Memory in MB; 0 where Snakemake wrote ``NA``, because the job was too short."""
    try:
        return float(text)
    except ValueError:
        return 0.0
