"""Make gauge.nc: the films, and the one unknown of the model, that explain the records."""

from lube.gauge import gauge_records
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
kinds = ("master", "film", "contact", "experiment")
inputs = {kind: snakemake.input[kind] for kind in kinds}
datasets = (load(path, kind, study) for kind, path in inputs.items())
save(gauge_records(*datasets), snakemake.output[0], "gauge", study, inputs.values())
