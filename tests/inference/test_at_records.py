"""The model at each record's own conditions: what the grid has, and what a literal run finds."""

import itertools

import numpy as np
import pytest
import xarray as xr
from experiments import experiment_at, experiment_of, model_of_records
from literal_scan import scan_statistics
from studies import OIL

from lube.contact.rough_pair import drawn, roughness_batch
from lube.contact.windows import study_windows
from lube.grid.discretise import layer_factor_of, line_pair, speed_ratios, whole_numbers
from lube.inference.at_records import film_at_records
from lube.inference.record_scatter import alignment_windows, combined_deviations
from lube.stages import contact_statistics, film_table
from lube.statistics.one_pair import repeat_factor
from lube.statistics.sample_size import effective_sample_size
from lube.study.lubricant_record import load_record
from lube.study.oil_properties import lubricant_table

PROBABILITY = "breakthrough_probability"
CONDITIONS = [(250.0, 77.0, 66.6), (1234.5, 60.0, 79.3), (100.0, 100.0, 60.0), (90.0, 63.0, 80.4)]


def experiment_off_the_grid(order=(0, 1, 2, 3), **values):
    conditions = np.array(CONDITIONS)[list(order)].T
    return experiment_of(np.full(conditions.shape[1], 0.1), *conditions, **values)


@pytest.fixture(scope="module")
def few(busy):
    """The busy study with three realisations, for what has to be run."""
    study = busy.study.model_copy(update={"realisations": 3})
    return study, busy.film, busy.contact.isel(realisation=slice(3))


@pytest.fixture(scope="module")
def off_grid(few):
    study, film, contact = few
    return model_of_records(experiment_off_the_grid(), film, contact, study)


def film_of_records(experiment, study):
    """Films at records, by the study's choices."""
    oil = lubricant_table(study.lubricants, np.unique(experiment["temperature"]))
    return film_at_records(
        experiment, oil, study.rough_rollers, study.film_formulas, **study.film_model
    )


def literal_run(study, force, speed, temperature, realisations=3, slips=(0.0,)):
    """Film table and statistics of one operating point, by the stages themselves."""
    oil = lubricant_table(study.lubricants, [temperature])
    film = film_table(oil, study.rollers, [force], [speed], study.film_formulas)
    lines = roughness_batch(study.line_spec, study.seed, range(realisations))
    return film.squeeze(), contact_statistics(lines, film, study.boundary_layer, slips)


# Films and probabilities


def test_records_on_the_grid_have_the_values_of_the_grid_to_the_last_bit(busy):
    experiment = experiment_at(busy.film, np.zeros(12)).isel(record=[5, 0, 11, 5, 7])
    model = model_of_records(experiment, busy.film, busy.contact, busy.study)
    for number in range(experiment.sizes["record"]):
        record = experiment.isel(record=number)
        levels = {name: record[name].item() for name in ("force", "speed", "temperature")}
        here = model.isel(record=number)
        table, found = busy.film.sel(levels).squeeze(), busy.contact.sel(levels).squeeze()
        np.testing.assert_array_equal(here[PROBABILITY], found[PROBABILITY].values)
        for name in ("film_thickness", "lambda_ratio", "contact_half_width"):
            np.testing.assert_array_equal(here[name], table[name].values)


def test_points_of_the_grid_are_taken_from_its_file_and_not_run_again(busy):
    """A contact.nc with other values shows which records are taken from it."""
    other = busy.contact.assign({PROBABILITY: busy.contact[PROBABILITY] / 2.0})
    experiment = experiment_off_the_grid()
    taken = model_of_records(experiment, busy.film, other, busy.study)[PROBABILITY]
    right = model_of_records(experiment, busy.film, busy.contact, busy.study)[PROBABILITY]
    ratio = (taken / right).isel(realisation=0, film_formula=0)
    np.testing.assert_array_equal(ratio, [1.0, 1.0, 0.5, 1.0])


def test_a_file_without_one_turn_of_rolling_is_not_used_and_the_bits_stay(few):
    study, film, contact = few
    experiment = experiment_at(film, np.zeros(12))
    expected = model_of_records(experiment, film, contact, study)
    for change in ({"slide_to_roll_ratio": [0.1]}, {"revolutions": 2}):
        other = contact.assign({PROBABILITY: np.nan * contact[PROBABILITY]}).assign_coords(change)
        run = model_of_records(experiment, film, other, study)
        xr.testing.assert_equal(run, expected)


