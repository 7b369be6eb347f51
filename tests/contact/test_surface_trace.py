"""Traces of contacts along the rollers: step by step by hand, then their mean as sampled."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.ndimage
import xarray as xr

from lube.contact import surface_trace
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import (
    mean_breaking_curvature,
    smallest_contacts,
    strip_films,
    surface_contact,
)
from lube.contact.surface_trace import surface_traces
from lube.grid import film_responses
from lube.grid.films import film_at
from lube.grid.gap import PLAIN, Gap
from lube.study.oil_properties import lubricant_table
from lube.surfaces.rough_surface import field, rough_surface

LENGTH = 4e-3
TRACES = 12
LAY = {"lay_ratio": 2.0, "lay_angle": 60.0}


def films(study, spec, ratios, slip=0.0, gap=PLAIN):
    """Films of one operating point, scaled to some lambda ratios."""
    oil = lubricant_table(study.lubricants, [80.0]).isel(lubricant=0, temperature=0)
    point = xr.DataArray(1600.0), xr.DataArray(100.0), ["computed"]
    answered = {"answered_surfaces": spec} if gap.is_answered else {}
    film = film_at(oil, study.rollers, *point, gap.has_shape, slip, **answered)
    film = film.squeeze(drop=True)
    scale = xr.DataArray(np.array(ratios), dims="operating_point") / film["lambda_ratio"]
    thickness = {"film_thickness": scale * film["film_thickness"]}
    if gap.has_shape:
        thickness["film_profile"] = scale * film["film_profile"]
    return film.assign(thickness)


@pytest.mark.parametrize(("slip", "lay"), [(0.0, {}), (0.5, {}), (0.5, LAY)])
def test_contacts_are_those_of_surfaces_moved_by_hand(study, make_spec, slip, lay):
    spec = make_spec(50_000, **lay)
    film = films(study, spec, [2.0])
    pair = RoughPair(spec, LENGTH, study.boundary_layer, 3)
    found = surface_traces(pair, film, slip).isel(operating_point=0)
    width = 2.0 * film["contact_half_width"].item()
    strips = strip_films(pair, film)
    surface = rough_surface(spec, width, tuple(smallest_contacts(spec, strips)[0]))
    # From edge to edge.
    rows, columns = int(LENGTH / surface.spacing[0]), round(width / surface.spacing[1]) + 1
    sharp = mean_breaking_curvature(pair, film)
    near = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]])
    if surface.diagonal:
        near[0, 0] = near[2, 2] = 1
    pieces = [min(surface.points[0], rows - k) for k in range(0, rows, surface.points[0])]
    steps = 0, 77, surface_trace.STEPS - 1
    counts, lengths = np.zeros(len(steps)), np.zeros(len(steps))
    for number, size in enumerate(pieces):
        generator = np.random.default_rng(np.random.SeedSequence((3, number)).spawn(9)[8])
        heights, curvatures, waves = surface.draw(generator)
        both = [(heights, curvatures), (np.zeros(surface.points),) * 2]
        if slip:
            both = [
                tuple(field(each * own, surface.points) for own in (1.0, surface.curvatures))
                for each in surface.of_each(waves, generator)
            ]
        for at, step in enumerate(steps):
            moved = [
                [
                    np.roll(each, round(found["step"].values[step] * speed / surface.spacing[1]), 1)
                    for each in fields
                ]
                for fields, speed in zip(both, (1.0 + slip / 2, 1.0 - slip / 2), strict=True)
            ]
            height, curvature = (spec.height_step * sum(each) for each in zip(*moved, strict=True))
            overlap = (height - film["film_thickness"].item())[:size, :columns]
            labels, count = scipy.ndimage.label(overlap > 0.0, near)
            counts[at] += count
            for contact in range(1, count + 1):
                summit = np.argmax(np.where(labels == contact, overlap, -np.inf))
                if curvature[:size, :columns].flat[summit] > sharp:
                    area = np.count_nonzero(labels == contact) * np.prod(surface.spacing)
                    lengths[at] += np.sqrt(4.0 * area / np.pi)
    np.testing.assert_array_equal(found["contacts"].values[list(steps)], counts)
    np.testing.assert_allclose(found["contact_length"].values[list(steps)], lengths, rtol=1e-6)
    assert counts.min() > 0
    placed = found["contact_length_at"].sum("roller_position")
    np.testing.assert_allclose(placed, found["contact_length"], rtol=1e-9)


@pytest.mark.parametrize(
    ("gap", "slip"),
    [
        (PLAIN, 0.0),
        (PLAIN, 1.0),
        (Gap("computed", "computed"), 0.4),
        (Gap("computed", "none"), 0.0),
        pytest.param(Gap("flat", "computed"), 0.4, marks=pytest.mark.slow),
    ],
)
def test_the_strip_touches_as_often_as_by_sampling(study, make_spec, monkeypatch, gap, slip):
    monkeypatch.setattr(surface_trace, "STEPS", 12)
    # The same responses serve both, whatever the angles between which they are interpolated.
    monkeypatch.setattr(film_responses, "ANGLES", np.arange(0.0, 91.0, 45.0))
    spec = make_spec(50_000)
    film, layer = films(study, spec, [2.0, 2.3], slip, gap), study.boundary_layer
    pair = RoughPair(spec, LENGTH, layer, 1, gap)
    strips = strip_films(pair, film)  # the same in all traces
    monkeypatch.setattr(surface_trace, "strip_films", lambda *_: strips)
    pairs = [replace(pair, seed=seed) for seed in range(TRACES)]
    traces = [surface_traces(each, film, slip) for each in pairs]
    found = [each["contacts"].mean("step").values for each in traces]
    touched = [(each["contacts"] > 0.0).mean("step").values for each in traces]
    # On a quarter of the surfaces it is still three times as certain as the mean of the traces.
    fewer = 4 if gap.is_answered else 1
    sampled = surface_contact(pair, film, fewer=fewer)
    for name, values in (("contacts", found), ("geometric_contact_probability", touched)):
        half = 0.5 * (sampled[f"{name}_upper"] - sampled[f"{name}_lower"]).values
        error = np.hypot(np.std(values, axis=0, ddof=1) / TRACES**0.5, 0.5 * half)
        # The ends of the pieces cut some contacts in two.
        allowed = 3.0 * error + 0.03 * sampled[name].values
        assert np.all(np.abs(np.mean(values, axis=0) - sampled[name].values) < allowed)
        assert np.all(error < 0.15 * sampled[name].values)


def test_a_film_that_is_not_known_has_no_trace(study, make_spec):
    spec = make_spec(50_000)
    film = films(study, spec, [2.0, np.nan])
    found = surface_traces(RoughPair(spec, LENGTH, study.boundary_layer, 3), film)
    for values in found.data_vars.values():
        assert values.isel(operating_point=0).notnull().all()
        assert values.isel(operating_point=1).isnull().all()
