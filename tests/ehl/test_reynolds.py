"""The discrete Reynolds equation: exact fluxes, derivatives by complex steps, Newton's method."""

import numpy as np
import pytest
from paper_grid import contact_at

from lube.ehl import line_contact
from lube.ehl.line_contact import LineContact, solve
from lube.ehl.reynolds import HERTZ_LOAD, DiscreteContact

ROELANDS = contact_at(800, 100, 40)
BARUS = LineContact(1e-5, 2e-11, 3000.0, 0.2, 2.3e11, "barus")
both = pytest.mark.parametrize("contact", [ROELANDS, BARUS], ids=["roelands", "barus"])


def state(contact):
    """Some pressure, with equal neighbours and jumps, on an uneven mesh, and an offset."""
    rng = np.random.default_rng(1)
    nodes = np.cumsum(rng.uniform(0.05, 0.3, 25)) - 2.5
    pressure = np.maximum(rng.normal(0.3, 0.4, 25), 0.0)
    pressure[[0, -1]], pressure[7] = 0.0, pressure[8]
    return DiscreteContact(contact, nodes), pressure, 3.0


def complex_step(function, argument):
    """Derivatives of a vector by each component of the argument, shape (n, components)."""
    steps = 1e-30j * np.eye(argument.size)
    return np.stack([function(argument + step).imag / 1e-30 for step in steps], axis=1)


@both
def test_derivatives_of_the_flux(contact):
    discrete, pressure, offset = state(contact)
    flow = discrete.flow(pressure, offset)
    by_pressure = complex_step(lambda p: discrete.flow(p, offset).flux, pressure)
    found = discrete.flux_by_pressure(flow)
    np.testing.assert_allclose(found[:, 1:-1], by_pressure[:, 1:-1], rtol=1e-9, atol=1e-12)
    by_offset = complex_step(lambda o: discrete.flow(pressure, o).flux, np.array([offset]))[:, 0]
    np.testing.assert_allclose(flow.by_gap, by_offset, rtol=1e-10)


@both
def test_derivatives_of_what_is_dragged(contact):
    discrete, pressure, offset = state(contact)

    def dragged(p):
        flow = discrete.flow(p, offset)
        return flow.flux + flow.pressure_flow

    flow = discrete.flow(pressure, offset)
    found = discrete._dense(flow.drag_by_gap, flow.drag_by_node, flow.drag_by_node)
    expected = complex_step(dragged, pressure)
    np.testing.assert_allclose(found[:, 1:-1], expected[:, 1:-1], rtol=1e-9, atol=1e-12)


def test_without_a_pressure_gradient_the_surfaces_drag_the_whole_gap():
    discrete, pressure, offset = state(ROELANDS)
    flow = discrete.flow(np.zeros_like(pressure), offset)
    np.testing.assert_allclose(flow.flux, offset + 0.5 * discrete.middle**2, rtol=1e-15)
    assert not flow.pressure_flow.any()


def test_flux_of_a_barus_oil_is_exact_between_two_nodes():
    """It depends on the difference of (1 - exp(-alpha p)) / alpha, however large the step is."""
    discrete, pressure, offset = state(BARUS)
    alpha = BARUS.material / BARUS.film_modulus * BARUS.hertz_pressure
    reduced = -np.expm1(-alpha * pressure) / alpha
    gap = discrete.gap(pressure, offset)
    density = BARUS.density(0.5 * (pressure[1:] + pressure[:-1]))[0]
    driven = density * gap**3 / BARUS.flow_number * np.diff(reduced) / discrete.step
    found = discrete.flow(pressure, offset).pressure_flow - discrete.damping @ pressure
    np.testing.assert_allclose(found, driven, rtol=1e-7, atol=1e-12)


def test_newton_steps_end_quadratically_at_the_load(monkeypatch):
    profile = solve(ROELANDS)
    discrete = DiscreteContact(ROELANDS, profile.nodes)
    bump = np.exp(-((profile.nodes + 0.5) ** 2)) * (profile.pressure > 0.1)
    pressure, offset, defects = profile.pressure + 0.01 * bump, profile.offset, []
    for _ in range(3):
        change, shift = discrete.newton_step(pressure, discrete.flow(pressure, offset), np.inf)
        pressure, offset = np.maximum(pressure + change, 0.0), offset + shift
        defects.append(np.abs(pressure - profile.pressure).max())
        assert discrete.weight @ pressure == pytest.approx(HERTZ_LOAD, rel=1e-12)
    assert defects[0] < 1e-2 and defects[1] < 10.0 * defects[0] ** 2 and defects[2] < 1e-6


def test_a_short_settling_time_moves_the_film_little_and_a_long_one_as_none():
    profile = solve(ROELANDS)
    discrete = DiscreteContact(ROELANDS, profile.nodes)
    pressure = profile.pressure * (1.0 + 0.02 * np.cos(profile.nodes))
    pressure *= HERTZ_LOAD / (discrete.weight @ pressure)
    flow = discrete.flow(pressure, profile.offset)
    changes = [discrete.newton_step(pressure, flow, time) for time in (1e-6, 1e12, np.inf)]
    widening = [shift + discrete.deflection @ change for change, shift in changes]
    assert np.abs(widening[0]).max() < 1e-3 * np.abs(widening[2]).max()
    np.testing.assert_allclose(changes[1][0], changes[2][0], atol=1e-9)


def test_settling_keeps_the_mass(monkeypatch):
    """Without an equation for the load: what the gap gains has come in, over the film's nodes."""
    discrete, _, offset = state(ROELANDS)
    pressure = np.maximum(0.4 - 0.3 * discrete.nodes**2, 0.0)
    pressure[[0, -1]] = 0.0
    flow, time = discrete.flow(pressure, offset), 1e-3
    change, shift = discrete.newton_step(pressure, flow, time)
    wet = np.flatnonzero(pressure[1:-1] + change[1:-1] > 0.0)
    drag = discrete._dense(flow.drag_by_gap, flow.drag_by_node, flow.drag_by_node)
    gained = drag @ change + flow.drag_by_gap * shift
    jacobian = discrete.flux_by_pressure(flow)
    flux = flow.flux + jacobian @ change + flow.by_gap * shift
    squeeze = 0.5 * discrete.weight[1:-1] * (gained[1:] + gained[:-1]) / time
    np.testing.assert_allclose(np.diff(flux)[wet], -squeeze[wet], rtol=1e-6, atol=1e-9)


def test_incompressible_oil_needs_no_special_case(monkeypatch):
    law = line_contact.dowson_higginson_density
    monkeypatch.setattr(line_contact, "dowson_higginson_density", lambda p: (1 + 0 * p, 0 * p))
    assert law(1e9)[0] > 1.2
    stiff = solve(ROELANDS)
    np.testing.assert_allclose(stiff.flow.flux[: stiff.end], stiff.flow.flux[0], rtol=1e-9)
