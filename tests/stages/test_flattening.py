"""Lines that the oil has flattened: limits, then a second way."""

import numpy as np
import pytest

from lube import contact_statistics, roughness_lines
from lube.grid import contact_runs
from lube.physics.flattening import amplitude_ratio
from lube.stages import flattening
from lube.stages.flattening import flattened_contact
from lube.surfaces.synthetic import draw_realisation

SEED = 11


@pytest.fixture(scope="module")
def few(film):
    return film.isel(temperature=[0, 3], speed=[1], force=[2, 4])


@pytest.fixture(scope="module", params=[None, 0.04])
def spec(request, make_spec):
    """Equal rollers, whose lines are flattened as one, and unequal ones."""
    return make_spec(40_000, request.param)


@pytest.fixture(scope="module")
def weak(study):
    return study.boundary_layer.model_copy(update={"shear_strength": 2e5})


@pytest.fixture(scope="module")
def found(spec, few, weak):
    return flattened_contact(spec, few, weak, SEED, [0, 1])


def test_undeformed_lines_are_those_of_the_contact_model(spec, few, weak, found):
    lines = roughness_lines(spec, SEED, [0, 1])
    expected = contact_statistics(lines, few.isel(film_formula=[0]), weak)
    expected = expected["breakthrough_probability"].squeeze(
        ["slide_to_roll_ratio", "film_formula"], drop=True
    )
    undeformed = found["breakthrough_probability"].sel(roughness_model="undeformed", drop=True)
    np.testing.assert_array_equal(undeformed, expected.transpose(*undeformed.dims))


def test_without_flattening_both_are_the_same(spec, few, weak, monkeypatch):
    for module in (flattening, contact_runs):
        monkeypatch.setattr(module, "amplitude_ratio", lambda wavelength, *_: 0 * wavelength + 1)
    same = flattened_contact(spec, few, weak, SEED, [0, 1])
    both = same["breakthrough_probability"].transpose("roughness_model", ...).values
    # The waves beyond the band, of the rounding to whole height steps, are left out.
    np.testing.assert_allclose(both[1], both[0], atol=1e-3)
    np.testing.assert_allclose(same["roughness_ratio"], 1.0, rtol=1e-6)


def test_flattening_lowers_roughness_and_contact_the_more_the_higher_the_load(found):
    ratio = found["roughness_ratio"].squeeze()
    assert np.all((ratio > 0.3) & (ratio < 1.0))
    assert np.all(ratio.diff("force") < 0.0)
    mean = found["breakthrough_probability_mean"]
    assert np.all(mean.sel(roughness_model="flattened") <= mean.sel(roughness_model="undeformed"))
    lower, upper = found["probability_ratio_lower"], found["probability_ratio_upper"]
    known = found["probability_ratio"].values > 0.0
    assert known.any()
    inside = (lower <= found["probability_ratio"]) & (found["probability_ratio"] <= upper)
    assert inside.values[known].all()


def test_roughness_ratio_by_a_plain_transform(spec, few, found):
    """All waves of both lines one by one, from the lines as drawn."""
    here = {"temperature": -1, "speed": 0, "force": -1, "lubricant": 0}
    point = few.isel(here)
    power = np.zeros(2)
    for number in (0, 1):
        for line in draw_realisation(spec, SEED, number):
            waves = np.fft.rfft(line)[1:]
            wavelength = line.size * spec.spacing / np.arange(1, waves.size + 1)
            kept = amplitude_ratio(
                wavelength / point["contact_half_width"].item(),
                point["moes_load"].item(),
                point["moes_material"].item(),
            )
            power += [np.sum(np.abs(waves) ** 2), np.sum(np.abs(kept * waves) ** 2)]
    expected = np.sqrt(power[1] / power[0])
    assert found["roughness_ratio"].isel(here).item() == pytest.approx(expected, rel=0.03)
