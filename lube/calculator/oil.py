"""The oil of an answer, from a lubricant record or from numbers with units."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer, described
from lube.calculator.arguments import amount, checked, in_words
from lube.errors import LubeError, RecordError, located, shown
from lube.physics.pressure_viscosity import FORMULA_DEFINITION, GOLD_BASES
from lube.study.field_types import validate
from lube.study.lubricant_record import LubricantRecord, TemperatureRange, base_oil, load_record
from lube.study.oil_properties import lubricant_table
from lube.study.viscosity_checks import check_points
from lube.study.viscosity_points import read_viscosity_csv
from lube.types import Amount, File, OneAmount
from lube.units import parse_quantity

_SOURCE = "assumed: given in Python"


class Oil:
    """An oil, from a lubricant record or from numbers.

    Quantities are given as text, such as ``"870 kg/m^3"``, as ``(870, "kg/m^3")`` or by pint.

    Parameters
    ----------
    name : str or Path, optional
        Name of a shipped lubricant record (`lube.stages.shipped_records`), or path of a YAML file.
    viscosity : dict or str, optional
        Without a record: viscosities, kinematic or dynamic, at two temperatures or more, such as
        ``{"40 degC": "320 mm^2/s", "100 degC": "38 mm^2/s"}``; or the path of a CSV file with the
        columns ``temperature [degC]`` and ``kinematic_viscosity [mm^2/s]``.
    density : str, optional
        Without a record: at 15 degC, by default 870 kg/m^3.
    base : str, optional
        Without a record: base oil, for the pressure-viscosity coefficient by Gold's form:
        ``mineral`` (by default), ``polyalphaolefin`` or ``PAO``, ``ester``, ``polyglycol`` or
        ``PAG``.
    pressure_viscosity : str, optional
        Without a record: pressure-viscosity coefficient such as ``"18 1/GPa"``, the slope at
        atmospheric pressure, in place of the base oil's.
    thermal_conductivity : str, optional
        Without a record: for the heating at the inlet, by default 0.14 W/(m K), as of mineral oils.
    temperature_range : sequence of str or tuple, optional
        Lowest and highest temperature at which the oil may be used, such as
        ``["20 degC", "120 degC"]``; by default those of its data. Beyond the data the viscosity is
        extrapolated by the oil's viscosity law.

    Attributes
    ----------
    record : LubricantRecord
        The lubricant record.

    Raises
    ------
    RecordError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> oil = Oil(viscosity={"40 degC": "320 mm^2/s", "100 degC": "38 mm^2/s"}, base="mineral")
    >>> f"{oil.properties('60 degC').dynamic_viscosity.item():.0f} mPa s"
    '114 mPa s'
    """

    @checked
    def __init__(
        self,
        name: File | None = None,
        *,
        viscosity: Mapping[str, OneAmount] | File | None = None,
        density: OneAmount | None = None,
        base: str | None = None,
        pressure_viscosity: OneAmount | None = None,
        thermal_conductivity: OneAmount | None = None,
        temperature_range: Amount | None = None,
    ) -> None:
        if (name is None) == (viscosity is None):
            came = "neither" if name is None else "both"
            needed = "need either the name of a lubricant record or viscosity={...}"
            raise RecordError(f"Oil: got {came}, {needed}")
        own = {
            "density": density,
            "base": base,
            "pressure_viscosity": pressure_viscosity,
            "thermal_conductivity": thermal_conductivity,
        }
        if None not in (base, pressure_viscosity):
            came = f"got {shown(base)} together with pressure_viscosity"
            raise RecordError(f"Oil: base: {came}, which it would give, need only one of the two")
        if name is None:
            self.record = _record(in_words(viscosity), **in_words(own))
        else:
            needed = "together with a lubricant record, which sets it, need only one of the two"
            for key, value in own.items():
                if value is not None:
                    raise RecordError(f"Oil: {key}: got {shown(value)} {needed}")
            with located("Oil: name"):
                self.record = load_record(name)
        if temperature_range is not None:
            levels = amount("temperature_range", temperature_range, "degC").values.ravel().tolist()
            if len(levels) != 2:
                came = f"got {shown(temperature_range)}, need the lowest and the highest"
                raise RecordError(f"Oil: temperature_range: {came}")
            ends = {"lowest": f"{levels[0]!r} degC", "highest": f"{levels[-1]!r} degC"}
            ends["source"] = _SOURCE
            valid = validate(TemperatureRange, ends, "Oil: temperature_range", RecordError)
            self.record = self.record.model_copy(update={"temperature_range": valid})

    def properties(self, temperature: Amount) -> Answer:
        """Viscosity, density and pressure-viscosity coefficient at some temperatures.

        Parameters
        ----------
        temperature : str, sequence of str or tuple
            Such as ``"60 degC"`` or ``(range(40, 101, 10), "degC")``.

        Returns
        -------
        Answer
            In customary units, over temperature if there are several.

        Raises
        ------
        RangeError
            If the lubricant record is not valid at a temperature.
        """
        degrees = amount("temperature", temperature, "degC")
        table = self.at(degrees)
        names = [name for name, values in table.items() if {*values.dims} <= {*degrees.dims}]
        return described(table[names])

    def at(self, temperature: xr.DataArray) -> xr.Dataset:
        """Properties in SI units, at temperatures in degC over any dimensions."""
        table = lubricant_table([self.record], np.unique(temperature.values))
        return table.isel(lubricant=0).sel(temperature=temperature).drop_attrs()

    def __repr__(self) -> str:
        lowest, highest = self.record.valid_temperatures
        return f"<Oil: {self.record.title}, valid from {lowest:g} to {highest:g} degC>"


def _record(viscosity, density, base, pressure_viscosity, thermal_conductivity):
    """Lubricant record for given viscosities."""
    base = base_oil(base or "mineral")
    if base not in list(GOLD_BASES):
        raise RecordError(f"Oil: base: got {shown(base)}, need one of {', '.join(GOLD_BASES)}")
    alpha = {"source": _SOURCE, "gold_base": base}
    if pressure_viscosity is not None:
        alpha = {"source": _SOURCE, "value": pressure_viscosity, "definition": FORMULA_DEFINITION}
    density = {"at_15_degC": density or "870 kg/m^3", "thermal_coefficient": "6.4e-4 1/K"}
    content = {
        "name": "oil",
        "title": "Oil of given viscosity",
        "viscosity": {"source": _SOURCE, "points": _points(viscosity)},
        "density": density | {"source": _SOURCE},
        "pressure_viscosity": alpha,
        "thermal_conductivity": {"source": _SOURCE, "value": thermal_conductivity or "0.14 W/m/K"},
    }
    record = validate(LubricantRecord, content, "Oil", RecordError)
    check_points(record, "Oil")
    return record


def _points(viscosity):
    # A text may also be a viscosity without its temperature.
    if isinstance(viscosity, str | Path):
        path = Path(viscosity)
        if path.suffix == ".csv" or path.is_file():
            return read_viscosity_csv(viscosity)
    if not isinstance(viscosity, Mapping):
        raise RecordError(
            f"Oil: viscosity: got {shown(viscosity)}, need viscosities by temperature, such as "
            "{'40 degC': '320 mm^2/s', '100 degC': '38 mm^2/s'}, or a CSV file"
        )
    return [{"temperature": level, _kind(value): value} for level, value in viscosity.items()]


def _kind(viscosity):
    """Whether a viscosity is kinematic or dynamic, by its unit."""
    try:
        parse_quantity(viscosity, "Pa*s")
    except LubeError:
        return "kinematic_viscosity"
    return "dynamic_viscosity"
