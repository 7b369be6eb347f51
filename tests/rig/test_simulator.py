"""The simulated rig: its contacts, and its voltages in whole steps, with their noise."""

from dataclasses import replace

import numpy as np
import pytest

from lube.contact.rough_pair import RoughPair, drawn, roughness_batch
from lube.contact.surface_revolution import revolution_contact
from lube.grid.gap import Gap
from lube.grid.operating_points import operating_points
from lube.physics.electrical import divider_voltage, resistance_from_voltage
from lube.rig import simulator as module
from lube.rig.simulator import Revolution, drifting_rollers, simulated_revolutions, whole_points
from lube.stages.contact import contact_statistics
from lube.study.rig_settings import Rig

TIME_STEP, SPOT, CAPACITANCE = 6e-7, 0.64, 2.7e-10
QUIET = {"noise": "0 V", "resolution": 32}


def logged(contact, rig, seed=1, capacitance=CAPACITANCE):
    contact = np.array(contact, np.int32)
    return Revolution(contact, TIME_STEP, SPOT, capacitance, (seed,)).voltage(rig)


def test_a_steady_contact_is_logged_with_its_resistance_and_none_as_the_leak():
    rig = Rig(**QUIET)
    for points, expected in ((0, rig.leak_resistance), (1, SPOT), (5, SPOT / 5), (200, SPOT / 200)):
        resistance = resistance_from_voltage(logged(np.full(20_000, points), rig), rig)
        np.testing.assert_allclose(resistance, expected, rtol=1e-3, atol=1e-6)


def test_voltages_are_whole_steps_of_the_converter_within_its_range():
    rig = Rig(resolution=8, amplifier_range="60 mV", noise="1 mV")
    voltage = logged(np.arange(30_000) // 900 % 2, rig)
    steps = voltage / rig.resolved_voltage
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-9)
    assert voltage.min() >= -0.06 and voltage.max() <= 0.06 * (1 - 1 / 128) + 1e-12


