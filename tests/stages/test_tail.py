"""Contact at any rarity over the grid: theory and limits, then counting, then stored numbers."""

import dataclasses

import numpy as np
import pytest
import xarray as xr
from plain_answers import PlainAnswer

from lube.contact.window_films import window_films
from lube.contact.windows import study_windows
from lube.grid.discretise import speed_ratios
from lube.grid.gap import Gap
from lube.grid.operating_points import at_slip
from lube.kernels.layer import layer_factor
from lube.kernels.motion import surface_position
from lube.schema import CONTACT_DIMS, OPERATING_DIMS
from lube.stages import (
    contact_statistics,
    film_table,
    gather,
    lubricant_table,
    roughness_lines,
)
from lube.stages.areal import make as make_areal
from lube.stages.tail import _in_uneven_windows, _turn, make
from lube.study.rollers import OwnRoughness
from lube.surfaces.rare_contact import draw_pair

SEED = 1
RATIOS = (0.0, -0.1, 0.5)
COUNTED = "contact is counted in realisations, not sampled"
PROBABILITIES = ("breakthrough_probability", "geometric_contact_probability")


@pytest.fixture(scope="module")
def few(film):
    return film.isel(temperature=[0, 3], speed=[1], force=[0, 2, 4])


@pytest.fixture(scope="module")
def coarse(study):
    """The study on coarse lines, with other slips and boundary layer, and any other changes."""

    def change(slips=(0.0,), points=100_000, shear_strength=None, **changes):
        layer = {"shear_strength": shear_strength or study.boundary_layer.shear_strength}
        grid = {"slide_to_roll_ratio": tuple(slips)}
        own = {
            "seed": SEED,
            "roughness": study.roughness.model_copy(update={"points": points}),
            "operating_grid": study.operating_grid.model_copy(update=grid),
            "boundary_layer": study.boundary_layer.model_copy(update=layer),
        }
        return study.model_copy(update=own | changes)

    return change


@pytest.fixture(scope="module")
def spec(coarse):
    return coarse().line_spec


@pytest.fixture(scope="module")
def make_tail(coarse):
    """Make the dataset of a changed study with some films."""
    return lambda film, *args, threads=1, **changes: make(
        coarse(*args, **changes), {"film": film}, threads
    )


@pytest.fixture(scope="module")
def tail(make_tail, few):
    return make_tail(few, RATIOS)


@pytest.fixture(scope="module")
def rare(make_tail, few):
    """Contact with twice as thick films; on the coarse lines only a weak layer breaks."""
    thick = few.isel(film_formula=[0], temperature=[0])
    thick = thick.assign(film_thickness=2.0 * thick["film_thickness"])
    return make_tail(thick, shear_strength=3e4)


# --- Theory and limits -------------------------------------------------------------------


def test_lines_that_the_oil_flattens_are_refused_in_words(few, make_tail):
    found = make_tail(few, RATIOS, roughness_deformation="venner-1997")
    assert found.attrs["remarks"].startswith(
        f"{COUNTED}: roughness_deformation: got venner-1997, need none or computed"
    )
    assert all(np.isnan(found[name]).all() for name in found.data_vars)


def test_results_are_over_the_dimensions_of_the_contact_model(tail, few):
    assert tail["breakthrough_rate"].dims == CONTACT_DIMS
    assert tail["touching_pair_share"].dims == OPERATING_DIMS
    assert tail["slide_to_roll_ratio"].values.tolist() == list(RATIOS)
    for name in OPERATING_DIMS:
        np.testing.assert_array_equal(tail[name], few[name])


