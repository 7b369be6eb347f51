"""The plan stage: what a record at each operating point would tell, and what else to measure."""

import numpy as np
import xarray as xr

from lube.contact.ensemble import sample_size, windows_by_force
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import SURFACES
from lube.digits import six_digits
from lube.grid.film_responses import with_surface_responses
from lube.grid.levels import rolling
from lube.grid.operating_points import at_slip, over_contact_models
from lube.inference import planning
from lube.schema import POINT_DIMS, label, with_dims
from lube.sensitivity.findings import LEFT, narrowing
from lube.sensitivity.samples import SEED
from lube.study.rig_settings import OWN_RIG
from lube.study.study import Study
from lube.study.uncertainty import CHOICES
from lube.types import Datasets

TURNS = (0.1, 0.3, 1.0, 10.0)
"""Durations of records, in revolutions."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``plan.nc``; see `lube.stages`.

    All values are for the first film formula and the slide-to-roll ratio nearest to pure rolling,
    and for records of one pair of rollers with the study's rig. In a study of surfaces they are
    over contact_model. The rig runs with lines, or with surfaces; its error of the others follows
    from theirs.
    """
    slip = rolling(study.slips)
    film = at_slip(with_surface_responses(inputs), slip).isel(film_formula=0, drop=True)
    film = film.transpose(*POINT_DIMS, ...)
    threshold, readings = _readings(study, inputs, slip)
    by_coefficient = _by_coefficient(study, inputs["lubricant"], film, slip)
    coordinates = {name: film[name].values for name in POINT_DIMS}
    coordinates |= {"quantity": list(planning.QUANTITIES), "turns": list(TURNS)}
    sizes, tables = [film.sizes[name] for name in POINT_DIMS], {}
    for model in study.contact_model:
        of_model = _of_lines if model == "line" else _of_surfaces
        scatter = of_model(study, inputs, film, slip, readings[model], threads)
        unknown = {"half_width": 0.0}
        if "sensitivity" in inputs:
            unknown["half_width_assumed"] = _assumed(inputs["sensitivity"], study, model)
        found = _expected(scatter, by_coefficient, unknown).items()
        values = {name: _digits(each.reshape(*each.shape[:-1], *sizes)) for name, each in found}
        values["best_threshold"] = threshold
        tables[model] = xr.Dataset(with_dims("plan", values), coordinates)
    dataset = over_contact_models("plan", tables) if study.has_surfaces else tables["line"]
    if "sensitivity" in inputs:
        factors = inputs["sensitivity"]["factor"].values.tolist()
        if names := [name for name in factors if name not in (*CHOICES, SEED)]:
            dataset = dataset.merge(_to_measure(study, inputs["sensitivity"], names), join="exact")
    return label(dataset, "plan")


def _by_coefficient(study, lubricant, film, slip):
    """Slope of the film's logarithm over that of the pressure-viscosity coefficient, (P,)."""
    options = study.inlet_model | {"slide_to_roll_ratio": slip}
    rollers, formula = study.rough_rollers, study.film_formulas[0]
    found = planning.film_by_coefficient(
        lubricant, rollers, film["force"], film["speed"], formula, **options
    )
    return found.transpose(*POINT_DIMS).values.ravel()


def _expected(scatter, by_coefficient, unknown):
    """Slopes and half-widths of intervals at operating points, shape (..., P).

    `scatter` is from `_of_lines` or `_of_surfaces`. `unknown` has, by the name of half-widths, the
    standard deviation of ln P by all that is not known.
    """
    found, size, ratios, read, curve, ensemble = scatter
    values = {
        "breakthrough_probability": found.probability,
        "slope_by_film": found.by_film,
        "slope_by_layer": found.by_layer,
        "slope_by_film_error": found.film_error,
        "slope_by_layer_error": found.layer_error,
        "film_by_coefficient": by_coefficient,
        "reading_error": read,
    }
    own = np.hypot(read, curve)
    errors = [planning.relative_error(found.probability, size, one, own) for one in ratios]
    for name, deviation in unknown.items():
        error = np.hypot(errors, deviation)
        values[name] = planning.half_widths(found, by_coefficient, error, ensemble)
    return values


def _of_lines(study, inputs, film, slip, reading, threads):
    """Find slopes and sample size, variances of records, errors of reading and curve, realisations.

    The sample size is for one revolution, and the variances are divided by that of one revolution.
    The scatter between the realisations includes the error of the curve.
    """
    contact, pair = inputs["contact"], RoughPair.of(study)
    found = planning.slopes(pair, film, threads)
    size = _sample_size(contact, inputs["film"], slip)
    ratios = planning.line_ratios(pair, film, slip, TURNS, study.rig.drift, study.revolutions)
    return found, size, ratios, reading, 0.0, contact.sizes["realisation"]


