"""Execute one figure's notebook on the study's datasets."""

from pathlib import Path

from lube.notebooks import execute_notebook

datasets = {Path(path).stem: path for path in snakemake.input.datasets}
execute_notebook(
    snakemake.input.notebook,
    snakemake.output.notebook,
    {**datasets, "figure": str(Path(snakemake.output[0]).with_suffix(""))},
)
