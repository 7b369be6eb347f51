"""Search for the film that keeps contact below a share of time."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer
from lube.calculator.arguments import bare_number, check_realisations, one_name
from lube.calculator.bands import Assumptions
from lube.calculator.choices import Choices
from lube.calculator.film import conditions_of, with_remarks
from lube.calculator.rollers import Rollers
from lube.contact.strip_film import surface_moments
from lube.contact.surface_strip import strip_films, surface_contact
from lube.contact.windows import ContactWindows
from lube.errors import RangeError, StudyError, shown
from lube.grid.films import unreported
from lube.grid.gap import PLAIN
from lube.physics.excursions import expected_contacts
from lube.schema import LIMITS, values_with_limits
from lube.stages.tail import PAIRS
from lube.statistics.confidence import mean_interval, probability_interval
from lube.statistics.curves import contact_curve, peaked_curve
from lube.surfaces.synthetic import draw_realisation
from lube.threads import on_threads
from lube.types import Array

LAMBDA_RATIOS = np.geomspace(0.1, 13.0, 61)
"""Lambda ratios of the first look; at the highest, contact has a probability of 1e-37."""
NEAR = np.exp(np.linspace(-0.2, 0.2, 9))
"""Lambda ratios of the second look, over the one at which the first look finds the share."""
AROUND = np.exp(np.linspace(-1.0, 0.6, 17))
"""The same for surfaces, and for lines if the film has a shape or the oil changes them, which the
first look ignores."""
EXPECTED = np.exp([-0.3, 0.1])
"""The same for surfaces under films with a shape, or that the oil answers, where each film takes
many seconds: at these two, theory says how many contacts to expect."""
CLOSE = np.exp(np.linspace(-0.25, 0.15, 5))
"""Lambda ratios at which these surfaces are sampled, over the one at which theory has the share."""
FARTHER = np.exp(np.linspace(0.1, 0.4, 4))
"""How many times thicker, or thinner, the next films are if those do not enclose the share."""
BROAD = np.exp(np.linspace(-1.0, 1.0, 11))
"""The same for the limits over what is not known exactly."""
FALLING = 0.3
"""Share, relative to the largest probability of the first look, which is rough where contact is
frequent, below which it is well on the falling branch."""
OFTEN = 10.0
"""Least number of independent windows with contact, in all realisations, to count contact."""
FEW_PAIRS = 2
"""Pairs of lines of the first look."""
_LEAST = 1e-40
"""Probability below which contact counts as impossible."""


def check_known(is_known: bool) -> None:
    """Refuse conditions at none of which the film is known.

    Raises
    ------
    RangeError
        In one line.
    """
    if not is_known:
        raise RangeError("the film did not converge at the conditions tried, need others")


class FilmSearch:
    """Search for the films at which the probability of contact equals a share of time.

    Contact of lines is counted where the realisations show enough of it, else sampled; that of the
    surface is sampled. It is counted in alignments of pure rolling, in which it is as frequent as
    with slip.

    Parameters
    ----------
    assumed : Assumptions
        Rollers, a model with a single contact model, and what is not known exactly; if wanted, adds
        the limits over it to all that is found.
    share : float
        Share of time with contact, between 0 and 1.
    realisations : int
        As in `lube.contact_probability`.
    """

    def __init__(self, assumed: Assumptions, share: float | str, realisations: int) -> None:
        rollers, choices, seed = assumed.rollers, assumed.choices, assumed.seed
        if len(choices.models) > 1:
            raise StudyError(f"contact_model: got {shown(list(choices.models))}, need one name")
        one_name("film_formula", choices.film_formula)
        self._share = bare_number("share", share, above=0.0, below=1.0)
        self._choices, self._gap = choices, choices.gap
        self._on_surface = "surface" in choices.models
        self._realisations = check_realisations(realisations, seed)
        self._rollers, self._seed, self._assumed = rollers, seed, assumed
        if not self._on_surface:
            rollers.lines.check_follows_rolling()
        self._sigma = rollers.pair.composite_rms_roughness

    def along(self, table, levels, tried, is_rising=True):
        """Find the films that give the share, and the levels of a condition that give them.

        Parameters
        ----------
        table : callable
            Film table at some levels, with choices as second argument.
        levels : numpy.ndarray
            Levels of the condition that are tried.
        tried : str
            These levels in words.
        is_rising : bool, optional
            Whether the film grows with the condition. Where heating at the inlet makes it shrink
            again, levels beyond the thickest film are left out.

        Returns
        -------
        films : dict
            As from `films`.
        levels : numpy.ndarray
            The level and its limits.
        table : xarray.Dataset
            Film table at the film found, or the one next to it that was tried.
        """
        plain = replace(self._choices, gap=PLAIN)
        with unreported():
            whole = table(levels, plain)
        for name, size in whole["film_thickness"].sizes.items():
            if size != levels.size:
                raise StudyError(f"{name}: got {size} values, need one")
        ratios = whole["lambda_ratio"].values
        known = np.flatnonzero(np.isfinite(ratios))
        check_known(known.size)
        thickest = known[np.argmax(ratios[known])]
        known = known[known <= thickest] if is_rising else known[known >= thickest][::-1]

        def table_at(sought, choices=self._choices):
            here = np.interp(sought, ratios[known], known)
            return table(np.interp(here, np.arange(levels.size), levels), choices)

        def points_at(sought):
            return conditions_of(table_at(sought, plain), plain)

        ends = ratios[known[[0, -1]]]
        films = self.films(whole["contact_half_width"].item(), points_at, table_at, ends)
        thickness = whole["film_thickness"].values[known]
        reached = _reached(films, thickness, levels[known], tried, is_rising)
        return films, reached, table_at(np.clip(films["lambda_ratio"][:1], *ends))

    def films(self, half_width, points_at, table_at=None, ends=(0.0, np.inf), factor_at=None):
        """Find the films at which the probability, its lower and its upper limit equal the share.

        Parameters
        ----------
        half_width : float
            Half-width of the contact, m.
        points_at : callable
            Operating points at some lambda ratios, as `lube.calculator.bands.Assumptions` takes
            them.
        table_at : callable, optional
            Film table at some lambda ratios, for films with a shape and for lines that the oil
            flattens or answers.
        ends : tuple of float, optional
            Least and greatest lambda ratio of `table_at`.
        factor_at : callable, optional
            Factor of the rollers' heights at some lambda ratios, if these change and not the film.
            The layer's strength then changes in proportion, as `required_roughness` explains.
        """
        self._rollers.lines.check_width(2.0 * half_width, "force: the contact")
        if self._assumed.wanted:
            self._assumed.check(points_at(np.clip(LAMBDA_RATIOS[[0, -1]], *ends)))
        look = self._at_surfaces if self._on_surface else self._at_lines
        ratios, limits = look(half_width, table_at, ends, factor_at)
        known = np.isfinite(limits[0])
        check_known(known.any())
        ratios, limits = ratios[known], [each[known] for each in limits]
        found = np.array([self._crossing(ratios, each) for each in limits])
        if not (found[0] > 0.0 or np.isclose(ratios[0], ends[0])):  # thinner films are not known
            peak = np.argmax(limits[0])
            raise RangeError(
                f"share: got {self._share:g}, which no film has: the largest share is "
                f"{limits[0][peak]:.3g}, at a lambda ratio of {ratios[peak]:.2g}"
            )
        if self._assumed.wanted:
            found = np.append(found, self._over_assumptions(found[0], points_at, ends))
        return {"film_thickness": self._sigma * found, "lambda_ratio": found}

    def _over_assumptions(self, found, points_at, ends):
        """Find the films that 5 and 95 % of the samples need at most.

        Each sample touches less under a thicker film. So 95 % need less than the film at which the
        probability is below the share in 95 % of them.
        """
        ratios = np.unique(np.clip(found * BROAD, *ends))
        samples = self._assumed.probabilities(points_at(ratios))
        limits = np.stack(list(self._assumed.limits(samples, "share").values()))
        known = np.isfinite(limits).all(axis=0)
        if not known.any():
            return np.full(2, np.nan)
        return [self._crossing(ratios[known], each[known]) for each in limits]

    def _at_lines(self, half_width, table_at, ends, factor_at):
        """Films near the one sought, and the probability on lines there, with its limits."""
        spec = self._rollers.lines
        windows = spec.independent_windows(2.0 * half_width) * self._realisations
        can_sample = spec.is_gaussian and not self._gap.is_flattened
        if not can_sample and self._share * windows < 1.0:
            raise RangeError(
                f"share: got {self._share:g}, need at least {1.0 / windows:.2g}: "
                f"{self._realisations} realisations show no rarer contact, and importance sampling "
                "needs Gaussian lines that no formula flattens"
            )
        ratios, is_plain = LAMBDA_RATIOS, self._gap.is_plain
        if spec.is_gaussian or not is_plain:
            # A first look at flat films, on lines as drawn, says where to look.
            first = self._windows(self._flat(ratios, half_width), factor_at, PLAIN)
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
        looked_at = self._windows(table, factor_at, self._gap)
        limits = self._counted(looked_at) if is_seen else self._sampled(looked_at, PAIRS)
        return self._ratios(table), limits

    def _at_surfaces(self, half_width, table_at, ends, factor_at):
        """Films near the one sought, and the probability on surfaces there, with its limits."""
        pair = self._rollers.rough_pair(self._seed, self._gap)
        # Theory for high, flat films says where to look.
        ratios = LAMBDA_RATIOS[LAMBDA_RATIOS > 1.0]
        films, moments = ratios * self._sigma, surface_moments(pair.spec)
        contacts = expected_contacts(films, moments, pair.length, 2.0 * half_width)
        found = max(_crossing(ratios, -np.expm1(-contacts), self._share), ratios[0])

        def sampled(table):
            contact = surface_contact(pair, table, weaker=self._weaker(table, factor_at))
            limits = [contact[f"breakthrough_probability{end}"].values for end in LIMITS]
            return self._ratios(table), np.stack(limits)

        if not self._gap.is_plain:
            found = self._expected(pair, table_at, ends, found)
            return self._enclosing(lambda ratios: sampled(table_at(ratios)), ends, found)
        while True:
            ratios, limits = sampled(self._flat(found * AROUND, half_width))
            if (limits[0] >= self._share).any() or ratios[0] < LAMBDA_RATIOS[0]:
                return ratios, limits
            found = found * AROUND[0]  # the layer of most contacts holds

    def _expected(self, pair, table_at, ends, found):
        """Find the lambda ratio at which theory expects the share, from two films."""
        table = table_at(np.clip(found * EXPECTED, *ends))
        strips, ratios = strip_films(pair, table), self._ratios(table)
        if None in strips or ratios[0] == ratios[1]:
            return found
        numbers = [strip.contacts(pair.spec, pair.length).number for strip in strips]
        # The logarithm of the number is nearly linear in the square of the ratio.
        wanted, logs, squares = np.log(-np.log1p(-self._share)), np.log(numbers), ratios**2
        square = squares[0] + (wanted - logs[0]) * np.diff(squares).item() / np.diff(logs).item()
        return np.sqrt(np.clip(square, *(found * AROUND[[0, -1]]) ** 2))

    def _enclosing(self, sampled, ends, found):
        """Sample surfaces at more and more films, until the limits enclose the share."""
        ends, tried, parts = np.clip(ends, *LAMBDA_RATIOS[[0, -1]]), [], []
        more = np.unique(np.clip(found * CLOSE, *ends))
        while more.size:
            tried, parts = [*tried, *more], [*parts, sampled(more)]
            ratios, limits = (np.concatenate(each, axis=-1) for each in zip(*parts, strict=True))
            if np.isnan(parts[-1][1]).all():
                break  # no film is known beyond those that did not converge
            farther = np.stack([min(tried) / FARTHER, max(tried) * FARTHER])
            enclosed = np.array([limits[1] > self._share, limits[2] < self._share]).any(axis=1)
            more = np.setdiff1d(np.clip(farther[~enclosed], *ends), tried)
        order = np.argsort(ratios)
        return ratios[order], limits[:, order]

    def _crossing(self, ratios, probabilities):
        """Greatest lambda ratio at which a probability equals the share.

        0 if it is always less, infinite if it is always more.
        """
        if (probabilities < self._share).all():
            return 0.0
        if (probabilities > self._share).all():
            return np.inf
        if self._on_surface:
            curve = contact_curve(np.log(ratios), probabilities, np.ones(ratios.size))
            found = np.exp(curve.film_at(self._share))
        else:
            found = _crossing(ratios, probabilities, self._share)
        if 0.0 < found < np.inf:
            return found
        # Beside a probability of 0 or 1, from which no curve follows.
        peak = np.argmax(probabilities)
        return ratios[peak:][probabilities[peak:] < self._share].min(initial=np.inf)

    def _ratios(self, table):
        """Lambda ratios of films."""
        return table["film_thickness"].values / self._sigma

    def _flat(self, ratios, half_width):
        films = {"film_thickness": ("film", ratios * self._sigma), "contact_half_width": half_width}
        return xr.Dataset(films | {"reduced_modulus": self._rollers.pair.reduced_modulus})

    def _weaker(self, table, factor_at):
        """How many times weaker than the rollers' the layer is at each film, as `films` says."""
        return 1.0 if factor_at is None else factor_at(self._ratios(table))

    def _windows(self, table, factor_at, gap):
        layer, weaker = self._rollers.layer, self._weaker(table, factor_at)
        return ContactWindows(self._rollers.lines, table, layer, gap, weaker)

    def _sampled(self, windows, pairs):
        """Mean and limits of the breakthrough probability, by importance sampling."""
        found = windows.on_pairs(self._rollers.lines, self._seed, pairs)
        return mean_interval(found[:, 1], 1.0)

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
    # The logarithm of a rare probability is nearly linear in the square of the ratio.
    curve = peaked_curve(ratios**2, probabilities, np.full(ratios.size, np.nan), _LEAST)
    film = curve.film_at(share)  # NaN where all probabilities are 0
    return np.sqrt(film) if film > 0.0 else 0.0


