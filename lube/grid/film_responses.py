"""Responses of the film to waves of the roughness, over any operating conditions.

Roughness shifts the pressure spike. The linear response takes the shift as small compared with the
width of the spike. Roughness that may touch shifts it much further, so around a spike the response
is the mean of that to spikes at all of these places.
"""

import itertools
import logging
import math

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.ehl.line_contact import ConvergenceError, FilmProfile, one_blas_thread
from lube.ehl.response import WaveResponse, at_wavelengths
from lube.grid.film_profiles import film_positions
from lube.grid.operating_points import surface_speeds
from lube.surfaces.lay import stretched
from lube.surfaces.synthetic import amplitudes_across_lay, wave_amplitudes
from lube.threads import on_threads
from lube.types import Array, Datasets, Pair

log = logging.getLogger(__name__)

SHORTEST = 0.05
"""Shortest wave that is solved for, over the half-width of the contact."""
UNCHANGED = 0.003
"""Relative change of a wave by the oil below which it and all shorter waves count as unchanged."""
WAVE_RATIO, FINER_RATIO = 1.2, 1.15
"""Largest ratio of neighbouring wavelengths; the second for slide-to-roll ratios above 1. There the
response changes faster with the wavelength: the part of a wave that the oil carries through the
contact runs far ahead of the rough surface, or falls far behind it."""
POSITIONS = 0.02, 1.06
"""Spacing of positions near the contact, and ratio of neighbouring positions beyond."""
ANGLES = np.arange(0.0, 91.0, 15.0)
"""Angles between rolling and the direction of the waves of a surface, degrees. Between them the
response is interpolated to 0.4 % of the wave in pure rolling, and to 0.8 % with slip."""
SHIFT = 0.15
"""Rms shift of the pressure spike by the roughness, over its distance from the end of the film."""
LONG = 16.0
"""The shift is at most the length of a wave over this number, so that none is averaged away."""
DIRECTIONS, LENGTHS = 180, 1000
"""Directions and lengths among which the mean square height of a surface is distributed."""
VARIABLES = "response_real", "response_imaginary", "interpolation_error", "rms_deformation"
SURFACE_VARIABLES = [f"surface_{name}" for name in VARIABLES if name != "interpolation_error"]


def wave_responses(
    solved: xr.DataArray, contact: xr.Dataset, slide_to_roll_ratio, spec, threads=None
) -> xr.Dataset:
    """Compute the linear response of films to waves of the roughness of either roller.

    Parameters
    ----------
    solved : xarray.DataArray
        Elements are a `lube.ehl.line_contact.FilmProfile`, or None where there is no film.
    contact : xarray.Dataset
        With the variables from `lube.grid.films.hertz_contact`.
    slide_to_roll_ratio : xarray.DataArray
        Slide-to-roll ratio, over the dimension of this name or over those of the films.
    spec : lube.study.line_spec.LineSpec
        The roughness lines, which set the longest and the shortest wave.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        `VARIABLES` over the dimensions of the films and of the slide-to-roll ratio. The error is
        also over roller; the real and the imaginary part are also over roller, wavelength and
        response_position. All are NaN where the film is not known.

    Notes
    -----
    The wavelengths fall, each by the same ratio, from the lines' longest wave to `SHORTEST` of the
    narrowest contact's half-width, or to the lines' shortest wave. At each operating point waves
    are solved for from the longest to the shortest, until the oil changes one by less than
    `UNCHANGED` anywhere. The response to shorter waves is 1; in `rms_deformation` they count as
    changed as much as the shortest one that was solved for. The error of interpolation is a root
    mean square over the contact. It is found at two wavelengths for each surface speed, midway
    between the stored one at which the response in the contact is least smooth and its neighbours;
    the largest is stored.
    """
    response, error = _solved(solved, contact, slide_to_roll_ratio, spec, np.zeros(1), threads)
    deformation = _deformation(response, line_heights(spec, response["wavelength"].values))
    response, error = (each.isel(wave_angle=0, drop=True) for each in (response, error))
    values = response.real, response.imag, error, deformation
    return xr.Dataset(dict(zip(VARIABLES, values, strict=True)))


def surface_responses(
    solved: xr.DataArray, contact: xr.Dataset, slide_to_roll_ratio, spec, threads=None
) -> xr.Dataset:
    """Compute the linear response of films to waves of rough surfaces, which run at any angle.

    Parameters
    ----------
    solved, contact, slide_to_roll_ratio, spec, threads
        As in `wave_responses`; the wavelengths are the same.

    Returns
    -------
    xarray.Dataset
        `SURFACE_VARIABLES` over the dimensions of the films and of the slide-to-roll ratio; the
        real and the imaginary part also over roller, wave_angle (degrees, `ANGLES`), wavelength and
        response_position; NaN where the film is not known.
    """
    response, _ = _solved(solved, contact, slide_to_roll_ratio, spec, ANGLES, threads)
    heights = surface_heights(spec, response["wavelength"].values)
    values = response.real, response.imag, _deformation(response, heights)
    return xr.Dataset(dict(zip(SURFACE_VARIABLES, values, strict=True)))


