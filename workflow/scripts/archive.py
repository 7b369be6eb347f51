"""Make the archive of a study: a folder and its zip."""

from pathlib import Path

from lube.archive.build import make_archive
from lube.pipeline.jobs import study_of_job

study, study_file = study_of_job(snakemake), snakemake.config["study"]["path"]
sums = Path(snakemake.output.sums)
make_archive(study, study_file, sums.parents[2], snakemake.params.figures, sums.parent)
