"""Studies that no machine can hold or plan are told before the first job."""

import pytest
import yaml
from studies import SMOKE, with_value

from lube.errors import StudyError
from lube.study.study import load_study


@pytest.fixture
def load(tmp_path):
    """Load the smoke study with sections or values changed."""

    def load_changed(**changes):
        content = yaml.safe_load(SMOKE.read_text("utf-8"))
        for key, value in changes.items():
            content = with_value(content, key.replace("__", "."), value)
        path = tmp_path / "large.yaml"
        path.write_text(yaml.safe_dump(content), encoding="utf-8")
        return load_study(path)

    return load_changed


def levels(count, units):
    return {"values": [800 + n for n in range(count)], "units": units}


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"rollers__second__radius": "1 km"}, "rollers.second.radius: its line has 4e+08 points"),
        (
            {"realisations": 10**6, "batch_size": 99},
            "batch_size: got 99 for 1000000 realisations, need at least 100",
        ),
        (
            {"realisations": 10**5, "batch_size": 10**5, "roughness__points": 10**5},
            "batch_size: the lines of a batch take 2e+10 numbers, need 1e9 at most",
        ),
        (
            {"realisations": 10**5, "batch_size": 10, "kept_realisations": list(range(30_000))},
            "kept_realisations: their lines take 1.2e+09 numbers",
        ),
        (
            {"rig__revolutions": 1000, "rig__drift": 0.1, "roughness__points": 10**6},
            "rig.revolutions: the lines of the rig take 2e+09 numbers",
        ),
        (
            {"rig__pairs": 1000, "roughness__points": 10**6},
            "rig.pairs: the lines of the rig take 2e+09 numbers",
        ),
        (
            {"rig__pairs": 1000, "operating_grid__force": levels(20, "N")}
            | {"traces": [{"force": "800 N", "speed": "100 rpm", "temperature": "40 degC"}]},
            "rig.pairs: its folded records take 1.6e+09 numbers",
        ),
        ({"rig__sampling_rate": "1 THz"}, "rig.sampling_rate: its samples of the traces take"),
        ({"experiment__debounce": "1 year"}, "experiment.debounce: its samples take 6.31e+11"),
        (
            {"operating_grid__speed": {"values": [1e-9, 100], "units": "rpm"}},
            "rig.sampling_rate: its samples of the traces take",
        ),
        (
            {"operating_grid__speed": levels(1000, "rpm"), "realisations": 10**5, "batch_size": 10}
            | {"traces": [{"force": "800 N", "speed": "800 rpm", "temperature": "40 degC"}]},
            "operating_grid: its combinations in all realisations take 1.6e+09 numbers",
        ),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_a_study_that_no_machine_can_hold_is_refused(load, changes, told):
    with pytest.raises(StudyError) as caught:
        load(**changes)
    assert f"large.yaml: {told}" in str(caught.value)


def test_a_large_study_that_a_machine_can_hold_is_accepted(load):
    study = load(roughness__points=2**24, realisations=10**5, batch_size=10, rig__revolutions=1000)
    assert len(study.batches) == 10_000


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"lubricants": ["mobilgear-shc-xmp-320"] * 101}, "lubricants: got 101, need 100 at most"),
        ({"operating_grid__force": levels(1001, "N")}, "got 1001 levels, need 1000 at most"),
        (
            {"traces": [{"force": "800 N", "speed": "100 rpm", "temperature": "40 degC"}] * 1001},
            "need at most 1000",
        ),
    ],
    ids=["lubricants", "levels", "traces"],
)
def test_lists_have_an_end(load, changes, told):
    with pytest.raises(StudyError, match=told):
        load(**changes)


def test_a_long_list_of_realisations_is_checked_at_once(load):
    with pytest.raises(StudyError, match="0 is repeated"):
        load(kept_realisations=[*range(20_000), 0], realisations=10**6, batch_size=100)
