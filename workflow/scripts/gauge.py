"""Make gauge.nc: film, pressure-viscosity coefficient and boundary layer from the records."""

from lube.stages.gauge import gauge_records
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
inputs = {kind: snakemake.input[kind] for kind in ("master", "contact", "comparison")}
datasets = (load(path, kind, study) for kind, path in inputs.items())
save(gauge_records(*datasets), snakemake.output[0], "gauge", study, inputs.values())