def with_surface_responses(inputs: Datasets) -> xr.Dataset:
    """Return the film of a stage's inputs, with its responses to surfaces if they have these."""
    film = inputs["film"]
    if "surface_response" not in inputs:
        return film
    responses = inputs["surface_response"][SURFACE_VARIABLES]
    return film.assign(responses.rename(film_position="response_position"))


def _solved(solved, contact, slide_to_roll_ratio, spec, angles, threads):
    """Responses, and their interpolation errors over all of their dimensions but the last two."""
    widths, longest = contact["contact_half_width"], spec.longest_wavelength
    shortest = max(SHORTEST * widths.min().item(), spec.shortest_wavelength)
    ratio = FINER_RATIO if (np.abs(slide_to_roll_ratio) > 1.0).any() else WAVE_RATIO
    count = int(np.ceil(np.log(longest / shortest) / np.log(ratio)))
    waves = np.geomspace(longest, shortest, count + 1)
    positions = film_positions(contact, *POSITIONS)
    films, widths = xr.broadcast(solved, widths)
    slips = slide_to_roll_ratio.broadcast_like(films).transpose(*films.dims, ...)
    speeds = np.stack(surface_speeds(1.0, slips.values), axis=-1)

    def at_angle(item):
        at, angle = item
        return _of_film(films.values[at], waves / widths.values[at], speeds[at], positions, angle)

    items = itertools.product(np.ndindex(films.shape), angles)
    with one_blas_thread():
        found = on_threads(at_angle, items, threads, "response of the film")
    # Numbers of films and of angles come first, then those of slips and rollers.
    shape = *films.shape, angles.size, *speeds.shape[films.ndim :]
    response = np.reshape([each for each, _ in found], (*shape, waves.size, positions.size))
    response = np.ascontiguousarray(np.moveaxis(response, films.ndim, -3))
    error = np.moveaxis(np.reshape([each for _, each in found], shape), films.ndim, -1)
    levels = {"roller": [1, 2], "wave_angle": angles}
    error = xr.DataArray(error, {**slips.coords, **levels}, (*slips.dims, *levels))
    levels |= {"wavelength": waves, "response_position": positions}
    dims = *slips.dims, *levels
    return xr.DataArray(response, {**slips.coords, **levels}, dims), error


def _deformation(response, heights):
    """Rms change of surfaces by the oil, from the mean square heights of their waves."""
    inside = np.abs(response["response_position"]) <= 1.0
    square = np.mean(np.abs(response.values[..., inside] - 1.0) ** 2, axis=-1)
    solved = np.where(square > 0.0, np.arange(square.shape[-1]), 0)
    square = np.take_along_axis(square, np.maximum.accumulate(solved, axis=-1), axis=-1)
    rms = six_digits(np.sqrt(np.einsum("...raw,raw", square, heights)))
    one = response.isel(roller=0, wave_angle=0, wavelength=0, response_position=0, drop=True)
    return one.copy(data=rms)


def surface_heights(spec, wavelengths: Array) -> Array:
    """Distribute the mean square height of each surface over angles and wavelengths.

    Parameters
    ----------
    spec : lube.study.line_spec.LineSpec
        The lines that the surfaces stand behind.
    wavelengths : numpy.ndarray, shape (w,)
        Wavelengths, m, falling.

    Returns
    -------
    numpy.ndarray
        Shape (2, a, w), m^2, at `ANGLES`.
    """
    psi = np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    shares = []
    for roller, line in enumerate(spec.lines):
        length, power = line_waves(spec, roller, amplitudes_across_lay)
        power, edges = np.histogram(-np.log(length), LENGTHS, weights=power)
        # The waves of the isotropic surface run in all directions; see `lube.surfaces.lay`.
        along, across = stretched(1.0, psi, line.lay_ratio, line.lay_angle)
        angle = np.degrees(np.arctan2(np.abs(across), np.abs(along)))[:, None]
        places = 0.5 * (edges[1:] + edges[:-1]) + np.log(np.hypot(along, across))[:, None]
        shares.append(_spread(power, (angle, ANGLES), (places, -np.log(wavelengths))))
    return np.array(shares) / DIRECTIONS


def line_heights(spec, wavelengths: Array) -> Array:
    """Distribute the mean square height of each line as in `surface_heights`, at the angle 0."""
    both = (line_waves(spec, roller) for roller in (0, 1))
    shares = [_spread(power, (-np.log(length), -np.log(wavelengths))) for length, power in both]
    return np.array(shares)[:, None]


def line_waves(spec, roller: int, amplitudes_of=wave_amplitudes) -> Pair:
    """Lengths of the waves of a line, m, and their mean square heights, m^2."""
    first, amplitudes = amplitudes_of(spec, roller)
    length = spec.points[roller] * spec.spacing / (first + np.arange(amplitudes.size))
    return length, amplitudes**2 / 2.0


