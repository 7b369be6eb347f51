"""Imports go one way, as the architecture says, and the public names are there."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import lube

PACKAGE = Path(lube.__file__).parent
MODULES = {
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): path
    for path in PACKAGE.rglob("*.py")
    if path.name != "__init__.py"
}

# A folder, or a module beside them, imports from those of the floors before its own.
FLOORS = [
    {"errors", "kernels"},
    {"units", "schema", "physics", "statistics", "surfaces"},
    {"grid"},
    {"study"},
    {"rig", "storage"},
    {"recordings"},
    {"stages"},
    {"workflow", "report"},
    {"archive", "plots"},
    {"cli"},
]
FLOOR_OF = {room: number for number, floor in enumerate(FLOORS) for room in floor}


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


def part(module):
    """The module of the package, or the folder of kernels, that a full name means."""
    return module.split(".")[1]


def own_imports(path):
    return {part(name) for name in imported(path) if name.startswith("lube.")}


def outside_imports(path):
    return {name.split(".")[0] for name in imported(path)} - {"lube"}


def test_every_room_has_its_floor():
    assert {part(module) for module in MODULES} == set(FLOOR_OF)


def test_imports_go_down_the_floors_only():
    for module, path in MODULES.items():
        for room in own_imports(path) - {part(module)}:
            assert FLOOR_OF[room] < FLOOR_OF[part(module)], f"{module} imports {room}"


def test_stages_meet_as_datasets_and_never_import_one_another():
    for module, path in MODULES.items():
        if part(module) == "stages":
            assert "stages" not in own_imports(path), module


def test_kernels_know_arrays_and_nothing_else():
    for module, path in MODULES.items():
        if part(module) == "kernels":
            known = {"numpy", "numba", "math"}
            if module == "lube.kernels.compiler":
                known |= {"hashlib", "os", "pathlib"}  # where the compiled kernels are kept
            assert outside_imports(path) <= known, module


def test_the_mathematics_knows_neither_datasets_nor_files():
    for module, path in MODULES.items():
        if part(module) in ("physics", "statistics", "surfaces"):
            outside = outside_imports(path) & {"xarray", "netCDF4", "matplotlib", "numba"}
            assert not outside, f"{module} imports {outside}"


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
        (
            "import lube.study.study",
            {"xarray", "numba", "matplotlib", "netCDF4", "scipy", "CoolProp"},
        ),
        (
            "from lube.study.study import load_study; import lube.workflow.jobs",
            {"xarray", "papermill"},
        ),
        ("import lube.report.markdown", {"numpy", "docutils"}),
        ("import lube.workflow.cells", {"xarray", "nbformat", "papermill"}),
    ],
)
def test_what_snakemake_imports_at_every_start_is_light(statement, heavy):
    assert not loaded_after(statement) & heavy


@pytest.mark.parametrize("name", lube.__all__)
def test_every_public_name_resolves_and_explains_itself(name):
    public = getattr(lube, name)
    assert name in dir(lube)
    if callable(public):
        assert inspect.getdoc(public)
        assert public.__module__ == lube._HOME_OF[name]


def test_an_unknown_public_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'nope'"):
        _ = lube.nope


@pytest.mark.parametrize("module", ["lube", *sorted(MODULES)])
def test_every_module_explains_itself(module):
    path = MODULES.get(module, PACKAGE / "__init__.py")
    assert ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
