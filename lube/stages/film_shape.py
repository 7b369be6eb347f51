"""The film shape stage: probability of contact under flat films and under the computed one."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from lube.contact.window_films import scaled_film
from lube.grid.discretise import layer_factor_of, whole_numbers
from lube.grid.operating_points import at_slip
from lube.kernels.strips import strip_statistics
from lube.kernels.whole_runs import whole_run_steps
from lube.physics.hertz import hertz_gap
from lube.schema import POINT_DIMS, label, values_with_limits
from lube.statistics.confidence import mean_interval, probability_interval, ratio_interval
from lube.study.line_spec import LineSpec
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.surfaces.rare_contact import check_gaussian, rare_contact_under
from lube.surfaces.synthetic import draw_realisation
from lube.types import Array, Datasets

FILM_MODELS = ("formula", "flat", "open", "computed")
"""Films that are compared: the study's first film formula and the computed central film, both flat
and cut off at the edges of Hertz' contact; the latter with Hertz' gap around it; and the computed
film with the gap around it."""
PAIRS = 40
"""Pairs of lines; errors follow from the scatter between them."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``film_shape.nc``; see `lube.stages`."""
    films = inputs["film"], inputs["film_profile"]
    return film_shape_probabilities(
        study.line_spec, *films, study.boundary_layer, study.seed, threads
    )


def film_shape_probabilities(
    spec: LineSpec,
    film: xr.Dataset,
    profile: xr.Dataset,
    boundary_layer: BoundaryLayer,
    seed: int,
    threads: int = 1,
) -> xr.Dataset:
    """Compute the probability of contact under the films of `FILM_MODELS`.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines; `Study.line_spec` of a study.
    film, profile : xarray.Dataset
        A ``film`` and a ``film_profile`` dataset of one study; of several slips `at_slip` selects.
    boundary_layer : BoundaryLayer
        The boundary layer.
    seed : int
        Seed of the study.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The ``film_shape`` file of `lube.schema`; NaN where the film did not converge.

    Raises
    ------
    StudyError
        If the lines are not Gaussian: rare contact is sampled as in `lube.surfaces.rare_contact`.
    """
    check_gaussian(spec)
    film = at_slip(film)
    name = film["film_formula"].values[0]
    thickness = film["film_thickness"].sel(film_formula=name).transpose(*POINT_DIMS)
    profile = profile.transpose(*POINT_DIMS, "film_position")
    if "inlet_shear_heating_factor" in film:  # which thins the computed film as the formula's
        factor = film["inlet_shear_heating_factor"]
        heated = scaled_film(profile["film"], factor, film).transpose(*profile["film"].dims)
        central = (factor * profile["central_film"]).transpose(*POINT_DIMS)
        profile = profile.assign(film=heated, central_film=central)
    central = profile["central_film"]
    work = seed, threads
    contact, breakthrough = _sampled(spec, film, profile, thickness, boundary_layer, work)
    films = [thickness, central, central, central]  # of the models in this order
    thicknesses = xr.concat(films, "film_model", join="exact", coords="minimal")
    ratio = ratio_interval(breakthrough, breakthrough[:, :1])
    table = xr.Dataset(
        {
            **_limited("geometric_contact_probability", contact),
            **_limited("breakthrough_probability", breakthrough),
            # From the same lines, over the formula's flat film.
            **values_with_limits("probability_ratio", ratio, _DIMS[1:]),
            **_edges(spec, film, thickness, boundary_layer, work),
            "lambda_ratio": thicknesses.drop_attrs() / film["composite_rms_roughness"].item(),
            "film_formula": ((), name),
        },
        {dim: film[dim] for dim in POINT_DIMS} | {"film_model": list(FILM_MODELS)},
    )
    return label(table.transpose("film_model", *POINT_DIMS), "film_shape")


