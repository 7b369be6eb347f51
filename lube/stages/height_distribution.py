"""The height distribution stage: contact of lines of other skewness and kurtosis."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import xarray as xr

from lube.contact.windows import ContactWindows
from lube.grid.gap import PLAIN, Gap
from lube.grid.operating_points import at_slip
from lube.kernels.synthesis import mean_powers
from lube.schema import MEAN_LIMITS, label, values_with_limits
from lube.statistics.confidence import probability_interval
from lube.study.line_spec import LineSpec
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.surfaces.synthetic import draw_realisation
from lube.types import Datasets

SKEWNESS = (-1.0, -0.5, 0.0, 0.5, 1.0)
"""Levels of the skewness of both lines; those of run-in rollers are negative."""
KURTOSIS = (3.0, 4.0, 6.0)
"""Levels of the kurtosis of both lines."""
LAMBDA_RATIOS = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0])
"""Levels of the lambda ratio."""
PAIRS = 8
"""Realisations, the first of the study: all distributions have the same random phases."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``height_distribution.nc``; see `lube.stages`."""
    film, layer = inputs["film"], study.boundary_layer
    options = study.seed, threads, study.gap
    return height_distributions(study.line_spec, film, layer, *options)


def height_distributions(
    spec: LineSpec,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    seed: int,
    threads: int = 1,
    gap: Gap = PLAIN,
) -> xr.Dataset:
    """Compute probabilities by skewness and kurtosis of the heights, in pure rolling.

    The contact is that of the largest force. If the film has a shape, or the oil flattens the
    lines, both are those of this force at the middle speed and temperature and the first lubricant,
    at all films.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines; their own skewness and kurtosis are replaced.
    film : xarray.Dataset
        A ``film`` dataset.
    boundary_layer : BoundaryLayer
        The boundary layer.
    seed : int
        Seed of the study.
    threads : int, optional
        Threads that share the work; they do not change the results.
    gap : Gap, optional
        How film and roughness make up the gap; by default flat films, and lines as drawn.

    Returns
    -------
    xarray.Dataset
        The ``height_distribution`` file of `lube.schema`.
    """
    at = {name: film.sizes[name] // 2 for name in ("speed", "temperature")}
    at |= {"film_formula": 0, "lubricant": 0, "force": np.argmax(film["contact_half_width"].values)}
    point = at_slip(film).isel(at)
    half_width = point["contact_half_width"].item()
    films = LAMBDA_RATIOS * film["composite_rms_roughness"].item()
    points = point.drop_vars("lambda_ratio").assign(film_thickness=("lambda_ratio", films))
    contact_windows = ContactWindows(spec, points, boundary_layer, gap)
    levels = [(skewness, kurtosis) for skewness in SKEWNESS for kurtosis in KURTOSIS]
    # Both rollers turn as one, so a revolution of the smaller one shows all of its line.
    windows = np.full(films.size, spec.independent_windows(2.0 * half_width))

    def row(level):
        return _row(_with_heights(spec, *level), seed, contact_windows, windows)

    # Drawing and counting release Python's lock, so threads share the work.
    with ThreadPoolExecutor(threads) as pool:
        rows = list(pool.map(row, levels))
    shape = len(SKEWNESS), len(KURTOSIS)
    dims = ("height_skewness", "height_kurtosis")
    table = {"contact_half_width": half_width}
    for name in rows[0]:
        values = np.array([row[name] for row in rows])
        along = (*dims, "lambda_ratio")[: 1 + values.ndim]
        table[name] = along, values.reshape(shape + values.shape[1:])
    coordinates = dict(zip(dims, (list(SKEWNESS), list(KURTOSIS)), strict=True))
    coordinates |= {"lambda_ratio": LAMBDA_RATIOS, "revolutions": 1}
    attributes = {"travel": spec.travel, "longest_wavelength": spec.longest_wavelength}
    return label(xr.Dataset(table, coordinates, attributes), "height_distribution")


def _with_heights(spec, skewness, kurtosis):
    heights = {"skewness": skewness, "kurtosis": kurtosis}
    return spec.model_copy(
        update={"lines": tuple(line.model_copy(update=heights) for line in spec.lines)}
    )


def _row(spec, seed, contact_windows, windows):
    """Probabilities with their intervals over the films, and the moments that were attained."""
    counts, moments = [], []
    for number in range(PAIRS):
        pair = draw_realisation(spec, seed, number)
        counts.append(contact_windows.count(pair))
        moments += map(_moments, pair)
    contact, breakthrough, _, _ = np.moveaxis(np.array(counts), -1, 0)
    skewness, kurtosis = np.mean(moments, axis=0)
    row = {"attained_skewness": skewness, "attained_kurtosis": kurtosis}
    for name, values in (
        ("breakthrough_probability", breakthrough),
        ("geometric_contact_probability", contact),
    ):
        interval = probability_interval(values, windows)
        row |= values_with_limits(name, interval, names=MEAN_LIMITS)
    return row


def _moments(line):
    """Skewness and kurtosis of a line of mean zero."""
    variance, third, fourth = mean_powers(line)
    return third / variance**1.5, fourth / variance**2
