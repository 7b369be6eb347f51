"""The tail stage: probability and rate of contact at any rarity, at all operating points."""

import numpy as np
import scipy.special
import xarray as xr

from lube.contact.ensemble import PROBABILITIES
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import mean_breaking_curvature
from lube.contact.windows import FLATTENED, ContactWindows
from lube.errors import StudyError
from lube.grid.film_profiles import shaped_films
from lube.grid.gap import Gap
from lube.grid.operating_points import over_contact_models, surface_speeds
from lube.physics.excursions import crossing_rate
from lube.physics.summits import sharp_summit_share
from lube.schema import FILES, LIMITS, OPERATING_DIMS, POINT_DIMS, label, values_with_limits
from lube.statistics.confidence import breakthrough_limit, jackknife_interval, mean_interval
from lube.statistics.sample_size import independent_windows
from lube.study.line_spec import LineSpec
from lube.study.study import Study
from lube.surfaces.rare_contact import WINDOWS, check_gaussian
from lube.surfaces.spectra import pair_moments
from lube.threads import on_threads
from lube.types import Datasets

PAIRS = 40
"""Number of pairs of lines for the first film formula, enough for a relative standard error of 2 %;
errors follow from the scatter between them."""
FEWER_PAIRS = 8
"""The first of these pairs, used for the other film formulas."""
_SLIP = "slide_to_roll_ratio"
_ASYMPTOTES = "geometric_contact_asymptote", "breakthrough_asymptote"


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    r"""Make ``tail.nc``: probability and rate of contact at any rarity.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`.

    Returns
    -------
    xarray.Dataset
        The ``tail`` file of `lube.schema`. Its attribute ``remarks`` is that of `why_counted`; if
        it is not empty, all values are NaN. In
        uneven windows and on surfaces the fraction of pairs with a breakthrough and the time to the
        first one are estimated from the probability and the duration of a breakthrough. The theory
        for high films holds for lines as drawn.

    Notes
    -----
    At equal film thickness the probabilities do not depend on slip, in expectation: the lines are
    stationary and independent, so every alignment is as good as another. Slip changes how many
    contacts there are, and how long they last; the film, where inlet shear heating thins it; and
    the answer of the oil to the roughness, if that is computed.

    A *breakthrough* is counted where the boundary layer breaks on an uncut run of touching points,
    not on a piece that the window's edge cuts off. There are :math:`\nu` breakthroughs per point of
    the line, and in each relative step of one point :math:`\beta` new ones appear in a window. At
    the entrainment speed v the rate of breakthroughs in the window is

    .. math:: \frac{v}{\Delta x} (\nu + |S|\, \beta)

    In uneven windows a run may break and hold several times on its way through the window. All of
    this is one breakthrough, as long as the points of the run touch without a pause. Where such a
    window has edges, as under a flat film on lines that the oil answers, pieces that they cut off
    count, too.

    The mean number in the window, divided by this rate, is the mean duration.

    In pure rolling, equal rollers repeat themselves. Groups of breakthroughs a longest wavelength
    apart are rare and independent, so where :math:`\mu` of them are expected in a revolution, the
    fraction of pairs with any is :math:`1 - e^{-\mu}`.
    """
    film = inputs["film"].transpose("film_formula", *POINT_DIMS, ...)
    remark = why_counted(study.line_spec, study.gap)
    if remark or not study.line_spec.follows_rolling:
        table = _unknown(film, np.asarray(study.slips, float))
    else:
        table = _on_lines(study, film, threads)
    if study.has_surfaces and not remark:
        table = _by_model(study, film, table, inputs["areal"])
    return label(table.assign_attrs(remarks=remark), "tail")


def _on_lines(study, film, threads):
    """Variables of lines, unlabelled."""
    pair, levels = RoughPair.of(study), np.asarray(study.slips, float)
    if _SLIP in film["film_thickness"].dims:
        film = film.sel({_SLIP: levels})
    tables = []
    for formulas, pairs in (slice(1), PAIRS), (slice(1, None), FEWER_PAIRS):
        some = film.isel(film_formula=formulas)
        if some["film_formula"].size:
            found = _sampled(pair, some, levels, pairs, threads)
            tables.append(_table(pair, some, *found, levels))
    table = xr.concat(tables, "film_formula", data_vars="minimal", coords="minimal", join="exact")
    coordinates = {name: film[name] for name in OPERATING_DIMS}
    return table.assign_coords(coordinates).transpose(_SLIP, *OPERATING_DIMS)


