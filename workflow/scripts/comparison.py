"""Make comparison.nc: simulation and records side by side, and how far they agree."""

from lube.comparison import compare
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
contact, experiment = (load(snakemake.input[kind], kind) for kind in ("contact", "experiment"))
save(compare(contact, experiment), snakemake.output[0], "comparison", study)
