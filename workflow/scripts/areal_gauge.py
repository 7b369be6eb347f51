"""Make areal_gauge.nc: films from the records, by the surface and by the line."""

from lube.stages.areal_gauge import gauge_by_surface
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
inputs = {kind: snakemake.input[kind] for kind in ("film", "areal", "comparison", "gauge")}
datasets = (load(path, kind, study) for kind, path in inputs.items())
save(gauge_by_surface(*datasets), snakemake.output[0], "areal_gauge", study, inputs.values())
