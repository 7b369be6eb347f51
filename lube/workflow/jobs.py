"""What every job of the workflow does first: open its log and tell errors in one line."""

import errno
import logging
import os
import signal
import sys
import threading
import time
from pathlib import Path

from lube.errors import DataError, LubeError
from lube.storage.files import is_running, why_not

TERMINAL_PAUSE = 5.0
"""Seconds between two progress lines of one job on the terminal; the log keeps all."""

SNAKEMAKE = "LUBE_SNAKEMAKE"
"""Variable of the environment that holds the number of Snakemake's process."""
WATCH_PAUSE = 0.2
"""Seconds between two looks of a job at whether its Snakemake still lives."""
LAST_RESPITE = 10.0
"""Seconds that a job has to clear up when it does not."""


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

    From here on the job ends when its Snakemake does, whose process the workflow tells in the
    environment: a file that it finished later could pass for one of the next run, perhaps of a
    changed study.

    Parameters
    ----------
    log_file : str or Path
        The job's log, begun anew.

    Raises
    ------
    DataError
        If the log cannot be written.
    """
    sys.excepthook = _tell
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    if SNAKEMAKE in os.environ:
        threading.Thread(target=_end_with, args=(int(os.environ[SNAKEMAKE]),), daemon=True).start()
    terminal = logging.StreamHandler()
    terminal.setLevel(logging.INFO)  # a notebook's traceback is for the log alone
    terminal.addFilter(_NowAndThen())
    logging.basicConfig(level=logging.WARNING, handlers=[terminal], format="%(message)s")
    logging.getLogger("lube").setLevel(logging.DEBUG)
    logging.raiseExceptions = False  # a log on a full disk has nothing to add to the job's error
    logging.getLogger().addHandler(_log_handler(Path(log_file)))


def _log_handler(path):
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        return logging.FileHandler(path, mode="w")
    except OSError as error:
        raise DataError(f"{path}: cannot be written: {why_not(error, path)}") from error


def _end_with(snakemake):
    """End this process soon after another, without leaving half a file if that can be helped."""
    while is_running(snakemake):
        time.sleep(WATCH_PAUSE)
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(LAST_RESPITE)
    os.kill(os.getpid(), signal.SIGKILL)


def _tell(kind, error, traceback):
    """Report an uncaught error: one line for the user's, all of it for ours."""
    if isinstance(error, LubeError):
        logging.error("Error: %s", error)
    elif isinstance(error, KeyboardInterrupt):
        logging.error("Interrupted")
    elif isinstance(error, OSError) and error.errno == errno.ENOSPC:
        # Not of a result, which says so itself, but for instance of a compiled kernel.
        logging.error("Error: %s: no space left on its disk", error.filename or "a file aside")
    else:
        logging.error("Error in the study's own code", exc_info=(kind, error, traceback))
