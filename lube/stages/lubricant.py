"""Lubricant stage: from records and temperatures to a table of lubricant properties.

Inside this module temperatures are in kelvin and viscosities in SI units; the laws of
`lube.physics.viscosity` want mm2/s. The dataset's temperatures are in degC.
"""

import math

import numpy as np
import xarray as xr

from lube.errors import RangeError, RecordError
from lube.physics.coolprop_fluids import (
    initial_pressure_viscosity,
    liquid_property,
    liquid_range,
    secant_pressure_viscosity,
)
from lube.physics.viscosity import (
    PARAMETER_UNITS,
    VISCOSITY_LAWS,
    ZERO_CELSIUS,
    gold_pressure_viscosity,
    linear_density,
    viscosity_index,
)
from lube.schema import FILES, label
from lube.study.lubricant_record import check_temperatures

MM2_PER_S = 1e-6
"""One mm2/s in m2/s."""

# Temperatures at which a CoolProp fluid is sampled, to have data that the laws are fitted to.
_SAMPLES = 25

# Half the step of the central difference in temperature, K: its error is below 1e-6 of the
# result, and CoolProp's digits suffice.
_DIFFERENCE_STEP = 0.05


class _MeasuredOil:
    """Properties of a record with measured viscosities, between which a law leads."""

    def __init__(self, record):
        self._record = record
        points = record.viscosity.points
        self.data_temperature = np.array([point.temperature for point in points]) + ZERO_CELSIUS
        self.data_viscosity = np.array([self._kinematic(point) for point in points])
        self._law = VISCOSITY_LAWS[record.law_used]
        self._parameters = self._law.fit(self.data_temperature, self.data_viscosity / MM2_PER_S)

    def _kinematic(self, point):
        if point.kinematic_viscosity is not None:
            return point.kinematic_viscosity
        return point.dynamic_viscosity / self.density(point.temperature + ZERO_CELSIUS)

    def density(self, temperature):
        density = self._record.density
        return linear_density(temperature, density.at_15_degC, density.thermal_coefficient)

    def kinematic_viscosity(self, temperature):
        return self._law.evaluate(temperature, *self._parameters) * MM2_PER_S

    def pressure_viscosity_coefficient(self, temperature):
        section = self._record.pressure_viscosity
        if section.gold_base is None:
            return np.full(np.shape(temperature), section.value)
        viscosity = self.kinematic_viscosity(temperature) / MM2_PER_S
        return gold_pressure_viscosity(viscosity, section.gold_base)

    def thermal_conductivity(self, temperature):
        return np.full(np.shape(temperature), self._record.thermal_conductivity.value)

    def neighbours(self, temperature):
        """Temperatures just below and above, for differences: the law leads beyond its ends."""
        return temperature - _DIFFERENCE_STEP, temperature + _DIFFERENCE_STEP


class _CoolPropFluid:
    """Properties of a record that names a CoolProp fluid, at atmospheric pressure."""

    def __init__(self, record):
        self._fluid = record.viscosity.coolprop_fluid
        self._pressure_viscosity = record.pressure_viscosity
        lowest, highest = record.valid_temperatures
        self.data_temperature = np.linspace(lowest, highest, _SAMPLES) + ZERO_CELSIUS
        self.data_viscosity = self.kinematic_viscosity(self.data_temperature)

    def density(self, temperature):
        return liquid_property(self._fluid, "density", temperature)

    def kinematic_viscosity(self, temperature):
        dynamic = liquid_property(self._fluid, "viscosity", temperature)
        return dynamic / self.density(temperature)

    def pressure_viscosity_coefficient(self, temperature):
        if self._pressure_viscosity.definition == "secant":
            pressure = self._pressure_viscosity.pressure
            return secant_pressure_viscosity(self._fluid, temperature, pressure)
        return initial_pressure_viscosity(self._fluid, temperature)

    def thermal_conductivity(self, temperature):
        return liquid_property(self._fluid, "conductivity", temperature)

    def neighbours(self, temperature):
        """Temperatures just below and above, for differences, within the liquid's limits."""
        below, above = temperature - _DIFFERENCE_STEP, temperature + _DIFFERENCE_STEP
        lowest, highest = liquid_range(self._fluid)
        return np.clip(below, lowest, highest), np.clip(above, lowest, highest)


def lubricant_table(records, temperature):
    """Properties of lubricants at the temperatures of a study.

    Parameters
    ----------
    records : sequence of LubricantRecord
        The lubricants, each name once.
    temperature : array_like of float, shape (n,)
        Temperatures of the study, degC.

    Returns
    -------
    xarray.Dataset
        The variables of ``FILES["lubricant"]``. Beside the properties by each record's own
        law it holds the fits of all laws: parameters, relative residuals on the data, and
        curves over whole degrees, nan outside a record's range. The laws of a CoolProp
        fluid are fitted to samples of it and give no property. Parameters that a law does
        not have, data points that a record does not have, fits that a law refuses and
        viscosity indices of thin liquids are nan.

    Raises
    ------
    RangeError
        If a temperature lies outside a record's range, or a law or CoolProp has no
        viscosity there.
    RecordError
        If a name is repeated or a CoolProp fluid cannot be used.
    """
    temperature = np.array(temperature, dtype=float)
    names = [record.name for record in records]
    if len(set(names)) < len(names):
        raise RecordError(f"lubricants: got the names {', '.join(names)}, need each once")
    fit_temperature = _whole_degrees(records)
    rows = [_checked_row(record, temperature, fit_temperature) for record in records]
    columns = {name: _stacked([row[name] for row in rows]) for name in rows[0]}
    schema = FILES["lubricant"]
    dataset = xr.Dataset(
        {name: (schema[name].dims, column) for name, column in columns.items()}
        | {
            "parameter_units": ("parameter", list(PARAMETER_UNITS.values())),
            "law_source": ("viscosity_law", [law.source for law in VISCOSITY_LAWS.values()]),
        },
        coords={
            "lubricant": names,
            "temperature": temperature,
            "viscosity_law": list(VISCOSITY_LAWS),
            "parameter": list(PARAMETER_UNITS),
            "fit_temperature": fit_temperature,
        },
    )
    return label(dataset, "lubricant")


