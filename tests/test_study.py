"""A study: read whole, frozen, and every mistake refused before anything is computed."""

import copy
import json
from pathlib import Path

import pytest
import yaml
from pydantic import ValidationError

from lube.apparatus import Experiment, Rig
from lube.errors import LubeError
from lube.records import SHIPPED_FOLDER
from lube.study import load_study
from lube.surfaces import AUTOMATIC_WAVELENGTH

CONFIG = Path(__file__).parents[1] / "workflow" / "config"
PAPER = CONFIG / "paper.yaml"
OIL = "mobilgear-shc-xmp-320"
REMOVED = object()
STAGES = (
    *("lubricant", "film", "roughness", "contact", "trace"),
    *("experiment", "rig", "comparison", "gauge", "speed", "reading"),
)


def with_value(content, key, value):
    """A copy of a study's content with the value of one dotted key exchanged, or removed."""
    content = copy.deepcopy(content)
    *path, last = [int(part) if part.isdigit() else part for part in key.split(".")]
    place = content
    for part in path:
        place = place[part]
    if value is REMOVED:
        del place[last]
    else:
        place[last] = value
    return content


@pytest.fixture(scope="module")
def content():
    return yaml.safe_load(PAPER.read_text(encoding="utf-8"))


@pytest.fixture
def change(content, tmp_path):
    """Write the paper's study with changed values, and return the file."""

    def write(*changes):
        changed = content
        for key, value in changes:
            changed = with_value(changed, key, value)
        path = tmp_path / "mine.yaml"
        path.write_text(yaml.safe_dump(changed), encoding="utf-8")
        return path

    return write


def refusal(path):
    with pytest.raises(LubeError) as caught:
        load_study(path)
    message = str(caught.value)
    assert "\n" not in message
    return message


# What the paper says


def test_the_papers_study_has_the_papers_125_operating_points():
    grid = load_study(PAPER).operating_grid
    assert grid.force == (100.0, 200.0, 400.0, 800.0, 1600.0)
    assert grid.speed == (600.0 / 7.0, 100.0, 120.0, 150.0, 200.0)
    assert grid.temperature == (40.0, 50.0, 60.0, 70.0, 80.0)
    assert len(grid.force) * len(grid.speed) * len(grid.temperature) == 125
    assert 0.0 in grid.slide_to_roll_ratio


def test_the_papers_speeds_are_a_minute_over_tenths_of_a_second():
    expected = [60.0 / (0.1 * tenths) for tenths in (7, 6, 5, 4, 3)]
    assert load_study(PAPER).operating_grid.speed == pytest.approx(expected, rel=1e-15)


def test_the_papers_rollers_are_in_si():
    rollers = load_study(PAPER).rollers
    assert rollers.length == pytest.approx(10e-3)
    assert rollers.first.radius == pytest.approx(50e-3)
    assert rollers.first.rms_roughness == pytest.approx(0.2e-6)
    assert rollers.reduced_radius == pytest.approx(25e-3)
    assert rollers.composite_rms_roughness == pytest.approx(0.2e-6 * 2**0.5)


def test_the_papers_layer_roughness_and_trace():
    study = load_study(PAPER)
    assert study.boundary_layer.critical_thickness == pytest.approx(5e-9)
    assert study.boundary_layer.shear_strength == pytest.approx(1e6)
    assert study.roughness.points == 1_000_000
    assert study.roughness.hurst_exponent == 0.7
    first = study.trace_points[0]
    assert (first["force"], first["speed"], first["temperature"]) == (800.0, 100.0, 40.0)


def test_both_shipped_studies_have_the_same_keys():
    def keys(value):
        if isinstance(value, dict):
            return {key: keys(below) for key, below in value.items()}
        return None

    paper, smoke = (
        yaml.safe_load((CONFIG / name).read_text(encoding="utf-8"))
        for name in ("paper.yaml", "smoke.yaml")
    )
    assert keys(paper) == keys(smoke)


def test_the_defaults_of_the_rig_are_those_of_the_papers_study():
    study = load_study(PAPER)
    assert study.rig == Rig()
    assert study.experiment == Experiment()


# What follows from what is written


