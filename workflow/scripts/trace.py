"""Make trace.nc: contact length and resistance at every step of one revolution."""

from lube.contact import contact_trace
from lube.io import load, save
from lube.study import load_study

study = load_study(snakemake.config["study_file"])
trace = contact_trace(
    load(snakemake.input.lines, "roughness"),
    load(snakemake.input.film, "film"),
    study.trace_points,
    study.rollers.reduced_modulus,
    study.boundary_layer,
    study.resistivity,
)
save(trace, snakemake.output[0], "trace", study)
