"""Properties of oils: from lubricant records and temperatures to a table.

Inside this module temperatures are in kelvin and viscosities in SI units, while the viscosity laws,
the viscosity index and Gold's form take mm2/s. The temperatures of the dataset are in degC.
"""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from lube.errors import RangeError, located
from lube.physics import ZERO_CELSIUS, coolprop_fluids
from lube.physics.pressure_viscosity import (
    fit_mcewen,
    gold_pressure_viscosity,
    mcewen_coefficient,
    mcewen_log_ratio,
    roelands_slope,
)
from lube.physics.viscosity_index import viscosity_index
from lube.physics.viscosity_laws import PARAMETER_UNITS, VISCOSITY_LAWS
from lube.schema import label
from lube.study.lubricant_record import LubricantRecord

MM2_PER_S = 1e-6
"""One mm2/s in m2/s."""

PER_GPA = 1e-9
"""One 1/GPa in 1/Pa."""

# Number of temperatures at which a CoolProp fluid is sampled, as data for the fits of all laws.
_SAMPLES = 25

# Half the step of the central difference in temperature, K: its error is below 1e-6 of the
# result, and CoolProp's digits suffice.
_DIFFERENCE_STEP = 0.05


class _MeasuredOil:
    """Properties of a lubricant record with measured viscosities, interpolated by a law."""

    def __init__(self, record):
        self._record, self.density = record, record.density_at
        temperature, self.data_viscosity = np.transpose(record.data)
        self.data_temperature = temperature + ZERO_CELSIUS
        self._law = VISCOSITY_LAWS[record.law_used]
        self._parameters = self._law.fit(self.data_temperature, self.data_viscosity / MM2_PER_S)
        # The law also holds a little outside the range of the data.
        self.temperature_limits = -np.inf, np.inf
        self._coefficients, self.pressure_fit_residual = _measured_coefficients(record)

    def kinematic_viscosity(self, temperature):
        return self._law.evaluate(temperature, *self._parameters) * MM2_PER_S

    def stated_coefficient(self, temperature):
        base = self._record.pressure_viscosity.gold_base
        if base is None:
            return _interpolated(temperature - ZERO_CELSIUS, self._coefficients)
        return gold_pressure_viscosity(self.kinematic_viscosity(temperature) / MM2_PER_S, base)

    def thermal_conductivity(self, temperature):
        section = self._record.thermal_conductivity
        return np.full(np.shape(temperature), np.nan if section is None else section.value)


def _measured_coefficients(record):
    """Coefficients by temperature in degC, and the residual of the fits under pressure if any."""
    section, residuals = record.pressure_viscosity, []
    if section.value is not None:
        return {0.0: section.value * PER_GPA}, math.nan
    if section.points is not None:
        return {point.temperature: point.value * PER_GPA for point in section.points}, math.nan
    found = {}
    for temperature, pairs in record.isotherms.items():
        pressure, ratio = np.array(pairs).T
        fit = fit_mcewen(pressure, ratio)
        residuals += list(abs(np.exp(mcewen_log_ratio(pressure, *fit)) / ratio - 1.0))
        found[temperature] = mcewen_coefficient(*fit, section.definition, section.span)
    return found, max(residuals, default=math.nan)


def _interpolated(temperature, coefficients):
    """Interpolate coefficients: their logarithm is linear in temperature, also beyond the data.

    A single coefficient is the same at all temperatures.
    """
    known = np.array(sorted(coefficients))
    logarithms = np.log([coefficients[each] for each in known])
    if known.size == 1:
        return np.full(np.shape(temperature), coefficients[known[0]])
    after = np.clip(np.searchsorted(known, temperature), 1, known.size - 1)
    slopes = np.diff(logarithms) / np.diff(known)
    return np.exp(logarithms[after] + slopes[after - 1] * (temperature - known[after]))