def test_probabilities_of_surfaces_stand_beside_those_of_lines(coarse, few, few_surfaces):
    both = coarse(contact_model=("surface", "line"), shear_strength=3e4)
    films = {"film": few.isel(force=[0])}
    films["areal"] = make_areal(both, films)
    without = coarse(shear_strength=3e4)
    assert make_areal(without, films).equals(films["areal"].isel(film_formula=[0]))
    found, lines = make(both, films), make(without, films)
    assert found["contact_model"].values.tolist() == ["surface", "line"]
    assert found["breakthrough_rate"].dims == ("contact_model", *CONTACT_DIMS)
    deviation = films["areal"]["pair_deviation"].isel(slide_to_roll_ratio=0, drop=True)
    assert found["surface_pair_deviation"].equals(deviation)
    of_lines = found.sel(contact_model="line", drop=True)
    assert of_lines.drop_vars("surface_pair_deviation").equals(lines)
    surface = found.sel(contact_model="surface", drop=True)
    for name in PROBABILITIES:
        assert surface[name].equals(films["areal"][name])
        assert (surface[name] > lines[name]).all()
    of_both = lines.drop_vars(("geometric_contact_asymptote", "breakthrough_asymptote"))
    for name, each in of_both.items():
        assert (surface[name].notnull() == each.notnull()).all(), name
    only = make(coarse(contact_model=("surface",), shear_strength=3e4), films)
    assert only.equals(found.sel(contact_model=["surface"]))


def test_each_interval_encloses_its_estimate(tail):
    for name in (*PROBABILITIES, "breakthrough_rate", "touching_pair_share"):
        lower, upper = tail[f"{name}_lower"], tail[f"{name}_upper"]
        certain = upper == 1.0
        assert np.all((lower >= 0.0) & (certain | (lower < upper)))
        assert np.all((certain | (lower < tail[name])) & (tail[name] <= upper))
    for name in PROBABILITIES:
        assert np.all(tail[f"{name}_upper"] <= 1.0)


def test_a_layer_that_no_sampled_contact_breaks_has_an_upper_limit(make_tail, few, tail):
    strong = make_tail(few.isel(film_formula=[0], temperature=[0]), shear_strength=1e12)
    assert np.all(strong["breakthrough_probability"] == 0.0)
    upper = strong["breakthrough_probability_upper"]
    assert np.all((upper > 0.0) & (upper < 1e-3 * strong["geometric_contact_probability"]))


def test_probabilities_do_not_depend_on_slip_but_contacts_become_more_and_shorter(tail):
    for name in PROBABILITIES:
        assert np.all(tail[name] == tail[name].isel(slide_to_roll_ratio=0))
    rate, duration = tail["breakthrough_rate"], tail["breakthrough_duration"]
    assert np.all(rate.diff("slide_to_roll_ratio") > 0.0)
    assert np.all(duration.diff("slide_to_roll_ratio") < 0.0)
    present = rate * duration
    np.testing.assert_allclose(present, present.isel(slide_to_roll_ratio=[0] * len(RATIOS)))


def test_a_roller_at_rest_makes_no_revolution():
    speed, slip = (
        xr.DataArray([0.5, 1.0], dims="speed"),
        xr.DataArray([-2.0, 0.0, 2.0], dims="slip"),
    )
    turn = _turn(0.3, speed, slip).transpose("slip", "speed")
    assert np.isnan(turn[0]).all()
    np.testing.assert_allclose(turn[1:], [[0.6, 0.3], [0.3, 0.15]])


def test_each_slip_has_the_film_that_heating_leaves_there(tail, few, make_tail):
    """With two formulas; what holds in pure rolling is not known without it."""
    name = "slide_to_roll_ratio"
    thinner = xr.DataArray([1.0, 0.95, 0.8], {name: list(RATIOS)}, name)
    heated = few.drop_dims("slide_to_roll_ratio").assign(
        film_thickness=thinner * few["film_thickness"]
    )
    found = make_tail(heated, RATIOS)
    assert found["breakthrough_asymptote"].dims == CONTACT_DIMS
    for ratio in RATIOS:
        one = at_slip(heated, ratio)
        alone = make_tail(one, [ratio])
        for name in (*PROBABILITIES, "breakthrough_rate", "breakthrough_duration"):
            here = found[name].sel(slide_to_roll_ratio=[ratio])
            np.testing.assert_allclose(here, alone[name], rtol=1e-12)
        for name in ("breakthrough_asymptote", "geometric_contact_asymptote"):
            here = found[name].sel(slide_to_roll_ratio=ratio)
            np.testing.assert_allclose(here, alone[name], rtol=1e-12)
    for name in ("touching_pair_share", "touching_pair_share_upper", "first_breakthrough_time"):
        np.testing.assert_allclose(found[name], tail[name], rtol=1e-12)
    without = make_tail(heated, RATIOS[1:])
    assert without["touching_pair_share"].isnull().all()
    expected = found["breakthrough_rate"].isel(slide_to_roll_ratio=slice(1, None))
    np.testing.assert_allclose(without["breakthrough_rate"], expected, rtol=1e-12)


