"""Make film_plane.nc: the computed film over Moes' numbers, and the error of each formula."""

from lube.stages.film_plane import film_plane
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
lubricant = load(snakemake.input.lubricant, "lubricant", study)
plane = film_plane(lubricant, study.rollers.reduced_modulus)
save(plane, snakemake.output[0], "film_plane", study, [snakemake.input.lubricant])
