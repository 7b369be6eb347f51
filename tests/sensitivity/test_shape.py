"""The flat film that contact sees in a film with a shape."""

import numpy as np
import pytest
import scipy.special
from studies import CONFIG

from lube.ehl.line_contact import LineContact, solve
from lube.sensitivity import shape
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.shape import WINDOW, _ratio, effective_ratio
from lube.study.study import load_study

RATIOS = np.array([[1.0], [3.0], [6.0]])


def flat(dent=1.0):
    """A flat film in the contact, which is open outside, and thinner over the last tenth."""
    film = np.where(np.abs(WINDOW) <= 1.0, 1.0, 99.0)
    return np.where((WINDOW > 0.8) & (WINDOW <= 1.0), dent, film)


def test_a_flat_film_is_its_own():
    np.testing.assert_allclose(_ratio(RATIOS, flat()), RATIOS[:, 0], rtol=1e-9)


def test_as_many_points_touch_in_both_films():
    ratio = _ratio(RATIOS, flat(dent=0.8))
    assert (0.8 * RATIOS[:, 0] < ratio).all() and (ratio < RATIOS[:, 0]).all()
    inside = np.abs(WINDOW) <= 1.0
    expected = scipy.special.ndtr(-RATIOS * flat(dent=0.8))[:, inside].mean(axis=1)
    np.testing.assert_allclose(scipy.special.ndtr(-ratio), expected, rtol=1e-9)


@pytest.fixture(scope="module")
def deviating():
    return Deviating.of(load_study(CONFIG / "paper.yaml"))


def test_between_its_levels_the_table_is_a_solved_film(deviating, monkeypatch):
    monkeypatch.setattr(shape, "NODES", (6, 4, 12))
    table = effective_ratio(deviating, np.array([[1.0, 4.0], [6.0, 10.0], [1.0, 7.0]]))
    study = deviating.study
    modulus = 2.0 * study.rollers.reduced_modulus
    oil = np.exp(deviating.oils.isel(lubricant=0).median())
    material = oil["pressure_viscosity_coefficient"].item() * modulus
    for moes_load, moes_material, ratio in ((1.7, 7.3, 3.1), (3.2, 9.1, 5.2)):
        speed = 0.5 * (moes_material / material) ** 4
        load = moes_load * np.sqrt(2.0 * speed)
        viscosity = oil["dynamic_viscosity"].item()
        film = solve(LineContact(load, speed, material, viscosity, modulus))
        expected = _ratio(np.array([[ratio]]), film.scaled_gap(WINDOW) / film.central_gap)
        found = table(*(np.array([each]) for each in (ratio, moes_load, moes_material)))
        np.testing.assert_allclose(found, expected, rtol=0.005)
        # The outlet is thinner than the centre.
        assert film.minimum_film / film.central_film * ratio < found < ratio


def test_beyond_its_levels_it_is_that_of_the_last(deviating, monkeypatch):
    monkeypatch.setattr(shape, "NODES", (4, 4, 4))
    table = effective_ratio(deviating, np.array([[1.0, 4.0], [6.0, 10.0], [1.0, 7.0]]))
    far, last = (table(np.array([3.0]), np.array([load]), np.array([8.0])) for load in (9.0, 4.0))
    np.testing.assert_allclose(far, last)