def test_in_pure_rolling_a_breakthrough_lasts_as_long_as_its_passage(tail, few):
    width = 2.0 * few["contact_half_width"]
    passage = width / few["entrainment_speed"]
    longer = tail["breakthrough_duration"].isel(slide_to_roll_ratio=0) / passage
    assert longer.min() > 0.97 and longer.max() < 1.1


def test_rare_breakthroughs_come_to_few_pairs_in_the_middle_of_the_revolution(rare):
    count = rare["breakthroughs_per_revolution"].squeeze()
    share = rare["touching_pair_share"].squeeze()
    assert np.all(count < 1e-6) and count.min() < 1e-20
    assert np.all((0.6 * count < share) & (share <= count))
    revolution = 60.0 / rare["speed"].item()
    np.testing.assert_allclose(rare["first_breakthrough_time"], revolution / 2.0, rtol=1e-4)


def test_where_breakthroughs_are_many_every_pair_has_one_at_once(tail):
    often = tail.isel(film_formula=0, force=2, temperature=1, slide_to_roll_ratio=0).squeeze()
    assert often["touching_pair_share"] == pytest.approx(1.0, abs=1e-6)
    assert often["first_breakthrough_time"] < 0.1 * 60.0 / often["speed"]


def test_pairs_touch_at_least_as_often_as_one_of_their_independent_windows(tail, few, spec):
    length = 2.0 * few["contact_half_width"].max() + 2.0 * np.pi / spec.q_min
    without = 1.0 - tail["breakthrough_probability"].isel(slide_to_roll_ratio=0)
    one_of_many = 1.0 - without ** (2.0 * np.pi * 0.05 / length)
    assert np.all(tail["touching_pair_share"] >= one_of_many - 1e-12)


def test_for_high_films_the_probabilities_approach_theory(rare):
    for name in PROBABILITIES:
        ratio = rare[name] / rare[name.replace("probability", "asymptote")]
        # A line of points misses some crossings.
        assert np.all((ratio > 0.85) & (ratio < 1.02))


def test_threads_and_further_formulas_do_not_change_the_results(tail, few, make_tail):
    xr.testing.assert_identical(make_tail(few, RATIOS, threads=3), tail)
    alone = make_tail(few.isel(film_formula=[0]), RATIOS)
    xr.testing.assert_identical(alone, tail.isel(film_formula=[0]))


# --- Counting ----------------------------------------------------------------------------


def test_an_ensemble_finds_the_same_probabilities(tail, spec, few, study):
    lines = roughness_lines(spec, SEED, range(24))
    contact = gather([contact_statistics(lines, few, study.boundary_layer)], few)
    rolling = tail.sel(slide_to_roll_ratio=0.0)
    seen = 0
    for name in PROBABILITIES:
        mean = contact[f"{name}_mean"].isel(slide_to_roll_ratio=0)
        often = (mean > 1e-3).values
        error = contact[name].std("realisation", ddof=1).isel(slide_to_roll_ratio=0) / 24**0.5
        half = (rolling[name] - rolling[f"{name}_lower"]) / 2.0
        deviation = (mean - rolling[name]).values / np.hypot(error.values, half.values)
        assert np.all(np.abs(deviation[often]) < 4.0)
        seen += often.sum()
    assert seen >= 8


