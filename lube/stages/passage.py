"""The passage stage: rough lines and waves of any height pass through the contact.

Reynolds' equation with time gives the gap. It is compared with the linear response and with the
contact model for the same roughness.
"""

import logging

import numpy as np
import xarray as xr

from lube.contact.rough_pair import drawn
from lube.contact.rough_piece import RoughPiece
from lube.contact.windows import ContactWindows
from lube.digits import rounded
from lube.ehl.line_contact import ConvergenceError, one_blas_thread
from lube.ehl.response import WaveResponse
from lube.ehl.transient import RoughPassage, pass_wave
from lube.grid.films import FilmGroups, film_at, hertz_contact
from lube.grid.gap import Gap
from lube.grid.levels import rolling
from lube.schema import POINT_DIMS, label
from lube.study.study import Study
from lube.threads import on_threads
from lube.types import Datasets

log = logging.getLogger(__name__)

LAMBDA_RATIOS = 1.0, 1.75, 2.5, 3.25, 4.0
"""The operating points nearest to these, by the computed film, are taken."""
ANSWERS = "as drawn", "linear", "nonlinear"
"""Roughness as drawn, the linear response to it, and Reynolds' equation with time."""
WAVES = {
    "surface_speed": (1.0, 1.5),
    "relative_wavelength": (1.0, 0.25),
    "relative_amplitude": (0.05, 0.1, 0.2, 0.5, 1.0),
}
"""Single waves: speeds of the surface over the entrainment speed, wavelengths over the half-width,
and amplitudes over the central film."""
REALISATION = 0
BEFORE, CROSSING = -3.1, 1.0
"""Half-widths from the line of centres: position of the middle of the piece at the beginning, and
distance on either side within which the gap is judged."""
INSIDE = 0.95
"""Positions over the half-width up to which waves are compared."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``passage.nc``; see `lube.stages`.

    The film is that of smooth rollers without heating at the inlet, and of the first lubricant. The
    lines are those of the first realisation, in pure rolling or at the study's first slip.
    """
    film = inputs["film_profile"]["central_film"].isel(lubricant=0, drop=True)
    points = film.stack(operating_point=POINT_DIMS[1:]).dropna("operating_point")
    ratios = points / study.rough_rollers.composite_rms_roughness
    chosen = dict.fromkeys(int(np.abs(ratios.values - each).argmin()) for each in LAMBDA_RATIOS)
    points = points[list(chosen)].reset_index("operating_point")
    levels = list(zip(*(points[name].values for name in POINT_DIMS[1:]), strict=True))
    oil = inputs["lubricant"].isel(lubricant=[0])
    with one_blas_thread():
        found = on_threads(lambda level: _passed(study, oil, *level), levels, threads)
    table = xr.concat(found, "operating_point", join="outer").assign_coords(points.coords)
    # Further digits depend on the processor.
    table = table.map(rounded, keep_attrs=True, digits=4)
    table["lambda_ratio"] = "operating_point", ratios.values[list(chosen)]
    table["critical_thickness"] = study.boundary_layer.critical_thickness
    return label(table.transpose("operating_point", "answer", ...), "passage")


def _passed(study, oil, temperature, speed, force):
    """Let a piece of the lines and single waves pass at one operating point."""
    rollers, meniscus = study.rough_rollers, study.inlet_model["inlet_meniscus"]
    levels = {"force": [force], "speed": [speed]}
    force, speed = (xr.DataArray(each, {name: each}, [name]) for name, each in levels.items())
    oil, slip = oil.sel(temperature=[temperature]), rolling(study.slips)
    contact = hertz_contact(rollers, force, speed)
    profile = FilmGroups.at(oil, rollers, force, contact, meniscus).profiles.item()
    width, spec = contact["contact_half_width"].item(), study.line_spec
    piece = RoughPiece(drawn(study, REALISATION), spec, width, slip)
    lines = _of_lines(piece, profile, study.boundary_layer, rollers.reduced_radius)
    options = {"inlet_meniscus": meniscus, "answered_lines": spec, "slide_to_roll_ratio": slip}
    film = film_at(oil, rollers, force, speed, ["computed"], True, **options, threads=1)
    return lines.merge(_of_waves(profile)).assign(_by_the_model(piece, film, study.boundary_layer))


