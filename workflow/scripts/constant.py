"""Make constant.nc: contact by the paper's Eq. 3, by its source, and by the computed film."""

from lube.stages.constant import constant_effect
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
kinds = ("lubricant", "film", "master")
files = [snakemake.input[kind] for kind in kinds]
effect = constant_effect(*(load(*each, study) for each in zip(files, kinds, strict=True)))
save(effect, snakemake.output[0], "constant", study, files)
