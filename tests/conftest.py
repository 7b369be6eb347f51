"""Shared fixtures: the rollers of the smoke study on grids fine or small enough for a test."""

import fcntl
import pickle
import shutil
import subprocess
import warnings
from types import SimpleNamespace

import pytest
import yaml
from every_kind import datasets_of_every_kind
from hypothesis import settings
from made import on_few_surfaces
from studies import PAPER_CONTENT, SMOKE, with_value
from unlike_studies import STUDIES, write_datasets

from lube.contact.ensemble import gather, gather_map
from lube.contact.rough_pair import roughness_batch
from lube.stages import film_table, line_spec, load_study, roughness_lines
from lube.stages.contact import contact_statistics
from lube.stages.master import contact_map
from lube.storage.netcdf import save
from lube.study.metadata import About
from lube.study.oil_properties import lubricant_table
from lube.study.rollers import OwnRoughness

# The first example of a test may have to wait for its kernel to be compiled.
settings.register_profile("lube", deadline=None)
settings.load_profile("lube")


def pytest_collection_modifyitems(items):
    """Put tests of the smoke study first, in one process; the other begins with those without.

    These begin with tests that need no kernel: the smoke study compiles the kernels meanwhile. The
    other tests of the workflow, whose files take longest, follow, so that both processes end
    together.
    """

    def rank(item):
        folder = item.path.parent.name
        needs_kernels = folder not in ("ehl", "physics", "recordings", "statistics", "study")
        return item.path.name != "test_run.py", needs_kernels, folder != "pipeline", item.path

    items.sort(key=rank)


LARGEST_FORCE = 1600.0


@pytest.fixture(scope="session")
def study():
    """The smoke study: the paper's rollers and layer."""
    return load_study(SMOKE)


@pytest.fixture(scope="session")
def attributed_study(study):
    """The smoke study, with makers of every kind and a title that needs care."""
    about = {
        "title": "My <rollers> & oil",
        "summary": "Rollers & oil.",
        "creators": [
            {"name": "Popova, Elena", "affiliation": "TU Berlin", "orcid": "0000-0002-1825-0097"},
            {"name": "The authors of lube"},
        ],
        "licence": "CC0-1.0",
        "date": "2026-02-03",
        "doi": "10.5281/zenodo.123",
    }
    return study.model_copy(update={"about": About.model_validate(about)})


@pytest.fixture(scope="session")
def make_spec(study):
    """Maker of a line specification: the study's, with other points, radius or roughness."""

    def make(points, second_radius=None, second_roughness=None, second_own=None, **roughness):
        second = study.rollers.second
        second = second.model_copy(
            update={
                "radius": second_radius or second.radius,
                "rms_roughness": second_roughness or second.rms_roughness,
                "roughness": second_own and OwnRoughness(**second_own),
            }
        )
        return line_spec(
            study.rollers.model_copy(update={"second": second}),
            study.roughness.model_copy(update={"points": points, **roughness}),
            LARGEST_FORCE,
        )

    return make


@pytest.fixture(scope="session")
def film(study):
    """Film table whose five dimensions all differ in length, so that none passes for another."""
    oil = lubricant_table(study.lubricants, [40.0, 55.0, 70.0, 80.0])
    forces = [100.0, 200.0, 400.0, 800.0, LARGEST_FORCE]
    speeds = [60.0, 100.0, 150.0]
    return film_table(oil, study.rollers, forces, speeds, ["paper", "pan-hamrock-minimum"])


@pytest.fixture(scope="session")
def shaped_film(study, make_spec):
    """Films with the computed shape at four operating points, for two film formulas; they answer
    roughness lines."""
    oil = lubricant_table(study.lubricants, [60.0, 80.0])
    levels = [400.0, 1600.0], [100.0], ["paper", "computed"], True
    found = film_table(oil, study.rollers, *levels, answered_lines=make_spec(100_000))
    return found.squeeze("slide_to_roll_ratio", drop=True)


@pytest.fixture(scope="session")
def lines(make_spec):
    """Two realisations, a tenth as fine as the paper's."""
    return roughness_lines(make_spec(100_000), seed=11, realisations=[0, 1])


@pytest.fixture(scope="session")
def coarse_lines(make_spec):
    """One realisation on a grid so coarse that the literal scan is quick."""
    return roughness_lines(
        make_spec(6000, shortest_wavelength="4.0 points"), seed=11, realisations=[0]
    )


@pytest.fixture(scope="session")
def with_rig():
    """A study whose simulated rig has other values, and two revolutions."""

    def change(study, **values):
        rig = type(study.rig)(**({"revolutions": 2} | values))
        return study.model_copy(update={"rig": rig})

    return change