def _spread(power, *axes):
    """Distribute power at places among the nodes of each axis, as in linear interpolation."""
    shape, ends = [nodes.size for _, nodes in axes], []
    for places, nodes in axes:
        right = np.clip(np.searchsorted(nodes, places), 1, nodes.size - 1)
        part = np.clip((places - nodes[right - 1]) / (nodes[right] - nodes[right - 1]), 0.0, 1.0)
        ends.append([(right - 1, 1.0 - part), (right, part)])
    found = np.zeros(np.prod(shape))
    for corner in itertools.product(*ends):
        at, weights = zip(*corner, strict=True)
        each = np.broadcast_arrays(*at)
        weight = np.broadcast_to(math.prod(weights) * power, each[0].shape)
        number = np.ravel_multi_index([one.ravel() for one in each], shape)
        found += np.bincount(number, weight.ravel(), found.size)
    return found.reshape(shape)


def _of_film(profile, wavelengths, speeds, positions, angle):
    """Response over the speeds, wavelength and position, and its interpolation error."""
    shape = *speeds.shape, wavelengths.size, positions.size
    unknown = np.full(shape, np.nan + 0j), np.full(speeds.shape, np.nan)
    if profile is None:
        return unknown
    distinct, inverse = np.unique(speeds, return_inverse=True)
    inside = np.abs(positions) <= 1.0
    try:
        response = changed_waves(profile, wavelengths, distinct, positions, angle)
        between = _least_smooth(response[..., inside], wavelengths)
        exact = [_of_wave(profile, each, distinct, positions, angle) for each in between]
    except ConvergenceError as error:
        log.warning("%s", error)
        return unknown
    found = at_wavelengths(between, wavelengths, response, positions, angle)
    errors = np.abs(found - np.stack(exact, axis=1))[..., inside]
    errors = np.sqrt(np.mean(errors**2, axis=-1)).max(axis=1)
    inverse = inverse.reshape(speeds.shape)
    rounded = six_digits(response.real) + 1j * six_digits(response.imag)
    return rounded[inverse], six_digits(errors)[inverse]


def _least_smooth(response, wavelengths):
    """Wavelengths between those where the response at each speed is least smooth."""
    solved = max(np.count_nonzero(np.abs(response - 1.0).max(axis=(0, 2))), 3)
    order = min(4, solved - 1)  # the error of a cubic spline goes with the fourth derivative
    differences = np.diff(response[:, :solved], order, axis=1)
    middle = np.argmax(np.mean(np.abs(differences) ** 2, axis=-1), axis=1) + order // 2
    longer = np.unique([middle - 1, middle])
    return np.sqrt(wavelengths[longer] * wavelengths[longer + 1])


def changed_waves(
    profile: FilmProfile, wavelengths: Array, speeds: Array, positions: Array, angle: float = 0.0
) -> Array:
    """Response of a film to waves, solved for from the longest until the oil changes one no more.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers.
    wavelengths : numpy.ndarray, shape (w,)
        Wavelengths over the half-width, falling.
    speeds : numpy.ndarray, shape (s,)
        Surface speeds over the entrainment speed.
    positions : numpy.ndarray, shape (n,)
        Positions over the half-width.
    angle : float, optional
        Angle between rolling and the direction of the waves, degrees.

    Returns
    -------
    numpy.ndarray of complex, shape (s, w, n)
        1 for shorter waves.

    Raises
    ------
    ConvergenceError
        If the film does not converge on a finer mesh.
    """
    response = np.ones((len(speeds), wavelengths.size, positions.size), complex)
    for number, wavelength in enumerate(wavelengths[wavelengths >= SHORTEST]):
        response[:, number] = _of_wave(profile, wavelength, speeds, positions, angle)
        if np.abs(response[:, number] - 1.0).max() < UNCHANGED:
            break
    return response


def _of_wave(profile, wavelength, speeds, positions, angle):
    """Response to a wave at some speeds, a mean over shifted pressure spikes."""
    wave = WaveResponse(profile, wavelength, angle=angle)
    spike = profile.spike
    if np.isnan(spike):
        return np.stack([wave.transfer(speed, positions) for speed in speeds])
    shift = min(SHIFT * (profile.film_end - spike), wavelength / LONG)
    scaled, finer = (positions - spike) / shift, np.linspace(-5.0, 5.0, 201)
    near = np.abs(scaled) < 4.0
    # Farther from the spike the shift matters less and less, and is taken as smaller.
    width = np.sqrt(1.0 - (scaled[near, None] / 4.0) ** 2) + np.diff(finer)[0]
    likely = np.exp(-0.5 * ((scaled[near, None] - finer) / width) ** 2)
    likely /= likely.sum(axis=1, keepdims=True)
    wanted = np.append(positions, spike + shift * finer)
    found = np.stack([wave.transfer(speed, wanted) for speed in speeds])
    response, around = np.split(found, [positions.size], axis=1)
    response[:, near] = np.einsum("sf,pf->sp", around, likely)
    return response
