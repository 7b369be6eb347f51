"""Pairs of rough rollers, and of their lines, drawn as the study's seed says."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import xarray as xr

from lube.grid.gap import PLAIN, Gap
from lube.study.line_spec import LineSpec
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.surfaces.spectra import line_attributes
from lube.surfaces.synthetic import ROLLER_NUMBERS, LineSpecLike, draw_realisation
from lube.types import Pair

PADDING = np.iinfo(np.int32).min
"""Fill value beyond the end of the shorter of two lines."""


@dataclass(frozen=True)
class RoughPair:
    """A pair of rough rollers: all that their contact depends on, besides the film.

    Attributes
    ----------
    spec : LineSpecLike
        Parameters of the lines, and of the surfaces that they stand for.
    length : float
        Length L' of the rollers, m.
    layer : BoundaryLayer
        The boundary layer.
    seed : int
        Seed of the study.
    gap : Gap, optional
        How film and roughness make up the gap; by default flat films, and roughness as drawn.
    """

    spec: LineSpecLike
    length: float
    layer: BoundaryLayer
    seed: int
    gap: Gap = PLAIN

    @classmethod
    def of(cls, study: Study) -> Self:
        """Pair of rollers of a study."""
        length, layer = study.rollers.length, study.boundary_layer
        return cls(study.line_spec, length, layer, study.seed, study.gap)


def drawn(study: Study, realisation: int) -> Pair:
    """Draw the two lines of a realisation of a study."""
    return draw_realisation(study.line_spec, study.seed, realisation)


def roughness_batch(spec: LineSpec, seed: int, realisations: Sequence[int]) -> xr.Dataset:
    """Draw realisations in whole height steps; other stages use them without a file.

    Parameters
    ----------
    spec, seed, realisations
        As in `lube.stages.roughness.roughness_lines`.

    Returns
    -------
    xarray.Dataset
        ``height`` over (realisation, roller, position), int32, in height steps; the attribute
        ``height_step`` is the step in m. The shorter line is padded with `PADDING`.
    """
    heights = np.full((len(realisations), len(ROLLER_NUMBERS), max(spec.points)), PADDING, np.int32)
    for row, realisation in enumerate(realisations):
        for roller, line in enumerate(draw_realisation(spec, seed, realisation)):
            heights[row, roller, : line.size] = line
    return xr.Dataset(
        {"height": (("realisation", "roller", "position"), heights)},
        {"realisation": list(realisations), "roller": list(ROLLER_NUMBERS)},
        line_attributes(spec),
    )
