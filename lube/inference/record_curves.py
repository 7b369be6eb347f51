"""Curves of the breakthrough probability against the film, one for each record.

Where contact depends on the film thickness and the contact width alone, they are read from the
master map. Under a film with a shape, or on lines that the oil flattens or answers, a curve is made
for every record: the film at its conditions is made thinner and thicker, and contact is counted on
some of the study's realisations, or sampled where it is rare.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import scipy
import xarray as xr
from scipy.special import expit, logit

from lube.contact.ensemble import windows_at_records, windows_in
from lube.contact.rough_pair import drawn
from lube.contact.surface_strip import SURFACES
from lube.contact.windows import study_windows
from lube.grid.film_profiles import film_at_places
from lube.statistics.curves import Curve, film_interval, peaked_curve
from lube.statistics.sample_size import effective_sample_size
from lube.study.study import Study
from lube.threads import on_threads
from lube.types import Array, Pair

PROBABILITY = "breakthrough_probability"

FILMS = 13
"""Number of films of a record at which contact is counted or sampled."""
FINER = 4
"""Number of films of the curve for each of these, by interpolation."""
BEYOND = 0.3, 1.5
"""Thinnest film of the curves over the thinnest of all records, and thickest over the thickest."""
PAIRS = 8
"""Number of pairs of lines on which contact is counted or sampled."""
FREQUENT = 0.03
"""Lowest probability at which contact is counted, because sampling scatters more than counting."""
LAYER_FACTORS = np.array([1 / 8, 1 / 3, 1.0, 3.0, 8.0])
"""Strengths of the boundary layer, relative to the study's."""
LAYER_FILMS, LAYER_PAIRS = 5, 4
"""Numbers of films and of pairs of lines for boundary layers of other strengths."""
_LEAST = 1e-40
"""Probability up to which contact is taken as impossible."""


@dataclasses.dataclass(frozen=True)
class RecordCurves:
    """Curves of the breakthrough probability of the records of a comparison.

    Their films are the logarithms of the lambda ratio by the study's first film formula.

    Attributes
    ----------
    of_records : list of Curve
        The mean probability for each record.
    offsets : numpy.ndarray
        Shape (film_formula, record): logarithm of the lambda ratio that the first formula gives to
        a film, less the one that each formula gives to it. They differ for a film with a shape: one
        formula gives the film at the line of centres, another at the thinnest point.
    strengths : numpy.ndarray
        Strengths tau0 / h_c of boundary layers, Pa/m, rising.
    of_layers : list of list of Curve
        For each of these strengths the curves of all records, less exact than `of_records`.
    contact_model : str, optional
        Whether the contact is that of the ``line`` or of the ``surface``.
    """

    of_records: list[Curve]
    offsets: Array
    strengths: Array
    of_layers: list[list[Curve]]
    contact_model: str = "line"

    def logits(self, ratios: xr.DataArray) -> xr.DataArray:
        """Logits of the mean probability at films of the records.

        Parameters
        ----------
        ratios : xarray.DataArray
            Lambda ratios over film_formula, record and other dimensions.

        Returns
        -------
        xarray.DataArray
            Over the same dimensions, film_formula and record last.
        """
        return self._read(self.of_records, ratios)

    def layer_logits(self, ratios: xr.DataArray) -> xr.DataArray:
        """Logits of the mean probability with each of the `strengths` of the boundary layer.

        Parameters
        ----------
        ratios : xarray.DataArray
            As in `logits`.

        Returns
        -------
        xarray.DataArray
            Over layer_strength and the same dimensions.
        """
        rows = [self._read(curves, ratios) for curves in self.of_layers]
        strengths = xr.DataArray(self.strengths, dims="layer_strength", name="layer_strength")
        return xr.concat(rows, strengths, join="exact")

    def _read(self, curves, ratios):
        logits = np.log(ratios.transpose(..., "film_formula", "record"))
        films = logits.values + self.offsets
        for record, curve in enumerate(curves):
            logits.values[..., record] = curve.logit_at(films[..., record])
        return logits


# The master map


def map_curves(master: xr.Dataset, comparison: xr.Dataset) -> RecordCurves:
    """Curves of the master map at the contact widths of the records.

    Parameters
    ----------
    master, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    RecordCurves
        Records of one width have the same curve.
    """
    widths = 2.0 * comparison["contact_half_width"].values
    layers = master["layer_breakthrough_probability"].mean("realisation")
    layers = layers.transpose("layer_strength", ...)
    distinct, inverse = np.unique(widths, return_inverse=True)
    rows = ([curve_at(master, width, layer) for width in distinct] for layer in (None, *layers))
    of_records, *of_layers = ([row[number] for number in inverse] for row in rows)
    offsets = np.zeros(comparison["film_thickness"].shape[:-1] + widths.shape)
    return RecordCurves(of_records, offsets, master["layer_strength"].values, of_layers)