def test_records_off_the_grid_are_those_of_a_literal_run(off_grid, few):
    for number, conditions in enumerate(CONDITIONS):
        table, found = literal_run(few[0], *conditions)
        here = off_grid.isel(record=number)
        np.testing.assert_array_equal(here[PROBABILITY], found[PROBABILITY].squeeze())
        assert 0.0 < here[PROBABILITY].mean() < 1.0
        for name in ("film_thickness", "lambda_ratio", "moes_load", "moes_material"):
            np.testing.assert_array_equal(here[name], table[name].values)


@pytest.mark.parametrize("deformation", ["none", "venner-1997"])
def test_records_under_films_with_a_shape_are_those_of_contact_statistics(
    few, shaped_film, deformation
):
    """From contact.nc, or run if that holds none of one revolution."""
    study = few[0].model_copy(
        update={
            "film_shape": "computed",
            "film_formulas": tuple(shaped_film["film_formula"].values.tolist()),
            "roughness_deformation": deformation,
        }
    )
    lines = roughness_batch(study.line_spec, study.seed, range(3))
    contact = contact_statistics(lines, shaped_film, study.boundary_layer, gap=study.gap)
    experiment = experiment_at(shaped_film, np.zeros(4))
    expected = contact[PROBABILITY].squeeze(["slide_to_roll_ratio", "lubricant"])
    expected = expected.stack(record=["temperature", "speed", "force"]).transpose(
        "realisation", "film_formula", "record"
    )
    for stored in (contact, contact.assign_coords(revolutions=2)):
        model = model_of_records(experiment, shaped_film, stored, study)
        np.testing.assert_array_equal(model[PROBABILITY], expected.values)
    slipping = experiment_at(shaped_film, np.zeros(4), slide_to_roll_ratio=0.1, turns=3.0)
    model = model_of_records(slipping, shaped_film, contact, study)
    np.testing.assert_array_equal(model[PROBABILITY], expected.values)
    assert (model["scatter_ratio"] > 0.0).all()
    assert 0.0 < expected.min() < expected.max() < 1.0


def test_lines_are_paired_crosswise_under_the_films_of_records_with_a_shape(few, shaped_film):
    """As drawn, at the known films with the nearest lambda ratios."""
    formulas = tuple(shaped_film["film_formula"].values.tolist())
    study = few[0].model_copy(update={"film_shape": "computed", "film_formulas": formulas})
    model = film_of_records(experiment_at(shaped_film, np.zeros(4)), study)
    model["film_profile"] = model["film_profile"].where(model["record"] != 0)
    levels, windows = alignment_windows(model, study)
    known = model.isel(record=slice(1, None))
    ratios = known["lambda_ratio"].values.ravel()
    assert set(levels) <= set(ratios) and 1 < levels.size <= ratios.size
    assert np.all(np.diff(levels) > 0.0)
    pair = drawn(study, 0)
    expected = dict(zip(ratios, study_windows(study, known).count(pair)[:, 1], strict=True))
    np.testing.assert_array_equal(windows.count(pair)[:, 1], [expected[level] for level in levels])


def test_neither_order_nor_number_nor_slip_of_records_changes_a_probability(off_grid, few):
    study, film, contact = few
    for order in ([3, 1, 0, 2, 1, 1], [2]):
        model = model_of_records(experiment_off_the_grid(order), film, contact, study)
        expected = off_grid.isel(record=order)
        for name in off_grid.data_vars:
            np.testing.assert_array_equal(model[name], expected[name])
    slipping = experiment_off_the_grid(slide_to_roll_ratio=0.1)
    model = model_of_records(slipping, film, contact, study)
    xr.testing.assert_equal(model[PROBABILITY], off_grid[PROBABILITY])


def test_each_record_has_the_film_of_its_own_lubricant(few):
    study, film, contact = few
    study = study.model_copy(update={"lubricants": (*study.lubricants, load_record("n-dodecane"))})
    experiment = experiment_off_the_grid([0, 0], lubricant=["n-dodecane", OIL])
    model = model_of_records(experiment, film, contact, study)
    oil = lubricant_table(study.lubricants, [66.6])
    table = film_table(oil, study.rollers, [250.0], [77.0], study.film_formulas).squeeze()
    for record, name in enumerate(("n-dodecane", OIL)):
        expected = table["film_thickness"].sel(lubricant=name)
        np.testing.assert_array_equal(model["film_thickness"][:, record], expected)


# Scatter of one record


