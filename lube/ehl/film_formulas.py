"""Film thickness of lubricated line contacts: the formulas, and their ranges of validity.

Each formula is a plain function of the groups W, U and G of `lube.physics.dimensionless` (numbers,
or arrays that broadcast) and returns the film thickness over R*. The decorator above it is its row
of `FORMULAS`: to add a formula, write the function and its row. The last row is no formula but the
solution of Reynolds' equation, which `lube.grid.films` calls for.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lube.errors import StudyError, right_one
from lube.physics.dimensionless import moes_numbers
from lube.physics.regimes import moes_asymptotes
from lube.types import Values

TOLERANCE = 0.15
"""Relative error against a numerical solution up to which a formula counts as valid.

The film is not flat: at the outlet it is some 16 % thinner than at the centre (for instance at
800 N, 100 r/min, 40 degC), but the contact model takes it as flat. A formula with a smaller error
than that is as accurate as the model needs.

The validity ranges in the rows below were determined in this study. Each is the largest box in M
and L in which the formula stayed within the tolerance of numerical solutions of the Reynolds
equation (Roelands viscosity, Dowson-Higginson density, fully flooded), at M 0.1 to 100 and L 5 to
12, with the paper's oil at 40, 60 and 80 degC: ``python tests/film_ranges.py``. Each formula is
compared with the computed film that it stands for: at the line of centres, the minimum, or the mean
over the Hertzian zone.
"""


@dataclass(frozen=True)
class Formula:
    """One row of the registry of film formulas.

    Attributes
    ----------
    name : str
        Label along the dimension ``film_formula``.
    thickness : str
        Which film thickness it gives: ``central``, ``minimum`` or ``mean``.
    evaluate : callable or None
        Function of (load, speed, material), that is of W, U and G, that returns the film thickness
        over R*; None for the solution of Reynolds' equation.
    source : str
        Publication.
    remark : str
        Its error against the numerical solution in its range of validity, and other remarks.
    moes_load, moes_material : tuple of float
        Lowest and highest M and L of that range, both included; by default the full range of L
        above.
    """

    name: str
    thickness: str
    evaluate: Callable[..., Values] | None
    source: str
    remark: str
    moes_load: tuple[float, float]
    moes_material: tuple[float, float] = (5.0, 12.0)

    @property
    def depends_on_oil(self) -> bool:
        """Whether Reynolds' equation is solved; the film then depends on viscosity and E' too."""
        return self.evaluate is None

    def holds(self, moes_load: Values, moes_material: Values) -> bool | np.ndarray:
        """Check whether points lie within the formula's range of validity.

        Parameters
        ----------
        moes_load, moes_material : float, numpy.ndarray or xarray.DataArray
            M and L.

        Returns
        -------
        bool or array of bool
            True inside the limits, ends included.

        Examples
        --------
        >>> formula("pan-hamrock").holds(np.array([0.2, 2.0]), 8.0).tolist()
        [False, True]
        """
        (least, most), (lowest, highest) = self.moes_load, self.moes_material
        inside = (moes_load >= least) & (moes_load <= most)
        return inside & (moes_material >= lowest) & (moes_material <= highest)

    @property
    def validity(self) -> str:
        """Range of validity in words."""
        (least, most), (lowest, highest) = self.moes_load, self.moes_material
        return f"M {least:g} to {most:g}, L {lowest:g} to {highest:g}; {self.remark}"


_PAN_HAMROCK = "Pan & Hamrock, J. Tribol. 111 (1989)"

FORMULAS: dict[str, Formula] = {}
"""Registry of the film formulas by name, in the order of tables."""


def formula(name: str) -> Formula:
    """Find a film formula by its name.

    Parameters
    ----------
    name : str
        Name of a film formula.

    Returns
    -------
    Formula
        Its row of the registry.

    Raises
    ------
    StudyError
        If no formula has that name.

    Examples
    --------
    >>> formula("pan-hamrock").source
    'Pan & Hamrock, J. Tribol. 111 (1989)'
    """
    if name not in FORMULAS:
        raise StudyError(f"unknown film formula {name!r}, {right_one(name, FORMULAS)}")
    return FORMULAS[name]


def _register(thickness, source, remark, **limits):
    """Enter the function below into the registry, by its name with hyphens."""

    def enter(evaluate):
        name = evaluate.__name__.replace("_", "-")
        FORMULAS[name] = Formula(name, thickness, evaluate, source, remark, **limits)
        return evaluate

    return enter


@_register(
    "central",
    "the paper, Eq. 3",
    "-7 to +13 %; 2.4 % above pan-hamrock: one digit is misprinted",
    moes_load=(1.5, 100.0),
)
def paper(load: Values, speed: Values, material: Values) -> Values:
    r"""Central film of the paper's Eq. 3, with the constant 2.992 as printed.

    .. math:: h_0 / R^* = 2.992\, G^{0.470}\, U^{0.692}\, W^{-0.166}

    Examples
    --------
    >>> f"{paper(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '4.22e-05'
    """
    return 2.992 * material**0.470 * speed**0.692 * load**-0.166


@_register("central", _PAN_HAMROCK, "-9 to +15 %", moes_load=(1.3, 100.0))
def pan_hamrock(load: Values, speed: Values, material: Values) -> Values:
    r"""Central film of Pan and Hamrock, the source of the paper's Eq. 3.

    .. math:: h_0 / R^* = 2.922\, G^{0.470}\, U^{0.692}\, W^{-0.166}

    References
    ----------
    P. Pan and B. J. Hamrock, Simple formulas for performance parameters used in
    elastohydrodynamically lubricated line contacts, J. Tribol. 111 (1989) 246-251.

    Examples
    --------
    >>> f"{pan_hamrock(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '4.12e-05'
    """
    return 2.922 * material**0.470 * speed**0.692 * load**-0.166


@_register("minimum", _PAN_HAMROCK, "-13 to +3 %", moes_load=(1.0, 100.0))
def pan_hamrock_minimum(load: Values, speed: Values, material: Values) -> Values:
    r"""Minimum film of Pan and Hamrock, at the outlet constriction; source as in `pan_hamrock`.

    .. math:: h_{min} / R^* = 1.714\, G^{0.568}\, U^{0.694}\, W^{-0.128}

    Examples
    --------
    >>> f"{pan_hamrock_minimum(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '3.36e-05'
    """
    return 1.714 * material**0.568 * speed**0.694 * load**-0.128


@_register(
    "central",
    "Dowson & Toyoda, Proc. 5th Leeds-Lyon Symp. Tribol. (1978)",
    "-9 to +14 %; up to 37 % above at higher M and L",
    moes_load=(0.6, 6.0),
    moes_material=(5.0, 6.0),
)
def dowson_toyoda(load: Values, speed: Values, material: Values) -> Values:
    r"""Central film of Dowson and Toyoda.

    .. math:: h_0 / R^* = 3.06\, G^{0.56}\, U^{0.69}\, W^{-0.10}

    References
    ----------
    D. Dowson and S. Toyoda, A central film thickness formula for elastohydrodynamic line contacts,
    Proc. 5th Leeds-Lyon Symposium on Tribology (1978).

    Examples
    --------
    >>> f"{dowson_toyoda(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '4.53e-05'
    """
    return 3.06 * material**0.56 * speed**0.69 * load**-0.10


@_register(
    "minimum",
    "Dowson & Higginson, Elasto-hydrodynamic Lubrication (1966); Dowson (1968)",
    "-12 to +12 %",
    moes_load=(0.8, 100.0),
)
def dowson_higginson_minimum(load: Values, speed: Values, material: Values) -> Values:
    r"""Minimum film of Dowson and Higginson.

    .. math:: h_{min} / R^* = 2.65\, G^{0.54}\, U^{0.7}\, W^{-0.13}

    References
    ----------
    D. Dowson and G. R. Higginson, Elasto-hydrodynamic Lubrication, Pergamon Press, 1966;
    D. Dowson, Elastohydrodynamics, Proc. Inst. Mech. Eng. 182 (1968).

    Examples
    --------
    >>> f"{dowson_higginson_minimum(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '3.65e-05'
    """
    return 2.65 * material**0.54 * speed**0.7 * load**-0.13


@_register(
    "mean",
    "Grubin, Central Sci. Res. Inst. Technol. Mech. Eng., Book 30 (1949)",
    "-14 to +14 %; up to 31 % above at higher M and L",
    moes_load=(0.8, 8.0),
    moes_material=(6.0, 11.0),
)
def grubin(load: Values, speed: Values, material: Values) -> Values:
    r"""Mean film of Ertel and Grubin, who take the Hertzian zone as parallel.

    .. math:: \bar h / R^* = 1.95\, (G U)^{8/11}\, W^{-1/11}

    Examples
    --------
    >>> f"{grubin(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '4.15e-05'
    """
    return 1.95 * (material * speed) ** (8.0 / 11.0) * load ** (-1.0 / 11.0)


@_register(
    "central",
    "Moes, Wear 159 (1992)",
    "+6 to +15 %; above the computed film everywhere, by 6 to 36 %: it gives the film of a "
    "Barus oil where the pressure is greatest",
    moes_load=(1.8, 3.5),
    moes_material=(5.0, 8.0),
)
def moes(load: Values, speed: Values, material: Values) -> Values:
    r"""Central film of Moes, which joins the asymptotes of all four regimes.

    .. math::

        \frac{h_0}{R^*} = \sqrt{2U}
        \left[ \left( H_{RI}^{7/3} + H_{EI}^{7/3} \right)^{3s/7}
        + \left( H_{RP}^{-7/2} + H_{EP}^{-7/2} \right)^{-2s/7} \right]^{1/s},
        \qquad s = \frac{7 + 8 e^{-2 H_{EI} / H_{RI}}}{5}

    The asymptotes, and where in the contact this film is found, are given in
    `lube.physics.regimes.moes_asymptotes`.

    Examples
    --------
    >>> f"{moes(1.39e-5, 2.52e-11, 3696.0):.3g}"
    '4.51e-05'
    """
    numbers = moes_numbers(load, speed, material)
    rigid_iso, rigid_piezo, elastic_iso, elastic_piezo = moes_asymptotes(*numbers)
    s = (7.0 + 8.0 * np.exp(-2.0 * elastic_iso / rigid_iso)) / 5.0
    isoviscous = rigid_iso ** (7.0 / 3.0) + elastic_iso ** (7.0 / 3.0)
    piezoviscous = rigid_piezo**-3.5 + elastic_piezo**-3.5
    film = (isoviscous ** (3.0 * s / 7.0) + piezoviscous ** (-2.0 * s / 7.0)) ** (1.0 / s)
    return film * np.sqrt(2.0 * speed)


FORMULAS["computed"] = Formula(
    "computed",
    "central",
    None,
    "Reynolds' equation, solved by `lube.ehl.line_contact`",
    "a mesh twice as fine changes the film by less than 0.1 %",
    moes_load=(0.003, 100.0),
    moes_material=(0.05, 15.0),
)
