"""The model at the conditions of each record.

The force, speed and temperature of a record need not be levels of the operating grid. The film
thickness there follows from the film formulas, and the probability from the study's realisations,
run at that film and contact width: nothing is rounded to the nearest level.
"""

import logging
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube.contact.ensemble import ATTRIBUTES
from lube.contact.rough_pair import drawn
from lube.contact.windows import study_windows
from lube.grid.films import film_with_oil
from lube.grid.operating_points import at_slip
from lube.inference.record_scatter import record_scatter
from lube.schema import FILES, OPERATING_DIMS, with_dims
from lube.study.oil_properties import lubricant_table
from lube.study.rollers import RollerPair
from lube.study.study import Study

Data = xr.Dataset

log = logging.getLogger(__name__)


def model_at_records(experiment: Data, film: Data, contact: Data, study: Study) -> Data:
    """Probability at the conditions of each record, and the scatter of one pair there.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    film, contact : xarray.Dataset
        The study's datasets of these kinds. Where they contain the film and contact width of a
        record, its probability in pure rolling is taken from them.
    study : Study
        Its oils, rollers, films, roughness lines, boundary layer and drift.

    Returns
    -------
    xarray.Dataset
        The variables and attributes of `study_films_at_records`; ``breakthrough_probability`` over
        (realisation, film_formula, record); and the results of
        `lube.inference.record_scatter.record_scatter` over the same dimensions, most without
        realisation.

        The probabilities are those of one revolution of pure rolling, with the film and its
        response to the roughness at the record's slip. Apart from these, slip does not change the
        expected probability, only the scatter of a record.
    """
    at_records = study_films_at_records(study, experiment)
    windows, stored = study_windows(study, at_records), _stored(study, film, contact)
    probability = _probability(windows, stored, contact.sizes["realisation"], study)
    shape = at_records.sizes["film_formula"], at_records.sizes["record"]
    scatter = record_scatter(at_records, experiment, probability, study)
    values = {"breakthrough_probability": probability, **scatter}
    values = {name: each.reshape(*each.shape[:-1], *shape) for name, each in values.items()}
    values["realisation"] = contact["realisation"].values
    return at_records.assign(with_dims("comparison", values))


def study_films_at_records(study: Study, experiment: xr.Dataset) -> xr.Dataset:
    """Film thickness at the conditions of each record by a study's films.

    Parameters
    ----------
    study : Study
        Its oils, rollers and films.
    experiment : xarray.Dataset
        An ``experiment`` dataset.

    Returns
    -------
    xarray.Dataset
        Of `film_at_records`, what the ``comparison`` file has; with the attributes ``travel`` and
        ``longest_wavelength``, both m, of one realisation.
    """
    oils = lubricant_table(study.lubricants, np.unique(experiment["temperature"]))
    table = film_at_records(
        experiment, oils, study.rough_rollers, study.film_formulas, **study.film_model
    )
    unused = [name for name in table if name not in FILES["comparison"]]
    unused += [] if study.gap.has_shape else ["formula_place"]
    attributes = {name: getattr(study.line_spec, name) for name in ATTRIBUTES}
    return table.drop_vars(unused).assign_attrs(attributes)


def film_at_records(
    experiment: xr.Dataset,
    lubricant: xr.Dataset,
    rollers: RollerPair,
    formulas: Sequence[str],
    **film_model: Any,
) -> xr.Dataset:
    """Film table at the conditions of each record, and the viscosity of the oil.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    lubricant : xarray.Dataset
        A ``lubricant`` dataset at all temperatures of the records.
    rollers, formulas, **film_model
        As in `lube.grid.films.film_at`, such as `Study.film_model`; the slip is that of each
        record.

    Returns
    -------
    xarray.Dataset
        Variables of `lube.grid.films.film_at` over film_formula and record, and
        ``dynamic_viscosity``; with a meniscus also its distance, with inlet shear heating its
        factor, with load sharing the asperities' share.
    """
    names = "force", "speed", "temperature", "lubricant", "slide_to_roll_ratio"
    columns = (xr.DataArray(experiment[name].values, dims="record") for name in names)
    force, speed, temperature, oil, slip = columns
    properties = lubricant.sel(lubricant=oil, temperature=temperature).reset_coords(drop=True)
    choices = film_model | {"slide_to_roll_ratio": slip}
    table = film_with_oil(properties, rollers, force, speed, formulas, **choices)
    if film_model.get("load_sharing", "none") == "none":
        table = table.drop_vars("surface_load_share", errors="ignore")
    return table.transpose("film_formula", "record", ...)


def _stored(study, film, contact):
    """Probability of every realisation at the points of contact.nc in pure rolling, by key."""
    if 0.0 not in contact["slide_to_roll_ratio"].values or contact["revolutions"].item() != 1:
        return {}
    film = at_slip(film, 0.0).transpose(*OPERATING_DIMS, ...)
    stored = contact["breakthrough_probability"].sel(slide_to_roll_ratio=0.0).values
    columns = stored.reshape(len(stored), -1).T
    return dict(zip(study_windows(study, film).keys, columns, strict=True))


def _probability(windows, stored, realisations, study):
    """Probability of every realisation in one revolution of pure rolling, shape (R, P)."""
    unknown = np.full(realisations, np.nan)
    values = np.array([stored.get(key, unknown) for key in windows.keys]).T
    missing = np.array([key not in stored for key in windows.keys])
    for realisation in range(realisations) if missing.any() else ():
        values[realisation, missing] = windows[missing].count(drawn(study, realisation))[:, 1]
        log.info("records: realisation %d of %d: done", realisation + 1, realisations)
    return values
