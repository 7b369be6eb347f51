"""Runs and indices of a small study, on few samples."""

import numpy as np
import pytest
import xarray as xr
from made import made
from studies import CONFIG

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import surface_contact
from lube.contact.windows import study_windows
from lube.digits import six_digits
from lube.errors import DataError
from lube.schema import POINT_DIMS
from lube.sensitivity import indices, runs
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.indices import sobol
from lube.sensitivity.predictor import Predictor
from lube.sensitivity.runs import PAIRS, PLAIN_LINE, SEEDS, design, models, run
from lube.sensitivity.samples import SEED
from lube.stages import sensitivity
from lube.stages.film import make as make_film
from lube.stages.lubricant import make as make_lubricant
from lube.study.study import load_study
from lube.study.uncertainty import Uncertainty

PROBABILITY = "breakthrough_probability"
SOURCE = {"source": "assumed"}
SMALL = {
    "viscosity": {"range": "+- 10 %"} | SOURCE,
    "rms_roughness": {"range": "-29 % to 25 %"} | SOURCE,
    "hurst_exponent": {"range": "0.6 to 0.8"} | SOURCE,
    "critical_thickness": {"range": "-50 % to 0 %"} | SOURCE,
    "film_formula": {"choices": ["paper", "computed"]} | SOURCE,
    "film_shape": {"choices": ["flat", "computed"]} | SOURCE,
}


@pytest.fixture(scope="module")
def study():
    own = load_study(CONFIG / "smoke.yaml")
    roughness = own.roughness.model_copy(update={"points": 300_000})
    update = {"roughness": roughness, "uncertainty": Uncertainty.model_validate(SMALL)}
    return own.model_copy(update=update)


@pytest.fixture(scope="module")
def few():
    patch = pytest.MonkeyPatch()
    patch.setattr(runs, "SIZES", dict.fromkeys(runs.SIZES, (64, 2)))
    patch.setattr(indices, "BASE_SAMPLES", 256)
    patch.setattr(indices, "TRAJECTORIES", 100)
    yield
    patch.undo()


@pytest.fixture(scope="module")
def direct(study, few):
    return made(study, ["sensitivity_runs"])["sensitivity_runs"]


@pytest.fixture(scope="module")
def result(study, direct):
    return sensitivity.make(study, {"sensitivity_runs": direct})


def test_runs_do_not_depend_on_batches_or_the_number_of_threads(study, direct):
    deviating = Deviating.of(study)
    for model in models(deviating):
        unit, points = design(deviating, model)
        some = slice(8)
        found = run(deviating, model, unit[some], points.isel(run=some), threads=2)
        same = [direct[name].values == choice for name, choice in model._asdict().items()]
        expected = direct.isel(run=np.all(same, axis=0)).isel(run=some)
        for name in ("breakthrough_probability", "film_thickness"):
            np.testing.assert_array_equal(six_digits(found[name].values), expected[name])


@pytest.mark.parametrize(
    "name", ["critical_thickness", pytest.param("film_formula", marks=pytest.mark.slow)]
)
def test_a_factor_alone_explains_all_but_the_random_numbers(study, few, name):
    """Also one with which the films do not vary continuously."""
    factor = Uncertainty.model_validate({name: SMALL[name]})
    own = study.model_copy(update={"uncertainty": factor})
    found = sensitivity.make(own, made(own, ["sensitivity_runs"]))
    assert found["factor"].values.tolist() == [name, SEED]
    np.testing.assert_allclose(found["total_effect"].sum("factor"), 1.0, atol=0.1)


def test_runs_without_breakthroughs_are_refused_in_one_line(study, direct):
    """As of the smoke study, on whose coarse grid the layer of hardly any contact breaks."""
    probability = direct[PROBABILITY].where(direct["film_shape"] == "flat")
    expected = (
        r"^sensitivity: the boundary layer breaks in 0 of 128 runs of the model "
        r"'line, computed, none', need 20 or more: .* too coarse$"
    )
    with pytest.raises(DataError, match=expected):
        sensitivity.make(study, {"sensitivity_runs": direct.assign({PROBABILITY: probability})})


def test_runs_without_breakthroughs_are_not_counted_as_fitted(study, direct):
    probability = direct[PROBABILITY].where(direct["run"] % 4 > 0)
    found = sensitivity.make(study, {"sensitivity_runs": direct.assign({PROBABILITY: probability})})
    assert found["run_count"].values.tolist() == [96, 96]
    assert found["left_out_count"].values.tolist() == [24, 24]


