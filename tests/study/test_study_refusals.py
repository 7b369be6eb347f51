"""Every mistake in a study is refused, before anything is computed."""

import re
from functools import partial

from refusals import NEEDED, one_line
from studies import OIL, PAPER_CONTENT, REMOVED

from lube.errors import LubeError
from lube.report.key_tables import keys
from lube.study.rollers import AUTOMATIC_WAVELENGTH
from lube.study.study import Study, load_study

refusal = partial(one_line, LubeError, load_study)

# Key, value, message

UNKNOWN_KEYS = [
    ("about.creators.0.orchid", 1, "about.creators.0.orchid: unknown key, did you mean 'orcid'?"),
    ("operating_grid.load", 1, "operating_grid.load: unknown key, need one of force, speed, "),
]

PURE_NUMBERS = [
    ("rollers.first.poisson_ratio", -0.1, "got -0.1, need a value at least 0 and at most 0.5"),
    ("roughness.hurst_exponent", 0, "got 0, need a value above 0 and below 1"),
    ("rig.oil_permittivity", 0.5, "got 0.5, need a value at least 1"),
    ("rig.noise", "-1 uV", "got -1 uV, need a value at least 0 V"),
    ("rig.leak_resistance", "90 ohm", "got 90 ohm, need more than 1000 ohm, below which"),
    ("rig.noise", "30 mV", "got 30 mV, need at most 0.00831 V, a third of the voltage between"),
    ("rig.amplifier_range", "20 mV", "got 20 mV, need more than the 0.0455 V"),
    ("experiment.release_ratio", 0.9, "got 0.9, need a value at least 1"),
    ("experiment.debounce", "-1 s", "got -1 s, need a value at least 0 s"),
    ("experiment.threshold", "50 ohm", "got 50 ohm, need one of experiment.thresholds: (10.0, "),
    ("experiment.manifest", "none.csv", "need a file that exists"),
    (
        "roughness.shortest_wavelength",
        "1.9 points",
        "got 1.9 points, need a value at least 2 and at most",
    ),
    ("operating_grid.slide_to_roll_ratio", [2.5], "got 2.5, need a value at least -2 and at most"),
    ("operating_grid.slide_to_roll_ratio", [], "need a list such as [0, 0.1]"),
]

CORRECTIONS = [
    ("inlet_meniscus", "0.2 mm", "got 0.2 mm, need more than 210.093 µm, the half-width of"),
    ("inlet_meniscus", "0.4", "got '0.4', need a number with its unit, such as '1 m', or none"),
    ("inlet_meniscus", "far", "or none"),
    ("inlet_meniscus", "-1 mm", "got -1 mm, need a value above 0 m, or none"),
    ("inlet_shear_heating", "gupta", "'zhu-cheng-1988'"),
    ("contact_model", ["volume"], "got 'volume', need 'line' or 'surface'"),
    ("contact_model", ["line", "line"], "got line repeatedly, need it once"),
    ("contact_model", "surface", "got 'surface', need a list such as [surface]"),
]

COUNTS = [
    ("seed", -1, "got -1, need at least 0"),
    ("seed", 1.5, "got 1.5, need a whole number"),
    ("seed", 2**63, "need at most 9223372036854775807"),
    ("realisations", 0, "got 0, need at least 1"),
    ("realisations", 1_000_001, "got 1000001, need at most 1000000"),
    ("revolutions", 0, "got 0, need at least 1"),
    ("batch_size", 0, "got 0, need at least 1"),
    ("roughness.points", 10, "got 10, need at least 64"),
    ("kept_realisations", [0, 64], "got (0, 64), need 0, which the traces use, and none above 63"),
    ("kept_realisations", [0, 0], "got 0 repeatedly, need it once"),
    ("kept_realisations", [1], "got (1,), need 0, which the traces use"),
]

