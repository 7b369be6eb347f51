"""Make one batch of the sensitivity study's direct runs."""

from lube.pipeline.jobs import study_of_job
from lube.stages import sensitivity_runs
from lube.storage.netcdf import load, save

study = study_of_job(snakemake)
files = {kind: snakemake.input[kind] for kind in ("sensitivity_responses",) if study.has(kind)}
inputs = {kind: load(path, kind, study) for kind, path in files.items()}
batch = sensitivity_runs.make_batch(study, inputs, int(snakemake.wildcards.number))
save(batch, snakemake.output[0], "sensitivity_runs_batch", study, [*files.values()])
