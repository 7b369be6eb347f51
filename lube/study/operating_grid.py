"""The operating points of a study, and the traced ones among them."""

from typing import Annotated

from lube.study.field_types import StrictModel, levels, quantity


class OperatingGrid(StrictModel):
    """Levels of the operating variables; every combination is an operating point."""

    force: Annotated[tuple[float, ...], levels("N", above=0.0)]
    """normal forces"""
    speed: Annotated[tuple[float, ...], levels("rpm", above=0.0)]
    """rotation speeds of the first roller when it rolls without slip"""
    temperature: Annotated[tuple[float, ...], levels("degC", above=-273.15)]
    """temperatures of rollers and oil"""
    slide_to_roll_ratio: Annotated[tuple[float, ...], levels(None, least=-2.0, most=2.0)]
    """(v1 - v2) / mean surface speed; 0 is pure rolling"""

    @property
    def conditions(self) -> dict[str, tuple[float, ...]]:
        """The levels that records are assigned to: all but those of the slide-to-roll ratio."""
        return self.model_dump(exclude={"slide_to_roll_ratio"})


class TracePoint(StrictModel):
    """An operating point whose contact is kept at every time step of a revolution."""

    force: Annotated[float, quantity("N")]
    """a force of the grid"""
    speed: Annotated[float, quantity("rpm")]
    """a speed of the grid, the same for all traces"""
    temperature: Annotated[float, quantity("degC")]
    """a temperature of the grid"""
    lubricant: str | None = None
    """a lubricant of the study; by default its first"""
    film_formula: str | None = None
    """a formula of the study; by default its first"""
    slide_to_roll_ratio: Annotated[float, quantity(None)] | None = None
    """a ratio of the grid; by default its first"""
