"""The variants stage: how contact changes if choices of the study are made otherwise.

All variants of lines are computed on the same lines, so their ratios are better known than the
probabilities themselves.
"""

import functools
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from lube.contact.ensemble import PROBABILITIES
from lube.contact.rough_pair import RoughPair, drawn
from lube.contact.surface_strip import surface_contact
from lube.contact.windows import ContactWindows
from lube.ehl.response import at_wavelengths
from lube.grid.film_responses import SURFACE_VARIABLES, VARIABLES, line_waves
from lube.grid.films import film_at
from lube.grid.gap import Gap
from lube.grid.levels import rolling
from lube.grid.operating_points import at_slip
from lube.physics.flattening import amplitude_ratio
from lube.physics.hertz import hertz_gap
from lube.schema import LIMITS, POINT_DIMS, label, values_with_limits, with_dims
from lube.statistics import confidence
from lube.study.study import Study
from lube.surfaces.rare_contact import WINDOWS
from lube.threads import on_threads
from lube.types import Datasets

PAIRS = 40
"""Number of pairs of lines on which contact is sampled; errors follow from their scatter."""


@dataclass(frozen=True)
class Variant:
    """The study with some of its choices made otherwise; None is the study's own choice.

    Attributes
    ----------
    film : str, optional
        Film formula, or ``computed``, the central film by Reynolds' equation. The study's choice is
        its first formula.
    film_shape : str, optional
        ``flat`` and cut off at the edges of the contact; ``open``, flat with the gap of the dry
        contact around it; or ``computed``, the shape by Reynolds' equation.
    roughness_deformation : str, optional
        As in a study.
    is_uncut : bool, optional
        Whether the boundary layer is judged on uncut segments, of which any part lies in the
        window; otherwise on the parts that the edges of the window leave.
    is_on_surface : bool, optional
        Whether contact is that of the surface that the line stands for, over the length of the
        rollers.
    """

    film: str | None = None
    film_shape: str | None = None
    roughness_deformation: str | None = None
    is_uncut: bool = False
    is_on_surface: bool = False

    def of(self, study: Study) -> "Variant":
        """Return the variant with the study's own choices in place of None."""
        return replace(
            self,
            film=self.film or study.film_formulas[0],
            film_shape=self.film_shape or study.film_shape,
            roughness_deformation=self.roughness_deformation or study.roughness_deformation,
        )

    @property
    def gap(self) -> Gap:
        """How film and roughness make up the gap."""
        return Gap("flat" if self.film_shape == "flat" else "computed", self.roughness_deformation)


STUDY = "study"
VARIANTS = {
    STUDY: Variant(),
    "paper": Variant(film="paper"),
    "pan-hamrock": Variant(film="pan-hamrock"),
    "computed, flat": Variant("computed", "flat"),
    "computed, open": Variant("computed", "open"),
    "computed": Variant("computed", "computed"),
    "as drawn": Variant(roughness_deformation="none"),
    "answered": Variant(roughness_deformation="computed"),
    "computed, answered": Variant("computed", "computed", "computed"),
    "flattened": Variant(roughness_deformation="venner-1997"),
    "uncut": Variant(film_shape="flat", roughness_deformation="none", is_uncut=True),
    "plain": Variant(None, "flat", "none"),
    "plain, computed film": Variant("computed", "flat", "none"),
    "plain, computed shape": Variant("computed", "computed", "none"),
    "plain, surface": Variant(None, "flat", "none", is_on_surface=True),
    "computed shape, surface": Variant("computed", "computed", "none", is_on_surface=True),
    "complete": Variant("computed", "computed", "computed", is_on_surface=True),
}
"""All variants by name, the study's own first; the others are compared with it."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``variants.nc``; see `lube.stages`.

    Contact is sampled at any rarity if the study's lines are Gaussian and no formula flattens them.
    Otherwise, and for variants that cannot be sampled, it is counted on the study's realisations.
    Contact of the surface is always sampled; it is NaN where the lines stand for no isotropic
    surface, or a formula flattens them.
    """
    chosen = {name: variant.of(study) for name, variant in VARIANTS.items()}
    own, spec = chosen[STUDY], study.line_spec
    film_by = functools.cache(functools.partial(_film_by, study, inputs))
    films = {each: _film(each, study, inputs, film_by) for each in dict.fromkeys(chosen.values())}
    sampled = [
        each
        for each in films
        if each.is_on_surface or (study.is_sampled and not (each.gap.is_flattened or each.is_uncut))
    ]
    found = _on_lines(own, films, sampled, study, threads)
    for each, film in films.items():
        if each.is_on_surface:
            found[each] = _on_surface(each, film, found[own], study, threads)
    film, each_found = films[own], [found[each] for each in chosen.values()]
    thickness = np.array([films[each]["film_thickness"].values for each in chosen.values()])
    sizes = thickness.shape
    values = {name: np.reshape([one[name] for one in each_found], sizes) for name in found[own]}
    values |= {
        "film_thickness": thickness,
        "lambda_ratio": thickness / film["composite_rms_roughness"].item(),
        "roughness_ratio": [_roughness_ratio(each, spec, film) for each in chosen.values()],
        "is_sampled": [int(each in sampled) for each in chosen.values()],
        "film_formula": study.film_formulas[0],
    }
    coordinates = {name: film[name] for name in POINT_DIMS} | {"variant": list(VARIANTS)}
    return label(xr.Dataset(with_dims("variants", values), coordinates), "variants")


