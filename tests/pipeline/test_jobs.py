"""What a job does first: its log, and its errors in one line."""

import signal
import subprocess
import sys
import textwrap

import pytest

BEGIN = """\
import logging, sys
from lube.errors import DataError
from lube.pipeline.jobs import begin_job
begin_job(sys.argv[1])
log = logging.getLogger("lube.stages.contact")
"""


@pytest.fixture
def run(tmp_path):
    """Run a job of some code by itself; return its standard error and its log."""

    def run_job(code, exit_code=1):
        log = tmp_path / "job.log"
        finished = subprocess.run(
            [sys.executable, "-c", BEGIN + textwrap.dedent(code), log],
            capture_output=True,
            text=True,
            check=False,
        )
        assert finished.returncode == exit_code
        return finished.stderr, log.read_text(encoding="utf-8")

    return run_job


def test_progress_goes_to_a_new_log_and_warnings_also_to_the_terminal(run):
    run("log.info('an earlier run')", exit_code=0)
    code = """
        logging.getLogger('matplotlib').info('of another package')
        log.debug('a traceback')
        log.info('realisation 0: done')
        log.warning('strange')
    """
    lines = "a traceback\nrealisation 0: done\nstrange\n"
    assert run(code, exit_code=0) == ("strange\n", lines)


def test_an_error_that_a_user_can_correct_is_one_line_in_log_and_terminal(run):
    for error, line, exit_code in (
        ("DataError('film.nc: truncated')", "Error: film.nc: truncated\n", 1),
        ("OSError(28, '', 'k.nbc')", "Error: k.nbc: no space left on its disk\n", 1),
        ("KeyboardInterrupt", "Interrupted\n", -signal.SIGINT),
    ):
        assert run(f"raise {error}", exit_code) == (line, line)


def test_an_error_of_the_code_comes_with_its_traceback(run):
    for text in run("raise ZeroDivisionError('by nought')"):
        assert text.startswith("Error in the study's own code\nTraceback")
        assert "ZeroDivisionError: by nought" in text


def test_a_log_on_a_full_disk_adds_nothing_to_the_jobs_error():
    command = [sys.executable, "-c", BEGIN + "raise DataError('film.nc: no space')", "/dev/full"]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.stderr == "Error: film.nc: no space\n"


WRITE_SLOWLY = """\
import time
from lube.storage.files import written_whole
with written_whole(sys.argv[2]) as part:
    part.write_text("half")
    print(flush=True)
    time.sleep(60.0)
"""


def test_a_job_that_is_terminated_removes_its_unfinished_file(tmp_path):
    command = [sys.executable, "-c", BEGIN + WRITE_SLOWLY, tmp_path / "log", tmp_path / "made"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as job:
        job.stdout.readline()
        assert len(list(tmp_path.glob("made.*.part"))) == 1
        job.terminate()
        assert job.wait(20.0) == 128 + signal.SIGTERM
    assert [path.name for path in tmp_path.iterdir()] == ["log"]
