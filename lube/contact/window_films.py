"""Films at the points of the contact window, with the shape of a computed film."""

from dataclasses import dataclass

import numpy as np
import scipy
import xarray as xr

from lube.errors import DataError
from lube.grid.discretise import LineGrid
from lube.grid.film_profiles import shaped_films
from lube.types import Array


@dataclass(frozen=True)
class WindowFilm:
    """Film at the points of a contact window, and beyond it as far as lines may touch.

    The surfaces move from the last point to the first: the last ones lie in the inlet.

    Attributes
    ----------
    film : numpy.ndarray
        Film thickness, or gap outside the contact, at each point, height steps. Shape (W,), or
        (F, W) for F operating points with the same window.
    before : int
        Number of points before the line of centres.
    """

    film: Array
    before: int

    @property
    def at_ends(self) -> int:
        """The lowest film at the first or the last point, height steps."""
        return self.film[..., [0, -1]].min()

    def below(self, height: float) -> "WindowFilm":
        """Return the part in which the film is lower than a height, at least one point.

        Parameters
        ----------
        height : float
            Height, height steps.

        Returns
        -------
        WindowFilm
            The points from the first to the last at which a film is lower.

        Raises
        ------
        DataError
            If a film is lower than the height even at an end, so that points may be missing.
        """
        films = np.atleast_2d(self.film)
        reached = np.flatnonzero((films < height).any(axis=0))
        first, last = reached[[0, -1]] if reached.size else (self.before, self.before)
        if first == 0 or last == films.shape[1] - 1:
            raise DataError(
                f"film profile: got {self.at_ends:.3g} height steps at its end, need "
                f"more than the height of the lines, {height:.3g}, from a longer profile"
            )
        return WindowFilm(self.film[..., first : last + 1], int(self.before - first))


def window_films(film: xr.Dataset, grid: LineGrid) -> Array:
    """Films with the computed shape, in whole height steps and points.

    Parameters
    ----------
    film : xarray.Dataset
        As in `shaped_films`.
    grid : LineGrid
        Grid of the lines.

    Returns
    -------
    numpy.ndarray of object
        A `WindowFilm` of each operating point, in the order of ``film_thickness``, as far as the
        profile reaches; None where the film is not known.
    """
    position = film["film_position"].values

    def on_points(profile, half_width):
        if not np.isfinite(profile).all():
            return None
        first, last = -position[[-1, 0]] * half_width / grid.spacing
        points = np.arange(np.ceil(first), np.floor(last) + 1.0)
        films = film_on_points(position, profile, half_width, points, grid)
        return WindowFilm(films, int(-points[0]))

    shaped, width = shaped_films(film), film["contact_half_width"]
    options = {"input_core_dims": [["film_position"], []], "output_dtypes": [object]}
    return xr.apply_ufunc(on_points, shaped, width, vectorize=True, **options).values.ravel()


def film_on_points(
    position: Array, profile: Array, half_width: float, points: Array, grid: LineGrid
) -> Array:
    """Film at the points of a line that moves with the oil, by one point at most in a time step.

    Parameters
    ----------
    position, profile : numpy.ndarray
        Positions over the half-width, rising, and the film there, m.
    half_width : float
        Half-width of the contact, m.
    points : numpy.ndarray, shape (n,)
        Points, counted from the line of centres against the motion, into the inlet.
    grid : LineGrid
        Grid of the lines.

    Returns
    -------
    numpy.ndarray of int64, shape (n,)
        Film at the points, height steps, from a cubic spline through the profile.
    """
    film = scipy.interpolate.CubicSpline(position, profile)(-points * (grid.spacing / half_width))
    return np.rint(film / grid.height_step).astype(np.int64)
