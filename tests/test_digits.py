"""Rounding to six digits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.digits import six_digits


@given(st.floats(1e-300, 1e300))
def test_six_digits_are_the_nearest(value):
    assert six_digits(np.array([value]))[0] == pytest.approx(value, rel=5.0001e-6)
    assert f"{six_digits(np.array([value]))[0]:.6g}" == f"{value:.6g}"
