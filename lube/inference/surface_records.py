"""Contact of the surfaces at the conditions of each record, and curves of it against the film.

The resistance of a real rig falls where the rollers touch anywhere along their length. So a record
is compared with contact of the surfaces that the lines stand for, at the film of the
record, and its film is read from their probability at thinner and thicker films.
"""

import numpy as np
import scipy
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import curvature_moments, surface_moments
from lube.contact.strip_sampling import WITHOUT
from lube.contact.surface_strip import mean_breaking_curvature, strip_films, surface_contact
from lube.contact.windows import study_windows
from lube.grid.film_responses import SURFACE_VARIABLES, VARIABLES, with_surface_responses
from lube.inference.at_records import film_at_records
from lube.inference.record_curves import RecordCurves, curve_offsets
from lube.inference.surface_scatter import revolution_size, surface_scatter
from lube.physics.excursions import expected_contacts
from lube.physics.summits import sharp_surface_summit_share
from lube.schema import LIMITS, values_with_limits, with_dims
from lube.statistics.confidence import error_of_limits, jackknife_error
from lube.statistics.curves import contact_curve, log_groups_between
from lube.statistics.one_pair import quantile
from lube.study.oil_properties import lubricant_table
from lube.study.study import Study
from lube.types import Array, Datasets

CURVE_FILMS = 8
"""Number of films of a curve at which contact is sampled."""
CURVE_CONTACTS = 20.0, 1e-5
"""Contacts that theory expects in the strip under the thinnest and the thickest of these films."""
BREAKTHROUGHS = 3.0
"""Breakthroughs that it expects under the thinnest at least, or as many as under any film."""
RATIOS = np.geomspace(0.5, 20.0, 12)
"""Lambda ratios at which theory is asked for these."""
ANCHORED = 0.9999
"""Probability at the film of a record below which the number of contacts is known well enough to
correct the curve by it."""
STEEPEST = 2.0
"""Most by which a number of groups follows another: few surfaces may say more by chance."""
ANCHORINGS = 3
"""How often a curve is corrected, as it is interpolated between its films."""
LAYER_FILMS = [1, 3, 5]
"""Numbers of those of these films at which contact with other boundary layers is sampled."""
LAYER_SHARES = 0.9, 0.5, 0.2, 0.05
"""Fractions of summits that are sharp enough to break boundary layers of other strengths."""
FEWER, LAYER_FEWER = 3, 8
"""Surfaces drawn for the film of a record, for each one drawn for its curve, and for its curves of
other layers."""
_SLIP = "slide_to_roll_ratio"


def surfaces_at_records(
    study: Study, films: xr.Dataset, inputs: Datasets, threads: int | None = None
) -> xr.Dataset:
    """Probability of contact of the surfaces at the film of each record, and at other films.

    Parameters
    ----------
    study : Study
        Its surfaces, boundary layer, films and seed.
    films : xarray.Dataset
        Films at the records, from `lube.inference.at_records.study_films_at_records`.
    inputs : dict of str to xarray.Dataset
        The study's ``experiment``, ``film`` and ``areal``, and its ``surface_response`` if the oil
        answers the surfaces. Where these contain the film of a record, its probability is taken
        from them.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        ``breakthrough_probability`` with ``_lower`` and ``_upper`` over film_formula and record,
        and ``sample_size``, the effective sample size of one revolution of pure rolling: sampled
        for the first film formula, read from curves for the others. These curves are
        ``curve_probability`` and ``curve_sample_size`` over curve_lambda_ratio and record: the
        same for the film of the record, made thinner and thicker. The shape of the film, and how
        the oil deforms the surfaces, stay those of the record. ``layer_curve_probability``, over
        layer_strength, layer_lambda_ratio and record, is the same for other boundary layers, at
        fewer films and on fewer surfaces. And ``scatter_ratio`` from
        `lube.inference.surface_scatter.surface_scatter`.
    """
    experiment, first = inputs["experiment"], films.isel(film_formula=0)
    own, parts = _at_films(study, first, inputs, threads)
    own_ratios, rare = first["lambda_ratio"].values, (own[0] > 0.0) & (own[0] < ANCHORED)
    thinnest, thickest = _curve_range(study, first, parts)
    # Where most layers hold, they may break rarely under films that many contacts bridge.
    thinnest = np.min(own_ratios[rare], initial=thinnest)
    ratios, pair = np.geomspace(thinnest, thickest, CURVE_FILMS), RoughPair.of(study)
    thickness = xr.DataArray(ratios, dims="curve_film") * first["composite_rms_roughness"].item()
    strengths = _layer_strengths(pair, first, thickness.median())
    scatter, curves = np.empty(own.shape[1]), np.empty((4, ratios.size, own.shape[1]))
    of_layers = np.empty((strengths.size, len(LAYER_FILMS), own.shape[1]))
    slips, turns = (experiment[name].values for name in (_SLIP, "turns"))
    for records, some in parts:
        scatter[records] = surface_scatter(
            pair, some, own[0, records], slips[records], turns[records], study.rig.drift
        )
        some = some.assign(film_thickness=thickness * xr.ones_like(some["film_thickness"]))
        weaker = pair.layer.strength / strengths
        found, without, of_layers[..., records] = _curves(study, some, weaker, threads)
        logs = np.log(ratios), np.log(own_ratios[records])
        found[:3] = _anchored(found, without, own[:, records], *logs)
        curves[..., records] = found
    few = of_layers[strengths == pair.layer.strength]
    with np.errstate(divide="ignore", invalid="ignore"):  # no layer breaks
        factors = _groups(curves[0, LAYER_FILMS]) / _groups(few)
    of_layers = _with_groups(of_layers, factors)
    by_formula = _by_formula(own, np.log(ratios), curves, films, study.gap.has_shape)
    found = {
        "film_formula": films["film_formula"].values,
        "curve_lambda_ratio": ratios,
        **values_with_limits("breakthrough_probability", by_formula[:3]),
        "sample_size": by_formula[3],
        "scatter_ratio": scatter,
        **values_with_limits("curve_probability", curves[:3]),
        "curve_sample_size": curves[3],
        "layer_strength": strengths,
        "layer_lambda_ratio": ratios[LAYER_FILMS],
        "layer_curve_probability": of_layers,
        "record": experiment["record"].values,
    }
    return xr.Dataset(with_dims("surface_records", found))


