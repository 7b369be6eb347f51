"""Runs of the contact model with the realisations of a study, at any film and contact width."""

import numpy as np
import numpy.typing as npt
import xarray as xr

from lube.grid.contact_runs import ContactRuns
from lube.grid.discretise import (
    UNKNOWN_FILM,
    layer_factor_of,
    revolution,
    speed_ratios,
    whole_numbers,
)
from lube.kernels.motion import surface_position
from lube.kernels.strips import strip_statistics
from lube.study.study import Study
from lube.surfaces.spectra import line_attributes
from lube.surfaces.synthetic import draw_realisation
from lube.types import Array, Pair


class EnsembleRuns:
    """The roughness, the elasticity and the boundary layer of a study, ready to run.

    Parameters
    ----------
    study : Study
        Its rollers, roughness lines, boundary layer and seed are used.
    films : xarray.Dataset, optional
        Films at the points to run, where the study gives them a shape, or flattens the lines there;
        without them all films are flat, and the lines as drawn.
    """

    def __init__(self, study: Study, films: xr.Dataset | None = None):
        self._study = study
        self._lines = xr.Dataset(attrs=line_attributes(study.line_spec))
        modulus = study.rollers.reduced_modulus
        self._factor = layer_factor_of(self._lines, modulus, study.boundary_layer)
        self._at = None
        if films is not None and not study.follows_master_map:
            layer = study.boundary_layer
            self._at = ContactRuns(self._lines, films, layer, study.is_flattened)
            points = self.points_of(films)
            self._numbers = {tuple(point): number for number, point in enumerate(points.T.tolist())}

    def pair(self, realisation: int) -> Pair:
        """Draw the two lines of a realisation."""
        return draw_realisation(self._study.line_spec, self._study.seed, realisation)

    def points(self, film_thickness: npt.ArrayLike, half_width: npt.ArrayLike) -> Array:
        """Convert films and half-widths (m) to height steps and grid points, shape (2, P)."""
        thickness, widths = np.broadcast_arrays(film_thickness, half_width)
        return np.stack(whole_numbers(thickness.ravel(), widths.ravel(), self._lines))

    def points_of(self, films: xr.Dataset) -> Array:
        """Points of a film table, shape (2, P); or (4, P) where more decides than film and width.

        Then the bits of Moes' numbers M and L are added, which tell operating points apart.
        """
        names = ["contact_half_width"]
        names += ["moes_load", "moes_material"] if self._at else []
        spread = xr.broadcast(films["film_thickness"], *(films[name] for name in names))
        thickness, half_width, *moes = (each.values.ravel() for each in spread)
        bits = [np.ascontiguousarray(each).view(np.int64)[None] for each in moes]
        return np.concatenate([self.points(thickness, half_width), *bits])

    def share(
        self, pair: Pair, slip: float, points: Array, turns: float = 1.0, begin: int = 0
    ) -> Array:
        """Share of time steps with breakthrough in some revolutions, shape (P,).

        Parameters
        ----------
        pair : tuple of numpy.ndarray
            From `pair`.
        slip : float
            Slide-to-roll ratio.
        points : numpy.ndarray
            From `points_of`.
        turns : float, optional
            Revolutions of the roller with the faster surface; a single time step at least.
        begin : int, optional
            First time step.

        Returns
        -------
        numpy.ndarray
            Shape (P,); NaN where the film is not known.
        """
        steps = max(round(turns * revolution(pair, speed_ratios(slip))), 1)
        if self._at is None:
            counts = self.breakthroughs(pair, slip, points, begin, begin + steps)
            return np.where(points[0] < UNKNOWN_FILM, counts / steps, np.nan)
        numbers = np.array([self._numbers[tuple(point)] for point in points.T.tolist()], int)
        pair, ratios = _begun(pair, slip, begin), speed_ratios(slip)
        return self._at.statistics(pair, ratios, steps, numbers)[:, 1]

    def breakthroughs(self, pair: Pair, slip: float, points: Array, begin: int, end: int) -> Array:
        """Count the time steps from `begin` to `end` with breakthrough under flat films, (P,)."""
        pair, ratios = _begun(pair, slip, begin), speed_ratios(slip)
        return strip_statistics(pair, ratios, end - begin, *points, self._factor)[:, 1]


def _begun(pair, slip, begin):
    """Lines as they lie at a time step."""
    if not begin:
        return pair
    positions = (surface_position(begin, ratio) for ratio in speed_ratios(slip))
    return tuple(np.roll(line, -at) for line, at in zip(pair, positions, strict=True))
