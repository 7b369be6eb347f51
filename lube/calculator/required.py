"""What keeps contact rare: the film, viscosity, speed, temperature or roughness that it takes.

Each is found where the curve of the breakthrough probability crosses the share asked for, and its
limits where the limits of the probability cross it. So the 95 % interval is that of the mean over
pairs of rollers.
"""

import numpy as np
import xarray as xr

from lube.calculator.amounts import amount, described
from lube.calculator.operating_points import (
    FORMULA,
    REALISATIONS,
    SEED,
    check_widths,
    ensemble,
    film_in_si,
    one_formula,
    probabilities,
    rotation_speed,
    run_all,
    single,
    with_limits,
)
from lube.calculator.parts import Oil, Rollers, with_parts
from lube.errors import LubeError, RangeError, StudyError
from lube.schema import LIMITS
from lube.statistics.curves import falling_curve
from lube.statistics.sample_size import independent_windows
from lube.study.field_types import bounded
from lube.units import parse_number

LAMBDA_RATIOS = np.geomspace(0.5, 8.0, 49)
"""Lambda ratios that are tried; of the roughness every second one."""
FACTORS = np.geomspace(1e-3, 1e3, 601)
"""Factors of the viscosity, and entrainment speeds in m/s, that are tried."""
TEMPERATURES = 241
"""Number of temperatures that are tried, over the range of the lubricant record."""