def _film_by(study, inputs, formula, shape):
    """Film by another formula, or that shares the load by another shape."""
    changed = {"with_shape": shape == "computed", "answered_lines": None}
    changed["slide_to_roll_ratio"] = rolling(study.slips)
    oil, rollers, choices = inputs["lubricant"], study.rough_rollers, study.film_model | changed
    force, speed = inputs["film"]["force"], inputs["film"]["speed"]
    film = film_at(oil, rollers, force, speed, [formula], **choices)
    return film[["film_thickness", "formula_place"]].isel(film_formula=0)


def _film(variant, study, inputs, film_by):
    """Film of a variant, in pure rolling or at the study's first slip."""
    film = at_slip(inputs["film"]).isel(film_formula=0).transpose(*POINT_DIMS, ...)
    profile = inputs["film_profile"].transpose(*POINT_DIMS, "film_position")
    shape = "computed" if variant.film_shape == "computed" else "flat"
    is_own = variant.film == study.film_formulas[0]
    if variant.film == "computed" and study.load_sharing == "none":
        thinner = film["inlet_shear_heating_factor"] if study.inlet_shear_heating != "none" else 1.0
        film = film.assign(film_thickness=thinner * profile["central_film"])
        film["formula_place"] = "central"
    elif not is_own or (study.load_sharing != "none" and shape != study.film_shape):
        film = film.assign(film_by(variant.film, shape))
    film["film_thickness"] = film["film_thickness"].transpose(*POINT_DIMS)
    kind, names = "film_response", VARIABLES
    if variant.is_on_surface and "surface_response" in inputs:
        kind, names = "surface_response", SURFACE_VARIABLES
    response = inputs[kind][list(names)].rename(film_position="response_position")
    film = film.assign(response.sel(slide_to_roll_ratio=rolling(study.slips), drop=True))
    if variant.film_shape == "flat":
        return film.drop_vars("film_profile", errors="ignore")
    if variant.film_shape == "computed":
        return film.assign(film_profile=profile["film"])
    gap = profile["film_position"].copy(data=hertz_gap(profile["film_position"].values))
    gap = gap.drop_attrs() * film["contact_half_width"] ** 2 / film["reduced_radius"]
    return film.assign(film_profile=film["film_thickness"] + gap)


def _on_lines(own, films, sampled, study, threads):
    """Probabilities of the variants of lines, the study's own among them."""
    windows = {
        each: ContactWindows(study.line_spec, film, study.boundary_layer, each.gap)
        for each, film in films.items()
        if not each.is_on_surface
    }
    counted = [own, *(each for each in windows if each not in sampled and each != own)]
    found = _counted(counted, windows, study, threads)
    if on_lines := [each for each in windows if each in sampled]:
        found |= _sampled(on_lines, windows, study, threads)
    return found