def test_runs_leave_xarrays_options_as_they_were(direct):
    assert xr.get_options()["keep_attrs"] == "default"
    assert xr.get_options()["arithmetic_join"] == "inner"


def test_a_run_without_deviations_samples_what_the_study_samples(study):
    """Lines are shorter in a run, so the pairs are others."""
    factor = Uncertainty.model_validate({"force": {"range": "+- 1 %"} | SOURCE})
    own = study.model_copy(update={"uncertainty": factor})
    deviating, film = Deviating.of(own), make_film(own, {"lubricant": make_lubricant(own, {})})
    film = film.isel(film_formula=0).transpose(*POINT_DIMS, ...)
    points = film["film_thickness"].stack(run=POINT_DIMS).reset_index("run").coords.to_dataset()
    points = points.reset_coords()[list(POINT_DIMS)]
    count = points.sizes["run"]
    found = run(deviating, PLAIN_LINE, np.full((count, 1), 0.5), points)
    whole, windows = study_windows(own, film), SEEDS * PAIRS
    expected = [whole.sample(own.line_spec, own.seed, number)[0][1] for number in range(windows)]
    shorter = found["breakthrough_probability"].mean("seed").values
    assert shorter == pytest.approx(np.mean(expected, axis=0), rel=0.15)
    assert (shorter > 0.0).all()


def test_where_a_run_is_noisy_more_pairs_are_sampled(study, monkeypatch):
    deviating = Deviating.of(study)
    unit, points = design(deviating, PLAIN_LINE)
    some = unit[:24], points.isel(run=slice(24))
    found = []
    for noisy in (np.inf, 0.02):
        monkeypatch.setattr(runs, "NOISY", noisy)
        table = run(deviating, PLAIN_LINE, *some)
        found.append(np.log(table["breakthrough_probability"].transpose("run", "seed").values))
    few, many = (each.std(axis=1, ddof=1) for each in found)
    known = np.isfinite(few) & np.isfinite(many)
    # Nine times as many leave a third of the scatter.
    assert np.nanmean(many[known]) < 0.6 * np.nanmean(few[known])
    np.testing.assert_allclose(found[0].mean(axis=1), found[1].mean(axis=1), atol=0.3)


def test_where_most_layers_hold_more_surfaces_are_sampled(study):
    """Few surfaces show no contact, or one of very many, that breaks its layer."""
    length = study.rollers.length
    film = xr.Dataset(
        {
            "film_thickness": ("run", 2.83e-7 * np.array([2.0, 3.0, np.nan])),
            "contact_half_width": ("run", np.full(3, study.rollers.contact_half_width(400.0))),
            "reduced_modulus": study.rollers.reduced_modulus,
        }
    )
    found, few, whole = [], [], []
    for strength in (1.0, 5.0):
        layer = study.boundary_layer
        layer = layer.model_copy(update={"shear_strength": strength * layer.shear_strength})
        pair = RoughPair(study.line_spec, length, layer, study.seed)
        with np.errstate(invalid="ignore"):  # a single surface has no scatter
            found.append(runs._of_surfaces(pair, film, 1.0)[0])
            few.append(surface_contact(pair, film, 1, fewer=runs.FEWER_SURFACES[0])[PROBABILITY])
        whole.append(surface_contact(pair, film, 1)[PROBABILITY])
    np.testing.assert_array_equal(found[0][:, 0], few[0])
    assert (few[1] > 3.0 * whole[1])[:2].all()
    assert found[1].mean(axis=1)[:2] == pytest.approx(whole[1].values[:2], rel=0.5)
    assert np.isnan(found).all(axis=(0, 2)).tolist() == [False, False, True]


def test_indices_are_parts_of_the_variance(result):
    assert result["factor"].values.tolist() == [*SMALL, SEED]
    assert result["factor_group"].values.tolist() == ["oil", "surface", "layer", "film", SEED]
    first, total = result["first_order"], result["total_effect"]
    error = total - result["total_effect_lower"]
    first_error = first - result["first_order_lower"]
    assert ((first - first_error <= total + error) & (total > -2.0 * error)).all()
    together = first.sum("factor")
    assert ((together > 0.6) & (together < 1.15)).all()
    groups = result["group_first_order"]
    for group in ("surface", "film"):
        members = first.sel(factor=first["factor"][result["group_of_factor"] == group])
        assert (abs(groups.sel(factor_group=group) - members.sum("factor")) < 0.2).all()


