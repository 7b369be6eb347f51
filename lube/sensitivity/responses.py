"""Responses of the film to waves of the roughness, interpolated over Moes' numbers.

Every direct run has a film of its own, and to solve for its response as well would take seconds.
"""

from collections.abc import Iterable

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from lube.ehl.film_formulas import formula
from lube.ehl.response import at_wavelengths
from lube.grid.film_responses import (
    line_heights,
    surface_heights,
    surface_responses,
    wave_responses,
)
from lube.grid.films import FilmGroups
from lube.grid.levels import rolling
from lube.sensitivity.conditions import OIL, Deviating
from lube.sensitivity.samples import deviations, over_run
from lube.study.uncertainty import deviating_lines
from lube.types import Array

NUMBERS = ["moes_load", "moes_material"]
RATIOS = 1.35, 1.8
"""Largest ratios of neighbouring levels of M, and of L, with which responses change less."""
LEAST_LEVELS = 3
NAMES = {"line": "response", "surface": "surface_response"}
"""By contact model: name of the response in a film dataset."""
SOLVERS = {"line": wave_responses, "surface": surface_responses}
"""Functions that solve for it."""
HEIGHTS = {"line": line_heights, "surface": surface_heights}
"""Functions that distribute the mean square heights among the waves."""


def solve_responses(
    deviating: Deviating,
    contact_models: Iterable[str],
    unit: Array,
    points: xr.Dataset,
    threads: int | None = None,
) -> xr.Dataset:
    """Solve for the responses of films between the least and the greatest M and L of some runs.

    Parameters
    ----------
    deviating : Deviating
        The study, also for a typical oil.
    contact_models : iterable of str
        As in a study.
    unit, points
        The runs, as in `lube.sensitivity.runs.run`.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        Variables of `lube.grid.film_responses` over `NUMBERS` and their own dimensions, NaN where a
        film does not converge, and the half-width of the contact of their wavelengths.
    """
    values = over_run(deviations(deviating.factors, unit))
    films = [film for _, film in deviating.films(values, points)]
    numbers = np.concatenate([_numbers(film) for film in films], axis=1)
    levels = dict(zip(NUMBERS, map(_levels, numbers, RATIOS), strict=True))
    profiles = typical_films(deviating, **levels)
    widths = np.concatenate([np.ravel(film["contact_half_width"]) for film in films])
    half_width, ratio = np.nanmax(widths), np.nanmax(widths) / np.nanmin(widths)
    highest = max(film["composite_rms_roughness"].max().item() for film in films)
    contact = {
        "contact_half_width": half_width,
        "reduced_radius": deviating.study.rollers.reduced_radius,
        # Positions reach as far as the narrowest contact needs them.
        "composite_rms_roughness": ratio**2 * highest,
    }
    # Over the half-width, the longest wave is that in the narrowest contact.
    longer = float(np.max(values.get("longest_wavelength", 0.0)))
    shorter = float(np.min(values.get("shortest_wavelength", 0.0)))
    waves = {"longest_wavelength": ratio * (1.0 + longer) - 1.0, "shortest_wavelength": shorter}
    lines = deviating_lines(deviating.study.line_spec, waves)
    slips = np.unique(slips_of(deviating, points))
    slips = xr.DataArray(slips, {"slide_to_roll_ratio": slips}, ["slide_to_roll_ratio"])
    tables = [
        SOLVERS[name](profiles, xr.Dataset(contact), slips, lines, threads)
        for name in contact_models
    ]
    return xr.merge(tables, join="exact").assign(contact_half_width=half_width)


