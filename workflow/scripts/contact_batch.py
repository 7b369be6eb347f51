"""Run the contact model on one batch of realisations, at all operating points."""

from lube.stages.contact import contact_statistics
from lube.storage.netcdf import load, opened, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
film = load(snakemake.input.film, "film", study)
with opened(snakemake.input.lines, "roughness_batch", study) as lines:
    ratios = study.operating_grid.slide_to_roll_ratio
    run = contact_statistics(lines, film, study.boundary_layer, ratios, study.revolutions)
save(run, snakemake.output[0], "contact_batch", study, [snakemake.input.film])
