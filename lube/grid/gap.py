"""The choices of how film and roughness make up the gap between the rollers."""

from dataclasses import dataclass

import numpy as np

from lube.errors import StudyError
from lube.types import FilmShape, RoughnessDeformation, Values


@dataclass(frozen=True)
class Gap:
    """How film and roughness make up the gap.

    Attributes
    ----------
    film_shape : str
        ``flat``: the film is flat and ends at the edges of the contact; ``computed``: it has the
        shape that follows from Reynolds' equation.
    roughness_deformation : str
        ``none``: the lines enter the gap as drawn; ``venner-1997``: the oil flattens their waves by
        `lube.physics.flattening`; ``computed``: the oil answers the lines, which means that it
        deforms each wave by the linear response of `lube.ehl.response`.
    """

    film_shape: FilmShape = "flat"
    roughness_deformation: RoughnessDeformation = "none"

    @property
    def has_shape(self) -> bool:
        """Whether the film is not flat."""
        return self.film_shape != "flat"

    @property
    def is_on_surfaces(self) -> bool:
        """Whether surfaces can enter the gap; the formula is for lines only."""
        return not self.is_flattened

    @property
    def is_flattened(self) -> bool:
        """Whether the oil flattens the lines alike everywhere in the contact."""
        return self.roughness_deformation == "venner-1997"

    @property
    def is_answered(self) -> bool:
        """Whether the oil answers the lines, differently at each position in the contact."""
        return self.roughness_deformation == "computed"

    @property
    def is_uniform(self) -> bool:
        """Whether film and lines are alike at all positions in the window; else it is uneven."""
        return not (self.has_shape or self.is_answered)

    def check_slip(self, slide_to_roll_ratio: Values) -> None:
        """Refuse slip of lines that a formula flattens.

        Parameters
        ----------
        slide_to_roll_ratio : float or numpy.ndarray
            Slide-to-roll ratios.

        Raises
        ------
        StudyError
            With the largest ratio, and what is needed.
        """
        most = max(np.ravel(slide_to_roll_ratio), key=abs)
        if self.is_flattened and most:
            raise StudyError(
                f"roughness_deformation: got {self.roughness_deformation} with a slide-to-roll "
                f"ratio of {most:g}, need none or computed, or a ratio of 0: its formula is for "
                "pure rolling"
            )

    @property
    def is_plain(self) -> bool:
        """Whether film thickness and contact width alone decide on contact, as in a master map."""
        return self == PLAIN


PLAIN = Gap()
"""Flat films, and lines as drawn."""