def test_equal_rollers_in_rolling_repeat_themselves(few, off_grid):
    """Longer records scatter no less, and are correlated as the realisations are."""
    turns = np.array([1.0, 1.3, 1.5, 1000.0])
    model = model_of_records(experiment_off_the_grid(turns=turns), few[1], few[2], few[0])
    for ratios in model["scatter_ratio"].values:
        np.testing.assert_allclose(ratios, repeat_factor(turns), rtol=1e-12)
    deviation = off_grid[PROBABILITY] - off_grid[PROBABILITY].mean("realisation")
    np.testing.assert_allclose(off_grid["record_deviation"], deviation, atol=1e-12)


def test_several_alignments_combine_effects_of_lines_alone_and_together():
    """Here the effects of lines alone are equal at all points, those together independent."""
    rng = np.random.default_rng(6)
    lines, meeting = rng.normal(size=(20_000, 1)), rng.normal(size=(20_000, 3))
    effects = np.repeat(lines, 3, axis=1)
    turn = np.sqrt(0.1) * effects + np.sqrt(0.9) * meeting
    alone, together = np.array([0.1, 0.1, 0.0]), np.array([0.3, 0.1, 0.2])
    found = combined_deviations(alone, together, effects, turn)
    expected = np.sqrt(alone[:, None] * alone) + np.diag(together)
    np.testing.assert_allclose(np.cov(found.T), expected, atol=0.01)


@pytest.mark.parametrize("slip", [0.0, 0.1])
def test_a_part_of_a_turn_scatters_as_parts_of_the_realisations_do(busy, slip):
    """Halves of each line, counted by hand; they differ by more than sqrt(2) times the whole."""
    study, film, contact = busy.study, busy.film, busy.contact
    experiment = experiment_off_the_grid([0], turns=0.5, slide_to_roll_ratio=slip)
    model = model_of_records(experiment, film, contact, study).isel(record=0)
    lines = roughness_batch(study.line_spec, study.seed, range(study.realisations))
    factor = layer_factor_of(study.line_spec, study.rollers.reduced_modulus, study.boundary_layer)
    thickness = model["film_thickness"].values
    points = whole_numbers(
        thickness, np.full(thickness.size, model["contact_half_width"]), study.line_spec
    )
    half, ratios = study.line_spec.points[0] // 2, speed_ratios(slip)
    shares = []
    for pair in (line_pair(lines, number) for number in range(study.realisations)):
        for begin in (0, half):
            begun = tuple(
                np.roll(line, -int(np.floor(begin * ratio + 0.5)))
                for line, ratio in zip(pair, ratios, strict=True)
            )
            counts = scan_statistics(begun, ratios, half, *points, factor)
            shares.append(counts[:, 1] / half)
    expected = np.var(shares, axis=0, ddof=1) / model[PROBABILITY].var("realisation", ddof=1)
    np.testing.assert_allclose(model["scatter_ratio"], expected, rtol=1e-9)


def test_one_revolution_with_slip_scatters_as_the_realisations_do(busy):
    experiment = experiment_off_the_grid([0], slide_to_roll_ratio=0.1)
    study = busy.study
    model = model_of_records(experiment, busy.film, busy.contact, study)
    _, found = literal_run(study, *CONDITIONS[0], study.realisations, (0.0, 0.1))
    rolling, slipping = found[PROBABILITY].var("realisation", ddof=1).squeeze()
    np.testing.assert_allclose(model["scatter_ratio"][:, 0], slipping / rolling, rtol=1e-9)


def test_turns_that_do_not_show_all_of_a_line_scatter_as_those_of_the_realisations(few):
    """Two turns with two thirds of the second line."""
    study, film, contact = few
    experiment = experiment_off_the_grid([0], turns=2.0, slide_to_roll_ratio=1.0)
    model = model_of_records(experiment, film, contact, study)
    force, speed, temperature = CONDITIONS[0]
    oil = lubricant_table(study.lubricants, [temperature])
    table = film_table(oil, study.rollers, [force], [speed], study.film_formulas)
    lines = roughness_batch(study.line_spec, study.seed, range(3))
    one, two = (
        contact_statistics(lines, table, study.boundary_layer, *run)[PROBABILITY]
        .var("realisation", ddof=1)
        .squeeze()
        for run in (([0.0], 1), ([1.0], 2))
    )
    np.testing.assert_allclose(model["scatter_ratio"][:, 0], two / one, rtol=1e-9)


def unequal(study):
    second = study.rollers.second.model_copy(update={"radius": 0.04})
    rollers = study.rollers.model_copy(update={"second": second})
    return study.model_copy(update={"rollers": rollers})