def test_the_noise_has_its_rms_and_its_seed():
    rig = Rig(resolution=24, noise="0.1 mV")
    one, same, other = (logged(np.zeros(300_000), rig, seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)
    assert np.std(one) == pytest.approx(1e-4, rel=0.02)
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.03


def test_the_filter_follows_what_happens_within_a_long_time_step():
    """Behind 10 kohm the film charges slowly, so that the mean voltage depends on every closing."""
    choosing, contact = np.random.default_rng(1), []
    while len(contact) < 50_000:
        contact += [0] * int(choosing.integers(20, 200)) + [40] * int(choosing.integers(1, 24))
    rig = Rig(preset="mtm-ecr-10-kohm", **QUIET, sampling_rate="400 kHz")
    coarse = Revolution(np.array(contact, np.int32), 2.5e-6, SPOT, 4e-10, (1,))
    fine = replace(coarse, contact=np.repeat(coarse.contact, 40), time_step=2.5e-6 / 40)
    reads = [1.0 - np.mean(one.voltage(rig)) / rig.bias_voltage for one in (coarse, fine)]
    assert reads[0] == pytest.approx(reads[1], rel=0.006)


def below(voltage, rig, threshold=100.0):
    return np.mean(voltage < divider_voltage(threshold, rig))


def test_a_narrow_band_misses_short_contacts_and_a_wide_one_does_not():
    contact = (np.arange(200_000) % 100 >= 90).astype(np.int32)  # 6 us of every 60 us
    shares = [
        below(logged(contact, rig), rig)
        for rig in (
            Rig(bandwidth=bandwidth, sampling_rate="1.6 MHz", **QUIET)
            for bandwidth in ("1 kHz", "30 kHz", "10 MHz")
        )
    ]
    assert shares[0] == 0.0
    assert shares[0] <= shares[1] < shares[2]
    assert shares[2] == pytest.approx(0.1, abs=0.01)


def test_a_large_capacitance_hides_how_soon_a_contact_ends():
    contact = (np.arange(200_000) % 1000 >= 990).astype(np.int32)
    rig = Rig(bandwidth="10 MHz", sampling_rate="1.6 MHz", **QUIET)
    small, large = (below(logged(contact, rig, 1, c), rig) for c in (1e-12, 1e-7))
    assert small == pytest.approx(0.01, abs=0.001)
    # The gap charges over 100 ohm: the same 100 ohm's half of the bias is reached after ln 2 R C.
    assert large - small == pytest.approx(np.log(2.0) * 100.2 * 1e-7 / 6e-4, rel=0.1)


# A rig with rollers of its own


@pytest.fixture(scope="module")
def finer(study):
    """The smoke study, on a grid fine enough for some contact."""
    roughness = study.roughness.model_copy(update={"points": 60_000})
    return study.model_copy(update={"roughness": roughness})


def lines_of(study):
    """The lines that its rig draws, for other stages."""
    return roughness_batch(study.line_spec, study.seed, study.rig_realisations)


@pytest.fixture(scope="module")
def points(rig_film):
    return operating_points(rig_film.isel(film_formula=0, force=[1], temperature=[0, 1]), 0.0)


@pytest.fixture(scope="module")
def slipping(rig_film):
    return operating_points(rig_film.isel(film_formula=0), 0.1)


def run(study, points):
    return list(simulated_revolutions(study, points))


def test_every_pair_passes_all_points_for_all_its_revolutions(finer, with_rig, points):
    several = with_rig(finer, pairs=3, revolutions=2.5)
    passed = run(several, points)
    assert [(pair, number) for pair, number, _ in passed] == [
        (pair, number)
        for pair in range(3)
        for _turn in range(3)
        for number in range(points.sizes["operating_point"])
    ]
    assert all(revolution.seed[2] == number + 1 for _, number, revolution in passed)
    sizes = [
        revolution.contact.size for pair, number, revolution in passed if (pair, number) == (0, 0)
    ]
    assert sizes == [60_000, 60_000, 30_000]


@pytest.mark.parametrize(("slip", "within"), [(0.0, 1e-12), (0.1, 0.01)])
def test_its_contacts_are_those_of_the_contact_stage(finer, with_rig, rig_film, slip, within):
    """With slip the second turn goes on where the first ended, to half a grid point."""
    two = with_rig(finer, pairs=2, revolutions=2)
    lines = lines_of(two)
    found = contact_statistics(lines, rig_film, finer.boundary_layer, [slip], revolutions=2)
    expected = found["breakthrough_probability"].isel(film_formula=0, slide_to_roll_ratio=0)
    points = operating_points(rig_film.isel(film_formula=0), slip)
    touched = np.zeros((2, points.sizes["operating_point"]))
    for pair, number, revolution in run(two, points):
        touched[pair, number] += np.mean(revolution.contact > 0) / 2.0
    np.testing.assert_allclose(touched.ravel(), expected.values.ravel(), rtol=within, atol=2e-5)
    assert touched.max() > 0.01


def test_surfaces_turn_as_they_were_drawn(finer, with_rig, points):
    weak = finer.boundary_layer.model_copy(update={"shear_strength": 1e4})
    several = with_rig(finer, pairs=2, revolutions=1.5, contact_model="surface")
    several = several.model_copy(update={"boundary_layer": weak})
    spec, drawn = several.line_spec, []
    for number in several.rig_realisations:
        lengths = revolution_contact(RoughPair.of(several), points, number)
        drawn.append(whole_points(lengths, spec))
    assert np.any(drawn) and not np.array_equal(*drawn)
    for pair, number, revolution in run(several, points):
        whole, turn = drawn[pair][number], revolution.seed[3]
        size = whole.size if turn == 0 else round(0.5 * whole.size)
        np.testing.assert_array_equal(revolution.contact, whole[:size])
        speed = points["entrainment_speed"][number].item()
        turned = revolution.time_step * whole.size * speed
        assert turned == pytest.approx(2.0 * np.pi * several.rollers.first.radius)


def test_contact_is_at_least_one_whole_point(finer):
    spec = finer.line_spec
    lengths = spec.spacing * np.array([0.0, 1e-6, 0.6, 2.4, 2.6])
    assert whole_points(lengths, spec).tolist() == [0, 1, 1, 2, 3]


@pytest.mark.parametrize("deformation", ["none", "venner-1997"])
def test_under_films_with_a_shape_too(finer, with_rig, shaped_film, deformation):
    """The contact stage looks at some windows, and rounds flattened lines otherwise.

    Under so weak a layer contact is frequent enough that some windows know it."""
    weak = finer.boundary_layer.model_copy(update={"shear_strength": 2e5})
    choices = {"film_shape": "computed", "roughness_deformation": deformation}
    changed = with_rig(finer.model_copy(update=choices | {"boundary_layer": weak}), revolutions=1)
    lines, gap = lines_of(changed), Gap("computed", deformation)
    found = contact_statistics(lines, shaped_film, weak, gap=gap)["breakthrough_probability"]
    points = operating_points(shaped_film.isel(film_formula=0), 0.0)
    touched = [np.mean(one.contact > 0) for _, _, one in run(changed, points)]
    expected = found.isel(film_formula=0).values.ravel()
    np.testing.assert_allclose(touched, expected, rtol=0.05, atol=5e-4)
    assert max(touched) > 0.03


@pytest.mark.parametrize(("drift", "kept"), [(0.3, 0.7**0.5), (1.0, 0.0)])
def test_drift_renews_its_share_of_the_variance_each_turn(finer, with_rig, drift, kept):
    drifting = with_rig(finer, drift=drift, revolutions=3)
    pairs = (drawn(drifting, number) for number in drifting.rig_realisations)
    first, second, third = (pair[0] for pair in drifting_rollers(drifting, pairs))
    assert np.corrcoef(first, second)[0, 1] == pytest.approx(kept, abs=0.05)
    assert np.corrcoef(first, third)[0, 1] == pytest.approx(kept**2, abs=0.05)
    assert np.std(third) == pytest.approx(np.std(first), rel=0.05)


def test_the_faster_surface_passes_one_grid_point_each_time_step(finer, with_rig, slipping):
    one = with_rig(finer, revolutions=1)
    _, _, revolution = run(one, slipping)[0]
    faster = 1.05 * slipping["entrainment_speed"][0].item()
    assert revolution.time_step == pytest.approx(finer.line_spec.spacing / faster)
    turn = 2.0 * np.pi * finer.rollers.first.radius / faster
    assert revolution.contact.size * revolution.time_step == pytest.approx(turn)


def test_noise_differs_between_pairs_points_and_turns(finer, with_rig, points):
    two = with_rig(finer, pairs=2, revolutions=2)
    passed = {}
    for pair, number, revolution in run(two, points):
        passed.setdefault((pair, number), []).append(revolution)
    silent = np.zeros(60_000, np.int32)

    def noise(pair, number, turn):
        return replace(passed[pair, number][turn], contact=silent).voltage(two.rig)

    np.testing.assert_array_equal(noise(0, 0, 0), noise(0, 0, 0))
    for other in ((1, 0, 0), (0, 0, 1)):
        assert not np.array_equal(noise(0, 0, 0), noise(*other))
    beside = noise(0, 1, 0)
    assert not np.array_equal(noise(0, 0, 0), beside[: noise(0, 0, 0).size])


def test_how_many_points_are_held_at_once_changes_nothing(finer, with_rig, slipping, monkeypatch):
    two = with_rig(finer, revolutions=2)
    expected = {}
    for pair, number, revolution in run(two, slipping):
        expected.setdefault((pair, number), []).append(revolution.contact)
    monkeypatch.setattr(module, "TOGETHER", 3)
    for pair, number, revolution in run(two, slipping):
        np.testing.assert_array_equal(revolution.contact, expected[pair, number].pop(0))
    assert not any(expected.values())
