"""Make the archive of a study: a folder and its zip."""

from pathlib import Path

from lube.archive.build import make_archive
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study_file, sums = snakemake.config["study_file"], Path(snakemake.output.sums)
kinds, figures = snakemake.params.kinds, snakemake.params.figures
study, results = load_study(study_file), sums.parents[2]
make_archive(study, study_file, results, kinds, figures, sums.parent)
