"""Checks of the computed film, and of its response to the roughness."""

from typing import NamedTuple

import numpy as np

from lube.ehl.film_formulas import moes
from lube.ehl.line_contact import FilmProfile, LineContact, solve
from lube.ehl.response import WaveResponse
from lube.physics.regimes import moes_asymptotes
from lube.types import Array
from lube.verification.check import Check, percent_off

CORNERS = (
    ("rigid rollers, constant viscosity", 0, (0.003, 0.05), 0.5),
    ("rigid rollers, viscosity rising with pressure", 1, (0.1, 300.0), 5.0),
    ("elastic rollers, constant viscosity", 2, (100.0, 1e-3), 5.0),
)
"""Corners of the plane of Moes' numbers: name, number of the asymptote, M and L, and the greatest
deviation that passes, per cent. Only the first asymptote is exact there; the others are fits."""
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


class Response(NamedTuple):
    """Parts of their heights that waves keep.

    Attributes
    ----------
    wavelength, computed, printed : numpy.ndarray
        Shape (waves,); wavelengths over the half-width.
    """

    wavelength: Array
    computed: Array
    printed: Array


def response() -> Response:
    """Compute the waves of Venner's table."""
    # An oil of 20 1/GPa between steel rollers.
    material, film_modulus = 2e-8 * 2.308e11, 2.308e11
    speed = 0.5 * (11.0 / material) ** 4
    profile = solve(LineContact(100.0 * np.sqrt(2.0 * speed), speed, material, 0.1, film_modulus))
    centre = np.array([0.0])
    kept = [abs(WaveResponse.of(profile, each).transfer(1.0, centre).item()) for each in VENNER]
    return Response(*map(np.array, (list(VENNER), kept, list(VENNER.values()))))


def film_checks(contact: LineContact, found: Response) -> list[Check]:
    """Make all checks of the film.

    Parameters
    ----------
    contact : LineContact
        Contact of the study at an operating point.
    found : Response
        From `response`.

    Returns
    -------
    list of Check
        Their outcomes.
    """
    profile = solve(contact)
    finer, longer = solve(contact, fineness=2.0), solve(contact, flooded=1e5)
    checks = [
        Check(
            "film at the line of centres, rigid rollers",
            "Martin's film, 2.447/M",
            "exact",
            percent_off(_over_root(_corner(0.003, 0.05))[0], MARTIN / 0.003),
            0.5,
            "%",
            "Martin 1916",
        )
    ]
    for name, number, at, allowed in CORNERS:
        asymptote = moes_asymptotes(*at)[number]
        checks.append(
            Check(
                f"film at the greatest pressure, {name} (M = {at[0]:g}, L = {at[1]:g})",
                "Moes' asymptote",
                "exact" if number == 0 else "print",
                percent_off(_over_root(_corner(*at))[1], asymptote),
                allowed,
                "%",
                "Moes 1992",
            )
        )
    by_formula = _corner(*FORMULA_AT)
    contact_there = by_formula.contact
    formula = moes(contact_there.load, contact_there.speed, contact_there.material)
    flux = by_formula.flow.flux[0] * contact_there.half_width**2
    checks.append(
        Check(
            "film at the greatest pressure, elastic rollers, viscosity rising with pressure "
            f"(M = {FORMULA_AT[0]:g}, L = {FORMULA_AT[1]:g})",
            "Moes' formula",
            "print",
            percent_off(flux, formula),
            2.0,
            "%",
            "Moes 1992",
        )
    )
    places = [profile.central_film, profile.minimum_film]
    checks += [
        Check(
            f"mass flux from node to node, {contact.name}",
            "the flux at the line of centres",
            "exact",
            round(100.0 * profile.mass_flux_defect, 7),  # smaller ones depend on the processor
            1e-6,
            "%",
            "Reynolds' equation",
        ),
        Check(
            "film times the rise of the pressure, along the contact",
            "moment of the pressure about the line of centres",
            "exact",
            _moment_off(profile),
            0.3,
            "%",
            "Biboulet and Houpert 2010",
        ),
        Check(
            "central and least film",
            "twice as many nodes",
            "grid",
            percent_off(places, [finer.central_film, finer.minimum_film]),
            0.1,
            "%",
            "second order",
        ),
        Check(
            "central and least film",
            "an inlet ten times as high",
            "grid",
            percent_off(places, [longer.central_film, longer.minimum_film]),
            0.1,
            "%",
            "flooded",
        ),
        Check(
            "part of its height that a wave keeps, M = 100, L = 11, linear",
            "Venner's Table 1, nonlinear",
            "print",
            percent_off(found.computed, found.printed),
            8.0,
            "%",
            "Venner and others 1996",
        ),
    ]
    return checks


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
    return percent_off(np.sum(np.diff(profile.pressure) * profile.middle_gap), moment)
