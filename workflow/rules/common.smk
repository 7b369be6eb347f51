# The study's configuration, checked before any job, and the helpers all rules share.
import ast
import atexit
import hashlib
import json
import os
import sys
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(workflow.basedir)

# Jobs and notebooks take the lube beside this workflow, never another clone's that happens
# to be installed: the files watched for changes are then the files that run.
sys.path.insert(0, str(ROOT))
elsewhere = dict(os.environ).get("PYTHONPATH")
os.environ.update(PYTHONPATH=os.pathsep.join(filter(None, [str(ROOT), elsewhere])))

import lube
from lube.workflow.processors import compute_alike

# For all jobs, before one of them imports NumPy.
compute_alike()

from lube.errors import LubeError
from lube.storage.files import check_writable, cut_within_a_line
from lube.workflow.jobs import SNAKEMAKE
from lube.schema import DATASETS, MEASURED
from lube.study.study import load_study

# Jobs end when this process does.
os.environ[SNAKEMAKE] = str(os.getpid())

# Where the report has its pages, apart from the figures.
ABOUT_THE_STUDY = "About the study"


@contextmanager
def told_in_one_line():
    """End Snakemake before any job, with one line, if the study is not fit to start."""
    try:
        yield
    except LubeError as error:
        sys.exit(f"The study cannot start. {error}")


def check_name(path):
    """Refuse a name that Snakemake would take for a wildcard, or no list could hold in a line."""
    if "{" in path or "}" in path:
        raise LubeError(f"{path}: got a name with braces, need one without")
    if not path.isprintable():
        raise LubeError(f"{path}: got a name with an invisible character, need one without")


def the_study_file():
    """The one file a study is read from: --configfile, or else the paper's."""
    if workflow.config_settings.config:
        raise LubeError("--config is not used: write the change into a copy of the study's file")
    if len(workflow.configfiles) > 1:
        raise LubeError("got several --configfile, need one: a study is one file")
    study_file = str((workflow.configfiles or ["workflow/config/paper.yaml"])[0])
    check_name(study_file)
    return study_file


with told_in_one_line():
    config["study_file"] = the_study_file()
    STUDY = load_study(config["study_file"])

RESULTS = f"results/{STUDY.name}"


def result(name):
    """Path of a result of this study."""
    return f"{RESULTS}/{name}"


def digest(content):
    """Fingerprint of plain data; as a parameter of a rule, its change re-runs the rule."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def stage_inputs(*stages):
    """Fingerprint of the study's values that a file depends on, and of what it says of itself."""
    values = [STUDY.stage_inputs(stage) for stage in stages]
    return digest([*values, STUDY.about.in_files])


def imported_modules(code):
    """Names of the modules that a piece of Python imports, as far as they may be lube's."""
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom) and node.module:
            # `from lube import io`, `from lube import load` and `from lube.storage.netcdf import load`
            # all mean lube.storage.netcdf: the package's public names come from their home modules.
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from [node.module, *names]
            if node.module == "lube":
                yield from filter(None, (lube._HOME_OF.get(alias.name) for alias in node.names))
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
            if any(alias.name == "lube" for alias in node.names):
                yield from lube._HOMES


def sources(code):
    """Files of the lube package that some code depends on, by following its imports."""
    # The study reaches a stage through its values only, and those are parameters of its rule.
    found, waiting = {ROOT / "lube/study/study.py"}, list(imported_modules(code))
    while waiting:
        path = ROOT / Path(*waiting.pop().split("."))
        path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
        if path.is_relative_to(ROOT / "lube") and path.is_file() and path not in found:
            found.add(path)
            waiting += imported_modules(path.read_text(encoding="utf-8"))
    # The package's __init__ names everything and computes nothing.
    found -= {ROOT / "lube/__init__.py", ROOT / "lube/study/study.py"}
    return sorted(str(path.relative_to(ROOT)) for path in found)


def script_sources(name):
    """Files of the lube package that a script of the workflow depends on."""
    return sources((ROOT / f"workflow/scripts/{name}.py").read_text(encoding="utf-8"))


def input_paths(files):
    """Paths of files that a study names, told from here so that the tree can be moved."""
    paths = sorted({os.path.relpath(file) for file in files})
    with told_in_one_line():
        for path in paths:
            check_name(path)
    return paths


def record_files():
    """Files of the study's lubricant records."""
    return input_paths(file for record in STUDY.lubricants for file in record.files)


def measured_files():
    """Manifest and measured records, as far as there are any; what is missing is told later."""
    if STUDY.experiment.manifest is None:
        return []
    from lube.recordings.manifest import read_manifest

    with told_in_one_line():
        entries = read_manifest(STUDY.experiment.manifest).entries
    files = (entry.file for entry in entries if entry.file)
    return input_paths([STUDY.experiment.manifest, *files])


def archived_texts():
    """What people wrote and an archive holds: the study's file, its records, the code."""
    from lube.archive.build import written_files
    from lube.archive.citation import check_about
    from lube.storage.git import code_files

    with told_in_one_line():
        check_about(STUDY)
        written = written_files(STUDY, config["study_file"]).values()
    return [*input_paths(written), *record_files(), *code_files()]


def state_of_code():
    """What an archive says of its code besides the code itself."""
    from lube.storage.git import changed_code, commit, commit_date

    return commit(), commit_date(), changed_code()


def batch_limits(wildcards):
    """First and last realisation of a batch."""
    batch = STUDY.batch(int(wildcards.first))
    return batch[0], batch[-1]


def tell_refused_records():
    """Name the records that were refused, and why, in the very last line of the run."""
    experiment = Path(result("experiment.nc"))
    if STUDY.experiment.manifest is None or not experiment.exists():
        return
    from lube.storage.netcdf import load
    from lube.rig.study_shares import refused_in_one_line

    told = refused_in_one_line(load(experiment, "experiment"))
    if told:
        # When Snakemake has said all that it has to say.
        atexit.register(print, told, file=sys.stderr)


onstart:
    with told_in_one_line():
        check_writable(RESULTS)  # Snakemake would end in a traceback
    for file in [config["study_file"], *record_files(), *measured_files()]:
        if cut_within_a_line(file):
            told = (
                "its last line has no end; if the file was cut short, its last value is wrong"
            )
            print(f"Warning: {file}: {told}", file=sys.stderr)


onsuccess:
    tell_refused_records()
