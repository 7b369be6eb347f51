"""Probability of contact at operating points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube import types
from lube.calculator.answers import Answer
from lube.calculator.arguments import check_realisations, checked, conditions
from lube.calculator.bands import Assumptions
from lube.calculator.choices import FORMULA, REALISATIONS, SEED, Choices, Inlet
from lube.calculator.film import conditions_of, film_in_si, of_film, with_remarks
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.contact.ensemble import with_limits, with_pair_limits
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import surface_contact, surface_widths
from lube.contact.windows import ContactWindows
from lube.grid.discretise import speed_ratios
from lube.grid.gap import Gap
from lube.inference.surface_scatter import revolution_size, surface_prediction, surface_scatter
from lube.schema import LIMITS
from lube.stages.tail import pair_limits, pair_probabilities, surface_rates
from lube.surfaces.synthetic import draw_realisation
from lube.threads import on_threads


@checked
def contact_probability(
    rollers: Rollers,
    oil: Oil,
    force: types.Amount,
    speed: types.Amount,
    temperature: types.Amount,
    *,
    film_formula: str | Sequence[str] = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel | Sequence[types.ContactModel] = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Probability of metal contact, with its 95 % interval, and the film.

    It is a mean over pairs of rollers; a single pair touches more or less often. By default it is
    the probability for a line. The surfaces of rollers, which have a length, touch far more often:
    that is the probability for the surface. The arguments in `lube.COMPLETE` choose the most
    complete model of this package, such as ``contact_probability(..., **lube.COMPLETE)``.

    The probability for the line is found in two ways. Contact in realisations is counted, as in
    ``contact.nc`` of a study; where they show no contact, the upper limit says how rare it is at
    least. Importance sampling, as in ``tail.nc``, finds any probability, however small, with a
    standard error of about 2 %: use it where contact is rare. Both agree where both find contact.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula
        As in `film`.
    film_shape : str, optional
        ``"flat"``; or ``"computed"`` from Reynolds' equation, which takes a second for each
        operating point.
    roughness_deformation : str, optional
        ``"none"``; ``"computed"``: the oil deforms each wave of the roughness by Reynolds'
        equation, which takes some seconds for each operating point; or ``"venner-1997"``: it
        flattens long waves of lines by a formula for Moes' load numbers above 20.
    inlet_shear_heating, inlet_meniscus
        As in `film`.
    load_sharing : str, optional
        ``"none"``, the oil carries the whole load; or ``"iterated"``, the asperities of the
        rollers' surfaces carry a share of it, and the film is that of the rest.
    slide_to_roll_ratio : float, optional
        Difference of the surface speeds over their mean. It changes the computing time and the
        scatter, and with heating at the inlet or ``roughness_deformation="computed"`` also the
        expected probability.
    contact_model : str or sequence of str, optional
        ``"line"``; ``"surface"``, the isotropic rough surface that the line stands for, over the
        length of the rollers, which takes ten seconds to half a minute; or a list of both. The
        surface needs Gaussian heights that no formula flattens.
    realisations : int, optional
        Number of pairs of roughness lines.
    seed : int, optional
        Seed of the roughness.
    bands : bool or dict, optional
        Whether to find the band of the probability over what is not known exactly: a dict in the
        form of a study's section ``uncertainty``, such as ``{"temperature": {"range": "+- 3 K",
        "source": "thermocouple"}}``; or True for usual ranges of quantities, without choices of
        the model. It is from 128 samples, 32 for surfaces, and takes some seconds for each
        operating point of lines under flat films, some minutes for surfaces. It needs Gaussian
        heights that no formula flattens.

    Returns
    -------
    Answer
        The variables of `film`; ``breakthrough_probability`` and
        ``geometric_contact_probability`` of each realisation, and ``_mean``, ``_lower`` and
        ``_upper`` of both; ``breakthrough_probability_pair_lower`` and ``_pair_upper``, between
        which the share of one pair in a revolution of the faster roller lies in 95 % of cases.
        Results of importance sampling are ``tail_breakthrough_probability``,
        ``tail_geometric_contact_probability`` and ``tail_breakthrough_rate``, breakthroughs per
        hour, each with ``_lower`` and ``_upper``.
        Pieces of runs that the edges of the contact cut off add to the probability but not to the
        rate, which is NaN where nothing else was found to break. All are NaN where the heights are
        not Gaussian, or the formula flattens them; then the attribute ``remarks`` says so, before
        the remarks of `film`.

        With `bands` also ``assumed_breakthrough_probability_lower`` and ``_upper``, between which
        90 % of the means over pairs lie, by the first film formula and contact model unless
        `bands` has choices.

        For the surface, by importance sampling: ``surface_breakthrough_probability`` and
        ``surface_geometric_contact_probability``, anywhere along the rollers, and the mean numbers
        ``surface_breakthroughs`` and ``surface_contacts`` at any moment, and the part of the
        contact's area where the layer is broken, ``surface_breakdown_ratio``, each with ``_lower``
        and ``_upper``. By theory: ``surface_load_share``, the share of the load that their
        asperities would carry; ``surface_pair_deviation``, the standard deviation of the share of
        one pair of rollers in a revolution of pure rolling, and
        ``surface_breakthrough_probability_pair_lower`` and ``_pair_upper``, between which this
        share lies in 95 % of cases, with the slip given; ``surface_passage_width``, over which the
        rollers move while a contact is in the strip, and ``surface_breakthrough_width``, over which
        they move while the layer of a contact is broken; and ``surface_expected_breakthroughs`` and
        ``surface_expected_contacts``, which are less than the numbers sampled where contacts have
        holes, with the default band by 2 % at a lambda ratio of 9 and 15 % at 4.5. From numbers and
        ``surface_breakthrough_width``: ``surface_breakthrough_rate``, per hour, with ``_lower`` and
        ``_upper``, and ``surface_breakthrough_duration``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="5 mm", rms_roughness="0.2 um")
    >>> oil = Oil("mobilgear-shc-xmp-320")
    >>> found = contact_probability(
    ...     rollers, oil, "300 N", "500 rpm", "80 degC", realisations=4
    ... )
    >>> bool(found.breakthrough_probability_lower < found.breakthrough_probability_upper)
    True
    >>> bool(found.tail_breakthrough_probability_lower > 0)
    True
    """
    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, contact_model)
    check_realisations(realisations, seed)
    assumed = Assumptions(bands, rollers, oil, choices, seed)
    assumed.check(conditions(force, speed, temperature, rollers.pair.first.radius))
    table = film_in_si(rollers, oil, force, speed, temperature, choices)
    pair = rollers.rough_pair(seed, gap)
    found, _ = contact_at(table, pair, choices, realisations, choices.slip)
    if assumed.wanted:
        samples = assumed.probabilities(conditions_of(table, choices))
        found = found.assign(assumed.limits(samples, "assumed_breakthrough_probability"))
    return with_remarks(found, table, rollers, choices.models)


