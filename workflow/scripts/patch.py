"""Make patch.nc: surfaces pressed against a flat, and the lines that stand for them."""

from lube.stages.patch import patch_contact
from lube.storage.netcdf import save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
patch = patch_contact(study.line_spec, study.rollers.reduced_modulus, study.seed)
save(patch, snakemake.output[0], "patch", study)
