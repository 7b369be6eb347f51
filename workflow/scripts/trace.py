"""Make trace.nc: contact length and resistance at every step of one revolution."""

import math

from lube.stages.trace import contact_trace
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
trace = contact_trace(
    load(snakemake.input.roughness, "roughness", study),
    load(snakemake.input.film, "film", study),
    study.trace_points,
    study.boundary_layer,
    study.resistivity if study.conducts else math.nan,
    study.is_flattened,
)
save(trace, snakemake.output[0], "trace", study, [snakemake.input.roughness, snakemake.input.film])
