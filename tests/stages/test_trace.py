"""Traces over one revolution, and the window that explains each of their steps."""

import numpy as np
import pytest
import xarray as xr

from lube.errors import DataError
from lube.grid.gap import Gap
from lube.schema import CONTACT_DIMS, OPERATING_DIMS
from lube.stages import BoundaryLayer, contact_statistics, contact_trace, contact_window

RESISTIVITY = 0.2e-6


def point(film, ratio, **indices):
    """Operating point at these indices of the film table."""
    place = film.isel({"lubricant": 0, "speed": 1, **indices})
    return {"slide_to_roll_ratio": ratio} | {name: place[name].item() for name in OPERATING_DIMS}


def points_of(film, ratio):
    return [
        point(film, ratio, film_formula=0, temperature=3, force=4),
        point(film, ratio, film_formula=1, temperature=1, force=3),
        point(film, ratio, film_formula=0, temperature=0, force=0),  # nothing touches
    ]


@pytest.fixture(scope="module", params=[0.0, 0.4, -0.4])
def case(request, lines, coarse_lines, film, study):
    """Pure rolling on a fine grid, slip either way on a coarse one and with a weak layer."""
    ratio = request.param
    weak = BoundaryLayer.model_construct(critical_thickness=5e-9, shear_strength=1e4)
    surfaces, layer = (lines, study.boundary_layer) if ratio == 0.0 else (coarse_lines, weak)
    trace = contact_trace(surfaces, film, points_of(film, ratio), layer, RESISTIVITY)
    contact = contact_statistics(surfaces.isel(realisation=[0]), film, layer, [ratio])
    return surfaces, trace, contact


def test_time_means_are_the_contact_statistics(case, film):
    _, trace, contact = case
    ratio = trace["slide_to_roll_ratio"].values[0]
    for number, place in enumerate(points_of(film, ratio)):
        length = trace["contact_length"].isel(operating_point=number)
        expected = contact.sel(realisation=0, **place)
        share = np.count_nonzero(length > 0.0) / length.size
        assert share == expected["breakthrough_probability"].item()
        mean = expected["mean_contact_length"].item()
        assert length.mean().item() == pytest.approx(mean, rel=1e-12, abs=1e-300)


def test_resistance_is_equation_1(case):
    _, trace, _ = case
    length, resistance = trace["contact_length"].values, trace["contact_resistance"].values
    assert trace["resistivity"].item() == RESISTIVITY
    assert (np.isinf(resistance) == (length == 0.0)).all()
    touches = length > 0.0
    np.testing.assert_allclose(resistance[touches] * length[touches], RESISTIVITY, rtol=1e-12)
    touched = touches.mean(axis=1)
    assert 0.0 < touched[0] < 1.0 and touched[2] == 0.0


def test_time_goes_by_the_faster_surface(case):
    lines, trace, _ = case
    ratio = trace["slide_to_roll_ratio"].values[0]
    mean_speed = 2.0 * np.pi * 0.05 * 100.0 / 60.0  # 100 rpm on a radius of 50 mm
    # (v1 - v2) / v = ratio and (v1 + v2) / 2 = v.
    faster = max(mean_speed * (1.0 + ratio / 2.0), mean_speed * (1.0 - ratio / 2.0))
    np.testing.assert_allclose(np.diff(trace["time"]), lines.attrs["spacing"] / faster, rtol=1e-9)
    assert trace["time"].values[0] == 0.0
    assert trace.sizes["time"] == lines.attrs["points"][0]
    revolution = 60.0 / 100.0 / (1.0 + abs(ratio) / 2.0)
    assert trace["time"].values[-1] == pytest.approx(revolution * (1.0 - 1.0 / trace.sizes["time"]))


def test_operating_points_carry_their_coordinates(case, film):
    _, trace, _ = case
    ratio = trace["slide_to_roll_ratio"].values[0]
    for number, place in enumerate(points_of(film, ratio)):
        here = trace.isel(operating_point=number)
        assert {name: here[name].item() for name in CONTACT_DIMS} == place
        there = film.sel({name: place[name] for name in OPERATING_DIMS})
        for name in ("film_thickness", "contact_half_width"):
            assert here[name].item() == there[name].item()


