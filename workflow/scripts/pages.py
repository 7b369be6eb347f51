"""Write what the report says of the study: its start page's parts, and pages of their own."""

from pathlib import Path

from lube.report.configuration import configuration
from lube.report.excerpts import excerpts
from lube.report.pages import html_page
from lube.report.summary import facts, findings, notes
from lube.storage.files import written_whole
from lube.storage.netcdf import load
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
kinds = ("film", "contact", "experiment", "comparison")
film, contact, experiment, comparison = (load(snakemake.input[kind], kind, study) for kind in kinds)
written, readme, style = (
    Path(snakemake.input[name]).read_text(encoding="utf-8") for name in ("study", "readme", "style")
)
parts = excerpts(readme)
parts |= {
    "facts": facts(study),
    "findings": findings(study, film, contact, comparison) + notes(experiment, comparison),
    "configuration": html_page("Configuration", configuration(study, written), style),
    "assumptions": html_page("What the paper leaves open", parts["assumptions"], style),
}
for name, html in parts.items():
    with written_whole(snakemake.output[name]) as part:
        part.write_text(html, encoding="utf-8")
