# The study, checked before any job, and the helpers that all rules share.
import atexit
import os
import sys
from pathlib import Path

# The lube of this folder, even if another clone is installed: the files watched for changes are
# the files that run.
sys.path.insert(0, str(workflow.basedir))

from lube.schema import DATASETS
from lube.storage.files import check_writable
from lube.workflow.command_line import study_of_command
from lube.workflow.environment import compute_alike, use_package
from lube.workflow.sources import script_sources
from lube.workflow.study_files import StudyFiles, digest, one_line_errors

# For all jobs.
use_package(workflow.basedir)
compute_alike()

with one_line_errors():
    STUDY, config["study"] = study_of_command(workflow.configfiles, workflow.config_settings.config)

FILES = StudyFiles(STUDY, **config["study"])
RESULTS = FILES.folder
result = FILES.result
stage_files = FILES.stage_files
stage_inputs = FILES.stage_inputs
record_files = FILES.record_files
measured_files = FILES.measured_files
batches_of = FILES.batches_of
batch_limits = FILES.batch_limits


onstart:
    # In a folder that cannot be written Snakemake itself ends in a traceback.
    with one_line_errors():
        check_writable(RESULTS)


onsuccess:
    # At exit, so that it is the last line of the run.
    if refused := FILES.refused_records():
        atexit.register(print, refused, file=sys.stderr)
