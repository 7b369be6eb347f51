"""The paper's rollers, oil and grid as plain numbers, for tests of the film."""

import numpy as np
from hypothesis import strategies as st

from lube.ehl import film_formulas
from lube.ehl.line_contact import LineContact
from lube.physics import dimensionless, hertz

RADIUS, LENGTH = 0.025, 0.01
MODULUS = hertz.reduced_modulus(210e9, 0.3, 210e9, 0.3)
FORCE = np.array([100.0, 200.0, 400.0, 800.0, 1600.0])
SPEED = np.array([600 / 7, 100.0, 120.0, 150.0, 200.0])
TEMPERATURE = np.array([40.0, 50.0, 60.0, 70.0, 80.0])
KINEMATIC = np.array([335.0, 210.665, 139.1001950405, 95.806, 68.451])  # mm2/s
VISCOSITY = KINEMATIC * 1e-6 * 860.0 * (1.0 - 6.4e-4 * (TEMPERATURE - 15.0))
ALPHA = 7.382e-9 * KINEMATIC**0.1335

loads = st.floats(1e-6, 1e-3)
speeds = st.floats(1e-13, 1e-9)
materials = st.floats(500.0, 1e4)


def groups_at(force, speed, temperature):
    """W, U and G of one operating point of the paper's grid."""
    at = list(TEMPERATURE).index(temperature)
    return (
        dimensionless.dimensionless_load(force / LENGTH, 2 * MODULUS, RADIUS),
        dimensionless.dimensionless_speed(
            VISCOSITY[at], 2 * np.pi * 0.05 * speed / 60, 2 * MODULUS, RADIUS
        ),
        dimensionless.dimensionless_material(ALPHA[at], 2 * MODULUS),
    )


def contact_at(force, speed, temperature):
    """Line contact at one operating point of the paper's grid."""
    viscosity = VISCOSITY[list(TEMPERATURE).index(temperature)]
    return LineContact(*groups_at(force, speed, temperature), viscosity, 2 * MODULUS)


def groups_of_the_grid():
    """W, U and G of all 125 points, shapes broadcasting to (temperature, speed, force)."""
    entrainment = 2 * np.pi * 0.05 * SPEED / 60
    return (
        dimensionless.dimensionless_load(FORCE / LENGTH, 2 * MODULUS, RADIUS),
        dimensionless.dimensionless_speed(
            VISCOSITY[:, None, None], entrainment[:, None], 2 * MODULUS, RADIUS
        ),
        dimensionless.dimensionless_material(ALPHA[:, None, None], 2 * MODULUS),
    )


def film(name, *point):
    return film_formulas.formula(name).evaluate(*groups_at(*point)) * RADIUS


def log_slope(function, arguments, which):
    """Exponent of a power law in one of its arguments, by a central difference."""
    up, down = list(arguments), list(arguments)
    up[which] *= 1.001
    down[which] /= 1.001
    return np.log(function(*up) / function(*down)) / (2.0 * np.log(1.001))


def contact_by(moes_load, moes_material):
    """Return the line contact at M and L, of an oil of 20 1/GPa between steel rollers."""
    material = 2e-8 * 2.308e11
    speed = 0.5 * (moes_material / material) ** 4
    return LineContact(moes_load * np.sqrt(2.0 * speed), speed, material, 0.1, 2.308e11)
