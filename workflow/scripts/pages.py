"""Write the report's text: the parts of its start page, and its further pages."""

from pathlib import Path

from lube.pipeline.jobs import study_of_job
from lube.report import ON_ASSUMPTIONS, SUMMARISED
from lube.report.configuration import configuration
from lube.report.key_tables import files_table
from lube.report.markdown import title_and_text, to_html
from lube.report.pages import render
from lube.report.sensitivity import rests_on
from lube.report.statements import assumptions_of, limits_of
from lube.report.summary import facts, findings, made
from lube.storage.files import write_text
from lube.storage.netcdf import load
from lube.study.study import load_study

study, paper = study_of_job(snakemake), load_study(snakemake.input.paper)
results = {
    kind: load(path, kind, study)
    for kind in (*SUMMARISED, *ON_ASSUMPTIONS)
    if (path := snakemake.input.get(kind))
}
written = Path(snakemake.input.study).read_text(encoding="utf-8")
docs = {Path(file).stem: Path(file).read_text(encoding="utf-8") for file in snakemake.input.docs}
title, assumptions = title_and_text(assumptions_of(study, paper, docs["assumptions"]))
_, limits = title_and_text(limits_of(study, paper, docs["limits"]))
if "sensitivity" in results:
    assumptions += rests_on(study, *map(results.get, ON_ASSUMPTIONS))
drawing = docs["architecture"].split("```")[1]
parts = {
    "facts": to_html(f"{facts(study, results['lubricant'])}\n\n{made(study)}"),
    "findings": to_html(findings(study, results)),
    "limits": to_html(limits),
    "files": to_html(files_table(study.datasets)),
    "pipeline": to_html(f"```{drawing}```"),
    "configuration": render("page.html", title="Configuration", body=configuration(study, written)),
    "assumptions": render("page.html", title=title, body=to_html(assumptions)),
}
for name, html in parts.items():
    write_text(snakemake.output[name], html)
