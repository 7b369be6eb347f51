"""Tables of spectra: exact integrals, a changed power, and bands that are refused."""

from dataclasses import replace

import numpy as np
import pytest

from lube.errors import DataError
from lube.surfaces.spectrum_table import LineSpectrum, band_table, power_law_integral, with_power


def test_power_law_integral_is_exact():
    q = np.array([1.0, 1.5, 4.0, 10.0])
    for exponent in (-2.4, -1.0, 0.0, 1.0):
        exact = np.log(10) if exponent == -1 else (10 ** (exponent + 1) - 1) / (exponent + 1)
        assert power_law_integral(q, q**exponent) == pytest.approx(exact, rel=1e-9)


def test_missing_power_goes_to_the_least_certain_densities():
    q = np.geomspace(1.0, 1e3, 60)
    changed = with_power(q, q**-2.0, q**2, 1.05)
    assert power_law_integral(q, changed) == pytest.approx(1.05, rel=1e-9)
    assert np.all(np.diff(changed / q**-2.0) <= 0.0)
    assert changed[-20:] == pytest.approx(q[-20:] ** -2.0, rel=1e-3)


def test_bands_beyond_the_measurement_are_refused():
    q = np.geomspace(1e4, 1e6, 30)
    known = LineSpectrum("a.csv", q, q**-2.4, np.ones(30), np.ones(30), True)
    with pytest.raises(DataError, match=r"a.csv: got waves up to 0.628 mm.* to 1.26 mm"):
        band_table(known, 5e3, 1e6)
    with pytest.raises(DataError, match=r"a.csv: got waves down to 6.28 µm.* to 3.14 µm"):
        band_table(known, 1e4, 2e6)
    negative = replace(known, density=-known.density)
    with pytest.raises(DataError, match="got a density of zero or less"):
        band_table(negative, 1e4, 1e6)
