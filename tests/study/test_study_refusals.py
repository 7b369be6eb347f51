"""Every mistake in a study is refused, before anything is computed."""

import re
from functools import partial

import pytest
import yaml
from refusals import one_line
from studies import CONFIG, OIL, PAPER_CONTENT, REMOVED, with_value

from lube.errors import LubeError
from lube.study.lubricant_record import SHIPPED_FOLDER
from lube.study.rollers import AUTOMATIC_WAVELENGTH
from lube.study.study import load_study

refusal = partial(one_line, LubeError, load_study)

# Key, value, what is told of it

NAN, INFINITY = float("nan"), float("inf")

UNKNOWN_KEYS = [
    ("colour", 1, "colour: unknown key"),
    ("rollers.colour", 1, "rollers.colour: unknown key"),
    ("rollers.first.colour", 1, "rollers.first.colour: unknown key"),
    ("operating_grid.load", 1, "operating_grid.load: unknown key"),
    ("roughness.colour", 1, "roughness.colour: unknown key"),
    ("boundary_layer.colour", 1, "boundary_layer.colour: unknown key"),
    ("traces.0.load", "800 N", "traces.0.load: unknown key"),
    ("rig.colour", 1, "rig.colour: unknown key"),
    ("experiment.colour", 1, "experiment.colour: unknown key"),
]

# Every quantity of a study but the levels: its key, its unit, another dimension's unit.
QUANTITIES = [
    ("rollers.length", "mm", "kg"),
    ("rollers.first.radius", "mm", "N"),
    ("rollers.first.young_modulus", "GPa", "N"),
    ("rollers.first.rms_roughness", "um", "um^2"),
    ("rollers.second.radius", "mm", "s"),
    ("rollers.second.young_modulus", "GPa", "mm"),
    ("rollers.second.rms_roughness", "um", "Pa"),
    ("roughness.longest_wavelength", "mm", "1/mm"),
    ("roughness.height_step", "pm", "pN"),
    ("boundary_layer.critical_thickness", "nm", "nN"),
    ("boundary_layer.shear_strength", "MPa", "MN"),
    ("resistivity", "uohm*m", "uohm"),
    ("rig.bias_voltage", "mV", "mA"),
    ("rig.series_resistance", "kohm", "kV"),
    ("rig.leak_resistance", "Mohm", "MPa"),
    ("rig.amplifier_range", "mV", "mm"),
    ("rig.bandwidth", "kHz", "km"),
    ("rig.sampling_rate", "kHz", "s"),
    ("experiment.threshold", "ohm", "V"),
    ("traces.0.force", "N", "kg"),
    ("traces.0.speed", "rpm", "m/s"),
    ("traces.0.temperature", "degC", "W"),
]
POSITIVE = [key for key, _, _ in QUANTITIES if not key.startswith("traces")]
LEVELS = [
    ("operating_grid.force", "N", "mm"),
    ("operating_grid.speed", "rpm", "N"),
    ("operating_grid.temperature", "degC", "rpm"),
    ("experiment.thresholds", "ohm", "V"),
]
UNITS = {key: units for key, units, _ in QUANTITIES}