def _by_model(study, film, lines, areal):
    """Variables of lines and of surfaces over contact_model; the theory is for lines."""
    known = _on_surfaces(study, film["entrainment_speed"], areal.drop_attrs())
    surfaces = {name: known[name].transpose(*lines[name].dims) for name in known}
    tables = {"line": lines, "surface": lines.assign(surfaces)}
    found = over_contact_models("tail", {name: tables[name] for name in study.contact_model})
    if study.gap.is_answered:
        found["surface_rms_deformation"] = areal["surface_rms_deformation"]
    return found.assign(surface_pair_deviation=_in_pure_rolling(areal["pair_deviation"]))


def _on_surfaces(study, speed, areal):
    """Variables of surfaces."""
    perimeter = study.line_spec.points[0] * study.line_spec.spacing
    table = {f"{name}{end}": areal[f"{name}{end}"] for name in PROBABILITIES for end in LIMITS}
    table |= surface_rates(areal, speed)
    turn = _turn(perimeter, speed, areal[_SLIP])
    table["breakthroughs_per_revolution"] = table["breakthrough_rate"] * turn
    areal = _in_pure_rolling(areal)
    passages = perimeter / areal["passage_width"]
    return xr.Dataset(table | _by_groups(areal, passages, perimeter / speed))


def _turn(perimeter, speed, slip):
    """Time of a revolution of the first roller; NaN if it stands still."""
    first, _ = surface_speeds(speed, slip)
    return perimeter / first.where(first > 0.0)


def surface_rates(surfaces: xr.Dataset, speed: xr.DataArray) -> dict[str, xr.DataArray]:
    """Compute the rate of breakthroughs on surfaces, and their mean duration.

    A breakthrough is counted once, from where the layer of a contact breaks to where it holds
    again, or the contact disappears.

    Parameters
    ----------
    surfaces : xarray.Dataset
        From `lube.contact.surface_strip.surface_contact`.
    speed : xarray.DataArray
        Entrainment speed, m/s.

    Returns
    -------
    dict of str to xarray.DataArray
        ``breakthrough_rate`` (1/s) with ``_lower`` and ``_upper``, and ``breakthrough_duration``
        (s).
    """
    width = surfaces["breakthrough_width"]
    rates = (surfaces[f"breakthroughs{end}"] * speed / width for end in LIMITS)
    found = values_with_limits("breakthrough_rate", rates)
    return found | {"breakthrough_duration": width / speed}


def _by_groups(found, passages, revolution):
    r"""Fraction of pairs with a breakthrough in a revolution, and time to the first, estimated.

    Groups of breakthroughs come independently of one another: of those that a revolution has,
    :math:`-\ln(1 - P)` are in the window on average, each for the time of one passage or, in an
    uneven window, for the duration of a breakthrough. On lines under flat films, where groups are
    sampled one by one, this gives 2 to 11 % too many of them where P is below 0.001; where it is
    greater, nearly all pairs have a breakthrough anyway.
    """
    groups = _seen_groups(found, passages)
    # The more groups there are, the sooner comes the first.
    ends = LIMITS[0], LIMITS[2], LIMITS[1]
    never = (1.0 - found[f"breakthrough_probability{end}"] for end in ends)
    times = [revolution * one * _wait(groups[end]) for one, end in zip(never, ends, strict=True)]
    times = [each.where(found["breakthrough_probability"] > 0.0) for each in times]
    return _pair_shares(groups) | values_with_limits("first_breakthrough_time", times)


def _seen_groups(found, windows):
    """Find how many groups of breakthroughs are expected in some independent windows."""
    probability = {end: found[f"breakthrough_probability{end}"] for end in LIMITS}
    with np.errstate(divide="ignore"):  # infinitely many where contact is always seen
        return {end: -windows * np.log1p(-each) for end, each in probability.items()}


def _pair_shares(groups):
    """Fraction of pairs with any of the groups expected in a revolution."""
    return {f"touching_pair_share{end}": -np.expm1(-each) for end, each in groups.items()}


