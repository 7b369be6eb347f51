"""The trace stage: contact at every time step, and the details of one contact window."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import xarray as xr

from lube.contact.waves import Waves, answers_at, lifted
from lube.contact.window_films import film_on_points
from lube.contact.windows import ContactWindows
from lube.grid.discretise import LineGrid, layer_factor_of, line_pair, speed_ratios, whole_numbers
from lube.grid.film_profiles import shaped_films
from lube.grid.gap import PLAIN, Gap
from lube.grid.operating_points import known_rows, surface_speeds
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.physics.electrical import contact_resistance
from lube.schema import label
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.types import Datasets

REALISATION = 0
"""The realisation that traces show."""
_MOES = ["moes_load", "moes_material"]
_RESPONSE = ["response_real", "response_imaginary", "reduced_radius", "composite_rms_roughness"]


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``trace.nc``; see `lube.stages`."""
    lines, film, layer = inputs["roughness"], inputs["film"], study.boundary_layer
    resistivity = study.resistivity if study.conducts else np.nan
    return contact_trace(lines, film, study.trace_points, layer, resistivity, study.gap)


def contact_trace(
    lines: xr.Dataset,
    film: xr.Dataset,
    points: Sequence[Mapping[str, float | str]],
    boundary_layer: BoundaryLayer,
    resistivity: float,
    gap: Gap = PLAIN,
) -> xr.Dataset:
    """Contact at every time step of one revolution, at some operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` dataset; its realisation 0 is used.
    film : xarray.Dataset
        A ``film`` dataset.
    points : sequence of dict
        Operating points, each a dict from the coordinates of `lube.schema.CONTACT_DIMS` to levels;
        all with the same speed and slide-to-roll ratio.
    boundary_layer : BoundaryLayer
        With attributes ``critical_thickness`` (m) and ``shear_strength`` (Pa).
    resistivity : float
        Resistivity of the rollers' material, ohm m; NaN if either does not conduct.
    gap : Gap, optional
        How film and roughness make up the gap; by default flat films, and lines as drawn.

    Returns
    -------
    xarray.Dataset
        The ``trace`` file of `lube.schema`: contact length (m) and resistance (ohm, Eq. 1) over
        (operating_point, time). Points where the film is not known are left out, and the log names
        them.

    Raises
    ------
    DataError
        If the film is known at none of the points.
    """
    table = known_rows(film, points, gap)
    windows = ContactWindows(LineGrid.of(lines), table, boundary_layer, gap)
    ratio, spacing = points[0]["slide_to_roll_ratio"], lines.attrs["spacing"]
    length = windows.trace(line_pair(lines, REALISATION), ratio) * spacing
    faster_surface = max(surface_speeds(table["entrainment_speed"].values[0], ratio))
    dims = ("operating_point", "time")
    names = ["film_thickness", "contact_half_width", "entrainment_speed"]
    names += _MOES if gap.is_flattened else []
    names += _RESPONSE if gap.is_answered else []
    trace = table[names].transpose("operating_point", ...)
    trace = trace.assign(
        contact_length=(dims, length),
        contact_resistance=(dims, contact_resistance(length, resistivity)),
        reduced_modulus=film["reduced_modulus"],
        critical_thickness=boundary_layer.critical_thickness,
        shear_strength=boundary_layer.shear_strength,
        resistivity=resistivity,
    )
    if gap.has_shape:
        trace["film_profile"] = shaped_films(table)
    time = spacing / faster_surface * np.arange(length.shape[1])
    return label(trace.assign_coords(time=time).assign_attrs(asdict(gap)), "trace")


