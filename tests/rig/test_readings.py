"""Contact shares as meters read them, of records whose contact is known."""

import numpy as np
import pytest

from lube.physics.electrical import divider_voltage
from lube.rig.readings import READINGS, read_shares
from lube.study.rig_settings import Experiment, Rig

RIG = Rig(leak_resistance="1 Gohm")
OPEN = divider_voltage(np.inf, RIG)


def shares(voltage, rig=RIG):
    found, _ = read_shares(voltage, Experiment(), rig)
    return dict(zip(READINGS, found, strict=True))


def record(share, closed, samples=100_000, noise=2e-5):
    """A record in contact at its beginning, with the resistance then, and noise."""
    is_closed = np.arange(samples) < share * samples
    noise = noise * np.random.default_rng(1).standard_normal(samples)
    return np.where(is_closed, divider_voltage(closed, RIG), OPEN) + noise


@pytest.mark.parametrize("share", [0.01, 0.3, 0.9])
def test_metal_contact_is_read_alike_in_all_ways(share):
    found = shares(record(share, closed=0.5))
    # A short circuit still shows the voltage over the leads.
    seen = share * (1.0 - divider_voltage(0.5, RIG) / OPEN)
    assert found["threshold"] == pytest.approx(share, abs=1e-4)
    assert found["adaptive threshold"] == pytest.approx(share, abs=1e-4)
    assert found["mean voltage"] == pytest.approx(seen, abs=1e-3)


def test_a_contact_of_as_many_ohms_as_the_resistor_is_half_of_one_by_the_mean():
    found = shares(record(0.4, closed=100.0 - 0.2))
    assert found["mean voltage"] == pytest.approx(0.2, abs=2e-3)
    # The threshold of 100 ohm is met by a part of the noise.
    assert 0.1 < found["threshold"] <= 0.4


def test_a_record_in_contact_is_open_to_an_adaptive_threshold():
    """It takes the record's own highest voltage for that of an open circuit."""
    found = shares(record(1.0, closed=5.0))
    assert found["threshold"] == 1.0
    assert found["adaptive threshold"] < 0.01
