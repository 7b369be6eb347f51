"""The band of an answer over quantities that are not known exactly."""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from lube.calculator.choices import Choices
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.errors import StudyError, located, shown
from lube.schema import LIMITS, POINT_DIMS
from lube.study.field_types import validate
from lube.study.operating_grid import OperatingGrid
from lube.study.study import Study
from lube.study.uncertainty import BAND, Uncertainty, check_uncertainty
from lube.types import Array, Values

SAMPLES = {"line": 128, "surface": 32}
"""Numbers of samples by contact model, powers of 2; surfaces take long to draw."""
RANGES = pd.read_csv(Path(__file__).with_name("ranges.csv"), index_col="name").to_dict("index")
"""Ranges of an answer if none are given, in the form of a study's section ``uncertainty``."""


class Assumptions:
    """What an answer does not know exactly, and the probability of breakthrough over it.

    It is over `RANGES`, which are of quantities: the choices of the model are those of the answer
    unless `bands` has them.

    Parameters
    ----------
    bands : bool or mapping
        True for `RANGES`, or ranges in the form of a study's section ``uncertainty``; False for no
        band.
    rollers, oil
        As in `lube.contact_probability`.
    choices : Choices
        Model; of several contact models, or film formulas, the first.
    seed
        As in `lube.contact_probability`.
    left_out : sequence of str, optional
        Factors, or groups of them, on which the answer does not depend: their ranges are ignored.

    Attributes
    ----------
    wanted : bool
        Whether there is a band.
    rollers, choices, seed
        As given.

    Raises
    ------
    StudyError
        Which range, what came, what is needed.
    """

    def __init__(
        self,
        bands: bool | Mapping,
        rollers: Rollers,
        oil: Oil,
        choices: Choices,
        seed: int,
        left_out: Sequence[str] = (),
    ) -> None:
        if not isinstance(bands, bool | Mapping):
            raise StudyError(f"bands: got {shown(bands)}, need True, False or a dict of ranges")
        self.wanted = bands is not False
        self.rollers, self.choices, self.seed = rollers, choices, seed
        ranges = _usual_ranges(rollers) if bands is True else dict(bands or {})
        uncertain = validate(Uncertainty, ranges, "bands", StudyError)
        if uncertain.resistivity:
            came = "resistivity: got a range, on which no probability depends"
            raise StudyError(f"bands: {came}, need none")
        uncertain = _without(uncertain, left_out)
        if self.wanted and not uncertain.factors():
            needed = "need an uncertain quantity or choice on which the answer depends"
            raise StudyError(f"bands: got {' and '.join(ranges) or 'none'}, {needed}")
        # The study of the answer, as far as `lube.sensitivity` needs it.
        self._study = Study.model_construct(
            lubricants=(oil.record,),
            rollers=rollers.given_pair,
            roughness=rollers.roughness,
            boundary_layer=rollers.layer,
            film_formulas=tuple(np.ravel(choices.film_formula).tolist()[:1]),
            **asdict(choices.gap),
            load_sharing=choices.load_sharing,
            inlet_shear_heating=choices.inlet.shear_heating,
            inlet_meniscus=choices.inlet.meniscus or "none",
            contact_model=choices.models,
            seed=seed,
            uncertainty=uncertain,
        )

    def study(self, levels: Mapping[str, Array]) -> Study:
        """Study of the answer with some levels of force, speed and temperature."""
        grid = {name: tuple(np.unique(levels[name]).tolist()) for name in POINT_DIMS[1:]}
        grid = OperatingGrid.model_construct(**grid, slide_to_roll_ratio=(0.0,))
        return self._study.model_copy(update={"operating_grid": grid})

    def check(self, points: Mapping[str, Values]) -> None:
        """Refuse ranges for which the model has no answer at some operating points.

        Parameters
        ----------
        points : mapping
            As in `probabilities`.

        Raises
        ------
        LubeError
            As from `lube.study.uncertainty.check_uncertainty`.
        """
        if self.wanted:
            with located("bands"):
                check_uncertainty(self.study(points))

    def probabilities(self, points: Mapping[str, Values]) -> xr.DataArray:
        """Find the probability of breakthrough of all samples at some operating points.

        All points have the same samples.

        Parameters
        ----------
        points : mapping of str to xarray.DataArray
            ``force``, N, ``speed``, rpm, and ``temperature``, degC, over any dimensions, and what
            else `lube.sensitivity.conditions.Deviating.films` takes.

        Returns
        -------
        xarray.DataArray
            Of `SAMPLES` samples over sample and the dimensions of the points; NaN where a film is
            not known.
        """
        # These are slow to import.
        from lube.sensitivity.conditions import Deviating
        from lube.sensitivity.runs import run_all
        from lube.sensitivity.samples import quantiles

        points = dict(zip(points, xr.broadcast(*map(xr.DataArray, points.values())), strict=True))
        study, force = self.study(points), points["force"]
        deviating = Deviating.of(study, "bands")
        runs = xr.Dataset({name: ("point", each.values.ravel()) for name, each in points.items()})
        runs["lubricant"] = "point", np.full(force.size, study.lubricants[0].name)
        count = SAMPLES[study.contact_model[0]]
        unit = quantiles(count, len(deviating.factors), study.seed)
        found = run_all(deviating, unit, runs).reshape(count, *force.shape)
        return force.expand_dims(sample=count).copy(data=found)

    def log_deviations(
        self, points: Mapping[str, Values], left_out: Sequence[Sequence[str]]
    ) -> list[xr.DataArray]:
        """Find the standard deviation of the logarithm of the probability over all samples.

        Parameters
        ----------
        points : mapping
            As in `probabilities`.
        left_out : sequence of sequence of str
            For each result the factors, or groups of them, that are taken as known.

        Returns
        -------
        list of xarray.DataArray
            Over the dimensions of the points. 0 if nothing else is uncertain, NaN where a film of a
            sample is not known or never touches.
        """
        some = [_without(self._study.uncertainty, known) for known in left_out]
        names = [tuple(factor.name for factor in one.factors()) for one in some]
        distinct = dict(zip(names, some, strict=True))
        found = {key: self._log_deviation(points, one) for key, one in distinct.items()}
        return [found[key] for key in names]

    def _log_deviation(self, points, uncertain):
        if not uncertain.factors():
            return xr.zeros_like(xr.broadcast(*map(xr.DataArray, points.values()))[0])
        other = copy(self)
        other._study = self._study.model_copy(update={"uncertainty": uncertain})
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log(other.probabilities(points)).std("sample", skipna=False)

    @staticmethod
    def limits(samples: xr.DataArray, name: str) -> dict[str, xr.DataArray]:
        """Name the limits below which 5 and 95 % of some samples lie."""
        from lube.sensitivity.predictor import BAND

        limits = zip(LIMITS[1:], np.quantile(samples, BAND, axis=0), strict=True)
        return {f"{name}{end}": samples[0].copy(data=limit) for end, limit in limits}


def _usual_ranges(rollers):
    """Those of `RANGES` that both rollers' lines have: measured spectra have no other band."""
    known = [] if all(line.hurst_exponent for line in rollers.lines.lines) else BAND
    return {name: one for name, one in RANGES.items() if name not in known}


def _without(uncertain, left_out):
    """Ranges without those of some factors, or groups of them."""
    gone = (one.name for one in uncertain.factors() if {one.name, one.group} & set(left_out))
    return uncertain.model_copy(update=dict.fromkeys(gone))
