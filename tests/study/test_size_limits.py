"""A study that does not fit a workstation is refused before the first job."""

import pytest
import yaml
from studies import SMOKE_CONTENT, with_value

from lube.errors import StudyError
from lube.study.study import load_study


@pytest.fixture
def load(tmp_path):
    """Load the smoke study with values changed."""

    def load_changed(changes):
        content = SMOKE_CONTENT
        for key, value in changes.items():
            content = with_value(content, key, value)
        (tmp_path / "large.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
        return load_study(tmp_path / "large.yaml")

    return load_changed


def rising(count, units):
    return {"values": [800 + n for n in range(count)], "units": units}


FEW = {"realisations": 10**5, "batch_size": 10}
FINE, FINER = {"roughness.points": 10**5}, {"roughness.points": 10**6}
TRACE = {"force": "800 N", "speed": "100 rpm", "temperature": "40 degC"}
FORCES = {"operating_grid.force": rising(20, "N"), "traces": [TRACE]}
SPEEDS = {"operating_grid.speed": rising(1000, "rpm"), "traces": [TRACE | {"speed": "800 rpm"}]}
SLOW = {"operating_grid.speed": {"values": [1e-9, 100], "units": "rpm"}}


def test_a_study_that_is_too_large_is_refused(load):
    for changes, message in [
        (
            {"rollers.second.radius": "1 km"},
            "rollers.second.radius: got 1 km, 4e+08 grid points around the roller, need",
        ),
        (FEW | {"realisations": 10**6}, "batch_size: 100000 batches, need 10000 at most"),
        (FEW | {"batch_size": 10**5} | FINE, "batch_size: 2e+10 heights in a batch, need 1e+09"),
        (FEW | {"kept_realisations": [*range(30_000)]}, "kept_realisations: 1.2e+09 heights"),
        (FINER | {"rig.revolutions": 1000, "rig.drift": 0.1}, "rig.revolutions: 2e+09 heights"),
        (FINER | {"rig.pairs": 1000}, "rig.pairs: 2e+09 heights of the rig"),
        (FORCES | {"rig.pairs": 1000}, "rig.pairs: 1.6e+09 folded samples"),
        ({"rig.sampling_rate": "1 THz"}, "rig.sampling_rate: "),
        (SLOW, "rig.sampling_rate: "),
        (FEW | SPEEDS, "operating_grid: 1.6e+09 combinations in all realisations"),
    ]:
        with pytest.raises(StudyError) as caught:
            load(changes)
        assert f"large.yaml: {message}" in str(caught.value)


def test_a_large_study_that_fits_a_workstation_is_accepted(load):
    study = load(FEW | {"roughness.points": 2**24, "rig.revolutions": 1000})
    assert len(study.batches) == 10_000
