"""Operating points as plain numbers, and the rows of a film table as such points."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from lube.schema import EXPERIMENT_DIMS


@dataclass(frozen=True)
class OperatingPoint:
    """An operating point of a rig, with what its contact follows from.

    Attributes
    ----------
    slide_to_roll_ratio : float
        (v1 - v2) / v, with the surface speeds and their mean v.
    lubricant : str
        Name of the lubricant.
    temperature, speed, force : float
        Levels of the study, degC, rpm and N.
    film_thickness, contact_half_width : float
        h0 and a, m.
    entrainment_speed : float
        Mean surface speed v, m/s.
    reduced_modulus : float
        E*, Pa.
    """

    slide_to_roll_ratio: float
    lubricant: str
    temperature: float
    speed: float
    force: float
    film_thickness: float
    contact_half_width: float
    entrainment_speed: float
    reduced_modulus: float

    @property
    def levels(self):
        """Levels of the operating variables, by the names of `lube.schema.EXPERIMENT_DIMS`."""
        return {name: getattr(self, name) for name in EXPERIMENT_DIMS}

    @property
    def faster_speed(self):
        """Speed of the faster surface, m/s."""
        return self.entrainment_speed * (1.0 + abs(self.slide_to_roll_ratio) / 2.0)

    @property
    def slower_speed(self):
        """Speed of the slower surface, m/s."""
        return self.entrainment_speed * (1.0 - abs(self.slide_to_roll_ratio) / 2.0)


def operating_points(table, slide_to_roll_ratio):
    """Operating points of a film table, in the order of its dimensions.

    Parameters
    ----------
    table : xarray.Dataset
        A ``film`` dataset of one film formula, without that dimension.
    slide_to_roll_ratio : float
        Of all points; the film does not depend on it.

    Returns
    -------
    list of OperatingPoint
        The lubricant changes most slowly, then temperature, speed and force.
    """
    names = EXPERIMENT_DIMS[1:]
    films = table["film_thickness"].transpose(*names).values
    half_widths = table["contact_half_width"].values
    speeds = table["entrainment_speed"].values
    modulus = table["reduced_modulus"].item()
    every_level = product(*(table[name].values.tolist() for name in names))
    return [
        OperatingPoint(
            slide_to_roll_ratio, *levels, film, half_widths[force], speeds[speed], modulus
        )
        for ((*_, speed, force), film), levels in zip(
            np.ndenumerate(films), every_level, strict=True
        )
    ]
