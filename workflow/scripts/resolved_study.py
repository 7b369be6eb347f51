"""Write the whole study as a single file, based on no other."""

from pathlib import Path

from lube.pipeline.jobs import begin_job
from lube.storage.files import written_whole
from lube.study.resolve import resolved_text

begin_job(snakemake.log[0])
output, study = Path(snakemake.output[0]), snakemake.config["study"]
with written_whole(output) as part:
    part.write_text(resolved_text(study["path"], study["changes"], output.parent), encoding="utf-8")
