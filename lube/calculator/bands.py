"""The band of an answer over quantities that are not known exactly."""

from collections.abc import Mapping
from dataclasses import asdict

import numpy as np
import xarray as xr

from lube.calculator.arguments import Choices, conditions
from lube.calculator.parts import Oil, Rollers
from lube.errors import StudyError, shown
from lube.schema import POINT_DIMS
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.predictor import BAND, is_chosen
from lube.sensitivity.runs import models, run
from lube.sensitivity.samples import deviations, quantiles
from lube.study.field_types import validate
from lube.study.operating_grid import OperatingGrid
from lube.study.study import Study
from lube.study.uncertainty import Uncertainty

SAMPLES = {"line": 128, "surface": 32}
"""Numbers of samples by contact model, powers of 2; surfaces take long to draw."""
RANGES = {
    "viscosity": {"range": "+- 10 %", "source": "ISO 3448, limits of a viscosity grade"},
    "pressure_viscosity_coefficient": {"range": "+- 20 %", "source": "assumed"},
    "temperature": {"range": "+- 1 K", "source": "assumed"},
    "force": {"range": "+- 1 %", "source": "assumed"},
    "speed": {"range": "+- 1 %", "source": "assumed"},
    "young_modulus": {"range": "+- 3 %", "source": "assumed, bearing and gear steels"},
    "first_rms_roughness": {"range": "+- 10 %", "source": "assumed"},
    "second_rms_roughness": {"range": "+- 10 %", "source": "assumed"},
    "longest_wavelength": {"range": "-50 % to 0 %", "source": "assumed"},
    "shortest_wavelength": {"range": "-20 % to 100 %", "source": "assumed"},
    "critical_thickness": {"range": "-80 % to 0 %", "source": "assumed, a layer of 1 to 5 nm"},
    "shear_strength": {"range": "+- 50 %", "source": "assumed"},
}
"""Ranges of an answer if none are given, in the form of a study's section ``uncertainty``."""


def assumed_limits(
    rollers: Rollers,
    oil: Oil,
    given: tuple,
    choices: Choices,
    bands: bool | Mapping,
    film_formula: str,
    slip: float,
    seed: int,
) -> dict[str, xr.DataArray]:
    """Find the band of the probability of breakthrough over what is not known exactly.

    It is over `RANGES`, which are of quantities: the choices of the model are those of the answer
    unless `bands` has them.

    Parameters
    ----------
    rollers, oil
        As in `lube.contact_probability`.
    given : tuple
        Its force, speed and temperature.
    choices : Choices
        Model; of several contact models the first.
    bands : bool or mapping
        True for `RANGES`, or ranges in the form of a study's section ``uncertainty``.
    film_formula, slip, seed
        As in `lube.contact_probability`.

    Returns
    -------
    dict of str to xarray.DataArray
        ``assumed_breakthrough_probability_lower`` and ``_upper``, below which 5 and 95 % of
        `SAMPLES` samples lie; NaN where a film is not known.

    Raises
    ------
    StudyError
        Which range, what came, what is needed.
    """
    if not isinstance(bands, bool | Mapping):
        raise StudyError(f"bands: got {shown(bands)}, need True, False or a dict of ranges")
    ranges = RANGES if bands is True else dict(bands)
    uncertain = validate(Uncertainty, ranges, "bands", StudyError)
    levels = conditions(*given, rollers.pair.first.radius)
    force, speed, temperature = xr.broadcast(*levels)
    names = {"force": force, "speed": speed, "temperature": temperature}
    study = _study(rollers, oil, names, choices, film_formula, slip, seed, uncertain)
    deviating = Deviating.of(study, "bands")
    points = xr.Dataset({name: ("point", values.values.ravel()) for name, values in names.items()})
    points["lubricant"] = "point", np.full(points.sizes["point"], oil.record.name)
    unit = quantiles(SAMPLES[choices.models[0]], len(deviating.factors), seed)
    found = _probabilities(deviating, unit, points[list(POINT_DIMS)])
    limits = np.quantile(found, BAND, axis=0)
    return {
        f"assumed_breakthrough_probability_{end}": force.copy(data=limit.reshape(force.shape))
        for end, limit in zip(("lower", "upper"), limits, strict=True)
    }


def _study(rollers, oil, conditions_, choices, film_formula, slip, seed, uncertain):
    """Study of the answer, as far as `lube.sensitivity` needs it."""
    levels = {name: tuple(np.unique(values).tolist()) for name, values in conditions_.items()}
    return Study.model_construct(
        lubricants=(oil.record,),
        rollers=rollers.given_pair,
        roughness=rollers.roughness,
        boundary_layer=rollers.layer,
        film_formulas=(film_formula,),
        operating_grid=OperatingGrid.model_construct(**levels, slide_to_roll_ratio=(slip,)),
        **asdict(choices.gap),
        load_sharing=choices.load_sharing,
        contact_model=choices.models,
        seed=seed,
        uncertainty=uncertain,
    )


def _probabilities(deviating, unit, points):
    """Probability of breakthrough of all samples at some points, shape (samples, points)."""
    number = points.sizes["point"]
    samples = np.repeat(unit, number, axis=0)
    runs = points.isel(point=np.tile(np.arange(number), len(unit))).rename(point="run")
    values, found = deviations(deviating.factors, samples), np.full(len(samples), np.nan)
    for model in models(deviating):
        some = np.flatnonzero(is_chosen(deviating, model, values, len(samples)))
        if some.size:
            table = run(deviating, model, samples[some], runs.isel(run=some))
            # Without a value where the layer holds in all contacts that were sampled.
            probability = table["breakthrough_probability"].fillna(0.0).mean("seed")
            probability = probability.where(table["film_thickness"].notnull())
            found[some] = probability.values
    return found.reshape(len(unit), number)