def runs_in(lines, starts, film, window, factor, margin=60, answers=()):
    """Whole touching runs that reach into a window of the sum of lines, and whether each breaks.

    As sets of points, counted from the window's first point.
    """
    points = np.arange(-margin, window + margin)
    first, second = (
        line[(start + points) % line.size] for line, start in zip(lines, starts, strict=True)
    )
    overlap = first + second - film
    for answer, start in zip(answers, starts, strict=False):
        overlap += answer(start)
    edges = np.flatnonzero(np.diff(overlap > 0.0, prepend=False, append=False))
    for begin, end in edges.reshape(-1, 2):
        if points[end - 1] >= 0 and points[begin] < window:
            breaks = (end - begin) ** 3 < factor * overlap[begin:end].sum()
            yield set(points[begin:end].tolist()), bool(breaks)


@pytest.mark.parametrize(
    ("ratio", "gap"),
    [
        (0.0, Gap()),
        pytest.param(0.0, Gap("computed"), marks=pytest.mark.slow),
        pytest.param(0.0, Gap("computed", "computed"), marks=pytest.mark.slow),
        pytest.param(0.4, Gap(), marks=pytest.mark.slow),
        pytest.param(0.4, Gap("computed"), marks=pytest.mark.slow),
        (0.4, Gap("computed", "computed")),
    ],
)
def test_breakthroughs_are_as_many_as_counted_step_by_step(
    coarse, few, study, ratio, gap, monkeypatch
):
    """A run goes on in those of the next step that it overlaps, seen from either surface.

    A broken run is new unless it goes on from one that is broken or, in an uneven window, that was.
    """
    monkeypatch.setattr("lube.surfaces.rare_contact.FOLLOWED", 400)  # for small errors
    weak = coarse([ratio], 20_000, 3e4, **dataclasses.asdict(gap))
    spec, layer = weak.line_spec, weak.boundary_layer
    point = few.isel(film_formula=[0], temperature=[1], force=[2])
    if gap.has_shape:
        oil = lubricant_table(study.lubricants, point["temperature"].values)
        levels = study.rollers, point["force"], point["speed"], study.film_formulas[:1], True
        answered = spec if gap.is_answered else None
        point = film_table(oil, *levels, slide_to_roll_ratio=[ratio], answered_lines=answered)
    tail = make(weak, {"film": point}).squeeze()
    factor = layer_factor(
        point["reduced_modulus"].item(), layer.critical_thickness, 3e4, spec.spacing, 1e-12
    )
    film, margin = point["film_thickness"].item() / spec.height_step, 60
    window = 2 * int(point["contact_half_width"].item() / spec.spacing) + 1
    if gap.has_shape:
        reached = window_films(point, spec)[0].below(8.0 * np.hypot(*spec.rms_height) / 1e-12)
        film, margin, window = reached.film, 0, reached.film.size
        places = np.arange(window) - reached.before
    ratios, counts = speed_ratios(ratio), []
    answering = []
    if gap.is_answered:
        responses = [point.squeeze().isel(roller=roller) for roller in range(2)]
        answering = [
            PlainAnswer(size, spec.spacing, one, places)
            for size, one in zip(spec.points, responses, strict=True)
        ]
    for number in range(8):
        lines, _ = draw_pair(spec, SEED, 100 + number)
        count, old, starts, answers = 0, None, None, ()
        if gap.is_answered:
            each = zip(answering, lines, strict=True)
            plain = [answer.lifts(line, 2000 + window) for answer, line in each]
            answers = [lambda start, one=one: one[start + reached.before] for one in plain]
        for step in range(2000):
            moved = [surface_position(step, one) for one in ratios]
            runs = list(runs_in(lines, moved, film, window, factor, margin, answers))
            if old is not None:
                steps = {new - before for new, before in zip(moved, starts, strict=True)}
                # The points of the step before, as each surface has carried them on.
                seen = [{i - one for i in run} for run, was in old if was for one in steps]
                known = [any(run & points for points in seen) for run, _ in runs]
                count += sum(broke and not was for (_, broke), was in zip(runs, known, strict=True))
                if gap.has_shape:
                    runs = [
                        (run, broke or was) for (run, broke), was in zip(runs, known, strict=True)
                    ]
            old, starts = runs, moved
        counts.append(count / 1999)
    duration = spec.spacing / (point["entrainment_speed"].item() * (1.0 + ratio / 2.0))
    expected = tail["breakthrough_rate"].item() * duration
    half = expected - tail["breakthrough_rate_lower"].item() * duration
    error = np.hypot(np.std(counts, ddof=1) / 8**0.5, half / 2.0)
    assert abs(np.mean(counts) - expected) < 4.0 * error
    assert error < 0.15 * expected


