"""The roughness stage: the lines of realisations as labelled datasets."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.schema import label
from lube.study.rollers import LineSpec
from lube.surfaces.synthetic import (
    ROLLERS,
    draw_realisation,
    line_attributes,
    line_moments,
    spectrum_moments,
)

PADDING = np.iinfo(np.int32).min
"""Fill value beyond the end of the shorter of two lines."""


def roughness_lines(spec: LineSpec, seed: int, realisations: Sequence[int]) -> xr.Dataset:
    """Draw realisations of the roughness lines, with their moments.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines; `Study.line_spec` of a study.
    seed : int
        Seed of the study.
    realisations : sequence of int
        Numbers of the realisations.

    Returns
    -------
    xarray.Dataset
        The ``roughness`` file of `lube.schema`. Heights are in m, exact multiples of the
        height step; where the rollers differ in size, the shorter line is padded with NaN.
    """
    shape = (len(realisations), len(ROLLERS))
    heights = np.full((*shape, max(spec.points)), np.nan)
    moments = np.empty(shape, dict)
    for row, realisation in enumerate(realisations):
        for roller, line in enumerate(draw_realisation(spec, seed, realisation)):
            heights[row, roller, : line.size] = line * spec.height_step
            moments[row, roller] = line_moments(heights[row, roller, : line.size], spec.spacing)
    expected = [spectrum_moments(spec, roller) for roller in range(len(ROLLERS))]
    dims = ("realisation", "roller")
    dataset = xr.Dataset(
        {
            "height": ((*dims, "position"), heights),
            "seed": ("realisation", np.full(len(realisations), seed, np.int64)),
            **{
                name: (dims, np.reshape([moment[name] for moment in moments.flat], shape))
                for name in moments.flat[0]
            },
            **{
                f"spectrum_{name}": ("roller", [moment[name] for moment in expected])
                for name in expected[0]
            },
        },
        coords={**_labels(realisations), "position": spec.spacing * np.arange(max(spec.points))},
        attrs=line_attributes(spec),
    )
    return label(dataset, "roughness")


def roughness_batch(spec: LineSpec, seed: int, realisations: Sequence[int]) -> xr.Dataset:
    """Draw realisations as whole height steps, the compact input of the contact stage.

    Parameters
    ----------
    spec, seed, realisations
        As in `roughness_lines`.

    Returns
    -------
    xarray.Dataset
        The ``roughness_batch`` file of `lube.schema`: int32 heights in height steps, which the
        attribute ``scale_factor`` converts into m.
    """
    heights = np.full((len(realisations), len(ROLLERS), max(spec.points)), PADDING, np.int32)
    for row, realisation in enumerate(realisations):
        for roller, line in enumerate(draw_realisation(spec, seed, realisation)):
            heights[row, roller, : line.size] = line
    dataset = xr.Dataset(
        {"height": (("realisation", "roller", "position"), heights)},
        coords=_labels(realisations),
        attrs=line_attributes(spec),
    )
    dataset = label(dataset, "roughness_batch")
    dataset["height"].attrs["scale_factor"] = spec.height_step
    return dataset


def _labels(realisations):
    return {
        "realisation": np.asarray(realisations, np.int64),
        "roller": np.asarray(ROLLERS, np.int64),
    }
