"""Make the dataset of a stage, by the function `make` of its module in `lube/stages`."""

from pathlib import Path

from lube.pipeline.jobs import study_of_job
from lube.schema import STAGES
from lube.stages import maker
from lube.storage.netcdf import load, save

study = study_of_job(snakemake)
# The stage follows from the file, because the rule has a prefix in a module of another workflow.
stage = STAGES[Path(snakemake.output[0]).stem]
files = {kind: snakemake.input[kind] for kind in study.inputs_of(stage.name)}
inputs = {kind: load(path, kind, study) for kind, path in files.items()}
batches = [load(path, f"{stage.name}_batch", study) for path in snakemake.input.batches]
dataset = maker(stage.name)(study, {**inputs, "batches": batches}, snakemake.threads)
# The batches are left out, because the number of batches changes nothing.
made_from = [*files.values(), *snakemake.input.written]
save(dataset, snakemake.output[0], stage.name, study, made_from)
