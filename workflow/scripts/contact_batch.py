"""Run the contact model on one batch of realisations, at all operating points."""

from lube.contact import contact_statistics
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
statistics = contact_statistics(
    load(snakemake.input.lines, "roughness_batch", raw=True),
    load(snakemake.input.film, "film"),
    study.boundary_layer,
    study.operating_grid.slide_to_roll_ratio,
    study.revolutions,
)
save(statistics, snakemake.output[0], "contact_batch", study)
