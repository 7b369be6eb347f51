"""Make comparison.nc: simulation and records side by side, and how far they agree."""

from lube.comparison import compare
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
inputs = {kind: snakemake.input[kind] for kind in ("contact", "experiment")}
contact, experiment = (load(path, kind, study) for kind, path in inputs.items())
save(compare(contact, experiment), snakemake.output[0], "comparison", study, inputs.values())
