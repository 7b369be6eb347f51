"""Make flattening.nc: contact of lines as drawn and as the oil flattens them."""

from lube.stages.flattening import flattened_contact
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
flattening = flattened_contact(
    study.line_spec,
    load(snakemake.input.film, "film", study),
    study.boundary_layer,
    study.seed,
    range(study.realisations),
    snakemake.threads,
)
save(flattening, snakemake.output[0], "flattening", study, [snakemake.input.film])
