"""Make master.nc: probability over lambda ratio and contact width, with intervals."""

from lube.ensemble import gather_map
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
batches = [load(path, "master_batch", study) for path in snakemake.input.batches]
save(gather_map(batches), snakemake.output[0], "master", study, [snakemake.input.film])