@with_parts
def required_film(
    rollers: Rollers,
    force: str,
    *,
    share: float = 0.01,
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> xr.Dataset:
    """Film thickness that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    force : str
        Normal force, such as ``"800 N"``; it sets the contact width.
    share : float, optional
        Largest breakthrough probability allowed; 0.01 is one per cent.
    realisations, seed : int, optional
        As in `lube.contact_probability`.

    Returns
    -------
    xarray.Dataset
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
    films = _films(rollers, force, share, realisations, seed)
    return _labelled(_film_variables(films, rollers))


@with_parts
def required_viscosity(
    rollers: Rollers,
    oil: Oil,
    force: str,
    speed: str,
    temperature: str,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> xr.Dataset:
    """Viscosity that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula
        As in `lube.contact_probability`, one of each. The pressure-viscosity coefficient and the
        density are the oil's at that temperature.
    share, realisations, seed
        As in `required_film`.

    Returns
    -------
    xarray.Dataset
        ``dynamic_viscosity`` (mPa s) and ``kinematic_viscosity`` (mm2/s) at the temperature, and
        the variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no viscosity is enough.
    """
    rotation = single("speed", rotation_speed(speed, rollers.pair.first.radius))
    properties = oil.at(_temperature(temperature))
    # The film depends on the product of viscosity and speed, so the speed is varied for both.
    table = _film(rollers, oil, force, (rotation * FACTORS, "rpm"), temperature, film_formula)
    films = _films(rollers, force, share, realisations, seed)
    factors = _reached(table, films, f"viscosity within a factor of {FACTORS[-1]:g} of the oil's")
    viscosity = properties["dynamic_viscosity"].item() * factors
    return _labelled(
        {
            "dynamic_viscosity": viscosity,
            "kinematic_viscosity": viscosity / properties["density"].item(),
            **_film_variables(films, rollers),
        }
    )


@with_parts
def required_speed(
    rollers: Rollers,
    oil: Oil,
    force: str,
    temperature: str,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> xr.Dataset:
    """Speed that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, temperature, film_formula
        As in `lube.contact_probability`, one of each.
    share, realisations, seed
        As in `required_film`.

    Returns
    -------
    xarray.Dataset
        ``speed`` (rpm, of the first roller in pure rolling), ``entrainment_speed`` (m/s), and the
        variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no speed is enough.
    """
    _temperature(temperature)
    table = _film(rollers, oil, force, (FACTORS, "m/s"), temperature, film_formula)
    films = _films(rollers, force, share, realisations, seed)
    speeds = _reached(table, films, f"speed up to {FACTORS[-1]:g} m/s")
    turns = rotation_speed("1 m/s", rollers.pair.first.radius).item()
    speeds = {"entrainment_speed": speeds, "speed": speeds * turns}
    return _labelled(speeds | _film_variables(films, rollers))


@with_parts
def required_temperature(
    rollers: Rollers,
    oil: Oil,
    force: str,
    speed: str,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> xr.Dataset:
    """Highest temperature at which metal contact stays below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, film_formula
        As in `lube.contact_probability`, one of each.
    share, realisations, seed
        As in `required_film`.

    Returns
    -------
    xarray.Dataset
        ``temperature`` (degC) and the variables of `required_film`, each with ``_lower`` and
        ``_upper``. Infinite if the film is still thick enough at the oil's highest temperature.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no temperature is low enough.
    """
    single("speed", rotation_speed(speed, rollers.pair.first.radius))
    levels = np.linspace(*oil.record.valid_temperatures, TEMPERATURES)
    table = _film(rollers, oil, force, speed, (levels, "degC"), film_formula)
    films = _films(rollers, force, share, realisations, seed)
    thickness = table["film_thickness"].values
    if thickness[0] < films[0]:
        coldest = ensemble(table.isel(temperature=[0]), rollers, realisations, seed)
        found = coldest["breakthrough_probability_mean"].item()
        raise RangeError(
            f"share: got {share:g}, no film keeps contact below it with this oil: at "
            f"{levels[0]:g} degC it is {found:.2g}"
        )
    ends = {"left": np.inf, "right": -np.inf}
    found = np.interp(np.log(films), np.log(thickness[::-1]), levels[::-1], **ends)
    return _labelled({"temperature": found} | _film_variables(films, rollers))


@with_parts
def required_roughness(
    rollers: Rollers,
    oil: Oil,
    force: str,
    speed: str,
    temperature: str,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    realisations: int = REALISATIONS,
    seed: int = SEED,
) -> xr.Dataset:
    r"""Roughness that keeps metal contact below a share of time.

    The heights of both rollers are multiplied by the same factor. Overlaps and the forces on
    segments grow with it, so lines of :math:`s` times the height, at a film :math:`h`, break as
    the given lines do at a film :math:`h / s` with a boundary layer :math:`s` times weaker.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula
        As in `lube.contact_probability`, one of each.
    share, realisations, seed
        As in `required_film`.

    Returns
    -------
    xarray.Dataset
        ``composite_rms_roughness`` (um), ``lambda_ratio`` and ``roughness_factor``, that of both
        rollers' roughness, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no roughness tried is low enough.
    """
    single("speed", rotation_speed(speed, rollers.pair.first.radius))
    _temperature(temperature)
    film = _film(rollers, oil, force, speed, temperature, film_formula)
    check_widths(film["contact_half_width"], rollers)
    share = _checked(share, rollers, film["contact_half_width"].item(), realisations)
    ratios = LAMBDA_RATIOS[::2]
    factors = film["lambda_ratio"].item() / ratios

    def run(lines):
        """Probabilities of some lines, made rougher by each factor."""
        parts = []
        for factor in factors:
            table = film.assign(film_thickness=film["film_thickness"] / factor)
            strength = rollers.layer.shear_strength / factor
            layer = rollers.layer.model_copy(update={"shear_strength": strength})
            parts.append(probabilities(lines, table, layer))
        joined = xr.concat(parts, "factor", coords="minimal", compat="override")
        return joined.transpose("realisation", ...)

    contact = with_limits(run_all(run, rollers, realisations, seed), film["contact_half_width"])
    ratios = _lambda_ratios(ratios, contact, share)
    factors = film["lambda_ratio"].item() / ratios
    sigma = rollers.pair.composite_rms_roughness * factors
    return _labelled(
        {
            "roughness_factor": factors,
            "composite_rms_roughness": sigma,
            "lambda_ratio": ratios,
        }
    )


def _film(rollers, oil, force, speed, temperature, film_formula):
    """Film table in SI units by one formula."""
    return film_in_si(rollers, oil, force, speed, temperature, one_formula(film_formula))


def _films(rollers, force, share, realisations, seed):
    """Film at which the probability, its lower and its upper limit have a share, shape (3,), m."""
    force = single("force", amount("force", force, "N", above=0.0))
    half_width = float(rollers.pair.contact_half_width(force))
    share = _checked(share, rollers, half_width, realisations)
    sigma = rollers.pair.composite_rms_roughness
    table = xr.Dataset(
        {
            "film_thickness": ("film", LAMBDA_RATIOS * sigma),
            "contact_half_width": half_width,
            "reduced_modulus": rollers.pair.reduced_modulus,
        }
    )
    contact = ensemble(table, rollers, realisations, seed)
    return sigma * _lambda_ratios(LAMBDA_RATIOS, contact, share)


def _checked(share, rollers, half_width, realisations):
    """Share as a number that is not too rare for the realisations to show."""
    try:
        share = bounded(parse_number(share), None, above=0.0, below=1.0)
    except LubeError as error:
        raise StudyError(f"share: {error}") from None
    lines = rollers.lines
    travel, longest = lines.spacing * min(lines.points), 2.0 * np.pi / lines.q_min
    windows = independent_windows(travel, 2.0 * half_width, longest)
    if share * windows * realisations < 1.0:
        raise RangeError(
            f"share: got {share:g}, need at least {1.0 / (windows * realisations):.2g}: "
            f"{realisations} realisations show no rarer contact"
        )
    return share


def _lambda_ratios(levels, contact, share):
    """Lambda ratios at which the probability, its lower and its upper limit have a share."""
    unknown = np.full(levels.size, np.nan)
    names = (f"breakthrough_probability_{part}" for part in ("mean", "lower", "upper"))
    curves = (falling_curve(np.log(levels), contact[name].values, unknown, 1e-12) for name in names)
    ratios = np.exp([curve.film_at(share) for curve in curves])
    if not 0.0 < ratios[0] < np.inf:
        raise RangeError(
            f"share: got {share:g}, which no lambda ratio from {levels[0]:g} to {levels[-1]:g} has"
        )
    return ratios


def _reached(table, films, tried):
    """Those of `FACTORS` at which a table has some films: 0 or infinity beyond its ends."""
    ends = {"left": -np.inf, "right": np.inf}
    rising = np.log(table["film_thickness"].values)
    factors = np.exp(np.interp(np.log(films), rising, np.log(FACTORS), **ends))
    if not np.isfinite(factors[0]):
        raise RangeError(
            f"share: no {tried} gives the film of {1e6 * films[0]:.3g} um that it needs"
        )
    return factors


def _temperature(temperature):
    degrees = amount("temperature", temperature, "degC", above=-273.15)
    single("temperature", degrees)
    return degrees


def _film_variables(films, rollers):
    return {"film_thickness": films, "lambda_ratio": films / rollers.pair.composite_rms_roughness}


def _labelled(found):
    """Dataset of values and their limits, the smaller one first, in customary units."""
    rows = {name: ("limit", [row[0], *np.sort(row[1:])]) for name, row in found.items()}
    rows = described(xr.Dataset(rows))
    labelled = xr.Dataset()
    for name in found:
        for number, ending in enumerate(LIMITS):
            labelled[f"{name}{ending}"] = rows[name].isel(limit=number)
    return labelled