def _at_films(study, first, inputs, threads):
    """Numbers as from `_numbers` at the films of records, and films of parts of the records."""
    grid, known = _on_grid(study, inputs)
    rows = {key: row for row, key in enumerate(study_windows(study, grid).keys)}
    row_of = np.array([rows.get(key, -1) for key in study_windows(study, first).keys], int)
    found, here = np.empty((4, row_of.size)), row_of >= 0
    found[:, here] = known[:, row_of[here]]
    others = _off_grid(study, inputs["experiment"].isel(record=~here), first.isel(record=~here))
    if others.sizes["record"]:
        found[:, ~here] = _numbers(study, _sampled(study, others, threads))
    parts = [(np.full(here.size, True), first)]
    if study.gap.is_answered:  # the responses of the film are over other wavelengths
        parts = [(here, grid.isel(record=row_of[here])), (~here, others)]
    return found, [part for part in parts if part[0].any()]


def _curves(study, films, weaker, threads):
    """Numbers as from `_numbers` at the films of curves, and probabilities with weaker layers.

    Between them are the numbers of groups of contacts without each of the surfaces.
    """
    found, few = _sampled(study, films, threads, FEWER), films.isel(curve_film=LAYER_FILMS)
    of_layers = [_sampled(study, few, threads, LAYER_FEWER, one) for one in weaker]
    shares = [one["breakthrough_probability"].values for one in of_layers]
    return _numbers(study, found), found[WITHOUT].values, shares


def _anchored(curves, without, own, log_ratios, log_own):
    """Curves with as many groups of contacts at the film of each record as were sampled there.

    A curve is sampled on the first of the same surfaces, so what it shows too much or too little
    there it shows at other films, too, as far as both scatter together between the surfaces. This
    corrects the error of interpolation as well. At the film of the record the curve is then as
    exact as the number sampled there. Numbers of groups that are not known within a factor of two,
    as where contact is nearly certain, correct nothing.
    """
    found, (own, lower, upper) = curves[:3].copy(), _groups(own[:3])
    known = (own > 0.0) & (own < _groups(ANCHORED)) & (upper < 2.0 * lower)
    for record in np.flatnonzero(known):
        slope, rest = _together(without[..., record], log_ratios, log_own[record])
        factor = 1.0
        for _ in range(ANCHORINGS):
            groups = _groups(_with_groups(curves[0, :, record], factor))
            some = (groups > 0.0) & np.isfinite(groups)
            if np.count_nonzero(some) < 2:
                break
            read = log_groups_between(log_ratios[some], np.log(groups[some]), log_own[record])
            factor = factor * (own[record] / np.exp(read)) ** slope
        found[..., record] = _with_groups(found[..., record], factor)
        of_own = 0.5 * slope * np.log(upper[record] / lower[record])
        times = np.exp(np.hypot(of_own, quantile(len(without) - 1) * rest))
        for row, one in ((1, 1.0 / times), (2, times)):
            limit = _with_groups(found[0, :, record], one)
            found[row, :, record] = np.where(np.isfinite(times), limit, found[row, :, record])
    return found