def contact_window(
    lines: xr.Dataset,
    trace: xr.Dataset,
    operating_point: int,
    step: int,
    reach: float | None = None,
) -> xr.Dataset:
    r"""Heights and segments in the contact window at one time step of a trace.

    Parameters
    ----------
    lines : xarray.Dataset
        The ``roughness`` dataset that the trace was made with.
    trace : xarray.Dataset
        A ``trace`` dataset.
    operating_point : int
        Index of the operating point in the trace.
    step : int
        Time step.
    reach : float, optional
        Half-width of the window, m; by default the contact half-width, or farther if the film has
        a shape and lines touch beyond it.

    Returns
    -------
    xarray.Dataset
        Over ``x`` (m, from the middle of the window, in the direction in which the surfaces
        move): ``height`` of both rollers and ``overlap`` z1 + z2 - h, m. Over ``segment``:
        ``first`` and ``last`` index in the window, ``contact_length`` D (m), ``force`` F (N,
        Eq. 5), ``layer_thickness`` h_l (m, Eq. 6), and ``broken``.

    Notes
    -----
    With the grid spacing :math:`\Delta x` and the overlaps :math:`\Delta z` of a segment:

    .. math::

        F = E^* \Delta x \sum \Delta z, \qquad
        h_l = \frac{\pi \tau_0}{12} \frac{D^3}{F}
    """
    point = trace.isel(operating_point=operating_point)
    grid = LineGrid.of(lines)
    gap = Gap(trace.attrs["film_shape"], trace.attrs["roughness_deformation"])
    half_width = point["contact_half_width"].item()
    widest = half_width * (point["film_position"].values[-1] if gap.has_shape else 1.0)
    film, half_window = whole_numbers(point["film_thickness"], reach or widest, grid)
    window = np.arange(-half_window, half_window + 1)
    if gap.has_shape:
        film = film_on_points(
            point["film_position"].values, point["film_profile"].values, half_width, window, grid
        )
    ratios = speed_ratios(point["slide_to_roll_ratio"].item())
    pair = line_pair(lines, REALISATION)
    if gap.is_flattened:
        contact = [point[name].item() for name in ("contact_half_width", *_MOES)]
        pair = [Waves(line, grid).flattened(*contact) for line in pair]
    both = zip(pair, (surface_position(step, ratio) for ratio in ratios), strict=True)
    heights = np.array([line[(place + window) % line.size] for line, place in both], np.int64)
    if gap.is_answered:
        heights += lifted(pair, grid, answers_at(point, gap.has_shape).values, ratios, step, window)
    # Points of a line that are ahead in its direction of motion come first.
    heights, film = heights[:, ::-1], np.broadcast_to(film, window.shape)[::-1]
    overlap = heights.sum(axis=0) - film
    if reach is None:
        touching = np.abs(window[overlap > 0]).max(initial=0)
        shown = np.abs(window) <= max(half_width / grid.spacing, touching + 1)
        window, heights, overlap = window[shown], heights[:, shown], overlap[shown]
    heights, overlaps = heights * grid.height_step, overlap * grid.height_step
    found = {"height": (("roller", "x"), heights), "overlap": ("x", overlaps)}
    found |= {name: ("segment", each) for name, each in _segments(overlap, point, grid).items()}
    return xr.Dataset(found, {"x": window * grid.spacing, "roller": lines["roller"]})


def _segments(overlap, point, grid):
    """Maximal runs of positive overlap, and the state of their boundary layer."""
    edges = np.flatnonzero(np.diff(overlap > 0, prepend=False, append=False))
    first, last = edges[::2], edges[1::2] - 1
    points = last - first + 1
    sums = np.array([overlap[i : i + n].sum() for i, n in zip(first, points, strict=True)])
    stiffness = point["reduced_modulus"].item() * grid.spacing
    length = points * grid.spacing
    force = stiffness * sums * grid.height_step
    factor = layer_factor_of(grid, point["reduced_modulus"], point).item()
    broken = [layer_breaks(*each, factor) for each in zip(points, sums, strict=True)]
    return {
        "first": first,
        "last": last,
        "contact_length": length,
        "force": force,
        "layer_thickness": np.pi * point["shear_strength"].item() / 12.0 * length**3 / force,
        "broken": np.array(broken, bool),
    }
