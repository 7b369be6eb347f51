"""Film thickness of lubricated line contacts: formulas, their registry and the regimes.

Every formula is a plain function of three dimensionless groups, with the load w' per length,
the entrainment speed v (the *mean* of the surface speeds), the reduced radius R* and
E' = 2 E* (twice the reduced modulus of `lube.hertz`)::

    W = w' / (E' R*)        U = eta0 v / (E' R*)        G = alpha E'

and returns the film thickness over R*. `FORMULAS` holds one row a formula: adding a formula
is writing the function and its row.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lube.errors import StudyError

ELASTIC_PIEZOVISCOUS = {"moes_load": (1.5, 100.0), "moes_material": (5.0, 12.0)}
"""Where the power laws are taken to hold.

The limits are derived, not published: in this box `pan_hamrock` was compared with a numerical
solution of the Reynolds equation (Roelands viscosity, Dowson-Higginson density, fully flooded)
and stayed within 12 %; over the paper's grid, within 10 %. Below M = 1.5 the contact leaves
the elastic regime: 400 N, 150 r/min, 60 degC (M = 1.23) is 15 % off, 100 N, 200 r/min, 40 degC
(M = 0.17) 39 %. On the way down the error changes sign, so that single points agree by chance.
"""

ALL_REGIMES = {"moes_load": (0.0, np.inf), "moes_material": (0.0, np.inf)}
"""Limits of a formula that joins the asymptotes of every regime."""


@dataclass(frozen=True)
class Formula:
    """One row of the registry of film formulas.

    Attributes
    ----------
    name : str
        Label along the dimension ``film_formula``.
    title : str
        Authors and equation, in words.
    place : str
        Which film it gives: ``central``, ``minimum`` or ``mean``.
    evaluate : callable
        Film thickness over R* of (load, speed, material), that is W, U and G.
    source : str
        Where it was published.
    moes_load, moes_material : tuple of float
        Lowest and highest M and L for which it holds, both included.
    remark : str
        How far it was seen from a numerical solution there, and what else to know.
    """

    name: str
    title: str
    place: str
    evaluate: Callable
    source: str
    moes_load: tuple
    moes_material: tuple
    remark: str

    def holds(self, moes_load, moes_material):
        """Whether the formula is within its range of validity.

        Parameters
        ----------
        moes_load, moes_material : float, numpy.ndarray or xarray.DataArray
            M and L.

        Returns
        -------
        bool or array of bool
            True inside the limits, ends included.
        """
        least_load, greatest_load = self.moes_load
        least_material, greatest_material = self.moes_material
        return (
            (moes_load >= least_load)
            & (moes_load <= greatest_load)
            & (moes_material >= least_material)
            & (moes_material <= greatest_material)
        )

    @property
    def validity(self):
        """Range of validity in words."""
        if not np.isfinite(self.moes_load[1]):
            return f"all regimes; {self.remark}"
        load, material = (
            f"{low:g} to {high:g}" for low, high in (self.moes_load, self.moes_material)
        )
        return f"M {load}, L {material}; {self.remark}"


def dimensionless_load(load_per_length, film_modulus, reduced_radius):
    """Load parameter W = w' / (E' R*).

    Parameters
    ----------
    load_per_length : float or numpy.ndarray
        Force per length of the contact w' = F_N / L', N/m.
    film_modulus, reduced_radius : float
        E' = 2 E* in Pa and R* in m.

    Returns
    -------
    float or numpy.ndarray
        Load parameter W.
    """
    return load_per_length / (film_modulus * reduced_radius)


def dimensionless_speed(viscosity, entrainment_speed, film_modulus, reduced_radius):
    """Speed parameter U = eta0 v / (E' R*), with the mean of the surface speeds.

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity eta0 at ambient pressure, Pa s.
    entrainment_speed : float or numpy.ndarray
        Mean surface speed v = (v1 + v2) / 2, m/s.
    film_modulus, reduced_radius : float
        E' = 2 E* in Pa and R* in m.

    Returns
    -------
    float or numpy.ndarray
        Speed parameter U.
    """
    return viscosity * entrainment_speed / (film_modulus * reduced_radius)


def dimensionless_material(pressure_viscosity_coefficient, film_modulus):
    """Materials parameter G = alpha E'.

    Parameters
    ----------
    pressure_viscosity_coefficient : float or numpy.ndarray
        Pressure-viscosity coefficient alpha, 1/Pa.
    film_modulus : float
        E' = 2 E*, Pa.

    Returns
    -------
    float or numpy.ndarray
        Materials parameter G.
    """
    return pressure_viscosity_coefficient * film_modulus


def moes_numbers(load, speed, material):
    """Moes' load number M = W (2U)^(-1/2) and material number L = G (2U)^(1/4).

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G. Moes' own speed parameter is made with the sum of the surface speeds,
        twice the mean; hence 2U.

    Returns
    -------
    tuple of float or numpy.ndarray
        M and L.

    References
    ----------
    Moes, Wear 159 (1992).
    """
    return load / np.sqrt(2.0 * speed), material * (2.0 * speed) ** 0.25


def paper(load, speed, material):
    """Central film of the paper's Eq. 3, with the constant 2.992 as printed.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*.
    """
    return 2.992 * material**0.470 * speed**0.692 * load**-0.166


def pan_hamrock(load, speed, material):
    """Central film of Pan and Hamrock, the source of the paper's Eq. 3.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*.
    """
    return 2.922 * material**0.470 * speed**0.692 * load**-0.166


def pan_hamrock_minimum(load, speed, material):
    """Minimum film of Pan and Hamrock, at the outlet constriction.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*.
    """
    return 1.714 * material**0.568 * speed**0.694 * load**-0.128


def dowson_toyoda(load, speed, material):
    """Central film of Dowson and Toyoda.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*.
    """
    return 3.06 * material**0.56 * speed**0.69 * load**-0.10


def dowson_higginson_minimum(load, speed, material):
    """Minimum film of Dowson and Higginson.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*.
    """
    return 2.65 * material**0.54 * speed**0.7 * load**-0.13


def grubin(load, speed, material):
    """Film of Ertel and Grubin, whose Hertzian zone is parallel: one mean thickness.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*.
    """
    return 1.95 * (material * speed) ** (8.0 / 11.0) * load ** (-1.0 / 11.0)


def moes_asymptotes(moes_load, moes_material):
    """Moes' film parameter in the four corners of the (M, L) plane.

    Parameters
    ----------
    moes_load, moes_material : float or numpy.ndarray
        M and L.

    Returns
    -------
    tuple of float or numpy.ndarray
        Rigid-isoviscous 3/M, rigid-piezoviscous 1.287 L^(2/3), elastic-isoviscous
        2.621 M^(-1/5), elastic-piezoviscous 1.311 M^(-1/8) L^(3/4), in the order of
        `lube.schema.REGIMES`. Each is film thickness over R* (2U)^(1/2).

    Notes
    -----
    The film meant is the one where the pressure is greatest. In the rigid limits that is
    1.226 times the film at the line of centres: 3/M is 2.447/M there, Martin's 4.9 U/W.
    """
    return (
        3.0 / moes_load,
        1.287 * moes_material ** (2.0 / 3.0),
        2.621 * moes_load**-0.2,
        1.311 * moes_load**-0.125 * moes_material**0.75,
    )


def moes(load, speed, material):
    """Central film of Moes, which joins the asymptotes of all four regimes.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    float or numpy.ndarray
        Film thickness over R*; see the note of `moes_asymptotes` for the place it is at.
    """
    rigid_iso, rigid_piezo, elastic_iso, elastic_piezo = moes_asymptotes(
        *moes_numbers(load, speed, material)
    )
    s = (7.0 + 8.0 * np.exp(-2.0 * elastic_iso / rigid_iso)) / 5.0
    isoviscous = rigid_iso ** (7.0 / 3.0) + elastic_iso ** (7.0 / 3.0)
    piezoviscous = rigid_piezo**-3.5 + elastic_piezo**-3.5
    film = (isoviscous ** (3.0 * s / 7.0) + piezoviscous ** (-2.0 * s / 7.0)) ** (1.0 / s)
    return film * np.sqrt(2.0 * speed)


def regime_films(load, speed, material):
    """Film parameter H W/U that each of the four regimes alone would give.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    numpy.ndarray
        Shape (4, ...), in the order of `lube.schema.REGIMES`: 4.9, 1.05 g_V^(2/3),
        3.10 g_E^0.8 and 2.65 g_V^0.54 g_E^0.06 with the viscosity number
        g_V = W^1.5 G U^-0.5 and the elasticity number g_E = W U^-0.5.

    References
    ----------
    Johnson, J. Mech. Eng. Sci. 12 (1970), for the chart; the last constants are those of Martin,
    Herrebrugh and Dowson and Higginson.

    Notes
    -----
    4.9, 3.10 and 2.65 belong to the mean speed. Reynolds' equation for a rigid cylinder and a
    Barus oil gives 1.666 g_V^(2/3) with the mean speed; 1.05 is that constant for the sum of
    the speeds. It is kept because the greatest-of-four rule needs it: 2.65 g_V^0.54 g_E^0.06
    falls behind 1.666 g_V^(2/3) as the load rises, and heavily loaded contacts would be
    called rigid.
    """
    viscosity_number = load**1.5 * material / np.sqrt(speed)
    elasticity_number = load / np.sqrt(speed)
    films = (
        np.full_like(elasticity_number * viscosity_number, 4.9),
        1.05 * viscosity_number ** (2.0 / 3.0),
        3.10 * elasticity_number**0.8,
        2.65 * viscosity_number**0.54 * elasticity_number**0.06,
    )
    return np.stack(np.broadcast_arrays(*films))


def regime(load, speed, material):
    """Regime of lubrication: the one whose formula gives the thickest film.

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G.

    Returns
    -------
    numpy.ndarray of int64
        Index into `lube.schema.REGIMES`. It sorts the contacts roughly; whether a formula
        may be used is decided by its limits in M and L, not by the regime.
    """
    return np.argmax(regime_films(load, speed, material), axis=0)


def inlet_shear_heating_factor(
    viscosity, temperature_viscosity_coefficient, entrainment_speed, thermal_conductivity
):
    """Film reduction by shear heating in the inlet, C = 1 / (1 + 0.254 Q^0.62).

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity eta at ambient pressure, Pa s.
    temperature_viscosity_coefficient : float or numpy.ndarray
        Relative fall of viscosity with temperature beta = -d(ln eta)/dT, 1/K.
    entrainment_speed : float or numpy.ndarray
        Mean surface speed v, m/s.
    thermal_conductivity : float or numpy.ndarray
        Of the oil, k, W/(m K).

    Returns
    -------
    float or numpy.ndarray
        Factor C between 0 and 1, with the thermal loading Q = eta beta v^2 / k.

    References
    ----------
    Murch and Wilson, J. Lubr. Technol. 97 (1975). Derived for rolling without sliding.
    """
    loading = (
        viscosity * temperature_viscosity_coefficient * entrainment_speed**2 / thermal_conductivity
    )
    return 1.0 / (1.0 + 0.254 * loading**0.62)


_ROWS = (
    Formula(
        name="paper",
        title="Eq. 3 of the paper as printed, constant 2.992",
        place="central",
        evaluate=paper,
        source="the paper, Eq. 3",
        remark="2.4 % above pan-hamrock by a digit transposed in print",
        **ELASTIC_PIEZOVISCOUS,
    ),
    Formula(
        name="pan-hamrock",
        title="Pan and Hamrock, central film, constant 2.922",
        place="central",
        evaluate=pan_hamrock,
        source="Pan & Hamrock, J. Tribol. 111 (1989)",
        remark="-12 to +10 % of a numerical solution",
        **ELASTIC_PIEZOVISCOUS,
    ),
    Formula(
        name="pan-hamrock-minimum",
        title="Pan and Hamrock, minimum film",
        place="minimum",
        evaluate=pan_hamrock_minimum,
        source="Pan & Hamrock, J. Tribol. 111 (1989)",
        remark="-7 to +6 % of a numerical solution",
        **ELASTIC_PIEZOVISCOUS,
    ),
    Formula(
        name="dowson-toyoda",
        title="Dowson and Toyoda, central film",
        place="central",
        evaluate=dowson_toyoda,
        source="Dowson & Toyoda, Proc. 5th Leeds-Lyon Symp. Tribol. (1978)",
        remark="+3 to +18 % of a numerical solution to M = 10, +40 % at M = 100",
        **ELASTIC_PIEZOVISCOUS,
    ),
    Formula(
        name="dowson-higginson-minimum",
        title="Dowson and Higginson, minimum film",
        place="minimum",
        evaluate=dowson_higginson_minimum,
        source="Dowson & Higginson, Elasto-hydrodynamic Lubrication (1966); Dowson (1968)",
        remark="0 to +15 % of a numerical solution",
        **ELASTIC_PIEZOVISCOUS,
    ),
    Formula(
        name="grubin",
        title="Ertel and Grubin, parallel film",
        place="mean",
        evaluate=grubin,
        source="Grubin, Central Sci. Res. Inst. Technol. Mech. Eng., Book 30 (1949)",
        remark="-15 to +15 % of a numerical solution to M = 20, +24 % at M = 100",
        **ELASTIC_PIEZOVISCOUS,
    ),
    Formula(
        name="moes",
        title="Moes, central film, all regimes",
        place="central",
        evaluate=moes,
        source="Moes, Wear 159 (1992)",
        remark="the film where the pressure is greatest, for a Barus oil; 8 to 27 % above the "
        "film in the middle for a Roelands oil over the paper's grid",
        **ALL_REGIMES,
    ),
)

FORMULAS = {row.name: row for row in _ROWS}
"""Registry of the film formulas, by name; its order is the order of tables."""


def formula(name):
    """Row of the registry.

    Parameters
    ----------
    name : str
        Name of a film formula.

    Returns
    -------
    Formula
        Its row.

    Raises
    ------
    StudyError
        If no formula has that name.
    """
    if name not in FORMULAS:
        raise StudyError(f"unknown film formula {name!r}, need one of {', '.join(FORMULAS)}")
    return FORMULAS[name]
