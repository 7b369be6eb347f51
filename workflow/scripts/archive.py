"""Make the archive of a study: a folder and its zip."""

from lube.archive import make_archive
from lube.jobs import begin_job
from lube.study import load_study

begin_job(snakemake.log[0])
study_file = snakemake.config["study_file"]
make_archive(
    load_study(study_file),
    study_file,
    snakemake.params.results,
    snakemake.params.kinds,
    snakemake.params.figures,
    snakemake.params.folder,
)
