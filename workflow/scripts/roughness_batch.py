"""Draw one batch of roughness lines for the contact stage."""

from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
batch = study.batch(int(snakemake.wildcards.first))
lines = roughness_batch(study.line_spec, study.seed, batch)
save(lines, snakemake.output[0], "roughness_batch", study, compress=False)
