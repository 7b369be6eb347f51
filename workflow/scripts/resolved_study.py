"""Write the whole study as a single file, based on no other."""

from pathlib import Path

from lube.pipeline.jobs import begin_job
from lube.storage.files import write_text
from lube.study.resolve import resolved_text

begin_job(snakemake.log[0])
output, study = Path(snakemake.output[0]), snakemake.config["study"]
write_text(output, resolved_text(study["path"], study["changes"], output.parent))
