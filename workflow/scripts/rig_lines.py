"""Draw the roughness lines of the simulated rig's own rollers."""

from lube.io import save
from lube.jobs import begin_job
from lube.roughness import roughness_batch
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
lines = roughness_batch(study.line_spec, study.seed, study.rig_realisations)
save(lines, snakemake.output[0], "roughness_batch", study, compress=False)
