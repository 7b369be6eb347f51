"""Make comparison.nc: simulation and records side by side, and how far they agree."""

from lube.at_records import model_at_records
from lube.comparison import compare
from lube.io import load, save
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study = load_study(snakemake.config["study_file"])
inputs = {kind: snakemake.input[kind] for kind in ("film", "contact", "experiment")}
film, contact, experiment = (load(path, kind, study) for kind, path in inputs.items())
model = model_at_records(experiment, film, contact, study)
result = compare(model, experiment, contact)
save(result, snakemake.output[0], "comparison", study, inputs.values())
