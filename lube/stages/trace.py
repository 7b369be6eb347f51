"""The trace stage: contact at every time step, and a close look into the contact window."""

import numpy as np
import xarray as xr

from lube.grid.discretise import layer_factor_of, line_pair, revolution, speed_ratios, whole_numbers
from lube.grid.operating_points import surface_speeds
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.kernels.strips import strip_trace
from lube.physics.electrical import contact_resistance
from lube.schema import CONTACT_DIMS, OPERATING_DIMS, label

REALISATION = 0
"""The realisation that traces are taken of."""


def contact_trace(lines, film, points, boundary_layer, resistivity):
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
    places = _places(film, points)
    factor = layer_factor_of(lines, film["reduced_modulus"].item(), boundary_layer)
    films, half_windows = whole_numbers(
        places["film_thickness"], places["contact_half_width"], lines
    )
    pair = line_pair(lines, REALISATION)
    ratio = points[0]["slide_to_roll_ratio"]
    ratios = speed_ratios(ratio)
    steps = revolution(pair, ratios)
    broken = strip_trace(*pair, ratios, steps, films, half_windows, factor)
    spacing = lines.attrs["spacing"]
    length = (("operating_point", "time"), broken * spacing)
    faster_surface = max(surface_speeds(places["entrainment_speed"].values[0], ratio))
    trace = places[["film_thickness", "contact_half_width", "entrainment_speed"]].assign(
        contact_length=length,
        contact_resistance=(length[0], contact_resistance(length[1], resistivity)),
        reduced_modulus=film["reduced_modulus"],
        critical_thickness=boundary_layer.critical_thickness,
        shear_strength=boundary_layer.shear_strength,
        resistivity=resistivity,
    )
    return label(
        trace.assign_coords(time=spacing / faster_surface * np.arange(length[1].shape[1])), "trace"
    )


def _places(film, points):
    """Rows of the film table at the operating points, along ``operating_point``."""
    along = {
        name: xr.DataArray([point[name] for point in points], dims="operating_point")
        for name in CONTACT_DIMS
    }
    chosen = film.sel({name: along[name] for name in OPERATING_DIMS})
    return chosen.assign_coords(slide_to_roll_ratio=along["slide_to_roll_ratio"])


def contact_window(lines, trace, operating_point, step, reach=None):
    """Look into the contact window at one time step of a trace.

    Parameters
    ----------
    lines : xarray.Dataset
        The ``roughness`` dataset that the trace was made with.
    trace : xarray.Dataset
        A ``trace`` dataset.
    operating_point : int
        Which of the trace's operating points.
    step : int
        Time step.
    reach : float, optional
        How far from the middle to look, m; the contact half-width if not given.

    Returns
    -------
    xarray.Dataset
        Over ``x`` (m, from the middle of the window): ``height`` of both rollers and
        ``overlap`` z1 + z2 - h0, m. Over ``segment``: ``first`` and ``last`` index in the
        window, ``contact_length`` D (m), ``force`` F (N, Eq. 5), ``layer_thickness`` h_l
        (m, Eq. 6), and ``broken``.
    """
    place = trace.isel(operating_point=operating_point)
    spacing, height_step = lines.attrs["spacing"], lines.attrs["height_step"]
    reach = place["contact_half_width"].item() if reach is None else reach
    film, half_window = whole_numbers(place["film_thickness"], reach, lines)
    window = np.arange(-half_window, half_window + 1)
    ratios = speed_ratios(place["slide_to_roll_ratio"].item())
    heights = np.array(
        [
            line[(surface_position(step, ratio) + window) % line.size]
            for line, ratio in zip(line_pair(lines, REALISATION), ratios, strict=True)
        ],
        np.int64,
    )
    overlap = heights.sum(axis=0) - film
    first, last = _segments(overlap)
    points = last - first + 1
    indentation = np.array([overlap[i : i + n].sum() for i, n in zip(first, points, strict=True)])
    stiffness = place["reduced_modulus"].item() * spacing
    length, force = points * spacing, stiffness * indentation * height_step
    layer = np.pi * place["shear_strength"].item() / 12.0 * length**3 / force
    factor = layer_factor_of(lines, place["reduced_modulus"], place).item()
    broken = np.array(
        [layer_breaks(n, s, factor) for n, s in zip(points, indentation, strict=True)], bool
    )
    return xr.Dataset(
        {
            "height": (("roller", "x"), heights * height_step),
            "overlap": ("x", overlap * height_step),
            "first": ("segment", first),
            "last": ("segment", last),
            "contact_length": ("segment", length),
            "force": ("segment", force),
            "layer_thickness": ("segment", layer),
            "broken": ("segment", broken),
        },
        coords={"x": window * spacing, "roller": lines["roller"]},
    )


def _segments(overlap):
    """First and last indices of the maximal runs of positive overlap."""
    edges = np.diff(np.concatenate([[0], (overlap > 0).astype(np.int8), [0]]))
    return np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