GRIDS = [
    ("roughness.points", 5000, "need 7478 roughness.points or more"),
    ("roughness.longest_wavelength", "1 um", "need less than the longest, 1 µm; if it is"),
    ("roughness.shortest_wavelength", "1 mm", "got 1 mm, need less than the longest"),
    ("roughness.shortest_wavelength", "1e308 points", "got 1e308 points, need a value at least 2"),
    ("roughness.longest_wavelength", "long", f", or the words `{AUTOMATIC_WAVELENGTH}`"),
    ("roughness.longest_wavelength", "1 m", "got a perimeter of 314 mm, need"),
    ("operating_grid.temperature", {"values": [101], "units": "degC"}, f"{OIL}: got 101 degC"),
    (
        "rollers.first.rms_roughness",
        "0.4 mm",
        "got 0.4 mm, need an rms height of 1 nm",
    ),
    ("rollers.first.rms_roughness", "0,2 um", "with a decimal point: '0.2 um'"),
    ("operating_grid.force", {"values": [-5], "units": "kN"}, "got -5 kN, need a value above 0 N"),
    ("roughness.height_step", "1 nm", "got 1 nm, need 0.02 pm to 0.2 nm"),
]

NAMES = [
    ("lubricants", ["nope"], "got 'nope', need one of base-oil-m100"),
    ("lubricants", ["nope.yaml"], "nope.yaml: cannot be read"),
    ("lubricants", [], "got (), need 1 or more entries"),
    ("lubricants", OIL, f"got '{OIL}', need a list"),
    ("lubricants", [3], "lubricants: got 3, need one of "),
    ("lubricants", [[OIL]], f"got ['{OIL}'], need one of "),
    ("lubricants", [OIL, OIL], f"got {OIL} repeatedly, need it once"),
    ("film_formulas", ["nope"], "film_formulas.0: unknown film formula 'nope', need one of paper"),
    ("film_formulas", [], "got [], need 1 or more entries"),
    ("name", "My study", "got 'My study', need lower-case letters"),
    ("name", 3, "got 3, need text"),
    ("rollers", 3, "got 3, need keys with their values"),
]

TRACE = {"force": "800 N", "speed": "150 rpm", "temperature": "40 degC"}
TRACES = [
    ("traces.0.force", "300 N", "got 300.0 N, need one of the study's: 100.0, 200.0"),
    ("traces.0.speed", "101 rpm", "got 101.0 rpm, need one of the study's: 85.7"),
    ("traces.0.lubricant", "nope", f"got nope, need one of the study's: {OIL}"),
    ("traces.0.film_formula", "nope", "got nope, need one of the study's: paper"),
    ("traces", [], "got [], need 1 or more entries"),
    ("traces", [TRACE, TRACE | {"speed": "100 rpm"}], "got several speeds or slide-to-roll ratios"),
]


def test_a_mistake_is_refused_by_key_value_and_what_is_needed(paper_with):
    for key, value, needed in [
        *UNKNOWN_KEYS,
        *PURE_NUMBERS,
        *COUNTS,
        *GRIDS,
        *NAMES,
        *TRACES,
        *CORRECTIONS,
    ]:
        message = refusal(paper_with((key, value)))
        assert needed in message
        assert NEEDED.search(message)
        # Of two keys that do not fit together, either may be named.
        if (key, value, needed) not in [*GRIDS, *NAMES]:
            assert f"mine.yaml: {key}" in message


def test_a_quantity_needs_a_unit_of_its_dimension(paper_with):
    tested = 0
    for cell, value, _ in keys(Study):  # of the JSON schema
        key = cell.strip("`").replace("[]", ".0")
        match = re.match(r"quantity in ([^ ,(]+)(, above 0)?", value)
        if match is None:
            continue
        if ".topography." in key:
            continue  # with a file that is missing here
        tested += 1
        units, positive = match.groups()
        bare = refusal(paper_with((key, 50)))
        assert f"mine.yaml: {key}: got 50, need a number with its unit, such as '1 {units}'" in bare
        wrong = refusal(paper_with((key, "50 kg")))
        assert f"mine.yaml: {key}: wrong dimension or unit 'kg', need a unit of the kind" in wrong
        if positive:
            negative = refusal(paper_with((key, f"-0.5 {units}")))
            assert f"mine.yaml: {key}: got -0.5 {units}, need a value above 0" in negative
    assert tested >= 20


WITH_DEFAULT = (
    "about",
    "rig",
    "experiment",
    "film_shape",
    "inlet_shear_heating",
    "inlet_meniscus",
    "roughness_deformation",
    "contact_model",
    "uncertainty",
)