def _of_lines(piece, profile, layer, radius):
    """Least gap by each answer at every time step, and share of time below the layer thickness."""
    step = piece.grid.spacing / piece.half_width
    scale = piece.half_width**2 / radius
    passage = RoughPassage(profile, step, piece.highest / scale)
    position = passage.position
    travel = BEFORE + step * np.arange(round((CROSSING - BEFORE) / step) + 1)
    heights = piece.heights(position, travel)
    smooth = profile.scaled_gap(position)[:, None] * scale
    gaps = np.full((len(ANSWERS), travel.size), np.nan)
    gaps[0] = (smooth - heights).min(axis=0)
    gaps[1] = (smooth - piece.heights(position, travel, profile)).min(axis=0)
    oil = np.full(travel.size, np.nan)
    try:
        for number in range(travel.size):
            passage.advance(heights[:, number] / scale)
            gaps[2, number] = passage.gap.min() * scale
            oil[number] = passage.oil_load_share
    except ConvergenceError as error:
        log.warning("%s", error)
    crossing = np.abs(travel) <= CROSSING
    below = np.where(np.isnan(gaps), np.nan, gaps < layer.critical_thickness)
    return xr.Dataset(
        {
            "travel": ("passage_step", travel),
            "least_gap": (("answer", "passage_step"), gaps),
            "oil_load_share": ("passage_step", oil),
            "share_below_layer": ("answer", below[:, crossing].mean(axis=1)),
        },
        {"answer": list(ANSWERS), "passage_step": np.arange(travel.size)},
    )


def _by_the_model(piece, film, layer):
    """Share of time with a broken layer by the contact model, of lines as drawn and answered."""
    first, steps = piece.steps(-CROSSING, CROSSING)
    shares = []
    for deformation in ("none", "computed"):
        windows = ContactWindows(piece.grid, film, layer, Gap("computed", deformation))
        broken = windows.trace(piece.lines, piece.slide_to_roll_ratio, first)
        shares.append(np.mean(broken[0, :steps] > 0))
    return {"breakthrough_share": ("answer", [*shares, np.nan])}


def _of_waves(profile):
    """Least gaps with single waves, and the difference of the wave from the linear response."""
    shape = tuple(map(len, WAVES.values()))
    difference, oil = np.full((2, *shape), np.nan)
    gaps = np.full((len(ANSWERS), *shape), np.nan)
    for at in np.ndindex(shape):
        speed, wavelength, amplitude = (w[n] for w, n in zip(WAVES.values(), at, strict=True))
        try:
            wave = pass_wave(profile, wavelength, speed, amplitude)
        except ConvergenceError as error:
            log.warning("%s", error)
            continue
        inside = np.abs(wave.position) < INSIDE
        linear = WaveResponse(profile, wavelength).transfer(speed, wave.position)
        smooth = profile.scaled_gap(wave.position) / profile.central_gap
        difference[at] = np.sqrt(np.mean(np.abs(wave.transfer - linear)[inside] ** 2))
        oil[at] = wave.oil_load_share
        gaps[0][at] = smooth.min() - amplitude
        gaps[1][at] = (smooth - amplitude * np.abs(linear))[inside].min()
        gaps[2][at] = wave.gap.min() / profile.central_gap
    return xr.Dataset(
        {
            "wave_difference": (tuple(WAVES), difference),
            "wave_oil_load_share": (tuple(WAVES), oil),
            "wave_least_gap": (("answer", *WAVES), gaps),
        },
        {name: list(values) for name, values in WAVES.items()} | {"answer": list(ANSWERS)},
    )
