"""All figures of unlike studies: what a reader would complain about."""

from pathlib import Path

import pytest
from figure_checks import draw, faults
from unlike_studies import STUDIES

from lube.pipeline.figure_list import study_figures
from lube.study.study import load_study

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
@pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")  # of SurfaceTopography
@pytest.mark.parametrize("name", STUDIES)
def test_no_figure_has_colliding_text_covered_or_missing_points(name, unlike):
    folder = unlike(name)
    paths = {path.stem: path for path in folder.glob("*.nc")}
    figures = study_figures(load_study(folder / "study.yaml"), NOTEBOOKS)
    found = [
        f"{figure.name}: {fault}"
        for figure in figures.values()
        if figure.target != "benchmark"
        for fault in faults(draw(NOTEBOOKS / f"{figure.name}.ipynb", paths))
    ]
    assert not found, "\n".join(found)