class _CoolPropFluid:
    """Properties of a lubricant record that names a CoolProp fluid, at atmospheric pressure."""

    pressure_fit_residual = math.nan

    def __init__(self, record):
        self._fluid = record.viscosity.coolprop_fluid
        self._pressure_viscosity = record.pressure_viscosity
        lowest, highest = record.valid_temperatures
        self.data_temperature = np.linspace(lowest, highest, _SAMPLES) + ZERO_CELSIUS
        self.data_viscosity = self.kinematic_viscosity(self.data_temperature)
        self.temperature_limits = coolprop_fluids.liquid_range(self._fluid)

    def density(self, temperature):
        return coolprop_fluids.liquid_property(self._fluid, "density", temperature)

    def kinematic_viscosity(self, temperature):
        dynamic = coolprop_fluids.liquid_property(self._fluid, "viscosity", temperature)
        return dynamic / self.density(temperature)

    def stated_coefficient(self, temperature):
        if self._pressure_viscosity.definition == "secant":
            pressure = self._pressure_viscosity.pressure
            return coolprop_fluids.secant_pressure_viscosity(self._fluid, temperature, pressure)
        return coolprop_fluids.initial_pressure_viscosity(self._fluid, temperature)

    def thermal_conductivity(self, temperature):
        return coolprop_fluids.liquid_property(self._fluid, "conductivity", temperature)


def lubricant_table(records: Sequence[LubricantRecord], temperature: npt.ArrayLike) -> xr.Dataset:
    """Tabulate the properties of lubricants at the temperatures of a study.

    Parameters
    ----------
    records : sequence of LubricantRecord
        Lubricant records with distinct names.
    temperature : array_like of float, shape (n,)
        Temperatures of the study, degC.

    Returns
    -------
    xarray.Dataset
        The ``lubricant`` file of `lube.schema`. The properties follow from the law that the
        lubricant record names. For comparison all viscosity laws are fitted to the data as
        well: parameters, relative residuals, and curves at whole degrees within the record's
        temperature range. The data of a CoolProp fluid are samples of it, and its properties
        come from CoolProp itself. Pressure-viscosity coefficients by a definition other than that
        of the film formulas are converted by Roelands' law. If there are viscosities under
        pressure, the coefficients follow by McEwen's law, fitted at each temperature. Values that
        do not exist are NaN: parameters that a law does not have, data points that a lubricant
        does not have, fits that a law does not allow, the viscosity index of a thin liquid, the
        residual of a fit under pressure where there is none, and a thermal conductivity that is
        not given.

    Raises
    ------
    RangeError
        If a temperature lies outside the range of a lubricant record, or a law or CoolProp has
        no viscosity there.
    RecordError
        If a CoolProp fluid cannot be used.
    DataError
        If a name is repeated.

    Examples
    --------
    >>> from lube.stages import load_record
    >>> table = lubricant_table([load_record("mobilgear-shc-xmp-320")], [40.0, 80.0])
    >>> [f"{viscosity:.4f} Pa s" for viscosity in table.dynamic_viscosity.values[0]]
    ['0.2835 Pa s', '0.0564 Pa s']
    """
    temperature = np.array(temperature, dtype=float)
    names = [record.name for record in records]
    lowest, highest = zip(*(record.valid_temperatures for record in records), strict=True)
    fit_temperature = np.arange(math.floor(min(lowest)), math.ceil(max(highest)) + 1.0)
    rows = [_row(record, temperature, fit_temperature) for record in records]
    # Lubricants have different numbers of data points; NaN stands for the missing ones.
    table = xr.concat(rows, xr.Variable("lubricant", names), join="outer").drop_vars("data_point")
    table["parameter_units"] = "parameter", list(PARAMETER_UNITS.values())
    table["law_source"] = "viscosity_law", [law.source for law in VISCOSITY_LAWS.values()]
    levels = {"temperature": temperature, "fit_temperature": fit_temperature, "lubricant": names}
    laws = {"viscosity_law": list(VISCOSITY_LAWS), "parameter": list(PARAMETER_UNITS)}
    return label(table.assign_coords(levels | laws), "lubricant")


def _row(record, temperature, fit_temperature):
    """Variables of one lubricant."""
    record.check_temperatures(temperature)
    with located(record.name):
        substance = (_CoolPropFluid if record.law_used == "coolprop" else _MeasuredOil)(record)
        properties = _properties(record, substance, temperature + ZERO_CELSIUS)
        index = _viscosity_index(record, substance)
    row = xr.Dataset({name: ("temperature", values) for name, values in properties.items()})
    return row.merge(_fits(record, substance, fit_temperature)).assign(
        viscosity_index=index,
        viscosity_law_used=record.law_used,
        pressure_fit_residual=substance.pressure_fit_residual,
        pressure_viscosity_definition=record.pressure_viscosity.definition_text,
    )


