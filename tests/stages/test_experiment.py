"""Simulated records against the contact they were made of; measured ones as stated."""

import numpy as np
import pytest
from written_recordings import write_csv

from lube.errors import DataError
from lube.recordings.manifest import read_manifest
from lube.rig.record import LEVELS, TRACE_SAMPLES
from lube.schema import POINT_DIMS, check
from lube.stages.contact import contact_statistics
from lube.stages.experiment import measured_experiment, simulated_experiment

FAST = {"bandwidth": "50 MHz", "sampling_rate": "2 MHz", "noise": "0 V", "lead_resistance": "0 ohm"}


def at_100_ohm(dataset):
    return dataset.sel(threshold=100.0)


# Simulated records


def with_points(study, points):
    """The study with lines of so many points."""
    roughness = study.roughness.model_copy(update={"points": points})
    return study.model_copy(update={"roughness": roughness})


@pytest.fixture(scope="module")
def ideal(rig_film, study, with_rig):
    """A rig without inertia or noise."""
    return simulated_experiment(rig_film, with_rig(with_points(study, 60_000), **FAST))


@pytest.fixture(scope="module")
def simulated(rig_film, study, with_rig):
    """Simulate a rig of other values at the two points with most contact."""

    def run(**values):
        changed = with_rig(with_points(study, 30_000), **{"noise": "0 V"} | values)
        return simulated_experiment(rig_film.isel(temperature=[1]), changed)

    return run


def test_the_truth_is_what_the_contact_stage_finds_of_the_same_rollers(
    ideal, rig_lines, rig_film, study
):
    found = contact_statistics(rig_lines, rig_film, study.boundary_layer)
    expected = found["breakthrough_probability"].isel(realisation=0, film_formula=0)
    np.testing.assert_allclose(
        ideal["true_contact_share"], expected.transpose(..., *POINT_DIMS).values.ravel(), rtol=1e-12
    )
    assert (expected > 0.01).any()


def test_a_rig_without_inertia_or_noise_finds_the_truth(ideal):
    known = at_100_ohm(ideal)
    np.testing.assert_allclose(known.contact_share, known.true_contact_share, atol=2e-3)
    assert (known.contact_share_lower <= known.contact_share).all()
    assert (known.contact_share <= known.contact_share_upper).all()


def test_a_simulated_record_stands_at_its_operating_point(ideal, rig_film, study):
    assert check(ideal, "experiment") is ideal
    assert ideal["origin"].item() == "simulated"
    points = {tuple(ideal[name].values[row] for name in LEVELS) for row in range(4)}
    assert points == {(f, 100.0, t) for f in (800.0, 1600.0) for t in (40.0, 80.0)}
    for name in LEVELS:
        np.testing.assert_array_equal(ideal[name], ideal[f"{name}_level"])
    assert set(ideal["slide_to_roll_ratio"].values) == {0.0}
    assert ideal["record"].values[0] == "800 N, 100 r/min, 40 °C"
    assert (ideal["turns"].values, ideal.refused, ideal.remarks) == (pytest.approx(2.0), "", "")


def test_the_first_turn_is_kept_as_a_trace_and_a_long_one_by_its_extremes(ideal, simulated):
    assert ideal["trace_resistance"].shape == (4, TRACE_SAMPLES)
    times = ideal["trace_time"].isel(record=0)
    assert 0.0 == times[0] < times[-1] < ideal["revolution_period"][0]
    assert ideal["trace_resistance"].min() < 10.0  # no contact is lost between samples
    slow = simulated(sampling_rate="2 kHz")
    kept = np.isfinite(slow["trace_resistance"]).sum("trace_sample")
    np.testing.assert_array_equal(kept, 1200)  # 0.6 s


# Pairs of rollers and their repetition


