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

# Each module may import those of the layers above its own.
LAYERS = [
    {"errors", "repository", "processors", "classic_netcdf"},
    {
        *("units", "texts", "hertz", "groups", "regimes", "inlet_heating", "viscosity"),
        *("resistance", "intervals", "one_pair", "folding", "levels", "schema", "kernels", "pages"),
    },
    {
        *("formulas", "markdown", "fields", "files", "fluids", "seals", "steps", "points"),
        *("evaluation", "curves", "shares", "signals", "tables", "sizes", "cells"),
    },
    {
        *("about", "apparatus", "records", "surfaces", "rig", "manifest", "excerpts", "map_curves"),
        *("text_signals", "binary_signals"),
    },
    {"study", "recordings", "fits", "ensemble"},
    {
        *("lubricant", "film", "roughness", "contact", "trace"),
        *("experiment", "rig_records", "comparison", "gauge"),
    },
    {"provenance", "jobs", "reference", "at_records"},
    {"io", "plots", "citation", "notebooks"},
    {"crate", "explanation", "configuration", "overview", "figures"},
    {"archive_page"},
    {"archive"},
    {"verify", "redraw"},
    {"command"},
]
LAYER_OF = {name: number for number, layer in enumerate(LAYERS) for name in layer}
FOUNDATIONS = {
    *(
        "errors",
        "units",
        "texts",
        "fields",
        "hertz",
        "groups",
        "regimes",
        "formulas",
        "inlet_heating",
    ),
    *("viscosity", "resistance", "curves", "intervals", "one_pair", "folding"),
}
STAGES = LAYERS[5]


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


def test_every_module_has_its_layer():
    assert {part(module) for module in MODULES} == set(LAYER_OF)


@pytest.mark.parametrize("module", sorted(MODULES))
def test_imports_go_up_the_layers_only(module):
    own = part(module)
    for name in own_imports(MODULES[module]) - {own}:
        assert LAYER_OF[name] < LAYER_OF[own], f"{module} imports lube.{name}"


@pytest.mark.parametrize("module", sorted(m for m in MODULES if part(m) in STAGES))
def test_stages_meet_as_datasets_and_never_import_one_another(module):
    assert not own_imports(MODULES[module]) & STAGES


@pytest.mark.parametrize("module", sorted(m for m in MODULES if part(m) == "kernels"))
def test_kernels_know_arrays_and_nothing_else(module):
    known = {"numpy", "numba", "math"}
    if module == "lube.kernels.compiler":
        known |= {"hashlib", "os", "pathlib"}  # where the compiled kernels are kept
    assert outside_imports(MODULES[module]) <= known
    assert own_imports(MODULES[module]) <= {"kernels"}


@pytest.mark.parametrize("module", sorted(m for m in MODULES if part(m) in FOUNDATIONS))
def test_the_mathematics_knows_neither_datasets_nor_files(module):
    assert not outside_imports(MODULES[module]) & {"xarray", "netCDF4", "matplotlib", "numba"}


def test_modules_that_import_each_other_form_no_ring():
    ahead = {module: {f"lube.{n}" for n in own_imports(p)} for module, p in MODULES.items()}

    def reached(module, trail):
        assert module not in trail, f"ring of imports: {trail}"
        for name in ahead.get(module, ()):
            reached(name, [*trail, module])

    for module in MODULES:
        if part(module) != "kernels":
            reached(module, [])


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
        ("import lube.study", {"xarray", "numba", "matplotlib", "netCDF4", "scipy", "CoolProp"}),
        ("from lube.study import load_study; import lube.jobs", {"xarray", "papermill"}),
        ("import lube.markdown", {"numpy", "docutils"}),
        ("import lube.cells", {"xarray", "nbformat", "papermill"}),
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
