"""Surfaces of whole rollers: as often in contact as sampled ones, and as long as on traces."""

import numpy as np
import pytest

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_revolution import revolution_contact
from lube.contact.surface_strip import surface_contact
from lube.contact.surface_trace import surface_traces
from lube.grid.gap import PLAIN, Gap
from lube.statistics.confidence import mean_interval
from lube.study.roller_lines import line_spec

from .test_surface_trace import LAY, films

LENGTH, PAIRS = 1.2e-3, 12
# The grid is coarse, and the layer so weak that it nearly always breaks.
POINTS, WEAKER = 20_000, 0.02
SHAPED, ANSWERED = Gap("computed", "none"), Gap("computed", "computed")


@pytest.fixture(scope="module")
def layer(study):
    strength = WEAKER * study.boundary_layer.shear_strength
    return study.boundary_layer.model_copy(update={"shear_strength": strength})


@pytest.fixture(scope="module")
def make_small(study):
    """Maker of surfaces of small rollers, which are drawn soon; films are those of the study."""

    def make(**lay):
        both = {name: getattr(study.rollers, name) for name in ("first", "second")}
        both = {name: one.model_copy(update={"radius": 0.01}) for name, one in both.items()}
        own = {"points": POINTS, "longest_wavelength": 0.3e-3, **lay}
        rollers = study.rollers.model_copy(update=both)
        return line_spec(rollers, study.roughness.model_copy(update=own), 1600.0)

    return make


@pytest.mark.parametrize(
    ("gap", "lay"),
    [
        (PLAIN, {}),
        pytest.param(PLAIN, LAY, marks=pytest.mark.slow),
        (SHAPED, {}),
        pytest.param(ANSWERED, {}, marks=pytest.mark.slow),
    ],
)
def test_pairs_of_rollers_touch_as_often_as_sampled_surfaces(study, make_small, layer, gap, lay):
    spec = make_small(**lay)
    film = films(study, spec, [2.8, 3.4], gap=gap)
    sampled = surface_contact(RoughPair(spec, LENGTH, layer, 1, gap), film, fewer=2)
    pair = RoughPair(spec, LENGTH, layer, 2, gap)
    lengths = [revolution_contact(pair, film, number) for number in range(PAIRS)]
    shares = np.mean(np.array(lengths) > 0.0, axis=-1)
    mean, _, upper = mean_interval(shares)
    expected, high = (sampled[f"breakthrough_probability{end}"].values for end in ("", "_upper"))
    assert expected.min() > 0.01 and expected.max() < 0.99
    assert (np.abs(mean - expected) < np.hypot(upper - mean, high - expected) + 0.02).all()
    # Pairs differ as theory says: within a factor, since twelve pairs scatter themselves.
    scatter = shares.std(axis=0, ddof=1) / sampled["pair_deviation"].values
    assert (scatter > 0.4).all() and (scatter < 2.0).all()


def test_contact_is_about_as_long_as_on_traces(study, make_small, layer):
    spec = make_small()
    film = films(study, spec, [1.5, 2.0])
    traces = [surface_traces(RoughPair(spec, LENGTH, layer, seed), film) for seed in range(10)]
    traced = np.array([trace["contact_length"].mean("step").values for trace in traces])
    pair = RoughPair(spec, LENGTH, layer, 2)
    lengths = [revolution_contact(pair, film, number).mean(axis=1) for number in range(4)]
    _, lower, upper = mean_interval(traced)
    # The paraboloids of merging summits cover less than their contact.
    assert (np.mean(lengths, axis=0) > 0.8 * lower).all()
    assert (np.mean(lengths, axis=0) < upper).all()


def test_threads_change_nothing_and_pairs_differ(study, make_small, layer):
    spec = make_small()
    film = films(study, spec, [2.0])
    pair = RoughPair(spec, LENGTH, layer, 2)
    one, two = (revolution_contact(pair, film, 0, threads) for threads in (1, 3))
    other = revolution_contact(pair, film, 1)
    np.testing.assert_array_equal(one, two)
    assert one.shape == other.shape and not np.array_equal(one, other)


def test_contact_under_an_unknown_film_is_unknown(study, make_small, layer):
    spec = make_small()
    film = films(study, spec, [2.0, 3.0])
    thickness = film["film_thickness"].where(film["film_thickness"] < film["film_thickness"].max())
    unknown = film.assign(film_thickness=thickness)
    pair = RoughPair(spec, LENGTH, layer, 2)
    found = revolution_contact(pair, unknown, 0)
    assert np.isfinite(found[0]).all() and np.isnan(found[1]).all()
    nothing = unknown.isel(operating_point=[1])
    assert np.isnan(revolution_contact(pair, nothing, 0)).all()
