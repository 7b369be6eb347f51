"""The smoke study through a Slurm of its own, where one can be started."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("run_slurm.py")


@pytest.mark.slow
def test_the_smoke_study_through_slurm_makes_the_same_bytes():
    finished = subprocess.run(
        [sys.executable, SCRIPT],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if finished.stdout.startswith("Skipped: "):
        pytest.skip(finished.stdout.strip())
    assert finished.returncode == 0, finished.stdout
    assert finished.stdout.endswith(" passed, 0 failed\n"), finished.stdout
