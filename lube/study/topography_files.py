"""Read a measured roughness profile or map from a file of an instrument, CSV or NetCDF.

- CSV: two columns, ``position [mm],height [um]``, evenly spaced; a height that is empty or ``nan``
  is a hole.
- NetCDF: a variable ``height`` over one or two coordinates, all with ``units``; NaN is a hole. The
  coordinates ``x`` and ``y`` may be in either order.
- Any other suffix, or a NetCDF file without ``height``: one of the instruments' formats that
  SurfaceTopography recognises by its content, such as X3P, SUR, SDF, PLUX, OPD or VK. Its default
  channel is read, in metres, the first axis is x, and masked points are holes.
"""

from pathlib import Path

import numpy as np
import xarray as xr

from lube.errors import DataError, located, shown
from lube.study.small_csv import read_cells, units_of, with_points
from lube.surfaces.topography import Topography
from lube.types import File
from lube.units import convert, parse_number

UNEVEN = 0.1
"""Largest distance of a position from the even grid, in grid spacings."""


def read_topography(path: File) -> Topography:
    """Read a profile or a map.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Topography
        Heights in m, NaN in holes.

    Raises
    ------
    DataError
        If the file cannot be read, or has no heights, no lengths, no units or no even grid.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError(f"{path}: no such file, need a measured profile or map")
    if path.suffix.lower() == ".csv":
        return _read_csv(path)
    if path.suffix.lower() in (".nc", ".nc4") and (found := _read_netcdf(path)):
        return found
    return _read_instrument(path)


def _read_csv(path):
    (number, header), *rows = read_cells(path, DataError)
    units = units_of(header)
    if len(header) != 2 or list(units) != ["position", "height"]:
        needed = "need the columns `position [mm],height [um]` with units of length"
        raise DataError(f"{path}: line {number}: got {shown(','.join(header))}, {needed}")
    pointed = zip(rows, with_points(path, rows, 2, DataError), strict=True)
    values = np.array([_row(f"{path}: line {number}", *cells) for (number, _), cells in pointed])
    values = values.reshape(-1, 2)
    columns = zip(values.T, units.values(), strict=True)
    position, height = (_in_metres(path, *column) for column in columns)
    return Topography(str(path), height, (_even_spacing(path, position),))


def _row(where, position, height):
    """Position and height of a line; a missing height is NaN."""
    with located(where, DataError):
        hole = height.lower() in ("", "nan")
        return parse_number(position), np.nan if hole else parse_number(height)


def _read_netcdf(path):
    """Variable `height` of a NetCDF file, None if it has no such variable."""
    try:
        with xr.open_dataset(path, decode_times=False) as dataset:
            dataset = dataset.load()
    except Exception:  # of many kinds: SurfaceTopography says whether it can read the file
        return None
    if "height" not in dataset:
        return None
    height = dataset["height"].transpose("x", "y", ..., missing_dims="ignore")
    if height.ndim not in (1, 2) or not all(name in height.coords for name in height.dims):
        raise DataError(f"{path}: got height{height.dims}, need it over one or two coordinates")
    spacing = tuple(_even_spacing(path, _labelled(path, height[name])) for name in height.dims)
    heights = _labelled(path, height.astype(float))
    return Topography(str(path), heights, spacing)


def _read_instrument(path):
    # Before the library, which imports h5py: their wheels have two HDF5 libraries, and where these
    # quarrel, it is because h5py's came first (h5py issue 1541).
    import netCDF4  # noqa: F401

    # Imported on first use: it takes two seconds.
    import SurfaceTopography

    try:
        channel = SurfaceTopography.open_topography(str(path)).default_channel
        if not channel.is_height_channel:
            raise DataError(f"{path}: got {channel.name} in its default channel, need heights")
        if channel.unit is None or channel.physical_sizes is None:
            named = ", and the name `height` in NetCDF" if path.suffix.startswith(".nc") else ""
            raise DataError(f"{path}: got a topography without unit or lengths, need both{named}")
        surface = channel.topography().to_unit("m")
        heights = np.ma.filled(np.ma.asarray(surface.heights(), dtype=float), np.nan)
        if not surface.is_uniform:
            return Topography(str(path), heights, (_even_spacing(path, surface.positions()),))
        resolution = surface.short_reliability_cutoff() or 0.0
    except DataError:
        raise
    except Exception as error:  # of many kinds, one for every format
        raise DataError(f"{path}: cannot be read as a topography: {_reason(error)}") from None
    sides = zip(surface.physical_sizes, heights.shape, strict=True)
    spacing = tuple(float(size) / points for size, points in sides)
    return Topography(str(path), heights, spacing, float(resolution))


def _reason(error):
    """First line of an exception; the library lists every format that it has tried."""
    if type(error).__name__ == "CannotDetectFileFormat":
        return "no known format of an instrument"
    return str(error).strip().partition("\n")[0] or type(error).__name__


def _labelled(path, array):
    """Values of a labelled array, m."""
    if "units" not in array.attrs:
        raise DataError(f"{path}: got no unit, need the attribute `units` of {array.name}")
    return _in_metres(path, array.values, array.attrs["units"])


def _in_metres(path, values, unit):
    with located(f"{path}", DataError):
        return np.asarray(convert(values, unit, "m"))


def _even_spacing(path, position):
    """Distance of neighbouring points of an even, rising grid, m."""
    if position.size < 2 or not np.all(np.isfinite(position)):
        raise DataError(f"{path}: got {position.size} positions, need two or more, all finite")
    spacing = (position[-1] - position[0]) / (position.size - 1)
    away = np.abs(position - position[0] - spacing * np.arange(position.size)).max()
    if spacing <= 0.0 or away > UNEVEN * spacing:
        came = f"got positions up to {away:.3g} m off an even grid of {spacing:.3g} m"
        raise DataError(f"{path}: {came}, need rising, evenly spaced positions")
    return float(spacing)