@pytest.mark.parametrize(
    ("change", "slip", "turns"),
    [
        # 40 alignments: three quarters of the scatter persist.
        pytest.param(lambda study: study, 0.1, 40, id="slip", marks=pytest.mark.slow),
        # Four turns of the first roller are five of the second: all four alignments.
        pytest.param(unequal, 0.0, 4, id="unequal rollers"),
        # A turn shows a third of the second line, which scatters far more than the whole.
        pytest.param(lambda study: study, 1.0, 6, id="much slip", marks=pytest.mark.slow),
    ],
)
def test_the_scatter_of_a_long_record_is_that_of_a_literal_run(busy, change, slip, turns):
    study, pairs = change(busy.study), 48
    force, speed, temperature = CONDITIONS[0]
    experiment = experiment_off_the_grid([0], turns=float(turns), slide_to_roll_ratio=slip)
    # Only its number of realisations is used.
    contact = busy.contact.isel(realisation=np.arange(pairs) % 32)
    contact = contact.assign_coords(realisation=range(pairs))
    model = model_of_records(experiment, busy.film, contact, study)
    oil = lubricant_table(study.lubricants, [temperature])
    film = film_table(oil, study.rollers, [force], [speed], study.film_formulas)
    lines = roughness_batch(study.line_spec, study.seed, range(pairs))
    one, long = (
        contact_statistics(lines, film, study.boundary_layer, *run)[PROBABILITY]
        .var("realisation", ddof=1)
        .squeeze()
        for run in (([0.0], 1), ([slip], turns))
    )
    # Two estimated variances of 48 pairs: known to some 20 % each.
    np.testing.assert_allclose(model["scatter_ratio"][:, 0], long / one, rtol=0.4)


def test_the_pooled_mean_is_that_of_each_first_line_with_four_second_lines(busy):
    """By a literal scan of every pairing; equal rollers in rolling have one alignment only."""
    study = busy.study.model_copy(update={"realisations": 6})
    contact = busy.contact.isel(realisation=slice(6))
    experiment = experiment_off_the_grid([0, 3], turns=5.0, slide_to_roll_ratio=0.1)
    model = model_of_records(experiment, busy.film, contact, study)
    lines = roughness_batch(study.line_spec, study.seed, range(6))
    factor = layer_factor_of(study.line_spec, study.rollers.reduced_modulus, study.boundary_layer)
    spread = xr.broadcast(model["film_thickness"], model["contact_half_width"])
    points = whole_numbers(*(one.values.ravel() for one in spread), study.line_spec)
    pairs = [line_pair(lines, number) for number in range(6)]
    expected = np.zeros(points[0].size)
    for number, other in itertools.product(range(6), range(4)):
        pair = pairs[number][0], pairs[(number + other) % 6][1]
        steps = pair[0].size
        expected += scan_statistics(pair, (1.0, 1.0), steps, *points, factor)[:, 1] / steps / 24
    np.testing.assert_allclose(model["pooled_probability"].values.ravel(), expected, rtol=1e-12)
    assert (model["pooled_error"] < 1.0).all() and (model["pooled_error"] >= 0.25).all()
    rolling = model_of_records(
        experiment_off_the_grid([0, 3], turns=5.0), busy.film, contact, study
    )
    np.testing.assert_array_equal(rolling["pooled_error"], 1.0)
    np.testing.assert_allclose(
        rolling["pooled_probability"], rolling[PROBABILITY].mean("realisation")
    )


def test_drift_makes_equal_rollers_scatter_less(few):
    study, film, contact = few
    drifting = study.model_copy(update={"rig": study.rig.model_copy(update={"drift": 0.5})})
    experiment = experiment_off_the_grid(turns=50.0)
    ratios = model_of_records(experiment, film, contact, drifting)["scatter_ratio"]
    assert (ratios < 0.2).all() and (ratios >= 0.02).all()


def test_one_realisation_gives_no_scatter_and_the_widest_interval(busy):
    study = busy.study.model_copy(update={"realisations": 1})
    experiment = experiment_off_the_grid(turns=40.0, slide_to_roll_ratio=0.1)
    model = model_of_records(experiment, busy.film, busy.contact.isel(realisation=[0]), study)
    # The interval is the widest: as if all scatter persisted.
    assert (model["scatter_ratio"] > 0.9).all()
    assert effective_sample_size(model[PROBABILITY].values, 7.0).tolist() == [[7.0] * 4] * 2
