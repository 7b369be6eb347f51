"""Snakemake's own lint and the formatters have nothing to say."""

import re
import subprocess
import sys
from pathlib import Path

from repository import ROOT

from lube.schema import STAGES

BIN = Path(sys.executable).parent

# One Python environment is right here; all other lints apply.
ONE_ENVIRONMENT = "Specify a conda environment or container for each rule."


def test_snakemakes_lint_asks_for_environments_and_nothing_else(smoke):
    lints = re.findall(r"^ +\* (.*):$", smoke.snakemake("--lint", study=None).stdout, re.MULTILINE)
    assert set(lints) == {ONE_ENVIRONMENT}


def test_the_sources_are_tidy():
    for program, *arguments in (
        ("ruff", "check", "."),
        ("ruff", "format", "--check", "."),
        ("snakefmt", "--check", "Snakefile", "workflow", "profiles"),
    ):
        assert subprocess.run([BIN / program, *arguments], cwd=ROOT, check=False).returncode == 0


def test_every_rule_has_a_message_a_log_a_benchmark_and_a_script_of_its_name():
    rules = "\n".join(path.read_text("utf-8") for path in (ROOT / "workflow/rules").glob("*.smk"))
    for rule in re.split(r"^ *rule ", rules, flags=re.MULTILINE)[1:]:
        name = rule.split(":")[0]
        assert "    message:\n" in rule and "    log:\n" in rule, name
        # `verify` makes no file and is repeated each time.
        assert name == "verify" or "    benchmark:\n" in rule, name
        script = re.search(rf'script:\n +"../scripts/{name}.py"', rule)
        assert script or "    shell:\n" in rule, name


def test_every_rule_is_told_in_a_sentence(smoke):
    listed = smoke.snakemake("--list", study=None).stdout.splitlines()
    rules = {line.split(" (")[0]: line for line in listed if re.match(r"\w+( \(|$)", line)}
    assert STAGES.keys() <= rules.keys()
    assert all(re.fullmatch(r"\w+ \(.{15,}\)", line) for line in rules.values()), rules


def test_rule_files_hold_declarations_only():
    for path in (ROOT / "workflow/rules").glob("*.smk"):
        defined = re.findall(r"^ *(?:def|class) (\w+)", path.read_text("utf-8"), re.MULTILINE)
        assert defined in ([], ["in_report"]), path
