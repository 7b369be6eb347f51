"""Make roughness.nc: the kept realisations of the roughness lines, with their moments."""

from lube.stages.roughness import roughness_lines
from lube.storage.netcdf import save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
lines = roughness_lines(study.line_spec, study.seed, study.kept_realisations)
save(lines, snakemake.output[0], "roughness", study)
