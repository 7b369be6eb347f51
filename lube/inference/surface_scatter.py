"""The scatter of a record's contact share between pairs of surfaces.

As for lines (`lube.inference.record_scatter`) it depends on how long a record is, on slip, and on
the rollers' sizes. Its parts follow from the theory of `lube.contact.pair_scatter`.
"""

import math

import numpy as np
import xarray as xr

from lube.contact.pair_scatter import RecurringContacts, persistent_part
from lube.contact.strip_film import StripFilm, surface_moments, surface_motion
from lube.contact.surface_strip import drawn_strips
from lube.grid.discretise import speed_ratios
from lube.statistics.one_pair import scatter_ratio
from lube.study.study import Study
from lube.types import Array


def surface_scatter(
    study: Study, experiment: xr.Dataset, films: xr.Dataset, shares: Array
) -> Array:
    """Find how far the share of each record scatters between pairs of surfaces.

    Parameters
    ----------
    study : Study
        Its rollers, roughness, film shape and drift.
    experiment : xarray.Dataset
        With the slide-to-roll ratio and the number of revolutions of each record.
    films : xarray.Dataset
        Films at the records by one film formula.
    shares : numpy.ndarray, shape (record,)
        Probability of breakthrough at the records.

    Returns
    -------
    numpy.ndarray, shape (record,)
        Variance of the record's share over that of one revolution of pure rolling of equal rollers;
        NaN where the film is not known. What the oil does to the surfaces has no effect on it.
    """
    moments = surface_moments(study.line_spec)
    rms = math.sqrt(moments.height)
    widths = films["film_thickness"], films["contact_half_width"]
    strips = drawn_strips(films, *widths, study.gap, rms)
    recurring = RecurringContacts(study.line_spec)
    records = zip(
        *(experiment[name].values.tolist() for name in ("slide_to_roll_ratio", "turns")),
        shares,
        strips,
        strict=True,
    )

    def of_record(slip, turns, share, strip):
        if strip is None or np.isnan(share):
            return np.nan
        thinnest = strip.films(strip.width / 100).min() / rms
        _, lags, common = strip.passage(moments, study.rollers.length)
        part = persistent_part(share, lags, common, recurring.at(thinnest))
        return _ratio(study, slip, turns, part, _shortened(study, strip, slip))

    return np.array([of_record(*record) for record in records])


def _shortened(study: Study, strip: StripFilm, slip: float) -> float:
    """Passage of a contact through the strip, over that in pure rolling."""
    if slip == 0.0:
        return 1.0
    spec = study.line_spec
    motion = surface_motion(spec, slip)
    return 1.0 / strip.appearing(surface_moments(spec), motion, study.rollers.length)


def _ratio(study, slip, turns, persistent, shortened):
    """Variance of the share of a record over that of one revolution of pure rolling."""
    spec, persistent = study.line_spec, min(persistent / shortened, 1.0)
    reach = spec.longest_wavelength / spec.spacing
    motion = speed_ratios(slip), spec.points, reach
    return shortened * scatter_ratio(turns, *motion, persistent, study.rig.drift)
