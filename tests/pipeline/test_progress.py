"""The bar of a run on a terminal, and what stands above it."""

import io
import logging
from types import SimpleNamespace

from rich.console import Console
from snakemake.logging import DefaultFormatter
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

from lube.pipeline import progress
from lube.pipeline.jobs import SILENT
from lube.pipeline.progress import LogHandler, progress_bar, reason_of_failure


def test_the_reason_is_the_last_line_of_the_log(tmp_path):
    log = tmp_path / "film.log"
    assert reason_of_failure([str(log)]) == "it left no message in its log"
    log.write_text("Traceback\nError: oil.yaml: no source\n\n")
    assert reason_of_failure([str(log)]) == f"Error: oil.yaml: no source\n  full log: {log}"


def test_a_log_has_no_bar_and_a_terminal_has_one(monkeypatch):
    monkeypatch.setattr(LoggerPluginRegistry(), "plugins", {})
    assert not progress_bar()
    monkeypatch.setattr(progress.sys, "stderr", SimpleNamespace(isatty=lambda: True))
    assert progress_bar()
    assert LoggerPluginRegistry().get_plugin("lube").log_handler is LogHandler


def handler(monkeypatch, dryrun=False):
    monkeypatch.setenv(SILENT, "")
    made = LogHandler(SimpleNamespace(dryrun=dryrun, nocolor=True), None)
    made.setFormatter(DefaultFormatter())
    made._console = Console(file=io.StringIO(), force_terminal=True, width=100, color_system=None)
    return made


def report(made, event=None, level=logging.INFO, msg="", **values):
    record = logging.LogRecord("snakemake", level, "", 0, msg, (), None)
    record.__dict__.update(values)
    if event:
        record.event = event
    made.emit(record)


def test_a_run_shows_the_bar_its_failures_and_its_end_only(monkeypatch, tmp_path):
    (tmp_path / "film.log").write_text("Error: [no] film\n")
    made = handler(monkeypatch)
    report(made, msg="Building DAG of jobs...")
    report(made, LogEvent.RUN_INFO, stats={"total": 2})
    job = {"jobid": 1, "rule_name": "film"}
    report(made, LogEvent.JOB_INFO, rule_msg="Film: [x] films", reason="r" * 2000, **job)
    report(made, msg="Select jobs to execute...")
    for _ in range(2):
        values = job | {"log": [str(tmp_path / "film.log")]}
        report(made, LogEvent.JOB_ERROR, logging.ERROR, **values)
    report(made, LogEvent.JOB_FINISHED, job_id=1)
    report(made, LogEvent.PROGRESS, done=1, total=99)
    end = {"jobid": 0, "rule_name": "all", "rule_msg": "Done: results"}
    report(made, LogEvent.JOB_INFO, **end)
    report(made, level=logging.WARNING, msg="low disk")
    made.close()
    shown = made._console.file.getvalue()
    assert "Building" in shown and "Select" not in shown and "rrr" not in shown
    assert shown.count("FAILED Film: [x] films: Error: [no] film") == 1
    assert "1/2 jobs" in shown and "Done: results" in shown and "low disk" in shown


def test_without_progress_the_jobs_are_lines(monkeypatch):
    made = handler(monkeypatch)
    values = {"rule_msg": "Film: films", "jobid": 1, "reason": "", "rule_name": "film"}
    report(made, LogEvent.JOB_INFO, **values)
    made.close()
    assert "Job 1: Film: films" in made._console.file.getvalue()


def test_a_dry_run_has_snakemakes_own_lines(monkeypatch, capsys):
    made = handler(monkeypatch, dryrun=True)
    made._plain.stream = io.StringIO()
    report(made, LogEvent.RUN_INFO, msg="Job stats", stats={"total": 1})
    assert made._plain.stream.getvalue() == "Job stats\n"
