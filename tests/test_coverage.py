"""How often intervals hold the truth, for pairs of rollers that no ensemble has seen.

The fast part of `tests/benchmarks/bench_coverage.py`, on coarse lines whose layer is so weak that
as many segments break as on the paper's. The windows of its forces are levels of the map: between
them a coarse grid rounds the window by up to a tenth. Some 120 pairs by 7 points, of two
ensembles of 32 realisations, tell a coverage of 95 % to about 2 % (one standard error, most of it
the ensembles' draw), that of fits, one a pair, to 3 %; 60 pairs with slip half as well. The bands
are the demanded ones, widened by two of these; widths, known to 10 %, by a fifth, with slip more,
as the spread of few pairs is seen too small.
"""

import functools

import numpy as np
import pytest
from benchmarks import bench_coverage as bench
from studies import PAPER

from lube import load_study
from lube.grid.discretise import revolution, speed_ratios
from lube.surfaces.synthetic import draw_realisation

ENSEMBLES, REALISATIONS = 2, 32
PAIRS = {"rolling": 120, "slipping": 60}
TURNS = (0.3, 10.4, 100.4)


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
    def ensembles(rollers):
        study = bench.variant(coarse, rollers)
        return bench.make_ensembles(study, ENSEMBLES, map)

    @functools.cache
    def scenario(rollers, motion):
        study = bench.variant(coarse, rollers, motion)
        table = bench.operating_table(ensembles(rollers)[0].film, "slipping")
        shares = bench.held_out_shares(study, table, motion, PAIRS[motion], map)
        made = [bench.comparisons(study, one, table, motion, TURNS) for one in ensembles(rollers)]
        return shares, made

    def figures(rollers, motion, turns):
        shares, made = scenario(rollers, motion)
        shares, number = shares[:, bench.TURNS.index(turns)], TURNS.index(turns)
        rows = []
        for k, ensemble in enumerate(ensembles(rollers)):
            comparison, own = made[k][number], shares[k::ENSEMBLES]
            rows.append(bench.figures(comparison, own, bench.judge(ensemble, comparison, own)))
        return {name: np.mean([row[name] for row in rows]) for name in rows[0]}

    return figures


@pytest.mark.parametrize("turns", TURNS)
@pytest.mark.parametrize("rollers", ["equal", "unequal"])
def test_intervals_hold_the_truth_in_rolling(figures_of, rollers, turns):
    found = figures_of(rollers, "rolling", turns)
    assert 0.89 <= found["film_coverage"] <= 0.99
    assert 0.89 <= found["agreement"] <= 0.99
    assert found["film_width_ratio"] <= 1.35
    assert found["prediction_width_ratio"] <= 1.35
    # What is common to all points of a short record is more than the whole lines tell.
    least = 0.84 if turns >= 1.0 else 0.8
    assert least <= found["alpha_coverage"]
    assert least <= found["layer_coverage"]


def test_intervals_hold_the_truth_with_slip(figures_of):
    found = figures_of("equal", "slipping", 10.4)
    assert found["film_coverage"] >= 0.87
    assert found["agreement"] >= 0.87
    assert found["film_width_ratio"] <= 1.6
    assert found["alpha_coverage"] >= 0.8
    assert found["layer_coverage"] >= 0.8


@pytest.mark.parametrize(
    ("rollers", "motion"), [("equal", "rolling"), ("unequal", "rolling"), ("equal", "slipping")]
)
def test_a_record_of_several_cycles_is_that_of_the_run_itself(coarse, rollers, motion):
    """The benchmark's shortcut by whole cycles, beside all turns counted in one run."""
    study, turns = bench.variant(coarse, rollers, motion), 10.4
    table = bench.operating_table(bench.film_of(study), "slipping")
    found = bench.record_shares(study, table, bench.MOTIONS[motion], [turns], 0)
    pair = draw_realisation(study.line_spec, study.seed, 0)
    ratios = speed_ratios(bench.MOTIONS[motion])
    steps = round(turns * revolution(pair, ratios))
    _, counted = bench.counts_up_to(study, pair, ratios, table, np.array([0, steps]))
    np.testing.assert_allclose(
        found[0], counted / steps, rtol=1e-12 if motion == "rolling" else 0.01
    )
