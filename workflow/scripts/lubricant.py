"""Make lubricant.nc: properties of every lubricant at the study's temperatures."""

from lube.stages.lubricant import lubricant_table
from lube.storage.netcdf import save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
table = lubricant_table(study.lubricants, study.operating_grid.temperature)
# Not the records themselves: with another title the file stays the same, and what is made from it.
save(table, snakemake.output[0], "lubricant", study)
