"""What keeps contact rare: the film, viscosity, speed, temperature or roughness that it takes.

Each answer lies where the breakthrough probability equals the given share of time, and its limits
lie where the limits of the probability do. So the 95 % interval is that of the mean over pairs of
rollers.
"""

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer, described
from lube.calculator.arguments import (
    FORMULA,
    REALISATIONS,
    SEED,
    amount,
    bare_number,
    check_realisations,
    gap_of,
    one_formula,
    one_model,
    rotation_speed,
    single,
)
from lube.calculator.operating_points import film_in_si
from lube.calculator.parts import Oil, Rollers, with_parts
from lube.contact.surface_strip import surface_contact
from lube.contact.window_films import shaped_films
from lube.contact.windows import ContactWindows
from lube.errors import RangeError, StudyError
from lube.grid.gap import PLAIN
from lube.physics.excursions import expected_contacts
from lube.schema import LIMITS, values_with_limits
from lube.stages.tail import PAIRS
from lube.statistics.confidence import mean_interval, probability_interval
from lube.statistics.curves import peaked_curve
from lube.study.line_spec import check_width
from lube.surfaces.spectra import pair_moments
from lube.surfaces.synthetic import draw_realisation
from lube.threads import on_threads

LAMBDA_RATIOS = np.geomspace(0.1, 13.0, 61)
"""Lambda ratios of the first look; at the highest, contact has a probability of 1e-37."""
NEAR = np.exp(np.linspace(-0.2, 0.2, 9))
"""Lambda ratios of the second look, over the one at which the first look finds the share."""
AROUND = np.exp(np.linspace(-1.0, 0.6, 17))
"""The same if the film has a shape or the oil changes the lines, which the first look ignores."""
FALLING = 0.9
"""Share, relative to the largest probability, below which it is well on the falling branch."""
OFTEN = 10.0
"""Least number of independent windows with contact, in all realisations, to count contact."""
FEW_PAIRS = 2
"""Pairs of lines of the first look."""
_LEAST = 1e-40
"""Probability below which contact counts as impossible."""
FACTORS = np.geomspace(1e-3, 1e3, 601)
"""Factors of the viscosity, and entrainment speeds in m/s, that are tried."""
TEMPERATURES = 241
"""Number of temperatures that are tried in the range of the lubricant record."""


