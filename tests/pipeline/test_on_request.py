"""What is made on request only: in report and archive once it was made, and never asked for."""

import re

import pytest
from repository import RESULTS

from lube.archive.verify import verify_archive

FIGURE = "fig29_film_profile"
PICTURE = f"{RESULTS}/figures/{FIGURE}.png"
MADE = {"film_profile", FIGURE}
OTHERS = ("areal", "patch", "variants", "film_plane", "speed")


def named(repository, *targets):
    """Which of the kinds and figures made on request the plan of some targets names."""
    said = repository.run(*targets, "-n")
    return {name for name in (*MADE, *OTHERS) if re.search(rf"\b{name}\b", said)}


@pytest.mark.slow
def test_report_and_archive_have_what_was_made_on_request_and_ask_for_nothing_else(spare):
    spare.take_notebooks(FIGURE)
    assert named(spare, "archive", "report") == set()
    spare.run(PICTURE)
    assert spare.planned() == set()
    spare.run("archive", "report")
    archive = spare.results / "archive/smoke"
    report = (spare.results / "report.html").read_text("utf-8")
    for name in (f"figures/{FIGURE}.png", f"notebooks/{FIGURE}.ipynb", "data/film_profile.nc"):
        assert (archive / name).is_file()
    assert f'"{PICTURE}":' in report and "film_profile.nc" in report
    assert not [name for name in OTHERS if (archive / f"data/{name}.nc").exists()]
    assert verify_archive(archive) == []
    assert "Nothing to be done" in spare.run()
    assert "Nothing to be done" in spare.run("archive", "report")
    # Where it is out of date, report and archive make it again; bare Snakemake leaves it alone.
    spare.append("lube/stages/film_profile.py", "# changed")
    assert spare.planned() == set()
    for target in ("archive", "report"):
        assert named(spare, target) == MADE


@pytest.mark.slow
def test_an_archive_made_in_the_same_run_has_it_and_is_complete(spare):
    spare.take_notebooks("fig24_patch")
    spare.run("patch_contact", "archive")
    assert (spare.results / "archive/smoke/data/patch.nc").is_file()
    assert (spare.results / "archive/smoke/figures/fig24_patch.png").is_file()
    assert "Nothing to be done" in spare.run("archive")
