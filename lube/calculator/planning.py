"""What a record at some operating points would tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lube import types
from lube.calculator.answers import Answer
from lube.calculator.arguments import amount, check_realisations, checked, one_name
from lube.calculator.bands import Assumptions
from lube.calculator.choices import FORMULA, REALISATIONS, SEED, Choices, Inlet
from lube.calculator.contact import ensemble
from lube.calculator.film import conditions, conditions_of, film_in_si, of_film, with_remarks
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.contact.ensemble import sample_size
from lube.contact.surface_strip import SURFACES, surface_contact
from lube.contact.windows import ContactWindows
from lube.errors import StudyError, right_one, shown
from lube.grid.discretise import speed_ratios
from lube.grid.gap import Gap
from lube.grid.operating_points import surface_speeds
from lube.inference import planning
from lube.rig.readings import READINGS, charged_capacitance, mean_shares
from lube.rig.simulator import Revolution
from lube.study.rig_settings import PRESETS, RIG_REALISATIONS, Experiment, KnownRig, Rig
from lube.study.uncertainty import CHOICES
from lube.surfaces.synthetic import draw_realisation

THRESHOLD = "100 ohm"
"""Resistance below which a rig shows contact, by default."""


@checked
def plan(
    rollers: Rollers,
    oil: Oil,
    force: types.Amount,
    speed: types.Amount,
    temperature: types.Amount,
    *,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel = "line",
    turns: float | Sequence[float] = 1.0,
    rig: KnownRig | None = None,
    threshold: types.Amount | None = None,
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Expect how well a record of the contact share tells film, oil and layer.

    Ask before you measure: at which operating points, and how long. A record comes from one pair of
    rollers, whose share differs from the mean over pairs. By default it is a record of lines; the
    surfaces of rollers touch far more often.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, inlet_shear_heating, inlet_meniscus
        As in `lube.film`.
    film_formula, film_shape, roughness_deformation, load_sharing, slide_to_roll_ratio
        As in `lube.contact_probability`; one film formula.
    realisations, seed
        As in `lube.contact_probability`. Realisations are those of lines.
    contact_model : str, optional
        ``"line"``; or ``"surface"``, as in `lube.contact_probability`, which takes a minute.
    turns : float or sequence of float, optional
        Length of the record, revolutions of the roller with the faster surface. Longer records of
        equal rollers in pure rolling tell no more than one revolution.
    rig : str, optional
        A known rig, such as ``"mtm-ecr"``, whose error in reading the share of a revolution is
        added. By default the share is read exactly. The rig runs with lines, so its error of
        surfaces follows from theirs.
    threshold : str, sequence of str or tuple, optional
        Resistance below which that rig shows contact, by default 100 ohm. An ECR meter shows the
        mean voltage, which depends on no threshold.
    bands : bool or dict, optional
        Whether quantities that are not known exactly widen the intervals; ranges are as in
        `lube.contact_probability`, but choices of the model do not count. The film is inferred
        without knowing oil, temperature and speed, the coefficient and the layer's strength without
        their own ranges. It takes up to three times as long as there.

    Returns
    -------
    Answer
        The variables of `lube.film`; ``breakthrough_probability`` by importance sampling;
        ``half_width``, the half-width of the expected interval of each ``quantity`` relative to the
        quantity, NaN where the record tells less than a factor of two, or where it is not known to
        a third how the probability changes with the quantity; and ``reading_error``. They have the
        dimensions turns and threshold if several are given. With `bands` also
        ``half_width_assumed``, the half-width if the other quantities are uncertain.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that the lines cannot be sampled.

    Examples
    --------
    >>> rollers = Rollers(radius="50 mm", rms_roughness="0.2 um")
    >>> oil = Oil("mobilgear-shc-xmp-320")
    >>> found = plan(rollers, oil, "800 N", "100 rpm", "60 degC", realisations=16)
    >>> bool(found.half_width.sel(quantity="film thickness") < 0.1)
    True
    """
    turns = amount("turns", (turns, "1"), "1", above=0.0)
    if rig is None and threshold is not None:
        raise StudyError(f"threshold: got {shown(threshold)} without a rig, need rig, too")
    thresholds = amount("threshold", threshold or THRESHOLD, "ohm", above=0.0)
    model = one_name("contact_model", contact_model)
    models = [model] if rig is None else list(dict.fromkeys((model, "line")))
    _check_ridges(rig, model, rollers)
    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, models)
    one_name("film_formula", film_formula)
    slip = choices.slip
    check_realisations(realisations, seed)
    assumed = Assumptions(bands, rollers, oil, choices, seed, CHOICES)
    assumed.check(conditions(force, speed, temperature, rollers.pair.first.radius))
    table = film_in_si(rollers, oil, force, speed, temperature, choices)
    reading = _reading_error(rollers, table, gap, slip, rig, thresholds.values, seed)
    records, pair = turns.values.ravel().tolist(), rollers.rough_pair(seed, gap)
    if model == "surface":
        contact = surface_contact(pair, table)
        found, size, ratio, curve = planning.on_surfaces(pair, table, contact, slip, records)
        reading, realisations = planning.reading_of_surfaces(reading, found.probability), SURFACES
    else:
        found, size, ratio, curve = _on_lines(pair, table, realisations, slip, records)
    error = planning.relative_error(
        found.probability, size, ratio[:, None], np.hypot(reading, curve)
    )
    by_coefficient = _film_by_coefficient(oil, rollers, table, choices)
    widths = {}
    for name, deviation in _unknown(assumed, conditions_of(table, choices), table).items():
        both = np.hypot(error.reshape(-1, size.size), deviation)
        widths[name] = planning.half_widths(found, by_coefficient, both, realisations)
    answer = _labelled(table, turns, thresholds, found.probability, widths, reading)
    return with_remarks(answer, table, rollers, [model])


