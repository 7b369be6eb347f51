"""Make explorer.html, a page that shows any operating point of the study."""

from lube.explorer import explored
from lube.explorer.page import explorer_page
from lube.pipeline.jobs import study_of_job
from lube.storage.files import write_text
from lube.storage.netcdf import load

study = study_of_job(snakemake)
kinds = explored(study, snakemake.input.keys())
datasets = {kind: load(snakemake.input[kind], kind, study) for kind in kinds}
is_heated = study.inlet_shear_heating != "none"
write_text(snakemake.output[0], explorer_page(datasets, study.band, is_heated))
