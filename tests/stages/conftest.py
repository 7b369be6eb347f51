"""Comparisons of given shares with the busy study, whose contact is neither rare nor certain."""

import pytest
from experiments import experiment_at, experiment_of, made_up_surfaces, model_of_records

from lube.inference.at_records import study_films_at_records
from lube.stages.comparison import compare


@pytest.fixture(scope="session")
def compared(busy):
    """Compare an experiment with the busy study."""

    def run(experiment):
        model = model_of_records(experiment, busy.film, busy.contact, busy.study)
        return compare(model, experiment, busy.contact)

    return run


@pytest.fixture(scope="session")
def at_grid(compared, busy):
    """Compare shares at the 12 points of the grid, the force changing fastest."""
    grid = busy.study.operating_grid.model_dump()
    return lambda shares, **values: compared(experiment_at(grid, shares, **values))


@pytest.fixture(scope="session")
def at_point(compared):
    """Compare several records of one point."""
    point = {"force": 400.0, "speed": 100.0, "temperature": 60.0}
    return lambda shares, **values: compared(experiment_of(shares, **(point | values)))


@pytest.fixture(scope="session")
def members(busy):
    """Probability of each realisation at the 12 points of the grid by one formula, (R, 12)."""
    found = busy.contact["breakthrough_probability"].sel(film_formula="paper").squeeze()
    return found.transpose("realisation", "temperature", "speed", "force").values.reshape(32, 12)


@pytest.fixture(scope="session")
def mean(members):
    return members.mean(axis=0)


@pytest.fixture(scope="session")
def on_surfaces(busy):
    """Compare an experiment with made-up surfaces too, whose probability is known."""

    def run(experiment, models=("line", "surface"), error=0.0):
        model = model_of_records(experiment, busy.film, busy.contact, busy.study)
        surfaces = made_up_surfaces(model["lambda_ratio"], error)
        return compare(model, experiment, busy.contact, models, surfaces)

    return run


@pytest.fixture(scope="session")
def without_lines(busy):
    """Compare an experiment with made-up surfaces alone, as where no line stands for them."""

    def run(experiment):
        model = study_films_at_records(busy.study, experiment)
        surfaces = made_up_surfaces(model["lambda_ratio"])
        return compare(model, experiment, busy.film, ("surface",), surfaces)

    return run