PURE_NUMBERS = [
    ("rollers.first.poisson_ratio", -0.1, "got -0.1, need a value at least 0 and at most 0.5"),
    ("rollers.second.poisson_ratio", 0.51, "got 0.51, need a value at least 0 and at most 0.5"),
    ("rollers.first.poisson_ratio", NAN, "need a finite number"),
    ("rollers.first.poisson_ratio", "0.3 mm", "got '0.3 mm', need a number"),
    ("roughness.hurst_exponent", 0, "got 0, need a value above 0 and below 1"),
    ("roughness.hurst_exponent", 1, "got 1, need a value above 0 and below 1"),
    ("roughness.hurst_exponent", -0.5, "got -0.5, need a value above 0 and below 1"),
    ("rig.oil_permittivity", 0.5, "got 0.5, need a value at least 1"),
    ("rig.noise", "-1 uV", "got -1e-06, need a value at least 0 V"),
    ("rig.lead_resistance", "-1 ohm", "got -1, need a value at least 0 ohm"),
    (
        "rig.amplifier_range",
        "20 mV",
        "rig.amplifier_range: got 0.02 V, need more than the 0.0455 V",
    ),
    ("experiment.release_ratio", 0.9, "got 0.9, need a value at least 1"),
    ("experiment.debounce", "-1 s", "got -1, need a value at least 0 s"),
    ("experiment.threshold", "50 ohm", "got 50 ohm, need one of experiment.thresholds: 10, "),
    ("experiment.manifest", "none.csv", "need a file that is there"),
    ("roughness.hurst_exponent", INFINITY, "need a finite number"),
    (
        "roughness.shortest_wavelength",
        "1.9 points",
        "got 1.9, need a value at least 2 and at most 1.67772e+07 points",
    ),
    ("operating_grid.slide_to_roll_ratio", [2.5], "got 2.5, need a value at least -2 and at most"),
    ("operating_grid.slide_to_roll_ratio", [], "need a list such as [0, 0.1]"),
    ("operating_grid.slide_to_roll_ratio", [0, 0], "got 0 after 0, need rising levels"),
    ("operating_grid.slide_to_roll_ratio", [0.1, 0], "got 0 after 0.1, need rising levels"),
    ("operating_grid.slide_to_roll_ratio", [NAN], "need a finite number"),
    ("operating_grid.slide_to_roll_ratio", 0, "got 0, need a list"),
]

COUNTS = [
    ("seed", -1, "got -1, need at least 0"),
    ("seed", 1.5, "got 1.5, need a whole number"),
    ("seed", 2**63, "need at most 9223372036854775807"),
    ("realisations", 0, "got 0, need at least 1"),
    ("realisations", 1_000_001, "got 1000001, need at most 1000000"),
    ("revolutions", 0, "got 0, need at least 1"),
    ("revolutions", 1.5, "got 1.5, need a whole number"),
    ("realisations", "4", "got '4', need a whole number"),
    ("batch_size", 0, "got 0, need at least 1"),
    ("batch_size", True, "got True, need a whole number"),
    ("roughness.points", 10, "got 10, need at least 64"),
    ("roughness.points", 1e6, "got 1000000.0, need a whole number"),
    ("kept_realisations", [0, 64], "got 64, need realisations from 0 to 63"),
    ("kept_realisations", [-1, 0], "kept_realisations.0: got -1, need at least 0"),
    ("kept_realisations", [0, 0], "0 is repeated, need each once"),
    ("kept_realisations", [1], "need 0 among them"),
    ("kept_realisations", [], "need 0 among them"),
    ("kept_realisations", 0, "got 0, need a list"),
]

GRIDS = [
    ("roughness.points", 5000, "got 5000, too coarse a grid"),
    ("roughness.longest_wavelength", "1 um", "got 1000000, too coarse a grid"),
    ("roughness.longest_wavelength", "1e-310 m", "need a magnitude from 1e-30 to 1e+30"),
    ("roughness.shortest_wavelength", "1 mm", "got 0.001 m, need less than the longest"),
    ("roughness.shortest_wavelength", "1e308 points", "got 1e+308, need a value at least 2 and at"),
    ("roughness.longest_wavelength", "1 m", "the perimeter, 0.314 m, is too short"),
    ("roughness.height_step", "1 nm", "got 1e-09 m, need 2e-14 to 2e-10 m"),
    ("roughness.height_step", "1e-15 m", "got 1e-15 m, need 2e-14 to 2e-10 m"),
]

NAMES = [
    ("lubricants", ["nope"], f"got 'nope', need one of {OIL}"),
    ("lubricants", ["nope.yaml"], "nope.yaml: cannot be read"),
    ("lubricants", [], "got (), need at least 1"),
    ("lubricants", OIL, f"got '{OIL}', need a list"),
    ("lubricants", [3], "got 3, need names or paths of records"),
    ("lubricants", [{"name": "inline"}], "need names or paths of records"),
    ("lubricants", [OIL, OIL], f"{OIL} is repeated, need each once"),
    ("film_formulas", ["nope"], "unknown film formula 'nope', need one of paper"),
    ("film_formulas", [], "got [], need at least 1"),
    ("film_formulas", ["paper", "paper"], "paper is repeated, need each once"),
    ("film_formulas", "paper", "got 'paper', need a list"),
    ("name", "My study", "got 'My study', need lower-case letters"),
    ("name", "../elsewhere", "got '../elsewhere', need lower-case letters"),
    ("name", 3, "got 3, need text"),
    ("rollers", 3, "got 3, need keys with their values"),
]