def test_breakthroughs_count_once_however_long_they_are(coarse, study, monkeypatch):
    """As many are found by a few looks at each run at first as by a look at every time step."""
    fine = coarse(points=200_000, shear_strength=1e6, film_shape="computed")
    oil = lubricant_table(study.lubricants, [60.0])
    film = film_table(oil, study.rollers, [400.0], [100.0], ["paper"], **fine.film_model)
    found = {}
    for looks in (1, 8, 16, 32, 1_000_000):
        monkeypatch.setattr("lube.surfaces.rare_contact.LOOKS", looks)
        found[looks] = make(fine, {"film": film}).squeeze()
    passage = 2.0 * film["contact_half_width"] / film["entrainment_speed"]
    assert found[1]["breakthrough_duration"] < 0.2 * passage
    *few, every = (one["breakthrough_rate"].item() for one in found.values())
    assert few == pytest.approx([every] * 4, rel=0.02)


def steps_to_the_next(line, film, window, factor):
    """Mean steps from any window of a periodic line to one that a broken run reaches into."""
    line = np.roll(line, -np.argmin(line))
    edges = np.flatnonzero(np.diff((line > film).astype(int))) + 1
    reached = np.zeros(line.size, bool)
    for start, stop in edges.reshape(-1, 2):
        if (stop - start) ** 3 < factor * (line[start:stop] - film).sum():
            reached[np.arange(start - window + 1, stop)] = True
    found = np.flatnonzero(reached)
    gaps = np.diff(found, append=found[0] + line.size) - 1
    return np.sum(gaps * (gaps + 1) / 2) / line.size


@pytest.mark.parametrize(("shear_strength", "force", "temperature"), [(3e4, 1, 1), (1e4, 0, 1)])
def test_the_first_breakthrough_comes_when_counting_finds_it(
    coarse, few, shear_strength, force, temperature
):
    """Where contact is frequent, in pure rolling; in windows wide and narrow."""
    weak = coarse(points=50_000, shear_strength=shear_strength)
    spec = weak.line_spec
    point = few.isel(film_formula=[0], temperature=[temperature], force=[force])
    found = make(weak, {"film": point}).squeeze()
    assert 0.1 < found["breakthrough_probability"] < 0.7
    factor = layer_factor(
        point["reduced_modulus"].item(), 5e-9, shear_strength, spec.spacing, spec.height_step
    )
    film = point["film_thickness"].item() / spec.height_step
    window = 2 * int(point["contact_half_width"].item() / spec.spacing) + 1
    counted = []
    for number in range(30):
        first, second = draw_pair(spec, SEED, 100 + number)[0]
        counted.append(steps_to_the_next(first + second, film, window, factor))
    time = np.mean(counted) * spec.spacing / point["entrainment_speed"].item()
    assert found["first_breakthrough_time"] == pytest.approx(time, rel=0.15)
    error = np.std(counted, ddof=1) / np.sqrt(30) * spec.spacing / point["entrainment_speed"].item()
    lower, upper = (found[f"first_breakthrough_time_{end}"].item() for end in ("lower", "upper"))
    assert lower - 2.0 * error < time < upper + 2.0 * error
    # Other seeds scatter as much as the interval says.
    seeds = (weak.model_copy(update={"seed": seed}) for seed in range(12))
    others = [make(one, {"film": point}).squeeze() for one in seeds]
    logs = np.log([one["first_breakthrough_time"].item() for one in others])
    assert 0.4 < 3.92 * np.std(logs, ddof=1) / np.log(upper / lower) < 1.6


