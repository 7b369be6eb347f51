"""The start of every job: its log, and its errors in one line."""

import errno
import gc
import logging
import os
import signal
import sys
from typing import TYPE_CHECKING, Any

from lube.errors import LubeError
from lube.types import File

if TYPE_CHECKING:
    from lube.study.study import Study

SILENT = "LUBE_SILENT_JOBS"
"""Environment variable by which the bar of a run keeps jobs from writing across it."""


def begin_job(log_file: File) -> None:
    """Set up the process of a job: messages go to its log, warnings also to the terminal.

    From here on an error that the user can correct is reported in one line, and a job that is
    terminated removes its unfinished files. Call it only in a process that runs nothing else.

    Parameters
    ----------
    log_file : str or Path
        The job's log, which is overwritten.
    """
    # Looking for garbage took a tenth of a figure's time. There is little, and a job ends soon.
    gc.set_threshold(50_000)
    sys.excepthook = _report
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    terminal = logging.NullHandler() if SILENT in os.environ else logging.StreamHandler()
    terminal.setLevel(logging.WARNING)  # progress and tracebacks of notebooks go to the log alone
    log = logging.FileHandler(log_file, mode="w")
    log.handleError = lambda record: None  # on a full disk the job's own error is enough
    logging.basicConfig(level=logging.WARNING, handlers=[terminal, log], format="%(message)s")
    logging.getLogger("lube").setLevel(logging.DEBUG)


def study_of_job(snakemake: Any) -> "Study":
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
    from lube.study.study import load_study  # figures, which need no study, start without it

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
