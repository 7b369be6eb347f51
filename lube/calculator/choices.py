"""Choices of the model of an answer, and what it takes where none is given."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
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
class Choices:
    """What film and contact are made of, apart from the film formula.

    Attributes
    ----------
    gap : Gap
        How film and roughness make up the gap.
    models : tuple of str
        Contact models.
    load_sharing : str
        ``none``, or ``iterated``: the asperities carry a share of the load.
    inlet_shear_heating : str
        How heating at the inlet thins the film, as in a study.
    inlet_meniscus : float, optional
        Distance of the oil's meniscus before the line of centres, m; None if the contact is fully
        flooded.
    slip : float or xarray.DataArray
        Slide-to-roll ratio, of all operating points or of each.
    """

    gap: Gap = PLAIN
    models: tuple[types.ContactModel, ...] = ("line",)
    load_sharing: types.LoadSharing = "none"
    inlet_shear_heating: types.InletHeating = "none"
    inlet_meniscus: float | None = None
    slip: types.Values = 0.0

    @property
    def has_surfaces(self) -> bool:
        """Whether surfaces touch, so that the film comes with their share of the load."""
        return "surface" in self.models or self.load_sharing != "none"

    @classmethod
    def of(
        cls,
        gap: Gap = PLAIN,
        contact_model: types.ContactModel | Sequence[types.ContactModel] = "line",
        inlet_shear_heating: types.InletHeating = "none",
        inlet_meniscus: types.OneAmount | None = None,
        slide_to_roll_ratio: float = 0.0,
        load_sharing: types.LoadSharing = "none",
    ) -> "Choices":
        """Choose by the values of a study's keys.

        Raises
        ------
        StudyError
            If a study has no such choice, or a contact model is repeated.
        """
        slip = bare_number("slide_to_roll_ratio", slide_to_roll_ratio, least=-2.0, most=2.0)
        film = {"load_sharing": load_sharing, "inlet_shear_heating": inlet_shear_heating}
        for name, value in (vars(gap) | film).items():
            _check_choice(name, value, get_args(Study.model_fields[name].annotation))
        models = tuple(np.ravel(contact_model).tolist())
        for model in models or [contact_model]:
            _check_choice("contact_model", model, get_args(types.ContactModel))
        no_repetition("contact_model", models)
        if inlet_meniscus is not None:
            inlet_meniscus = single(amount("inlet_meniscus", inlet_meniscus, "m", above=0.0))
        return cls(gap, models, **film, inlet_meniscus=inlet_meniscus, slip=slip)

    @classmethod
    def of_smooth_rollers(
        cls,
        inlet_shear_heating: types.InletHeating,
        inlet_meniscus: types.OneAmount | None,
        slide_to_roll_ratio: float,
    ) -> "Choices":
        """As `of`, of a film without contact, which no lines or surfaces can refuse."""
        choices = cls.of(PLAIN, "line", inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio)
        return replace(choices, models=())


def _check_choice(name, value, options):
    if value not in options:
        raise StudyError(f"{name}: got {shown(value)}, {right_one(value, options)}")
