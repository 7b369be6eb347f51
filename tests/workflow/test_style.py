"""Snakemake's own lint and the formatters have nothing to say."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from repository import ROOT

BIN = Path(sys.executable).parent
RULES = sorted((ROOT / "workflow/rules").glob("*.smk"))

# One Python environment is right here; nothing else of Snakemake's lint is passed over.
ONE_ENVIRONMENT = "Specify a conda environment or container for each rule."


def test_snakemakes_lint_asks_for_environments_and_nothing_else(smoke):
    lints = re.findall(r"^ +\* (.*):$", smoke.snakemake("--lint", study=None).stdout, re.MULTILINE)
    assert set(lints) == {ONE_ENVIRONMENT}


@pytest.mark.parametrize(
    "command",
    [
        ("ruff", "check", "."),
        ("ruff", "format", "--check", "."),
        ("snakefmt", "--check", "Snakefile", "workflow", "profiles"),
    ],
    ids=" ".join,
)
def test_the_sources_are_tidy(command):
    program, *arguments = command
    finished = subprocess.run(
        [BIN / program, *arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stdout


@pytest.mark.parametrize("file", RULES, ids=lambda path: path.stem)
def test_every_rule_has_a_message_a_log_and_a_benchmark(file):
    rules = re.split(r"^rule ", file.read_text("utf-8"), flags=re.MULTILINE)[1:]
    assert rules or file.stem in ("common", "notebooks")
    for rule in rules:
        needed = ["message:", "log:"]
        # To verify is to make nothing, each time anew.
        needed += [] if rule.startswith("verify:") else ["output:", "benchmark:"]
        for directive in needed:
            assert f"    {directive}\n" in rule, f"{rule.split(':')[0]} has no {directive}"
        assert re.search(r"^    (script|shell):\n", rule, re.MULTILINE)


@pytest.mark.parametrize("file", RULES, ids=lambda path: path.stem)
def test_every_rule_has_a_script_of_its_own_name(file):
    for name, script in re.findall(
        r"^rule (\w+):.*?script:\n +\"\.\./scripts/(\w+)\.py\"",
        file.read_text("utf-8"),
        re.S | re.M,
    ):
        assert name == script
        assert (ROOT / f"workflow/scripts/{script}.py").is_file()