def pair_probabilities(
    pair: RoughPair, film: xr.Dataset, slide_to_roll_ratio: xr.DataArray | float
) -> xr.Dataset:
    """Compute probabilities and rate of contact on each pair of lines, on all processors.

    Parameters
    ----------
    pair : RoughPair
        The rollers, of which other pairs are drawn, too.
    film : xarray.Dataset
        ``film_thickness``, ``contact_half_width`` (m) and ``entrainment_speed`` (m/s) over any
        dimensions, and ``reduced_modulus`` (Pa).
    slide_to_roll_ratio : xarray.DataArray or float
        Over the same dimensions.

    Returns
    -------
    xarray.Dataset
        ``breakthrough_probability``, ``geometric_contact_probability`` and ``breakthrough_rate``
        (1/s) over pair and those dimensions. All operating points have the same pairs, so a
        quantity of several points is first computed on each pair. The attribute ``remarks`` is as
        in ``tail.nc``.
    """
    if remark := why_counted(pair.spec, pair.gap):
        unknown = xr.full_like(film["film_thickness"], np.nan).expand_dims(pair=2)
        names = *PROBABILITIES, "breakthrough_rate"
        return xr.Dataset(dict.fromkeys(names, unknown), attrs={"remarks": remark})
    table, runs = _sampled(pair, film, slide_to_roll_ratio, PAIRS)
    table["breakthrough_rate"] = _in_time(pair, film, runs, slide_to_roll_ratio)[1]
    return table.assign_attrs(remarks="").transpose("pair", *film["film_thickness"].dims)


def pair_limits(values: xr.Dataset) -> xr.Dataset:
    """Mean over pairs of lines and its 95 % interval.

    Parameters
    ----------
    values : xarray.Dataset
        Variables of `pair_probabilities`.

    Returns
    -------
    xarray.Dataset
        Each variable without pair, and its ``_lower`` and ``_upper``. A rate is NaN where there are
        breakthroughs, but the beginning of none was sampled.
    """
    limited = {}
    for name, of_pairs in values.items():
        of_pairs = of_pairs.transpose("pair", ...)
        most = 1.0 if name.endswith("probability") else np.inf
        limits = mean_interval(of_pairs.values, most)
        limited |= values_with_limits(name, [of_pairs[0].copy(data=limit) for limit in limits])
    limits = xr.Dataset(limited, attrs=values.attrs)
    breakthrough, contact = (limits[f"{name}_upper"] for name in PROBABILITIES)
    most = breakthrough_limit(breakthrough, contact, WINDOWS * values.sizes["pair"])
    known = (limits["breakthrough_probability"] == 0.0) | (limits.get("breakthrough_rate", 1.0) > 0)
    changed = {name: each.where(known) for name, each in limits.items() if "_rate" in name}
    changed["breakthrough_probability_upper"] = breakthrough.copy(data=most)
    return limits.assign(changed)


def why_counted(spec: LineSpec, gap: Gap) -> str:
    """Say why contact of lines is counted alone, and not sampled at any rarity.

    Parameters
    ----------
    spec : LineSpec
        The lines.
    gap : Gap
        How film and roughness make up the gap.

    Returns
    -------
    str
        One line; empty if contact can be sampled.
    """
    try:
        check_gaussian(spec)
    except StudyError as error:
        reason = str(error)
    else:
        reason = FLATTENED if gap.is_flattened else ""
    return reason and f"contact is counted in realisations, not sampled: {reason}"


def _unknown(film, slide_to_roll_ratio):
    """Table without any value."""
    levels = {name: film[name] for name in OPERATING_DIMS} | {_SLIP: slide_to_roll_ratio}
    empty = {
        name: xr.DataArray(np.nan, {dim: levels[dim] for dim in row.dims}, row.dims)
        for name, row in FILES["tail"].items()
        if not row.optional
    }
    return xr.Dataset(empty)


