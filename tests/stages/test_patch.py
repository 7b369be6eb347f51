"""Surfaces and lines pressed against a flat: what the stage says beside `elastic_contact`."""

import importlib.util
import sys

import numpy as np
import pytest

from lube.errors import LubeError
from lube.schema import check
from lube.stages import patch
from lube.stages.patch import patch_contact

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("tamaas") is None, reason="tamaas is not installed"
)
MODULUS = 1.154e11


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(100_000)


@pytest.fixture(scope="module")
def pressed(spec):
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(patch, "REALISATIONS", 2)
        changed.setattr(patch, "PRESSURES", (0.003, 0.03))
        yield patch_contact(spec, MODULUS, 1)


def test_the_surface_is_as_rough_as_the_study_says(pressed, spec):
    check(pressed, "patch")
    assert pressed["rms_height"].item() == pytest.approx(0.2e-6 * np.sqrt(2.0))
    assert pressed["side"].item() == pytest.approx(2.0 * np.pi / spec.q_min, rel=0.02)
    expected = pressed["relative_pressure"] * MODULUS * pressed["rms_gradient"]
    np.testing.assert_allclose(pressed["pressure"], expected)


def test_more_pressure_closes_the_gap_of_surface_and_line(pressed):
    steps = pressed.diff("relative_pressure")
    assert (steps["gap"] < 0.0).all()
    for name in ("contact_area_share", "line_pressure", "line_contact_area_share"):
        assert (steps[name] > 0.0).all()


def test_the_area_is_in_proportion_to_the_pressure_nearly(pressed):
    """Between Persson's theory and that of Bush, Gibson and Thomas, less at high pressures."""
    factors = pressed["contact_area_share"].mean("realisation") / pressed["relative_pressure"]
    low, high = factors.values
    assert 0.8 * np.sqrt(8.0 / np.pi) < high < low < 1.2 * np.sqrt(2.0 * np.pi)


def test_realisations_differ_and_the_seed_decides(pressed, spec, monkeypatch):
    assert np.ptp(pressed["gap"].values, axis=0).min() > 0.0
    monkeypatch.setattr(patch, "REALISATIONS", 1)
    monkeypatch.setattr(patch, "PRESSURES", (0.003, 0.03))
    again = patch_contact(spec, MODULUS, 1)
    assert again.equals(pressed.isel(realisation=[0]))


def test_without_tamaas_one_line_comes_before_any_work(spec, monkeypatch):
    monkeypatch.setattr(patch, "rough_surface", None)
    monkeypatch.setitem(sys.modules, "tamaas", None)
    with pytest.raises(LubeError, match="tamaas is not installed"):
        patch_contact(spec, MODULUS, 1)