def test_the_rigs_rollers_are_none_of_the_simulation(change):
    study = load_study(change(("realisations", 10**6), ("batch_size", 100)))
    assert not set(study.rig_realisations) & set(range(study.realisations))
    assert len(study.rig_realisations) == study.rig.revolutions


def test_a_manifest_is_looked_for_beside_its_study(change, tmp_path):
    (tmp_path / "records.csv").write_text("file\n")
    path = change(("experiment.manifest", "records.csv"))
    assert load_study(path).experiment.manifest == str(tmp_path / "records.csv")


def test_the_longest_wave_is_the_contact_width_at_the_largest_force(change):
    study = load_study(PAPER)
    width = 2.0 * study.rollers.contact_half_width(max(study.operating_grid.force))
    assert 2.0 * 3.141592653589793 / study.line_spec.q_min == pytest.approx(width, rel=1e-12)
    written = load_study(change(("roughness.longest_wavelength", f"{float(width)!r} m")))
    assert written.line_spec.q_min == pytest.approx(study.line_spec.q_min, rel=1e-12)


def test_a_roller_of_half_the_radius_has_half_the_points(change):
    spec = load_study(change(("rollers.second.radius", "25 mm"))).line_spec
    assert spec.points == (1_000_000, 500_000)


@pytest.mark.parametrize(("realisations", "size"), [(64, 8), (7, 3), (1, 5), (6, 6)])
def test_batches_take_every_realisation_once(change, realisations, size):
    study = load_study(change(("realisations", realisations), ("batch_size", size)))
    taken = [number for first in study.batches for number in study.batch(first)]
    assert taken == list(range(realisations))
    assert all(len(study.batch(first)) <= size for first in study.batches)


def test_a_trace_takes_the_first_level_of_what_it_does_not_name(change):
    study = load_study(change(("operating_grid.slide_to_roll_ratio", [0.1, 0.2])))
    point = study.trace_points[0]
    assert point["slide_to_roll_ratio"] == 0.1
    assert point["film_formula"] == study.film_formulas[0]
    assert point["lubricant"] == study.lubricants[0].name


def test_a_trace_may_write_its_level_in_another_unit(change):
    path = change(("traces.0.force", "0.8 kN"), ("traces.0.temperature", "313.15 K"))
    assert load_study(path).trace_points == load_study(PAPER).trace_points


def test_an_own_record_is_found_from_the_studys_folder(change):
    path = change(("lubricants", ["oils/mine.yaml"]))
    (path.parent / "oils").mkdir()
    shipped = (SHIPPED_FOLDER / f"{OIL}.yaml").read_text(encoding="utf-8")
    (path.parent / "oils" / "mine.yaml").write_text(shipped.replace(OIL, "mine"), encoding="utf-8")
    study = load_study(path)
    assert study.lubricants[0].name == "mine"
    assert study.lubricants[0].files[0].samefile(path.parent / "oils" / "mine.yaml")


@pytest.mark.parametrize(
    "freeze",
    [lambda study: study, lambda study: study.rollers.first, lambda study: study.traces[0]],
)
def test_a_study_is_frozen_in_all_its_parts(freeze):
    part = freeze(load_study(PAPER))
    field = next(iter(type(part).model_fields))
    with pytest.raises(ValidationError, match="frozen"):
        setattr(part, field, getattr(part, field))


# What a stage depends on


@pytest.fixture
def changed_stages(change):
    """Stages whose inputs a change of the paper's study changes."""

    def compare(*changes):
        before, after = load_study(PAPER), load_study(change(*changes))
        return {
            stage for stage in STAGES if before.stage_inputs(stage) != after.stage_inputs(stage)
        }

    return compare


MECHANICS = {"contact", "trace", "experiment"}
LINES = MECHANICS | {"roughness"}


