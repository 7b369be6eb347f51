"""The plan stage: what a record at each operating point would tell, and what else to measure."""

import numpy as np
import xarray as xr

from lube.contact.ensemble import sample_size, windows_by_force
from lube.grid.discretise import speed_ratios
from lube.grid.film_profiles import six_digits
from lube.grid.levels import rolling
from lube.grid.operating_points import at_slip
from lube.inference import planning
from lube.schema import POINT_DIMS, label
from lube.sensitivity.findings import LEFT, narrowing
from lube.sensitivity.samples import SEED
from lube.statistics.one_pair import scatter_ratio
from lube.study.rig_settings import OWN_RIG
from lube.study.study import Study
from lube.study.uncertainty import CHOICES
from lube.types import Datasets

TURNS = (0.1, 0.3, 1.0, 10.0)
"""Durations of records, in revolutions."""
_GIVEN = {
    "film thickness": ("oil", "temperature", "speed"),
    "pressure-viscosity coefficient": ("pressure_viscosity_coefficient",),
    "layer strength": ("layer",),
}
"""Uncertain quantities, and groups of them, of which each inference does without."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``plan.nc``; see `lube.stages`.

    All values are for the first film formula and the slide-to-roll ratio nearest to pure rolling,
    and for records of one pair of rollers with the study's rig. Probabilities, slopes and scatter
    are those of the line.
    """
    slip = rolling(study.slips)
    film = at_slip(inputs["film"], slip).isel(film_formula=0, drop=True).transpose(*POINT_DIMS, ...)
    sizes = [film.sizes[name] for name in POINT_DIMS]
    choices = study.boundary_layer, study.gap, study.seed, threads
    found = planning.slopes(study.line_spec, film, *choices)
    threshold, reading = _reading(inputs["electrical"], study)
    point = inputs["lubricant"], study.rough_rollers, film["force"], film["speed"]
    by_coefficient = planning.film_by_coefficient(
        *point, study.film_formulas[0], slide_to_roll_ratio=slip, **study.inlet_model
    )
    by_coefficient = by_coefficient.transpose(*POINT_DIMS).values.ravel()
    table = {
        "breakthrough_probability": found.probability,
        "slope_by_film": found.by_film,
        "slope_by_layer": found.by_layer,
        "film_by_coefficient": by_coefficient,
        "reading_error": reading,
    }
    table = {name: (POINT_DIMS, _digits(each.reshape(sizes))) for name, each in table.items()}
    size = _sample_size(inputs["contact"], inputs["film"], slip)
    ratios = [_ratio(study, slip, turns) for turns in TURNS]
    errors = [planning.relative_error(found.probability, size, ratio, reading) for ratio in ratios]
    unknown = {"half_width": 0.0}
    if "sensitivity" in inputs:
        unknown["half_width_assumed"] = _assumed(inputs["sensitivity"])[:, None]
    for name, others in unknown.items():
        error, realisations = np.hypot(errors, others), inputs["contact"].sizes["realisation"]
        widths = planning.half_widths(found, by_coefficient, error, realisations)
        widths = _digits(widths.reshape(len(planning.QUANTITIES), len(TURNS), *sizes))
        table[name] = ("quantity", "turns", *POINT_DIMS), widths
    coordinates = {name: film[name].values for name in POINT_DIMS}
    coordinates |= {"quantity": list(planning.QUANTITIES), "turns": list(TURNS)}
    dataset = xr.Dataset(table | {"best_threshold": threshold}, coordinates)
    if "sensitivity" in inputs:
        factors = inputs["sensitivity"]["factor"].values.tolist()
        if names := [name for name in factors if name not in (*CHOICES, SEED)]:
            dataset = dataset.merge(_to_measure(study, inputs["sensitivity"], names), join="exact")
    return label(dataset, "plan")


def _sample_size(contact, film, slip):
    """Effective sample size of a realisation, from the scatter between them."""
    contact = contact.isel(film_formula=0, drop=True)
    windows = windows_by_force(contact, film).sel(slide_to_roll_ratio=slip, drop=True)
    shares = contact["breakthrough_probability"].sel(slide_to_roll_ratio=slip, drop=True)
    return sample_size(shares.transpose("realisation", *POINT_DIMS), windows).ravel()


def _digits(values):
    """Round to six digits; NaN where a slope or an interval is infinite."""
    return six_digits(np.where(np.isfinite(values), values, np.nan))


def _ratio(study, slip, turns):
    """Variance of a record's share over that of a revolution, if new alignments do not help."""
    spec = study.line_spec
    reach = spec.longest_wavelength / spec.spacing
    known = speed_ratios(slip), spec.points, reach, 1.0, study.rig.drift
    # A realisation may be several revolutions long.
    return scatter_ratio(turns, *known) / scatter_ratio(study.revolutions, *known)


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


def _assumed(sensitivity):
    """Return the standard deviation of ln P by all that each inference must know."""
    total = sensitivity["log_probability_deviation"].transpose(*POINT_DIMS)
    parts = sensitivity["first_order"].clip(0.0, 1.0)
    each = zip(parts["factor"].values, sensitivity["group_of_factor"].values, strict=True)
    groups, found = dict(each), []
    for quantity in planning.QUANTITIES:
        given = {*_GIVEN[quantity], *CHOICES, SEED}
        unknown = [name for name, group in groups.items() if not {name, group} & given]
        part = parts.sel(factor=unknown).sum("factor").clip(0.0, 1.0)
        found.append((total * np.sqrt(part)).transpose(*POINT_DIMS).values.ravel())
    return np.array(found)


def _to_measure(study, sensitivity, names):
    """Which uncertain quantity narrows the band most, and how well to measure it."""
    narrower = narrowing(sensitivity, names).transpose("factor", *POINT_DIMS).drop_attrs()
    found = xr.Dataset({"narrowing": narrower.copy(data=_digits(narrower.values))})
    given = [getattr(study.uncertainty, name) for name in names]
    found["range_of_factor"] = "factor", [one.in_words for one in given]
    found["accuracy_of_factor"] = "factor", [one.within(LEFT**0.5) for one in given]
    return found
