"""Questions of the tests of what is required, and what is found for the answers."""

import numpy as np

import lube
from lube import Rollers

RUNS = {"realisations": 32, "seed": 2}
FEW = {"realisations": 8, "seed": 2}
POINT = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}
CHOICES = {"film_shape": "computed", "roughness_deformation": "venner-1997"}
SURFACE = {"contact_model": "surface", "seed": 2}


def without(name):
    return {key: value for key, value in POINT.items() if key != name}


def probability(rollers, oil, **changes):
    found = lube.contact_probability(rollers, oil, **POINT | changes, **RUNS)
    return found["breakthrough_probability_mean"].item()


def of_roughness(rms, spec):
    """Rollers as those of the tests, but of another rms roughness."""
    lengths = {
        "longest_wavelength": f"{2.0 * np.pi / spec.q_min!r} m",
        "shortest_wavelength": f"{10.0 * spec.spacing!r} m",
    }
    return Rollers("50 mm", rms, points=50_000, shear_strength="0.2 MPa", **lengths)


def assert_has_the_share(found, share):
    """The interval is as wide as the share is badly known."""
    lower, upper = (found[f"surface_breakthrough_probability{end}"] for end in ("_lower", "_upper"))
    assert abs(lower + upper - 2.0 * share) < 1.5 * (upper - lower) < 0.5 * share
