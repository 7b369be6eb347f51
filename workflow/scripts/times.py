"""Write the report's page on time and memory, from what Snakemake measured of each job."""

from lube.pipeline.jobs import begin_job
from lube.report.pages import render
from lube.report.run_times import run_times
from lube.storage.files import write_text

begin_job(snakemake.log[0])
page = render("page.html", title="Run times", body=run_times(snakemake.params.jobs))
write_text(snakemake.output[0], page)