def _unknown(assumed, points, table):
    """Find the standard deviation of ln P by all that is not known, by the name of half-widths.

    That of assumptions has the shape (quantities, 1, P).
    """
    found, dims = {"half_width": 0.0}, table["film_thickness"].dims
    if assumed.wanted:
        each = assumed.log_deviations(points, planning.GIVEN.values())
        each = [one.broadcast_like(table["film_thickness"]).transpose(*dims) for one in each]
        found["half_width_assumed"] = np.reshape(each, (len(each), 1, -1))
    return found


def _check_ridges(rig, model, rollers):
    """Refuse a rig whose readings of the surfaces would follow from lines that do not exist."""
    if rig and model == "surface" and not rollers.lines.follows_rolling:
        raise StudyError(
            f"rig: got {rig!r} with ridges for which no line stands, need none: how a rig misreads "
            "surfaces follows from lines"
        )


def _on_lines(pair, table, realisations, slip, turns):
    """As `planning.on_surfaces`, of lines."""
    contact = ensemble(pair, table, realisations, slip)
    slower, width = min(speed_ratios(slip)), 2.0 * table["contact_half_width"]
    windows = pair.spec.independent_windows(width, slower)
    size = sample_size(contact["breakthrough_probability"], windows).ravel()
    found = planning.slopes(pair, table)
    # The scatter between the realisations includes the error of the curve.
    return found, size, planning.line_ratios(pair, table, slip, turns), 0.0


def _film_by_coefficient(oil, rollers, table, choices):
    """Slope of the film over the pressure-viscosity coefficient, at each operating point."""
    # Published factors of heating do not depend on the coefficient. Computed ones change the slope
    # by 2 to 3 %, which is left out.
    slope = planning.film_by_coefficient(
        oil.at(table["temperature"]),
        rollers.pair,
        table["force"],
        table["speed"],
        choices.film_formula,
        inlet_meniscus=choices.inlet.meniscus,
    )
    return slope.transpose(*table["film_thickness"].dims).values.ravel()


def _labelled(table, turns, thresholds, probability, widths, reading):
    """Film, probability, half-widths and reading error over their dimensions."""
    film = table["film_thickness"]
    answer = of_film(table).assign_coords(quantity=list(planning.QUANTITIES))
    answer = answer.assign_coords(turns.coords).assign_coords(thresholds.coords)
    answer["breakthrough_probability"] = film.dims, probability.reshape(film.shape)
    dims, shape = (*thresholds.dims, *film.dims), (*thresholds.shape, *film.shape)
    for name, each in widths.items():
        each = each.reshape(len(planning.QUANTITIES), *turns.shape, *shape)
        answer[name] = ("quantity", *turns.dims, *dims), each
    answer["reading_error"] = dims, reading.reshape(shape)
    return answer


def _reading_error(rollers, table, gap, slip, rig, thresholds, seed):
    """Relative error of the share that a known rig reads of another pair, in one revolution.

    Shape (thresholds, points).
    """
    film = table["film_thickness"]
    if rig is None:
        return np.zeros((thresholds.size, film.size))
    if rig not in PRESETS:
        raise StudyError(f"rig: got {rig!r}, {right_one(rig, PRESETS)}")
    levels, place = np.unique(thresholds, return_inverse=True)
    given = {"values": levels.tolist(), "units": "ohm"}
    experiment = Experiment(thresholds=given, threshold=f"{levels.item(0)!r} ohm")
    known, spec = Rig(preset=rig), rollers.lines
    if np.isnan(rollers.resistivity):
        raise StudyError(
            f"rig: got {rig!r} with rollers that do not conduct, need none: they show no "
            "resistance that a rig could read"
        )
    windows = ContactWindows(spec, table, rollers.layer, gap)
    traces = windows.trace(draw_realisation(spec, seed, RIG_REALISATIONS), slip)
    settings = rollers.layer.critical_thickness, rollers.pair.length, known.oil_permittivity
    capacitance = charged_capacitance(table, windows.gaps(spec), *settings).values.ravel()
    steps = spec.spacing / np.maximum(*surface_speeds(table["entrainment_speed"], slip))
    steps = steps.broadcast_like(film).transpose(*film.dims).values.ravel()
    resistance = rollers.resistivity / spec.spacing
    errors = np.full((thresholds.size, len(traces)), np.nan)
    for number, (contact, step, one) in enumerate(zip(traces, steps, capacitance, strict=True)):
        revolution = Revolution(contact, step, resistance, one, (seed, 0))
        shares, by_threshold = mean_shares(revolution, experiment, known)
        read = dict(zip(READINGS, shares, strict=True)) | {"threshold": by_threshold[place.ravel()]}
        if true := np.count_nonzero(contact) / contact.size:
            errors[:, number] = np.abs(read[PRESETS[rig].reading] / true - 1.0)
    # Where the simulated rig does not touch, it reads as well as on average.
    seen = np.isfinite(errors)
    mean = errors.sum(axis=1, where=seen, keepdims=True) / np.maximum(seen.sum(axis=1)[:, None], 1)
    return np.where(seen, errors, mean)
