"""The rig's records: simulated ones against the truth they were made of, measured ones as told."""

import numpy as np
import pytest

from lube.contact import contact_statistics
from lube.errors import DataError
from lube.experiment import measured_experiment, simulated_experiment
from lube.manifest import read_manifest
from lube.schema import EXPERIMENT_DIMS

FAST = {"bandwidth": "50 MHz", "sampling_rate": "2 MHz", "noise": "0 V", "lead_resistance": "0 ohm"}


@pytest.fixture(scope="module")
def ideal(rig_lines, rig_film, study, with_rig):
    """A rig without inertia or noise."""
    return simulated_experiment(rig_lines, rig_film, with_rig(study, **FAST))


def at(dataset, **levels):
    return dataset.sel(slide_to_roll_ratio=0.0, threshold=100.0, **levels).squeeze()


# Simulated records


def test_the_truth_is_what_the_contact_stage_finds_of_the_same_rollers(
    ideal, rig_lines, rig_film, study
):
    found = contact_statistics(rig_lines, rig_film, study.boundary_layer)
    expected = found.breakthrough_probability.mean("realisation").isel(film_formula=0)
    actual = ideal.true_contact_share.sel(slide_to_roll_ratio=[0.0])
    np.testing.assert_allclose(
        actual.values, expected.transpose(*EXPERIMENT_DIMS).values, rtol=1e-12
    )
    assert (expected > 0.01).any()


def test_a_rig_without_inertia_or_noise_finds_the_truth(ideal):
    known = at(ideal)
    np.testing.assert_allclose(known.contact_share, known.true_contact_share, atol=2e-3)
    assert (known.contact_share_lower <= known.contact_share).all()
    assert (known.contact_share <= known.contact_share_upper).all()


def test_each_revolution_is_a_record_of_its_own(ideal):
    known = at(ideal)
    np.testing.assert_allclose(
        known.revolution_share.mean("revolution"), known.contact_share, atol=1e-4
    )
    assert (known.revolution_share_lower <= known.revolution_share).all()
    assert (known.revolution_share <= known.revolution_share_upper).all()
    assert (known.revolution_share_upper >= 0.5 * known.contact_share_upper).all()


def test_a_slow_rig_misses_contact_most_at_low_thresholds(rig_lines, rig_film, study, with_rig):
    slow = simulated_experiment(rig_lines, rig_film, with_rig(study, bandwidth="2 kHz"))
    shares = slow.contact_share.sel(slide_to_roll_ratio=0.0)
    assert (shares.diff("threshold") >= 0.0).all()
    seen = slow.true_contact_share.sel(slide_to_roll_ratio=0.0) > 0.01
    lowest = shares.isel(threshold=0).where(seen)
    assert (lowest < slow.true_contact_share.sel(slide_to_roll_ratio=0.0)).where(seen, True).all()


def test_records_are_of_the_rigs_slip_and_say_that_they_are_simulated(ideal, study):
    assert ideal.origin.item() == "simulated"
    assert ideal.slide_to_roll_ratio.values.tolist() == list(study.slips) == [0.0, 0.1]
    assert ideal.contact_share.sel(slide_to_roll_ratio=0.1).isnull().all()
    assert set(ideal.record.sel(slide_to_roll_ratio=0.0).values.ravel()) == {"simulated"}
    assert ideal.refused == ""


# Measured records


def write_record(path, resistance, interval=1e-4):
    rows = [f"{number * interval!r},{value}" for number, value in enumerate(resistance)]
    path.write_text("time [s],resistance [ohm]\n" + "\n".join(rows) + "\n", encoding="utf-8")


