"""The contact stage: every label in its place, exact identities, then known magnitudes."""

import math
from fractions import Fraction
from itertools import groupby, product

import numpy as np
import pytest
import scipy.stats
import xarray as xr

from lube.grid.discretise import line_pair
from lube.grid.operating_points import at_slip
from lube.kernels.layer import layer_factor
from lube.kernels.strips import strip_statistics
from lube.schema import OPERATING_DIMS
from lube.stages import BoundaryLayer, contact_map, contact_statistics, gather_map, roughness_lines
from lube.stages import master as module
from lube.surfaces.synthetic import draw_realisation

MEANS = (
    "geometric_contact_probability",
    "breakthrough_probability",
    "mean_contact_length",
    "mean_contact_force",
)


@pytest.fixture(scope="module")
def layer(study):
    return study.boundary_layer


@pytest.fixture(scope="module")
def contact(lines, film, layer):
    return contact_statistics(lines, film, layer)


def same(left, right):
    """Whether two results hold the same numbers."""
    return all(np.array_equal(left[name].values, right[name].values) for name in MEANS)


def points_of(film):
    return [
        dict(zip(OPERATING_DIMS, levels, strict=True))
        for levels in product(*(film[name].values for name in OPERATING_DIMS))
    ]


def kernel_means(lines, realisation, point, layer, modulus):
    """Means of one operating point (film thickness and half-width) in rolling, by the kernel."""
    spacing, height_step = lines.attrs["spacing"], lines.attrs["height_step"]
    film, half_width = point
    pair = line_pair(lines, realisation)
    steps = pair[0].size
    factor = layer_factor(
        modulus, layer.critical_thickness, layer.shear_strength, spacing, height_step
    )
    films = np.array([round(film / height_step)])
    half_windows = np.array([math.floor(half_width / spacing)])
    counts = strip_statistics(pair, (1.0, 1.0), steps, films, half_windows, factor)[0]
    touching, breaking, points, overlap = (int(count) / steps for count in counts)
    return [touching, breaking, points * spacing, modulus * spacing * overlap * height_step]


def point_at(film, point):
    half_width = film["contact_half_width"].sel(force=point["force"])
    return film["film_thickness"].sel(point).item(), half_width.item()


def test_every_value_is_the_kernels_at_the_labelled_point(lines, film, layer, contact):
    modulus, distinct = film["reduced_modulus"].item(), set()
    for realisation, point in product((0, 1), points_of(film)):
        here = point_at(film, point)
        expected = kernel_means(lines, realisation, here, layer, modulus)
        found = contact.sel(realisation=realisation, slide_to_roll_ratio=0.0, **point)
        assert [found[name].item() for name in MEANS] == pytest.approx(expected, rel=1e-13)
        distinct.add(tuple(expected))
    assert len(distinct) > 150  # of 240: mixed-up points would show


def naive_means(pair, ratio, film, half_width, modulus, layer, spacing, height_step):
    """The model of physics.md (section 5), in metres, newtons and exact fractions."""
    z1, z2 = ([Fraction(height_step) * int(z) for z in line] for line in pair)
    dx, modulus = Fraction(spacing), Fraction(modulus)
    v1, v2 = 1 + Fraction(ratio) / 2, 1 - Fraction(ratio) / 2
    j = range(-math.floor(Fraction(half_width) / dx), math.floor(Fraction(half_width) / dx) + 1)
    steps = len(z1) if v1 >= v2 else len(z2)
    touching = breaking = length = force = 0
    for t in range(steps):
        s1, s2 = (math.floor(t * v / max(v1, v2) + Fraction(1, 2)) for v in (v1, v2))
        gaps = [z1[(s1 + i) % len(z1)] + z2[(s2 + i) % len(z2)] - film for i in j]
        segments = [list(run) for contact, run in groupby(gaps, lambda z: z > 0) if contact]
        broken = Fraction(0)
        for segment in segments:
            d = len(segment) * dx
            f = modulus * dx * sum(segment)  # Eq. 5
            remaining = Fraction(math.pi) * Fraction(layer.shear_strength) / 12 * d**3 / f  # Eq. 6
            broken += d if remaining < Fraction(layer.critical_thickness) else 0
            force += f
        touching += bool(segments)
        breaking += broken > 0
        length += broken
    return [float(Fraction(total) / steps) for total in (touching, breaking, length, force)]


