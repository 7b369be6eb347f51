"""The film of a lubricated line contact from Reynolds' equation: steady, isothermal, Newtonian."""

import logging
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from threadpoolctl import ThreadpoolController

from lube.ehl.deflection import deflection_matrix
from lube.ehl.mesh import breadth, first_mesh, fitted_mesh, inlet_end
from lube.ehl.reynolds import HERTZ_LOAD, DiscreteContact, Flow
from lube.errors import LubeError, RangeError
from lube.physics.dimensionless import moes_numbers
from lube.physics.pressure_laws import PRESSURE_LAWS, ROELANDS_VISCOSITY, dowson_higginson_density
from lube.physics.regimes import asymptotic_film
from lube.physics.starvation import starvation_factor
from lube.types import Array, Values

log = logging.getLogger(__name__)

FLOODED = 1e4
"""Height of the gap, over the central film, at which the oil of a flooded inlet begins.

A tenth of this height thins the film by up to 0.2 %."""
TOLERANCE = 1e-9
"""Largest defect of the mass flux, over the flux at the centre, and of the load, over the load."""
_SPIKE_REACH, _SHARP = 0.15, 2.0
_HERTZ_DEFLECTION = 0.25 + 0.5 * np.log(2.0)
"""Scaled deflection of the dry contact at the line of centres."""
_FITTINGS = 2
_MOST_STEPS = 400
_MOST_NODES = 1000
"""A very sharp pressure spike would need more; a step on so many nodes takes half a second."""
_LARGEST_CHANGE = 0.3
_FIRST_SETTLING_TIME, _LONGEST_SETTLING_TIME, _SHORTEST_SETTLING_TIME = 0.5, 3.0, 1e-9


class ConvergenceError(LubeError):
    """The computed film of a contact did not converge."""


@dataclass(frozen=True)
class LineContact:
    """A lubricated line contact.

    Attributes
    ----------
    load, speed, material : float
        Dimensionless W, U and G of `lube.physics.dimensionless`.
    viscosity : float
        Dynamic viscosity at ambient pressure, Pa s.
    film_modulus : float
        E' = 2 E*, Pa.
    law : str
        Law of viscosity under pressure, a key of `lube.physics.pressure_laws.PRESSURE_LAWS`.
    """

    load: float
    speed: float
    material: float
    viscosity: float
    film_modulus: float
    law: str = "roelands"

    @property
    def half_width(self) -> float:
        """Hertzian half-width over the reduced radius, a / R*."""
        return float(np.sqrt(8.0 * self.load / np.pi))

    @property
    def hertz_pressure(self) -> float:
        """Maximum pressure of the dry contact, Pa."""
        return float(self.film_modulus * np.sqrt(self.load / (2.0 * np.pi)))

    @property
    def flow_number(self) -> float:
        """Ratio lambda of dragged to pressure-driven flow, as in `lube.ehl.reynolds`."""
        pressure = np.sqrt(self.load / (2.0 * np.pi))
        return float(12.0 * self.speed / (self.half_width**3 * pressure))

    def density(self, pressure: Values) -> tuple[Values, Values]:
        """Density ratio at scaled pressures, and its slope."""
        density, slope = dowson_higginson_density(pressure * self.hertz_pressure)
        return density, slope * self.hertz_pressure

    def log_viscosity(self, pressure: Values) -> tuple[Values, Values]:
        """Logarithm of the viscosity ratio at scaled pressures, and its slope."""
        law, coefficient = PRESSURE_LAWS[self.law], self.material / self.film_modulus
        logarithm, slope = law(pressure * self.hertz_pressure, coefficient, self.viscosity)
        return logarithm, slope * self.hertz_pressure

    @property
    def name(self) -> str:
        """Name of its film in messages, by the Moes numbers."""
        moes_load, moes_material = moes_numbers(self.load, self.speed, self.material)
        return f"the film at M = {moes_load:.3g}, L = {moes_material:.3g}"

    @property
    def film_guess(self) -> float:
        """Guess of the central film H: the asymptote of its regime (`lube.physics.regimes`)."""
        numbers = moes_numbers(self.load, self.speed, self.material)
        return float(asymptotic_film(*numbers) * np.sqrt(2.0 * self.speed) / self.half_width**2)


