"""Viscosity index against the table and the examples of ASTM D2270."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.errors import RangeError
from lube.physics.viscosity_index import reference_oils, viscosity_at_100, viscosity_index


def test_reference_oils_meet_the_table_of_astm_d2270_and_join_smoothly():
    table = [  # KV100, L and H, mm2/s
        *((2.0, 7.994, 6.394), (3.0, 15.49, 12.15), (4.1, 26.50, 20.37), (4.7, 35.13, 25.63)),
        *((5.7, 52.64, 35.29), (6.7, 71.29, 45.33), (7.3, 84.53, 51.78), (8.0, 100.0, 59.60)),
        *((10.0, 147.7, 82.87), (13.0, 231.9, 121.5), (16.0, 331.9, 164.6), (20.0, 493.2, 229.5)),
        *((25.0, 736.5, 320.9), (38.5, 1613.0, 615.0), (50.0, 2618.0, 919.6)),
        *((60.0, 3676.0, 1222.0), (70.0, 4905.0, 1558.0)),
    ]
    for viscosity_100, low, high in table:
        assert reference_oils(viscosity_100) == pytest.approx((low, high), rel=5e-4)
    for joint in (3.8, 4.4, 5.0, 6.4, 7.0, 7.7, 9, 12, 15, 18, 22, 28, 40, 55, 70):
        below, above = reference_oils(joint * (1 - 1e-9)), reference_oils(joint)
        assert below == pytest.approx(above, rel=2e-3)


def test_viscosity_index_rounds_to_the_printed_figure():
    for viscosity_40, viscosity_100, printed in (
        (73.30, 8.86, 92),  # ASTM D2270, example of procedure A
        (22.83, 5.05, 156),  # ASTM D2270, examples of procedure B
        (53.47, 7.80, 111),
        (335.0, 38.3, 164),  # Mobilgear SHC XMP 320, physics.md section 2
        (320.0, 38.3, 170),
    ):
        assert round(viscosity_index(viscosity_40, viscosity_100)) == printed
    assert viscosity_index(335.0, 38.3) == pytest.approx(164.4, abs=0.05)


@given(st.floats(2.0, 200.0))
def test_reference_oils_have_the_viscosity_indices_0_and_100(viscosity_100):
    low, high = reference_oils(viscosity_100)
    assert viscosity_index(low, viscosity_100) == pytest.approx(0.0, abs=1e-9)
    assert viscosity_index(high, viscosity_100) == pytest.approx(100.0, abs=1e-9)
    # Procedures A and B meet at 100.
    assert viscosity_index(high * (1 - 1e-9), viscosity_100) == pytest.approx(100.0, abs=1e-4)


def test_viscosity_index_of_thin_liquids_is_refused():
    for viscosity_100 in (1.99, 0.0, float("nan")):
        with pytest.raises(RangeError, match="needs 2 mm2/s or more"):
            viscosity_index(5.0, viscosity_100)


@given(st.floats(15.0, 1500.0), st.floats(20.0, 300.0))
def test_viscosity_at_100_has_the_index_that_was_asked_for(viscosity_40, index):
    found = viscosity_at_100(viscosity_40, index)
    # At the joints of the standard's fits the index jumps a little.
    assert viscosity_index(viscosity_40, found) == pytest.approx(index, abs=1.0)


def test_no_viscosity_at_100_for_an_index_that_the_oil_cannot_have():
    with pytest.raises(RangeError, match="got a viscosity index of 10 at 5 mm2/s at 40 degC"):
        viscosity_at_100(5.0, 10.0)
    assert viscosity_at_100(335.0, 164.4) == pytest.approx(38.3, abs=0.01)