def table_of(film, films, half_widths):
    """Film table of one oil with every combination of film and half-width, by speed and force."""
    table = film.isel(
        temperature=[0], film_formula=[0], speed=[0] * len(films), force=[0] * len(half_widths)
    ).assign_coords(speed=np.arange(len(films)) + 1.0, force=np.arange(len(half_widths)) + 1.0)
    thickness = np.broadcast_to(np.reshape(films, (1, 1, 1, -1, 1)), table["film_thickness"].shape)
    return table.assign(
        film_thickness=table["film_thickness"].copy(data=thickness),
        contact_half_width=table["contact_half_width"].copy(data=half_widths),
    )


@pytest.mark.parametrize("ratio", [0.0, 0.25, -0.25, 2.0])
def test_contact_equals_a_naive_model_in_metres_and_newtons(make_spec, film, ratio):
    spec = make_spec(150, second_radius=0.04, longest_wavelength=0.1)
    lines = roughness_lines(spec, 3, [0])
    films, widths = [0.1e-6, 0.35e-6], [2.7 * spec.spacing, 5.2 * spec.spacing]
    modulus = film["reduced_modulus"].item()
    weak = BoundaryLayer.model_construct(critical_thickness=5e-9, shear_strength=3.0)
    found = contact_statistics(lines, table_of(film, films, widths), weak, [ratio])
    for number, (h0, half_width) in enumerate(zip(films, widths, strict=True)):
        whole = Fraction(round(h0 / spec.height_step)) * Fraction(spec.height_step)
        scale = (modulus, weak, spec.spacing, spec.height_step)
        expected = naive_means(line_pair(lines, 0), ratio, whole, half_width, *scale)
        values = [found[name].isel(speed=number, force=number).item() for name in MEANS]
        assert values == pytest.approx(expected, rel=1e-12)
        assert ratio == 2.0 or 0.0 < expected[1] < expected[0] < 1.0


# Identities


def test_only_film_and_half_width_matter(lines, film, layer, contact):
    """Equal (h0, 2a) give equal results at any force, speed and temperature."""
    few = film.isel(force=[0, 1, 4])
    films = xr.DataArray([0.3e-6, 0.6e-6, 0.3e-6], dims="force")
    few["film_thickness"] = few["film_thickness"] * 0.0 + films
    few["contact_half_width"] = few["contact_half_width"].copy(data=[2e-4, 2e-4, 2e-4])
    results = contact_statistics(lines, few, layer)
    for name in MEANS:
        values = results[name].transpose("force", "realisation", ...).values
        assert (values[0] == values[2]).all()
        assert (values[0] > values[1]).all()
        assert (values == values[:, :, :1, :1, :1, :1, :1]).all()
        assert (values[:, 0] != values[:, 1]).all()
    turned = film.transpose("force", "speed", "film_formula", "temperature", "lubricant", ...)
    # Equal rollers without slip repeat themselves.
    assert same(contact_statistics(lines, turned, layer, revolutions=3), contact)


def test_contact_falls_with_the_film_and_rises_with_the_width(lines, film, layer):
    films = np.linspace(0.0, 1.6e-6, 17)
    half_widths = np.array([2e-6, 2e-5, 5e-5, 1e-4, 2.1e-4])
    contact = contact_statistics(lines, table_of(film, films, half_widths), layer)
    for name in ("geometric_contact_probability", "mean_contact_force"):  # sets within sets
        assert (contact[name].diff("speed") <= 0.0).all()
        assert (contact[name].diff("force") >= 0.0).all()
        assert contact[name].isel(speed=0).min() > contact[name].isel(speed=-1).max()
    # A thicker film can part one segment into two that break, so breakthrough falls on average.
    breaking = contact["breakthrough_probability"].mean("realisation").isel(speed=slice(2, None, 3))
    assert (breaking.isel(force=slice(1, None)).diff("speed") < 0.0).all()
    assert (breaking.isel(force=slice(1, None), speed=[0, 1, 2]).diff("force") > 0.0).all()


def test_load_share_is_the_force_over_the_load_of_a_patch(contact, film, study):
    """F_N 2a/L'."""
    width = 2.0 * study.rollers.contact_half_width(film["force"])
    load = film["force"] * width / study.rollers.length
    assert (contact["contact_load_share"] > 0.0).any()
    expected = contact["mean_contact_force"] / load
    np.testing.assert_allclose(contact["contact_load_share"], expected, rtol=1e-12)