@dataclass(frozen=True, eq=False)
class FilmProfile:
    """Pressure and film of a line contact.

    Attributes
    ----------
    contact : LineContact
        The contact.
    nodes : numpy.ndarray, shape (n,)
        Positions over the Hertzian half-width, rising; the oil enters at the first.
    pressure : numpy.ndarray, shape (n,)
        Pressures over Hertz' maximum pressure, linear between the nodes.
    offset : float
        Gap less the undeformed parabola and the deflection, scaled.
    flow : Flow
        Scaled mass flux between the nodes.
    steps : int
        Steps of Newton's method on all meshes.
    """

    contact: LineContact
    nodes: Array
    pressure: Array
    offset: float
    flow: Flow
    steps: int

    def scaled_gap(self, position: Array) -> Array:
        """Gap h R* / a^2 at positions over the half-width, in the contact or outside."""
        deflection = deflection_matrix(position, self.nodes) @ self.pressure
        return self.offset + 0.5 * position**2 + deflection

    def film_at(self, position: Array) -> Array:
        """Film, and gap outside the contact, over R*, at positions over the half-width."""
        return self.scaled_gap(np.asarray(position, float)) * self.contact.half_width**2

    def pressure_at(self, position: Array) -> Array:
        """Pressure over Hertz' maximum pressure, at positions over the half-width."""
        return np.interp(position, self.nodes, self.pressure, left=0.0, right=0.0)

    @property
    def pressure_reach(self) -> float:
        """Distance before the contact, over the half-width, with a thousandth of the pressure."""
        return -self.nodes[np.argmax(self.pressure >= 1e-3 * self.pressure.max())]

    @cached_property
    def middle(self) -> Array:
        """Positions midway between the nodes, where the equation holds."""
        return 0.5 * (self.nodes[1:] + self.nodes[:-1])

    @cached_property
    def end(self) -> int:
        """Index of the last node with pressure; the film ends between it and the next."""
        return int(np.flatnonzero(self.pressure)[-1])

    @cached_property
    def film_end(self) -> float:
        """Position over the half-width at which the film ends.

        There the surfaces alone carry the whole mass flux. The last node with pressure lies up to a
        cell before it.
        """
        from scipy.optimize import brentq  # slow to import

        def beyond(position):
            return self.scaled_gap(np.array([position])).item() - self.flow.flux[0]

        thinnest = self.middle[np.argmin(self.flow.gap)]
        return float(brentq(beyond, thinnest, self.nodes[-1]))

    @cached_property
    def spike(self) -> float:
        """Position of the pressure spike over the half-width, NaN without one.

        It is a maximum more than twice as sharp as that of Hertz' pressure.
        """
        peaks = 1 + np.flatnonzero(np.diff(np.sign(np.diff(self.pressure))) < 0.0)
        place, before = self.nodes[peaks], _SPIKE_REACH * (self.film_end - self.nodes[peaks])
        rise = self.pressure[peaks] - self.pressure_at(place - before)
        sharpest = np.argmax(rise)
        is_sharp = rise[sharpest] > _SHARP * before[sharpest] ** 2
        return float(place[sharpest]) if is_sharp else np.nan

    @cached_property
    def central_gap(self) -> float:
        """Scaled gap at the line of centres, linear between the two nearest positions."""
        return float(np.interp(0.0, self.middle, self.flow.gap))

    @cached_property
    def central_film(self) -> float:
        """Film over R* at the line of centres.

        It is interpolated by a cubic through the four nearest positions midway between nodes, where
        the equation holds. At a node the kink of the pressure dents a thin film.
        """
        first = int(np.searchsorted(self.middle, 0.0)) - 2
        near = self.middle[first : first + 4]
        return float(np.polyfit(near, self.film_at(near), 3)[-1])

    @cached_property
    def minimum_film(self) -> float:
        """Minimum film over R*."""
        thinnest = self.middle[np.argmin(self.flow.gap)]
        near = np.searchsorted(self.nodes, thinnest) + np.array([-3, 2])
        low, high = self.nodes[np.clip(near, 0, self.nodes.size - 1)]
        return float(self.film_at(np.linspace(low, high, 201)).min())

    @cached_property
    def mean_film(self) -> float:
        """Mean film over R* in the Hertzian zone, one half-width on either side."""
        points, weights = np.polynomial.legendre.leggauss(64)
        return float(self.film_at(points) @ weights / 2.0)

    @cached_property
    def rolling_resistance(self) -> float:
        r"""Resistance to rolling of either surface, per length over E' R*.

        The pressure is greater before the line of centres than behind it. Its moment about that
        line is balanced by the tractions of the oil on the two surfaces, T each in pure rolling:

        .. math:: 2 T = -\int p \frac{x}{R^*} dx = \int h \frac{dp}{dx} dx
        """
        x, p = self.nodes, self.pressure
        # Exact for pressures that are linear between the nodes.
        ends, middles = p[1:] * x[1:] + p[:-1] * x[:-1], (p[1:] + p[:-1]) * (x[1:] + x[:-1])
        moment = np.sum((ends + middles) * np.diff(x)) / 6.0
        scale = self.contact.hertz_pressure / self.contact.film_modulus
        return float(-0.5 * scale * self.contact.half_width**2 * moment)

    @cached_property
    def mass_flux_defect(self) -> float:
        """Largest difference of the mass flux from the flux at the centre, over the latter."""
        central = np.interp(0.0, self.middle, self.flow.flux)
        return float(np.abs(self.flow.flux[: self.end] / central - 1.0).max())

    @cached_property
    def load_defect(self) -> float:
        """Difference of the pressure's integral from the load, over the load."""
        return float(abs(np.trapezoid(self.pressure, self.nodes) / HERTZ_LOAD - 1.0))


