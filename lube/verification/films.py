"""Checks of the computed film, and of its response to the roughness."""

import numpy as np

from lube.ehl.film_formulas import moes
from lube.ehl.line_contact import FilmProfile, LineContact, solve
from lube.ehl.response import WaveResponse
from lube.physics.regimes import moes_asymptotes
from lube.types import Array
from lube.verification.check import percent_off

CORNERS = {
    "rigid_isoviscous": (0.003, 0.05),
    "rigid_piezoviscous": (0.1, 300.0),
    "elastic_isoviscous": (100.0, 1e-3),
}
"""Moes' numbers M and L in the corners of their plane, in the order of the asymptotes. Only the
first asymptote is exact there; the others are fits."""
FORMULA_AT = 100.0, 5.0
"""Moes' numbers at which his whole formula is compared."""
MARTIN = 2.447
"""M times the film at the line of centres between rigid rollers, over R* (2U)^0.5 (Martin 1916)."""
VENNER = {4.0: 0.030, 2.0: 0.073, 1.0: 0.183, 0.5: 0.394, 0.25: 0.660, 0.125: 0.839}
"""Part of its height that a wave keeps at the centre, by its wavelength over the half-width, at
M = 100, L = 11 and an amplitude of a tenth of the film: Venner, Couhier, Lubrecht and Greenwood
1996, Table 1, read in transcription."""
_THIN = 2.0
"""Twice a reduced modulus so low, Pa, that no pressure changes the density."""


def response() -> Array:
    """Compute the part of its height that each wave of Venner's table keeps, shape (waves,)."""
    # An oil of 20 1/GPa between steel rollers.
    material, film_modulus = 2e-8 * 2.308e11, 2.308e11
    speed = 0.5 * (11.0 / material) ** 4
    profile = solve(LineContact(100.0 * np.sqrt(2.0 * speed), speed, material, 0.1, film_modulus))
    centre = np.array([0.0])
    kept = [abs(WaveResponse(profile, each).transfer(1.0, centre).item()) for each in VENNER]
    return np.array(kept)


def film_checks(contact: LineContact, kept: Array) -> dict[str, float]:
    """Make all checks of the film.

    Parameters
    ----------
    contact : LineContact
        Contact of the study at an operating point.
    kept : numpy.ndarray
        From `response`.

    Returns
    -------
    dict of str to float
        Deviation of each check of `lube.verification.check.CHECKS`.
    """
    profile = solve(contact)
    finer, longer = solve(contact, fineness=2.0), solve(contact, flooded=1e5)
    found = {"martin": percent_off(_over_root(_corner(0.003, 0.05))[0], MARTIN / 0.003)}
    for number, (name, at) in enumerate(CORNERS.items()):
        found[name] = percent_off(_over_root(_corner(*at))[1], moes_asymptotes(*at)[number])
    by_formula = _corner(*FORMULA_AT)
    there = by_formula.contact
    formula = moes(there.load, there.speed, there.material)
    places = [profile.central_film, profile.minimum_film]
    return found | {
        "elastic_piezoviscous": percent_off(by_formula.flow.flux[0] * there.half_width**2, formula),
        "flux": round(100.0 * profile.mass_flux_defect, 7),  # less depends on the processor
        "moment": _moment_off(profile),
        "finer": percent_off(places, [finer.central_film, finer.minimum_film]),
        "longer_inlet": percent_off(places, [longer.central_film, longer.minimum_film]),
        "venner": percent_off(kept, list(VENNER.values())),
    }


def _corner(moes_load, moes_material):
    """Film of a Barus oil at M and L, at pressures that change no density."""
    speed = 1e-11
    root = np.sqrt(2.0 * speed)
    material = moes_material / np.sqrt(root)
    return solve(LineContact(moes_load * root, speed, material, 0.1, _THIN, "barus"))


def _over_root(profile):
    """Films at the line of centres and at the greatest pressure, over R* (2U)^0.5."""
    # Where the pressure is greatest it drives nothing, so the surfaces drag the whole flux.
    films = profile.central_film, profile.flow.flux[0] * profile.contact.half_width**2
    return np.array(films) / np.sqrt(2.0 * profile.contact.speed)


def _moment_off(profile: FilmProfile) -> float:
    """Difference of two forms of the resistance to rolling, which agree at any pressure, %."""
    scale = profile.contact.hertz_pressure / profile.contact.film_modulus
    moment = 2.0 * profile.rolling_resistance / (scale * profile.contact.half_width**2)
    return percent_off(np.sum(np.diff(profile.pressure) * profile.flow.gap), moment)
