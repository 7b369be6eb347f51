"""What every job does first: its log, its progress, its errors in one line."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest

from lube.workflow.jobs import SNAKEMAKE, TERMINAL_PAUSE, _NowAndThen

BEGIN = """\
import logging, sys
from lube.errors import DataError
from lube.workflow.jobs import begin_job
begin_job(sys.argv[1])
log = logging.getLogger("lube.stages.contact")
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


def test_what_is_for_the_log_alone_never_goes_to_the_terminal(run):
    code = f"""
        import time
        time.sleep({TERMINAL_PAUSE} + 0.1)
        log.debug('a traceback')
    """
    finished, log = run(code)
    assert log == "a traceback\n"
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


def test_a_disk_that_is_full_elsewhere_is_told_in_one_line(run):
    finished, log = run("raise OSError(28, 'No space left on device', 'kernel.nbc')")
    assert finished.returncode != 0
    assert log == finished.stderr == "Error: kernel.nbc: no space left on its disk\n"


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


def test_a_log_that_cannot_be_written_is_told_in_one_line(tmp_path):
    (tmp_path / "logs").write_text("no folder")
    log = tmp_path / "logs" / "job.log"
    command = [sys.executable, "-c", BEGIN, log]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.returncode != 0
    assert finished.stderr.startswith(f"Error: {log}: cannot be written: ")
    assert finished.stderr.count("\n") == 1


# Killed, itself or its Snakemake

WRITE_SLOWLY = """\
import time
from lube.storage.files import written_whole
with written_whole(sys.argv[2]) as part:
    part.write_text("half")
    print(flush=True)
    time.sleep(60.0)
"""


@pytest.fixture
def start(tmp_path):
    """Start a job that is writing a file, of a Snakemake whose process is another."""
    started = []

    def start_job(snakemake):
        started.append(
            subprocess.Popen(
                [sys.executable, "-c", BEGIN + WRITE_SLOWLY, tmp_path / "log", tmp_path / "made"],
                env=os.environ | {SNAKEMAKE: str(snakemake.pid)},
                stdout=subprocess.PIPE,
            )
        )
        started[0].stdout.readline()
        assert len(list(tmp_path.glob("made.*.part"))) == 1
        return started[0]

    yield start_job
    for job in started:
        job.kill()
        job.communicate()


@pytest.fixture
def other():
    """Another process, which does nothing for long."""
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    yield process
    process.kill()
    process.communicate()


def test_a_job_ends_with_its_snakemake_and_clears_up(start, other, tmp_path):
    job = start(other)
    other.kill()
    other.wait()
    assert job.wait(20.0) == 128 + signal.SIGTERM
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def test_a_job_that_is_stopped_clears_up(start, other, tmp_path):
    job = start(other)
    job.terminate()
    assert job.wait(20.0) == 128 + signal.SIGTERM
    assert [path.name for path in tmp_path.iterdir()] == ["log"]