def curve_at(master: xr.Dataset, width: float, layer: xr.DataArray | None = None) -> Curve:
    """Curve of the mean breakthrough probability and of its effective sample size.

    If contacts occur independently along the line, -ln(1 - p) is proportional to the width, but
    for what the edges of the window cut off, which does not depend on it. So it is interpolated
    linearly between the map's widths, and beyond them it follows the straight line through its
    ends; in proportion if the map has one width.

    Parameters
    ----------
    master : xarray.Dataset
        A ``master`` dataset.
    width : float
        Contact width, m.
    layer : xarray.DataArray, optional
        Mean probability with another boundary layer, over layer_lambda_ratio and
        layer_contact_width; by default that of the study's layer.

    Returns
    -------
    Curve
        Against the logarithm of the lambda ratio. With another layer the sample size is unknown,
        NaN.
    """
    probability = master[f"{PROBABILITY}_mean"] if layer is None else layer
    ratios, widths = (probability[name].values for name in probability.dims)
    sample_size = np.full(ratios.size, np.nan)
    if layer is None:
        rows = effective_sample_size(master[PROBABILITY].values, windows_in(master, widths))
        sample_size = np.array([np.interp(width, widths, row) for row in rows])
    intensity = -np.log1p(-np.minimum(probability.values, 1.0 - 1e-12))
    nearest = np.clip(width, widths[0], widths[-1])
    here = np.array([np.interp(width, widths, row) for row in intensity]) * width / nearest
    if widths.size > 1:
        first, last = intensity[:, 0] * widths[-1], intensity[:, -1] * widths[0]
        at_edges = (first - last) / (widths[-1] - widths[0])
        here = np.maximum(here + at_edges * (1.0 - width / nearest), 0.0)
    resolution = 1.0 / (windows_in(master, width) * master.sizes["realisation"])
    return peaked_curve(np.log(ratios), -np.expm1(-here), sample_size, resolution)


# Curves at the films of the records


