# The study, checked before any job, and the helpers that all rules share.
import atexit
import os
import sys
from pathlib import Path

# The lube of this repository, even if another clone is installed: the files watched for changes are
# the files that run. The Snakefile in use may be another one, of which this is a module.
sys.path.insert(0, str(Path(workflow.snakefile).parents[2]))

from lube.storage.files import check_writable
from lube.storage.git import ROOT
from lube.pipeline.command_line import study_of_command, study_of_module
from lube.pipeline.environment import compute_alike, use_package
from lube.pipeline.sources import from_here, script_sources, stage_sources
from lube.pipeline.study_files import StudyFiles, digest, one_line_errors

# The environment of all jobs.
use_package(ROOT)
compute_alike()

IS_MODULE = not workflow.modifier.is_main_snakefile()
with one_line_errors():
    if IS_MODULE:
        STUDY, SOURCE = study_of_module(config)
    else:
        STUDY, SOURCE = study_of_command(workflow.configfiles, workflow.config_settings.config)

# The scripts and the report use it. The dictionary of another Snakefile stays unchanged.
config = {**config, "study": SOURCE | STUDY.readings}
FILES = StudyFiles(STUDY, **SOURCE)
RESULTS = FILES.folder
result = FILES.result


onstart:
    # Snakemake itself ends in a traceback if it cannot write to the folder.
    with one_line_errors():
        check_writable(RESULTS)


onsuccess:
    # At exit, so that it is the last line of the run.
    if refused := FILES.refused_records():
        atexit.register(print, refused, file=sys.stderr)
