"""Make areal.nc: contact of the surfaces that the lines stand for."""

from lube.stages.areal import strip_contacts
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
areal = strip_contacts(
    study.line_spec,
    load(snakemake.input.film, "film", study),
    study.boundary_layer,
    study.rollers.length,
    study.seed,
    study.operating_grid.slide_to_roll_ratio,
    snakemake.threads,
)
save(areal, snakemake.output[0], "areal", study, [snakemake.input.film])
