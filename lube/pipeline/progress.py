"""A run on a terminal as one bar with the remaining time: a logger plugin of Snakemake.

Snakemake finds its plugins by the names of installed packages. This module registers itself
instead, so that bare ``snakemake`` shows the bar in any clone. Where the output is no terminal,
Snakemake's own lines remain.
"""

import os
import sys
from logging import WARNING, LogRecord
from pathlib import Path

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

from lube.pipeline.jobs import SILENT

_SAID = (None, LogEvent.JOB_INFO)  # shown until the bar begins; `--quiet progress` has no bar
_BESIDE = 66  # characters of a line taken by the bar, the counts and the times


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


def reason_of_failure(logs: list[str]) -> str:
    """Return the last line of a failed job's log, which says why.

    Parameters
    ----------
    logs : list of str
        The job's log files, one or none.

    Returns
    -------
    str
        The last line, and the path of the log.
    """
    for log in map(Path, logs):
        lines = log.read_text("utf-8", "replace").split("\n") if log.exists() else []
        if said := [line for line in lines if line.strip()]:
            return f"{said[-1]}\n  full log: {log}"
    return "it left no message in its log"


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
            self._begin(record.stats["total"])
        elif event == LogEvent.JOB_INFO and self._bar is not None:
            self._start(record)
        elif event == LogEvent.PROGRESS:
            self._bar.update(self._task, completed=record.done)
        elif record.levelno >= WARNING or (event in _SAID and self._bar is None):
            self._print(self.format(record), "red" if record.levelno > WARNING else None)

    def close(self) -> None:
        """Leave the bar as it is."""
        if self._bar is not None:
            self._bar.update(self._task, description="")
            self._bar.stop()
        super().close()

    def _print(self, text, style=None):
        self._console.print(text, style=style, markup=False, emoji=False, soft_wrap=True)

    def _begin(self, jobs):
        from rich import progress

        bar, done = progress.BarColumn(20), progress.MofNCompleteColumn()
        elapsed, remaining = progress.TimeElapsedColumn(), progress.TimeRemainingColumn()
        columns = (bar, done, "jobs,", elapsed, remaining, "left", "[dim]{task.description}")
        self._bar = progress.Progress(*columns, console=self._console, refresh_per_second=2)
        self._task = self._bar.add_task("", total=jobs)
        self._bar.start()

    def _start(self, record):
        message = self._messages[record.jobid] = record.rule_msg or record.rule_name
        if message.startswith("Done"):
            self._print(message, "bold green")
        else:
            room = max(self._console.width - _BESIDE, 0)
            self._bar.update(self._task, description=message[:room].replace("[", r"\["))

    def _say_failure(self, record):
        if record.jobid not in self._failed:  # Snakemake repeats it at the end
            self._failed.add(record.jobid)
            job = self._messages.get(record.jobid, record.rule_name)
            self._print(f"FAILED {job}: {reason_of_failure(record.log)}", "bold red")