def _together(without, log_ratios, log_own):
    """How far the number of groups at each film follows that at another, and the error of the rest.

    Both are of logarithms of the numbers. `without` has the numbers without each of the surfaces.
    Where a number is 0, it is taken to follow one to one, and the error is not known.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = np.log(without)
        there = np.array([[np.interp(log_own, log_ratios, one)] for one in logs])
        away = there - there.mean()
        slope = np.sum(away * logs, axis=0) / np.sum(away**2)
        slope = np.clip(np.where(np.isfinite(slope), slope, 1.0), 0.0, STEEPEST)
        # The slope takes a degree of freedom.
        wider = np.sqrt((len(logs) - 1) / (len(logs) - 2))
        return slope, wider * jackknife_error(logs - slope * there)


def _with_groups(shares, factors):
    """Probabilities of some times as many groups of contacts; the same where this is not known."""
    with np.errstate(invalid="ignore"):
        return np.where(np.isfinite(factors), -np.expm1(-factors * _groups(shares)), shares)


def _groups(shares):
    with np.errstate(divide="ignore"):  # a probability of 1
        return -np.log1p(-shares)


def _by_formula(own, log_ratios, curves, films, has_shape):
    """Numbers as from `_numbers` by every film formula: by the others, read from the curves."""
    others = np.log(films["lambda_ratio"].transpose("film_formula", "record").values)
    others = (others + curve_offsets(films, has_shape))[1:]
    found = np.empty((4, *others.shape))
    for record, films in enumerate(others.T):
        mean, *_, sizes = curves[..., record]
        curve = contact_curve(log_ratios, mean, sizes)
        share = scipy.special.expit(curve.logit_at(films))
        for row, each in enumerate(curves[:3, :, record]):
            # A limit is as far from the mean as at the films of the curve, in parts of it.
            parts = np.divide(each, mean, out=np.ones_like(mean), where=mean > 0.0)
            found[row, :, record] = np.minimum(share * np.interp(films, log_ratios, parts), 1.0)
        found[3, :, record] = np.interp(films, log_ratios, sizes)
    return np.concatenate([own[:, None], found], axis=1)


def _on_grid(study, inputs):
    """Films of the operating points as of records, and numbers as from `_numbers`."""
    both = with_surface_responses(inputs), inputs["areal"]
    film, areal = (each.isel(film_formula=0) for each in both)
    if _SLIP not in film["film_thickness"].dims:
        areal = areal.sel({_SLIP: 0.0}, method="nearest")
    points = {"record": film["film_thickness"].dims}
    film, areal = (each.stack(points, create_index=False) for each in (film, areal))
    return film, _numbers(study, areal)


def _off_grid(study, experiment, first):
    """Films of records; where the oil answers the surfaces, with its responses."""
    if not (study.gap.is_answered and first.sizes["record"]):
        return first
    some, inverse = study_windows(study, first).distinct()
    choices = study.film_model | {"answered_surfaces": study.line_spec}
    experiment = experiment.isel(record=some)
    oils = lubricant_table(study.lubricants, np.unique(experiment["temperature"]))
    formulas = study.film_formulas[:1]
    table = film_at_records(experiment, oils, study.rough_rollers, formulas, **choices)
    responses = table[[*VARIABLES, *SURFACE_VARIABLES]].isel(record=inverse)
    return first.drop_dims(["wavelength", "response_position"]).assign(responses)


def _sampled(study, films, threads, fewer=1, weaker=1.0):
    """Contact of the surfaces, sampled once for all records that have the same."""
    one_film = films.isel(curve_film=0, missing_dims="ignore")
    some, inverse = study_windows(study, one_film).distinct()
    choices = {"fewer": fewer, "weaker": weaker, "left_out": True}
    found = surface_contact(RoughPair.of(study), films.isel(record=some), threads, **choices)
    return found.transpose(..., "record").isel(record=inverse)


def _numbers(study, contact):
    """Probability, its limits, and effective sample size of a revolution, shape (4, ...)."""
    limits = [contact[f"breakthrough_probability{end}"].values for end in LIMITS]
    return np.stack([*limits, revolution_size(study.line_spec, contact)])


def _curve_range(study, first, parts):
    """Least and largest lambda ratio of the curves by theory, of the records furthest apart.

    Under uneven films, and where the oil answers the surfaces, each record has its own contacts.
    """
    ends = np.concatenate([_curve_ends(study, films) for _, films in parts])
    broken = np.min(ends[:, 2], initial=np.inf)
    if study.gap.is_plain:
        moments, ratios = surface_moments(study.line_spec), np.geomspace(1.0, 20.0, 400)
        films = ratios * first["composite_rms_roughness"].item()
        width = 2.0 * first["contact_half_width"].mean().item()
        contacts = expected_contacts(films, moments, study.rollers.length, width)
        thinnest, thickest = np.interp(-np.log(CURVE_CONTACTS), -np.log(contacts), ratios)
        return min(thinnest, broken), thickest
    return min(ends[:, 0].min(), broken), ends[:, 1].max()


def _curve_ends(study, films):
    """Find the ends of a curve for each distinct record, shape (records, 3), lambda ratios.

    Between the first two theory expects `CURVE_CONTACTS`. At the third it expects `BREAKTHROUGHS`,
    or the most there are.
    """
    pair, ends, (some, _) = RoughPair.of(study), [], study_windows(study, films).distinct()
    films = films.isel(record=some)
    sharp, strips = mean_breaking_curvature(pair, films), strip_films(pair, films)
    for strip, own in zip(strips, films["lambda_ratio"].values, strict=True):
        if strip is not None:
            changed = [strip.thicker(ratio / own) for ratio in RATIOS]
            each = [one.expected(pair.spec, pair.length, sharp) for one in changed]
            contacts, broken = np.transpose(each)
            most = _ratios_with(broken, min(BREAKTHROUGHS, broken.max()))
            ends.append([*_ratios_with(contacts, CURVE_CONTACTS), most])
    return np.reshape(ends, (-1, 3))


def _ratios_with(each, numbers):
    """Largest lambda ratios with some numbers of contacts, from those at `RATIOS`."""
    # Below the film with the most contacts these merge. The logarithm of rare ones is nearly linear
    # in the square of the ratio.
    first = int(np.argmax(each))
    with np.errstate(divide="ignore"):
        logs = np.log(np.maximum.accumulate(each[::-1])[::-1][first:])
        squares = np.interp(-np.log(numbers), -logs, RATIOS[first:] ** 2)
    return np.sqrt(squares)


def _layer_strengths(pair, films, level):
    """Strengths of boundary layers, Pa/m, rising: the pair's, and those that some summits break."""
    factors = np.geomspace(1e-3, 1e3, 400)
    sharp = mean_breaking_curvature(pair, films) * factors
    levels, moments = np.full(sharp.size, level.item()), surface_moments(pair.spec)
    shares = sharp_surface_summit_share(levels, moments, sharp, curvature_moments(pair.spec))
    others = np.exp(np.interp(np.negative(LAYER_SHARES), -shares, np.log(factors)))
    return pair.layer.strength * np.unique([1.0, *others])