def _properties(record, substance, temperature):
    """Properties at the temperatures of the study, in K."""
    viscosity, density = substance.kinematic_viscosity(temperature), substance.density(temperature)
    wrong = ~(np.isfinite(viscosity) & (viscosity > 0.0))
    if wrong.any():
        first, at = viscosity[wrong][0], temperature[wrong][0] - ZERO_CELSIUS
        came = f"the viscosity law gives {first:g} m2/s at {at:g} degC"
        raise RangeError(f"{came}, need a positive viscosity; narrow temperature_range")
    dynamic, stated = viscosity * density, substance.stated_coefficient(temperature)
    if (thins := stated <= 0.0).any():  # cold water does
        first, at = stated[thins][0] / PER_GPA, temperature[thins][0] - ZERO_CELSIUS
        came = f"got a pressure-viscosity coefficient of {first:.3g} 1/GPa at {at:g} degC"
        raise RangeError(f"{came}, need one above 0; narrow temperature_range")
    return {
        "kinematic_viscosity": viscosity,
        "density": density,
        "dynamic_viscosity": dynamic,
        "pressure_viscosity_coefficient": _for_formulas(record.pressure_viscosity, stated, dynamic),
        "stated_pressure_viscosity_coefficient": stated,
        "thermal_conductivity": substance.thermal_conductivity(temperature),
        "temperature_viscosity_coefficient": _temperature_viscosity(substance, temperature),
    }


def _for_formulas(section, stated, dynamic_viscosity):
    """Convert coefficients to the definition of the film formulas; Gold's form needs no change."""
    if section.definition is None:
        return stated
    pairs = zip(stated, dynamic_viscosity, strict=True)
    return np.array([roelands_slope(*pair, section.definition, section.span) for pair in pairs])


def _temperature_viscosity(substance, temperature):
    """Temperature-viscosity coefficient beta = -d ln(eta)/dT, 1/K, by a central difference."""
    steps = np.array([[-_DIFFERENCE_STEP], [_DIFFERENCE_STEP]])
    sides = np.clip(temperature + steps, *substance.temperature_limits)
    below, above = (np.log(substance.kinematic_viscosity(t) * substance.density(t)) for t in sides)
    return (below - above) / (sides[1] - sides[0])


def _viscosity_index(record, substance):
    """Viscosity index; NaN for thin liquids, and if 40 or 100 degC is beyond data and range."""
    at_40_and_100, measured = np.array([40.0, 100.0]) + ZERO_CELSIUS, substance.data_temperature
    try:
        if at_40_and_100[0] < measured.min() or measured.max() < at_40_and_100[1]:
            record.check_temperatures((40.0, 100.0))
        return viscosity_index(*substance.kinematic_viscosity(at_40_and_100) / MM2_PER_S)
    except RangeError:
        return math.nan


def _fits(record, substance, fit_temperature):
    """Parameters, curve and residuals of every law, fitted to the data of one lubricant."""
    lowest, highest = record.valid_temperatures
    inside = (lowest <= fit_temperature) & (fit_temperature <= highest)
    curve_temperature = np.where(inside, fit_temperature + ZERO_CELSIUS, np.nan)
    data = substance.data_viscosity
    fits = [_fit(law, substance, curve_temperature) for law in VISCOSITY_LAWS.values()]
    parameters, curves, fitted = (np.array(column) for column in zip(*fits, strict=True))
    curves = np.where(np.isfinite(curves), curves, np.nan)
    return xr.Dataset(
        {
            "fit_parameter": (("viscosity_law", "parameter"), parameters),
            "fitted_kinematic_viscosity": (("viscosity_law", "fit_temperature"), curves),
            "data_temperature": ("data_point", substance.data_temperature - ZERO_CELSIUS),
            "data_kinematic_viscosity": ("data_point", data),
            "fit_residual": (("viscosity_law", "data_point"), fitted / data - 1.0),
        },
        coords={"data_point": np.arange(data.size)},
    )


def _fit(law, substance, curve_temperature):
    """Parameters by name, curve and fitted data of one law; NaN where the law allows no fit."""
    try:
        parameters = law.fit(substance.data_temperature, substance.data_viscosity / MM2_PER_S)
    except RangeError:
        parameters = (math.nan,) * len(law.parameters)
    named = dict(zip(law.parameters, parameters, strict=True))
    temperatures = curve_temperature, substance.data_temperature
    row = [named.get(name, math.nan) for name in PARAMETER_UNITS]
    return row, *(law.evaluate(t, *parameters) * MM2_PER_S for t in temperatures)
