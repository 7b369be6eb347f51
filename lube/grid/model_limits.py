"""Operating points at which the model cannot hold, or where its answers are doubtful."""

import numpy as np
import xarray as xr

LARGEST_DEFORMATION = 0.1
"""Largest ratio of the rms change of the roughness by the oil to the film at which the linear
response counts as valid. High summits change by three times the rms, 0.3 of the film. Single waves
that change by more deviate from the linear response (Figure 35). Waves too short to be solved for
count as changed as much as the shortest that was."""
LARGEST_SHARE = 0.1
"""Largest share of the load on the surfaces' asperities at which the film of smooth rollers counts
as valid."""
SEPARATING_RATIO = 2.5
"""At this lambda ratio and above, the oil of a transient solution kept overlapping lines apart, by
more than the critical thickness of the boundary layer (Figure 35)."""


def overloaded(contact: xr.Dataset) -> xr.DataArray:
    """Find the points where asperities would carry more than the load: outside the model.

    Parameters
    ----------
    contact : xarray.Dataset
        The ``contact`` dataset.

    Returns
    -------
    xarray.DataArray
        Whether `contact_load_share` is above 1 on average over realisations.
    """
    return contact["contact_load_share"].mean("realisation") > 1.0


def merged(contact: xr.Dataset, film: xr.Dataset) -> xr.DataArray:
    """Find the points where breakthrough is rarer than at a thicker film.

    In the model the boundary layer of merged segments holds, as h_l grows with D^3/F (Eq. 6):
    although more of the lines is in contact, the layer breaks on fewer segments.

    Parameters
    ----------
    contact, film : xarray.Dataset
        The datasets of these names, with the same levels.

    Returns
    -------
    xarray.DataArray
        True where some thicker film, at the same force and so the same contact width, has more
        breakthrough on the same lines, by three standard errors of the mean or more, but no more
        geometric contact. False if there is only one realisation.
    """
    breakthrough = contact["breakthrough_probability"]
    geometric = contact["geometric_contact_probability_mean"]
    films, dims = film["film_thickness"].broadcast_like(geometric), ["temperature", "speed"]
    core = {"input_core_dims": [dims, ["realisation", *dims], dims], "output_core_dims": [dims]}
    options = core | {"vectorize": True, "join": "exact"}
    found = xr.apply_ufunc(_falls, films, breakthrough, geometric, **options)
    return found.transpose(*geometric.dims)


def _falls(film, breakthrough, geometric):
    """Compare every point of one contact width, by rows, with every other, by columns."""
    pairs = breakthrough.reshape(len(breakthrough), -1)
    if len(pairs) == 1:
        return np.zeros(film.shape, bool)
    here, there = film.ravel()[:, None], film.ravel()
    excess = pairs[:, None, :] - pairs[:, :, None]
    error = excess.std(axis=0, ddof=1) / len(pairs) ** 0.5
    touches = geometric.ravel()[:, None] >= geometric.ravel()
    falls = (there > here) & (excess.mean(axis=0) > 3.0 * error) & touches
    return falls.any(axis=1).reshape(film.shape)


def deformed(film: xr.Dataset, surfaces: xr.Dataset | None = None) -> xr.DataArray:
    """Find the points where the oil changes the roughness by too large a part of the film.

    The linear response to roughness is not valid there.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset.
    surfaces : xarray.Dataset, optional
        A ``tail`` dataset, for the points of surfaces; by default those of lines.

    Returns
    -------
    xarray.DataArray
        Whether `rms_deformation`, of surfaces `surface_rms_deformation`, is above
        `LARGEST_DEFORMATION` times the film. False where the film is not known, or the oil does not
        answer the roughness.
    """
    change = film.get("rms_deformation", 0.0)
    if surfaces is not None:
        change = surfaces.get("surface_rms_deformation", 0.0)
    return change > LARGEST_DEFORMATION * film["film_thickness"]


def separated(film: xr.Dataset) -> xr.DataArray:
    """Find the points where an isothermal Newtonian oil may keep lines apart that overlap.

    The linear response gives contact there, the nonlinear one was found to give none.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset.

    Returns
    -------
    xarray.DataArray
        Whether `lambda_ratio` is at least `SEPARATING_RATIO`. False where the film is not known, or
        the oil does not answer the roughness.
    """
    return (film["lambda_ratio"] >= SEPARATING_RATIO) & ("rms_deformation" in film)


def rubbing(film: xr.Dataset, part: float = LARGEST_SHARE) -> xr.DataArray:
    """Find the points where asperities of the surfaces carry much of the load.

    The film is that of smooth rollers, and less certain there.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset.
    part : float, optional
        Share of the load that is much.

    Returns
    -------
    xarray.DataArray
        Whether `surface_load_share` is above `part`; False where it is not known.
    """
    return film.get("surface_load_share", xr.zeros_like(film["film_thickness"])) > part


def doubts(
    film: xr.Dataset, surfaces: xr.Dataset | None = None, model: str = "line"
) -> dict[str, tuple[str, xr.DataArray]]:
    """Find the points where answers are doubtful, for the figures.

    Parameters
    ----------
    film, surfaces
        As in `deformed`.
    model : str, optional
        Contact model of the answers.

    Returns
    -------
    dict
        Marker and points by what is doubtful, as far as there are such points.
    """
    found = {
        "oil's response not linear": ("s", deformed(film, surfaces)),
        "asperities carry > 10 %": ("D", rubbing(film)),
        "oil may keep lines apart": ("*", separated(film) & (model == "line")),
    }
    return {words: each for words, each in found.items() if each[1].any()}


def with_load_share(records: xr.Dataset, film: xr.Dataset) -> xr.Dataset:
    """Add the share of the load on the surfaces' asperities at the study's levels, for `rubbing`.

    Parameters
    ----------
    records : xarray.Dataset
        A ``comparison`` dataset, at one film formula.
    film : xarray.Dataset
        The ``film`` dataset of the study.

    Returns
    -------
    xarray.Dataset
        With `surface_load_share`, if the film has it and the records have none of their own. NaN
        for records near no level.
    """
    name, slip = "surface_load_share", "slide_to_roll_ratio"
    if name in records or name not in film:
        return records
    near = {each: records[f"{each}_level"].variable for each in ("force", "speed", "temperature")}
    known = np.isfinite(list(near.values())).all(axis=0)
    near = {each: level.fillna(film[each].values[0]) for each, level in near.items()}
    near |= {slip: records[slip].variable} if slip in film[name].dims else {}
    formula = records["film_formula"].item()
    share = film[name].sel(lubricant=records["lubricant"].variable, film_formula=formula)
    share = share.sel(near, method="nearest").variable
    return records.assign({name: share.where(known)})
