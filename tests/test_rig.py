"""The simulated rig: its contacts, and the right voltages, in whole steps, with their noise."""

import numpy as np
import pytest

from lube import rig as module
from lube.apparatus import Rig
from lube.contact import contact_statistics
from lube.points import operating_points
from lube.resistance import divider_voltage, resistance_from_voltage
from lube.rig import SimulatedRig, logged_voltage

TIME_STEP, SPOT, CAPACITANCE = 6e-7, 0.64, 2.7e-10
QUIET = {"noise": "0 V", "resolution": 32}


def logged(contact, rig, seed=1, capacitance=CAPACITANCE):
    rng = np.random.default_rng(seed)
    return logged_voltage(np.array(contact, np.int32), TIME_STEP, SPOT, capacitance, rig, rng)


@pytest.mark.parametrize("points", [1, 5, 200])
def test_a_steady_contact_is_logged_with_its_resistance(points):
    rig = Rig(**QUIET)
    resistance = resistance_from_voltage(logged(np.full(20_000, points), rig), rig)
    np.testing.assert_allclose(resistance, SPOT / points, rtol=1e-3, atol=1e-6)


def test_no_contact_is_logged_as_the_leak():
    rig = Rig(**QUIET)
    resistance = resistance_from_voltage(logged(np.zeros(20_000), rig), rig)
    np.testing.assert_allclose(resistance, rig.leak_resistance, rtol=1e-3)


def test_a_revolution_has_as_many_samples_as_fit_into_it():
    assert logged(np.zeros(100_000), Rig()).size == int(100_000 * TIME_STEP * 1e5) == 6_000
    assert logged(np.zeros(3), Rig()).size == 1


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


def test_an_amplifier_of_too_small_a_range_saturates():
    voltage = logged(np.zeros(20_000), Rig(amplifier_range="10 mV", **QUIET))
    np.testing.assert_allclose(voltage, 0.01, rtol=1e-6)


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
def points(rig_film):
    return operating_points(rig_film.isel(film_formula=0), 0.1)


@pytest.fixture(scope="module")
def revolutions(rig_lines, study, points):
    return list(SimulatedRig(rig_lines, study, points).revolutions())


def test_every_revolution_passes_all_points_in_order(revolutions, rig_lines, points):
    numbers = [number for number, _ in revolutions]
    assert numbers == [*range(len(points))] * rig_lines.sizes["realisation"]
    assert all(revolution.point is points[number] for number, revolution in revolutions)


def test_its_contacts_are_those_of_the_contact_stage(revolutions, rig_lines, rig_film, study):
    found = contact_statistics(rig_lines, rig_film, study.boundary_layer, [0.1])
    expected = found.breakthrough_probability.isel(film_formula=0)
    expected = expected.transpose("realisation", ..., "temperature", "speed", "force")
    shares = [np.mean(revolution.contact > 0) for _, revolution in revolutions]
    np.testing.assert_allclose(shares, expected.values.ravel(), rtol=1e-12)
    assert max(shares) > 0.01


def test_the_faster_surface_passes_one_grid_point_each_time_step(revolutions, rig_lines, study):
    _, revolution = revolutions[0]
    faster = 1.05 * revolution.point.entrainment_speed
    assert revolution.time_step == pytest.approx(rig_lines.attrs["spacing"] / faster)
    turn = 2.0 * np.pi * study.rollers.first.radius / faster
    assert revolution.contact.size * revolution.time_step == pytest.approx(turn)


def test_noise_is_of_its_revolution_and_point_and_no_other(revolutions, study, points):
    one, same, beside, later = (
        revolutions[number][1].voltage(study.rig) for number in (0, 0, 1, len(points))
    )
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, beside) and not np.array_equal(one, later)


def test_how_many_points_are_held_at_once_changes_nothing(
    revolutions, rig_lines, study, points, monkeypatch
):
    monkeypatch.setattr(module, "TOGETHER", 3)
    again = SimulatedRig(rig_lines, study, points).revolutions()
    for (number, revolution), (expected, other) in zip(again, revolutions, strict=True):
        assert number == expected
        np.testing.assert_array_equal(revolution.contact, other.contact)