@pytest.mark.parametrize(
    ("key", "value", "stages"),
    [
        ("resistivity", "0.3 uohm*m", {"trace", "experiment"}),
        ("boundary_layer.critical_thickness", "6 nm", MECHANICS),
        ("boundary_layer.shear_strength", "2 MPa", MECHANICS),
        ("operating_grid.slide_to_roll_ratio", [0, 0.05], MECHANICS),
        ("revolutions", 3, {"contact"}),
        ("seed", 1, LINES),
        ("roughness.points", 500_000, LINES),
        ("roughness.hurst_exponent", 0.8, LINES),
        ("roughness.height_step", "2 pm", LINES),
        ("roughness.longest_wavelength", "0.4 mm", LINES),
        ("rollers.second.rms_roughness", "0.3 um", LINES | {"film"}),
        ("rollers.first.young_modulus", "220 GPa", LINES | {"film"}),
        ("rollers.first.radius", "60 mm", LINES | {"film"}),
        ("film_formulas", ["paper"], {"film"}),
        ("operating_grid.speed", {"values": [100, 110], "units": "rpm"}, {"film"}),
        ("operating_grid.temperature", {"values": [40, 80], "units": "degC"}, {"lubricant"}),
        ("traces.1.temperature", "60 degC", {"trace", "rig"}),
        ("rig.bandwidth", "10 kHz", {"experiment"}),
        ("experiment.threshold", "10 ohm", {"experiment"}),
        ("realisations", 128, set()),
        ("batch_size", 16, set()),
        ("kept_realisations", [0, 1], set()),
        ("name", "another", set()),
    ],
)
def test_a_change_touches_the_stages_that_depend_on_it_and_no_other(
    changed_stages, key, value, stages
):
    assert changed_stages((key, value)) == stages


def test_a_force_below_the_largest_changes_the_film_alone(changed_stages):
    forces = {"values": [150, 400, 800, 1600], "units": "N"}
    assert changed_stages(("operating_grid.force", forces)) == {"film"}


def test_the_largest_force_changes_the_lines_by_its_contact_width(changed_stages):
    forces = {"values": [800, 1600, 1700], "units": "N"}
    assert changed_stages(("operating_grid.force", forces)) == LINES | {"film"}


def test_the_same_value_in_another_unit_changes_nothing(changed_stages):
    same = ("rollers.length", "0.01 m"), ("rollers.first.young_modulus", "210000 MPa")
    assert changed_stages(*same) == set()


def test_a_lubricants_values_are_inputs_of_the_lubricant_stage_alone(changed_stages):
    assert changed_stages(
        ("lubricants", [OIL, "n-dodecane"]),
        ("operating_grid.temperature", {"values": [40, 50, 60, 70, 80], "units": "degC"}),
    ) == {"lubricant"}


@pytest.mark.parametrize("stage", STAGES)
def test_stage_inputs_are_plain_data(stage):
    inputs = load_study(PAPER).stage_inputs(stage)
    written = json.dumps(inputs, allow_nan=False)
    assert json.dumps(json.loads(written)) == written


# What is refused: key, value, what is told of it

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
    ("roughness.shortest_wavelength", "1.9 points", "got 1.9, need a value at least 2 points"),
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
    ("kept_realisations", [-1, 0], "got -1, need realisations from 0 to 63"),
    ("kept_realisations", [0, 0], "0 is repeated, need each once"),
    ("kept_realisations", [1], "need 0 among them"),
    ("kept_realisations", [], "need 0 among them"),
    ("kept_realisations", 0, "got 0, need a list"),
]

