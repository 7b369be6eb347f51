"""How often intervals contain the true value, for pairs of rollers that are in no ensemble.

A short version of `benchmarks/bench_coverage.py`, on coarse lines whose layer is so weak that
as many segments break as on the paper's. The contact widths of its forces are levels of the map:
between them a coarse grid rounds the window by up to a tenth. Some 120 pairs at 7 points, judged by
two ensembles of 32 realisations, give a coverage of 95 % with a standard error of about 2 %, most
of it from the ensembles, and 3 % for fits, one a pair; 60 pairs with slip half as well. The bands
are the required ones, widened by two of these; widths, known to 10 %, by a fifth, with slip more,
because the spread of few pairs is underestimated.
"""

import functools

import bench_coverage as bench
import numpy as np
import pytest
from studies import PAPER

from lube.contact.rough_pair import drawn
from lube.contact.windows import study_windows
from lube.stages import load_study

ENSEMBLES, REALISATIONS = 2, 32
PAIRS = {"rolling": 120, "slipping": 60}
GAP = ("film_shape", "roughness_deformation")
SLOW = pytest.mark.slow


@pytest.fixture(scope="module")
def coarse():
    study = load_study(PAPER)
    changed = {
        "realisations": REALISATIONS,
        "roughness": study.roughness.model_copy(update={"points": 50_000}),
        "boundary_layer": study.boundary_layer.model_copy(update={"shear_strength": 2e5}),
        "operating_grid": study.operating_grid.model_copy(update={"force": (200.0, 1600.0)}),
    }
    return study.model_copy(update=changed)


@pytest.fixture(scope="module")
def figures_of(coarse):
    """Figures of a scenario for one length of record; each ensemble judges its share of pairs."""

    @functools.cache
    def ensembles(rollers, gap):
        study = coarse.model_copy(update=dict(zip(GAP, gap, strict=True)))
        return bench.make_ensembles(bench.variant(study, rollers), ENSEMBLES, map)

    @functools.cache
    def shares_of(rollers, motion, gap):
        one = ensembles(rollers, gap)[0]
        study = bench.variant(one.study, rollers, motion)
        table = bench.operating_table(one.film, motion, few=True)
        return study, table, bench.held_out_shares(study, table, motion, PAIRS[motion], map)

    def figures(rollers, motion, turns, gap=("flat", "none")):
        study, table, shares = shares_of(rollers, motion, gap)
        shares, rows = shares[:, bench.TURNS.index(turns)], []
        for number, ensemble in enumerate(ensembles(rollers, gap)):
            (comparison,) = bench.comparisons(study, ensemble, table, motion, [turns])
            own = shares[number::ENSEMBLES]
            judged = bench.judge(ensemble, comparison, ensemble.curves(comparison), own)
            rows.append(bench.figures(comparison, own, judged))
        return {name: np.mean([row[name] for row in rows]) for name in rows[0]}

    return figures


@pytest.mark.parametrize(
    ("rollers", "turns"),
    [
        ("equal", 10.4),
        pytest.param("equal", 0.3, marks=SLOW),
        pytest.param("equal", 100.4, marks=SLOW),
        pytest.param("unequal", 0.3, marks=SLOW),
        pytest.param("unequal", 10.4, marks=SLOW),
        pytest.param("unequal", 100.4, marks=SLOW),
    ],
)
def test_intervals_contain_the_true_value_in_rolling(figures_of, rollers, turns):
    found = figures_of(rollers, "rolling", turns)
    assert 0.89 <= found["film_coverage"] <= 0.99
    assert 0.89 <= found["agreement"] <= 0.99
    assert found["film_width_ratio"] <= 1.35
    assert found["prediction_width_ratio"] <= 1.35
    # The points of a short record are more correlated than the whole lines show.
    least = 0.84 if turns >= 1.0 else 0.8
    assert least <= found["alpha_coverage"]
    assert least <= found["layer_coverage"]


@SLOW
def test_intervals_contain_the_true_value_where_the_oil_answers_the_lines(figures_of):
    """Each record has a curve of its own, through few pairs."""
    found = figures_of("equal", "rolling", 10.4, ("computed", "computed"))
    assert 0.89 <= found["film_coverage"] <= 0.99
    assert 0.89 <= found["agreement"] <= 0.99
    assert found["film_width_ratio"] <= 1.6
    assert found["alpha_coverage"] >= 0.8
    assert found["layer_coverage"] >= 0.8


@SLOW
@pytest.mark.parametrize("gap", [("flat", "none"), ("computed", "computed")])
def test_intervals_contain_the_true_value_with_slip(figures_of, gap):
    found = figures_of("equal", "slipping", 10.4, gap)
    assert found["film_coverage"] >= 0.87
    assert found["agreement"] >= 0.87
    assert found["film_width_ratio"] <= 1.6
    assert found["alpha_coverage"] >= 0.8
    assert found["layer_coverage"] >= 0.8


@pytest.mark.parametrize(
    ("rollers", "motion"), [("equal", "rolling"), ("unequal", "rolling"), ("equal", "slipping")]
)
def test_a_record_of_several_cycles_is_that_of_the_run_itself(coarse, rollers, motion):
    """The benchmark's calculation by whole cycles, beside all turns counted in one run."""
    study, slip, turns = bench.variant(coarse, rollers, motion), bench.MOTIONS[motion], 10.4
    table = bench.operating_table(bench.film_of(study), motion, few=True)
    found = bench.record_shares(study, table, slip, [turns], 0)
    share = study_windows(study, table).count(drawn(study, 0), slip, turns)[:, 1]
    np.testing.assert_allclose(found[0], share, rtol=1e-12 if motion == "rolling" else 0.01)
