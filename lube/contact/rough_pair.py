"""Pairs of rough lines, drawn as the study's seed says."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.study.line_spec import LineSpec
from lube.study.study import Study
from lube.surfaces.spectra import line_attributes
from lube.surfaces.synthetic import ROLLER_NUMBERS, draw_realisation
from lube.types import Pair

PADDING = np.iinfo(np.int32).min
"""Fill value beyond the end of the shorter of two lines."""


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