def test_every_key_without_a_default_is_needed(paper_with):
    keys = [key for key in PAPER_CONTENT if key not in WITH_DEFAULT]
    for section in ("rollers", "operating_grid", "roughness", "boundary_layer"):
        keys += [f"{section}.{key}" for key in PAPER_CONTENT[section]]
    for key in [*keys, "rollers.first.radius"]:
        assert f"{key}: missing" in refusal(paper_with((key, REMOVED)))


def test_lines_that_the_oil_flattens_need_pure_rolling(paper_with):
    flattened = ("roughness_deformation", "venner-1997")
    message = refusal(paper_with(flattened, ("operating_grid.slide_to_roll_ratio", [0, 0.1])))
    assert (
        "roughness_deformation: got venner-1997 with a slide-to-roll ratio of 0.1, need none or "
        "computed" in message
    )
    answered = ("roughness_deformation", "computed")
    load_study(paper_with(answered, ("operating_grid.slide_to_roll_ratio", [0, 0.1])))
    assert "need 'flat' or 'computed'" in refusal(paper_with(("film_shape", "curved")))


def test_surfaces_that_cannot_touch_are_refused(paper_with):
    for *changes, message in [
        (("roughness_deformation", "venner-1997"), "got venner-1997, need none or computed"),
        (("roughness.kurtosis", 4), "roughness: got a skewness of 0 and"),
        (("rollers.length", "0.1 mm"), "rollers.length: got 0.0001 m, need the contact width of"),
        (("roughness.points", 4_000_000), "need one 1.31 times as long, or a longest of"),
    ]:
        said = refusal(paper_with(("contact_model", ["line", "surface"]), *changes))
        assert "mine.yaml: contact_model: surface: " in said and message in said
    said = refusal(paper_with(("load_sharing", "iterated"), ("roughness.kurtosis", 4)))
    assert "load_sharing: got iterated, need none: roughness: got a skewness of 0 and" in said


def test_lays_that_a_line_cannot_take_are_refused(paper_with):
    ridges, surface = ("roughness.lay_ratio", 5), ("contact_model", ["surface"])
    angle = "roughness.lay_angle"
    for *changes, message in [
        (ridges, "roughness.lay_angle: missing, need it with a lay_ratio of 5: 0 deg for ridges"),
        ((angle, "90 deg"), "roughness.lay_angle: got 90 deg without a lay_ratio, need how many"),
        (ridges, (angle, "0 deg"), "got ridges 5 times longer than wide at 0 deg to rolling, need"),
        (ridges, (angle, "120 deg"), "got 120 deg, need a value at least -90 and at most 90 deg"),
        (("roughness.lay_ratio", 0.5), "roughness.lay_ratio: got 0.5, need a value at least 1"),
        (
            *(ridges, (angle, "0 deg"), surface, ("experiment.manifest", "records.csv")),
            "experiment.manifest: got ",
        ),
        (("roughness.lay_ratio", 900), (angle, "90 deg"), "got a perimeter of 314 mm, need room"),
        (
            *(("roughness.lay_ratio", 50), (angle, "30 deg"), surface),
            "need one 7.07 times as long, or shorter ridges",
        ),
    ]:
        assert message in refusal(paper_with(*changes)), message
    load_study(paper_with(ridges, (angle, "0 deg"), surface))
    load_study(paper_with(ridges, (angle, "45 deg")))
    for ratio in (1, 1.4):
        load_study(paper_with(("roughness.lay_ratio", ratio), (angle, "0 deg")))


def test_a_contact_that_does_not_fit_the_grid_or_the_rollers_is_refused(paper_with):
    forces, trace = "operating_grid.force.values", ("traces.0.force", "1600 N")
    longest = "roughness.longest_wavelength"
    for *changes, message in [
        ((forces, [1e-3, 1600]), trace, "operating_grid.force: the contact at 0.001 N"),
        ((forces, [1600, 1e10]), trace, (longest, "0.4 mm"), "force: the contact at 1e+10 N"),
        (("rollers.second.radius", "25 mm"), (longest, "0.2 m"), "got a perimeter of 157 mm"),
    ]:
        assert message in refusal(paper_with(*changes))
