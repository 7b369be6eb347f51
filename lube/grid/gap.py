"""The choices of how film and roughness make up the gap between the rollers."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Gap:
    """How film and roughness make up the gap.

    Attributes
    ----------
    film_shape : str
        ``flat``: the film is flat and ends at the edges of the contact; ``computed``: it has the
        shape of the computed one.
    roughness_deformation : str
        ``none``: the lines reach the gap as drawn; ``venner-1997``: the oil flattens their waves by
        `lube.physics.flattening`.
    """

    film_shape: str = "flat"
    roughness_deformation: str = "none"

    @property
    def has_shape(self) -> bool:
        """Whether the film is not flat."""
        return self.film_shape != "flat"

    @property
    def is_flattened(self) -> bool:
        """Whether the oil flattens the lines."""
        return self.roughness_deformation != "none"

    @property
    def is_plain(self) -> bool:
        """Whether film thickness and contact width alone decide on contact: a map has it all."""
        return not (self.has_shape or self.is_flattened)


PLAIN = Gap()
"""Flat films, and lines as drawn."""
