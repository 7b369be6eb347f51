"""Execute one figure's notebook on the study's datasets."""

from pathlib import Path

from lube.pipeline.figures import draw_figure
from lube.pipeline.jobs import begin_job
from lube.storage.git import ROOT

begin_job(snakemake.log[0])
notebook, results = snakemake.input.notebook, Path(snakemake.output.notebook).parents[1]
code = [*snakemake.input.sources, str(ROOT / "workflow/scripts/figure.py")]
draw_figure(notebook, snakemake.input.datasets, code, results)
