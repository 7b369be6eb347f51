"""What every job of the workflow does first: open its log and tell errors in one line."""

import logging
import sys
import time
from pathlib import Path

from lube.errors import LubeError

TERMINAL_PAUSE = 5.0
"""Seconds between two progress lines of one job on the terminal; the log keeps all."""


class _NowAndThen(logging.Filter):
    """Let a progress line pass if the last one is some seconds ago, and every warning."""

    def __init__(self):
        super().__init__()
        self._last = time.monotonic()

    def filter(self, record):
        now = time.monotonic()
        if record.levelno < logging.WARNING and now - self._last < TERMINAL_PAUSE:
            return False
        self._last = now
        return True


def begin_job(log_file):
    """Send progress to a job's log, now and then to the terminal, and tell errors in one line.

    Parameters
    ----------
    log_file : str or Path
        The job's log, begun anew.
    """
    Path(log_file).parent.mkdir(parents=True, exist_ok=True)
    file = logging.FileHandler(log_file, mode="w")
    terminal = logging.StreamHandler()
    terminal.addFilter(_NowAndThen())
    logging.basicConfig(level=logging.WARNING, handlers=[file, terminal], format="%(message)s")
    logging.getLogger("lube").setLevel(logging.INFO)
    logging.raiseExceptions = False  # a log on a full disk has nothing to add to the job's error
    sys.excepthook = _tell


def _tell(kind, error, traceback):
    """Report an uncaught error: one line for the user's, all of it for ours."""
    if isinstance(error, LubeError):
        logging.error("Error: %s", error)
    elif isinstance(error, KeyboardInterrupt):
        logging.error("Interrupted")
    else:
        logging.error("Error in the study's own code", exc_info=(kind, error, traceback))