def test_window_explains_the_trace_at_every_step(case):
    """First and last steps, changes of state, and some between."""
    lines, trace, _ = case
    for operating_point in (0, 1):
        length = trace["contact_length"].isel(operating_point=operating_point).values
        changes = np.flatnonzero(np.diff((length > 0.0).astype(int)))
        near = np.concatenate([changes, changes + 1])[::10][:40]
        regular = np.arange(0, length.size, length.size // 60)
        for step in np.unique(np.concatenate([[0, 1, length.size - 1], near, regular])):
            window = contact_window(lines, trace, operating_point, step)
            broken = window["contact_length"].values[window["broken"].values].sum()
            assert broken == pytest.approx(length[step], rel=1e-12, abs=1e-300)


@pytest.mark.parametrize("deformation", ["none", "venner-1997", "computed"])
def test_window_explains_the_trace_under_a_shape(lines, shaped_film, study, deformation):
    """No segment is cut: where lines touch beyond the contact, the window is wider."""
    place = {"film_formula": 0, "speed": 0, "temperature": 1, "force": 1}
    points = [point(shaped_film, 0.0, **place)]
    layer, gap = study.boundary_layer, Gap("computed", deformation)
    trace = contact_trace(lines, shaped_film, points, layer, RESISTIVITY, gap)
    length, widths = trace["contact_length"].values[0], set()
    for step in np.unique(np.concatenate([np.argsort(length)[-20:], np.arange(0, 100_000, 2500)])):
        window = contact_window(lines, trace, 0, int(step))
        assert (window["overlap"].values[[0, -1]] <= 0.0).all()
        widths.add(window.sizes["x"])
        broken = window["contact_length"].values[window["broken"].values].sum()
        assert broken == pytest.approx(length[step], rel=1e-12, abs=1e-300)
    assert length.max() > 0.0 and len(widths) > 1
    assert ("moes_load" in trace) == gap.is_flattened


def test_window_lies_within_the_half_width_and_holds_the_heights(case):
    lines, trace, _ = case
    window = contact_window(lines, trace, 0, 0)
    spacing = lines.attrs["spacing"]
    half_width = trace["contact_half_width"].values[0]
    assert half_width - spacing < window["x"].values[-1] <= half_width
    np.testing.assert_array_equal(window["x"], -window["x"].values[::-1])
    np.testing.assert_allclose(np.diff(window["x"]), spacing, rtol=1e-9)
    for roller in (0, 1):
        line = lines["height"].values[0, roller]
        around = np.rint(-window["x"].values / spacing).astype(int) % line.size
        np.testing.assert_allclose(window["height"].values[roller], line[around], rtol=1e-12)
    gap = trace["film_thickness"].values[0] - window["height"].sum("roller")
    np.testing.assert_allclose(window["overlap"], -gap, rtol=0, atol=0.5e-12 * (1.0 + 1e-6))


def test_segments_of_the_window_are_equations_5_and_6(case):
    lines, trace, _ = case
    step = int(np.argmax(trace["contact_length"].values[0]))
    window = contact_window(lines, trace, 0, step)
    overlap, spacing = window["overlap"].values, lines.attrs["spacing"]
    assert window.sizes["segment"] > 0
    inside = np.zeros(overlap.size, bool)
    for segment in range(window.sizes["segment"]):
        this = window.isel(segment=segment)
        first, last = this["first"].item(), this["last"].item()
        assert (overlap[first : last + 1] > 0.0).all()
        assert first == 0 or overlap[first - 1] <= 0.0
        assert last == overlap.size - 1 or overlap[last + 1] <= 0.0
        inside[first : last + 1] = True
        length = (last - first + 1) * spacing
        force = trace["reduced_modulus"].item() * spacing * overlap[first : last + 1].sum()
        layer = np.pi * trace["shear_strength"].item() / 12.0 * length**3 / force
        assert this["contact_length"].item() == pytest.approx(length)
        assert this["force"].item() == pytest.approx(force)
        assert this["layer_thickness"].item() == pytest.approx(layer)
        assert this["broken"].item() == (layer < trace["critical_thickness"].item())
    assert (inside == (overlap > 0.0)).all()
    assert contact_window(lines, trace, 2, 5).sizes["segment"] == 0


def test_where_the_film_is_not_known_there_is_no_trace(lines, film, study):
    holed = film.copy(deep=True)
    holed["film_thickness"][0, 1, 1, 1, 3] = np.nan
    points = points_of(film, 0.0)
    trace = contact_trace(lines, holed, points, study.boundary_layer, RESISTIVITY)
    every = contact_trace(lines, film, points, study.boundary_layer, RESISTIVITY)
    xr.testing.assert_equal(trace, every.isel(operating_point=[0, 2]))
    with pytest.raises(DataError, match="known at none of the points"):
        contact_trace(lines, holed, points[1:2], study.boundary_layer, RESISTIVITY)
