"""Make tail.nc: probability and rate of contact at any rarity."""

from lube.stages.tail import tail_probabilities
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
tail = tail_probabilities(
    study.line_spec,
    load(snakemake.input.film, "film", study),
    study.boundary_layer,
    study.seed,
    study.operating_grid.slide_to_roll_ratio,
    snakemake.threads,
    study.is_flattened,
)
save(tail, snakemake.output[0], "tail", study, [snakemake.input.film])
