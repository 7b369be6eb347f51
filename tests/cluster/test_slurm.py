"""The smoke study through a Slurm of its own, where one can be started."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from run_slurm import CONF, OURS

SCRIPT = Path(__file__).with_name("run_slurm.py")


def reason_to_skip():
    if not shutil.which("slurmctld") and not os.environ.get("LUBE_TEST_SLURM"):
        return "Slurm is not installed; with LUBE_TEST_SLURM=1 this test installs it"
    if CONF.exists() and not CONF.read_text("utf-8").startswith(OURS):
        return "this machine has a Slurm of its own, left as it is"
    return ""


@pytest.mark.slow
@pytest.mark.skipif(bool(reason_to_skip()), reason=reason_to_skip())
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
