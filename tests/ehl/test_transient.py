"""Rough surfaces passing through the contact: smooth and small limits, balances, solid contact."""

import numpy as np
import pytest
import xarray as xr

from lube.ehl import transient
from lube.ehl.line_contact import ConvergenceError, one_blas_thread
from lube.ehl.response import WaveResponse, resolved_part
from lube.ehl.reynolds import HERTZ_LOAD
from lube.ehl.transient import CLOSED, RoughPassage, pass_wave, passage_nodes
from lube.grid.films import FilmGroups, hertz_contact
from lube.stages import lubricant_table

POINTS = [(800, 100, 40), (1600, 100, 80), (400, 100, 80), (800, 100, 60), (200, 150, 40)]


@pytest.fixture(scope="module")
def profile_at(study):
    """Maker of the film of smooth rollers at a force (N), speed (r/min) and temperature (degC)."""
    levels = [np.unique(column).astype(float) for column in np.transpose(POINTS)]
    force, speed, temperature = levels
    axes = xr.Dataset(coords={"force": force, "speed": speed})
    contact = hertz_contact(study.rollers, axes["force"], axes["speed"])
    oil = lubricant_table(study.lubricants[:1], temperature)
    groups = FilmGroups.at(oil, study.rollers, axes["force"], contact)

    def make(force, speed, temperature):
        at = {"force": force, "speed": speed, "temperature": temperature}
        one = {name: getattr(groups, name) for name in ("load", "speed", "material", "viscosity")}
        picked = {
            name: array.sel({dim: at[dim] for dim in array.dims if dim in at})
            for name, array in one.items()
        }
        return type(groups)(
            **picked, film_modulus=groups.film_modulus, meniscus=None
        ).profiles.item()

    return make


def difference(profile, wave, wavelength, speed):
    """Root mean square over the contact, from the linear response."""
    inside = np.abs(wave.position) < 0.95
    linear = WaveResponse(profile, wavelength).transfer(speed, wave.position)
    return np.sqrt(np.mean(np.abs(wave.transfer - linear)[inside] ** 2))


def test_nodes_are_even_in_the_contact_and_end_as_the_film_does(profile_at):
    profile = profile_at(1600, 100, 80)
    nodes = passage_nodes(profile, 0.05)
    np.testing.assert_allclose(nodes[[0, -1]], profile.nodes[[0, -1]])
    even = (nodes[1:] > -1.3) & (nodes[:-1] < profile.film_end + 0.1)
    np.testing.assert_allclose(np.diff(nodes)[even], 0.05, rtol=1e-9)
    ratio = np.diff(nodes)[1:] / np.diff(nodes)[:-1]
    assert np.all((ratio > 0.8) & (ratio < 1.25))


def test_without_roughness_the_steady_film_stays(profile_at):
    profile = profile_at(1600, 100, 80)
    passage = RoughPassage(profile, 0.05)
    gap = passage.gap
    for _ in range(5):
        passage.advance(np.zeros_like(gap))
    np.testing.assert_allclose(passage.gap, gap, rtol=1e-6)


@pytest.mark.parametrize("speed", [1.0, 1.5])
@pytest.mark.parametrize("point", POINTS)
def test_a_tenth_of_the_film_is_answered_as_the_linear_response_says(profile_at, point, speed):
    profile = profile_at(*point)
    wave = pass_wave(profile, 1.0, speed, 0.1)
    assert difference(profile, wave, 1.0, speed) < 0.02
    assert wave.oil_load_share == pytest.approx(1.0, abs=1e-9)


def test_halving_the_step_of_place_and_time_quarters_the_error(profile_at, monkeypatch):
    profile, errors = profile_at(1600, 100, 80), []
    for nodes in (10, 20, 40):
        monkeypatch.setattr(transient, "NODES", nodes)
        errors.append(difference(profile, pass_wave(profile, 1.0, 1.5, 0.01), 1.0, 1.5))
    assert errors[0] > 2.8 * errors[1] and errors[1] > 2.8 * errors[2]


def test_waves_as_high_as_the_film_are_answered_otherwise(profile_at):
    """The gap stays open where the linear response would close it."""
    profile = profile_at(1600, 100, 80)
    wave = pass_wave(profile, 1.0, 1.0, 1.5)
    assert difference(profile, wave, 1.0, 1.0) > 0.15
    linear = np.abs(WaveResponse(profile, 1.0).transfer(1.0, np.zeros(1))).item()
    assert 1.0 - 1.5 * linear < 0.0
    assert wave.gap.min() > 0.2 * profile.central_gap


class Sliding:
    """Waves three times as high as the film, that slide."""

    def __init__(self, profile, step):
        self.profile, self.step, self.time = profile, step, 0.0
        self.passage = RoughPassage(profile, step)
        self.height = 3.0 * profile.central_gap * resolved_part(0.2 / self.passage.spacing)

    def advance(self):
        self.time += self.step
        wave = np.cos(2.0 * np.pi / 0.2 * (self.passage.position - 1.5 * self.time))
        with one_blas_thread():
            self.passage.advance(self.height * min(1.0, self.time / 1.5) * wave)


@pytest.fixture(scope="module")
def touching(profile_at):
    """As soon as solid contact carries a tenth of the load."""
    sliding = Sliding(profile_at(1600, 100, 80), 0.2 / 12)
    while sliding.passage.oil_load_share > 0.9:
        sliding.advance()
    return sliding


def test_solid_contact_closes_the_gap_and_carries_load(touching):
    passage = touching.passage
    closed = CLOSED * np.interp(0.0, passage.position, passage.gap)
    assert passage.contact_pressure.min() == 0.0 and np.all(passage.pressure >= 0.0)
    shut = passage.contact_pressure > 0.0
    assert shut.any() and np.ptp(passage.gap[shut]) < 1e-12
    assert np.all(passage.gap[~shut] > passage.gap[shut][0]) and passage.gap[shut][0] < 10 * closed
    solid = np.sum(passage.spacing * passage.contact_pressure) / HERTZ_LOAD
    assert passage.oil_load_share + solid == pytest.approx(1.0, abs=1e-9)


def test_the_oil_in_the_film_changes_by_what_enters_and_leaves(touching):
    """Mass, from one time step to the next, by the scheme's own weights of both."""
    passage = touching.passage
    nodes = passage_nodes(touching.profile, touching.step)

    def state():
        flow = passage._flow
        return flow.flux + flow.pressure_flow, flow.pressure_flow

    drag, driven = state()
    touching.advance()
    new_drag, new_driven = state()
    late = 0.5 + 0.5 * touching.step
    flux = 0.5 * (drag + new_drag) - late * new_driven - (1.0 - late) * driven
    cells = 0.5 * (nodes[2:] - nodes[:-2]) / touching.step
    stored = 0.5 * cells * ((new_drag - drag)[1:] + (new_drag - drag)[:-1])
    film = passage.pressure[1:-1] > 0.0
    assert np.abs(stored[film]).max() > 1e-3
    np.testing.assert_allclose((np.diff(flux) + stored)[film], 0.0, atol=1e-7)


def test_a_step_that_is_not_solved_is_named(profile_at, monkeypatch):
    """Waves so high that solid contact begins and ends at many places at once."""
    monkeypatch.setattr(transient, "NODES", 12)
    message = "^the film at M = 8.67, .*: a time step of the passing roughness did not converge"
    with pytest.raises(ConvergenceError, match=message):
        pass_wave(profile_at(1600, 100, 80), 0.2, 1.0, 3.0)