def test_springs_pressed_flat_carry_what_their_stiffness_says(film, layer):
    """A smooth line pressed in by d everywhere: E* 2a d, over the load of the patch."""
    points, depth = 20_000, 1e-7
    spacing = 2.0 * np.pi * 0.05 / points
    heights = np.full((1, 2, points), 0.5 * depth)
    few = film.isel(temperature=[0], speed=[0], film_formula=[0])
    few = few.assign(film_thickness=0.0 * few["film_thickness"])
    lines = xr.Dataset(
        {"height": (("realisation", "roller", "position"), heights)},
        {"realisation": [0]},
        {
            "spacing": spacing,
            "height_step": 1e-12,
            "points": [points] * 2,
            "q_min": 1e4,
            "q_max": 1e6,
        },
    )
    share = contact_statistics(lines, few, layer)["contact_load_share"].squeeze()
    window = (2 * np.floor(few["contact_half_width"] / spacing) + 1) * spacing
    force = few["reduced_modulus"] * window * depth
    load = few["hertz_pressure"] * np.pi * few["contact_half_width"] ** 2
    np.testing.assert_allclose(share, force / load, rtol=1e-9)


def test_slip_changes_which_asperities_meet_and_next_to_none_changes_nothing(lines, film, layer):
    """In one revolution 1e-9 of slip is less than a grid point."""
    few = film.isel(temperature=[2], speed=[0, 1], force=[2, 4])
    contact = contact_statistics(lines, few, layer, [-1e-9, 0.0, 1e-9, 0.3])
    back, rolling, forth, slip = (contact.isel(slide_to_roll_ratio=number) for number in range(4))
    assert same(back, rolling) and same(forth, rolling)
    assert not same(slip, rolling)


def test_each_slip_has_the_film_that_heating_leaves_there(lines, film, layer):
    few = film.isel(temperature=[2, 3], speed=[0, 1], force=[2, 4])
    slips = [0.0, 0.3]
    thinner = xr.DataArray([1.0, 0.8], {"slide_to_roll_ratio": slips}, "slide_to_roll_ratio")
    heated = few.drop_dims("slide_to_roll_ratio").assign(
        film_thickness=thinner * few["film_thickness"], lambda_ratio=thinner * few["lambda_ratio"]
    )
    contact = contact_statistics(lines, heated, layer, slips)
    for slip in slips:
        alone = contact_statistics(lines, at_slip(heated, slip), layer, [slip])
        xr.testing.assert_identical(contact.sel(slide_to_roll_ratio=[slip]), alone)
    cold = contact_statistics(lines, few, layer, slips)
    assert same(cold.isel(slide_to_roll_ratio=0), contact.isel(slide_to_roll_ratio=0))
    name = "geometric_contact_probability"
    more = (contact[name] - cold[name]).sel(slide_to_roll_ratio=0.3)
    assert (more >= 0.0).all() and more.sum() > 0.0
    mapped = contact_map(lines, heated, layer)
    assert mapped["lambda_ratio"].min() == pytest.approx(0.3 * heated["lambda_ratio"].min().item())


def test_the_travel_is_the_circumference_of_the_smaller_roller(make_spec, film, layer):
    few = film.isel(temperature=[0], speed=[0], force=[0])
    for second_radius in (0.02, 0.05, 0.08):
        spec = make_spec(6000, second_radius, shortest_wavelength="4.0 points")
        contact = contact_statistics(roughness_lines(spec, 3, [0]), few, layer)
        assert contact.attrs["travel"] == pytest.approx(2 * np.pi * min(0.05, second_radius))


# Magnitudes at the paper's fineness, 1600 N window.


@pytest.fixture(scope="module")
def ensemble(make_spec, study, film):
    """Shares of time and mean overlap of a dozen realisations at four films."""
    spec = make_spec(1_000_000)
    half_window = math.floor(film["contact_half_width"].sel(force=1600.0).item() / spec.spacing)
    films = np.array([300_000, 600_000, 800_000, 1_000_000])
    factor = layer_factor(film["reduced_modulus"].item(), 5e-9, 1e6, spec.spacing, spec.height_step)
    statistics = []
    for realisation in range(12):
        pair = draw_realisation(spec, 77, realisation)
        windows = np.full(4, half_window)
        statistics.append(strip_statistics(pair, (1.0, 1.0), 1_000_000, films, windows, factor))
    return spec, half_window, films, np.array(statistics) / 1e6


def test_breakthrough_probability_is_that_of_another_implementation(ensemble):
    """physics.md, section 6: mean and standard deviation over 40 seeds."""
    found = ensemble[-1][:, :, 1]
    mean, scatter = np.array([(0.832, 0.290, 0.0625, 0.0071), (0.011, 0.014, 0.0081, 0.0032)])
    error = np.hypot(found.std(axis=0, ddof=1) / math.sqrt(len(found)), scatter / math.sqrt(40))
    assert (np.abs(found.mean(axis=0) - mean) < 4.0 * error).all()


