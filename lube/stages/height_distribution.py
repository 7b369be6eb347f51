"""The height distribution stage: contact of lines with other values of skewness and kurtosis."""

from functools import partial
from itertools import product

import numpy as np
import xarray as xr

from lube.contact.ensemble import ATTRIBUTES, PROBABILITIES, with_limits
from lube.contact.windows import study_windows
from lube.grid.operating_points import at_slip
from lube.kernels.synthesis import mean_powers
from lube.schema import label
from lube.study.study import Study
from lube.surfaces.synthetic import draw_realisation
from lube.threads import on_threads
from lube.types import Datasets

SKEWNESS = (-1.0, -0.5, 0.0, 0.5, 1.0)
"""Levels of the skewness of both lines; those of run-in rollers are negative."""
KURTOSIS = (3.0, 4.0, 6.0)
"""Levels of the kurtosis of both lines."""
LAMBDA_RATIOS = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0])
"""Levels of the lambda ratio."""
PAIRS = 8
"""Number of pairs: the study's first realisations, with the same random phases for every level."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``height_distribution.nc``: probabilities by skewness and kurtosis, in pure rolling.

    The contact is that of the largest force. If the film has a shape, or the oil flattens or
    answers the lines, this is taken at the same force, the middle speed and temperature, and with
    the first lubricant.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`. The skewness and the kurtosis of the study's lines are replaced.

    Returns
    -------
    xarray.Dataset
        The ``height_distribution`` file of `lube.schema`.
    """
    film, spec = inputs["film"], study.line_spec
    at = {name: film.sizes[name] // 2 for name in ("speed", "temperature")}
    at |= {"film_formula": 0, "lubricant": 0, "force": np.argmax(film["contact_half_width"].values)}
    point = at_slip(film).isel(at)
    half_width = point["contact_half_width"].item()
    films = LAMBDA_RATIOS * film["composite_rms_roughness"].item()
    points = point.drop_vars("lambda_ratio").assign(film_thickness=("lambda_ratio", films))
    windows = study_windows(study, points)
    found = on_threads(partial(_on_lines, study, windows), product(SKEWNESS, KURTOSIS), threads)
    shares, moments = map(np.array, zip(*found, strict=True))
    shape, dims = (len(SKEWNESS), len(KURTOSIS)), ("height_skewness", "height_kurtosis")
    shares = shares.reshape(*shape, *shares.shape[1:])
    over = *dims, "realisation", "lambda_ratio"
    table = {name: (over, shares[..., which]) for which, name in enumerate(PROBABILITIES)}
    names = "attained_skewness", "attained_kurtosis"
    for name, values in zip(names, np.moveaxis(moments.mean(axis=1), -1, 0), strict=True):
        table[name] = dims, values.reshape(shape)
    levels = {dims[0]: list(SKEWNESS), dims[1]: list(KURTOSIS), "lambda_ratio": LAMBDA_RATIOS}
    # Both rollers turn as one, so a revolution of the smaller one shows all of its line.
    independent = xr.DataArray(spec.independent_windows(2.0 * half_width))
    found = with_limits(xr.Dataset(table, levels).transpose("realisation", ...), independent)
    found = found.drop_vars(PROBABILITIES).assign(contact_half_width=half_width)
    attributes = {name: getattr(spec, name) for name in ATTRIBUTES}
    return label(found.assign_coords(revolutions=1).assign_attrs(attributes), "height_distribution")


def _on_lines(study, windows, level):
    """Probabilities on pairs of lines of some skewness and kurtosis, and the values attained."""
    heights = dict(zip(("skewness", "kurtosis"), level, strict=True))
    spec = study.line_spec
    lines = tuple(line.model_copy(update=heights) for line in spec.lines)
    spec = spec.model_copy(update={"lines": lines})
    shares, moments = [], []
    for number in range(PAIRS):
        pair = draw_realisation(spec, study.seed, number)
        shares.append(windows.count(pair)[:, 1::-1])
        moments += map(_moments, pair)
    return shares, moments


def _moments(line):
    """Skewness and kurtosis of a line of mean zero."""
    variance, third, fourth = mean_powers(line)
    return third / variance**1.5, fourth / variance**2
