"""What keeps contact rare: the film, viscosity, speed, temperature or roughness that it takes.

Each is found where the curve of the breakthrough probability crosses the share asked for, and its
limits where the limits of the probability cross it. So the 95 % interval is that of the mean over
pairs of rollers.
"""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import xarray as xr

from lube.calculator.amounts import amount, bare_number, described
from lube.calculator.answers import Answer
from lube.calculator.operating_points import (
    FORMULA,
    REALISATIONS,
    SEED,
    film_in_si,
    one_formula,
    probabilities,
    rotation_speed,
    run_all,
    single,
)
from lube.calculator.parts import Oil, Rollers, with_parts
from lube.errors import RangeError, StudyError
from lube.grid.discretise import layer_factor_of
from lube.schema import values_with_limits
from lube.stages.tail import PAIRS
from lube.statistics.confidence import mean_interval
from lube.statistics.curves import peaked_curve
from lube.study.line_spec import check_width
from lube.surfaces.rare_contact import rare_contact_under

LAMBDA_RATIOS = np.geomspace(0.1, 13.0, 61)
"""Lambda ratios that are tried at first; even at the last, contact has a probability of 1e-37."""
NEAR = np.exp(np.linspace(-0.2, 0.2, 9))
"""Lambda ratios that are tried then, over that of the share at first sight."""
FALLING = 0.9
"""Share, over the largest there is, below which it lies well on the falling branch."""
OFTEN = 10.0
"""Independent windows with contact, in all realisations, from which contact is counted."""
FEW_PAIRS = 2
"""Pairs of lines of the first look."""
_LEAST = 1e-40
"""Probabilities that are taken for none."""
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
) -> Answer:
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
    return _labelled(_films(rollers, force, share, realisations, seed))


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
) -> Answer:
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
    Answer
        ``dynamic_viscosity`` (mPa s) and ``kinematic_viscosity`` (mm2/s) at the temperature, and
        the variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no viscosity is enough.
    """
    rotation = single("speed", rotation_speed(speed, rollers.pair.first.radius))
    # The film depends on the product of viscosity and speed, so the speed is varied for both.
    speeds = rotation * FACTORS, "rpm"
    table = _film(rollers, oil, force, speeds, temperature, film_formula, "speed")
    properties = oil.at(table["temperature"])
    films = _films(rollers, force, share, realisations, seed)
    tried = f"viscosity within a factor of {FACTORS[-1]:g} of the oil's"
    factors = np.exp(_reached(films, table, np.log(FACTORS), tried))
    viscosity = properties["dynamic_viscosity"].item() * factors
    kinematic = viscosity / properties["density"].item()
    return _labelled({"dynamic_viscosity": viscosity, "kinematic_viscosity": kinematic} | films)


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
) -> Answer:
    """Speed that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, temperature, film_formula
        As in `lube.contact_probability`, one of each.
    share, realisations, seed
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
    table = _film(rollers, oil, force, (FACTORS, "m/s"), temperature, film_formula, "speed")
    films = _films(rollers, force, share, realisations, seed)
    tried = f"speed up to {FACTORS[-1]:g} m/s"
    speeds = np.exp(_reached(films, table, np.log(FACTORS), tried))
    turns = rotation_speed("1 m/s", rollers.pair.first.radius).item()
    return _labelled({"entrainment_speed": speeds, "speed": speeds * turns} | films)


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
) -> Answer:
    """Highest temperature at which metal contact stays below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, film_formula
        As in `lube.contact_probability`, one of each.
    share, realisations, seed
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
    levels = np.linspace(*oil.record.valid_temperatures, TEMPERATURES)
    table = _film(rollers, oil, force, speed, (levels, "degC"), film_formula, "temperature")
    films = _films(rollers, force, share, realisations, seed)
    found = _reached(films, table, levels, "temperature of this oil")
    return _labelled({"temperature": found} | films)


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
) -> Answer:
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
    Answer
        ``composite_rms_roughness`` (um), ``lambda_ratio`` and ``roughness_factor``, that of both
        rollers' roughness, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no roughness tried is low enough.
    """
    film = _film(rollers, oil, force, speed, temperature, film_formula)
    own, half_width = film["lambda_ratio"].item(), film["contact_half_width"].item()
    ratios = _lambda_ratios(rollers, half_width, share, realisations, seed, own)
    sigma = rollers.pair.composite_rms_roughness * own / ratios
    found = {"roughness_factor": own / ratios, "composite_rms_roughness": sigma}
    return _labelled(found | {"lambda_ratio": ratios})


def _film(rollers, oil, force, speed, temperature, film_formula, varied=None):
    """Film table in SI units by one formula, over `varied`."""
    table = film_in_si(rollers, oil, force, speed, temperature, one_formula(film_formula))
    for name, size in table["film_thickness"].sizes.items():
        if name != varied:
            raise StudyError(f"{name}: got {size} values, need one")
    return table


def _films(rollers, force, share, realisations, seed):
    """Films at which the probability, its lower and its upper limit have a share, shape (3,)."""
    force = single("force", amount("force", force, "N", above=0.0))
    half_width = float(rollers.pair.contact_half_width(force))
    ratios = _lambda_ratios(rollers, half_width, share, realisations, seed)
    films = rollers.pair.composite_rms_roughness * ratios
    return {"film_thickness": films, "lambda_ratio": films / rollers.pair.composite_rms_roughness}


