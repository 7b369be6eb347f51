"""Make surface.nc: the measured topographies of the rollers, described."""

from lube.stages.surface import measured_surfaces
from lube.storage.netcdf import save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
hurst_exponent = study.roughness.hurst_exponent
surfaces = measured_surfaces(study.topographies, study.line_spec, hurst_exponent)
save(surfaces, snakemake.output[0], "surface", study, snakemake.input.topographies)