def _whole_degrees(records):
    """Whole degrees Celsius over the ranges of all records."""
    ranges = [record.valid_temperatures for record in records]
    lowest = math.floor(min(low for low, _ in ranges))
    highest = math.ceil(max(high for _, high in ranges))
    return np.arange(lowest, highest + 1, dtype=float)


def _stacked(rows):
    """One array of the rows of all lubricants, the last axis padded with nan where short."""
    rows = [np.asarray(row) for row in rows]
    if rows[0].ndim == 0:
        return np.array(rows)
    longest = max(row.shape[-1] for row in rows)
    return np.stack([_padded(row, longest) for row in rows])


def _padded(row, length):
    widths = [(0, 0)] * (row.ndim - 1) + [(0, length - row.shape[-1])]
    return np.pad(row, widths, constant_values=np.nan)


def _checked_row(record, temperature, fit_temperature):
    """Values of one lubricant by variable, without the dimension lubricant."""
    check_temperatures(record, temperature)
    try:
        fluid = _CoolPropFluid if record.law_used == "coolprop" else _MeasuredOil
        substance = fluid(record)
        properties = _properties(substance, temperature + ZERO_CELSIUS)
        index = _viscosity_index(record, substance)
    except (RangeError, RecordError) as error:
        raise type(error)(f"{record.name}: {error}") from None
    return {
        **properties,
        **_fits(record, substance, fit_temperature),
        "viscosity_index": index,
        "viscosity_law_used": record.law_used,
        "pressure_viscosity_definition": record.pressure_viscosity.definition_text,
        "lubricant_title": record.title,
    }


def _properties(substance, temperature):
    """Properties at the temperatures of the study, in K."""
    kinematic_viscosity = substance.kinematic_viscosity(temperature)
    wrong = ~(np.isfinite(kinematic_viscosity) & (kinematic_viscosity > 0.0))
    if wrong.any():
        raise RangeError(
            f"the viscosity law gives {kinematic_viscosity[wrong][0]:g} m2/s at "
            f"{temperature[wrong][0] - ZERO_CELSIUS:g} degC, need a positive viscosity; "
            "narrow temperature_range"
        )
    density = substance.density(temperature)
    return {
        "kinematic_viscosity": kinematic_viscosity,
        "density": density,
        "dynamic_viscosity": kinematic_viscosity * density,
        "pressure_viscosity_coefficient": substance.pressure_viscosity_coefficient(temperature),
        "thermal_conductivity": substance.thermal_conductivity(temperature),
        "temperature_viscosity_coefficient": _relative_fall(substance, temperature),
    }


def _relative_fall(substance, temperature):
    """Relative fall of dynamic viscosity with temperature, beta = -d ln(eta)/dT, 1/K."""
    below, above = substance.neighbours(temperature)
    log_below, log_above = (
        np.log(substance.kinematic_viscosity(side) * substance.density(side))
        for side in (below, above)
    )
    return (log_below - log_above) / (above - below)


def _viscosity_index(record, substance):
    """Viscosity index, nan where a record does not reach 40 and 100 degC or is too thin."""
    try:
        check_temperatures(record, (40.0, 100.0))
        at_40_and_100 = np.array([40.0, 100.0]) + ZERO_CELSIUS
        return viscosity_index(*substance.kinematic_viscosity(at_40_and_100) / MM2_PER_S)
    except RangeError:
        return math.nan


def _fits(record, substance, fit_temperature):
    """Parameters, curve and residuals of every law on the data of one lubricant."""
    lowest, highest = record.valid_temperatures
    inside = (lowest <= fit_temperature) & (fit_temperature <= highest)
    curve_temperature = np.where(inside, fit_temperature + ZERO_CELSIUS, np.nan)
    data = substance.data_viscosity
    fits = [
        _fit(law, substance.data_temperature, data, curve_temperature)
        for law in VISCOSITY_LAWS.values()
    ]
    parameters, curves, fitted = (np.array(column) for column in zip(*fits, strict=True))
    return {
        "fit_parameter": parameters,
        "fitted_kinematic_viscosity": np.where(np.isfinite(curves), curves, np.nan),
        "data_temperature": substance.data_temperature - ZERO_CELSIUS,
        "data_kinematic_viscosity": data,
        "fit_residual": fitted / data - 1.0,
    }


def _fit(law, data_temperature, data_viscosity, curve_temperature):
    """Parameters by name, curve and fitted data of one law; nan where it refuses the data."""
    try:
        parameters = law.fit(data_temperature, data_viscosity / MM2_PER_S)
    except RangeError:
        parameters = (math.nan,) * len(law.parameters)
    named = dict(zip(law.parameters, parameters, strict=True))
    return (
        [named.get(name, math.nan) for name in PARAMETER_UNITS],
        law.evaluate(curve_temperature, *parameters) * MM2_PER_S,
        law.evaluate(data_temperature, *parameters) * MM2_PER_S,
    )