def test_what_matters_is_told_from_what_does_not(result):
    total = result["total_effect"].mean(POINT_DIMS)
    assert total.sel(factor="rms_roughness") > 5.0 * total.sel(factor="viscosity")
    assert total.sel(factor=SEED) < 0.1
    effect = result["elementary_effect"].mean(POINT_DIMS)
    assert effect.sel(factor="hurst_exponent") > 2.0 * effect.sel(factor=SEED)


def test_the_band_holds_its_median_and_is_as_wide_as_the_deviation_says(result):
    lower, median, upper = (
        np.log(result[f"breakthrough_probability_{end}"]) for end in ("lower", "median", "upper")
    )
    assert ((lower < median) & (median < upper)).all()
    width = (upper - lower) / (2.0 * 1.645 * result["log_probability_deviation"])
    assert ((width > 0.7) & (width < 1.2)).all()


def test_surrogates_miss_runs_that_they_have_not_seen_by_little(result):
    assert result["surrogate_model"].values.tolist() == [
        "line, flat, none",
        "line, computed, none",
    ]
    assert (result["surrogate_error"] < 0.15).all()
    assert (result["relative_surrogate_error"] < 0.15).all()
    assert result["film_surrogate_error"] < 0.005
    assert result["run_count"].values.tolist() == [128, 128]
    assert result["left_out_count"].values.tolist() == [32, 32]


def test_each_sample_has_the_model_film_and_random_numbers_that_it_chooses(study, direct):
    """The surrogate's values against direct runs of the same samples."""
    deviating = Deviating.of(study)
    predictor = Predictor.of(deviating, direct)
    for number, model in enumerate(models(deviating)):
        own = direct.isel(run=slice(128 * number, 128 * number + 12))
        unit = np.column_stack([own["factor_quantile"], np.full(12, 0.3)])  # the second seed
        unit[:, -2] = 0.25 + 0.5 * number
        predicted = predictor.log_probability(unit)
        points = own.reset_coords()[list(POINT_DIMS)].to_dataframe()
        known = [
            deviating.levels[name].index(value)
            for row in points[list(POINT_DIMS)].itertuples(index=False)
            for name, value in zip(POINT_DIMS, row, strict=True)
        ]
        shape = [len(each) for each in deviating.levels.values()]
        at = np.ravel_multi_index(np.reshape(known, (-1, 4)).T, shape)
        found = predicted[np.arange(12), at]
        expected = np.log(own["breakthrough_probability"].isel(seed=1).values)
        assert found == pytest.approx(expected, abs=0.35), model


@pytest.mark.slow
def test_indices_of_the_flat_line_agree_with_those_of_direct_runs(study, monkeypatch):
    """128 base samples without any surrogate, at all operating points of the small study."""
    section = {key: SMALL[key] for key in list(SMALL)[:4]}
    own = study.model_copy(update={"uncertainty": Uncertainty.model_validate(section)})
    deviating = Deviating.of(own)
    predictor = Predictor.of(deviating, made(own, ["sensitivity_runs"])["sensitivity_runs"])
    names = [*section, SEED]
    levels = np.meshgrid(*deviating.levels.values(), indexing="ij")

    def directly(unit):
        points = {
            name: ("run", np.tile(values.ravel(), len(unit)))
            for name, values in zip(POINT_DIMS, levels, strict=True)
        }
        count, size = len(unit), levels[0].size
        found = run(
            deviating, PLAIN_LINE, np.repeat(unit[:, :-1], size, axis=0), xr.Dataset(points)
        )["breakthrough_probability"].values.reshape(count, size, SEEDS)
        seed = np.minimum((unit[:, -1] * SEEDS).astype(int), SEEDS - 1)
        return np.log(found[np.arange(count), :, seed])

    monkeypatch.setattr(indices, "BASE_SAMPLES", 128)
    exact, _ = sobol(names, directly, own.seed)
    found, _ = sobol(names, predictor.log_probability, own.seed)
    for name in ("first_order", "total_effect"):
        error = np.hypot(*(one[f"{name}_upper"] - one[name] for one in (exact, found)))
        assert (np.abs(exact[name] - found[name]) < error).mean() > 0.9
