"""Make the archive of a study: a folder and its zip."""

from pathlib import Path

from lube.archive.build import make_archive
from lube.pipeline.jobs import begin_job
from lube.study.study import load_study

begin_job(snakemake.log[0])
study, study_file = load_study(**snakemake.config["study"]), snakemake.config["study"]["path"]
sums = Path(snakemake.output.sums)
make_archive(study, study_file, sums.parents[2], snakemake.params.figures, sums.parent)
