"""The circuit: a naive second implementation, steady states and time constants."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.kernels.circuit import sampled_voltage

OPEN, TOUCHING = 1.0, 0.01


def sampled(contact, decays=(0.9, 0.2), filter_decay=0.7, ratio=1.0, samples=None, limit=10.0):
    contact = np.asarray(contact, np.int32)
    samples = samples or int(contact.size / ratio)
    targets = np.array([OPEN, TOUCHING])
    decays = np.array(decays)
    return sampled_voltage(contact, targets, decays, 0.8, 0.1, limit, filter_decay, ratio, samples)


def one_by_one(contact, decays, filter_decay, limit):
    """The same circuit at every time step, in plain Python."""
    targets = [OPEN, TOUCHING]
    gap = targets[contact[0]]
    voltage = float(np.clip(0.8 * gap + 0.1, -limit, limit))
    history = []
    for touching in contact:
        gap = targets[touching] + (gap - targets[touching]) * decays[touching]
        seen = float(np.clip(0.8 * gap + 0.1, -limit, limit))
        voltage = seen + (voltage - seen) * filter_decay
        history.append(voltage)
    return np.array(history)


@given(
    st.lists(st.tuples(st.integers(0, 1), st.integers(1, 60)), min_size=1, max_size=12),
    st.floats(0.0, 0.95),
    st.floats(0.0, 0.99),
    st.floats(1.0, 9.0),
    st.sampled_from([0.5, 10.0]),
)
def test_samples_are_those_of_the_circuit_step_by_step(pieces, decay, filter_decay, ratio, limit):
    contact = [touching for touching, steps in pieces for _ in range(steps)]
    decays = (decay, decay / 3.0)
    samples = max(int(len(contact) / ratio), 1)
    expected = one_by_one(contact, decays, filter_decay, limit)
    taken = (np.arange(samples) * ratio).astype(int)
    np.testing.assert_allclose(
        sampled(contact, decays, filter_decay, ratio, samples, limit), expected[taken], atol=1e-8
    )


def test_a_steady_contact_gives_a_steady_voltage():
    np.testing.assert_allclose(sampled(np.zeros(50)), 0.8 * OPEN + 0.1, rtol=1e-12)
    np.testing.assert_allclose(sampled(np.ones(50)), 0.8 * TOUCHING + 0.1, rtol=1e-12)


def test_the_low_pass_filter_approaches_its_input_exponentially():
    contact = np.r_[np.ones(1), np.zeros(40)]
    after = sampled(contact, decays=(0.0, 0.0), filter_decay=0.8)
    final = 0.8 * OPEN + 0.1
    np.testing.assert_allclose(
        final - after[1:], (final - after[0]) * 0.8 ** np.arange(1, 41), rtol=1e-9
    )


def test_the_amplifier_saturates_before_the_low_pass_filter():
    record = sampled(np.zeros(20), limit=0.3)
    np.testing.assert_allclose(record, 0.3)


@pytest.mark.parametrize("ratio", [1.0, 2.5, 7.0])
def test_samples_are_taken_at_their_times(ratio):
    contact = (np.arange(70) // 7 % 2).astype(np.int32)
    record = sampled(contact, decays=(0.0, 0.0), filter_decay=0.0, ratio=ratio)
    at = contact[(np.arange(record.size) * ratio).astype(int)]
    np.testing.assert_allclose(record, np.where(at, 0.8 * TOUCHING + 0.1, 0.8 * OPEN + 0.1))