def _lambda_ratios(rollers, half_width, share, realisations, seed, own=None):
    """Lambda ratios at which the probability, its lower and its upper limit have a share.

    The film changes, or the roughness if its own lambda ratio is given: then so does the layer's
    strength in proportion, as of `required_roughness`. A first look by sampling says where to look.
    """
    share = bare_number("share", share, above=0.0, below=1.0)
    spec, ratios = rollers.lines, LAMBDA_RATIOS
    check_width(spec, 2.0 * half_width, "force: the contact")
    windows = spec.independent_windows(2.0 * half_width) * realisations
    if not spec.is_gaussian and share * windows < 1.0:
        raise RangeError(
            f"share: got {share:g}, need at least {1.0 / windows:.2g}: {realisations} realisations "
            "show no rarer contact, and importance sampling is for Gaussian heights"
        )
    if spec.is_gaussian:
        first = _sampled(rollers, half_width, seed, own, ratios, FEW_PAIRS)[0]
        near = max(_crossing(ratios, first, share), ratios[np.argmax(first)]) * NEAR
        # The maximum is flat: to find it takes them all.
        is_falling = share < FALLING * first.max()
        ratios = near if is_falling else ratios[ratios < 2.0 * near[-1]]
    is_seen = share * windows >= OFTEN or not spec.is_gaussian
    method, number = (_counted, realisations) if is_seen else (_sampled, PAIRS)
    limits = method(rollers, half_width, seed, own, ratios, number)
    found = np.array([_crossing(ratios, each, share) for each in limits])
    if not found[0] > 0.0:
        peak = np.argmax(limits[0])
        raise RangeError(
            f"share: got {share:g}, which no film has: the largest share is {limits[0][peak]:.3g}, "
            f"at a lambda ratio of {ratios[peak]:.2g}"
        )
    return found


def _crossing(ratios, probabilities, share):
    """Greatest lambda ratio at which a probability has a share: 0 if it is always less.

    Where contact is frequent, touching points merge to long segments whose boundary layer holds:
    the probability rises with the film up to a maximum, and falls beyond it.
    """
    unknown = np.full(ratios.size, np.nan)
    # Over the square, in which the logarithm of a rare probability is nearly linear.
    curve = peaked_curve(ratios**2, probabilities, unknown, _LEAST)
    return np.sqrt(max(curve.film_at(share), 0.0))


def _sampled(rollers, half_width, seed, own, ratios, pairs):
    """Mean and limits of the breakthrough probability, by importance sampling."""
    spec = rollers.lines
    factor = layer_factor_of(spec, rollers.pair.reduced_modulus, rollers.layer)
    factors = factor * (1.0 if own is None else own / ratios)
    points = 2 * int(half_width / spec.spacing) + 1
    steps = ratios * rollers.pair.composite_rms_roughness / spec.height_step
    films = [np.full(points, film) for film in steps]

    def on_one_pair(number):
        return rare_contact_under(spec, seed, number, films, factors)[0][1]

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = np.stack(list(pool.map(on_one_pair, range(pairs))))
    return np.minimum(mean_interval(found), 1.0)


def _counted(rollers, half_width, seed, own, ratios, realisations):
    """Mean and limits of the breakthrough probability, counted in realisations."""
    film = xr.DataArray(ratios * rollers.pair.composite_rms_roughness, dims="film")
    table = xr.Dataset({"film_thickness": film, "contact_half_width": half_width})
    table["reduced_modulus"] = rollers.pair.reduced_modulus
    layer = rollers.layer

    def run(lines):
        if own is None:
            return probabilities(lines, table, layer)
        found = []
        for number, ratio in enumerate(ratios):
            weaker = {"shear_strength": layer.shear_strength * ratio / own}
            part = table.isel(film=[number])
            found.append(probabilities(lines, part, layer.model_copy(update=weaker)))
        return xr.concat(found, "film", coords="minimal", compat="override")

    contact = run_all(run, rollers, realisations, seed, table["contact_half_width"])
    return [contact[f"breakthrough_probability_{end}"].values for end in ("mean", "lower", "upper")]


def _reached(films, table, levels, tried):
    """Levels at which the film of a table has some thicknesses; infinite beyond the table."""
    thickness = np.log(table["film_thickness"].values)
    rising = 1 if thickness[-1] > thickness[0] else -1
    ends = {"left": -rising * np.inf, "right": rising * np.inf}
    with np.errstate(divide="ignore"):  # a lower limit may be 0
        sought = np.log(films["film_thickness"])
    if sought[0] > thickness.max():
        film, most = 1e6 * np.exp([sought[0], thickness.max()])
        raise RangeError(
            f"share: it needs a film of {film:.3g} um, and no {tried} gives more than {most:.3g} um"
        )
    return np.interp(sought, thickness[::rising], levels[::rising], **ends)


def _labelled(found):
    """Values and their limits, the smaller one first, in customary units."""
    rows = {}
    for name, (value, *limits) in found.items():
        rows |= values_with_limits(name, [value, *np.sort(limits)])
    return described(xr.Dataset(rows))
