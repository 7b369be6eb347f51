"""Contact of surfaces in a strip: limits, then whole surfaces drawn and searched."""

import numpy as np
import pytest
import scipy.ndimage

from lube.contact import surface_strip
from lube.contact.surface_strip import StripFilm, strip_probability, surface_contact
from lube.errors import StudyError
from lube.grid.gap import Gap
from lube.surfaces.isotropic import isotropic_surface

SEED = 2
SURFACES = 150
ROWS = 40


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(50_000)


# --- Limits --------------------------------------------------------------------------------


def test_independent_rows_touch_as_by_the_binomial_distribution():
    for share in (1e-12, 0.02, 0.4):
        first = share * (1.0 - share) ** np.arange(30)
        for rows in (1, 7, 30, 1000):
            expected = -np.expm1(rows * np.log1p(-share))
            assert strip_probability(first, rows) == pytest.approx(expected, rel=1e-9)


def test_a_formula_that_flattens_the_roughness_is_refused(spec, film, study):
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[0])
    gap = Gap("computed", "venner-1997")
    with pytest.raises(StudyError, match=r"^roughness_deformation: got venner-1997, need none or"):
        surface_contact(spec, 0.01, few, study.boundary_layer, SEED, gap)


def test_a_film_that_is_not_known_has_no_contact_that_is(spec, film, study):
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[0, 4])
    few["film_thickness"] = few["film_thickness"].where(few["force"] > 1000.0)
    found = surface_contact(spec, 0.01, few, study.boundary_layer, SEED)
    for values in found.values():
        assert values.notnull().values.ravel().tolist() == [False, True]


# --- Counting ------------------------------------------------------------------------------


def shape(rms, spacing):
    """Film that is thinnest off its middle and rises at both ends, at positions in m."""
    position = spacing * np.linspace(-30.0, 30.0, 121)
    film = 2.3 * rms * (1.0 + (position / spacing / 9.0) ** 4 - 0.15 * np.sin(position / spacing))
    return position, film


@pytest.fixture(scope="module", params=["flat", "shaped"])
def strip(request, spec):
    """Film of a strip on the surface of these lines."""
    surface = isotropic_surface(spec)
    rms = surface.rms * spec.height_step
    if request.param == "flat":
        return surface, StripFilm.flat(2.6 * rms, 6.01 * surface.spacing)
    return surface, StripFilm.shaped(*shape(rms, surface.spacing), rms)


def searched(surface, films, sharp, generator):
    """Shares of strips that touch and that break, and their numbers in a strip, on a surface."""
    heights, curvatures, _ = surface.draw(generator)
    found = np.zeros((2, 2))
    begins = [
        (row, column)
        for row in range(0, surface.points - ROWS, 2 * ROWS)
        for column in range(0, surface.points - films.size, 40)
    ]
    for row, column in begins:
        part = np.s_[row : row + ROWS, column : column + films.size]
        overlap = heights[part] - films
        labels, contacts = scipy.ndimage.label(overlap > 0.0)
        summits = scipy.ndimage.maximum_position(overlap, labels, range(1, contacts + 1))
        breaking = sum(curvatures[part][summit] > sharp[summit[1]] for summit in summits)
        found += [[contacts > 0, breaking > 0], [contacts, breaking]]
    return found / len(begins)


def test_strips_touch_and_break_as_often_as_on_whole_surfaces(spec, strip):
    surface, film = strip
    curvature = 2.0 * np.std(surface.draw(np.random.default_rng(1))[1]) * spec.height_step
    films = film.films(surface.spacing) / spec.height_step
    sharp = film.breaking_curvatures(surface.spacing, curvature) / spec.height_step
    rng = np.random.default_rng(8)
    counted = np.array([searched(surface, films, sharp, rng) for _ in range(SURFACES)])
    length = (ROWS + 0.5) * surface.spacing
    strips = [film], np.array([False])
    found = surface_strip._sampled(spec, surface, *strips, [curvature], length, SEED)
    names = ["geometric_contact_probability", "breakthrough_probability"]
    names += ["contacts", "breakthroughs"]
    for name, values in zip(names, counted.reshape(SURFACES, 4).T, strict=True):
        half = (found[f"{name}_upper"] - found[name]).item()
        error = np.hypot(np.std(values, ddof=1) / SURFACES**0.5, half / 2.0)
        assert abs(found[name].item() - np.mean(values)) < 3.0 * error
        assert error < 0.07 * np.mean(values)
    assert np.mean(counted[:, 0, 1]) < 0.9 * np.mean(counted[:, 0, 0])  # some do not break
