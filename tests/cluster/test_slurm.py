"""The smoke study through a Slurm of its own, where there is one to start."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from run_slurm import CONF, OURS

SCRIPT = Path(__file__).with_name("run_slurm.py")
ASKED = "LUBE_TEST_SLURM"


def reason_to_skip():
    if os.environ.get(ASKED):
        return ""
    if not shutil.which("slurmctld"):
        return f"Slurm is not installed; with {ASKED}=1 in the environment, this test installs it"
    if not importlib.util.find_spec("snakemake_executor_plugin_slurm"):
        return "the Slurm plugin is not installed: pip install -e '.[slurm]'"
    if os.geteuid() != 0:
        return "only root can start a Slurm"
    if CONF.exists() and not CONF.read_text("utf-8").startswith(OURS):
        return "this machine has a Slurm of its own, left as it is"
    return ""


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