def solve(
    contact: LineContact,
    meniscus: float | None = None,
    flooded: float = FLOODED,
    fineness: float = 1.0,
) -> FilmProfile:
    r"""Compute the film of a line contact.

    Reynolds' equation with the elastic deflection of two half-planes, the load balance, and
    p >= 0 with mass conserved up to the end of the film (Reynolds' boundary condition). The
    density follows Dowson and Higginson.

    Parameters
    ----------
    contact : LineContact
        The contact.
    meniscus : float, optional
        Distance over the half-width, from the line of centres, at which the oil begins; by
        default far away, and the contact is flooded.
    flooded : float, optional
        Height of the gap where the oil of a flooded contact begins, over the central film.
    fineness : float, optional
        The number of nodes grows in proportion.

    Returns
    -------
    FilmProfile
        Pressure and film, converged to `TOLERANCE`.

    Raises
    ------
    RangeError
        If the meniscus lies inside the contact, or the viscosity is too low for Roelands' law.
    ConvergenceError
        If the iteration does not converge, or the pressure spike needs too many nodes.

    Notes
    -----
    Newton's method starts far from the solution, where it overshoots. Each of its steps is
    therefore a time step of a squeeze film that settles; a step that changes the pressure too
    much, or closes the gap, is repeated with a shorter time. The mesh is then fitted to the
    solution, twice.

    Examples
    --------
    The paper's rollers at 800 N, 100 r/min and 40 degC, with R* = 25 mm:

    >>> contact = LineContact(1.387e-5, 2.574e-11, 3693.0, 0.2835, 2.308e11)
    >>> profile = solve(contact)
    >>> f"{profile.central_film * 25e3:.2f} um, least {profile.minimum_film * 25e3:.2f} um"
    '1.02 um, least 0.85 um'
    """
    if contact.law == "roelands" and not contact.viscosity > ROELANDS_VISCOSITY:
        raise RangeError(
            f"viscosity: got {contact.viscosity:.3g} Pa s, need more than "
            f"{ROELANDS_VISCOSITY:.3g} Pa s for Roelands' law"
        )
    if meniscus is not None and not meniscus > 1.0:
        raise RangeError(
            f"meniscus: got {meniscus:g} half-widths before the line of centres, inside the "
            "contact, need more than 1 half-width"
        )

    def inlet(offset, film):
        # Oil that begins farther away floods the contact.
        end = inlet_end(offset, flooded * film)
        return end if meniscus is None else max(end, -meniscus)

    film = contact.film_guess
    if meniscus is not None:
        film = float(film * starvation_factor(film, meniscus))
    nodes = first_mesh(film, inlet(film - _HERTZ_DEFLECTION, film))
    reach = min(breadth(film), -nodes[0])  # no pressure before the oil begins
    pressure = np.sqrt(np.maximum(1.0 - (nodes / reach) ** 2, 0.0))
    profile = _settle(contact, nodes, pressure, film, 0)
    for _ in range(_FITTINGS):
        nodes = fitted_mesh(profile, inlet(profile.offset, profile.central_gap), fineness)
        if nodes.size > _MOST_NODES * max(fineness, 1.0):
            raise ConvergenceError(
                f"{contact.name} needs {nodes.size} nodes, more than the limit of {_MOST_NODES}: "
                "the pressure spike is too sharp"
            )
        profile = on_nodes(profile, nodes)
    return profile


