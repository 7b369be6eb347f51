"""Make explorer.html, a page that shows any operating point of the study."""

from lube.explorer.page import explorer_page
from lube.pipeline.jobs import begin_job
from lube.storage.files import write_text
from lube.storage.netcdf import load
from lube.study.study import load_study

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
datasets = {kind: load(snakemake.input[kind], kind, study) for kind in snakemake.params.kinds}
write_text(snakemake.output[0], explorer_page(datasets, study.band))
