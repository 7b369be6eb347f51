"""Film thickness of lubricated line contacts: the formulas, and where each may be used.

Every formula is a plain function of the groups W, U and G of `lube.physics.dimensionless`
(floats, or arrays that broadcast) and returns the film thickness over R*. Above each stands its
row of `FORMULAS`: adding a formula is writing the function and its row.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lube.errors import StudyError
from lube.physics.dimensionless import moes_numbers
from lube.physics.regimes import moes_asymptotes

FORMULAS = {}
"""Registry of the film formulas, by name; its order is the order of tables."""

TOLERANCE = 0.15
"""Relative error against the computed film up to which a formula counts as holding.

The film is not flat: at the outlet it is 15 to 18 % thinner than in the middle (for instance at
800 N, 100 r/min, 40 degC), and the contact model takes it as flat. A formula nearer than that is
as good as what is made of it.

The ranges in the rows below are this study's own. Each is the largest box in M and L in which the
formula stayed within the tolerance of numerical solutions of the Reynolds equation (Roelands
viscosity, Dowson-Higginson density, fully flooded), at M 0.1 to 100 and L 5 to 12, with the
paper's oil at 40, 60 and 80 degC: ``python tests/film_ranges.py``. Formulas of the central and
the mean film are held against the film in the middle, those of the minimum film against the
least.
"""


@dataclass(frozen=True)
class Formula:
    """One row of the registry of film formulas.

    Attributes
    ----------
    name : str
        Label along the dimension ``film_formula``.
    place : str
        Which film it gives: ``central``, ``minimum`` or ``mean``.
    evaluate : callable
        Film thickness over R* of (load, speed, material), that is W, U and G.
    source : str
        Where it was published.
    moes_load, moes_material : tuple of float
        Lowest and highest M and L for which it holds, both included.
    remark : str
        How far it was seen from the computed film there, and what else to know.
    """

    name: str
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
        load, material = (
            f"{low:g} to {high:g}" for low, high in (self.moes_load, self.moes_material)
        )
        return f"M {load}, L {material}; {self.remark}"


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


def _row(name, **entries):
    """Enter the function below into the registry."""

    def enter(evaluate):
        FORMULAS[name] = Formula(name=name, evaluate=evaluate, **entries)
        return evaluate

    return enter


@_row(
    name="paper",
    place="central",
    source="the paper, Eq. 3",
    moes_load=(1.5, 100.0),
    moes_material=(5.0, 12.0),
    remark="-6 to +13 %; 2.4 % above pan-hamrock by a digit transposed in print",
)
def paper(load, speed, material):
    """Central film of the paper's Eq. 3, with the constant 2.992 as printed."""
    return 2.992 * material**0.470 * speed**0.692 * load**-0.166


@_row(
    name="pan-hamrock",
    place="central",
    source="Pan & Hamrock, J. Tribol. 111 (1989)",
    moes_load=(1.3, 100.0),
    moes_material=(5.0, 12.0),
    remark="-8 to +15 %",
)
def pan_hamrock(load, speed, material):
    """Central film of Pan and Hamrock, the source of the paper's Eq. 3."""
    return 2.922 * material**0.470 * speed**0.692 * load**-0.166


@_row(
    name="pan-hamrock-minimum",
    place="minimum",
    source="Pan & Hamrock, J. Tribol. 111 (1989)",
    moes_load=(1.0, 100.0),
    moes_material=(5.0, 12.0),
    remark="-13 to +3 %",
)
def pan_hamrock_minimum(load, speed, material):
    """Minimum film of Pan and Hamrock, at the outlet constriction."""
    return 1.714 * material**0.568 * speed**0.694 * load**-0.128


@_row(
    name="dowson-toyoda",
    place="central",
    source="Dowson & Toyoda, Proc. 5th Leeds-Lyon Symp. Tribol. (1978)",
    moes_load=(0.6, 6.0),
    moes_material=(5.0, 6.0),
    remark="-9 to +14 %; up to 38 % above at higher M and L",
)
def dowson_toyoda(load, speed, material):
    """Central film of Dowson and Toyoda."""
    return 3.06 * material**0.56 * speed**0.69 * load**-0.10


@_row(
    name="dowson-higginson-minimum",
    place="minimum",
    source="Dowson & Higginson, Elasto-hydrodynamic Lubrication (1966); Dowson (1968)",
    moes_load=(0.8, 100.0),
    moes_material=(5.0, 12.0),
    remark="-12 to +12 %",
)
def dowson_higginson_minimum(load, speed, material):
    """Minimum film of Dowson and Higginson."""
    return 2.65 * material**0.54 * speed**0.7 * load**-0.13


@_row(
    name="grubin",
    place="mean",
    source="Grubin, Central Sci. Res. Inst. Technol. Mech. Eng., Book 30 (1949)",
    moes_load=(0.7, 12.0),
    moes_material=(6.0, 9.0),
    remark="-13 to +13 %; up to 34 % above at higher M and L",
)
def grubin(load, speed, material):
    """Film of Ertel and Grubin, whose Hertzian zone is parallel: one mean thickness."""
    return 1.95 * (material * speed) ** (8.0 / 11.0) * load ** (-1.0 / 11.0)


@_row(
    name="moes",
    place="central",
    source="Moes, Wear 159 (1992)",
    moes_load=(1.8, 3.5),
    moes_material=(5.0, 8.0),
    remark="+6 to +15 %; above the computed film everywhere, by 6 to 37 %: it gives the film of a "
    "Barus oil where the pressure is greatest",
)
def moes(load, speed, material):
    """Central film of Moes, which joins the asymptotes of all four regimes.

    See the note of `lube.physics.regimes.moes_asymptotes` for the place it is at.
    """
    rigid_iso, rigid_piezo, elastic_iso, elastic_piezo = moes_asymptotes(
        *moes_numbers(load, speed, material)
    )
    s = (7.0 + 8.0 * np.exp(-2.0 * elastic_iso / rigid_iso)) / 5.0
    isoviscous = rigid_iso ** (7.0 / 3.0) + elastic_iso ** (7.0 / 3.0)
    piezoviscous = rigid_piezo**-3.5 + elastic_piezo**-3.5
    film = (isoviscous ** (3.0 * s / 7.0) + piezoviscous ** (-2.0 * s / 7.0)) ** (1.0 / s)
    return film * np.sqrt(2.0 * speed)
