"""What keeps contact rare: the film, viscosity, speed, temperature or roughness that it takes.

Each answer lies where the breakthrough probability equals the given share of time, and its limits
lie where the limits of the probability do. So the 95 % interval is that of the mean over pairs of
rollers. The oil carries the whole load: films that keep contact rare leave little to asperities.
"""

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer, described
from lube.calculator.arguments import (
    FORMULA,
    REALISATIONS,
    SEED,
    Choices,
    amount,
    one_name,
    rotation_speed,
    single,
)
from lube.calculator.film_search import FilmSearch
from lube.calculator.operating_points import film_in_si
from lube.calculator.parts import Oil, Rollers, with_parts
from lube.grid.film_profiles import shaped_films
from lube.schema import values_with_limits
from lube.types import ContactModel, FilmShape, OneAmount, RoughnessDeformation

FACTORS = np.geomspace(1e-3, 1e3, 601)
"""Factors of the viscosity, and entrainment speeds in m/s, that are tried."""
TEMPERATURES = 241
"""Number of temperatures that are tried in the range of the lubricant record."""


@with_parts
def required_film(
    rollers: Rollers,
    force: OneAmount,
    *,
    share: float = 0.01,
    contact_model: ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> Answer:
    """Film thickness that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    force : str, tuple or pint.Quantity
        Normal force, such as ``"800 N"``; it sets the contact width.
    share : float, optional
        Largest breakthrough probability allowed; 0.01 is one per cent.
    contact_model : str, optional
        ``"line"`` or ``"surface"``, as in `lube.contact_probability`; the surface takes a minute.
    realisations, seed : int, optional
        As in `lube.contact_probability`.

    Returns
    -------
    Answer
        ``film_thickness`` (um) and ``lambda_ratio``, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="5 mm", rms_roughness="0.2 um")
    >>> found = required_film(rollers, "100 N", share=0.05, realisations=4)
    >>> bool(found.film_thickness_lower < found.film_thickness < found.film_thickness_upper)
    True
    """
    choices = Choices.of("flat", "none", "none", contact_model)
    search = FilmSearch(rollers, share, realisations, seed, choices)
    force = single(amount("force", force, "N", above=0.0))
    half_width = float(rollers.pair.contact_half_width(force))
    return _labelled(search.films(half_width))


@with_parts
def required_viscosity(
    rollers: Rollers,
    oil: Oil,
    force: OneAmount,
    speed: OneAmount,
    temperature: OneAmount,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    film_shape: FilmShape = "flat",
    roughness_deformation: RoughnessDeformation = "none",
    contact_model: ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> Answer:
    """Viscosity that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each. The pressure-viscosity coefficient and
        the density are those of the oil at that temperature.
    share, contact_model, realisations, seed
        As in `required_film`.

    Returns
    -------
    Answer
        ``dynamic_viscosity`` (mPa s) and ``kinematic_viscosity`` (mm2/s) at the temperature, and
        the variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no viscosity is enough.
    """
    rotation = single(rotation_speed(speed, rollers.pair.first.radius))
    one = one_name("film_formula", film_formula)

    def table(factors, choices):
        # The film depends on the product of viscosity and speed, so the speed is varied for both.
        speeds = rotation * factors, "rpm"
        return film_in_si(rollers, oil, force, speeds, temperature, one, choices)

    choices = Choices.of(film_shape, roughness_deformation, "none", contact_model)
    search = FilmSearch(rollers, share, realisations, seed, choices)
    tried = f"viscosity within a factor of {FACTORS[-1]:g} of the oil's"
    films, factors = search.along(table, FACTORS, tried)
    properties = oil.at(amount("temperature", temperature, "degC"))
    viscosity = properties["dynamic_viscosity"].item() * factors
    kinematic = viscosity / properties["density"].item()
    return _labelled({"dynamic_viscosity": viscosity, "kinematic_viscosity": kinematic} | films)


@with_parts
def required_speed(
    rollers: Rollers,
    oil: Oil,
    force: OneAmount,
    temperature: OneAmount,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    film_shape: FilmShape = "flat",
    roughness_deformation: RoughnessDeformation = "none",
    contact_model: ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> Answer:
    """Speed that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    share, contact_model, realisations, seed
        As in `required_film`.

    Returns
    -------
    Answer
        ``speed`` (rpm, of the first roller in pure rolling), ``entrainment_speed`` (m/s), and the
        variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no speed is enough.
    """
    one = one_name("film_formula", film_formula)

    def table(speeds, choices):
        return film_in_si(rollers, oil, force, (speeds, "m/s"), temperature, one, choices)

    choices = Choices.of(film_shape, roughness_deformation, "none", contact_model)
    search = FilmSearch(rollers, share, realisations, seed, choices)
    films, speeds = search.along(table, FACTORS, f"speed up to {FACTORS[-1]:g} m/s")
    turns = rotation_speed("1 m/s", rollers.pair.first.radius).item()
    return _labelled({"entrainment_speed": speeds, "speed": speeds * turns} | films)


@with_parts
def required_temperature(
    rollers: Rollers,
    oil: Oil,
    force: OneAmount,
    speed: OneAmount,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    film_shape: FilmShape = "flat",
    roughness_deformation: RoughnessDeformation = "none",
    contact_model: ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> Answer:
    """Highest temperature at which metal contact stays below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    share, contact_model, realisations, seed
        As in `required_film`.

    Returns
    -------
    Answer
        ``temperature`` (degC) and the variables of `required_film`, each with ``_lower`` and
        ``_upper``. Infinite if the film is still thick enough at the oil's highest temperature.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no temperature is low enough.
    """
    one = one_name("film_formula", film_formula)

    def table(temperatures, choices):
        return film_in_si(rollers, oil, force, speed, (temperatures, "degC"), one, choices)

    choices = Choices.of(film_shape, roughness_deformation, "none", contact_model)
    search = FilmSearch(rollers, share, realisations, seed, choices)
    levels = np.linspace(*oil.record.valid_temperatures, TEMPERATURES)
    films, found = search.along(table, levels, "temperature of this oil")
    return _labelled({"temperature": found} | films)


@with_parts
def required_roughness(
    rollers: Rollers,
    oil: Oil,
    force: OneAmount,
    speed: OneAmount,
    temperature: OneAmount,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    film_shape: FilmShape = "flat",
    roughness_deformation: RoughnessDeformation = "none",
    contact_model: ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> Answer:
    r"""Roughness that keeps metal contact below a share of time.

    The heights of both rollers are multiplied by the same factor. Overlaps and the forces on
    segments grow with it, so lines of :math:`s` times the height, at a film :math:`h`, break as
    the given lines do at a film :math:`h / s` with a boundary layer :math:`s` times weaker.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    share, contact_model, realisations, seed
        As in `required_film`.

    Returns
    -------
    Answer
        ``composite_rms_roughness`` (um), ``lambda_ratio`` and ``roughness_factor``, the factor of
        both rollers' heights, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no roughness tried is low enough.
    """
    choices = Choices.of(film_shape, roughness_deformation, "none", contact_model)
    search = FilmSearch(rollers, share, realisations, seed, choices)
    one = one_name("film_formula", film_formula)
    film = film_in_si(rollers, oil, force, speed, temperature, one, search.choices)
    own = single(film["lambda_ratio"])

    def table_at(ratios):
        # Lines of s times the height break as the given ones do under the film over s.
        scale = xr.DataArray(ratios / own, dims="film")
        scaled = {"film_thickness": scale * film["film_thickness"]}
        if search.choices.gap.has_shape:
            scaled["film_profile"] = scale * shaped_films(film)
        return film.assign(scaled)

    found = search.films(film["contact_half_width"].item(), table_at, own=own)
    ratios = found["lambda_ratio"]
    sigma = rollers.pair.composite_rms_roughness * own / ratios
    found = {"roughness_factor": own / ratios, "composite_rms_roughness": sigma}
    return _labelled(found | {"lambda_ratio": ratios})


def _labelled(found):
    """Answer of values and their limits, the smaller limit first."""
    rows = {}
    for name, (value, *limits) in found.items():
        rows |= values_with_limits(name, [value, *np.sort(limits)])
    return described(xr.Dataset(rows))