def test_one_pair_repeats_itself(simulated):
    found = simulated(revolutions=5)
    assert found.sizes["record"] == 2 and found["pairs"] == 1
    np.testing.assert_allclose(found["repeatability"], 1.0, atol=1e-9)
    np.testing.assert_allclose(found["share_error"], 0.0, atol=1e-12)
    np.testing.assert_allclose(found["revolution_period"], 0.6, rtol=1e-4)
    np.testing.assert_allclose(found["turns"], 5.0, rtol=1e-4)


def test_several_pairs_make_several_records_of_each_point(simulated):
    one, several = simulated(pairs=1), simulated(pairs=3)
    assert several.sizes["record"] == 6 and several["pairs"] == 3
    assert several["pair"].values.tolist() == ["1", "1", "2", "2", "3", "3"]
    assert several["record"].values[5] == "1600 N, 100 r/min, 80 °C, pair 3"
    np.testing.assert_array_equal(several["contact_share"][:2], one["contact_share"])
    assert len(set(at_100_ohm(several)["contact_share"].values)) == 6


def test_drift_lowers_the_repeatability(simulated):
    steady, little, much = (simulated(drift=drift, revolutions=8) for drift in (0.0, 0.05, 1.0))
    for more, less in ((steady, little), (little, much)):
        assert (more["repeatability"] > less["repeatability"] + 0.1).all()
    np.testing.assert_allclose(much["repeatability"], 0.0, atol=0.05)
    assert much["drift"] == 1.0


def test_the_error_of_the_share_is_electrical_noise_alone(simulated):
    """What drift changes from turn to turn is roughness, which the model's scatter has already."""
    quiet, noisy, drifting = (
        simulated(revolutions=8, **values)
        for values in ({}, {"noise": "10 mV"}, {"drift": 0.3, "noise": "10 mV"})
    )
    assert (quiet["share_error"] < 1e-12).all()
    assert (noisy["share_error"] > 1e-5).all()
    assert (drifting["share_error"] == 0.0).all()


def test_less_than_a_turn_has_no_repeatability(simulated):
    part = simulated(revolutions=0.4)
    np.testing.assert_allclose(part["turns"], 0.4, rtol=1e-3)
    assert part["repeatability"].isnull().all()
    np.testing.assert_allclose(part["revolution_period"], 0.6)
    assert np.isfinite(part["folded_share"]).mean() == pytest.approx(0.4, abs=0.01)


# Measured records


def written(path, values, interval=1e-4, head="resistance [ohm]"):
    write_csv(path, [np.arange(len(values)) * interval, values], f"time [s],{head}")


def turning(speed, turns, interval=1e-3, seed=1):
    """Resistance of rollers that repeat themselves at some speed, in rpm."""
    contact = np.random.default_rng(seed).random(50) < 0.4
    time = (np.arange(int(turns * 60.0 / speed / interval)) + 0.5) * interval
    return np.where(contact[(time * speed / 60.0 % 1.0 * 50).astype(int)], 5.0, 5e4)


COLUMNS = "file,force [N],speed [rpm],temperature [degC]"