def on_nodes(profile: FilmProfile, nodes: Array, is_damped: bool = True) -> FilmProfile:
    """Solve again for a film, on other nodes.

    Parameters
    ----------
    profile : FilmProfile
        The film.
    nodes : numpy.ndarray, shape (n,)
        Positions over the half-width, rising, with the same ends as the film's nodes.
    is_damped : bool, optional
        As in `lube.ehl.reynolds.DiscreteContact`.

    Returns
    -------
    FilmProfile
        The same film on these nodes, converged to `TOLERANCE`.

    Raises
    ------
    ConvergenceError
        If the iteration does not converge.
    """
    pressure = np.interp(nodes, profile.nodes, profile.pressure)
    film, steps = profile.central_gap, profile.steps
    return _settle(profile.contact, nodes, pressure, film, steps, is_damped)


def one_blas_thread() -> AbstractContextManager:
    """Limit linear algebra to one thread: more threads slow it down on these small matrices."""
    return _libraries().limit(limits=1, user_api="blas")


_libraries = cache(ThreadpoolController)


def profiles_of(
    load: Values,
    speed: Values,
    material: Values,
    viscosity: Values,
    film_modulus: Values,
    meniscus: Values | None = None,
) -> Array:
    """Solve for the films of many contacts.

    Parameters
    ----------
    load, speed, material, viscosity, film_modulus : float or numpy.ndarray
        As in `LineContact`; they broadcast.
    meniscus : float or numpy.ndarray, optional
        Distance over R*, from the line of centres, at which the oil begins; it broadcasts with the
        others. By default it is far away.

    Returns
    -------
    numpy.ndarray of object
        A `FilmProfile` for each contact. It is None where a number is NaN, or where the film did
        not converge, which is logged.
    """

    def solved(*numbers, meniscus):
        if np.isnan(numbers).any():
            return None
        contact = LineContact(*map(float, numbers))
        try:
            return solve(contact, meniscus and meniscus / contact.half_width)
        except ConvergenceError as error:
            log.warning("%s", error)
            return None

    solved_each = np.vectorize(solved, otypes=[object])
    return solved_each(load, speed, material, viscosity, film_modulus, meniscus=meniscus)


def _settle(contact, nodes, pressure, film, steps, is_damped=True):
    """Let the film settle on a mesh, from a guess of the pressure and the central film."""
    # A step that overflows is too large; it is repeated.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"), one_blas_thread():
        discrete = DiscreteContact(contact, nodes, is_damped=is_damped)
        pressure = pressure * (HERTZ_LOAD / (discrete.weight @ pressure))
        gap = discrete.gap(pressure, 0.0)
        # Lifted where the guess would let the rollers touch.
        offset = max(film - np.interp(0.0, discrete.middle, gap), 0.3 * film - gap.min())
        time, last = (_FIRST_SETTLING_TIME if steps == 0 else np.inf), steps + _MOST_STEPS
        flow = discrete.flow(pressure, offset)
        profile = FilmProfile(contact, nodes, pressure, offset, flow, steps)
        while steps < last and time > _SHORTEST_SETTLING_TIME:
            steps += 1
            change, shift = discrete.newton_step(pressure, flow, time)
            widening = shift + discrete.deflection @ change
            # Written so that NaN counts as too large.
            small = np.abs(change).max() <= _LARGEST_CHANGE
            if not (small and np.all(flow.gap + widening >= 0.3 * flow.gap)):
                time = min(time, _LONGEST_SETTLING_TIME) / 6.0
                continue
            pressure, offset = np.maximum(pressure + change, 0.0), offset + shift
            flow = discrete.flow(pressure, offset)
            profile = FilmProfile(contact, nodes, pressure, offset, flow, steps)
            defect = max(profile.mass_flux_defect, profile.load_defect)
            if defect < TOLERANCE:
                return profile
            time = np.inf if defect < 1e-4 else 4.0 * time
    raise ConvergenceError(
        f"{contact.name} did not converge: mass flux off by {profile.mass_flux_defect:.1g}, "
        f"load by {profile.load_defect:.1g} after {steps} steps"
    )