def _reached(films, thickness, levels, tried, is_rising):
    """Levels at which films have a thickness, of levels in the order of rising thickness.

    Beyond them a speed or viscosity is 0 or infinite, a temperature infinite of either sign.
    """
    # Films that rise with the level are those of a speed or viscosity, others of a temperature.
    left, right = (0.0, np.inf) if is_rising else (np.inf, -np.inf)
    with np.errstate(divide="ignore"):  # a lower limit may be 0
        sought, thickness = np.log(films["film_thickness"]), np.log(thickness)
    if sought[0] > thickness[-1]:
        film, most = 1e6 * np.exp([sought[0], thickness[-1]])
        needed = f"film of {film:.3g} um" if np.isfinite(film) else "thicker film"
        given = f"no {tried} gives more than {most:.3g} um"
        raise RangeError(f"share: this share needs a {needed}, and {given}")
    return np.interp(sought, thickness, levels, left, right)


def labelled(
    found: Mapping[str, Array], film: xr.Dataset, rollers: Rollers, choices: Choices
) -> Answer:
    """Answer of what was found, with remarks on the film found.

    Parameters
    ----------
    found : dict of str to numpy.ndarray
        By name the value, its two limits and, with bands, two more over what is not known exactly.
    film : xarray.Dataset
        Film table at the film found.
    rollers : Rollers
        The two rollers.
    choices : Choices
        With the contact model.
    """
    rows = {}
    for name, (value, *limits) in found.items():
        rows |= values_with_limits(name, [value, *np.sort(limits[:2])])
        assumed = zip(LIMITS[1:], np.sort(limits[2:]), strict=False)
        rows |= {f"assumed_{name}{end}": limit for end, limit in assumed}
    return with_remarks(xr.Dataset(rows), film, rollers, choices.models)