@pytest.fixture
def measured(tmp_path, rig_film, study):
    """Evaluate a manifest of the given rows, written beside their records."""

    def evaluate(*rows, header="file,force [N],speed [rpm],temperature [degC]", study=study):
        manifest = tmp_path / "manifest.csv"
        manifest.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
        return measured_experiment(read_manifest(manifest), rig_film, study)

    half = np.where(np.arange(20_000) // 50 % 2, 5.0, 5e4)
    write_record(tmp_path / "half.csv", half)
    write_record(tmp_path / "open.csv", np.full(20_000, 1e5))
    write_record(tmp_path / "broken.csv", [*half[:100], "nan", *half[:100]])
    return evaluate


def test_measured_records_stand_at_their_operating_points(measured):
    result = measured("half.csv,800,100,40", "open.csv,1600,100,80")
    assert result.origin.item() == "measured"
    half, none = at(result, force=800, temperature=40), at(result, force=1600, temperature=80)
    assert half.contact_share == 0.5
    assert 0.0 < half.contact_share_lower < 0.5 < half.contact_share_upper < 1.0
    assert none.contact_share == none.contact_share_lower == 0.0
    assert 0.0 < none.contact_share_upper < 1.0
    assert half.record == "half.csv"
    assert half.duration == pytest.approx(2.0)
    assert half.sampling_interval == pytest.approx(1e-4)
    assert np.isnan(half.true_contact_share)
    assert int(result.contact_share.notnull().any("threshold").sum()) == 2


def test_a_speed_in_round_numbers_finds_its_level(measured):
    result = measured("half.csv,800.5,100.3,40.1")
    assert at(result, force=800, temperature=40).contact_share == 0.5


def test_a_bad_record_is_refused_by_name_and_the_good_ones_stay(measured, caplog):
    result = measured(
        "broken.csv,800,100,40",
        "half.csv,1600,100,40",
        "half.csv,700,100,40",
        "half.csv,1600,100,40",
        "gone.csv,800,100,80",
    )
    assert at(result, force=1600, temperature=40).contact_share == 0.5
    refused = result.refused.splitlines()
    assert len(refused) == 4
    assert sum("broken.csv: line 102" in line for line in refused) == 1
    assert sum("got 700.0, need one of the study's: 800, 1600" in line for line in refused) == 1
    assert sum("gone.csv" in line for line in refused) == 1
    assert all(line in caplog.text for line in refused)


def test_no_record_at_all_is_an_error(measured):
    with pytest.raises(DataError, match=r"no record can be used; the first: .*broken.csv"):
        measured("broken.csv,800,100,40")


def test_a_share_evaluated_elsewhere_stands_at_the_compared_threshold_alone(measured):
    header = "probability,lower,upper,force [N],speed [rpm],temperature [degC]"
    result = measured("0.25,0.2,0.3,800,100,40", header=header)
    here = result.sel(slide_to_roll_ratio=0.0, force=800, temperature=40).squeeze()
    assert here.contact_share.sel(threshold=100).item() == 0.25
    assert here.contact_share_lower.sel(threshold=100).item() == 0.2
    assert here.contact_share.sel(threshold=[10, 1000]).isnull().all()


def test_a_voltage_is_judged_by_the_rigs_circuit(measured, tmp_path, study):
    # 100 ohm are 25.02 mV of the 50 mV, with 0.2 ohm of leads.
    voltage = np.where(np.arange(5000) // 50 % 4 == 0, 25.0e-3, 25.1e-3)
    rows = [f"{1e-4 * number!r};{value!r}" for number, value in enumerate(voltage.tolist())]
    text = "\n".join(["t [s];U [V]", *rows]).replace(".", ",") + "\n"
    (tmp_path / "volts.csv").write_text(text, encoding="utf-8")
    here = at(measured("volts.csv,800,100,40"), force=800, temperature=40)
    assert here.contact_share == 0.25


def test_a_saturated_record_is_refused(measured, tmp_path, study):
    rows = [f"{1e-4 * number!r},{0.12 if number % 2 else 0.001}" for number in range(1000)]
    (tmp_path / "volts.csv").write_text("\n".join(["t [s],U [V]", *rows]), encoding="utf-8")
    with pytest.raises(DataError, match=r"50.0% of its samples are at or beyond 0.1 V"):
        measured("volts.csv,800,100,40")


def test_a_voltage_behind_an_amplifier_is_judged_at_the_rig(measured, tmp_path):
    """Recorded are 0.253 and 0.254 V, beyond the amplifier's 0.1 V, of 25.0 and 25.1 mV."""
    true = np.where(np.arange(5000) // 50 % 4 == 0, 25.0e-3, 25.1e-3)
    recorded = 10.0 * true + 3e-3
    rows = [f"{1e-4 * number!r},5,{value!r}" for number, value in enumerate(recorded.tolist())]
    (tmp_path / "log.csv").write_text("\n".join(["t [s],CH1 [V],CH2", *rows]), encoding="utf-8")
    header = "file,channel,unit,gain,offset [mV],force [N],speed [rpm],temperature [degC]"
    result = measured("log.csv,CH2,V,10,3,800,100,40", header=header)
    assert at(result, force=800, temperature=40).contact_share == 0.25
