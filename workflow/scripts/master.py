"""Make master.nc: probabilities over lambda ratio and contact width, with intervals."""

from lube.stages.ensemble import gather_map
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
batches = [load(path, "master_batch", study) for path in snakemake.input.batches]
save(gather_map(batches), snakemake.output[0], "master", study, [snakemake.input.film])
