"""Make film_shape.nc: probability of contact under flat films and under the computed one."""

from lube.stages.film_shape import film_shape_probabilities
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
inputs = snakemake.input
shapes = film_shape_probabilities(
    study.line_spec,
    load(inputs.film, "film", study),
    load(inputs.film_profile, "film_profile", study),
    study.boundary_layer,
    study.seed,
    snakemake.threads,
)
save(shapes, snakemake.output[0], "film_shape", study, [inputs.film, inputs.film_profile])