def own_curves(study: Study, comparison: xr.Dataset, threads: int | None = None) -> RecordCurves:
    """Curves over the films at the conditions of the records, made thinner and thicker.

    The shape of the film, and how much the oil flattens the lines, stay those of the record. Where
    contact is counted, on some of the study's realisations, the curve is shifted to the mean over
    all of them at the record's film; where it is sampled, towards this mean, by more the better the
    realisations determine it.

    Parameters
    ----------
    study : Study
        Its roughness lines, boundary layer and seed.
    comparison : xarray.Dataset
        A ``comparison`` dataset of the study.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    RecordCurves
        Over the films of all records, and some thinner and thicker ones.
    """
    first = comparison.isel(film_formula=0)
    ratios, layer = first["lambda_ratio"].values, study.boundary_layer
    some, inverse = study_windows(study, first).distinct()
    records = first.isel(record=some)
    films = np.geomspace(BEYOND[0] * np.nanmin(ratios), BEYOND[1] * np.nanmax(ratios), FILMS)
    (pairs,) = _on_pairs(study, records, films, [1.0], PAIRS, threads)
    curves = [
        _own_curve(films, pairs[..., number], records.isel(record=number), study.is_sampled)
        for number in range(records.sizes["record"])
    ]
    strengths, of_layers, few = [], [], films[:: (FILMS - 1) // (LAYER_FILMS - 1)]
    by_layer = _on_pairs(study, records, few, 1.0 / LAYER_FACTORS, LAYER_PAIRS, threads)
    for factor, pairs in zip(LAYER_FACTORS, by_layer, strict=True):
        row = [_through(few, mean, np.nan) for mean in pairs.mean(axis=0).T]
        if factor == 1.0 or any(curve.films.size for curve in row):  # others may never break
            strengths.append(factor * layer.strength)
            of_layers.append(row)
    of_records, *of_layers = ([row[number] for number in inverse] for row in (curves, *of_layers))
    offsets = curve_offsets(comparison, study.gap.has_shape)
    return RecordCurves(of_records, offsets, np.array(strengths), of_layers)


def curve_offsets(comparison: xr.Dataset, has_shape: bool) -> Array:
    """Compute the `offsets` of `RecordCurves`; ``has_shape`` says whether films have one."""
    if not has_shape:
        return np.zeros(comparison["film_thickness"].shape)
    films = np.log(film_at_places(comparison).transpose("film_formula", "record").values)
    return films[0] - films


def _on_pairs(study, records, films, weaker, pairs, threads):
    """Probability at films of each record, shape (layers, pairs, films, records)."""
    shape = len(weaker), films.size, records.sizes["record"]
    thickness = np.broadcast_to(films[:, None], shape) * records["composite_rms_roughness"].item()
    table = records.assign(film_thickness=(("layer", "film", "record"), thickness))
    windows = study_windows(study, table, np.repeat(weaker, thickness[0].size))
    is_rare = np.zeros(windows.size, bool)
    if study.is_sampled:
        is_rare = windows.sample(study.line_spec, study.seed, 0)[0][1] < FREQUENT

    def on_one_pair(number):
        shares = np.empty(windows.size)
        if is_rare.any():
            shares[is_rare] = windows[is_rare].sample(study.line_spec, study.seed, number)[0][1]
        if not is_rare.all():
            shares[~is_rare] = windows[~is_rare].count(drawn(study, number))[:, 1]
        return shares

    found = on_threads(on_one_pair, range(min(pairs, study.realisations)), threads)
    return np.moveaxis(np.reshape(found, (-1, *shape)), 1, 0)


def _own_curve(films, pairs, record, is_sampled):
    """Curve of one record, shifted to the mean over the realisations, or towards it."""
    realised, size = realised_shares(record)
    curve = _through(films, pairs.mean(axis=0), size)
    if len(pairs) == 1:  # the study has no other realisation
        return curve
    own = np.log(record["lambda_ratio"].item())
    here = curve.logit_at(own)
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = logit(realised.mean()) - here
        if is_sampled and realised.mean() < FREQUENT:
            # Variances of a logit are those of the probability over (p (1 - p))^2.
            mean, nearest = expit(here), np.argmin(np.abs(np.log(films) - own))
            of_pairs = pairs[:, nearest].var(ddof=1) / len(pairs) / (mean * (1.0 - mean)) ** 2
            of_realisations = 1.0 / (size * realised.size * mean * (1.0 - mean))
            shift *= of_pairs / (of_pairs + of_realisations)
    if not np.isfinite(shift):
        return curve
    return dataclasses.replace(curve, logits=curve.logits + shift)


def realised_shares(comparison: xr.Dataset) -> Pair:
    """Probabilities of the realisations at records, and the effective sample size of one."""
    probabilities = comparison[PROBABILITY].values
    return probabilities, effective_sample_size(probabilities, windows_at_records(comparison))


def _through(films, mean, sample_size):
    """Curve through probabilities at some films, interpolated between them.

    The logit is interpolated over the square of the film, in which it is nearly linear where the
    probability is small.
    """
    known = (mean > _LEAST) & (mean < 1.0)
    if np.count_nonzero(known) < 2:
        return Curve(*np.zeros((3, 0)))
    films, mean = films[known], mean[known]
    places = np.linspace(0.0, 1.0, FINER * (films.size - 1) + 1)
    finer = np.exp(np.interp(places, np.linspace(0.0, 1.0, films.size), np.log(films)))
    logits = scipy.interpolate.PchipInterpolator(films**2, logit(mean))(finer**2)
    return peaked_curve(np.log(finer), expit(logits), np.full(finer.size, sample_size), _LEAST)


def gauged_ratios(curves: Sequence[Curve], comparison: xr.Dataset, noise: Array) -> Array:
    """Lambda ratios that explain the contact shares of records.

    Parameters
    ----------
    curves : sequence of Curve
        Curve of each record.
    comparison : xarray.Dataset
        A ``comparison`` dataset of these records.
    noise : numpy.ndarray, shape (record,)
        Standard errors of the shares from causes other than the roughness.

    Returns
    -------
    numpy.ndarray, shape (3, record)
        Value, lower and upper limit. If a share lies beyond its curve, the value is NaN, and a
        limit is 0 or infinity.
    """
    shares, scatter = comparison["measured_share"].values, comparison["scatter_ratio"].values[0]
    realisations = comparison.sizes.get("realisation", SURFACES)
    films = [
        film_interval(curve, share, ratio, realisations, error)
        for curve, share, ratio, error in zip(curves, shares, scatter, noise, strict=True)
    ]
    ratios = np.exp(films).T
    ratios[0] = np.where(np.isfinite(films)[:, 0], ratios[0], np.nan)
    return ratios
