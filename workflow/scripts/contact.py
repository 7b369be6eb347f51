"""Make contact.nc: all realisations side by side, and the interval of every probability."""

from lube.stages.ensemble import gather
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
batches = [load(path, "contact_batch", study) for path in snakemake.input.batches]
contact = gather(batches, load(snakemake.input.film, "film", study))
# The batches are left out: how many there are changes nothing.
save(contact, snakemake.output[0], "contact", study, [snakemake.input.film])