def _sampled(variants, windows, study, threads):
    """Probabilities by importance sampling."""
    values = np.stack(
        [windows[each].on_pairs(study.line_spec, study.seed, PAIRS, threads) for each in variants],
        axis=1,
    )
    mean, lower, upper = confidence.mean_interval(values, 1.0)
    upper[:, 1] = confidence.breakthrough_limit(upper[:, 1], upper[:, 0], WINDOWS * PAIRS)
    return _with_limits(variants, values, (mean, lower, upper))


def _counted(variants, windows, study, threads):
    """Probabilities counted on the study's realisations."""

    def run(number):
        pair = drawn(study, number)
        return [_count(each, windows[each], pair) for each in variants]

    values = np.array(on_threads(run, range(study.realisations), threads))
    widths = (2 * windows[variants[0]].half_windows + 1) * study.line_spec.spacing
    independent = study.line_spec.independent_windows(widths)
    return _with_limits(variants, values, confidence.probability_interval(values, independent))


def _on_surface(variant, film, own, study, threads):
    """Probabilities on surfaces, and their ratios to the study's own, which are independent."""
    unknown = np.full(film["film_thickness"].size, np.nan)
    found = {f"{name}{end}": unknown for name in PROBABILITIES for end in LIMITS}
    if study.has("surface_response") and variant.gap.is_on_surfaces:
        contact = surface_contact(replace(RoughPair.of(study), gap=variant.gap), film, threads)
        found = {name: contact[name].transpose(*POINT_DIMS).values.ravel() for name in found}
    name = "breakthrough_probability"
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.where(own[name] > 0.0, found[name] / own[name], np.nan)
        half_widths = [
            (each[f"{name}_upper"] - each[f"{name}_lower"]) / (2.0 * each[name])
            for each in (found, own)
        ]
        error = np.hypot(*half_widths)
        limits = ratio, ratio * np.exp(-error), ratio * np.exp(error)
    return found | values_with_limits("probability_ratio", limits)


def _count(variant, windows, pair):
    if not variant.is_uncut:
        return windows.count(pair)[:, :2].T
    breakthrough = windows.count_uncut(pair)
    return [np.full_like(breakthrough, np.nan), breakthrough]


def _with_limits(variants, values, means):
    """Probabilities of each variant, and their ratios to those of the first on the same lines."""
    contact, breakthrough = np.moveaxis(np.array(means), 2, 0)
    ratio = np.array(confidence.ratio_interval(values[:, :, 1], values[:, :1, 1]))
    return {
        each: values_with_limits("geometric_contact_probability", contact[:, at])
        | values_with_limits("breakthrough_probability", breakthrough[:, at])
        | values_with_limits("probability_ratio", ratio[:, at])
        for at, each in enumerate(variants)
    }


def _roughness_ratio(variant, spec, film):
    """Rms height of both lines together at the line of centres, over that as drawn."""
    is_drawn = variant.roughness_deformation == "none"
    if is_drawn or variant.is_on_surface:
        return np.full(film["film_thickness"].shape, 1.0 if is_drawn else np.nan)
    wavelengths, powers = zip(*(line_waves(spec, roller) for roller in (0, 1)), strict=True)
    power = np.concatenate(powers)

    def ratio(half_width, *contact):
        if any(np.isnan(each).any() for each in contact):  # the film is not known
            return np.nan
        scaled = [each / half_width for each in wavelengths]
        if variant.gap.is_answered:
            centre, solved = np.zeros(1), film["wavelength"].values / half_width
            both = zip(scaled, contact[0] + 1j * contact[1], strict=True)
            kept = [at_wavelengths(own, solved, one[:, None], centre)[:, 0] for own, one in both]
        else:
            kept = [amplitude_ratio(own, *contact) for own in scaled]
        return np.sqrt(np.sum(np.abs(np.concatenate(kept)) ** 2 * power) / np.sum(power))

    names, dims = ("contact_half_width", "moes_load", "moes_material"), []
    if variant.gap.is_answered:
        names, dims = ("contact_half_width", *VARIABLES[:2]), ["roller", "wavelength"]
        film = film.sel(response_position=0.0)
    contact = [film[name].drop_attrs() for name in names]
    options = {"input_core_dims": [[], dims, dims], "vectorize": True}
    return xr.apply_ufunc(ratio, *contact, **options).transpose(*POINT_DIMS).values
