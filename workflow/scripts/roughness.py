"""Make roughness.nc: the kept realisations of the roughness lines, with their moments."""

from lube.io import save
from lube.jobs import begin_job
from lube.roughness import roughness_lines
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
lines = roughness_lines(study.line_spec, study.seed, study.kept_realisations)
save(lines, snakemake.output[0], "roughness", study)
