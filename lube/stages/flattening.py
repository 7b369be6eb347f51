"""The flattening stage: contact of lines whose long waves the oil has flattened."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import xarray as xr

from lube.contact.windows import ContactWindows
from lube.grid.operating_points import at_slip
from lube.physics.flattening import amplitude_ratio
from lube.schema import MEAN_LIMITS, POINT_DIMS, label, values_with_limits
from lube.statistics.confidence import probability_interval, ratio_interval
from lube.study.line_spec import LineSpec
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.surfaces.synthetic import draw_realisation, wave_amplitudes
from lube.types import Datasets

ROUGHNESS_MODELS = ("undeformed", "flattened")


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``flattening.nc``; see `lube.stages`."""
    lines = study.seed, range(study.realisations)
    return flattened_contact(study.line_spec, inputs["film"], study.boundary_layer, *lines, threads)


def flattened_contact(
    spec: LineSpec,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    seed: int,
    realisations: Sequence[int],
    threads: int = 1,
) -> xr.Dataset:
    """Compute contact with the lines as drawn, and as the oil flattens them.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines; `Study.line_spec` of a study.
    film : xarray.Dataset
        A ``film`` dataset; its first film formula is used.
    boundary_layer : BoundaryLayer
        The boundary layer.
    seed : int
        Seed of the study.
    realisations : sequence of int
        Realisations of the lines.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The ``flattening`` file of `lube.schema`, in pure rolling.
    """
    film = at_slip(film).isel(film_formula=0).transpose(*POINT_DIMS, ...)
    models = [
        ContactWindows(spec, film, boundary_layer, flattened=model == "flattened")
        for model in ROUGHNESS_MODELS
    ]

    def run(number):
        pair = draw_realisation(spec, seed, number)
        return [model.count(pair)[:, 1] for model in models]

    with ThreadPoolExecutor(threads) as pool:
        probability = np.array(list(pool.map(run, realisations)))
    dims = ("realisation", "roughness_model", *POINT_DIMS)
    probability = probability.reshape(*probability.shape[:2], *film["film_thickness"].shape)
    width = 2.0 * film["contact_half_width"].broadcast_like(film["film_thickness"])
    windows = spec.independent_windows(width.transpose(*POINT_DIMS).values)
    means = probability_interval(probability, windows)
    # From the same lines; NaN where no contact was seen.
    ratio = ratio_interval(probability[:, 1], probability[:, 0])
    table = xr.Dataset(
        {
            "breakthrough_probability": (dims, probability),
            **values_with_limits("breakthrough_probability", means, dims[1:], MEAN_LIMITS),
            **values_with_limits("probability_ratio", ratio, POINT_DIMS),
            "roughness_ratio": _roughness_ratio(spec, film),
            "lambda_ratio": film["lambda_ratio"].drop_attrs(),
        },
        {name: film[name] for name in POINT_DIMS}
        | {"realisation": np.asarray(realisations), "roughness_model": list(ROUGHNESS_MODELS)}
        | {"revolutions": 1},
    )
    formula = film["film_formula"].item()
    table = table.drop_vars("film_formula", errors="ignore").assign(film_formula=formula)
    return label(table, "flattening")


def _roughness_ratio(spec, film):
    """Rms height of both lines together, flattened over as drawn."""
    waves = [wave_amplitudes(spec, roller) for roller in range(len(spec.lines))]
    power = np.concatenate([amplitudes**2 for _, amplitudes in waves])
    wavelength = np.concatenate(
        [
            points * spec.spacing / (first + np.arange(amplitudes.size))
            for points, (first, amplitudes) in zip(spec.points, waves, strict=True)
        ]
    )

    def ratio(half_width, *moes):
        kept = amplitude_ratio(wavelength / half_width, *moes)
        return np.sqrt(np.sum(kept**2 * power) / np.sum(power))

    names = ("contact_half_width", "moes_load", "moes_material")
    contact = (film[name].drop_attrs() for name in names)
    return xr.apply_ufunc(ratio, *contact, vectorize=True).transpose(*POINT_DIMS)
