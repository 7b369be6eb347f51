"""The MDR stage: what the rough lines do in the contact window, over time and operating points.

The compiled kernels work on whole height steps and grid points; here films, half-widths and
counts are turned into them and back. An operating point reaches the kernels only as its film
thickness and window, so any dimension of the film table passes through unchanged.
"""

import logging

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.kernels.layer import layer_factor
from lube.kernels.rolling import composite_line, rolling_statistics, rolling_trace
from lube.kernels.scan import scan_statistics, scan_trace, surface_position
from lube.resistance import contact_resistance
from lube.schema import CONTACT_DIMS, OPERATING_DIMS, label

log = logging.getLogger(__name__)


def speed_ratios(slide_to_roll_ratio):
    """Speeds of the two surfaces, over the faster one's.

    Parameters
    ----------
    slide_to_roll_ratio : float
        (v1 - v2) / v with the mean surface speed v = (v1 + v2) / 2.

    Returns
    -------
    tuple of float
        v1 / max(v1, v2) and v2 / max(v1, v2).
    """
    first, second = 1.0 + slide_to_roll_ratio / 2.0, 1.0 - slide_to_roll_ratio / 2.0
    return first / max(first, second), second / max(first, second)


def contact_statistics(lines, film, reduced_modulus, boundary_layer, slide_to_roll_ratio=(0.0,)):
    """Run the model over one revolution for all realisations and operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    film : xarray.Dataset
        A ``film`` dataset.
    reduced_modulus : float
        E*, Pa.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).
    slide_to_roll_ratio : sequence of float, optional
        Levels of the slide-to-roll ratio; pure rolling if not given.

    Returns
    -------
    xarray.Dataset
        The ``contact_batch`` file of `lube.schema`: probabilities, mean contact length (m)
        and mean contact force (N) over (realisation, slide_to_roll_ratio, lubricant,
        film_formula, temperature, speed, force).
    """
    spacing, height_step = lines.attrs["spacing"], lines.attrs["height_step"]
    factor = _factor(lines, reduced_modulus, boundary_layer)
    films, half_windows, back = _distinct_points(film, spacing, height_step)
    counts = np.empty((lines.sizes["realisation"], len(slide_to_roll_ratio), films.size, 4))
    for r, realisation in enumerate(lines["realisation"].values):
        pair = line_pair(lines, realisation)
        for s, ratio in enumerate(slide_to_roll_ratio):
            counts[r, s] = _mean_counts(pair, ratio, films, half_windows, factor)
            log.info("realisation %d, slide-to-roll ratio %g: done", realisation, ratio)
    shape = counts.shape[:2] + tuple(film.sizes[name] for name in OPERATING_DIMS)
    counts = counts[:, :, back].reshape(*shape, 4)
    dims = ("realisation", *CONTACT_DIMS)
    dataset = xr.Dataset(
        {
            "geometric_contact_probability": (dims, counts[..., 0]),
            "breakthrough_probability": (dims, counts[..., 1]),
            "mean_contact_length": (dims, counts[..., 2] * spacing),
            "mean_contact_force": (dims, counts[..., 3] * reduced_modulus * spacing * height_step),
        },
        coords={
            "realisation": lines["realisation"].values,
            "slide_to_roll_ratio": np.asarray(slide_to_roll_ratio, float),
            **{name: film[name] for name in OPERATING_DIMS},
        },
        attrs={
            "travel": spacing * max(lines.attrs["points"]),
            "longest_wavelength": 2.0 * np.pi / lines.attrs["q_min"],
        },
    )
    return label(dataset, "contact_batch")


def _mean_counts(pair, ratio, films, half_windows, factor):
    """Kernel statistics per time step, by the fastest method that is exact for the slip."""
    ratios = speed_ratios(ratio)
    steps = revolution(pair, ratios)
    if ratio == 0.0:
        margin = int(half_windows.max())
        line = composite_line(*pair, steps, margin)
        statistics = rolling_statistics(line, margin, films, half_windows, factor)
    else:
        statistics = scan_statistics(*pair, ratios, steps, films, half_windows, factor)
    return statistics / steps


