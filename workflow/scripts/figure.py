"""Execute one figure's notebook on the study's datasets."""

from pathlib import Path

from lube.jobs import begin_job
from lube.notebooks import execute_notebook

begin_job(snakemake.log[0])
datasets = {Path(path).stem: path for path in snakemake.input.datasets}
execute_notebook(
    snakemake.input.notebook,
    snakemake.output.notebook,
    {**datasets, "figure": str(Path(snakemake.output[0]).with_suffix(""))},
)