@with_parts
def required_film(
    rollers: Rollers,
    force: str,
    *,
    share: float = 0.01,
    contact_model: str = "line",
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
    search = _Search(rollers, share, realisations, seed, PLAIN, contact_model)
    force = single(amount("force", force, "N", above=0.0))
    half_width = float(rollers.pair.contact_half_width(force))
    return _labelled(search.films(half_width))


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
    film_shape: str = "flat",
    roughness_deformation: str = "none",
    contact_model: str = "line",
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
    one = one_formula(film_formula)

    def table(factors, gap=PLAIN):
        # The film depends on the product of viscosity and speed, so the speed is varied for both.
        speeds = rotation * factors, "rpm"
        return film_in_si(rollers, oil, force, speeds, temperature, one, gap)

    gap = gap_of(film_shape, roughness_deformation)
    search = _Search(rollers, share, realisations, seed, gap, contact_model)
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
    force: str,
    temperature: str,
    *,
    share: float = 0.01,
    film_formula: str = FORMULA,
    film_shape: str = "flat",
    roughness_deformation: str = "none",
    contact_model: str = "line",
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
    one = one_formula(film_formula)

    def table(speeds, gap=PLAIN):
        return film_in_si(rollers, oil, force, (speeds, "m/s"), temperature, one, gap)

    gap = gap_of(film_shape, roughness_deformation)
    search = _Search(rollers, share, realisations, seed, gap, contact_model)
    films, speeds = search.along(table, FACTORS, f"speed up to {FACTORS[-1]:g} m/s")
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
    film_shape: str = "flat",
    roughness_deformation: str = "none",
    contact_model: str = "line",
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
    one = one_formula(film_formula)

    def table(temperatures, gap=PLAIN):
        return film_in_si(rollers, oil, force, speed, (temperatures, "degC"), one, gap)

    gap = gap_of(film_shape, roughness_deformation)
    search = _Search(rollers, share, realisations, seed, gap, contact_model)
    levels = np.linspace(*oil.record.valid_temperatures, TEMPERATURES)
    films, found = search.along(table, levels, "temperature of this oil")
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
    film_shape: str = "flat",
    roughness_deformation: str = "none",
    contact_model: str = "line",
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
    gap = gap_of(film_shape, roughness_deformation)
    search = _Search(rollers, share, realisations, seed, gap, contact_model)
    one = one_formula(film_formula)
    film = film_in_si(rollers, oil, force, speed, temperature, one, search.gap)
    own = single(film["lambda_ratio"])

    def table_at(ratios):
        # Lines of s times the height break as the given ones do under the film over s.
        scale = xr.DataArray(ratios / own, dims="film")
        scaled = {"film_thickness": scale * film["film_thickness"]}
        if search.gap.has_shape:
            scaled["film_profile"] = scale * shaped_films(film)
        return film.assign(scaled)

    found = search.films(film["contact_half_width"].item(), table_at, own=own)
    ratios = found["lambda_ratio"]
    sigma = rollers.pair.composite_rms_roughness * own / ratios
    found = {"roughness_factor": own / ratios, "composite_rms_roughness": sigma}
    return _labelled(found | {"lambda_ratio": ratios})


class _Search:
    """Search for the films at which the probability of contact equals a share of time.

    Contact of lines is counted where the realisations show enough of it, else sampled; that of the
    surface is sampled.
    """

    def __init__(self, rollers, share, realisations, seed, gap, contact_model):
        self._share, self.gap = bare_number("share", share, above=0.0, below=1.0), gap
        self._on_surface = one_model(contact_model) == "surface"
        self._realisations = check_realisations(realisations, seed)
        self._rollers, self._seed = rollers, seed
        self._sigma = rollers.pair.composite_rms_roughness

    def along(self, table, levels, tried):
        """Find the films that give the share, and the levels of a condition that give them."""
        whole = table(levels)
        for name, size in whole["film_thickness"].sizes.items():
            if size != levels.size:
                raise StudyError(f"{name}: got {size} values, need one")
        ratios = whole["lambda_ratio"].values
        known = np.flatnonzero(np.isfinite(ratios))
        known = known[np.argsort(ratios[known])]

        def table_at(sought):
            here = np.interp(sought, ratios[known], known)
            return table(np.interp(here, np.arange(levels.size), levels), self.gap)

        ends = ratios[known[[0, -1]]]
        films = self.films(whole["contact_half_width"].item(), table_at, ends)
        return films, _reached(films, whole, levels, tried)

    def films(self, half_width, table_at=None, ends=(0.0, np.inf), own=None):
        """Find the films at which the probability, its lower and its upper limit equal the share.

        Parameters
        ----------
        half_width : float
            Half-width of the contact, m.
        table_at : callable, optional
            Film table at some lambda ratios, for films with a shape and for lines that the oil
            flattens or answers.
        ends : tuple of float, optional
            Least and greatest lambda ratio of `table_at`.
        own : float, optional
            Lambda ratio of the rollers, if their roughness changes and not the film. The layer's
            strength then changes in proportion, as `required_roughness` explains.
        """
        check_width(self._rollers.lines, 2.0 * half_width, "force: the contact")
        look = self._at_surfaces if self._on_surface else self._at_lines
        table, limits = look(half_width, table_at, ends, own)
        ratios = table["film_thickness"].values / self._sigma
        found = np.array([_crossing(ratios, each, self._share) for each in limits])
        if not found[0] > 0.0:
            peak = np.nanargmax(limits[0])
            raise RangeError(
                f"share: got {self._share:g}, which no film has: the largest share is "
                f"{limits[0][peak]:.3g}, at a lambda ratio of {ratios[peak]:.2g}"
            )
        return {"film_thickness": self._sigma * found, "lambda_ratio": found}

    def _at_lines(self, half_width, table_at, ends, own):
        """Films near the one sought, and the probability on lines there, with its limits."""
        spec = self._rollers.lines
        windows = spec.independent_windows(2.0 * half_width) * self._realisations
        can_sample = spec.is_gaussian and not self.gap.is_flattened
        if not can_sample and self._share * windows < 1.0:
            raise RangeError(
                f"share: got {self._share:g}, need at least {1.0 / windows:.2g}: "
                f"{self._realisations} realisations show no rarer contact, and importance sampling "
                "needs Gaussian lines that no formula flattens"
            )
        ratios, is_plain = LAMBDA_RATIOS, self.gap.is_plain
        if spec.is_gaussian or not is_plain:
            # A first look at flat films, on lines as drawn, says where to look.
            first = self._windows(self._flat(ratios, half_width), own, PLAIN)
            first = self._sampled(first, FEW_PAIRS) if spec.is_gaussian else self._counted(first)
            found = max(_crossing(ratios, first[0], self._share), ratios[np.argmax(first[0])])
            if not is_plain:
                ratios = np.unique(np.clip(found * AROUND, *ends))
            elif self._share < FALLING * first[0].max():
                ratios = found * NEAR
            else:  # the maximum is flat: the search for it needs all thinner films
                ratios = ratios[ratios < 2.0 * found * NEAR[-1]]
        table = self._flat(ratios, half_width) if is_plain else table_at(ratios)
        is_seen = self._share * windows >= OFTEN or not can_sample
        method = self._counted if is_seen else self._sampled
        return table, method(self._windows(table, own, self.gap))

    def _at_surfaces(self, half_width, table_at, ends, own):
        """Films near the one sought, and the probability on surfaces there, with its limits."""
        spec, length = self._rollers.lines, self._rollers.pair.length
        # Theory for high, flat films says where to look.
        ratios = LAMBDA_RATIOS[LAMBDA_RATIOS > 1.0]
        films, moments = ratios * self._sigma, pair_moments(spec)
        contacts = expected_contacts(films, moments, length, 2.0 * half_width)
        found = _crossing(ratios, -np.expm1(-contacts), self._share)
        ratios = np.unique(np.clip(max(found, ratios[0]) * AROUND, *ends))
        table = table_at(ratios) if self.gap.has_shape else self._flat(ratios, half_width)
        weaker = self._weaker(table, own)
        layer, seed = self._rollers.layer, self._seed
        found = surface_contact(spec, length, table, layer, seed, self.gap, weaker=weaker)
        return table, [found[f"breakthrough_probability{end}"].values for end in LIMITS]

    def _flat(self, ratios, half_width):
        films = {"film_thickness": ("film", ratios * self._sigma), "contact_half_width": half_width}
        return xr.Dataset(films | {"reduced_modulus": self._rollers.pair.reduced_modulus})

    def _weaker(self, table, own):
        """How many times weaker than the rollers' the layer is at each film, as `films` says."""
        return 1.0 if own is None else own * self._sigma / table["film_thickness"].values

    def _windows(self, table, own, gap):
        layer, weaker = self._rollers.layer, self._weaker(table, own)
        return ContactWindows(self._rollers.lines, table, layer, gap, weaker)

    def _sampled(self, windows, pairs=PAIRS):
        """Mean and limits of the breakthrough probability, by importance sampling."""
        spec, seed = self._rollers.lines, self._seed

        def on_pair(number):
            return windows.sample(spec, seed, number)[0][1]

        return mean_interval(np.stack(on_threads(on_pair, range(pairs))), 1.0)

    def _counted(self, windows):
        """Mean and limits of the breakthrough probability, counted in realisations."""
        spec, seed = self._rollers.lines, self._seed

        def on_pair(number):
            return windows.count(draw_realisation(spec, seed, number))[:, 1]

        found = np.stack(on_threads(on_pair, range(self._realisations)))
        widths = 2.0 * spec.spacing * windows.half_windows
        return probability_interval(found, spec.independent_windows(widths))


def _crossing(ratios, probabilities, share):
    """Greatest lambda ratio at which a probability equals a share: 0 if it is always less.

    Where contact is frequent, touching points merge to long segments whose boundary layer holds:
    the probability rises with the film up to a maximum, and falls beyond it.
    """
    unknown = np.full(ratios.size, np.nan)
    # The logarithm of a rare probability is nearly linear in the square of the ratio.
    curve = peaked_curve(ratios**2, probabilities, unknown, _LEAST)
    return np.sqrt(max(curve.film_at(share), 0.0))


def _reached(films, table, levels, tried):
    """Levels at which a table has the films; infinite beyond the table."""
    thickness = np.log(table["film_thickness"].values)
    rising = 1 if thickness[-1] > thickness[0] else -1
    ends = {"left": -rising * np.inf, "right": rising * np.inf}
    with np.errstate(divide="ignore"):  # a lower limit may be 0
        sought = np.log(films["film_thickness"])
    if sought[0] > thickness.max():
        film, most = 1e6 * np.exp([sought[0], thickness.max()])
        raise RangeError(
            f"share: this share needs a film of {film:.3g} um, and no {tried} gives more than "
            f"{most:.3g} um"
        )
    return np.interp(sought, thickness[::rising], levels[::rising], **ends)


def _labelled(found):
    """Answer of values and their limits, the smaller limit first."""
    rows = {}
    for name, (value, *limits) in found.items():
        rows |= values_with_limits(name, [value, *np.sort(limits)])
    return described(xr.Dataset(rows))