def with_responses(
    film: xr.Dataset, solved: xr.Dataset, contact_model: str, slips: Array
) -> xr.Dataset:
    """Add their responses to some films.

    Parameters
    ----------
    film : xarray.Dataset
        Films over run, as from `Deviating.films`.
    solved : xarray.Dataset
        From `solve_responses`.
    contact_model : str
        As in a study.
    slips : numpy.ndarray
        Slide-to-roll ratio of each run.

    Returns
    -------
    xarray.Dataset
        The films, with the variables that `lube.grid.films.film_at` adds.
    """
    table, known = response_table(solved, contact_model)
    numbers = zip(NUMBERS, _numbers(film), strict=True)
    weights = (_weights(table[name].values, each) for name, each in numbers)
    angles, position = table["wave_angle"].values, table["response_position"].values
    number = table["slide_to_roll_ratio"].values
    widths = film["contact_half_width"].broadcast_like(film["film_thickness"]).values
    found = []
    for *both, width, slip in zip(*weights, widths, slips, strict=True):
        response = np.einsum("m,l,ml...", *both, table.values[:, :, np.searchsorted(number, slip)])
        wanted = known * solved["contact_half_width"].item() / width
        each = zip(response.swapaxes(0, 1), angles, strict=True)
        by_angle = [at_wavelengths(wanted, known, one, position, angle) for one, angle in each]
        found.append(np.stack(by_angle, axis=1))
    like = table[0, 0, 0].drop_vars([*NUMBERS, "slide_to_roll_ratio"])
    found = like.expand_dims(run=slips.size).copy(data=np.stack(found))
    found = found.squeeze("wave_angle", drop=True) if contact_model == "line" else found
    name = NAMES[contact_model]
    return film.assign({f"{name}_real": found.real, f"{name}_imaginary": found.imag})


def response_table(solved: xr.Dataset, contact_model: str) -> tuple[xr.DataArray, Array]:
    """Return responses, and wavelengths over the half-width.

    The dimensions of the responses are M, L, slide-to-roll ratio, roller, angle (one for lines),
    wavelength and position.
    """
    name = NAMES[contact_model]
    table = solved[f"{name}_real"] + 1j * solved[f"{name}_imaginary"]
    if contact_model == "line":
        table = table.expand_dims(wave_angle=[0.0])
    names = "slide_to_roll_ratio", "roller", "wave_angle", "wavelength", "response_position"
    known = table["wavelength"].values / solved["contact_half_width"].item()
    return table.transpose(*NUMBERS, *names), known


def slips_of(deviating: Deviating, points: xr.Dataset) -> Array:
    """Return the slide-to-roll ratio of each run at some operating points."""
    own = xr.DataArray(rolling(deviating.study.slips))
    return points.get("slide_to_roll_ratio", own).broadcast_like(points["force"]).values


def _numbers(film):
    """M and L of the films of some runs, as heating at the inlet thins them; shape (2, runs)."""
    groups = FilmGroups.of(film)
    factor = film["inlet_shear_heating_factor"].clip(max=1.0 - 1e-9)

    def film_at(speed):
        return formula("moes").evaluate(groups.load, speed, groups.material)

    # Heating acts as a lower speed, at which the film is thinner by the factor.
    slower = factor
    for _ in range(2):
        thinner = film_at(slower * groups.speed) / film_at(groups.speed)
        slower = slower ** (np.log(factor) / np.log(thinner))
    numbers = film["moes_load"] / np.sqrt(slower), film["moes_material"] * slower**0.25
    return np.stack([np.ravel(each.broadcast_like(film["film_thickness"])) for each in numbers])


def _levels(values, ratio):
    """Choose levels of M or L between the least and the greatest value."""
    ends = np.nanmin(values) * 0.999, np.nanmax(values) * 1.001
    count = int(np.ceil(np.log(ends[1] / ends[0]) / np.log(ratio))) + 1
    return np.geomspace(*ends, max(count, LEAST_LEVELS))


def typical_films(deviating: Deviating, moes_load: Array, moes_material: Array) -> xr.DataArray:
    """Solve for the films of a typical oil of a study, at all levels of M and L.

    A film that does not converge is that of the next smaller M.
    """
    study, oil = deviating.study, np.exp(deviating.oils.isel(lubricant=0).median())
    modulus = 2.0 * study.rollers.reduced_modulus
    material = oil[OIL[1]] * modulus
    speed = 0.5 * (xr.DataArray(moes_material, dims="moes_material") / material) ** 4
    load = xr.DataArray(moes_load, dims="moes_load") * np.sqrt(2.0 * speed)
    meniscus = study.inlet_model["inlet_meniscus"]
    meniscus = meniscus and meniscus / study.rollers.reduced_radius
    groups = FilmGroups(load, speed, material, oil[OIL[0]], modulus, meniscus)
    films = groups.profiles.transpose(*NUMBERS)
    for (row, column), film in np.ndenumerate(films.values):
        films.values[row, column] = film or films.values[row - 1, column]
    return films.assign_coords(moes_load=moes_load, moes_material=moes_material)


def _weights(nodes, places):
    """Weights of values at nodes for a cubic spline through them over the logarithm."""
    spline = CubicSpline(np.log(nodes), np.eye(nodes.size))
    return spline(np.clip(np.log(places), *np.log(nodes[[0, -1]])))
