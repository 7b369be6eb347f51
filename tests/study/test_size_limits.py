"""A study that does not fit a workstation is refused before the first job."""

import pytest
import yaml
from studies import SMOKE_CONTENT, with_value

from lube.errors import StudyError
from lube.study.study import load_study


@pytest.fixture
def load(tmp_path):
    """Load the smoke study with sections or values changed."""

    def load_changed(**changes):
        content = SMOKE_CONTENT
        for key, value in changes.items():
            content = with_value(content, key.replace("__", "."), value)
        path = tmp_path / "large.yaml"
        path.write_text(yaml.safe_dump(content), encoding="utf-8")
        return load_study(path)

    return load_changed


def levels(count, units):
    return {"values": [800 + n for n in range(count)], "units": units}


def traces(speed="100 rpm"):
    return [{"force": "800 N", "speed": speed, "temperature": "40 degC"}]


def test_a_study_that_is_too_large_is_refused(load):
    for changes, message in [
        (
            {"rollers__second__radius": "1 km"},
            "rollers.second.radius: 4e+08 points around it, need 1.67772e+07 at most",
        ),
        (
            {"realisations": 10**6, "batch_size": 99},
            "batch_size: 10102 batches, need 10000 at most",
        ),
        (
            {"realisations": 10**5, "batch_size": 10**5, "roughness__points": 10**5},
            "batch_size: 2e+10 heights in a batch, need 1e+09 at most",
        ),
        (
            {"realisations": 10**5, "batch_size": 10, "kept_realisations": list(range(30_000))},
            "kept_realisations: 1.2e+09 heights",
        ),
        (
            {"rig__revolutions": 1000, "rig__drift": 0.1, "roughness__points": 10**6},
            "rig.revolutions: 2e+09 heights of the rig",
        ),
        (
            {"rig__pairs": 1000, "roughness__points": 10**6},
            "rig.pairs: 2e+09 heights of the rig",
        ),
        (
            {"rig__pairs": 1000, "operating_grid__force": levels(20, "N"), "traces": traces()},
            "rig.pairs: 1.6e+09 folded samples",
        ),
        ({"rig__sampling_rate": "1 THz"}, "rig.sampling_rate: "),
        (
            {"operating_grid__speed": {"values": [1e-9, 100], "units": "rpm"}},
            "rig.sampling_rate: ",
        ),
        (
            {"operating_grid__speed": levels(1000, "rpm"), "traces": traces("800 rpm")}
            | {"realisations": 10**5, "batch_size": 10},
            "operating_grid: 1.6e+09 combinations in all",
        ),
    ]:
        with pytest.raises(StudyError) as caught:
            load(**changes)
        assert f"large.yaml: {message}" in str(caught.value)


def test_a_large_study_that_fits_a_workstation_is_accepted(load):
    study = load(roughness__points=2**24, realisations=10**5, batch_size=10, rig__revolutions=1000)
    assert len(study.batches) == 10_000
