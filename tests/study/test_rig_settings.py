"""Settings of known rigs."""

from typing import get_args

import pytest
from studies import PAPER

from lube.errors import StudyError
from lube.rig.readings import READINGS
from lube.study.rig_settings import PRESETS, KnownRig, Rig
from lube.study.study import load_study


@pytest.mark.parametrize("name", PRESETS)
def test_a_known_rig_has_its_settings_and_the_studys_for_all_others(name):
    rig = Rig(preset=name, oil_permittivity=2.5)
    assert PRESETS[name].source
    known = Rig(**PRESETS[name].settings)
    for key in Rig.model_fields:
        if key not in ("preset", "oil_permittivity"):
            assert getattr(rig, key) == getattr(known, key)
    assert rig.oil_permittivity == 2.5
    assert Rig(oil_permittivity=2.5).like(name) == rig


def test_every_reading_is_one_that_is_simulated():
    assert {Rig(preset=name).reading for name in PRESETS} <= set(READINGS)
    assert Rig().reading == "threshold"


def test_the_type_of_a_known_rig_names_all_of_them():
    assert get_args(KnownRig) == tuple(PRESETS)


def test_values_of_the_study_take_precedence():
    rig = Rig(preset="mtm-ecr", series_resistance="1 kohm")
    assert (rig.bias_voltage, rig.series_resistance) == (0.015, 1000.0)


def test_an_unknown_rig_is_refused_with_the_known_ones(paper_with):
    with pytest.raises(StudyError) as caught:
        load_study(paper_with(("rig", {"preset": "mtm"})))
    assert "rig.preset: got 'mtm', need" in str(caught.value)
    assert "'mtm-ecr'" in str(caught.value)


def test_a_known_rig_replaces_the_circuit_of_the_study_below(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(
        f"based_on: {PAPER}\nname: mine\nrig: {{preset: mtm-ecr-10-kohm, noise: 1 uV}}\n", "utf-8"
    )
    rig = load_study(path).rig
    assert (rig.bias_voltage, rig.series_resistance, rig.noise) == (0.015, 1e4, 1e-6)
    assert rig.revolutions == load_study(PAPER).rig.revolutions
