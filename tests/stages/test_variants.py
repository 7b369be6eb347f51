"""Contact of a study with one choice made otherwise: the same lines, the other stages' numbers."""

import numpy as np
import pytest
from made import made

from lube.grid.film_responses import SURFACE_VARIABLES, VARIABLES
from lube.physics.flattening import amplitude_ratio
from lube.schema import LIMITS, POINT_DIMS
from lube.stages import tail, variants
from lube.stages.film import film_table
from lube.stages.variants import STUDY, VARIANTS, make
from lube.statistics.confidence import error_of_limits
from lube.surfaces.synthetic import draw_realisation

GRID = {"force": (400.0, 1600.0), "speed": (100.0,), "temperature": (60.0, 80.0)}
FORMULAS = ("paper", "pan-hamrock", "computed")
KINDS = ["lubricant", "film", "film_profile", "film_response", "surface_response", "contact"]
KINDS += ["tail", "areal", "variants"]
ON_LINES = [name for name, one in VARIANTS.items() if not one.is_on_surface]


@pytest.fixture(scope="module")
def few(busy_study):
    """A study of four operating points and few realisations, its first film formula `paper`."""
    grid = busy_study.operating_grid.model_copy(update=GRID)
    changes = {"operating_grid": grid, "realisations": 6, "film_formulas": ("paper",)}
    return busy_study.model_copy(update=changes)


