"""A small archive: the datasets of every kind, one figure, and the real code."""

import json
import shutil

import pytest
from studies import SMOKE, SMOKE_DATASETS

from lube.archive.build import make_archive
from lube.pipeline.study_files import origin, products
from lube.storage.netcdf import save
from lube.storage.provenance import fingerprint

FIGURE = "fig02_film"


def write_results(study, datasets, folder):
    """Save datasets, each made from those before it, the files of one figure, and the explorer."""
    *records, film = [*study.lubricants[0].files, folder / "film.nc"]
    for kind in SMOKE_DATASETS:
        inputs = {"lubricant": records, "film": [folder / "lubricant.nc"], "roughness": []}
        save(datasets[kind], folder / f"{kind}.nc", kind, study, inputs.get(kind, [film]))
    for name in products(FIGURE):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(name)
    content = {
        "datasets": {"film": fingerprint(film)},
        "products": {name: fingerprint(folder / name) for name in products(FIGURE)},
        "drawn_by": "",
    }
    (folder / origin(FIGURE)).write_text(json.dumps(content))
    (folder / "explorer.html").write_text("page")


@pytest.fixture(scope="session")
def archive(study, datasets, tmp_path_factory):
    """The archive; not to be changed. Its zip stands beside it."""
    folder = tmp_path_factory.mktemp("results")
    write_results(study, datasets, folder)
    make_archive(study, SMOKE, folder, [FIGURE], folder / "archive/smoke")
    return folder / "archive/smoke"


@pytest.fixture
def changed(archive, tmp_path):
    """A copy of the archive, free to be changed."""
    return shutil.copytree(archive, tmp_path / "archive")
