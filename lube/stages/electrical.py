"""The electrical stage: what electrical meters read at every operating point."""

from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import strip_films, surface_contact
from lube.contact.windows import study_windows
from lube.digits import six_digits
from lube.grid.film_responses import with_surface_responses
from lube.grid.levels import rolling
from lube.grid.operating_points import at_slip, known_films, operating_points
from lube.physics import electrical
from lube.rig.readings import READINGS, charged_capacitance, mean_shares
from lube.rig.simulator import simulated_revolutions
from lube.schema import POINT_DIMS, label, values_with_limits, with_dims
from lube.study.rig_settings import OWN_RIG, PRESETS
from lube.study.study import Study
from lube.types import Datasets

PAIRS = 8
"""Pairs of lines on which contact is sampled under films that a voltage makes thinner."""
FEWER = 3
"""How many times fewer surfaces are sampled under these films than for ``areal.nc``."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    r"""Make ``electrical.nc``; see `lube.stages`.

    All values are for the first film formula and the slide-to-roll ratio nearest to pure rolling,
    and for contact of the line, or of the surface if the simulated rig's rollers have surfaces. The
    rig runs for one revolution at each operating point.

    Notes
    -----
    The capacitance of the contact is that of a rough film,

    .. math:: C = \varepsilon_0 \varepsilon_r L' \int_{-a}^a
        \left\langle \frac{1}{\max(g, h_c)} \right\rangle dx

    and a meter that takes it for two plates reads a film that is thinner than the mean gap.
    """
    slip = rolling(study.slips)
    film = at_slip(with_surface_responses(inputs), slip).isel(film_formula=0, drop=True)
    film = film.transpose(*POINT_DIMS, ...)
    rigs = {OWN_RIG: study.rig} | {name: study.rig.like(name) for name in PRESETS}
    gaps, layer = _gaps(study, film), study.boundary_layer.critical_thickness
    table = _capacitances(study, film, gaps)
    settings = layer, study.rollers.length, study.rig.oil_permittivity
    charged = charged_capacitance(film, gaps, *settings)
    readings, length = _readings(study, film, charged.values, rigs, slip, threads)
    share = readings["true_contact_share"]
    if study.rig.has_surfaces:
        surfaces = _contact_of_surfaces(study, film, threads)
        table["breakdown_ratio"] = surfaces["breakdown_ratio"]
    else:
        surfaces = None
        contact = inputs["contact"].isel(film_formula=0, drop=True)
        contact = contact.sel(slide_to_roll_ratio=slip, drop=True)
        length = contact["mean_contact_length"].mean("realisation")
        share = contact["breakthrough_probability_mean"]
        table["breakdown_ratio"] = length / (2.0 * film["contact_half_width"])
    table |= _closed_resistance(study, share, length)
    table["impedance_phase"] = _impedance_phases(rigs, share, table["closed_resistance"], charged)
    found = xr.Dataset(table).transpose("rig", *POINT_DIMS).map(six_digits)
    found = found.merge(readings, join="exact")
    found["discharge_probability"] = _discharges(study, film, rigs, threads, surfaces)
    found = found.drop_attrs().assign_coords(rig=list(rigs), reading=list(READINGS))
    found = found.assign_coords(threshold=list(study.experiment.thresholds))
    found["rig_source"] = "rig", ["the study", *(one.source for one in PRESETS.values())]
    return label(found.assign(impedance_frequency=study.rig.frequency), "electrical")


def _closed_resistance(study, share, length):
    """Resistance while the contact is closed, ohm, and its limits by those of the resistivity."""
    closed = study.resistivity * share / length.where(length > 0.0)
    deviations = 0.0, *(study.resistivity_range or (np.nan, np.nan))
    limits = [closed * (1.0 + deviation) for deviation in deviations]
    return values_with_limits("closed_resistance", limits)


def _impedance_phases(rigs, share, resistance, capacitance):
    """Phase of the impedance that a bridge with each rig's series resistance reads, degrees."""
    phases = []
    for rig in rigs.values():
        series = rig.series_resistance + rig.lead_resistance
        settings = {"frequency": rig.frequency, "series": series}
        impedance = xr.apply_ufunc(
            electrical.read_impedance, share, resistance.fillna(1.0), capacitance, kwargs=settings
        )
        phases.append(np.degrees(xr.apply_ufunc(np.angle, impedance)))
    return xr.concat(phases, "rig", coords="minimal", compat="override")


