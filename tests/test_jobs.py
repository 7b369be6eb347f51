"""What every job does first: its log, its progress, its errors in one line."""

import subprocess
import sys
import textwrap
import time

import pytest

from lube.jobs import TERMINAL_PAUSE, _NowAndThen

BEGIN = """\
import logging, sys
from lube.errors import DataError
from lube.jobs import begin_job
begin_job(sys.argv[1])
log = logging.getLogger("lube.contact")
"""


@pytest.fixture
def run(tmp_path):
    """Run a job of some code by itself; return its process and what its log holds."""

    def run_job(code):
        log = tmp_path / "logs" / "job.log"
        finished = subprocess.run(
            [sys.executable, "-c", BEGIN + textwrap.dedent(code), log],
            capture_output=True,
            text=True,
            check=False,
        )
        return finished, log.read_text(encoding="utf-8")

    return run_job


def test_progress_goes_to_the_log_and_not_at_once_to_the_terminal(run):
    finished, log = run("log.info('realisation 0: done'); log.info('realisation 1: done')")
    assert finished.returncode == 0
    assert log == "realisation 0: done\nrealisation 1: done\n"
    assert finished.stderr == ""


def test_other_packages_chatter_stays_out(run):
    _, log = run("logging.getLogger('matplotlib').info('a font'); log.info('done')")
    assert log == "done\n"


def test_an_error_that_a_user_can_mend_is_one_line_in_log_and_terminal(run):
    finished, log = run("raise DataError('film.nc: truncated')")
    assert finished.returncode != 0
    assert log == finished.stderr == "Error: film.nc: truncated\n"


def test_an_error_of_our_own_comes_with_all_it_knows(run):
    finished, log = run("raise ZeroDivisionError('by nought')")
    assert finished.returncode != 0
    for text in (log, finished.stderr):
        assert text.startswith("Error in the study's own code\n")
        assert "Traceback" in text and "ZeroDivisionError: by nought" in text


def test_an_interrupted_job_shows_no_traceback(run):
    # What Ctrl-C raises; a signal would not do where a shell runs the tests in the background.
    finished, log = run("raise KeyboardInterrupt")
    assert finished.returncode != 0
    assert log == finished.stderr == "Interrupted\n"


def test_a_log_is_begun_anew(run):
    run("log.info('first')")
    _, log = run("log.info('second')")
    assert log == "second\n"


def test_the_terminal_shows_progress_now_and_then_and_every_warning(monkeypatch):
    import logging

    clock = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    now_and_then = _NowAndThen()

    def passes(level, after):
        clock[0] += after
        return now_and_then.filter(logging.LogRecord("lube", level, "", 0, "", (), None))

    assert not passes(logging.INFO, after=0.9 * TERMINAL_PAUSE)
    assert passes(logging.INFO, after=0.2 * TERMINAL_PAUSE)
    assert not passes(logging.INFO, after=0.5 * TERMINAL_PAUSE)
    assert passes(logging.WARNING, after=0.0)
    assert passes(logging.ERROR, after=0.0)
    assert passes(logging.INFO, after=1.1 * TERMINAL_PAUSE)
