r"""The gauge by the surface: records read as contact anywhere along the rollers.

A resistance below the threshold shows that the rollers touch somewhere in the strip 2a x L'. A line
has no length along the rollers' axis, and the stage gauge reads each record as contact of such a
line. Here the same share is read as contact of the surface in the strip.
"""

from functools import cache

import numpy as np
import xarray as xr

from lube.grid.operating_points import at_slip
from lube.inference.record_curves import gauged_ratios
from lube.schema import AT_RECORDS, LIMITS, label, values_with_limits, with_dims
from lube.statistics.confidence import error_of_limits
from lube.statistics.curves import falling_curve
from lube.study.study import Study
from lube.types import Datasets

RESOLUTION = 1e-6
"""Probabilities closer than this to 0 or to 1 are not read."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``areal_gauge.nc``: the lambda ratio of each record by the surface, and by the line.

    The probability of contact in the strip at the operating points of one force is a curve over the
    lambda ratio. A record is read on the curve of the nearest contact width, scaled to its width:
    -ln(1 - p) is proportional to it, as contacts at different positions are nearly independent.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`.

    Returns
    -------
    xarray.Dataset
        The ``areal_gauge`` file of `lube.schema`. Values and limits are NaN, zero and infinity as
        in `lube.stages.gauge.gauge_film`. The 95 % intervals include the noise of the record, the
        error of the curve, and the scatter between pairs of rollers: that of ``areal.nc`` for a
        revolution of pure rolling, which other records change as they do for lines.
    """
    film, areal, comparison = (inputs[kind] for kind in ("film", "areal", "comparison"))
    curve = cache(lambda width: _curve(film, areal, width))
    widths, shares = (comparison[name].values for name in ("contact_half_width", "measured_share"))
    curves, levels, errors = zip(*(curve(2.0 * width) for width in widths), strict=True)
    of_curves = [np.interp(*one) for one in zip(shares, levels, errors, strict=True)]
    noise = np.hypot(comparison["share_error"].values, of_curves)
    ratios = gauged_ratios(curves, comparison, noise)
    line = [inputs["gauge"][f"gauged_lambda_ratio{limit}"].values for limit in LIMITS]
    values = {
        **values_with_limits("line_lambda_ratio", line),
        **values_with_limits("surface_lambda_ratio", ratios),
        "surface_over_line": ratios[0] / line[0],
        "lambda_ratio": comparison["lambda_ratio"].values[0],
    }
    kept = comparison[[*AT_RECORDS, "origin", "pairs", "drift", "measured_share"]].drop_attrs()
    return label(kept.assign(with_dims("areal_gauge", values)), "areal_gauge")


def _curve(film, areal, width):
    """Curve of the strip's probability at a contact width, its values, rising, and their errors."""
    widths = 2.0 * film["contact_half_width"].values
    nearest = np.argmin(np.abs(np.log(widths / width)))
    at_force = {"film_formula": 0, "force": nearest}
    strip = areal.isel(at_force | {"slide_to_roll_ratio": 0})
    film = at_slip(film, areal["slide_to_roll_ratio"].values[0])
    ratios = film["lambda_ratio"].isel(at_force).transpose(*strip["contacts"].dims).values.ravel()
    limits = [strip[f"breakthrough_probability{limit}"].values.ravel() for limit in LIMITS]
    # Logarithm of the probability of no contact, in a strip of this width.
    untouched = np.log1p(-np.minimum(limits, 1.0 - 1e-12)) * width / widths[nearest]
    found = -np.expm1(untouched[:, np.argsort(ratios)])
    # Strips that count as independent trials, in a revolution.
    trials = strip["breakthrough_probability"] * (1.0 - strip["breakthrough_probability"])
    trials = trials.where(trials > 0.0) / strip["pair_deviation"] ** 2 * widths[nearest] / width
    trials = np.nan_to_num(trials.values.ravel()[np.argsort(ratios)])
    curve = falling_curve(np.log(np.sort(ratios)), found[0], trials, RESOLUTION)
    rising = np.argsort(found[0])
    return curve, found[0][rising], error_of_limits(found)[rising]
