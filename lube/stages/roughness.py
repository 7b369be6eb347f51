"""Roughness lines of realisations as labelled datasets."""

import numpy as np
import xarray as xr

from lube.schema import label
from lube.surfaces.synthetic import (
    ROLLERS,
    draw_realisation,
    line_attributes,
    line_moments,
    spectrum_moments,
)

PADDING = np.iinfo(np.int32).min
"""Marks the missing end of a line that is shorter than its partner's."""


def roughness_lines(spec, seed, realisations):
    """Draw realisations as a labelled dataset.

    Parameters
    ----------
    spec : LineSpec
        What determines the lines; `Study.line_spec` of a study.
    seed : int
        Seed of the study.
    realisations : sequence of int
        Which realisations.

    Returns
    -------
    xarray.Dataset
        The ``roughness`` file of `lube.schema`. Heights are in m, exact multiples of the
        height step; where the rollers differ in size, the shorter line ends in NaN.
    """
    heights = np.full((len(realisations), len(ROLLERS), max(spec.points)), np.nan)
    moments = []
    for heights_of_pair, realisation in zip(heights, realisations, strict=True):
        lines = draw_realisation(spec, seed, realisation)
        for row, line in zip(heights_of_pair, lines, strict=True):
            row[: line.size] = line * spec.height_step
            moments.append(line_moments(row[: line.size], spec.spacing))
    shape = heights.shape[:2]
    dims = ("realisation", "roller")
    variables = {
        name: (dims, np.array([moment[name] for moment in moments]).reshape(shape))
        for name in moments[0]
    }
    promised = [spectrum_moments(spec, roller) for roller in range(len(ROLLERS))]
    variables |= {
        f"spectrum_{name}": ("roller", [moment[name] for moment in promised])
        for name in promised[0]
    }
    dataset = xr.Dataset(
        {
            "height": ((*dims, "position"), heights),
            "seed": ("realisation", np.full(len(realisations), seed, np.int64)),
            **variables,
        },
        coords={
            "realisation": np.asarray(realisations, np.int64),
            "roller": np.asarray(ROLLERS, np.int64),
            "position": spec.spacing * np.arange(max(spec.points)),
        },
        attrs=line_attributes(spec),
    )
    return label(dataset, "roughness")


def roughness_batch(spec, seed, realisations):
    """Draw realisations as whole height steps, lean, to be handed on to the contact stage.

    Parameters
    ----------
    spec, seed, realisations
        As in `roughness_lines`.

    Returns
    -------
    xarray.Dataset
        The ``roughness_batch`` file of `lube.schema`: int32 heights in steps, which the
        attribute ``scale_factor`` turns into m.
    """
    heights = np.full((len(realisations), len(ROLLERS), max(spec.points)), PADDING, np.int32)
    for heights_of_pair, realisation in zip(heights, realisations, strict=True):
        lines = draw_realisation(spec, seed, realisation)
        for row, line in zip(heights_of_pair, lines, strict=True):
            row[: line.size] = line
    dataset = xr.Dataset(
        {"height": (("realisation", "roller", "position"), heights)},
        coords={
            "realisation": np.asarray(realisations, np.int64),
            "roller": np.asarray(ROLLERS, np.int64),
        },
        attrs=line_attributes(spec),
    )
    dataset = label(dataset, "roughness_batch")
    dataset["height"].attrs["scale_factor"] = spec.height_step
    return dataset
