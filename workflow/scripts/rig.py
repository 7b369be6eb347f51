"""Make rig.nc: records of the simulated rig at the trace points, and shares by bandwidth."""

from lube.stages.rig import rig_records
from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
lines = roughness_batch(study.line_spec, study.seed, study.rig_realisations)
records = rig_records(lines, load(snakemake.input.film, "film", study), study)
save(records, snakemake.output[0], "rig", study, [snakemake.input.film])