TRACES = [
    ("traces.0.force", "300 N", "got 300.0, need one of the study's: 100.0, 200.0"),
    ("traces.0.speed", "101 rpm", "got 101.0, need one of the study's: 85.7"),
    ("traces.0.temperature", "41 degC", "got 41.0, need one of the study's: 40.0"),
    ("traces.0.lubricant", "nope", f"got nope, need one of the study's: {OIL}"),
    ("traces.0.film_formula", "nope", "got nope, need one of the study's: paper"),
    ("traces.0.slide_to_roll_ratio", 1.5, "got 1.5, need one of the study's: 0.0"),
    ("traces", [], "got [], need at least 1"),
]


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [*UNKNOWN_KEYS, *PURE_NUMBERS, *COUNTS, *GRIDS, *NAMES, *TRACES],
)
def test_a_mistake_is_told_by_key_value_and_what_is_needed(paper_with, key, value, told):
    message = refusal(paper_with((key, value)))
    assert told in message
    assert "need" in message or "unknown key" in message or "cannot be read" in message
    # Names and grids may be told by the other of two keys that do not fit together.
    if (key, value, told) not in [*GRIDS, *NAMES]:
        assert f"mine.yaml: {key}" in message


@pytest.mark.parametrize(("key", "units", "other"), QUANTITIES)
def test_a_quantity_needs_a_unit_of_its_dimension_and_a_finite_number(
    paper_with, key, units, other
):
    for value in (50, "50", f"50 {other}", f"nan {units}", f"1e999 {units}", NAN, None, [50]):
        message = refusal(paper_with((key, value)))
        assert f"mine.yaml: {key}: " in message
        assert "need" in message


@pytest.mark.parametrize("key", POSITIVE)
@pytest.mark.parametrize("number", ["0", "-0.5"])
def test_lengths_moduli_stresses_and_resistivities_are_positive(paper_with, key, number):
    message = refusal(paper_with((key, f"{number} {UNITS[key]}")))
    assert f"mine.yaml: {key}: got {number[0]}" in message
    assert "need a value above 0" in message


@pytest.mark.parametrize(("key", "units", "other"), LEVELS)
def test_levels_rise_and_have_a_unit_of_their_dimension(paper_with, key, units, other):
    mistakes = {
        "need values and their unit": [
            50,
            [50, 60],
            {"values": [50]},
            {"values": [], "units": units},
            {"values": [50], "units": units, "colour": 1},
        ],
        "need rising levels, each once": [
            {"values": [50, 50], "units": units},
            {"values": [60, 50], "units": units},
        ],
        f"need a unit of the kind '{units}'": [{"values": [50], "units": other}],
        "need a finite number": [{"values": [50, NAN], "units": units}],
        "need a value above": [{"values": [-500], "units": units}],
        "need a number": [{"values": ["fifty"], "units": units}],
    }
    for told, values in mistakes.items():
        for value in values:
            message = refusal(paper_with((key, value)))
            assert f"mine.yaml: {key}: " in message
            assert told in message


@pytest.mark.parametrize("key", ["operating_grid.force", "operating_grid.speed"])
def test_no_force_and_no_speed_is_zero(paper_with, key):
    units = {key: units for key, units, _ in LEVELS}[key]
    message = refusal(paper_with((key, {"values": [0], "units": units})))
    assert "got 0, need a value above 0" in message


@pytest.mark.parametrize("temperature", [39, 101])
def test_temperatures_outside_the_records_range_are_refused(paper_with, temperature):
    value = {"values": [temperature], "units": "degC"}
    message = refusal(paper_with(("operating_grid.temperature", value)))
    assert f"{OIL}: got {temperature} degC, need 40 to 100 degC" in message