def contact_at(
    table: xr.Dataset, pair: RoughPair, choices: Choices, realisations: int, counted_slip: float
) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Film and contact at some films, by the names of `contact_probability`.

    Parameters
    ----------
    table : xarray.Dataset
        Film table, for these choices.
    pair : RoughPair
        The rollers.
    choices : Choices
        With the contact models and the slip.
    realisations : int
        As in `contact_probability`.
    counted_slip : float
        Slide-to-roll ratio of the alignments in which contact of lines is counted.

    Returns
    -------
    found : xarray.Dataset
        In SI units.
    on_pairs : xarray.Dataset or None
        Probabilities of lines as from `lube.stages.tail.pair_probabilities`; None without lines.
    """
    found, on_pairs = of_film(table), None
    if "line" in choices.models:
        contact = ensemble(pair, table, realisations, counted_slip)
        on_pairs = pair_probabilities(pair, table, choices.slip)
        sampled = pair_limits(on_pairs)
        tail = {f"tail_{name}": values for name, values in sampled.items()}
        found = found.assign(dict(contact.data_vars) | tail)
        found = found.assign_attrs(contact.attrs | sampled.attrs)
    if "surface" in choices.models:
        found = found.assign(_of_surface(pair, table, choices.slip))
    if choices.has_surfaces:
        found["surface_load_share"] = table["surface_load_share"]
    return found, on_pairs


def _of_surface(pair, table, slip):
    """Contact of the surface at some films, by the names of `contact_probability`."""
    found = surface_contact(pair, table).assign(surface_widths(pair, table, slip))
    found = found.assign(surface_rates(found, table["entrainment_speed"]))
    share = [found[f"breakthrough_probability{end}"] for end in LIMITS]
    slips, ratio = xr.full_like(share[0], 1.0) * slip, np.ones(share[0].shape)
    if slips.any():
        ratio = surface_scatter(
            pair, table, share[0].values.ravel(), slips.values.ravel(), np.ones(slips.size), 0.0
        ).reshape(slips.shape)
    size = revolution_size(pair.spec, found)
    of_pair = surface_prediction([each.values for each in share], size, ratio)
    for end, limit in zip(LIMITS[1:], of_pair, strict=True):
        found[f"breakthrough_probability_pair{end}"] = share[0].copy(data=limit)
    return {f"surface_{name}": values for name, values in found.items()}


def ensemble(pair: RoughPair, table: xr.Dataset, realisations: int, slip: float) -> xr.Dataset:
    """Probabilities at some films and contact widths, and their intervals.

    Parameters
    ----------
    pair : RoughPair
        The rollers.
    table : xarray.Dataset
        With ``film_thickness`` and ``contact_half_width`` (m) over any dimensions, and
        ``reduced_modulus`` (Pa); as `lube.contact.windows.ContactWindows` needs it.
    realisations : int
        As in `contact_probability`.
    slip : float
        Slide-to-roll ratio.

    Returns
    -------
    xarray.Dataset
        Both probabilities over all realisations and the table's dimensions, and their ``_mean``,
        ``_lower`` and ``_upper``.
    """
    spec = pair.spec
    thickness, width = xr.broadcast(table["film_thickness"], 2.0 * table["contact_half_width"])
    windows = ContactWindows(spec, table, pair.layer, pair.gap)

    def of_realisation(number):
        return windows.count(draw_realisation(spec, pair.seed, number), slip)[:, :2]

    counts = on_threads(of_realisation, range(realisations), name="contact of lines")
    shares = np.reshape(np.moveaxis(counts, -1, 0), (2, -1, *thickness.shape))
    dims = "realisation", *thickness.dims
    touched, broken = ((dims, each) for each in shares)
    contact = {"geometric_contact_probability": touched, "breakthrough_probability": broken}
    levels = {"realisation": np.arange(realisations), **thickness.coords}
    independent = spec.independent_windows(width, min(speed_ratios(slip)))
    found = with_limits(xr.Dataset(contact, levels, {"seed": pair.seed}), independent)
    return with_pair_limits(found, independent)
