"""The start of every job: its log, its progress on the terminal, its errors in one line."""

import errno
import logging
import os
import signal
import sys
import time
from typing import Any

from lube.errors import DataError, LubeError
from lube.storage.files import why_not
from lube.study.study import Study, load_study
from lube.types import File

TERMINAL_PAUSE = 5.0
"""Least time between two progress lines of a job on the terminal, s; the log has all of them."""


SILENT = "LUBE_SILENT_JOBS"
"""Environment variable by which the bar of a run keeps jobs from writing across it."""


class _Occasionally(logging.Filter):
    """Pass every warning, and a progress line if the last line is some seconds old."""

    def __init__(self):
        super().__init__()
        self._last = time.monotonic()

    def filter(self, record):
        now = time.monotonic()
        if record.levelno < logging.WARNING and now - self._last < TERMINAL_PAUSE:
            return False
        self._last = now
        return True


def begin_job(log_file: File) -> None:
    """Set up the process of a job: messages go to its log and, occasionally, to the terminal.

    From here on an error that the user can correct is reported in one line, and a job that is
    terminated removes its unfinished files. Call it only in a process that runs nothing else.

    Parameters
    ----------
    log_file : str or Path
        The job's log, which is overwritten.

    Raises
    ------
    DataError
        If the log cannot be written.
    """
    sys.excepthook = _report
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    terminal = logging.NullHandler() if SILENT in os.environ else logging.StreamHandler()
    terminal.setLevel(logging.INFO)  # tracebacks of notebooks go to the log alone
    terminal.addFilter(_Occasionally())
    logging.basicConfig(level=logging.WARNING, handlers=[terminal], format="%(message)s")
    logging.getLogger("lube").setLevel(logging.DEBUG)
    try:
        log = logging.FileHandler(log_file, mode="w")
    except OSError as error:
        raise DataError(f"{log_file}: cannot be written: {why_not(error, log_file)}") from error
    log.handleError = lambda record: None  # on a full disk the job's own error is enough
    logging.getLogger().addHandler(log)


def study_of_job(snakemake: Any) -> Study:
    """Set up the process of a job as `begin_job` does, and load the study.

    Parameters
    ----------
    snakemake : snakemake.script.Snakemake
        What Snakemake tells the job's script.

    Returns
    -------
    Study
        The study.
    """
    begin_job(snakemake.log[0])
    return load_study(**snakemake.config["study"])


def _report(kind, error, traceback):
    """Report an uncaught error: in one line if the user can correct it, else with traceback."""
    if isinstance(error, LubeError):
        logging.error("Error: %s", error)
    elif isinstance(error, KeyboardInterrupt):
        logging.error("Interrupted")
    elif isinstance(error, OSError) and error.errno == errno.ENOSPC:
        # For instance for a compiled kernel; a result that cannot be written raises a LubeError.
        logging.error("Error: %s: no space left on its disk", error.filename or "temporary file")
    else:
        logging.error("Error in the study's own code", exc_info=(kind, error, traceback))
