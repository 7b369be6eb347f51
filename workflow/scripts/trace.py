"""Make trace.nc: contact length and resistance at every step of one revolution."""

from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study
from lube.trace import contact_trace

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
trace = contact_trace(
    load(snakemake.input.lines, "roughness", study),
    load(snakemake.input.film, "film", study),
    study.trace_points,
    study.boundary_layer,
    study.resistivity,
)
save(trace, snakemake.output[0], "trace", study, [snakemake.input.lines, snakemake.input.film])
