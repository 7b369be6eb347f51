"""Film, probability of contact and resistance at operating points."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer, described
from lube.calculator.arguments import (
    FORMULA,
    REALISATIONS,
    SEED,
    Choices,
    Point,
    bare_number,
    check_realisations,
    conditions,
)
from lube.calculator.bands import Assumptions
from lube.calculator.parts import Oil, Rollers, with_parts
from lube.contact.ensemble import with_limits, with_pair_limits
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import surface_contact
from lube.contact.windows import ContactWindows
from lube.errors import StudyError, shown
from lube.grid.discretise import speed_ratios
from lube.grid.films import film_at
from lube.grid.plausibility import remarks
from lube.inference.surface_scatter import (
    revolution_size,
    surface_prediction,
    surface_scatter,
)
from lube.schema import LIMITS
from lube.stages.tail import pair_limits, pair_probabilities, surface_rates
from lube.study.rollers import RollerPair
from lube.study.surface_checks import check_surfaces
from lube.surfaces.synthetic import draw_realisation
from lube.threads import on_threads
from lube.types import (
    Amount,
    ContactModel,
    FilmShape,
    InletHeating,
    LoadSharing,
    OneAmount,
    RoughnessDeformation,
    Values,
)
from lube.units import with_unit

_FILM = (
    "film_thickness lambda_ratio regime in_validity_range hertz_pressure contact_half_width "
    "entrainment_speed dynamic_viscosity"
).split()
_THINNING = "inlet_shear_heating_factor", "starvation_factor"
"""Factors by which the film is thinner, where they are asked for."""
_PROBABILITIES = ("geometric_contact_probability", "breakthrough_probability")


@with_parts
def film(
    rollers: Rollers,
    oil: Oil,
    force: Amount,
    speed: Amount,
    temperature: Amount,
    *,
    film_formula: str | Sequence[str] = FORMULA,
    inlet_shear_heating: InletHeating = "none",
    inlet_meniscus: OneAmount | None = None,
    slide_to_roll_ratio: float = 0.0,
) -> Answer:
    """Film thickness, lambda ratio and regime.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    oil : Oil
        The oil between them.
    force : str, sequence of str or tuple
        Normal force, such as ``"800 N"``, or several: ``["400 N", "800 N"]`` or
        ``([400, 800], "N")``.
    speed : str, sequence of str or tuple
        Rotation speed of the first roller in pure rolling, such as ``"100 rpm"``, or entrainment
        speed, such as ``"0.5 m/s"``.
    temperature : str, sequence of str or tuple
        Temperature of rollers and oil, such as ``"60 degC"``.
    film_formula : str or sequence of str, optional
        Keys of `lube.FORMULAS`.
    inlet_shear_heating : str, optional
        How heating of the oil at the inlet thins the film, the more so the more the rollers slip:
        ``"none"``; ``"zhu-cheng-1988"`` or ``"wilson-sheu-1983"`` by a formula; or ``"computed"``,
        by the equation behind the latter.
    inlet_meniscus : str, optional
        Distance of the oil's meniscus before the line of centres, such as ``"1 mm"``, more than the
        half-width of the contact. Without it the contact is fully flooded.
    slide_to_roll_ratio : float, optional
        Difference of the surface speeds over their mean, on which the heating depends.

    Returns
    -------
    Answer
        The film in customary units, with ``inlet_shear_heating_factor`` and ``starvation_factor``,
        by which heating and starvation thin it, where they are asked for. Its dimensions are those
        of film_formula, temperature, speed and force that have several values. Like ``lube
        check``, its attribute ``remarks`` has a line for each value that may be a mistake or is
        beyond the limits of the model, by the first film formula.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="50 mm", rms_roughness="0.2 um")
    >>> found = film(rollers, Oil("mobilgear-shc-xmp-320"), "800 N", "100 rpm", "40 degC")
    >>> f"{found.film_thickness.item():.2f} um, lambda ratio {found.lambda_ratio.item():.1f}"
    '1.05 um, lambda ratio 3.7'
    """
    slip = bare_number("slide_to_roll_ratio", slide_to_roll_ratio, least=-2.0, most=2.0)
    choices = Choices.of_smooth_rollers(inlet_shear_heating, inlet_meniscus)
    table = film_in_si(rollers, oil, force, speed, temperature, film_formula, choices, slip)
    return with_remarks(of_film(table), table, rollers)


def of_film(table: xr.Dataset) -> xr.Dataset:
    """Variables of a film table that answers have."""
    return table[[*_FILM, *(name for name in _THINNING if name in table)]]


def film_in_si(
    rollers: Rollers,
    oil: Oil,
    force: Amount,
    speed: Amount,
    temperature: Amount,
    film_formula: str | Sequence[str],
    choices: Choices,
    slip: float = 0.0,
) -> xr.Dataset:
    """All variables of the film table in SI units, and the oil's viscosity.

    The arguments are those of `film`, `contact_probability` and `ensemble`.
    """
    point = conditions(force, speed, temperature, rollers.pair.first.radius)
    formulas = _names(film_formula)
    check_contact(rollers, rollers.pair.contact_half_width(point["force"].values), choices)
    model = film_model(rollers, choices, slip)
    table = film_of_oil(oil, rollers.pair, point, formulas, **model)
    dims = ("film_formula", "temperature", "speed", "force")
    table = table.assign_coords(force=point["force"], speed=point["speed"])
    table = table.transpose(*dims, ..., missing_dims="ignore")
    return table if np.ndim(film_formula) else table.isel(film_formula=0)


def check_contact(rollers: Rollers, half_width: Values, choices: Choices) -> None:
    """Refuse contacts that lines or surfaces do not have, before films take their time.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    half_width : float or numpy.ndarray
        Half-widths of the contacts, m.
    choices : Choices
        With the contact models.

    Raises
    ------
    LubeError
        As from `lube.study.surface_checks.check_surfaces`; or that a contact is finer than the grid
        or wider than a roller's perimeter, or reaches the meniscus, or that no line stands for the
        rollers.
    """
    spec, widest = rollers.lines, 2.0 * np.max(half_width).item()
    meniscus = choices.inlet_meniscus
    if meniscus is not None and meniscus <= 0.5 * widest:
        needed = f"more than {with_unit(0.5 * widest, 'm', 3)}, the half-width of the contact"
        raise StudyError(f"inlet_meniscus: got {with_unit(meniscus, 'm', 3)}, need {needed}")
    if "line" in choices.models:
        for width in (2.0 * np.min(half_width).item(), widest):
            spec.check_width(width, "force: the contact")
        spec.check_follows_rolling()
    if "surface" in choices.models:
        check_surfaces(spec, rollers.pair.length, widest, choices.gap)


def _names(film_formula):
    """Film formulas as a list."""
    formulas = np.ravel(film_formula).tolist()
    if not formulas or not isinstance(formulas[0], str):
        raise StudyError(f"film_formula: got {shown(film_formula)}, need a name, or a list of them")
    return formulas


def film_model(rollers: Rollers, choices: Choices, slip: float) -> dict[str, Any]:
    """Arguments of `film_of_oil` for some choices and a slide-to-roll ratio."""
    choices.gap.check_slip(slip)
    answered = {"line": "answered_lines", "surface": "answered_surfaces"}
    used = choices.models if choices.gap.is_answered else ()
    has_surfaces = "surface" in choices.models or choices.load_sharing != "none"
    return {
        "with_shape": choices.gap.has_shape,
        "slide_to_roll_ratio": slip,
        "rough_surfaces": rollers.lines if has_surfaces else None,
        "load_sharing": choices.load_sharing,
        "inlet_shear_heating": choices.inlet_shear_heating,
        "inlet_meniscus": choices.inlet_meniscus,
        **{answered[model]: rollers.lines for model in used},
    }


def film_of_oil(
    oil: Oil, pair: RollerPair, point: Point, formulas: Sequence[str], **choices: Any
) -> xr.Dataset:
    """Film table with the oil's viscosity; the point's numbers are in N, rpm and degC.

    Raises
    ------
    StudyError
        If the inlet heats up, and the oil's thermal conductivity is not known.
    """
    properties, heating = oil.at(point["temperature"]), choices["inlet_shear_heating"]
    if heating != "none" and properties["thermal_conductivity"].isnull().any():
        needed = "need none, or an oil with thermal_conductivity"
        raise StudyError(f"inlet_shear_heating: got {heating}, {needed}")
    table = film_at(properties, pair, point["force"], point["speed"], formulas, **choices)
    if heating == "none":
        del table["inlet_shear_heating_factor"]
    if choices["inlet_meniscus"] is not None:
        table["inlet_meniscus"] = choices["inlet_meniscus"]
    return table.assign(dynamic_viscosity=properties["dynamic_viscosity"])


def with_remarks(found: xr.Dataset, table: xr.Dataset, rollers: Rollers) -> Answer:
    """Answer in customary units, with its remarks and those of `lube check`.

    Parameters
    ----------
    found : xarray.Dataset
        Results in SI units.
    table : xarray.Dataset
        The film table that it comes from.
    rollers : Rollers
        The two rollers.

    Returns
    -------
    Answer
        With the attribute ``remarks``, one line for each remark.
    """
    notes = [found.attrs.get("remarks"), *remarks(table, rollers.lines, rollers.pair)]
    if halved := int((table.get("inlet_shear_heating_factor", xr.DataArray(1.0)) < 0.5).sum()):
        notes.append(
            f"inlet_shear_heating: at {halved} operating points the film is less than half as "
            "thick, where no model of the heating is reliable"
        )
    return described(found.assign_attrs(remarks="\n".join(filter(None, notes))))


@with_parts
def contact_probability(
    rollers: Rollers,
    oil: Oil,
    force: Amount,
    speed: Amount,
    temperature: Amount,
    *,
    film_formula: str | Sequence[str] = FORMULA,
    film_shape: FilmShape = "flat",
    roughness_deformation: RoughnessDeformation = "none",
    inlet_shear_heating: InletHeating = "none",
    inlet_meniscus: OneAmount | None = None,
    load_sharing: LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: ContactModel | Sequence[ContactModel] = "line",
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
        length of the rollers, which takes half a minute; or a list of both. The surface needs
        Gaussian heights that no formula flattens.
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
        which the share of one pair in a revolution lies in 95 % of cases. Results of importance
        sampling are ``tail_breakthrough_probability``, ``tail_geometric_contact_probability`` and
        ``tail_breakthrough_rate``, breakthroughs per hour, each with ``_lower`` and ``_upper``.
        They are NaN where the heights are not Gaussian, or the formula flattens them; then the
        attribute ``remarks`` says so, before the remarks of `film`.

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
        rollers move while a contact is in the strip; and, if the oil does not deform the roughness,
        ``surface_expected_breakthroughs`` and ``surface_expected_contacts``. From numbers and
        passage: ``surface_breakthrough_rate``, per hour, with ``_lower`` and ``_upper``, and
        ``surface_breakthrough_duration``.

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
    slip = bare_number("slide_to_roll_ratio", slide_to_roll_ratio, least=-2.0, most=2.0)
    choices = Choices.of(
        film_shape,
        roughness_deformation,
        contact_model,
        inlet_shear_heating,
        inlet_meniscus,
        load_sharing,
    )
    pair = rollers.rough_pair(seed, choices.gap)
    check_realisations(realisations, seed)
    assumed = Assumptions(bands, rollers, oil, choices, _names(film_formula)[0], seed)
    assumed.check(conditions(force, speed, temperature, rollers.pair.first.radius))
    table = film_in_si(rollers, oil, force, speed, temperature, film_formula, choices, slip)
    found = of_film(table)
    if "line" in choices.models:
        contact = ensemble(pair, table, realisations, slip)
        on_pairs = pair_probabilities(pair, table, slip)
        found = joined(table, contact, on_pairs)
    if "surface" in choices.models:
        found = found.assign(of_surface(pair, table, slip))
    if "surface_load_share" in table:
        found["surface_load_share"] = table["surface_load_share"]
    if assumed.wanted:
        points = conditions_of(table) | {"slide_to_roll_ratio": slip}
        samples = assumed.probabilities(points)
        found = found.assign(assumed.limits(samples, "assumed_breakthrough_probability"))
    return with_remarks(found, table, rollers)


def conditions_of(table: xr.Dataset) -> dict[str, xr.DataArray]:
    """Force in N, speed in rpm and temperature in degC of a table from `film_in_si`.

    And ``viscosity_factor`` if the table has it.
    """
    names = "force", "speed", "temperature", "viscosity_factor"
    return {name: table[name] for name in names if name in table.coords}


def of_surface(
    pair: RoughPair, table: xr.Dataset, slip: xr.DataArray | float
) -> dict[str, xr.DataArray]:
    """Contact of the surface at some films, by the names of `contact_probability`."""
    found = surface_contact(pair, table, slide_to_roll_ratio=slip)
    found = found.assign(surface_rates(found, table["entrainment_speed"]))
    share = [found[f"breakthrough_probability{end}"] for end in LIMITS]
    slips, ratio = xr.full_like(share[0], 1.0) * slip, np.ones(share[0].shape)
    if slips.any():
        of_turn = share[0].values.ravel(), slips.values.ravel(), np.ones(slips.size), 0.0
        ratio = surface_scatter(pair, table, *of_turn).reshape(slips.shape)
    size = revolution_size(pair.spec, found)
    of_pair = surface_prediction([each.values for each in share], size, ratio)
    for end, limit in zip(LIMITS[1:], of_pair, strict=True):
        found[f"breakthrough_probability_pair{end}"] = share[0].copy(data=limit)
    return {f"surface_{name}": values for name, values in found.items()}


def joined(table: xr.Dataset, contact: xr.Dataset, on_pairs: xr.Dataset) -> xr.Dataset:
    """Film, counted probabilities, and sampled ones, whose names begin with ``tail_``."""
    sampled = pair_limits(on_pairs)
    tail = {f"tail_{name}": values for name, values in sampled.items()}
    found = of_film(table).assign(dict(contact.data_vars) | tail)
    return found.assign_attrs(contact.attrs | sampled.attrs)


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
    contact = {name: (dims, each) for name, each in zip(_PROBABILITIES, shares, strict=True)}
    levels = {"realisation": np.arange(realisations), **thickness.coords}
    independent = spec.independent_windows(width, min(speed_ratios(slip)))
    found = with_limits(xr.Dataset(contact, levels, {"seed": pair.seed}), independent)
    return with_pair_limits(found, independent)