def _edges(spec, film, thickness, boundary_layer, work):
    """Breakthrough probability from uncut runs, and its ratio when the window's edges cut them.

    Counted in pure rolling, in the first `PAIRS` pairs of lines of the study's seed. Where the
    lines differ in length, the second is continued until the first ends.
    """
    seed, threads = work
    widths = film["contact_half_width"].broadcast_like(thickness).transpose(*POINT_DIMS)
    points = whole_numbers(thickness.values.ravel(), widths.values.ravel(), spec)
    factor = layer_factor_of(spec, film["reduced_modulus"].item(), boundary_layer)

    def on_one_pair(number):
        first, second = draw_realisation(spec, seed, number)
        line = first + np.resize(second, first.size)
        pair = line, np.zeros_like(line)
        pieces = strip_statistics(pair, (1.0, 1.0), line.size, *points, factor)[:, 1]
        return np.stack([whole_run_steps(line, *points, factor), pieces]) / line.size

    with ThreadPoolExecutor(threads) as pool:
        found = np.stack(list(pool.map(on_one_pair, range(PAIRS))))
    found[:, :, np.isnan(thickness.values.ravel())] = np.nan
    whole, pieces = (found[:, each].reshape(-1, *thickness.shape) for each in (0, 1))
    seen = probability_interval(whole, spec.independent_windows(2.0 * widths.values))
    return values_with_limits("whole_run_probability", seen, POINT_DIMS) | values_with_limits(
        "edge_ratio", ratio_interval(pieces, whole), POINT_DIMS
    )


_DIMS = ("pair", "film_model", *POINT_DIMS)


def _sampled(spec, film, profile, thickness, boundary_layer, work):
    """Geometric contact and breakthrough over `_DIMS`."""
    seed, threads = work
    factor = layer_factor_of(spec, film["reduced_modulus"].item(), boundary_layer)
    widths = profile["contact_half_width"].broadcast_like(thickness).transpose(*POINT_DIMS)
    rows = [
        window_models(spec, *each, film["reduced_radius"].item())
        for each in zip(
            profile["film_position"].values[None].repeat(thickness.size, axis=0),
            profile["film"].values.reshape(thickness.size, -1),
            thickness.values.ravel(),
            widths.values.ravel(),
            strict=True,
        )
    ]
    films = [row[model] for model in range(len(FILM_MODELS)) for row in rows]
    known = [number for number, one in enumerate(films) if np.isfinite(one).all()]

    def on_one_pair(number):
        found = np.full((2, len(films)), np.nan)
        found[:, known] = rare_contact_under(spec, seed, number, [films[i] for i in known], factor)
        return found.reshape(2, len(FILM_MODELS), *thickness.shape)

    with ThreadPoolExecutor(threads) as pool:
        return np.moveaxis(np.stack(list(pool.map(on_one_pair, range(PAIRS)))), 1, 0)


def window_models(
    spec: LineSpec,
    position: Array,
    profile: Array,
    thickness: float,
    half_width: float,
    reduced_radius: float,
) -> tuple[Array, ...]:
    """Films of `FILM_MODELS` at the points of the contact window, and around it where it is open.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines.
    position, profile : numpy.ndarray, shape (n,)
        Computed film, m, at positions over the half-width.
    thickness : float
        Film by the formula, m.
    half_width, reduced_radius : float
        Of the contact, m.

    Returns
    -------
    tuple of numpy.ndarray
        Films, height steps.
    """
    spacing = spec.spacing / half_width
    inside = int(1.0 / spacing)
    around = np.arange(int(position[0] / spacing), int(position[-1] / spacing) + 1) * spacing
    central = np.interp(0.0, position, profile)
    if np.isnan(central):
        around, profile = around[:0], np.zeros(profile.size)
    films = (
        np.full(2 * inside + 1, thickness),
        np.full(2 * inside + 1, central),
        central + hertz_gap(around) * half_width**2 / reduced_radius,
        CubicSpline(position, profile)(around),
    )
    return tuple(each / spec.height_step if each.size else np.array([np.nan]) for each in films)


def _limited(name, values):
    return values_with_limits(name, np.minimum(mean_interval(values), 1.0), _DIMS[1:])