def test_every_key_but_those_with_a_default_is_needed(paper_with):
    for key in PAPER_CONTENT.keys() - {"about", "rig", "experiment"}:
        assert f"{key}: missing" in refusal(paper_with((key, REMOVED)))
    for section in ("rollers", "rollers.first", "operating_grid", "roughness", "boundary_layer"):
        place = PAPER_CONTENT
        for part in section.split("."):
            place = place[part]
        for key in place:
            assert f"{section}.{key}: missing" in refusal(paper_with((f"{section}.{key}", REMOVED)))


def test_a_contact_no_wider_than_the_grid_is_fine_is_refused(paper_with):
    forces = {"values": [1e-3, 1600], "units": "N"}
    message = refusal(paper_with(("operating_grid.force", forces), ("traces.0.force", "1600 N")))
    assert "roughness.points: the contact at 0.001 N" in message


def test_a_contact_wider_than_a_roller_is_round_is_refused(paper_with):
    forces = {"values": [1600, 1e10], "units": "N"}
    changes = ("operating_grid.force", forces), ("traces.0.force", "1600 N")
    wavelength = ("roughness.longest_wavelength", "0.4 mm")
    message = refusal(paper_with(*changes, wavelength))
    assert "operating_grid.force: the contact at 1e+10 N" in message


def test_either_rollers_perimeter_must_hold_the_longest_wave(paper_with):
    changes = ("rollers.second.radius", "25 mm"), ("roughness.longest_wavelength", "0.2 m")
    message = refusal(paper_with(*changes))
    assert "rollers.second.radius: the perimeter, 0.157 m, is too short" in message


def test_traces_of_two_speeds_share_no_time_axis(paper_with):
    assert "traces: need one speed" in refusal(paper_with(("traces.1.speed", "150 rpm")))


def test_a_record_without_sources_is_refused(paper_with):
    path = paper_with(("lubricants", ["mine.yaml.oil.yaml"]))
    record = yaml.safe_load((SHIPPED_FOLDER / f"{OIL}.yaml").read_text(encoding="utf-8"))
    for section in [key for key, value in record.items() if isinstance(value, dict)]:
        text = yaml.safe_dump(with_value(record, f"{section}.source", REMOVED))
        (path.parent / "mine.yaml.oil.yaml").write_text(text, encoding="utf-8")
        assert f"{section}.source: missing" in refusal(path)


def test_the_automatic_wavelength_is_offered_where_a_length_is_refused(paper_with):
    message = refusal(paper_with(("roughness.longest_wavelength", "as long as can be")))
    assert AUTOMATIC_WAVELENGTH in message


@pytest.mark.parametrize("name", ["x" * 300 + ".csv", "a\0b.csv", "a\nb.csv", "."])
def test_a_manifest_that_cannot_be_is_refused(paper_with, name):
    message = refusal(paper_with(("experiment.manifest", name)))
    assert "experiment.manifest: got " in message
    assert message.isprintable()


def test_a_study_file_that_is_no_study_is_named(tmp_path):
    assert "absent.yaml: cannot be read" in refusal(tmp_path / "absent.yaml")
    (tmp_path / "empty.yaml").touch()
    assert "empty.yaml: need a mapping" in refusal(tmp_path / "empty.yaml")


@pytest.mark.parametrize("key", ["seed", "realisations", "batch_size", "kept_realisations"])
def test_a_number_that_python_will_not_write_out_is_told_by_its_length(key, tmp_path):
    path, huge = tmp_path / "study.yaml", "0x" + "f" * 5000
    value = f"[0, {huge}]" if key == "kept_realisations" else huge
    text = (CONFIG / "smoke.yaml").read_text(encoding="utf-8")
    path.write_text(re.sub(f"(?m)^{key}: .*$", f"{key}: {value}", text), encoding="utf-8")
    assert re.search("got a whole number of some 60.. digits, need at most [0-9]+$", refusal(path))
