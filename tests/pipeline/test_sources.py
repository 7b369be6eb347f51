"""Which files of the package a script depends on, by following its imports."""

import pytest

from lube.pipeline.sources import ROOT, imported_modules, script_sources, sources, stage_sources
from lube.schema import STAGES

MADE = [name for name, stage in STAGES.items() if stage.target != "benchmark"]
SCRIPTS = sorted(path.stem for path in (ROOT / "workflow/scripts").glob("*.py"))


@pytest.fixture
def package(tmp_path):
    """Write a package `lube` of some modules, and return the folder it lies in."""

    def write(modules):
        for name, code in modules.items():
            path = tmp_path / "lube" / f"{name}.py"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(code, encoding="utf-8")
        return tmp_path

    return write


def test_imports_are_found_wherever_they_are():
    code = "import ast\ndef f():\n    from lube.stages import film\n"
    assert imported_modules(code) == ("ast", "lube.stages", "lube.stages.film")
    some = imported_modules("from lube import load\nimport math\n")
    assert some == ("lube", "lube.load", "lube.storage.netcdf", "math")


def test_a_public_name_means_the_module_that_defines_it():
    assert "lube/contact/ensemble.py" in sources("from lube.stages import gather")
    assert "lube/contact/ensemble.py" in sources("import lube\nlube.gather([])")


def test_imports_are_followed_through_modules_and_packages(package):
    room = {"b/__init__": "from lube.d import x", "b/c": "import numpy"}
    circle = {"e": "import lube.f", "f": "import lube.e"}
    root = package(room | circle | {"a": "import lube.b.c", "d": ""})
    assert sources("import lube.a", root) == ["lube/a.py", "lube/b/c.py"]
    expected = ["lube/b/__init__.py", "lube/b/c.py", "lube/d.py"]
    assert sources("from lube.b import c", root) == expected
    assert sources("import lube.e", root) == ["lube/e.py", "lube/f.py"]


def test_the_study_and_the_registry_are_left_out_because_their_values_are_parameters(package):
    study = {"study/study": "import lube.units", "schema/stages": "", "units": ""}
    root = package(study | {"a": "import lube.study.study"})
    assert sources("import lube.a, lube.schema.stages", root) == ["lube/a.py"]
    for files in [*map(script_sources, SCRIPTS), *map(stage_sources, MADE)]:
        assert not {"lube/study/study.py", "lube/__init__.py"} & set(files)


def test_a_module_is_a_source_of_the_scripts_and_stages_that_use_it():
    def users(module):
        found = {name for name in SCRIPTS if f"lube/{module}.py" in script_sources(name)}
        return found | {name for name in MADE if f"lube/{module}.py" in stage_sources(name)}

    assert users("stages/trace") == {"trace"}
    assert users("plots") == {"explorer"}
    of_figures = script_sources("figure", "from lube import plots")
    assert {"lube/plots.py", "lube/plots.mplstyle"} <= set(of_figures)
    assert not {"lube/plots.mplstyle"}.intersection(*map(stage_sources, MADE))
    assert {"batch", "trace", "rig", "experiment"} <= users("kernels/layer")
    assert "figure" in users("pipeline/notebooks")
    assert users("pipeline/jobs") == {*SCRIPTS, *MADE}
    assert {"lube/schema/files.csv", "lube/schema/variables.csv"} <= set(stage_sources("film"))
    assert "lube/explorer/templates/explorer.html" in script_sources("explorer")
    assert not {"lube/report/templates/page.html"}.intersection(*map(stage_sources, MADE))
