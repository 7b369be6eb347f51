"""Short names of types that many signatures share."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import xarray as xr


class Quantity(Protocol):
    """A number, or an array, with its unit: a quantity of pint or of a package like it."""

    @property
    def magnitude(self) -> Any:
        """The number without its unit."""

    @property
    def units(self) -> Any:
        """The unit."""


Amount = str | Sequence[str] | tuple[npt.ArrayLike, str] | Quantity
"""``"800 N"``, ``["400 N", "800 N"]``, ``([400, 800], "N")``, or a quantity of pint."""
OneAmount = str | tuple[float, str] | Quantity
"""``"800 N"``, ``(800, "N")``, or a quantity of pint."""
Array = np.ndarray
ContactModel = Literal["line", "surface"]
"""Contact of two roughness lines, or of the surfaces that they stand for."""
Datasets = Mapping[str, "xr.Dataset"]
"""Datasets by the names of their kinds."""
File = str | Path
"""Path of a file or folder."""
Files = Iterable[File]
FilmShape = Literal["flat", "computed"]
InletHeating = Literal["none", "zhu-cheng-1988", "wilson-sheu-1983", "computed"]
LoadSharing = Literal["none", "iterated"]
Pair = tuple[Array, Array]
"""Two arrays, such as the lines of both rollers or both limits of an interval."""
Points = tuple[int, int]
"""Numbers of grid points, one for each roller."""
Ratios = tuple[float, float]
"""Ratios of speeds, one for each roller."""
RoughnessDeformation = Literal["none", "computed", "venner-1997"]
Values = float | Array
"""A number or an array, plain or labelled; arrays broadcast against one another."""
