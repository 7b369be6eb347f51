"""Choices of the model of an answer, and what it takes where none is given."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TypedDict, get_args

import numpy as np

from lube import types
from lube.calculator.arguments import amount, bare_number, no_repetition, single
from lube.errors import StudyError, right_one, shown
from lube.grid.gap import PLAIN, Gap
from lube.study.study import Study

FORMULA = "pan-hamrock"
"""Film formula if none is named: the source of the paper's Eq. 3, without its misprint."""


class Model(TypedDict):
    """Arguments that choose the model of an answer."""

    film_formula: str
    film_shape: types.FilmShape
    roughness_deformation: types.RoughnessDeformation
    contact_model: types.ContactModel
    inlet_shear_heating: types.InletHeating


COMPLETE: Model = {
    "film_formula": "computed",
    "film_shape": "computed",
    "inlet_shear_heating": "computed",
    "roughness_deformation": "computed",
    "contact_model": "surface",
}
"""The most complete model of this package: film, its shape and its response to the roughness by
Reynolds' equation, heating at the inlet, and contact of the rollers' surfaces over their length.
The contact is fully flooded unless ``inlet_meniscus`` is given, and the oil carries the whole load
unless ``load_sharing`` says otherwise."""
REALISATIONS = 64
SEED = 1


@dataclass(frozen=True)
class Inlet:
    """What thins the film at the inlet.

    Attributes
    ----------
    shear_heating : str
        How heating at the inlet thins the film, as in a study.
    meniscus : str, tuple, pint.Quantity or float, optional
        Distance of the oil's meniscus before the line of centres, as given or, in `Choices`, in m;
        None if the contact is fully flooded.
    """

    shear_heating: types.InletHeating = "none"
    meniscus: types.OneAmount | float | None = None


@dataclass(frozen=True)
class Choices:
    """What film and contact are made of.

    Attributes
    ----------
    film_formula : str or sequence of str
        Film formula, or several.
    gap : Gap
        How film and roughness make up the gap.
    models : tuple of str
        Contact models.
    load_sharing : str
        ``none``, or ``iterated``: the asperities carry a share of the load.
    inlet : Inlet
        What thins the film at the inlet.
    slip : float or xarray.DataArray
        Slide-to-roll ratio, of all operating points or of each.
    """

    film_formula: str | Sequence[str] = FORMULA
    gap: Gap = PLAIN
    models: tuple[types.ContactModel, ...] = ("line",)
    load_sharing: types.LoadSharing = "none"
    inlet: Inlet = field(default_factory=Inlet)
    slip: types.Values = 0.0

    @property
    def has_surfaces(self) -> bool:
        """Whether surfaces touch, so that the film comes with their share of the load."""
        return "surface" in self.models or self.load_sharing != "none"

    @property
    def formulas(self) -> list[str]:
        """The film formulas.

        Raises
        ------
        StudyError
            If they are neither a name nor a list of names, or have a name twice.
        """
        names = np.ravel(self.film_formula).tolist()
        if not names or not isinstance(names[0], str):
            came = f"got {shown(self.film_formula)}"
            raise StudyError(f"film_formula: {came}, need a name, or a list of them")
        no_repetition("film_formula", names)
        return names

    @classmethod
    def of(
        cls,
        film_formula: str | Sequence[str],
        gap: Gap,
        inlet: Inlet,
        load_sharing: types.LoadSharing = "none",
        slide_to_roll_ratio: float = 0.0,
        contact_model: types.ContactModel | Sequence[types.ContactModel] = "line",
    ) -> "Choices":
        """Choose by the values of a study's keys.

        Raises
        ------
        StudyError
            If a study has no such choice, or a contact model is repeated.
        """
        slip = bare_number("slide_to_roll_ratio", slide_to_roll_ratio, least=-2.0, most=2.0)
        film = {"load_sharing": load_sharing, "inlet_shear_heating": inlet.shear_heating}
        for name, value in (vars(gap) | film).items():
            _check_choice(name, value, get_args(Study.model_fields[name].annotation))
        models = tuple(np.ravel(contact_model).tolist())
        for model in models or [contact_model]:
            _check_choice("contact_model", model, get_args(types.ContactModel))
        no_repetition("contact_model", models)
        if inlet.meniscus is not None:
            metres = single(amount("inlet_meniscus", inlet.meniscus, "m", above=0.0))
            inlet = replace(inlet, meniscus=metres)
        return cls(film_formula, gap, models, load_sharing, inlet, slip)

    @classmethod
    def of_smooth_rollers(
        cls, film_formula: str | Sequence[str], inlet: Inlet, slide_to_roll_ratio: float
    ) -> "Choices":
        """As `of`, of a film without contact, which no lines or surfaces can refuse."""
        choices = cls.of(film_formula, PLAIN, inlet, slide_to_roll_ratio=slide_to_roll_ratio)
        return replace(choices, models=())


def _check_choice(name, value, options):
    if value not in options:
        raise StudyError(f"{name}: got {shown(value)}, {right_one(value, options)}")