def test_mean_overlap_is_that_of_a_gaussian_line(ensemble):
    """W sigma (phi(x) - x Q(x)) with x = h0 / sigma, the mean of a Gaussian's excess."""
    spec, half_window, films, statistics = ensemble
    overlap = statistics[:, :, 3]
    sigma = math.hypot(*spec.rms_height) / spec.height_step
    x = films / sigma
    excess = scipy.stats.norm.pdf(x) - x * scipy.stats.norm.sf(x)
    error = overlap.std(axis=0, ddof=1) / math.sqrt(len(overlap))
    expected = (2 * half_window + 1) * sigma * excess
    assert (np.abs(overlap.mean(axis=0) - expected) < 4.0 * error).all()


# The master map


@pytest.fixture(scope="module")
def mapped(lines, film, layer):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "LEVELS", (6, 4))
        return contact_map(lines, film, layer)


def test_the_map_spans_all_films_and_windows_of_the_study_and_thinner_films(mapped, film):
    for prefix in ("", "layer_"):
        for name, values in (
            ("lambda_ratio", film["lambda_ratio"]),
            ("contact_width", 2.0 * film["contact_half_width"]),
        ):
            levels = mapped[prefix + name].values
            assert (np.diff(levels) > 0).all()
            assert levels[-1] == pytest.approx(values.max().item())
            assert np.isclose(levels, values.min().item()).any()
    assert mapped.sizes["lambda_ratio"] == 12 + 6
    assert mapped.sizes["contact_width"] == 4
    least = film["lambda_ratio"].min().item()
    assert mapped["lambda_ratio"].values[[0, 12]] == pytest.approx([0.3 * least, least])


def test_every_value_of_the_map_is_the_kernels(mapped, lines, film, layer):
    roughness, modulus = film["composite_rms_roughness"].item(), film["reduced_modulus"].item()
    for ratio, width in product(mapped["lambda_ratio"].values, mapped["contact_width"].values):
        point = ratio * roughness, width / 2.0
        expected = kernel_means(lines, 1, point, layer, modulus)
        found = mapped.sel(realisation=1, lambda_ratio=ratio, contact_width=width)
        assert [found[name].item() for name in MEANS[:2]] == expected[:2]


def test_every_layer_of_the_map_is_run_as_a_layer_of_its_own(mapped, lines, film, layer):
    roughness, modulus = film["composite_rms_roughness"].item(), film["reduced_modulus"].item()
    strengths = mapped["layer_strength"].values
    study = layer.shear_strength / layer.critical_thickness
    np.testing.assert_allclose(strengths / study, [1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8])
    for number, level in product((0, 3, 6), (0, 4)):
        # The thinner layer of the same shear strength, rather than the weaker one.
        other = BoundaryLayer.model_construct(
            shear_strength=layer.shear_strength,
            critical_thickness=layer.shear_strength / strengths[number],
        )
        here = mapped.isel(layer_strength=number, layer_lambda_ratio=level, layer_contact_width=-1)
        thickness = here["layer_lambda_ratio"].item() * roughness
        point = thickness, here["layer_contact_width"].item() / 2.0
        expected = kernel_means(lines, 1, point, other, modulus)[1]
        found = here["layer_breakthrough_probability"].sel(realisation=1)
        assert found == pytest.approx(expected, abs=2e-5)
    breaking = mapped["layer_breakthrough_probability"]
    assert (breaking.diff("layer_strength") <= 0.0).all()
    assert breaking.isel(layer_strength=0).max() > 2.0 * breaking.isel(layer_strength=-1).max()


def test_one_film_and_one_window_make_a_map_of_one_width(lines, film, layer):
    mapped = contact_map(lines, film.isel({name: [0] for name in OPERATING_DIMS}), layer)
    assert mapped.sizes["lambda_ratio"] == 12 + 1  # thinner films than the study's are added
    assert mapped.sizes["layer_lambda_ratio"] == mapped.sizes["contact_width"] == 1


def test_the_map_gets_its_intervals(mapped):
    gathered = gather_map([mapped.isel(realisation=[1]), mapped.isel(realisation=[0])])
    for name in MEANS[:2]:
        np.testing.assert_allclose(gathered[f"{name}_mean"], mapped[name].mean("realisation"))
        assert (gathered[f"{name}_lower"] <= gathered[f"{name}_mean"]).all()
        assert (gathered[f"{name}_upper"] > 0).all()


def test_where_the_film_is_not_known_contact_is_not_either(lines, film, layer, contact):
    holed = film.copy(deep=True)
    holed["film_thickness"][0, 0, 1, 1, 1] = np.nan
    found = contact_statistics(lines, holed, layer)
    for name in MEANS:
        expected = contact[name].copy(deep=True)
        expected[:, :, 0, 0, 1, 1, 1] = np.nan
        np.testing.assert_array_equal(found[name], expected)
