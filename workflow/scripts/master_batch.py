"""Run the contact model on one batch of realisations, over all films and windows it spans."""

from lube.stages.contact import contact_map
from lube.storage.netcdf import load, opened, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
film = load(snakemake.input.film, "film", study)
with opened(snakemake.input.lines, "roughness_batch", study) as lines:
    run = contact_map(lines, film, study.boundary_layer)
save(run, snakemake.output[0], "master_batch", study, [snakemake.input.film])
