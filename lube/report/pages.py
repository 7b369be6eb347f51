"""Pages of the report: one HTML file each, that needs nothing beside it; and the run times.

Clock times stand here and nowhere else, so that all other results are the same whenever they
are made.
"""

import csv
import os
import platform
from html import escape
from pathlib import Path


def html_table(head, rows, kind=""):
    """Write a table.

    Parameters
    ----------
    head : sequence of str
        HTML of the columns' headings.
    rows : iterable of sequence of str
        HTML of the cells.
    kind : str, optional
        Class of the table, for its style.

    Returns
    -------
    str
        HTML.
    """
    lines = [f'<table class="{kind}">' if kind else "<table>"]
    lines += ["<thead>", _row("th", head), "</thead>", "<tbody>"]
    lines += [_row("td", row) for row in rows]
    return "\n".join([*lines, "</tbody>", "</table>"])


def _row(tag, cells):
    return f"<tr>{''.join(f'<{tag}>{cell}</{tag}>' for cell in cells)}</tr>"


def html_page(title, body, style):
    """Write a page.

    Parameters
    ----------
    title : str
        Its title, without marks.
    body : str
        HTML of what stands below the title.
    style : str
        Its style sheet, which is put into the page.

    Returns
    -------
    str
        HTML.
    """
    title = escape(title)
    return (
        f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{title}</title>\n<style>\n{style}</style>\n</head>\n"
        f"<body>\n<main>\n<h1>{title}</h1>\n{body}\n</main>\n</body>\n</html>\n"
    )


def run_times(jobs):
    """Tell how long the jobs of a study took, and how much memory.

    Parameters
    ----------
    jobs : dict
        From a step of the study to the files that Snakemake's benchmarks left of its jobs. A
        job whose file is missing is left out.

    Returns
    -------
    str
        HTML: a few sentences and two tables.
    """
    measured = {step: [_measured(file) for file in files if Path(file).exists()]
                for step, files in jobs.items()}  # fmt: skip
    steps = [(step, found) for step, found in measured.items() if found]
    every = sorted((job for _, found in steps for job in found), key=lambda job: -job["seconds"])
    if not every:
        return "<p>No job has left its times.</p>"
    total = sum(job["seconds"] for job in every)
    peak = max(every, key=lambda job: job["memory"])
    words = (
        f"<p><strong>{len(every)} jobs</strong> took <strong>{_duration(total)}</strong> one after "
        f"the other; those that ran beside one another took less by the clock. The longest was "
        f"<strong>{escape(every[0]['name'])}</strong> with {_duration(every[0]['seconds'])}; the "
        f"most memory, {_memory(peak['memory'])}, was <strong>{escape(peak['name'])}</strong>'s. "
        f"Each as of the last time that it ran.</p>\n<p>{_machine()}</p>"
    )
    return "\n".join([words, "<h2>Steps</h2>", _steps(steps, total),
                      "<h2>Every job</h2>", _every_job(every)])  # fmt: skip


def _measured(file):
    """Time and memory of one job; what was too short to be seen counts nothing."""
    with open(file, encoding="utf-8", newline="") as lines:
        values = next(csv.DictReader(lines, delimiter="\t"))
    return {
        "name": Path(file).stem,
        "seconds": _number(values["s"]),
        "memory": _number(values.get("max_rss")),
    }


def _number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return 0.0


def _steps(steps, total):
    rows = []
    for step, jobs in steps:
        seconds = [job["seconds"] for job in jobs]
        share = 100.0 * sum(seconds) / total if total else 0.0
        bar = f'<span class="bar"><span style="width: {share:.1f}%"></span></span>'
        peak = max(job["memory"] for job in jobs)
        cells = [len(jobs), _duration(sum(seconds)), bar, _duration(max(seconds)), _memory(peak)]
        rows.append([escape(step), *map(str, cells)])
    head = ("step", "jobs", "all together", "share", "longest", "most memory")
    return html_table(head, rows, kind="numbers")


def _every_job(jobs):
    rows = [
        (f"<code>{escape(job['name'])}</code>", _duration(job["seconds"]), _memory(job["memory"]))
        for job in jobs
    ]
    return html_table(("job", "time", "most memory"), rows, kind="numbers")


def _duration(seconds):
    if seconds < 60.0:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s"


def _memory(megabytes):
    return f"{megabytes:.0f} MB" if megabytes else "too short to tell"


def _machine():
    """Say on what the times were measured."""
    cores = f"{os.cpu_count()} core{'s' if os.cpu_count() != 1 else ''}"
    return f"Measured on {cores}, Python {platform.python_version()}, {platform.platform()}."
