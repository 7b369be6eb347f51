"""Measured viscosities: one point, and CSV files of them."""

from typing import Annotated

from pydantic import model_validator

from lube.errors import RecordError, shown
from lube.physics import ZERO_CELSIUS
from lube.physics.coolprop_fluids import ATMOSPHERIC_PRESSURE
from lube.study.field_types import StrictModel, quantity, validate
from lube.study.small_csv import read_cells, units_of, with_points
from lube.types import File

# Pressure up to which a viscosity counts as one at atmospheric pressure, Pa. It changes a
# viscosity by less than 1 %, so it does not matter whether pressures are absolute.
_AMBIENT = 2.0 * ATMOSPHERIC_PRESSURE

OilTemperature = Annotated[float, quantity("degC", above=-ZERO_CELSIUS, most=1000.0)]


class ViscosityPoint(StrictModel):
    """Viscosity at one temperature, kinematic or dynamic or both."""

    temperature: OilTemperature
    """temperature of the value"""
    kinematic_viscosity: Annotated[float, quantity("m^2/s", above=0.0, most=1.0)] | None = None
    """kinematic viscosity; this or `dynamic_viscosity`, or both if they agree"""
    dynamic_viscosity: Annotated[float, quantity("Pa*s", above=0.0)] | None = None
    """dynamic viscosity"""
    pressure: Annotated[float, quantity("Pa", least=0.0, most=1e10)] | None = None
    """pressure of a dynamic viscosity, by default atmospheric"""

    @model_validator(mode="after")
    def _check_viscosity(self):
        if self.kinematic_viscosity is None and self.dynamic_viscosity is None:
            raise ValueError("got no viscosity, need kinematic_viscosity or dynamic_viscosity")
        if self.is_under_pressure and self.kinematic_viscosity is not None:
            at = f"at {self.pressure / 1e6:g} MPa"
            raise ValueError(f"got kinematic_viscosity {at}, need dynamic_viscosity")
        return self

    @property
    def is_under_pressure(self) -> bool:
        """Whether the pressure is above that of the atmosphere."""
        return self.pressure is not None and self.pressure > _AMBIENT


_COLUMNS = (
    "temperature [degC] and kinematic_viscosity [mm^2/s] or dynamic_viscosity [mPa*s] or both; "
    "under pressure also pressure [MPa]"
)


def read_viscosity_csv(path: File) -> tuple[ViscosityPoint, ...]:
    """Read measured viscosities against temperature, and against pressure if it was changed.

    The first line names the columns with their units: ``temperature [degC]``, then
    ``kinematic_viscosity [mm^2/s]`` or ``dynamic_viscosity [mPa*s]`` or both, and ``pressure
    [MPa]`` if there are viscosities under pressure, which are dynamic. Columns are separated by
    tabs, semicolons or commas; with tabs or semicolons, numbers may have decimal commas. Empty
    lines and lines that begin with ``#`` are ignored.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8 text.

    Returns
    -------
    tuple of ViscosityPoint
        One point per row.

    Raises
    ------
    RecordError
        Which line and column, what came, what is needed.
    """
    (header_line, header), *rows = read_cells(path, RecordError)
    columns = _csv_columns(header, f"{path}: line {header_line}")
    points, values = [], with_points(path, rows, len(columns), RecordError)
    for (number, _), cells in zip(rows, values, strict=True):
        pairs = zip(columns.items(), cells, strict=True)
        content = {name: f"{cell} {units}" for (name, units), cell in pairs if cell}
        points.append(validate(ViscosityPoint, content, f"{path}: line {number}", RecordError))
    return tuple(points)


def _csv_columns(cells, where):
    """Units of the columns by name, in the order of the columns."""
    columns = units_of(cells)
    viscosities = set(columns) - {"temperature", "pressure"}
    known = viscosities <= {"kinematic_viscosity", "dynamic_viscosity"}
    if len(columns) != len(cells) or "temperature" not in columns or not viscosities or not known:
        raise RecordError(f"{where}: got the columns {shown(', '.join(cells))}, need {_COLUMNS}")
    return columns
