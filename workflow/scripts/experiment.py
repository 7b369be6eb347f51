"""Make experiment.nc: contact shares of measured or simulated records."""

from lube.recordings.manifest import read_manifest
from lube.stages.experiment import measured_experiment, simulated_experiment
from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
if study.experiment.manifest:
    experiment = measured_experiment(read_manifest(study.experiment.manifest), study)
else:
    film = load(snakemake.input.film, "film", study)
    lines = roughness_batch(study.line_spec, study.seed, study.rig_realisations)
    experiment = simulated_experiment(lines, film, study)
save(
    experiment,
    snakemake.output[0],
    "experiment",
    study,
    [snakemake.input.film, *snakemake.input.records],
)