@pytest.fixture
def measured(tmp_path, study):
    """Evaluate a manifest of the given rows, written beside their records."""

    def evaluate(*rows, header=COLUMNS, study=study):
        manifest = tmp_path / "manifest.csv"
        manifest.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
        return measured_experiment(read_manifest(manifest), study)

    # In stretches of 20 samples, half of them in contact, without any period.
    stretches = np.random.default_rng(5).permutation(np.arange(1000) % 2)
    half = np.where(np.repeat(stretches, 20), 5.0, 5e4)
    written(tmp_path / "half.csv", half)
    written(tmp_path / "open.csv", np.full(20_000, 1e5))
    written(tmp_path / "broken.csv", [*half[:100], np.nan, *half[:100]])
    written(tmp_path / "wave.csv", np.where(np.arange(20_000) // 50 % 2, 5.0, 5e4))
    return evaluate


def test_measured_records_stand_at_their_own_conditions(measured):
    result = measured("half.csv,801,100.3,40.1", "open.csv,1600,100,80")
    assert check(result, "experiment") is result
    assert result["origin"].item() == "measured"
    half, none = (at_100_ohm(result).isel(record=number) for number in (0, 1))
    assert half["contact_share"] == 0.5
    assert 0.0 < half["contact_share_lower"] < 0.5 < half["contact_share_upper"] < 1.0
    assert none["contact_share"] == none["contact_share_lower"] == 0.0
    assert 0.0 < none["contact_share_upper"] < 1.0
    assert [half[name].item() for name in LEVELS] == [801.0, 100.3, 40.1]
    assert [half[f"{name}_level"].item() for name in LEVELS] == [800.0, 100.0, 40.0]
    assert half["record"] == "half.csv (manifest.csv: line 2)"
    assert half["duration"] == pytest.approx(2.0)
    assert half["sampling_interval"] == pytest.approx(1e-4)
    assert half["turns"] == pytest.approx(2.0 * 100.3 / 60.0)
    assert (half["pair"], half["slide_to_roll_ratio"]) == ("1", 0.0)
    assert np.isnan(half["true_contact_share"])


def test_a_level_is_near_within_the_tolerance_of_the_study_or_the_manifest(measured):
    of_study = ",,,"
    for row, tolerances, levels in (
        # A per cent, or a kelvin.
        ("792.5,100.9,40.9", of_study, (800.0, 100.0, 40.0)),
        ("791,100,40", of_study, (np.nan, 100.0, 40.0)),
        ("800,98.9,40", of_study, (800.0, np.nan, 40.0)),
        ("800,100,41.1", of_study, (800.0, 100.0, np.nan)),
        ("780,105,44", ",25,6,5", (800.0, 100.0, 40.0)),
        ("801,100.1,40.1", ",0.5,0.05,0.05", (np.nan, np.nan, np.nan)),
        ("801,100.1,40.1", ",,,0.05", (800.0, 100.0, np.nan)),
    ):
        columns = ",force_tolerance [N],speed_tolerance [1/min],temperature_tolerance [degC]"
        result = measured(f"half.csv,{row}{tolerances}", header=COLUMNS + columns)
        np.testing.assert_array_equal([result[f"{name}_level"].item() for name in LEVELS], levels)
        # Near a level or not, the record is evaluated at its own conditions.
        assert [result[name].item() for name in LEVELS] == [float(each) for each in row.split(",")]
        assert at_100_ohm(result)["contact_share"] == 0.5


def test_pairs_are_counted_by_their_labels(measured):
    rows = "half.csv,800,100,40,A", "half.csv,800,100,40,B", "open.csv,800,100,80,A"
    result = measured(*rows, header=f"{COLUMNS},pair")
    assert result["pair"].values.tolist() == ["A", "B", "A"]
    assert result["pairs"] == 2


# The speed


def test_a_speed_that_the_repetition_contradicts_is_corrected(measured, tmp_path, caplog):
    written(tmp_path / "slow.csv", turning(97.0, 20.0), 1e-3)
    result = measured("slow.csv,800,100,40")
    assert result["speed"].item() == pytest.approx(97.0, rel=1e-4)
    assert np.isnan(result["speed_level"])
    assert result["turns"].item() == pytest.approx(20.0, rel=1e-3)
    assert result["repeatability"] > 0.9
    (line,) = result.remarks.splitlines()
    assert line.startswith("slow.csv (manifest.csv: line 2): its speed is stated as 100 rpm, but")
    used = float(line.split("repeats itself at ")[1].split(" rpm")[0])
    assert used == pytest.approx(97.0, rel=1e-4) and line in caplog.text


def test_a_speed_that_is_stated_far_off_is_remarked_on(measured, tmp_path):
    written(tmp_path / "fast.csv", turning(110.0, 20.0), 1e-3)
    result = measured("fast.csv,800,100,40")
    assert result["speed"] == 100.0
    assert result.remarks.startswith("fast.csv (manifest.csv: line 2): rollers of one size without")
    written(tmp_path / "slow.csv", turning(90.0, 20.0), 1e-3)
    both = measured("fast.csv,800,100,40", "slow.csv,800,100,40").remarks
    assert both.startswith("fast.csv (manifest.csv: line 2) and 1 more: rollers of one size")


def test_a_force_in_another_unit_is_remarked_on(measured):
    remarks = measured("wave.csv,800000,100,40", "wave.csv,800,100,40").remarks
    assert remarks.startswith(
        "wave.csv (manifest.csv: line 2): the force is 800000 N, but the study's are from "
    )
    assert "its unit may be wrong" in remarks


def test_a_speed_within_its_tolerance_is_left_as_stated(measured, tmp_path):
    written(tmp_path / "nearly.csv", turning(99.6, 20.0), 1e-3)
    written(tmp_path / "slow.csv", turning(97.0, 20.0), 1e-3)
    rows = "nearly.csv,800,100,40,", "slow.csv,800,100,40,5"
    result = measured(*rows, header=f"{COLUMNS},speed_tolerance [rpm]")
    assert result["speed"].values.tolist() == [100.0, 100.0]
    assert result.remarks == ""
    np.testing.assert_allclose(result["revolution_period"], [60.0 / 99.6, 60.0 / 97.0], rtol=1e-4)


def test_a_record_that_does_not_repeat_by_the_turn_keeps_its_speed(measured, tmp_path):
    rng = np.random.default_rng(2)
    written(tmp_path / "random.csv", np.where(rng.random(12_000) < 0.3, 5.0, 5e4), 1e-3)
    result = measured("random.csv,800,100,40", "wave.csv,800,100,40")
    assert (result["speed"] == 100.0).all()
    (line,) = result.remarks.splitlines()
    assert line.startswith("random.csv (manifest.csv: line 2): rollers of one size without slip")
    assert "at any speed within 5 % of the one stated" in line
    random = result.isel(record=0)
    assert random["revolution_period"] == pytest.approx(0.6)
    assert random["repeatability"] == pytest.approx(0.0, abs=0.05)


def test_turns_are_those_of_the_faster_surface(measured, tmp_path):
    rng = np.random.default_rng(2)
    written(tmp_path / "random.csv", np.where(rng.random(6000) < 0.3, 5.0, 5e4), 1e-3)
    for slip, period, turns in (
        (0.0, 0.6, 10.0),
        (0.1, 0.6 / 1.05, 10.5),
        (-0.1, 0.6 / 0.95, 10.5),  # now the second has the faster surface
        (2.0, 0.3, 20.0),  # the second is at rest
        (-2.0, 0.3, 20.0),  # the first is
    ):
        row = f"random.csv,800,100,40,{slip}"
        result = measured(row, header=f"{COLUMNS},slide_to_roll_ratio")
        assert result["revolution_period"].item() == pytest.approx(period)
        assert result["turns"].item() == pytest.approx(turns)
        # With slip the turns differ by their roughness, not by noise alone.
        assert (result["share_error"] == 0.0) == (slip != 0.0)


# Short records


def width(result):
    here = at_100_ohm(result)
    return (here["contact_share_upper"] - here["contact_share_lower"]).item()


def test_the_shorter_the_record_the_wider_is_its_interval(measured, tmp_path):
    contact = np.repeat(np.random.default_rng(3).random(2000) < 0.4, 5)
    resistance = np.where(contact, 5.0, 5e4)
    widths = []
    for samples in (3, 60, 600, 10_000):  # 0.2 mm, a hundredth of a turn, a tenth, and a whole
        written(tmp_path / "some.csv", resistance[:samples], 6e-5)
        result = measured("some.csv,800,100,40")
        assert result["turns"].item() == pytest.approx(samples * 6e-5 / 0.6)
        widths.append(width(result))
    assert (np.diff(widths) < 0.0).all()
    assert widths[0] > 0.75 and widths[-1] < 0.15


def test_less_than_a_window_without_contact_excludes_little(measured, tmp_path):
    """One window without contact: the share may be anything up to 95 %."""
    for samples in (2, 5):
        written(tmp_path / "some.csv", np.full(samples, 1e5), 1e-4)
        here = at_100_ohm(measured("some.csv,800,100,40"))
        assert here["contact_share"] == here["contact_share_lower"] == 0.0
        assert here["contact_share_upper"].item() == pytest.approx(0.95)
        assert np.isnan(here["repeatability"])


def test_records_shorter_than_the_passage_of_a_contact_are_remarked_on(measured, tmp_path, study):
    written(tmp_path / "some.csv", np.full(5, 1e5), 1e-4)
    width = 2.0 * study.rollers.contact_half_width(800.0)
    passage = width / (2.0 * np.pi * study.rollers.first.radius * 100.0 / 60.0)
    assert 5e-4 < passage < 7e-4
    remark = measured("some.csv,800,100,40").remarks
    needed = f"500 µs long, but the rollers need {1e6 * passage:.0f} µs to move by the width"
    assert remark.startswith(f"some.csv (manifest.csv: line 2): {needed}")
    two = measured("some.csv,800,100,40", "half.csv,800,100,40", "some.csv,800,90,40").remarks
    assert two.splitlines()[-1].startswith(
        "some.csv (manifest.csv: line 2) and 1 more: 500 µs long, but"
    )
    assert measured("some.csv,800,200,40").remarks == ""


def test_many_turns_of_equal_rollers_without_contact_exclude_no_more_than_one(measured, tmp_path):
    """Only slip brings new windows."""
    uppers = {}
    for turns in (1, 30):
        written(tmp_path / "some.csv", np.full(600 * turns, 1e5), 1e-3)
        for slip in (0.0, 0.1):
            row = f"some.csv,800,100,40,{slip}"
            here = at_100_ohm(measured(row, header=f"{COLUMNS},slide_to_roll_ratio"))
            uppers[turns, slip] = here["contact_share_upper"].item()
    assert uppers[30, 0.0] == pytest.approx(uppers[1, 0.0])
    assert uppers[30, 0.1] < 0.1 * uppers[1, 0.1]


def test_an_open_circuit_may_have_an_infinite_resistance(measured, tmp_path):
    written(tmp_path / "open.csv", np.where(np.arange(1000) % 4, np.inf, 1.0))
    result = measured("open.csv,800,100,40")
    assert result.refused == "" and at_100_ohm(result)["contact_share"] == 0.25


# What cannot be used


def refusals(measured, *rows, header=COLUMNS, **more):
    """Lines of what was refused, beside one record that can be used."""
    columns = header.count(",") - COLUMNS.count(",")
    result = measured(*rows, "half.csv,800,100,40" + "," * columns, header=header, **more)
    assert result.sizes["record"] == 1
    assert at_100_ohm(result)["contact_share"] == 0.5
    return result.refused.splitlines()


def test_a_bad_record_is_refused_by_name_and_the_good_ones_stay(measured, caplog):
    lines = refusals(measured, "broken.csv,800,100,40", "gone.csv,800,100,80")
    assert any("broken.csv: line 102" in line for line in lines)
    assert any("got 'gone.csv', no such file" in line for line in lines)
    assert len(lines) == 2 and all(line in caplog.text for line in lines)


def test_what_cannot_be_used_is_refused_in_one_line(measured, tmp_path):
    volts = np.where(np.arange(1000) % 2, 0.12, 0.001)
    written(tmp_path / "volts.csv", volts, head="U [V]")
    for column, row, reason in (
        ("lubricant", "half.csv,800,100,40,butter", "lubricant: got butter, need one of the study"),
        ("", "half.csv,0.001,100,40", "need at least two grid spacings, "),
        ("channel", "half.csv,800,100,40,CH7", "no channel 'CH7', need one of: 'time [s]'"),
        ("", "half.csv,800,100,400", "mobilgear-shc-xmp-320"),
        ("", "volts.csv,800,100,40", "saturated, 50.0% of its samples are at or beyond 0.1 V"),
    ):
        header = f"{COLUMNS},{column}" if column else COLUMNS
        (line,) = refusals(measured, row, header=header)
        assert reason in line
        assert line.startswith("manifest.csv: line 2: ") or row.split(",")[0] in line


def test_a_reversed_voltage_is_refused_and_not_counted_as_contact(measured, tmp_path):
    """The open circuit of 50 mV is recorded as -50 mV; near zero, noise may have either sign."""
    volts = np.where(np.arange(1000) % 4, -0.05, 0.001 * (-1.0) ** (np.arange(1000) // 4))
    written(tmp_path / "volts.csv", volts, head="U [V]")
    (line,) = refusals(measured, "volts.csv,800,100,40")
    assert "volts.csv: reversed, 75.0% of its samples are below -0.025 V" in line
    here = measured("volts.csv,800,100,40,-1", header=f"{COLUMNS},gain")
    assert at_100_ohm(here)["contact_share"] == 0.25 and here.refused == ""


def test_a_record_below_another_bias_voltage_reads_as_contact_with_a_remark(measured, tmp_path):
    written(tmp_path / "volts.csv", np.full(1000, 0.015), head="U [V]")
    here = measured("volts.csv,800,100,40")
    assert at_100_ohm(here)["contact_share"] == 1.0
    assert "volts.csv" in here.remarks and "less than rig.bias_voltage, 50 mV" in here.remarks
    written(tmp_path / "volts.csv", np.where(np.arange(1000) % 2, 0.015, 0.05), head="U [V]")
    assert measured("volts.csv,800,100,40").remarks == ""


def test_a_voltage_that_is_cut_off_reads_as_contact_by_the_higher_thresholds_alone(
    measured, tmp_path
):
    """A recorder that ends at 40 mV shows no more than 400 ohm behind 100 ohm at 50 mV."""
    volts = np.minimum(np.where(np.arange(1000) % 4, 0.05, 0.001), 0.04)
    written(tmp_path / "volts.csv", volts, head="U [V]")
    here = measured("volts.csv,800,100,40")
    assert here["contact_share"].values[0].tolist() == [0.25, 0.25, 1.0]
    assert "by thresholds from 1 kΩ on, which it also does if the recorder" in here.remarks


def test_no_record_at_all_is_an_error(measured):
    with pytest.raises(DataError, match=r"no record can be used, .*; the first: .*broken.csv"):
        measured("broken.csv,800,100,40")


# Shares and voltages


def test_a_share_evaluated_elsewhere_stands_at_the_compared_threshold_alone(measured):
    header = "probability,lower,upper,force [N],speed [rpm],temperature [degC]"
    here = measured("0.25,0.2,0.3,800,100,40", header=header).squeeze()
    limits = [
        here[f"contact_share{limit}"].sel(threshold=100) for limit in ("", "_lower", "_upper")
    ]
    assert limits == [0.25, 0.2, 0.3]
    assert here["contact_share"].sel(threshold=[10, 1000]).isnull().all()
    assert (here["turns"], here["share_error"]) == (1.0, 0.0)
    assert here["record"] == "manifest.csv: line 2"
    assert np.isnan(here["repeatability"]) and np.isnan(here["duration"])


def test_a_voltage_is_converted_by_the_rigs_circuit(measured, tmp_path):
    """100 ohm are 25.02 mV of the 50 mV, with 0.2 ohm of leads.

    Behind an amplifier, 0.253 and 0.254 V are recorded, beyond the 0.1 V of the rig's amplifier.
    """
    volts = np.where(np.arange(5000) // 50 % 4 == 0, 25.0e-3, 25.1e-3)
    written(tmp_path / "plain.csv", volts, head="CH2 [V]")
    written(tmp_path / "amplified.csv", 10.0 * volts + 3e-3, head="CH2")
    header = "file,channel,unit,gain,offset [mV],force [N],speed [rpm],temperature [degC]"
    rows = "plain.csv,,,,,800,100,40", "amplified.csv,CH2,V,10,3,800,100,40"
    shares = at_100_ohm(measured(*rows, header=header))["contact_share"]
    assert shares.values.tolist() == [0.25, 0.25]