def _table(pair, film, of_pairs, runs, slide_to_roll_ratio):
    """Variables of some film formulas, unlabelled."""
    spec, slip = pair.spec, xr.DataArray(slide_to_roll_ratio, {_SLIP: slide_to_roll_ratio})
    rolling = of_pairs.map(_in_pure_rolling)
    in_window, rate = _in_time(pair, film, runs, slip)
    limits = pair_limits((of_pairs * xr.ones_like(slip)).assign(breakthrough_rate=rate))
    rate = rate.where(limits["breakthrough_rate"].notnull())
    turn = _turn(spec.points[0] * spec.spacing, film["entrainment_speed"], slip)
    duration = in_window.mean("pair") / rate.mean("pair")
    if pair.gap.is_uniform:
        in_a_revolution = _in_a_revolution(spec, film, _in_pure_rolling(runs), rolling)
    else:
        turns, lasting = map(_in_pure_rolling, (turn, duration))
        in_a_revolution = _by_groups(pair_limits(rolling), turns / lasting, turns)
    table = {
        **limits,
        "breakthroughs_per_revolution": (rate * turn).mean("pair"),
        "breakthrough_duration": duration,
        **in_a_revolution,
        **_asymptotes(pair, film),
    }
    return xr.Dataset(table)


def _in_time(pair, film, runs, slip):
    """Calculate the mean number of broken runs in the window, and of new ones per second."""
    if not pair.gap.is_uniform:
        return _in_uneven_windows(pair.spec, film, runs, slip)
    points = _window_points(pair.spec, film)
    _, broken, _, new, broken_points, new_points, *_ = runs.transpose("outcome", ...)
    # A run is in the window if any of its points is.
    in_window = broken * (points - 1.0) + broken_points
    new_in_window = new * (points - 1.0) + new_points
    speed = film["entrainment_speed"]
    return in_window, speed / pair.spec.spacing * (broken + abs(slip) * new_in_window)


def _in_uneven_windows(spec, film, runs, slip):
    """As `_in_time`, in uneven windows, where the faster surface moves by a point in a step."""
    in_window, in_steps = runs.isel(outcome=0), runs.isel(outcome=slice(1, None))
    if in_steps.sizes["outcome"] == 1:
        in_steps = in_steps.isel(outcome=0)
    else:
        in_steps = in_steps.rename(outcome=_SLIP).assign_coords({_SLIP: slip})
    faster = film["entrainment_speed"] * (1.0 + 0.5 * abs(slip))
    return in_window, faster / spec.spacing * in_steps


def _in_pure_rolling(values):
    """Values without slip, if they depend on slip; NaN if it is 0 at no level."""
    if _SLIP not in values.dims:
        return values
    return values.reindex({_SLIP: [0.0]}).isel({_SLIP: 0}, drop=True)


def _in_a_revolution(spec, film, runs, of_pairs):
    """Fraction of pairs with a breakthrough in a revolution of rolling, and time to the first."""
    points = spec.points[0]
    width = 2.0 * film["contact_half_width"]
    windows = independent_windows(points * spec.spacing, width, spec.longest_wavelength)
    found = pair_limits(of_pairs.assign(groups=runs.isel(outcome=2, drop=True) * points))
    seen = _seen_groups(found, windows)
    # Groups of breakthroughs come independently of one another. Where contact is so frequent that
    # hardly any group ends, they are fewer than the independent windows with a breakthrough, which
    # are counted instead.
    groups = {end: np.maximum(found[f"groups{end}"], seen[end]) for end in LIMITS}
    step = spec.spacing / film["entrainment_speed"]
    times = [step * steps for steps in _first_steps(runs, _window_points(spec, film), points)]
    return _pair_shares(groups) | values_with_limits("first_breakthrough_time", times)


def _first_steps(runs, points, revolution):
    """Find the steps of `_first_breakthrough`, with limits by the scatter between pairs."""
    mean = runs.mean("pair").transpose("outcome", ...)
    steps = _first_breakthrough(mean, points, revolution)
    if runs.sizes["pair"] == 1:
        return [steps, steps * np.nan, steps * np.nan]

    def of_mean(values):
        return _first_breakthrough(mean.copy(data=values), points, revolution).values

    each = runs.transpose("pair", "outcome", ...).values
    limits = jackknife_interval(each, of_mean)[1:]
    # No pair waits longer than a revolution.
    return [steps, *(steps.copy(data=np.minimum(limit, revolution)) for limit in limits)]


def _window_points(spec, film):
    return 2.0 * np.floor(film["contact_half_width"] / spec.spacing) + 1.0