def surface_curves(surfaces: xr.Dataset, comparison: xr.Dataset, has_shape: bool) -> RecordCurves:
    """Curves of contact of the surfaces at records.

    Parameters
    ----------
    surfaces : xarray.Dataset
        A ``surface_records`` dataset.
    comparison : xarray.Dataset
        The ``comparison`` dataset of the same records.
    has_shape : bool
        Whether films have the computed shape.

    Returns
    -------
    RecordCurves
        Those of other boundary layers are less exact, and without sample sizes.
    """
    films = np.log(surfaces["curve_lambda_ratio"].values)
    columns = (surfaces[f"curve_{name}"].values.T for name in ("probability", "sample_size"))
    of_records = [contact_curve(films, *of_record) for of_record in zip(*columns, strict=True)]
    few, layers = np.log(surfaces["layer_lambda_ratio"].values), surfaces["layer_curve_probability"]
    unknown = np.full(few.size, np.nan)
    of_layers = [[contact_curve(few, one, unknown) for one in layer.T] for layer in layers.values]
    offsets, strengths = curve_offsets(comparison, has_shape), surfaces["layer_strength"].values
    return RecordCurves(of_records, offsets, strengths, of_layers, "surface")


def reading_errors(surfaces: xr.Dataset, shares: Array) -> Array:
    """Find the errors of the curves where they have the shares of the records.

    Parameters
    ----------
    surfaces : xarray.Dataset
        As in `surface_curves`.
    shares : numpy.ndarray, shape (record,)
        Contact shares of the records.

    Returns
    -------
    numpy.ndarray, shape (record,)
        Standard errors of the probability.
    """
    films = np.log(surfaces["curve_lambda_ratio"].values)
    limits = [surfaces[f"curve_probability{end}"].values.T for end in LIMITS]
    sizes, errors = surfaces["curve_sample_size"].values.T, error_of_limits(limits)
    rows = zip(shares, limits[0], sizes, errors, strict=True)
    return np.array([_error_at(films, *row) for row in rows])


def _error_at(films, share, probabilities, sizes, errors):
    """Error of a curve at the film that it gives for a share, or at the end of it."""
    film = contact_curve(films, probabilities, sizes).film_at(share)
    return np.interp(film, films, errors) if not np.isnan(film) else np.nan