def revolution(pair, ratios):
    """Time steps in one revolution of the roller with the faster surface.

    Parameters
    ----------
    pair : tuple of numpy.ndarray
        The two lines.
    ratios : tuple of float
        From `speed_ratios`.

    Returns
    -------
    int
        Points around that roller; the first roller's where both are equally fast.
    """
    return pair[0].size if ratios[0] == 1.0 else pair[1].size


def line_pair(lines, realisation):
    """Pick the two lines of a realisation as whole height steps.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset.
    realisation : int
        Which realisation.

    Returns
    -------
    tuple of numpy.ndarray
        Two int32 lines, shapes (N1,) and (N2,).

    Raises
    ------
    DataError
        If the dataset does not hold the realisation.
    """
    if realisation not in lines["realisation"].values:
        raise DataError(f"realisation {realisation} is not among the roughness lines")
    heights = lines["height"].sel(realisation=realisation).values
    pair = []
    for row, points in zip(heights, lines.attrs["points"], strict=True):
        line = row[: int(points)]
        if line.dtype.kind == "f":
            line = np.rint(line / lines.attrs["height_step"]).astype(np.int32)
        pair.append(np.ascontiguousarray(line))
    return tuple(pair)


def _factor(lines, reduced_modulus, boundary_layer):
    return layer_factor(
        reduced_modulus,
        boundary_layer.critical_thickness,
        boundary_layer.shear_strength,
        lines.attrs["spacing"],
        lines.attrs["height_step"],
    )


def _grid_units(film_thickness, half_width, spacing, height_step):
    """Film in height steps and half-window in grid points."""
    films = np.rint(np.asarray(film_thickness) / height_step).astype(np.int64)
    return films, np.floor(np.asarray(half_width) / spacing).astype(np.int64)


def _distinct_points(film, spacing, height_step):
    """Operating points as distinct (film, half-window) pairs, and the way back to all points."""
    thickness, half_width = (
        array.transpose(*OPERATING_DIMS).values.ravel()
        for array in xr.broadcast(film["film_thickness"], film["contact_half_width"])
    )
    films, half_windows = _grid_units(thickness, half_width, spacing, height_step)
    pairs, back = np.unique(np.stack([films, half_windows]), axis=1, return_inverse=True)
    return pairs[0], pairs[1], back.ravel()


def contact_trace(lines, film, points, reduced_modulus, boundary_layer, resistivity):
    """Record the contact at every time step of one revolution, for some operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` dataset; its realisation 0 is used.
    film : xarray.Dataset
        A ``film`` dataset.
    points : list of dict
        Operating points, each from the coordinates of `lube.schema.CONTACT_DIMS` to levels;
        all of one speed and slide-to-roll ratio.
    reduced_modulus : float
        E*, Pa.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).
    resistivity : float
        Resistivity of the rollers' material, ohm m.

    Returns
    -------
    xarray.Dataset
        The ``trace`` file of `lube.schema`: contact length (m) and resistance (ohm) over
        (operating_point, time).
    """
    spacing = lines.attrs["spacing"]
    pair = line_pair(lines, 0)
    factor = _factor(lines, reduced_modulus, boundary_layer)
    chosen = [film.sel({name: point[name] for name in OPERATING_DIMS}) for point in points]
    lengths = []
    for point, place in zip(points, chosen, strict=True):
        films, half_window = _grid_units(
            place["film_thickness"],
            place["contact_half_width"],
            spacing,
            lines.attrs["height_step"],
        )
        ratio = point["slide_to_roll_ratio"]
        broken = _broken_points(pair, ratio, int(films), int(half_window), factor)
        lengths.append(broken * spacing)
    lengths = np.array(lengths)
    fastest = chosen[0]["entrainment_speed"].item() * (
        1.0 + abs(points[0]["slide_to_roll_ratio"]) / 2.0
    )
    along = {
        name: ("operating_point", [place[name].item() for place in chosen])
        for name in OPERATING_DIMS
    }
    dims = ("operating_point", "time")
    dataset = xr.Dataset(
        {
            "contact_length": (dims, lengths),
            "contact_resistance": (dims, contact_resistance(lengths, resistivity)),
            "film_thickness": ("operating_point", [p["film_thickness"].item() for p in chosen]),
            "contact_half_width": (
                "operating_point",
                [p["contact_half_width"].item() for p in chosen],
            ),
        },
        coords={
            "time": spacing / fastest * np.arange(lengths.shape[1]),
            "slide_to_roll_ratio": (
                "operating_point",
                [float(point["slide_to_roll_ratio"]) for point in points],
            ),
            **along,
        },
        attrs={"realisation": 0},
    )
    return label(dataset, "trace")


