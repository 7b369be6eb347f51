"""What the report says of a study first: its numbers and its answers."""

import math
import platform
from html import escape
from importlib.metadata import version

import numpy as np

from lube.report.pages import html_table
from lube.storage.git import commit
from lube.storage.provenance import LIBRARIES
from lube.units import with_unit


def facts(study):
    """Tell the numbers of a study.

    Parameters
    ----------
    study : lube.study.study.Study
        The study.

    Returns
    -------
    str
        HTML: a table of two columns.
    """
    grid, roughness, spec = study.operating_grid, study.roughness, study.line_spec
    wavelengths = [with_unit(_rounded(2.0 * math.pi / q), "m") for q in (spec.q_max, spec.q_min)]
    points = math.prod(len(levels) for levels in grid.model_dump().values())
    rows = [
        ("Rollers", _rollers(study.rollers)),
        ("Lubricant", ", ".join(record.title for record in study.lubricants)),
        ("Film formulas", ", ".join(study.film_formulas)),
        ("Operating points", f"{points}: {_grid(grid)}"),
        ("Roughness lines", f"{roughness.points:,} points around the roller, Hurst exponent "
         f"{roughness.hurst_exponent:g}, wavelengths {wavelengths[0]} to {wavelengths[1]}"),
        ("Boundary layer", "critical thickness "
         f"{with_unit(study.boundary_layer.critical_thickness, 'm')}, shear strength "
         f"{with_unit(study.boundary_layer.shear_strength, 'Pa')}"),
        ("Realisations", f"{study.realisations} pairs of roughness lines, "
         f"{_counted(study.revolutions, 'revolution')} each; seed {study.seed}"),
        ("Experiment", _experiment(study)),
        ("Made by", "; ".join(creator.name for creator in study.about.creators) or "not named"),
        ("Code", f"commit {commit()}"),
        ("Software", _software()),
    ]  # fmt: skip
    return _pairs(rows)


def _rollers(rollers):
    told = [
        f"radius {with_unit(one.radius, 'm')}, {with_unit(one.young_modulus, 'Pa')}, Poisson's "
        f"ratio {one.poisson_ratio:g}, rms roughness {with_unit(one.rms_roughness, 'm')}"
        for one in (rollers.first, rollers.second)
    ]
    alike = rollers.first == rollers.second
    each = f"two alike, {told[0]}" if alike else f"first {told[0]}; second {told[1]}"
    return f"{each}; contact line {with_unit(rollers.length, 'm')} long"


def _grid(grid):
    units = {"force": "N", "speed": "rpm", "temperature": "degC"}
    told = [_levels(getattr(grid, name), unit) for name, unit in units.items()]
    slips = _levels(grid.slide_to_roll_ratio, "")
    return "; ".join([*told, f"slide-to-roll ratio {slips}"])


def _levels(levels, unit):
    """Name all levels, or the ends of many."""
    numbers = [f"{_rounded(level):g}" for level in levels[:-1]]
    if len(numbers) > 11:
        numbers = [f"{len(levels)} levels from {numbers[0]}"]
    join = " to " if len(levels) > 12 else " and "
    last = with_unit(_rounded(levels[-1]), unit)
    return f"{', '.join(numbers)}{join}{last}" if numbers else last


def _software():
    libraries = [f"{name} {version(name)}" for name in ("lube", *LIBRARIES, "snakemake")]
    return ", ".join([*libraries, f"Python {platform.python_version()}"])


def _counted(number, noun):
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _experiment(study):
    threshold = with_unit(study.experiment.threshold, "ohm")
    if study.experiment.manifest is not None:
        return f"measured records; below {threshold} counts as contact"
    turns = f"{study.rig.revolutions:g} revolution{'' if study.rig.revolutions == 1 else 's'}"
    pairs = study.rig.pairs
    rollers = "one pair of rollers turns" if pairs == 1 else f"{pairs} pairs of rollers turn"
    drift = f", which renew {100.0 * study.rig.drift:g} % of their roughness's variance each"
    return (
        f"a simulated rig: {rollers} {turns} at every operating point"
        f"{drift if study.rig.drift else ''}; below {threshold} counts as contact. "
        "No measured value enters this study."
    )


def findings(study, film, contact, comparison):
    """Tell the answers of a study in a few lines.

    Parameters
    ----------
    study : lube.study.study.Study
        The study.
    film, contact, comparison : xarray.Dataset
        Its datasets of these names.

    Returns
    -------
    str
        HTML: sentences, and a table of the points that the study names for its traces.
    """
    chosen = {
        "lubricant": study.lubricants[0].name,
        "film_formula": study.film_formulas[0],
        "slide_to_roll_ratio": study.rig_slip,
    }
    sentences = [
        _range_of(contact["breakthrough_probability_mean"].sel(chosen)),
        _outside(_at(film["in_validity_range"], chosen)),
        _agreement(comparison, chosen),
    ]
    items = "\n".join(f"<li>{sentence}</li>" for sentence in sentences if sentence)
    points = _points(study.trace_points, film, contact, comparison)
    return f"<p>{_which(study)}</p>\n<ul>\n{items}\n</ul>\n{points}"


