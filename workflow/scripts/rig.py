"""Make rig.nc: what the simulated rig logs at the trace points."""

from lube.experiment import rig_records
from lube.io import load, opened, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
with opened(snakemake.input.lines, "roughness_batch") as lines:
    records = rig_records(lines, load(snakemake.input.film, "film"), study)
save(records, snakemake.output[0], "rig", study)
