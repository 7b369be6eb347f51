"""Gold's form: its constants, and the coefficients of the paper's oil."""

import numpy as np
import pytest

from lube.physics.pressure_viscosity import GOLD_BASES, gold_pressure_viscosity
from lube.physics.viscosity_laws import evaluate_astm_d341, fit_astm_d341


def test_gold_gives_the_coefficients_of_physics_section_2_for_xmp_320():
    temperature = np.array([40.0, 50.0, 60.0, 70.0, 80.0]) + 273.15
    parameters = fit_astm_d341(np.array([313.15, 373.15]), np.array([335.0, 38.3]))
    viscosity = evaluate_astm_d341(temperature, *parameters)
    found = gold_pressure_viscosity(viscosity, "polyalphaolefin") * 1e9
    np.testing.assert_allclose(found, [16.0, 15.1, 14.3, 13.6, 13.0], atol=0.05)


def test_gold_at_1_mm2_per_s_is_s_and_grows_by_ten_to_the_t_a_decade():
    for base, (s, t) in GOLD_BASES.items():
        at_1, at_10 = gold_pressure_viscosity(np.array([1.0, 10.0]), base)
        assert at_1 == pytest.approx(s * 1e-9, rel=1e-12)
        assert np.log10(at_10 / at_1) == pytest.approx(t, rel=1e-12)
        assert t < 1.0 < s