def _sampled(pair, film, slips, pairs, threads=None):
    """Probabilities over pair and the film's dimensions, and numbers of runs, over outcome too."""
    thickness, _ = xr.broadcast(film["film_thickness"], film["contact_half_width"])
    dims = ("pair", "outcome", *thickness.dims)
    windows = ContactWindows(pair.spec, film, pair.layer, pair.gap)
    if _SLIP in film["film_thickness"].dims:
        slips = film[_SLIP]
    if isinstance(slips, xr.DataArray):  # one at each point
        slips = slips.broadcast_like(thickness).transpose(*thickness.dims).values.reshape(-1, 1)

    def on_one_pair(number):
        return windows.sample(pair.spec, pair.seed, number, np.atleast_2d(slips))

    found = on_threads(on_one_pair, range(pairs), threads, "rare contact of lines")
    in_window, runs = (
        xr.DataArray(np.reshape(each, (pairs, -1, *thickness.shape)), thickness.coords, dims)
        for each in zip(*found, strict=True)
    )
    contact, breakthrough = in_window.transpose("outcome", ...)
    return xr.Dataset(dict(zip(PROBABILITIES, (breakthrough, contact), strict=True))), runs


def _first_breakthrough(runs, points, revolution):
    r"""Mean steps to the first breakthrough, for pairs that have one in a revolution.

    The gaps between broken runs are known up to a longest wavelength. Longer gaps end independently
    of the runs before, so they exceed a longest wavelength by an exponentially distributed length.
    Its mean follows from the sum of all runs and gaps, which is the length of the line. With F the
    fraction of windows without a broken run and w the mean number of steps from any window to the
    next run, a window without one waits for :math:`m = w / F` steps, and within T steps for

    .. math:: m - \frac{T}{e^{T / m} - 1}
    """
    _, _, apart, _, run_points, _, searched, between, free, steps = runs.transpose("outcome", ...)
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = xr.where(apart > 0.0, (1.0 - run_points - between - searched) / apart, 0.0)
        excess = excess.clip(min=0.0)
        gap = xr.where(apart > 0.0, searched / apart, 0.0) - (points - 1.0)
        # A window longer than the gap leaves the part of the excess that extends beyond it.
        left = apart * xr.where(excess > 0.0, np.exp(gap.clip(max=0.0) / excess), 1.0)
        gap = gap.clip(min=0.0)
        free = free + left * (gap + excess)
        steps = steps + left * (0.5 * gap**2 + gap * excess + excess**2)
        turns = revolution * free / steps
    return revolution * free * _wait(turns)


def _wait(expected):
    """Mean wait for the first of events that are expected in a revolution, if there is one.

    In revolutions; from a moment at which none is under way, where they come independently.
    """
    # Where few are expected, `exact` is the difference of two large numbers.
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        exact = 1.0 / expected - 1.0 / np.expm1(expected)
    return xr.where(expected < 1e-4, 0.5 - expected / 12.0, exact)


def _asymptotes(pair, film):
    """Theory for high films: the window's first point touches, or a crossing lies in the window.

    The boundary layer breaks if the summit that follows is sharp enough.
    """
    if pair.gap.is_answered:  # the moments change along the window
        return dict.fromkeys(_ASYMPTOTES, xr.full_like(film["film_thickness"], np.nan))
    # The line's criterion is twice that of the surface.
    moments, curvature = pair_moments(pair.spec), 2.0 * mean_breaking_curvature(pair, film)
    films = shaped_films(film) if pair.gap.has_shape else film["film_thickness"]
    rows = films.values.reshape(-1, films.shape[-1])
    # Row by row: the integral over the curvature takes a thousand times the memory of the films.
    shares = [sharp_summit_share(row, moments, curvature) for row in rows]
    share, rate = films.copy(data=np.reshape(shares, films.shape)), crossing_rate(films, moments)
    if pair.gap.has_shape:  # the slope of the film is neglected
        crossings = rate * film["contact_half_width"]
        values = [each.integrate("film_position") for each in (crossings, crossings * share)]
    else:
        first = scipy.special.ndtr(-films / moments[0] ** 0.5)
        contact = first + 2.0 * film["contact_half_width"] * rate
        values = contact, contact * share
    return dict(zip(_ASYMPTOTES, values, strict=True))
