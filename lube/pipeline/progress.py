"""A run on a terminal as one bar with the remaining time: a logger plugin of Snakemake.

Snakemake finds its plugins by the names of installed packages. This module registers itself
instead, so that bare ``snakemake`` shows the bar in any clone. Where the output is no terminal,
Snakemake's own lines remain.
"""

import os
import sys
import time
from collections import Counter
from collections.abc import Mapping
from logging import WARNING, LogRecord
from pathlib import Path

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

from lube.pipeline.jobs import SILENT

_SAID = (None, LogEvent.JOB_INFO)  # before the bar, or without one, as with `--quiet progress`
_BESIDE = 66  # characters of a line that the bar, the counts and the times take


def progress_bar() -> bool:
    """Make the bar known to Snakemake as the logger ``lube`` if a terminal can show it.

    Returns
    -------
    bool
        Whether it can.
    """
    if not sys.stderr.isatty():
        return False
    LoggerPluginRegistry().register_plugin("snakemake_logger_plugin_lube", sys.modules[__name__])
    return True


class Remaining:
    """Estimate of a run's remaining time from the times that its jobs took so far.

    A job to come takes as long as the finished ones of its rule did on average. Where there is
    none, it takes as long as all finished jobs did on average, or as long as one of its rule has
    been running. As many jobs run side by side as did so far.

    Parameters
    ----------
    jobs : dict of str to int
        Number of jobs of each rule.
    now : float
        Start of the run, s.
    """

    def __init__(self, jobs: Mapping[str, int], now: float) -> None:
        self._to_do, self._begin = Counter(jobs), now
        self._running: dict[int, tuple[str, float]] = {}
        self._took: dict[str, list[float]] = {}

    def started(self, job: int, rule: str, now: float) -> None:
        """Note that a job of a rule has started."""
        self._running[job] = rule, now

    def finished(self, job: int, now: float) -> None:
        """Note that a job has finished; one that was never started is left out."""
        if job in self._running:
            rule, begin = self._running.pop(job)
            self._took.setdefault(rule, []).append(now - begin)
            self._to_do[rule] -= 1

    def seconds(self, now: float) -> float | None:
        """Estimate the remaining time, s; None before the first job has finished."""
        finished = [seconds for times in self._took.values() for seconds in times]
        if not finished:
            return None
        spent = {job: (rule, now - begin) for job, (rule, begin) in self._running.items()}
        each = dict.fromkeys(self._to_do, _mean(finished))
        for rule, seconds in spent.values():
            each[rule] = max(each[rule], seconds)
        each |= {rule: _mean(times) for rule, times in self._took.items()}
        work = sum(count * each[rule] for rule, count in self._to_do.items())
        work -= sum(min(seconds, each[rule]) for rule, seconds in spent.values())
        side_by_side = sum(finished) + sum(seconds for _, seconds in spent.values())
        return work * (now - self._begin) / side_by_side


def _mean(values):
    return sum(values) / len(values)


def reason_of_failure(logs: list[str]) -> str:
    """Return the last line of a failed job's log, which says why.

    Parameters
    ----------
    logs : list of str
        The job's log files, one or none.

    Returns
    -------
    str
        That line, and where the log is.
    """
    for log in map(Path, logs):
        lines = log.read_text("utf-8", "replace").split("\n") if log.exists() else []
        if said := [line for line in lines if line.strip()]:
            return f"{said[-1]}\n  its whole log: {log}"
    return "it ended without a word in its log"


class LogHandler(LogHandlerBase):
    """The bar, with failures, warnings and the last message above it; a dry run has none."""

    writes_to_stream = True
    writes_to_file = has_filter = has_formatter = needs_rulegraph = False

    def __post_init__(self) -> None:
        """Prepare the terminal."""
        from rich.console import Console

        self._console = Console(stderr=True, highlight=False)
        self._bar, self._messages, self._failed = None, {}, set()
        if self.common_settings.dryrun:
            from snakemake.logging import ColorizingTextHandler

            self._plain = ColorizingTextHandler(self.common_settings.nocolor, sys.stdout)
        else:
            os.environ[SILENT] = "1"

    def emit(self, record: LogRecord) -> None:
        """Show what Snakemake reports."""
        event = getattr(record, "event", None)
        if self.common_settings.dryrun:
            self._plain.setFormatter(self.formatter)
            self._plain.emit(record)
        elif event == LogEvent.JOB_ERROR:
            self._say_failure(record)
        elif event == LogEvent.RUN_INFO:
            self._begin({rule: n for rule, n in record.stats.items() if rule != "total"})
        elif event == LogEvent.JOB_INFO and self._bar is not None:
            self._start(record)
        elif event == LogEvent.JOB_FINISHED:
            self._remaining.finished(record.job_id, time.monotonic())
        elif event == LogEvent.PROGRESS:
            self._bar.update(self._task, completed=record.done)
        elif record.levelno >= WARNING or (event in _SAID and self._bar is None):
            self._print(self.format(record), "red" if record.levelno > WARNING else "")

    def close(self) -> None:
        """Leave the bar as it is, without an estimate."""
        self._remaining = None
        if self._bar is not None:
            self._bar.update(self._task, description="")
            self._bar.stop()
        super().close()

    def _print(self, text, style):
        from rich.text import Text

        self._console.print(Text(text, style), soft_wrap=True)

    def _begin(self, jobs):
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            ProgressColumn,
            TextColumn,
            TimeElapsedColumn,
        )
        from rich.text import Text

        class Left(ProgressColumn):
            def render(column, task):
                left = self._remaining and self._remaining.seconds(time.monotonic())
                return Text("" if left is None else in_words(left), no_wrap=True)

        self._remaining = Remaining(jobs, time.monotonic())
        columns = (BarColumn(20), MofNCompleteColumn(), TextColumn("jobs,"), TimeElapsedColumn())
        columns += (Left(), TextColumn("[dim]{task.description}"))
        self._bar = Progress(*columns, console=self._console, refresh_per_second=2)
        self._task = self._bar.add_task("", total=sum(jobs.values()))
        self._bar.start()

    def _start(self, record):
        message = self._messages[record.jobid] = record.rule_msg or record.rule_name
        self._remaining.started(record.jobid, record.rule_name, time.monotonic())
        if message.startswith("Done"):
            self._print(message, "bold green")
        else:
            room = max(self._console.width - _BESIDE, 0)
            self._bar.update(self._task, description=message[:room].replace("[", r"\["))

    def _say_failure(self, record):
        if record.jobid not in self._failed:  # Snakemake repeats it at the end
            self._failed.add(record.jobid)
            job = self._messages.get(record.jobid, record.rule_name)
            text = f"FAILED {job}: {reason_of_failure(record.log)}"
            self._print(text, "bold red")


def in_words(seconds: float) -> str:
    """Say how long a run will still take.

    Parameters
    ----------
    seconds : float
        The estimate.

    Returns
    -------
    str
        Such as ``about 3 min left``.

    Examples
    --------
    >>> in_words(200.0)
    'about 3 min left'
    """
    if seconds >= 5400.0:
        return f"about {seconds / 3600.0:.1f} h left"
    if seconds >= 90.0:
        return f"about {seconds / 60.0:.0f} min left"
    return f"about {max(seconds, 1.0):.0f} s left"
