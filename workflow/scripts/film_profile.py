"""Make film_profile.nc: pressure and film across the contact, computed."""

from lube.stages.film import film_profile_table
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
grid = study.operating_grid
lubricant = load(snakemake.input.lubricant, "lubricant", study)
profiles = film_profile_table(
    lubricant,
    study.rough_rollers,
    grid.force,
    grid.speed,
    study.film_model["inlet_meniscus"],
)
save(profiles, snakemake.output[0], "film_profile", study, [snakemake.input.lubricant])
