"""The first sample that breaks uniform sampling, against a plain search."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lube.kernels.threshold import CHUNK
from lube.kernels.uniform import first_uneven, first_unsound

places = st.sampled_from([0, 1, 7, CHUNK - 1, CHUNK, CHUNK + 1, 2 * CHUNK + 5])
sizes = st.sampled_from([1, 8, CHUNK, CHUNK + 1, CHUNK + 2, 3 * CHUNK])


@given(places, sizes, st.sampled_from([0.0, 0.5, 1.5, 2.0, -1.0, np.nan]))
def test_first_uneven_step_is_found_wherever_it_is(place, size, step):
    steps = np.ones(size)
    steps[place:][:1] = step
    times = np.cumsum(steps)
    assert first_uneven(times, 0.0, 1.0) == (place if place < size else -1)


@given(places, places, sizes, st.sampled_from([np.nan, np.inf, -np.inf, 3.0]))
def test_first_unsound_value_is_found_wherever_it_is(place, later, size, value):
    values = np.zeros(size)
    for index in (place, max(place, later)):
        values[index:][:1] = value
    assert first_unsound(values, 2.0) == (place if place < size else -1)


def test_infinity_is_sound_where_it_is_allowed():
    values = np.array([1.0, np.inf])
    assert first_unsound(values, np.inf) == -1
    assert first_unsound(values, np.finfo(float).max) == 1


def test_no_values_are_all_sound():
    assert first_unsound(np.array([]), 1.0) == -1
