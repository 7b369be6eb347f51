"""Make height_distribution.nc: probabilities by skewness and kurtosis of the heights."""

from lube.stages.height_distribution import height_distributions
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
film = load(snakemake.input.film, "film", study)
found = height_distributions(
    study.line_spec, film, study.boundary_layer, study.seed, snakemake.threads
)
save(found, snakemake.output[0], "height_distribution", study, [snakemake.input.film])
