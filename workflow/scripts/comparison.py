"""Make comparison.nc: simulation and records side by side, and how far they agree."""

import numpy as np

from lube.rig.at_records import model_at_records
from lube.stages.comparison import compare
from lube.stages.film import film_at_records
from lube.stages.lubricant import lubricant_table
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
inputs = {kind: snakemake.input[kind] for kind in ("film", "contact", "experiment")}
film, contact, experiment = (load(path, kind, study) for kind, path in inputs.items())
oils = lubricant_table(study.lubricants, np.unique(experiment["temperature"]))
at_records = film_at_records(
    experiment,
    oils,
    study.rough_rollers,
    study.film_formulas,
    **study.film_model,
)
model = model_at_records(at_records, experiment, film, contact, study)
result = compare(model, experiment, contact)
save(result, snakemake.output[0], "comparison", study, inputs.values())