def contact_window(
    lines,
    film_thickness,
    half_width,
    step,
    reduced_modulus,
    boundary_layer,
    slide_to_roll_ratio=0.0,
):
    """Look into the contact window at one time step: overlaps and what becomes of each segment.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` dataset; its realisation 0 is used.
    film_thickness, half_width : float
        h0 and a, m.
    step : int
        Time step t.
    reduced_modulus : float
        E*, Pa.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).
    slide_to_roll_ratio : float, optional
        Pure rolling if not given.

    Returns
    -------
    xarray.Dataset
        Over ``x`` (m, from the middle of the window): ``height`` of both rollers and
        ``overlap`` z1 + z2 - h0, m. Over ``segment``: ``first`` and ``last`` index in the
        window, ``contact_length`` D (m), ``force`` F (N, Eq. 5), ``layer_thickness`` h_l
        (m, Eq. 6), and ``broken``.
    """
    spacing, height_step = lines.attrs["spacing"], lines.attrs["height_step"]
    film, half_window = _grid_units(film_thickness, half_width, spacing, height_step)
    window = np.arange(-int(half_window), int(half_window) + 1)
    heights = np.array(
        [
            line[(surface_position(step, ratio, line.size) + window) % line.size]
            for line, ratio in zip(
                line_pair(lines, 0), speed_ratios(slide_to_roll_ratio), strict=True
            )
        ],
        np.int64,
    )
    overlap = heights.sum(axis=0) - film
    segments = _segments(overlap)
    points = np.array([last - first + 1 for first, last in segments], np.int64)
    indented = np.array([overlap[first : last + 1].sum() for first, last in segments], np.int64)
    length = points * spacing
    force = reduced_modulus * spacing * height_step * indented
    factor = _factor(lines, reduced_modulus, boundary_layer)
    return xr.Dataset(
        {
            "height": (("roller", "x"), heights * height_step),
            "overlap": ("x", overlap * height_step),
            "first": ("segment", np.array([first for first, _ in segments], np.int64)),
            "last": ("segment", np.array([last for _, last in segments], np.int64)),
            "contact_length": ("segment", length),
            "force": ("segment", force),
            "layer_thickness": (
                "segment",
                np.pi * boundary_layer.shear_strength / 12.0 * length**3 / force,
            ),
            "broken": ("segment", points.astype(float) ** 3 < factor * indented),
        },
        coords={"x": window * spacing, "roller": lines["roller"]},
    )


def _segments(overlap):
    """First and last index of each maximal run of positive overlaps."""
    edges = np.diff(np.concatenate([[0], (overlap > 0).astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1, strict=True))


def _broken_points(pair, ratio, film, half_window, factor):
    """Points of broken segments in the window, at each step of one revolution."""
    ratios = speed_ratios(ratio)
    steps = revolution(pair, ratios)
    if ratio == 0.0:
        line = composite_line(*pair, steps, half_window)
        return rolling_trace(line, film, half_window, factor)
    return scan_trace(*pair, ratios, steps, film, half_window, factor)[:, 1]