GRIDS = [
    ("roughness.points", 5000, "got 5000, too coarse a grid"),
    ("roughness.longest_wavelength", "1 um", "got 1000000, too coarse a grid"),
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
def test_a_mistake_is_told_by_key_value_and_what_is_needed(change, key, value, told):
    message = refusal(change((key, value)))
    assert told in message
    assert "need" in message or "unknown key" in message or "cannot be read" in message
    # Names and grids may be told by the other of two keys that do not fit together.
    if (key, value, told) not in [*GRIDS, *NAMES]:
        assert f"mine.yaml: {key}" in message


@pytest.mark.parametrize(("key", "units", "other"), QUANTITIES)
def test_a_quantity_needs_a_unit_of_its_dimension_and_a_finite_number(change, key, units, other):
    for value in (50, "50", f"50 {other}", f"nan {units}", f"1e999 {units}", NAN, None, [50]):
        message = refusal(change((key, value)))
        assert f"mine.yaml: {key}: " in message
        assert "need" in message


@pytest.mark.parametrize("key", POSITIVE)
@pytest.mark.parametrize("number", ["0", "-0.5"])
def test_lengths_moduli_stresses_and_resistivities_are_positive(change, key, number):
    message = refusal(change((key, f"{number} {UNITS[key]}")))
    assert f"mine.yaml: {key}: got {number[0]}" in message
    assert "need a value above 0" in message


@pytest.mark.parametrize(("key", "units", "other"), LEVELS)
def test_levels_rise_and_have_a_unit_of_their_dimension(change, key, units, other):
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
            message = refusal(change((key, value)))
            assert f"mine.yaml: {key}: " in message
            assert told in message


@pytest.mark.parametrize("key", ["operating_grid.force", "operating_grid.speed"])
def test_no_force_and_no_speed_is_zero(change, key):
    units = {key: units for key, units, _ in LEVELS}[key]
    assert "got 0, need a value above 0" in refusal(change((key, {"values": [0], "units": units})))


@pytest.mark.parametrize("temperature", [39, 101])
def test_temperatures_outside_the_records_range_are_refused(change, temperature):
    value = {"values": [temperature], "units": "degC"}
    message = refusal(change(("operating_grid.temperature", value)))
    assert f"{OIL}: got {temperature} degC, need 40 to 100 degC" in message


def test_every_key_but_those_with_a_default_is_needed(content, change):
    for key in content.keys() - {"about", "rig", "experiment"}:
        assert f"{key}: missing" in refusal(change((key, REMOVED)))
    for section in ("rollers", "rollers.first", "operating_grid", "roughness", "boundary_layer"):
        place = content
        for part in section.split("."):
            place = place[part]
        for key in place:
            assert f"{section}.{key}: missing" in refusal(change((f"{section}.{key}", REMOVED)))


def test_a_contact_no_wider_than_the_grid_is_fine_is_refused(change):
    forces = {"values": [1e-3, 1600], "units": "N"}
    message = refusal(change(("operating_grid.force", forces), ("traces.0.force", "1600 N")))
    assert "roughness.points: the contact at 0.001 N" in message


def test_a_contact_wider_than_a_roller_is_round_is_refused(change):
    forces = {"values": [1600, 1e10], "units": "N"}
    changes = ("operating_grid.force", forces), ("traces.0.force", "1600 N")
    wavelength = ("roughness.longest_wavelength", "0.4 mm")
    assert "operating_grid.force: the contact at 1e+10 N" in refusal(change(*changes, wavelength))


def test_either_rollers_perimeter_must_hold_the_longest_wave(change):
    changes = ("rollers.second.radius", "25 mm"), ("roughness.longest_wavelength", "0.2 m")
    assert "rollers.second.radius: the perimeter, 0.157 m, is too short" in refusal(
        change(*changes)
    )


def test_traces_of_two_speeds_share_no_time_axis(change):
    assert "traces: need one speed" in refusal(change(("traces.1.speed", "150 rpm")))


def test_a_record_without_sources_is_refused(change):
    path = change(("lubricants", ["mine.yaml.oil.yaml"]))
    record = yaml.safe_load((SHIPPED_FOLDER / f"{OIL}.yaml").read_text(encoding="utf-8"))
    for section in [key for key, value in record.items() if isinstance(value, dict)]:
        text = yaml.safe_dump(with_value(record, f"{section}.source", REMOVED))
        (path.parent / "mine.yaml.oil.yaml").write_text(text, encoding="utf-8")
        assert f"{section}.source: missing" in refusal(path)


def test_the_automatic_wavelength_is_offered_where_a_length_is_refused(change):
    message = refusal(change(("roughness.longest_wavelength", "as long as can be")))
    assert AUTOMATIC_WAVELENGTH in message


@pytest.mark.parametrize("name", ["x" * 300 + ".csv", "a\0b.csv", "a\nb.csv", "."])
def test_a_manifest_that_cannot_be_is_refused(change, name):
    message = refusal(change(("experiment.manifest", name)))
    assert "experiment.manifest: got " in message
    assert message.isprintable()


def test_a_study_file_that_is_no_study_is_named(tmp_path):
    assert "absent.yaml: cannot be read" in refusal(tmp_path / "absent.yaml")
    (tmp_path / "empty.yaml").touch()
    assert "empty.yaml: need a mapping" in refusal(tmp_path / "empty.yaml")