def _of_surfaces(study, inputs, film, slip, reading, threads):
    """As `_of_lines`, of surfaces; the sample size is that of a revolution of pure rolling."""
    found, size, ratios, curve = planning.on_surfaces(
        RoughPair.of(study), film, _areal(inputs, slip), slip, TURNS, study.rig.drift, threads
    )
    return found, size, ratios, reading, curve, SURFACES


def _areal(inputs, slip):
    """Contact of surfaces under the first film formula."""
    return inputs["areal"].sel(slide_to_roll_ratio=slip, drop=True).isel(film_formula=0, drop=True)


def _sample_size(contact, film, slip):
    """Effective sample size of a realisation, from the scatter between them."""
    contact = contact.isel(film_formula=0, drop=True)
    windows = windows_by_force(contact, film).sel(slide_to_roll_ratio=slip, drop=True)
    shares = contact["breakthrough_probability"].sel(slide_to_roll_ratio=slip, drop=True)
    return sample_size(shares.transpose("realisation", *POINT_DIMS), windows).ravel()


def _digits(values):
    """Round to six digits; NaN where a slope or an interval is infinite."""
    return six_digits(np.where(np.isfinite(values), values, np.nan))


def _readings(study, inputs, slip):
    """Threshold as from `_reading`, and the relative errors there by contact model."""
    threshold, reading = _reading(inputs["electrical"], study)
    if not study.has_surfaces:
        return threshold, {"line": reading}
    share = _areal(inputs, slip)["breakthrough_probability"].transpose(*POINT_DIMS).values.ravel()
    if study.rig.has_surfaces:
        return threshold, {"line": planning.reading_of_lines(reading, share), "surface": reading}
    return threshold, {"line": reading, "surface": planning.reading_of_surfaces(reading, share)}


def _reading(electrical, study):
    """Threshold at which the study's rig reads the share best, and its relative errors there.

    The threshold is NaN for a meter that has none, and the study's own, without an error, if the
    simulated rig never touches.
    """
    true = electrical["true_contact_share"].transpose(*POINT_DIMS)
    read = electrical["threshold_contact_share"]
    if study.rig.reading != "threshold":
        read = electrical["read_contact_share"].sel(reading=[study.rig.reading])
        read = read.rename(reading="threshold").assign_coords(threshold=[np.nan])
    read = read.sel(rig=OWN_RIG, drop=True)
    off = np.abs(read / true.where(true > 0.0) - 1.0).transpose("threshold", *POINT_DIMS)
    mean = off.mean(POINT_DIMS).values
    if np.isnan(mean).all():
        return study.experiment.threshold, np.zeros(true.size)
    best = off.isel(threshold=int(np.argmin(mean)))
    # Where the simulated rig does not touch, it reads as well as on average.
    return best["threshold"].item(), best.fillna(best.mean()).values.ravel()


def _assumed(sensitivity, study, contact_model):
    """Return the standard deviation of ln P by all that each inference must know.

    NaN if the sensitivity study does not sample the contact model.
    """
    open_choices = study.uncertainty.contact_model
    if contact_model not in (open_choices.choices if open_choices else study.contact_model[:1]):
        return np.nan
    total = sensitivity["log_probability_deviation"].transpose(*POINT_DIMS)
    parts = sensitivity["first_order"].clip(0.0, 1.0)
    each = zip(parts["factor"].values, sensitivity["group_of_factor"].values, strict=True)
    groups, found = dict(each), []
    for known in planning.GIVEN.values():
        given = {*known, *CHOICES, SEED}
        unknown = [name for name, group in groups.items() if not {name, group} & given]
        part = parts.sel(factor=unknown).sum("factor").clip(0.0, 1.0)
        found.append((total * np.sqrt(part)).transpose(*POINT_DIMS).values.ravel())
    return np.array(found)[:, None]


def _to_measure(study, sensitivity, names):
    """Which uncertain quantity narrows the band most, and how well to measure it."""
    narrower = narrowing(sensitivity, names).transpose("factor", *POINT_DIMS).drop_attrs()
    found = xr.Dataset({"narrowing": narrower.copy(data=_digits(narrower.values))})
    given = [getattr(study.uncertainty, name) for name in names]
    found["range_of_factor"] = "factor", [one.in_words for one in given]
    found["accuracy_of_factor"] = "factor", [one.within(LEFT**0.5) for one in given]
    return found