def notes(experiment, comparison):
    """Tell which records were refused, and what was remarked of the others.

    Parameters
    ----------
    experiment, comparison : xarray.Dataset
        The study's datasets of these names.

    Returns
    -------
    str
        HTML: a list under each heading; empty if there is nothing to tell.
    """
    remarks = experiment.attrs["remarks"].splitlines() + comparison.attrs["remarks"].splitlines()
    told = {
        "Records that were refused, and are in no result": experiment.attrs["refused"].splitlines(),
        "Remarks on records": remarks,
    }
    return "".join(
        f"\n<p>{heading}:</p>\n<ul>\n{''.join(f'<li>{escape(line)}</li>' for line in lines)}\n</ul>"
        for heading, lines in told.items()
        if lines
    )


def _which(study):
    """Say of which part of the study the sentences below tell."""
    return (
        f"With {escape(study.lubricants[0].title)}, the film formula "
        f"<code>{escape(study.film_formulas[0])}</code> and slide-to-roll ratio {study.rig_slip:g}:"
    )


def _at(variable, point):
    """Take a variable at a point, as far as it depends on it."""
    return variable.sel({name: level for name, level in point.items() if name in variable.dims})


def _range_of(mean):
    """Say how often metal touches metal, and where most."""
    touched = mean.values[mean.values > 0.0]
    if not touched.size:
        return f"Metal touched metal at none of {mean.size} operating points."
    place = mean.isel(mean.argmax(mean.dims))
    at = {name: float(place[name]) for name in mean.dims}
    never = mean.size - touched.size
    rest = f"; at the other {never} it was never seen" if never else ""
    return (
        f"Metal touches metal at {touched.size} of {mean.size} operating points{rest}. The "
        f"boundary layer is broken for at most <strong>{_percent(touched.max())}</strong> of the "
        f"time, at {_point(at)}."
    )


def _outside(inside):
    inside = inside.values.astype(bool)
    if inside.all():
        return "All operating points lie within the range in which the film formula holds."
    return (
        f"{int((~inside).sum())} of {inside.size} operating points lie outside the range in which "
        "the film formula was found to hold."
    )


def _agreement(comparison, chosen):
    """Say how far simulation and rig agree; nothing where there is no record."""
    chosen = chosen | {"threshold": comparison["comparison_threshold"].item()}
    bias, spread, inside = (
        float(_at(comparison[name], chosen)) for name in ("bias", "rms_difference", "overlap_share")
    )
    if not math.isfinite(bias):
        return ""
    rig = "a simulated rig" if comparison["origin"].item() == "simulated" else "the rig"
    records = int(_at(comparison["compared_records"], chosen))
    return (
        f"Against {rig} ({_counted(records, 'record')} of "
        f"{_counted(comparison['pairs'].item(), 'pair')} of rollers) the simulation is on average "
        f"{abs(100.0 * bias):.2g} percentage points too {'high' if bias > 0.0 else 'low'}; the rms "
        f"difference is {100.0 * spread:.2g} points. {_percent(inside)} of the records lie where "
        f"95 % of single pairs should{_perfect(comparison, chosen)}."
    )


def _perfect(comparison, chosen):
    """Tell what share of its records a right model would have within the prediction."""
    lower, upper = (
        float(_at(comparison[f"overlap_share_expected_{side}"], chosen))
        for side in ("lower", "upper")
    )
    if not math.isfinite(lower):
        return ""
    ends = " to ".join(_percent(end) for end in sorted({lower, upper}))
    return f"; a right model would have {ends} of them there"


def _points(points, film, contact, comparison):
    """Table of the operating points that the study names."""
    rows = [
        (
            _point(point),
            with_unit(_rounded(_at(film["film_thickness"], point)), "m"),
            f"{float(_at(film['lambda_ratio'], point)):.3g}",
            _with_interval(contact.sel(point)),
            _range(_measured_near(comparison, point)),
        )
        for point in points
    ]
    head = ("operating point", "film", "lambda ratio",
            "time with metal contact (95 % interval)", "by the rig")  # fmt: skip
    return html_table(head, rows)


def _measured_near(comparison, point):
    """Shares of the records near an operating point, as far as they are known."""
    names = {name: f"{name}_level" for name in ("force", "speed", "temperature")}
    names |= {name: name for name in ("lubricant", "slide_to_roll_ratio")}
    near = np.logical_and.reduce(
        [comparison[name].values == point[level] for level, name in names.items()]
    )
    shares = comparison["measured_share"].values[near]
    return shares[np.isfinite(shares)]


def _range(shares):
    """Tell one share, or the least and the greatest of several."""
    if not shares.size:
        return "–"
    ends = [_percent(end) for end in sorted({shares.min(), shares.max()})]
    return " to ".join(ends) + (f" ({shares.size} records)" if shares.size > 1 else "")


def _with_interval(contact):
    middle, lower, upper = (
        _percent(contact[f"breakthrough_probability_{name}"]) for name in ("mean", "lower", "upper")
    )
    return f"<strong>{middle}</strong> ({lower} to {upper})"


def _point(at):
    units = {"force": "N", "speed": "rpm", "temperature": "degC"}
    return ", ".join(with_unit(_rounded(at[name]), unit) for name, unit in units.items())


def _rounded(number):
    return float(f"{float(number):.3g}")


def _percent(share):
    share = float(share)
    return f"{100.0 * share:.3g} %" if math.isfinite(share) else "–"


def _pairs(rows):
    cells = (f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows)
    return "\n".join(['<table class="facts">', "<tbody>", *cells, "</tbody>", "</table>"])
