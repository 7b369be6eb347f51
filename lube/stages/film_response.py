"""The film response stage: what the oil does to waves of the roughness, by Reynolds' equation."""

import logging
from dataclasses import replace

import numpy as np
import xarray as xr

from lube.ehl.line_contact import ConvergenceError, one_blas_thread
from lube.ehl.response import WaveResponse, at_wavelengths
from lube.grid.film_profiles import film_positions, six_digits
from lube.grid.films import FilmGroups, hertz_contact
from lube.grid.operating_points import surface_speeds
from lube.schema import FILES, POINT_DIMS, label
from lube.study.line_spec import LineSpec
from lube.study.rollers import RollerPair
from lube.study.study import Study
from lube.surfaces.synthetic import ROLLER_NUMBERS
from lube.threads import on_threads
from lube.types import Datasets

log = logging.getLogger(__name__)

SHORTEST = 0.05
"""Shortest wave that is solved for, over the half-width of the contact."""
UNCHANGED = 0.003
"""Largest change by the oil of a wave that is taken for none, of shorter ones too."""
ROLLING_RATIO, SLIDING_RATIO = 1.2, 1.15
"""Largest ratio of neighbouring wavelengths. With slip the response changes faster with them: what
the oil carries through the contact runs ahead of the wave, or falls behind."""
POSITIONS = 0.02, 1.06
"""Distance of positions in the contact, and their growth beyond."""
_DIMS = FILES["film_response"]["response_real"].dims


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``film_response.nc``; see `lube.stages`."""
    meniscus, is_heated = study.film_model["inlet_meniscus"], study.inlet_shear_heating != "none"
    options = meniscus, is_heated, threads
    tables = inputs["lubricant"], inputs["film"]
    return film_responses(*tables, study.rough_rollers, study.line_spec, *options)


def film_responses(
    lubricant: xr.Dataset,
    film: xr.Dataset,
    rollers: RollerPair,
    spec: LineSpec,
    inlet_meniscus: float | None = None,
    is_heated: bool = False,
    threads: int = 1,
) -> xr.Dataset:
    """Compute the linear response of the film to waves of the roughness of either roller.

    Parameters
    ----------
    lubricant, rollers, inlet_meniscus
        As in `lube.stages.film.film_table`.
    film : xarray.Dataset
        A ``film`` dataset of these.
    spec : LineSpec
        The roughness lines, whose waves are asked for.
    is_heated : bool, optional
        Whether inlet shear heating thins the film; by default it does not.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The ``film_response`` file of `lube.schema`. Where the film did not converge, the response
        is NaN and the log says so.

    Notes
    -----
    At each operating point waves are solved for from the longest to the shortest, until the oil
    changes one by less than `UNCHANGED` anywhere. The response to shorter waves is 1. The error of
    interpolation is the root mean square over the contact, the larger of two wavelengths between
    those stored, on either side of the one at which the response is most curved.

    If heating thins the film, the steady film is that of an oil which is thinner at the inlet: so
    much that the central film is the thinned one.
    """
    levels = film[["force", "speed", "slide_to_roll_ratio"]].coords
    slips = levels["slide_to_roll_ratio"].values
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = hertz_contact(rollers, levels["force"], levels["speed"])
        groups = FilmGroups.at(lubricant, rollers, levels["force"], contact, inlet_meniscus)
        factor = film["inlet_shear_heating_factor"]
        solved = _thinned(groups, factor) if is_heated else groups.profiles()
    narrowest = contact["contact_half_width"].min().item()
    waves = wavelengths(spec, narrowest, SLIDING_RATIO if slips.any() else ROLLING_RATIO)
    rough = rollers.reduced_radius, rollers.composite_rms_roughness
    positions = film_positions(narrowest, *rough, *POSITIONS)
    names = ["slide_to_roll_ratio"] * is_heated + list(POINT_DIMS)
    solved = solved.transpose(*names)
    half_widths = contact["contact_half_width"].broadcast_like(solved).transpose(*names)
    speeds = np.array([surface_speeds(1.0, slip) for slip in slips])

    def at_point(index):
        one = solved.values[index]
        wanted = speeds[[index[0]]] if is_heated else speeds
        return _of_point(one, waves / half_widths.values[index], wanted, positions)

    with one_blas_thread():
        found = on_threads(at_point, np.ndindex(solved.shape), threads)
    responses, errors = (
        _over_grid(each, solved.shape, is_heated) for each in zip(*found, strict=True)
    )
    coordinates = {name: solved[name] for name in POINT_DIMS}
    coordinates |= {"slide_to_roll_ratio": slips, "roller": np.array(ROLLER_NUMBERS)}
    coordinates |= {"wavelength": waves, "film_position": positions}
    central = responses[..., np.searchsorted(positions, 0.0)]
    table = {
        "response_real": (_DIMS, responses.real),
        "response_imaginary": (_DIMS, responses.imag),
        "amplitude_ratio": (_DIMS[:-1], np.abs(central)),
        "interpolation_error": (_DIMS[:-2], errors),
        "contact_half_width": contact["contact_half_width"],
    }
    return label(xr.Dataset(table, coordinates), "film_response")


def wavelengths(spec: LineSpec, half_width: float, ratio: float) -> np.ndarray:
    """Wavelengths for which the response of the film is stored.

    Parameters
    ----------
    spec : LineSpec
        The roughness lines.
    half_width : float
        Half-width of the narrowest contact, m.
    ratio : float
        Largest ratio of neighbouring wavelengths.

    Returns
    -------
    numpy.ndarray
        From the lines' longest wave to `SHORTEST` of the half-width, or to the lines' shortest
        wave; m, falling, each by the same ratio.
    """
    longest = spec.longest_wavelength
    shortest = max(SHORTEST * half_width, 2.0 * np.pi / spec.q_max)
    count = int(np.ceil(np.log(longest / shortest) / np.log(ratio)))
    return np.geomspace(longest, shortest, count + 1)


def _thinned(groups, factor):
    """Films that heating thins: their central film is the heated one.

    The film is nearly a power of the viscosity at the inlet. The power is found from the film at
    two viscosities.
    """
    cold = groups.profiles()
    thinner = factor
    for _ in range(2):
        solved = replace(groups, speed=groups.speed * thinner).profiles()
        thinner = thinner ** (np.log(factor) / np.log(_central(solved) / _central(cold)))
    return replace(groups, speed=groups.speed * thinner).profiles()


def _central(solved):
    of_each = np.vectorize(lambda one: one.central_film if one else np.nan, otypes=[float])
    return xr.apply_ufunc(of_each, solved)


def _of_point(profile, wavelengths, speeds, positions):
    """Response over (slip, roller, wavelength, position), and its interpolation error."""
    shape = *speeds.shape, wavelengths.size, positions.size
    distinct, inverse = np.unique(speeds, return_inverse=True)
    response = np.ones((distinct.size, *shape[2:]), complex)
    if profile is None:
        return np.full(shape, np.nan + 0j), np.full(speeds.shape, np.nan)

    def solved(wavelength):
        wave = WaveResponse.of(profile, wavelength)
        return np.stack([wave.transfer(speed, positions) for speed in distinct])

    try:
        for number, wavelength in enumerate(wavelengths):
            if wavelength < SHORTEST:
                break
            response[:, number] = solved(wavelength)
            if np.abs(response[:, number] - 1.0).max() < UNCHANGED:
                break
        curvature = np.abs(np.diff(response, 2, axis=1)).max(axis=(0, 2))
        at = np.argmax(curvature) + 1
        between = np.sqrt(wavelengths[at - 1 : at + 1] * wavelengths[at : at + 2])
        estimated = at_wavelengths(between, wavelengths, response, positions)
        exact = np.stack([solved(each) for each in between], axis=1)
        inside = np.abs(positions) <= 1.0
        errors = np.abs(estimated - exact)[..., inside]
        errors = np.sqrt(np.mean(errors * errors, axis=-1)).max(axis=1)
    except ConvergenceError as error:
        log.warning("%s", error)
        return np.full(shape, np.nan + 0j), np.full(speeds.shape, np.nan)
    rounded = six_digits(response.real) + 1j * six_digits(response.imag)
    inverse = inverse.reshape(speeds.shape)
    return rounded[inverse], six_digits(errors)[inverse]


def _over_grid(found, shape, is_heated):
    """Results at each point, over slip and roller first, as one array over the grid."""
    found = np.array(found)
    found = found.reshape(*shape, *found.shape[1:])
    points = len(POINT_DIMS)
    if is_heated:  # each slip has its own films
        return np.moveaxis(np.squeeze(found, points + 1), points + 1, 1)
    return np.moveaxis(found, (points, points + 1), (0, 1))
