"""Errors of each film formula against the computed film, over Moes' M and L.

``python tests/film_ranges.py`` computes 888 films in half a minute, and prints for every formula
the largest box in which it stays within the tolerance, and its errors there: these are the ranges
and remarks of `lube.ehl.film_formulas`.
"""

import functools
from itertools import combinations, product

import numpy as np
from paper_grid import ALPHA, MODULUS, VISCOSITY

from lube.ehl.film_formulas import FORMULAS, TOLERANCE
from lube.ehl.line_contact import LineContact, solve
from lube.physics.dimensionless import dimensionless_material

LOADS = np.array([
    0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0,
    2.2, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 70.0,
    100.0,
])  # fmt: skip
MATERIALS = np.array([5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0])
OILS = [(VISCOSITY[at], ALPHA[at]) for at in (0, 2, 4)]  # the paper's at 40, 60 and 80 degC


@functools.cache
def relative_errors(moes_load, moes_material, viscosity, alpha):
    """Relative error of each formula against the computed film of its place.

    The oil is given, because Roelands' law needs more than M and L; speed and load follow.
    """
    material = dimensionless_material(alpha, 2 * MODULUS)
    speed = (moes_material / material) ** 4 / 2
    numbers = moes_load * np.sqrt(2 * speed), speed, material
    profile = solve(LineContact(*numbers, viscosity, 2 * MODULUS))
    return {
        name: row.evaluate(*numbers) / getattr(profile, f"{row.thickness}_film") - 1
        for name, row in FORMULAS.items()
        if not row.depends_on_oil
    }


def largest_box(holds):
    """Slices of M and L in which the formula holds everywhere, largest in log M times log L."""
    spans = [
        [slice(at, to + 1) for at, to in combinations(range(levels.size), 2)]
        for levels in (LOADS, MATERIALS)
    ]
    inside = [box for box in product(*spans) if holds[box].all()]
    return max(inside, key=lambda box: _extent(LOADS[box[0]]) * _extent(MATERIALS[box[1]]))


def _extent(levels):
    return np.log(levels[-1] / levels[0])


def main():
    """Print each formula's range, and its errors there and over all that was computed."""
    errors = [
        [[relative_errors(load, l_, *oil) for oil in OILS] for l_ in MATERIALS] for load in LOADS
    ]
    for name in errors[0][0][0]:
        each = np.array([[[error[name] for error in oils] for oils in row] for row in errors])
        box = largest_box((np.abs(each) <= TOLERANCE).all(axis=2))
        (loads, materials), inside = (LOADS[box[0]], MATERIALS[box[1]]), each[box]
        print(
            f"{name}: M {loads[0]:g} to {loads[-1]:g}, L {materials[0]:g} to {materials[-1]:g}: "
            f"{inside.min():+.1%} to {inside.max():+.1%}; "
            f"over all {each.min():+.1%} to {each.max():+.1%}"
        )


if __name__ == "__main__":
    main()
