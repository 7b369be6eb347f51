"""Groups of profiles/slurm: no group waits for itself, whatever the study; Slurm is not needed."""

import json
import subprocess
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
import yte
from repository import ROOT

from lube.schema import STAGES

LOCAL = {"report"}  # runs where Snakemake itself does
TARGETS = {"all", "areal_contact", "patch_contact", "computed", "rough_passage"}
TARGETS |= {"sensitivity", "electrical", "measurement_plan", "verification", "benchmark"}


@pytest.fixture
def profile(monkeypatch):
    """The profile as Snakemake reads it."""
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", ["snakemake"])
    monkeypatch.setattr(sys, "path", sys.path[:])
    return yte.process_yaml((ROOT / "profiles/slurm/config.yaml").read_text("utf-8"))


@pytest.fixture
def followers():
    """Pairs of rules of the shipped studies, of which the second follows the first."""
    finished = subprocess.run(
        [sys.executable, Path(__file__).with_name("job_graphs.py")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr
    return json.loads(finished.stdout.splitlines()[-1])


def order(pairs, groups):
    """Groups, and rules without one, each after those that it waits for."""
    waits = {}
    for first, second in pairs:
        one, other = groups.get(first, first), groups.get(second, second)
        if one != other:
            waits.setdefault(other, set()).add(one)
    return list(TopologicalSorter(waits).static_order())


def test_no_group_of_any_shipped_study_waits_for_itself(profile, followers):
    for study, pairs in followers.items():
        try:
            order(pairs, profile["groups"])
        except CycleError as error:
            pytest.fail(f"{study}: groups wait for one another: {' -> '.join(error.args[1])}")
        rules = {rule for pair in pairs for rule in pair} - LOCAL - TARGETS
        assert rules <= profile["groups"].keys(), study
    assert len(followers) >= 2  # with a measured surface and without


def test_every_stage_is_in_a_group(profile):
    assert {stage.rule for stage in STAGES.values()} <= profile["groups"].keys()


def test_the_batches_wait_for_the_tables_alone_and_the_figures_for_all(profile):
    members = {}
    for rule, group in profile["groups"].items():
        members.setdefault(group, set()).add(rule)
    assert members["tables"] == {"lubricant", "film", "resolved_study"}
    assert members["batches"] == {"batch"}
    assert {"contact", "gauge", "explorer", "times"} < members["figures"]
    assert {"experiment", "tail", "trace", "roughness", "variants"} < members["beside"]
