"""Imports go one way, as the architecture says, and the public names are there."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import lube
import lube.stages
from lube.lazy import homes

PACKAGE = Path(lube.__file__).parent
MODULES = {
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): path
    for path in PACKAGE.rglob("*.py")
    if path.name != "__init__.py"
}

# A folder, or a module beside them, imports from those of the floors before its own.
FLOORS = [
    {"errors", "types", "lazy", "threads"},
    {"kernels", "digits"},
    {"units", "schema", "physics", "statistics", "surfaces"},
    {"ehl"},
    {"grid"},
    {"study"},
    {"contact"},
    {"rig", "inference", "sensitivity", "verification", "storage"},
    {"recordings"},
    {"stages"},
    {"report"},
    {"pipeline"},
    {"archive", "plots"},
    {"calculator"},
    {"commands", "explorer"},
    {"cli"},
]
FLOOR_OF = {room: number for number, floor in enumerate(FLOORS) for room in floor}
MATHEMATICS = ("physics", "ehl", "statistics", "surfaces")


def imported(path):
    """Names of all modules that a file imports, wherever in the file, from the package or not."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: the workflow does not follow relative imports"
            if node.module == "lube":
                yield from (f"lube.{alias.name}" for alias in node.names)
            else:
                yield node.module


def room(module):
    """The folder, or the module beside the folders, that a full name means."""
    return module.split(".")[1]


def own_imports(path):
    return {room(name) for name in imported(path) if name.startswith("lube.")}


def outside_imports(path):
    return {name.split(".")[0] for name in imported(path)} - {"lube"}


def test_imports_go_down_the_floors_only():
    assert {room(module) for module in MODULES} == set(FLOOR_OF)
    for module, path in MODULES.items():
        for other in own_imports(path) - {room(module)}:
            assert FLOOR_OF[other] < FLOOR_OF[room(module)], f"{module} imports {other}"
        if room(module) == "stages":
            assert "stages" not in own_imports(path), f"{module} imports another stage"


def test_kernels_import_numpy_and_numba_only_and_the_mathematics_no_datasets():
    for module, path in MODULES.items():
        outside = outside_imports(path)
        if room(module) == "kernels" and module != "lube.kernels.compiler":
            assert outside <= {"numpy", "numba", "math", "typing"}, module
        if room(module) in MATHEMATICS:
            assert not outside & {"xarray", "netCDF4", "matplotlib", "numba"}, module


def loaded_after(statement):
    """Packages that a fresh Python has loaded after one statement."""
    listing = subprocess.run(
        [sys.executable, "-c", f"{statement}; import sys; print(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    return {name.split(".")[0] for name in listing.stdout.split()}


@pytest.mark.parametrize(
    ("statement", "heavy"),
    [
        ("import lube", {"numpy", "xarray", "numba", "pydantic", "pint"}),
        # The command switches off functions of NumPy, which must not be loaded by then.
        ("import lube.cli", {"numpy"}),
        (
            "import lube.pipeline.command_line, lube.pipeline.study_files, lube.archive.inputs",
            {"xarray", "numba", "matplotlib", "netCDF4", "scipy", "CoolProp", "papermill"},
        ),
        (
            "import lube; lube.Oil, lube.contact_probability, lube.required_film, lube.duty",
            {"snakemake", "papermill", "nbformat", "rocrate", "docutils", "markdown_it"},
        ),
        ("import lube.pipeline.figure_list", {"xarray", "nbformat", "papermill", "docutils"}),
    ],
)
def test_what_is_imported_at_every_start_is_light(statement, heavy):
    assert not loaded_after(statement) & heavy


@pytest.mark.parametrize(
    ("package", "modules"), [(lube, ["stages", "types"]), (lube.stages, [])], ids=["lube", "stages"]
)
def test_every_public_name_resolves_and_explains_itself(package, modules):
    known = homes(package.__name__)
    assert dir(package) == sorted([*known, *modules])
    for name, home in known.items():
        public = getattr(package, name)
        if callable(public):
            assert inspect.getdoc(public), name
            assert public.__module__ == home
    with pytest.raises(AttributeError, match="no attribute 'nope'"):
        _ = package.nope


def test_every_module_explains_itself():
    for path in PACKAGE.rglob("*.py"):
        assert ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))), path


def test_the_architecture_names_every_room():
    page = (PACKAGE.parent / "docs/architecture.md").read_text(encoding="utf-8")
    rooms = {line.split("`")[1].strip("/") for line in page.splitlines() if line.startswith("| `")}
    folders = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert folders <= rooms