@pytest.fixture(scope="session")
def rig_lines(make_spec, study, with_rig):
    """The rig's own rollers, one pair, on a grid fine enough for some contact."""
    return roughness_batch(make_spec(60_000), study.seed, with_rig(study).rig_realisations)


@pytest.fixture(scope="session")
def rig_film(film, study):
    """Film table at the study's levels, of one speed."""
    grid = study.operating_grid
    return film.sel(temperature=list(grid.temperature), speed=[100.0], force=list(grid.force))


@pytest.fixture(scope="session")
def busy_study(study):
    """A study quickly run in which contact is neither rare nor everywhere, of equal rollers."""
    grid = {
        "force": (100.0, 400.0, LARGEST_FORCE),
        "speed": (60.0, 100.0),
        "temperature": (60.0, 80.0),
        "slide_to_roll_ratio": (0.0,),
    }
    # So weak a layer that on the coarse grid as many segments break as on the paper's.
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e5})
    return study.model_copy(
        update={
            "operating_grid": study.operating_grid.model_copy(update=grid),
            "roughness": study.roughness.model_copy(update={"points": 50_000}),
            "boundary_layer": layer,
            "realisations": 32,
        }
    )


@pytest.fixture(scope="session")
def busy(busy_study):
    """The same with its film table, contact results and master map."""
    grid, layer = busy_study.operating_grid, busy_study.boundary_layer
    oil = lubricant_table(busy_study.lubricants, grid.temperature)
    film = film_table(oil, busy_study.rollers, grid.force, grid.speed, busy_study.film_formulas)
    realisations = range(busy_study.realisations)
    lines = roughness_batch(busy_study.line_spec, busy_study.seed, realisations)
    return SimpleNamespace(
        study=busy_study,
        film=film,
        lines=lines,
        contact=gather([contact_statistics(lines, film, layer)], film),
        master=gather_map([contact_map(lines, film, layer)]),
    )


@pytest.fixture(scope="module")
def few_surfaces():
    """As `made.on_few_surfaces`, for a whole module."""
    with on_few_surfaces():
        yield


@pytest.fixture
def paper_with(tmp_path):
    """Write the paper's study with changed values, and return the file."""

    def write(*changes):
        content = PAPER_CONTENT
        for key, value in changes:
            content = with_value(content, key, value)
        path = tmp_path / "mine.yaml"
        path.write_text(yaml.safe_dump(content), encoding="utf-8")
        return path

    return write


@pytest.fixture(scope="session")
def made_once(tmp_path_factory, worker_id):
    """Path of what one of several test processes makes; the others wait for it."""
    folder = tmp_path_factory.getbasetemp()
    if worker_id != "master":
        folder = folder.parent

    def path_of(name, make):
        path = folder / name
        with path.with_suffix(".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not path.exists():
                make(path)
        return path

    return path_of


@pytest.fixture(scope="session")
def unlike(made_once):
    """Folder of an unlike study with its datasets, by its name; not to be changed."""

    def make(path):
        unfinished = path.with_name(f"unfinished {path.name}")
        shutil.rmtree(unfinished, ignore_errors=True)
        with warnings.catch_warnings():  # of libraries; tests of figures refuse their own
            warnings.simplefilter("default")
            write_datasets(STUDIES[path.name], unfinished)
        unfinished.rename(path)

    return lambda name: made_once(name, make)


@pytest.fixture(scope="session")
def datasets(study, made_once):
    """One dataset of every kind; not to be changed."""

    def make(path):
        path.write_bytes(pickle.dumps(datasets_of_every_kind(study)))

    return pickle.loads(made_once("datasets", make).read_bytes())


@pytest.fixture(scope="session")
def files(datasets, study, tmp_path_factory):
    """The same, saved."""
    folder = tmp_path_factory.mktemp("files")
    for kind, dataset in datasets.items():
        save(dataset, folder / f"{kind}.nc", kind, study)
    return folder


@pytest.fixture
def disk():
    """Mount a disk in memory on a folder; options such as ``size=64k`` or ``remount,ro``."""
    mounted = []

    def mount(folder, options):
        command = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)]
        finished = subprocess.run(command, capture_output=True, text=True, check=False)
        if finished.returncode != 0:
            pytest.skip(f"no disk can be mounted here: {finished.stderr.strip()}")
        if "remount" not in options:
            mounted.append(str(folder))

    yield mount
    for folder in mounted:
        # At once, though the NetCDF library keeps files open that it could not write.
        subprocess.run(["umount", "--lazy", folder], check=True)
