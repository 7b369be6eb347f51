"""Draw one batch of roughness lines and run the contact model on them.

One job makes both results, so the lines stay in memory and Python starts once.
"""

from lube.contact.rough_pair import roughness_batch
from lube.pipeline.jobs import study_of_job
from lube.stages import contact, master
from lube.storage.netcdf import load, save

study = study_of_job(snakemake)
film = load(snakemake.input.film, "film", study)
lines = roughness_batch(study.line_spec, study.seed, study.batch(int(snakemake.wildcards.first)))
stages = {"contact": contact, "master": master}
for name, path in snakemake.output.items():
    made = stages[name].make_batch(study, film, lines)
    save(made, path, f"{name}_batch", study, [snakemake.input.film])
