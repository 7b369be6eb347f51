# The study's configuration, checked before any job, and the helpers all rules share.
import ast
import hashlib
import json
import sys
from pathlib import Path

from lube.errors import LubeError
from lube.study import load_study

ROOT = Path(workflow.basedir)
DATASETS = ("lubricant", "film", "roughness", "contact", "trace")
FIGURES = sorted(path.stem for path in Path("notebooks").glob("*.ipynb"))


def the_study_file():
    """The one file a study is read from: --configfile, or else the paper's."""
    if workflow.config_settings.config:
        raise LubeError("--config is not used: write the change into a copy of the study's file")
    if len(workflow.configfiles) > 1:
        raise LubeError("got several --configfile, need one: a study is one file")
    return (workflow.configfiles or [Path("workflow/config/paper.yaml")])[0]


try:
    config["study_file"] = str(the_study_file())
    STUDY = load_study(config["study_file"])
except LubeError as error:
    sys.exit(f"The study cannot start. {error}")

RESULTS = f"results/{STUDY.name}"


def result(name):
    """Path of a result of this study."""
    return f"{RESULTS}/{name}"


def stage_inputs(stage):
    """Digest of the study's values that a stage depends on: a change re-runs the stage."""
    inputs = json.dumps(STUDY.stage_inputs(stage), sort_keys=True)
    return hashlib.sha256(inputs.encode()).hexdigest()


def imported_modules(source):
    """Names of the modules of the lube package that a piece of Python imports."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.module:
            # `from lube import io` and `from lube.io import load` both mean lube.io.
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


def sources(code):
    """Files of the lube package that some code depends on, by following its imports."""
    found, waiting = set(), list(imported_modules(code))
    while waiting:
        path = ROOT / Path(*waiting.pop().split("."))
        path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
        if path.is_relative_to(ROOT / "lube") and path.is_file() and path not in found:
            found.add(path)
            waiting += imported_modules(path.read_text())
    # The package's __init__ names everything and computes nothing.
    return sorted(str(path.relative_to(ROOT)) for path in found - {ROOT / "lube/__init__.py"})


def script_sources(name):
    return sources((ROOT / f"workflow/scripts/{name}.py").read_text())


def notebook_code(figure):
    """The code cells of a figure's notebook: what decides on the figure, outputs do not."""
    cells = json.loads(Path(f"notebooks/{figure}.ipynb").read_text())["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


def notebook_digest(figure):
    return hashlib.sha256("\n".join(notebook_code(figure)).encode()).hexdigest()


def figure_datasets(figure):
    """Datasets that a notebook names in its first code cell, such as `film = "..."`."""
    names = [
        target.id
        for node in ast.parse(notebook_code(figure)[0]).body
        if isinstance(node, ast.Assign)
        for target in node.targets
    ]
    return [result(f"{name}.nc") for name in names if name in DATASETS]


def batch_limits(wildcards):
    """First and last realisation of a batch."""
    batch = STUDY.batch(int(wildcards.first))
    return batch[0], batch[-1]
