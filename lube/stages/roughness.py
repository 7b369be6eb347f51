"""The roughness stage: the lines of realisations as labelled datasets."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.contact.rough_pair import PADDING, roughness_batch
from lube.schema import label, with_dims
from lube.study.line_spec import LineSpec
from lube.study.study import Study
from lube.surfaces.spectra import line_moments, spectrum_bands, spectrum_moments
from lube.surfaces.synthetic import ROLLER_NUMBERS
from lube.types import Datasets

BANDS = 60
"""Number of bands over which the prescribed spectrum is averaged."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``roughness.nc``; see `lube.stages`."""
    return roughness_lines(study.line_spec, study.seed, study.kept_realisations)


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
    dataset = roughness_batch(spec, seed, realisations)
    steps = dataset["height"]
    heights = steps.where(steps != PADDING) * spec.height_step
    moments = [_moments(pair, spec) for pair in heights.values]
    values = {name: [[line[name] for line in pair] for pair in moments] for name in moments[0][0]}
    expected = [spectrum_moments(spec, roller) for roller in range(len(ROLLER_NUMBERS))]
    values |= {f"spectrum_{name}": [line[name] for line in expected] for name in expected[0]}
    bands = [spectrum_bands(spec, roller, BANDS) for roller in range(len(ROLLER_NUMBERS))]
    values["wave_vector"], values["prescribed_density"] = map(list, zip(*bands, strict=True))
    values["wave"] = np.arange(BANDS)
    for name in ("skewness", "kurtosis"):
        values[f"prescribed_{name}"] = [getattr(line, name) for line in spec.lines]
    values["seed"] = np.full(len(realisations), seed, np.int64)
    values["position"] = spec.spacing * np.arange(max(spec.points))
    return label(dataset.assign(height=heights, **with_dims("roughness", values)), "roughness")


def _moments(pair, spec):
    lines = (line[:size] for line, size in zip(pair, spec.points, strict=True))
    return [line_moments(line, spec.spacing) for line in lines]
