"""Films, lines and boundary layers of a study whose uncertain quantities deviate."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.fft
import xarray as xr

from lube.errors import located
from lube.grid.film_profiles import scaled_film
from lube.grid.films import film_at
from lube.grid.levels import rolling
from lube.physics.pressure_viscosity import roelands_slope
from lube.schema import POINT_DIMS
from lube.sensitivity.heights import equivalent_ratio
from lube.study.line_spec import LineSpec
from lube.study.oil_properties import lubricant_table
from lube.study.rollers import BoundaryLayer, Roller
from lube.study.study import Study
from lube.study.uncertainty import Factor, check_uncertainty, deviating_heights, deviating_lines
from lube.types import Array

OIL = (
    "dynamic_viscosity pressure_viscosity_coefficient temperature_viscosity_coefficient "
    "thermal_conductivity"
).split()
GIVEN = "film_thickness", "roughness_factor"
"""What operating points may state themselves, in place of a film found from the oil."""
GAUSSIAN = {"skewness": 0.0, "kurtosis": 3.0}
"""Moments of Gaussian heights."""
NODES = 500
"""Temperatures between which properties of the oils are interpolated: to some 1e-6."""
SECANT = 200e6
"""Pressure to which a secant goes if the definition of the coefficient is not known, Pa."""
TRAVEL = 100.0
"""Length of a drawn line over its longest wavelength: more contact windows than are sampled."""


@dataclass(frozen=True)
class DeviatingRollers:
    """Rollers as far as films depend on them, with a modulus and a roughness for each run.

    Attributes
    ----------
    first : lube.study.rollers.Roller
        The first roller.
    length : float
        As of `lube.study.rollers.RollerPair`.
    reduced_radius, reduced_modulus, composite_rms_roughness : float or xarray.DataArray
        As of `RollerPair`.
    """

    first: Roller
    length: float
    reduced_radius: float | xr.DataArray
    reduced_modulus: float | xr.DataArray
    composite_rms_roughness: float | xr.DataArray


@dataclass(frozen=True)
class Deviating:
    """A study whose uncertain quantities deviate.

    Attributes
    ----------
    study : Study
        The study.
    oils : xarray.Dataset
        Logarithms of the properties of its lubricants over a range of temperatures; also of the
        slope over the pressure-viscosity coefficient, by definition of the latter.
    heights : callable or None
        From `lube.sensitivity.heights.equivalent_ratio`; None if all heights are Gaussian.
    """

    study: Study
    oils: xr.Dataset
    heights: Callable | None

    @classmethod
    def of(
        cls, study: Study, named: str = "uncertainty", temperatures: Iterable[float] = ()
    ) -> "Deviating":
        """Tabulate the oils over the temperatures that occur, and the heights.

        The oils are tabulated as far as their data reach.

        Parameters
        ----------
        study : Study
            The study.
        named : str, optional
            Name of its ranges in messages.
        temperatures : iterable of float, optional
            Temperatures that occur besides those of the study's operating points, degC.

        Raises
        ------
        LubeError
            As from `lube.study.uncertainty.check_uncertainty`.
        """
        with located(named):
            check_uncertainty(study)
        levels = *study.operating_grid.temperature, *temperatures
        uncertain = study.uncertainty.temperature
        lower, upper = uncertain.ends if uncertain else (0.0, 0.0)
        ranges = [record.valid_temperatures for record in study.lubricants]
        coldest = max(min(levels) + lower, *(one[0] for one in ranges))
        hottest = min(max(levels) + upper, *(one[1] for one in ranges))
        # At a single temperature over a kelvin, as far as the data reach.
        hottest = min(max(hottest, coldest + 1.0), *(one[1] for one in ranges))
        temperature = np.linspace(min(coldest, hottest - 1.0), hottest, NODES)
        table = lubricant_table(study.lubricants, temperature)[OIL].drop_attrs()
        if definitions := study.uncertainty.pressure_viscosity_definition:
            slopes = [_slope_ratio(table, each) for each in definitions.choices]
            table["slope_ratio"] = xr.concat(slopes, "definition")
        return cls(study, np.log(table), _heights(study))

    def choices(self, name: str, own: str) -> tuple[str, ...]:
        """Return the choices of a factor, or the study's own if it is not uncertain."""
        given = getattr(self.study.uncertainty, name)
        return given.choices if given else (own,)

    @property
    def levels(self) -> dict[str, list]:
        """Levels of the study's operating points: lubricant, temperature, speed and force."""
        grid = self.study.operating_grid
        names = {"lubricant": [record.name for record in self.study.lubricants]}
        return names | {name: list(getattr(grid, name)) for name in POINT_DIMS[1:]}

    @property
    def factors(self) -> list[Factor]:
        """Factors of the study."""
        return self.study.uncertainty.factors()

    @property
    def formulas(self) -> tuple[str, ...]:
        """Film formulas that the study leaves open."""
        return self.choices("film_formula", self.study.film_formulas[0])

    def films(self, values: dict, points: xr.Dataset, **shape) -> list[tuple[Array, xr.Dataset]]:
        """Compute the films of some samples at some operating points.

        Parameters
        ----------
        values : dict of str to xarray.DataArray
            From `lube.sensitivity.samples.deviations`, over run, at least one.
        points : xarray.Dataset
            ``lubricant``, ``temperature``, ``speed`` and ``force``, over run too, or over point;
            also ``radius`` and ``second_radius``, m, and ``slide_to_roll_ratio`` if they are not
            the study's. A ``film_thickness``, m, takes the place of the oil's. The oils'
            viscosities are multiplied by a ``viscosity_factor``. With a ``roughness_factor`` on all
            heights films are over that factor.
        **shape
            Further arguments of `lube.grid.films.film_at`.

        Returns
        -------
        list of tuple
            For each film formula and model of inlet heating the numbers of the runs that choose
            both, and their films as from `film_at`. Without a model of heating its factor is 1.
            Where a run chooses the computed film, and no shape is asked for, the film of Moes'
            formula stands in for it.
        """
        heating = self.choices("inlet_shear_heating", self.study.inlet_shear_heating)
        count = next(iter(values.values())).sizes["run"]
        names = "film_formula", "inlet_shear_heating"
        # What is not uncertain has one choice, the study's own.
        chosen = np.array([np.broadcast_to(values.get(name, 0), count) for name in names])
        found = []
        for pair in np.unique(chosen, axis=1).T:
            here = np.flatnonzero((chosen == pair[:, None]).all(axis=0))
            own = {name: value.isel(run=here) for name, value in values.items()}
            at = points.isel(run=here, missing_dims="ignore")
            film = self._film(own, at, self.formulas[pair[0]], heating[pair[1]], **shape)
            found.append((here, film))
        return found

    def _film(self, values, points, formula, heating, **shape):
        """Film of samples with the same film formula and model of inlet heating."""
        study, oil = self.study, self._oil(values, points)
        loads = points["force"] * (1.0 + values.get("force", 0.0))
        speeds = points["speed"] * (1.0 + values.get("speed", 0.0))
        rollers = self._rollers(values, points)
        formulas = [formula if shape else STAND_IN.get(formula, formula)]
        choices = study.inlet_model | {"inlet_shear_heating": heating} | shape
        choices["slide_to_roll_ratio"] = points.get("slide_to_roll_ratio", rolling(study.slips))
        table = film_at(oil, rollers, loads, speeds, formulas, **choices)
        viscosity = oil["dynamic_viscosity"]
        table = table.isel(film_formula=0, drop=True).assign(dynamic_viscosity=viscosity)
        if heating == "none":
            table["inlet_shear_heating_factor"] = xr.ones_like(table["moes_load"])
        table.update({name: points[name] for name in GIVEN if name in points})
        if "roughness_factor" in table:
            return scaled_film(
                table, 1.0 / table["roughness_factor"], shape.get("with_shape", False)
            )
        return table

    def _oil(self, values, points):
        """Properties of the oils at the temperatures of the samples."""
        # Beyond the data the logarithms go on in a straight line, over a few kelvin at most.
        beyond = {"fill_value": "extrapolate"}
        temperature = points["temperature"] + values.get("temperature", 0.0)
        oil = self.oils.interp(temperature=temperature, kwargs=beyond).drop_vars("temperature")
        oil = np.exp(oil.sel(lubricant=points["lubricant"]))
        for name, key in (("viscosity", OIL[0]), ("pressure_viscosity_coefficient", OIL[1])):
            oil[key] = oil[key] * (1.0 + values.get(name, 0.0))
        if "pressure_viscosity_definition" in values:
            chosen = oil["slope_ratio"].isel(definition=values["pressure_viscosity_definition"])
            oil = oil.drop_vars("slope_ratio").assign({OIL[1]: oil[OIL[1]] * chosen})
        oil[OIL[0]] = oil[OIL[0]] * points.get("viscosity_factor", 1.0)
        return oil

    def _rollers(self, values, points):
        """Return the rollers as far as films depend on them, with values for each run."""
        pair, scale = self.study.rollers, 1.0 + values.get("young_modulus", 0.0)
        if "radius" in points:
            pair = pair.with_radii(points["radius"], points["second_radius"])
        modulus, rms = pair.reduced_modulus * scale, self.rms_roughness(values)
        return DeviatingRollers(pair.first, pair.length, pair.reduced_radius, modulus, rms)

    def rms_roughness(self, values: dict):
        """Rms height of both lines together, m."""
        return np.sqrt(sum(rms**2 for rms in deviating_heights(self.study.line_spec, values)))

    def equivalent(self, ratio: xr.DataArray, values: dict) -> xr.DataArray:
        """Find the lambda ratio at which Gaussian heights touch as often as those of the samples.

        Parameters
        ----------
        ratio : xarray.DataArray
            Lambda ratio.
        values : dict of str to xarray.DataArray
            As for `films`.

        Returns
        -------
        xarray.DataArray
            The ratio; that of the film itself if the heights are Gaussian.
        """
        if self.heights is None:
            return ratio
        own = (xr.DataArray(values.get(name, known)) for name, known in GAUSSIAN.items())
        return xr.apply_ufunc(self.heights, *xr.broadcast(ratio, *own))

    def lines(self, values: dict[str, float]) -> LineSpec:
        """Parameters of the lines of one sample, no longer than needed."""
        spec = deviating_lines(self.study.line_spec, values)
        needed = math.ceil(TRAVEL * spec.longest_wavelength / spec.spacing)
        points = min(scipy.fft.next_fast_len(needed, real=True), *spec.points)
        lines = tuple(line.model_copy(update={"points": points}) for line in spec.lines)
        return spec.model_copy(update={"lines": lines})

    def layer(self, values: dict[str, float]) -> BoundaryLayer:
        """Boundary layer of one sample."""
        layer = self.study.boundary_layer
        names = "critical_thickness", "shear_strength"
        scaled = {name: getattr(layer, name) * (1.0 + values.get(name, 0.0)) for name in names}
        return layer.model_copy(update=scaled)


