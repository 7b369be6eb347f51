"""Make contact.nc: all realisations side by side, and the interval of every probability."""

from lube.ensemble import gather
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
batches = [load(path, "contact_batch") for path in snakemake.input.batches]
contact = gather(batches, load(snakemake.input.film, "film"))
save(contact, snakemake.output[0], "contact", study)
