"""The rollers and the oil of the busy study, as a notebook gives them."""

import math

import pytest
from studies import OIL

from lube import Oil, Rollers
from lube.calculator import bands, film_search
from lube.inference import planning
from lube.stages import tail


@pytest.fixture(scope="session")
def rollers(busy):
    spec = busy.study.line_spec
    return Rollers(
        radius="50 mm",
        rms_roughness="0.2 um",
        points=50_000,
        longest_wavelength=f"{2.0 * math.pi / spec.q_min!r} m",
        shortest_wavelength=f"{10.0 * spec.spacing!r} m",
        shear_strength="0.2 MPa",
    )


@pytest.fixture(scope="session")
def oil():
    return Oil(OIL)


@pytest.fixture(scope="module")
def few_samples():
    patch = pytest.MonkeyPatch()
    patch.setattr(bands, "SAMPLES", {"line": 32, "surface": 4})
    yield
    patch.undo()


@pytest.fixture
def few_pairs(monkeypatch):
    """Sample contact on few pairs: where all that is compared is of the same pairs."""
    for module in (tail, film_search, planning):
        monkeypatch.setattr(module, "PAIRS", 8)
