"""The verification stage: the study's methods against theory, other methods and print."""

import logging

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.grid.films import FilmGroups, hertz_contact
from lube.schema import label, values_with_limits, with_dims
from lube.statistics.confidence import mean_interval
from lube.study.study import Study
from lube.types import Datasets
from lube.verification import films, lines, surfaces
from lube.verification.check import CHECKS

log = logging.getLogger(__name__)

_TEXTS = "subject", "against", "kind", "unit", "source"


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``verification.nc``; see `lube.stages`.

    The checks are made with the study's lines, layer, rollers and oils. Its film has the shape and
    its roughness the deformation of the paper, flat and none.
    """
    lubricant, found, waves = inputs["lubricant"], lines.curves(study, threads), films.response()
    seen = lines.line_checks(study, found, threads) | lines.scaled_checks(study, lubricant)
    seen |= surfaces.surface_checks(study, threads) if study.line_spec.is_isotropic else {}
    seen |= films.film_checks(_contact(study, lubricant), waves)
    on_others = lines.on_grids(study, threads)
    values = _outcomes(seen) | _curves(found) | _on_grids(on_others)
    values |= {
        "response": six_digits(waves),
        "printed_response": list(films.VENNER.values()),
        "check": np.arange(1, len(seen) + 1),
        "lambda_ratio": lines.LAMBDA_RATIOS,
        "grid": list(on_others),
        "grid_lambda_ratio": lines.LAMBDA_RATIOS[lines.FEW],
        "response_wavelength": list(films.VENNER),
    }
    return label(xr.Dataset(with_dims("verification", values)), "verification")


def _contact(study, lubricant):
    """Line contact at the middle of the study's levels."""
    grid, rollers = study.operating_grid, study.rough_rollers
    force, speed = (sorted(levels)[len(levels) // 2] for levels in (grid.force, grid.speed))
    oil = lubricant.isel(lubricant=0, temperature=lubricant.sizes["temperature"] // 2)
    contact = hertz_contact(rollers, force, speed)
    meniscus = study.inlet_model["inlet_meniscus"]
    return FilmGroups.at(oil, rollers, force, contact, meniscus).profiles.item().contact


def _outcomes(deviations):
    rows, seen = CHECKS.loc[list(deviations)], np.array(list(deviations.values()))
    values = {f"check_{name}": rows[name].tolist() for name in _TEXTS}
    allowed = rows["allowed"].to_numpy()
    outcomes = np.where(seen <= allowed, "agrees", "differs")
    outcomes = np.where(np.isnan(allowed), "not judged", outcomes)
    for number in np.flatnonzero(outcomes == "differs"):
        one = rows.iloc[number]
        both, off = f"{one['subject']}, and {one['against']}", f"{seen[number]:.2g} {one['unit']}"
        log.warning(
            "check %d: %s, differ by %s; up to %g passes", number + 1, both, off, one["allowed"]
        )
    judged = {"check_deviation": six_digits(seen), "check_allowed": allowed}
    return values | judged | {"check_outcome": outcomes}


def _curves(found):
    values = {"touching_bound": six_digits(found.bound)}
    for way in ("counted", "sampled"):
        for number, name in enumerate(lines.COUNTED):
            limits = map(six_digits, mean_interval(getattr(found, way)[..., number], 1.0))
            values |= values_with_limits(f"{way}_{name}", limits)
    return values


def _on_grids(found):
    """Ratios to the study's own probabilities; all grids have the same random numbers."""
    of_pairs = np.stack(list(found.values()), axis=1)
    own = of_pairs[:, :1]  # of the study's grid, which is the first
    ratio = of_pairs.mean(axis=0) / own.mean(axis=0)
    scatter = (of_pairs - ratio * own).std(axis=0, ddof=1) / np.sqrt(len(own))
    error = 1.96 * scatter / own.mean(axis=0)
    ends, values = (ratio, ratio - error, ratio + error), {}
    for number, name in enumerate(lines.COUNTED):
        limits = (six_digits(each[..., number]) for each in ends)
        values |= values_with_limits(f"{name}_ratio", limits)
    return values
