"""Draw one batch of roughness lines and run the contact model on them.

One job for both results: the lines never leave its memory, and Python starts once.
"""

from lube.stages.contact import contact_map, contact_statistics
from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
film = load(snakemake.input.film, "film", study)
batch = study.batch(int(snakemake.wildcards.first))
lines = roughness_batch(study.line_spec, study.seed, batch)
run = study.operating_grid.slide_to_roll_ratio, study.revolutions, study.is_flattened
contact = contact_statistics(lines, film, study.boundary_layer, *run)
save(contact, snakemake.output.contact, "contact_batch", study, [snakemake.input.film])
if study.has("master"):
    master = contact_map(lines, film, study.boundary_layer)
    save(master, snakemake.output.master, "master_batch", study, [snakemake.input.film])
