"""Draw one batch of roughness lines for the contact stage."""

from lube.io import save
from lube.jobs import begin_job
from lube.roughness import roughness_batch
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
batch = study.batch(int(snakemake.wildcards.first))
lines = roughness_batch(study.line_spec, study.seed, batch)
save(lines, snakemake.output[0], "roughness_batch", study, compress=False)