def _slope_ratio(oils, definition):
    """Slope at atmospheric pressure over the coefficient, if it is by some definition."""
    span = SECANT if definition == "secant" else None
    slope = partial(roelands_slope, definition=definition, span=span)
    return xr.apply_ufunc(np.vectorize(slope), oils[OIL[1]], oils[OIL[0]]) / oils[OIL[1]]


def _heights(study):
    """Table of lambda ratios for the heights of a study; None if they are Gaussian."""
    given = {name: getattr(study.uncertainty, name) for name in GAUSSIAN}
    if not any(given.values()):
        return None
    ends = (
        uncertain.ends if uncertain else (GAUSSIAN[name], GAUSSIAN[name] + 1e-6)
        for name, uncertain in given.items()
    )
    return equivalent_ratio(*ends, study.line_spec.rms_height)


FILM = (
    "film_thickness contact_half_width reduced_modulus moes_load moes_material dynamic_viscosity "
    "lambda_ratio"
).split()
"""Variables of films on which the probability depends."""
STAND_IN = {"computed": "moes"}
"""Film formulas that stand in for films that are too slow to compute."""


def joined(films: list[tuple[Array, xr.Dataset]]) -> xr.Dataset:
    """Join the variables `FILM` of films by `Deviating.films`, in the order of the runs."""
    tables = []
    for runs, film in films:
        # Films are the same in all runs if only lines, layer or choices of the model deviate.
        like, _ = xr.broadcast(film["film_thickness"], xr.DataArray(runs, dims="run"))
        tables.append(film[FILM].broadcast_like(like))
    table = xr.concat(tables, "run", coords="minimal", compat="override", join="exact")
    return table.isel(run=np.argsort(np.concatenate([runs for runs, _ in films])))