@pytest.fixture(scope="module", autouse=True)
def few_pairs():
    """The same pairs in both stages, and fewer."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (tail, variants):
            patch.setattr(module, "PAIRS", 12)
        yield


@pytest.fixture(scope="module")
def files(few, few_surfaces):
    return made(few, KINDS)


@pytest.fixture(scope="module")
def found(files):
    return files["variants"].squeeze(["lubricant", "speed"])


def close(found, expected, **tolerance):
    np.testing.assert_allclose(found, expected.transpose(*found.dims), **tolerance)


def test_the_studys_own_choices_are_sampled_as_in_the_tail(found, files):
    own, tail = found.sel(variant=STUDY), files["tail"].squeeze()
    for name in ("breakthrough_probability", "geometric_contact_probability"):
        for end in ("", "_lower", "_upper"):
            close(own[name + end], tail[name + end], rtol=1e-12)
    assert (own["probability_ratio"] == 1.0).all()
    same = found.sel(variant=["paper", "as drawn"])  # as the study has them
    assert (same["breakthrough_probability"] == own["breakthrough_probability"]).all()


def test_the_surface_is_that_of_the_areal_stage_on_another_grid(found, files):
    own, areal = found.sel(variant="plain, surface"), files["areal"].squeeze()
    name = "breakthrough_probability"
    for one in (own, areal):
        one["error"] = one[name].dims, error_of_limits([one[name + end].values for end in LIMITS])
    difference = own[name] - areal[name].transpose(*own[name].dims)
    error = np.hypot(own["error"], areal["error"].transpose(*own[name].dims))
    assert (np.abs(difference) <= 4.0 * error).all() and (error < 0.1 * own[name]).all()
    line = found[name].sel(variant=STUDY)
    assert (own[name] > line).all()
    np.testing.assert_allclose(own["probability_ratio"], own[name] / line, rtol=1e-12)


def test_films_are_those_of_the_film_stage(found, files, few):
    film = film_table(files["lubricant"], few.rollers, GRID["force"], GRID["speed"], FORMULAS)
    film = film.squeeze()
    for name, formula in zip(("paper", "pan-hamrock", "computed, flat"), FORMULAS, strict=True):
        expected = film["film_thickness"].sel(film_formula=formula)
        close(found["film_thickness"].sel(variant=name), expected, rtol=1e-5)
    ratio = found["film_thickness"].sel(variant="pan-hamrock") / found["film_thickness"][0]
    np.testing.assert_allclose(ratio, 2.922 / 2.992, rtol=1e-12)


@pytest.mark.slow
@pytest.mark.usefixtures("few_surfaces")
def test_films_that_share_the_load_do_so_by_their_shape_and_heated(few):
    grid = few.operating_grid.model_copy(update={"force": (100.0,), "temperature": (80.0,)})
    changes = {"load_sharing": "iterated", "inlet_shear_heating": "wilson-sheu-1983"}
    shared = few.model_copy(update={"operating_grid": grid, "realisations": 2} | changes)
    others = {"contact", "tail", "areal"}
    found = made(shared, set(KINDS) - others)["variants"]["film_thickness"].squeeze()
    of_shapes = (("flat", "computed, flat"), ("computed", "computed"), ("computed", "complete"))
    for shape, name in of_shapes:
        itself = {"film_shape": shape, "film_formulas": ("computed",)}
        film = made(shared.model_copy(update=itself), ["lubricant", "film"])["film"]
        expected = film["film_thickness"].item()
        assert found.sel(variant=name).item() == pytest.approx(expected, rel=1e-5), name
    assert found.sel(variant="computed") > 1.005 * found.sel(variant="computed, open")


def test_a_thinner_film_has_more_contact_and_every_ratio_its_interval(found):
    printed, source = (found["breakthrough_probability"].sel(variant=one) for one in FORMULAS[:2])
    assert (source > printed).all()
    known = found["probability_ratio"] > 0.0
    for end, sign in (("_lower", -1.0), ("_upper", 1.0)):
        distance = found[f"probability_ratio{end}"] - found["probability_ratio"]
        assert (sign * distance.where(known, 0.0) >= 0.0).all()


def test_flattened_lines_are_counted_as_in_the_contact_stage(few, found):
    flattened = few.model_copy(update={"roughness_deformation": "venner-1997"})
    contact = made(flattened, ("lubricant", "film", "contact"))["contact"].squeeze()
    here = found.sel(variant="flattened")
    assert here["is_sampled"] == 0
    for end, mean in (("", "_mean"), ("_lower", "_lower"), ("_upper", "_upper")):
        expected = contact[f"breakthrough_probability{mean}"]
        close(here[f"breakthrough_probability{end}"], expected, rtol=1e-12)
    assert (here["probability_ratio"] < 1.0).all()


def test_whole_segments_break_less_often_than_the_parts_in_the_window(found, files):
    """The more so the narrower the contact; and the ratio is to the parts on the same lines."""
    here = found.sel(variant="uncut")
    parts = here["breakthrough_probability"] / here["probability_ratio"]
    close(parts, files["contact"]["breakthrough_probability_mean"].squeeze(), rtol=1e-12)
    ratio = here["probability_ratio"]
    assert ((ratio > 0.5) & (ratio < 1.0)).all() and (ratio.diff("force") > 0.0).all()


def test_where_the_lines_are_not_gaussian_all_is_counted(few):
    heights = few.roughness.model_copy(update={"skewness": -1.0, "kurtosis": 5.0})
    worn = few.model_copy(update={"roughness": heights, "realisations": 2})
    files = made(worn, KINDS)
    found, contact = files["variants"].squeeze(), files["contact"].squeeze()
    assert not found["is_sampled"].sel(variant=ON_LINES).any()
    own = found["breakthrough_probability"].sel(variant=STUDY)
    close(own, contact["breakthrough_probability_mean"], rtol=1e-12)
    known = found["breakthrough_probability"].notnull()
    assert known.sel(variant=ON_LINES).all() and known.sum("variant").max() == len(ON_LINES)


def test_a_film_that_did_not_converge_is_unknown_in_its_variants_alone(
    few, files, found, few_surfaces
):
    profile = files["film_profile"].transpose(*POINT_DIMS, ...).copy(deep=True)
    for name in ("film", "central_film"):
        profile[name][0, 0, 0, 1] = np.nan
    holed = files | {"film_profile": profile}
    for kind, names in (("film_response", VARIABLES), ("surface_response", SURFACE_VARIABLES)):
        holed[kind] = files[kind].copy(deep=True)
        for name in names:
            holed[kind][name].transpose(*POINT_DIMS, ...)[0, 0, 0, 1] = np.nan
    holed = make(few, holed).squeeze()
    for name in ("breakthrough_probability", "roughness_ratio"):
        needs = [
            one.gap.is_answered or (one.film == "computed" and name != "roughness_ratio")
            for one in VARIANTS.values()
        ]
        expected = found[name].copy()
        expected[needs, 0, 1] = np.nan
        np.testing.assert_array_equal(holed[name], expected)


def test_the_roughness_ratio_by_a_plain_transform(few, files):
    """All waves of both lines one by one, from the lines as drawn."""
    here = {"temperature": -1, "speed": 0, "force": -1, "lubricant": 0}
    point, power = files["film"].isel(here), np.zeros(2)
    moes = point["moes_load"].item(), point["moes_material"].item()
    for number in (0, 1):
        for line in draw_realisation(few.line_spec, few.seed, number):
            waves = np.fft.rfft(line)[1:]
            wavelength = line.size * few.line_spec.spacing / np.arange(1, waves.size + 1)
            kept = amplitude_ratio(wavelength / point["contact_half_width"].item(), *moes)
            power += [np.sum(np.abs(waves) ** 2), np.sum(np.abs(kept * waves) ** 2)]
    found = files["variants"].sel(variant="flattened")["roughness_ratio"].isel(here)
    assert found.item() == pytest.approx(np.sqrt(power[1] / power[0]), rel=0.03)


def test_every_variant_is_named_once(found):
    assert found["variant"].values.tolist() == list(VARIANTS)
    assert len(set(VARIANTS.values())) == len(VARIANTS)