def _capacitances(study, film, gaps):
    """Capacitance of the rough contact and around it, and films by which meters explain it, m."""
    mean_gap, layer = film["film_thickness"], study.boundary_layer.critical_thickness
    inverse = [electrical.mean_inverse_gap(*gap, layer).mean() for gap in gaps]
    read = mean_gap.copy(data=1.0 / np.reshape(inverse, mean_gap.shape))
    half_width, radius = film["contact_half_width"], film["reduced_radius"]
    length, oil = study.rollers.length, study.rig.oil_permittivity
    around = partial(electrical.surrounding_capacitance, length=length, oil=oil)
    return {
        "film_thickness": mean_gap,
        "capacitance": electrical.film_capacitance(read, half_width, length, oil),
        "plate_capacitance": electrical.film_capacitance(mean_gap, half_width, length, oil),
        "surrounding_capacitance": xr.apply_ufunc(around, mean_gap, half_width, radius),
        "capacitance_film": read,
    }


def _gaps(study, film):
    """Mean gap and rms height across each contact, m; NaN where the film is not known."""
    spec = study.line_spec
    if study.rig.has_surfaces:
        widths = xr.broadcast(film["film_thickness"], film["contact_half_width"])[1]
        strips = zip(strip_films(RoughPair.of(study), film), widths.values.ravel(), strict=True)
        return [strip.gap(spec, width) if strip else (np.nan, np.nan) for strip, width in strips]
    return study_windows(study, film).gaps(spec)


def _readings(study, film, capacitance, rigs, slip, threads):
    """Contact shares by all rigs and readings, and the true ones; mean length of contact, m.

    The capacitance, F, is that which the circuit charges.
    """
    one_turn = study.rig.model_copy(update={"revolutions": 1, "pairs": 1, "drift": 0.0})
    once = study.model_copy(update={"rig": one_turn})
    points = operating_points(film, slip)
    known = np.flatnonzero(known_films(points, study.gap))
    sizes = [film.sizes[name] for name in POINT_DIMS]
    length, share = np.full((2, *sizes), np.nan)
    read = np.full((len(rigs), len(READINGS), *sizes), np.nan)
    by_threshold = np.full((len(rigs), len(study.experiment.thresholds), *sizes), np.nan)
    some = points.isel(operating_point=known)
    for _, number, revolution in simulated_revolutions(once, some, threads):
        contact, at = revolution.contact, np.unravel_index(known[number], sizes)
        length[at] = contact.mean() * study.line_spec.spacing
        share[at] = np.count_nonzero(contact) / contact.size
        revolution = replace(revolution, capacitance=capacitance[at])
        for row, rig in enumerate(rigs.values()):
            shares = mean_shares(revolution, study.experiment, rig)
            read[(row, ..., *at)], by_threshold[(row, ..., *at)] = shares
    found = {"true_contact_share": share, "read_contact_share": read}
    found["threshold_contact_share"] = by_threshold
    return xr.Dataset(with_dims("electrical", found)), xr.DataArray(length, dims=POINT_DIMS)


def _discharges(study, film, rigs, threads, surfaces):
    """Share of time in which a rig's voltage breaks down the oil, without contact.

    Of surfaces, if the rig has them, contact under the films themselves is known.

    Surfaces discharge where they are closer than a certain distance, as if the film were thinner by
    it. A film with a shape is thinner in proportion, by this much where its formula refers to.
    """

    def touching(closer):
        thickness = (film["film_thickness"] - closer).clip(min=0.0)
        if surfaces is not None:
            thicker = (thickness / film["film_thickness"]).values.ravel()
            contact = _contact_of_surfaces(study, film, threads, thicker) if closer else surfaces
            return contact["geometric_contact_probability"].values
        windows = study_windows(study, film.assign(film_thickness=thickness))
        return windows.on_pairs(study.line_spec, study.seed, PAIRS, threads)[:, 0].mean(axis=0)

    gaps = [rig.bias_voltage / rig.dielectric_strength for rig in rigs.values()]
    found = {gap: touching(gap) for gap in {0.0, *gaps}}
    # Few contacts more may come out as fewer, or as more than all, since both are estimates.
    each = [np.maximum(np.minimum(found[gap], 1.0) - found[0.0], 0.0) for gap in gaps]
    sizes = [film.sizes[name] for name in POINT_DIMS]
    return ("rig", *POINT_DIMS), six_digits(np.reshape(each, (len(rigs), *sizes)))


def _contact_of_surfaces(study, film, threads, thicker=1.0):
    """Contact of surfaces, of fewer than for ``areal.nc``."""
    pair = RoughPair.of(study)
    return surface_contact(pair, film, threads, fewer=FEWER, thicker=thicker).drop_attrs()