@pytest.mark.parametrize("deformation", ["none", "computed"])
def test_in_uneven_windows_as_many_pairs_touch_as_counted_and_as_late(coarse, study, deformation):
    waves = {"points": 20_000, "longest_wavelength": 0.2e-3, "shortest_wavelength": 40e-6}
    roughness = study.roughness.model_copy(update=waves)
    choices = {"film_shape": "computed", "roughness_deformation": deformation}
    weak = coarse(shear_strength=1e5, roughness=roughness, **choices)
    oil = lubricant_table(study.lubricants, [40.0])
    levels = study.rollers, [800.0], [110.0, 125.0, 140.0], ["paper"]
    film = film_table(oil, *levels, **weak.film_model)
    found, windows = make(weak, {"film": film}).squeeze(), study_windows(weak, film)
    pairs, seen, first = 30, [], []
    for number in range(pairs):
        lines = draw_pair(weak.line_spec, SEED, 100 + number)[0]
        broken = windows.trace(tuple(np.rint(line).astype(np.int32) for line in lines)) > 0
        seen.append(broken.any(axis=1))
        first.append(np.where(seen[-1], broken.argmax(axis=1) / broken.shape[1], np.nan))
    share = found["touching_pair_share"].values
    np.testing.assert_array_less(np.abs(np.mean(seen, axis=0) - share), 3.0 * 0.5 / pairs**0.5)
    revolution = 60.0 / found["speed"].values
    wait = found["first_breakthrough_time"].values / revolution
    np.testing.assert_allclose(np.nanmean(first, axis=0), wait, atol=0.1)
    assert share.max() > 0.9 and share.min() < 0.6


def test_in_uneven_windows_a_rate_is_unknown_if_no_breakthrough_begins(coarse, study, monkeypatch):
    oil, levels = lubricant_table(study.lubricants, [40.0]), ([800.0], [100.0, 140.0], ["paper"])
    film = film_table(oil, study.rollers, *levels, with_shape=True)

    def none_begins(*given):
        in_window, rate = _in_uneven_windows(*given)
        return in_window, rate.where(rate["speed"] > 120.0, 0.0)

    monkeypatch.setattr("lube.stages.tail._in_uneven_windows", none_begins)
    found = make(coarse(film_shape="computed", shear_strength=1e5), {"film": film})
    assert (found["breakthrough_probability"] > 0.0).all()
    for name in ("breakthrough_rate", "breakthrough_rate_upper", "breakthroughs_per_revolution"):
        assert found[name].isnull().squeeze().values.tolist() == [True, False]


def test_under_flat_films_a_rate_is_unknown_if_only_pieces_break_that_edges_cut_off(make_tail, few):
    found = make_tail(few, shear_strength=1e7)
    assert (found["breakthrough_probability"] > 0.0).all()
    for name in ("breakthrough_rate", "breakthrough_rate_upper", "breakthroughs_per_revolution"):
        assert found[name].isnull().all()


# --- Lines that are not Gaussian ---------------------------------------------------------


def test_lines_that_are_not_gaussian_have_no_value_and_a_remark(coarse, few, tail):
    worn, heights = coarse(RATIOS), OwnRoughness(skewness=-1.0, kurtosis=5.0)
    second = worn.rollers.second.model_copy(update={"roughness": heights})
    rollers = worn.rollers.model_copy(update={"second": second})
    found = make(worn.model_copy(update={"rollers": rollers}), {"film": few})
    assert found.attrs["remarks"] == (
        f"{COUNTED}: roughness: got a skewness of -1 and a kurtosis of 5, need 0 and 3: importance "
        "sampling is for Gaussian lines"
    )
    assert tail.attrs["remarks"] == ""
    for name, values in tail.data_vars.items():
        assert found[name].dims == values.dims and found[name].attrs == values.attrs
        assert found[name].shape == values.shape and np.isnan(found[name]).all()
