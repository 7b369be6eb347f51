"""Hostile and careless input: every file is read, or refused in one line, and soon.

Thousands of mistaken studies, records, lists and measurements are made from the shipped ones.
The cases are the same in every run of the same code, so that a test that passed cannot fail for
bad luck (Hypothesis takes numbers and words from the modules that are loaded: changed code, or this
file alone, has other cases). With LUBE_FUZZ=10 in the environment they are ten times as many, and
new ones each time.
"""

import contextlib
import copy
import datetime
import json
import math
import os
from collections import Counter
from functools import partial

import netCDF4
import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from nptdms import ChannelObject, TdmsWriter
from refusals import attempt, check_line, in_time
from studies import CONFIG

from lube.errors import LubeError
from lube.recordings.manifest import read_manifest
from lube.recordings.reader import open_recording
from lube.study.lubricant_record import SHIPPED_FOLDER, check_temperatures, load_record
from lube.study.study import load_study

TIMES_AS_MANY = int(os.environ.get("LUBE_FUZZ", "1"))

STAGES = (
    *("lubricant", "film", "roughness", "contact", "trace", "master"),
    *("experiment", "rig", "comparison", "gauge", "speed", "reading", "coverage"),
)


def fuzz(cases, examples, check):
    """Check so many cases, of which a fair share must be read and a fair share refused."""
    tally = Counter()

    @settings(
        max_examples=TIMES_AS_MANY * examples,
        derandomize=TIMES_AS_MANY == 1,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(cases)
    def run(case):
        tally[check(case)] += 1

    run()
    assert set(tally) == {True, False}
    assert tally.total() >= examples
    # New cases may by chance be mostly of one kind; those of every run are not.
    assert TIMES_AS_MANY > 1 or min(tally.values()) >= 0.1 * examples, tally


# What mistaken files hold

NUMBERS = [0, -1, 2, 10**12, 2**63, 2**64, 10**30, -(10**400), 0.5, 1e-320, 1e308, -0.0]
NUMBERS += [math.nan, math.inf, -math.inf, "1e400", "1e3", "0x10", "1_000", "٣", "1:30", "1.0e+5"]
FORMULAS = ["600/7", "9**9**9", "1/0", "600/0.7", "__import__('os')", "1/" + "7" * 400, "1+1"]
TEXTS = ["", " ", "yes", "null", "~", "-", "\0", "\ud800", "a\nb", "\u202e", "\x1b[31m", "１０ mm"]
TEXTS += ["{wildcard}", "%n%s", "$(touch x)", "../../x", "/dev/zero", "con", "µ" * 20_000]
KEYS = ["name", "seed", "viscosity", "force", "colour", 3, None, "a\nb"]
UNITS = ["mm", "m", "N", "GPa", "degC", "K", "rpm", "ohm", "Hz", "s", "V"]
UNITS += ["parsec", "", "m**9**9**9", "mm; import os", "dBm", "nm/N", "delta_degC"]
LISTS = [[], {}, [[]], [None], {"values": [], "units": "N"}, {"a": {"b": {"c": [1]}}}]
LISTS += [{"values": [1e-300, 1e300], "units": "N"}, {"values": list(range(1, 3000)), "units": "N"}]
OTHERS = [None, True, False, datetime.date(2018, 11, 9), b"\xff\0", {"x"}, list(range(3000))]
FACTORS = [1, 1, 1, 1.01, 0.9, 2, 2, 0.5, 10, 1e6, 1e-6, 1e40, 1e-40, -1, 0]

hostile = st.one_of(
    st.sampled_from(NUMBERS + FORMULAS + TEXTS + LISTS + OTHERS),
    st.builds("{} {}".format, st.sampled_from(NUMBERS + FORMULAS), st.sampled_from(UNITS)),
    st.text(st.characters(codec=None), max_size=20),
    st.integers(),
    st.floats(),
    st.recursive(
        st.none() | st.booleans() | st.text(max_size=3) | st.integers(),
        lambda below: st.lists(below, max_size=3) | st.dictionaries(st.text(), below, max_size=3),
        max_leaves=6,
    ),
)


def places(content, path=()):
    """Paths to all values of nested mappings and lists."""
    if path:
        yield path
    children = enumerate(content) if isinstance(content, list) else ()
    for key, value in content.items() if isinstance(content, dict) else children:
        yield from places(value, (*path, key))


@st.composite
def mistaken(draw, contents):
    """One of some contents with up to three things changed, some of which do no harm."""
    content = copy.deepcopy(draw(st.sampled_from(contents)))
    for _ in range(draw(st.integers(1, 3))):
        *path, last = draw(st.sampled_from(list(places(content))))
        place = content
        for part in path:
            place = place[part]
        value = place[last]
        match draw(st.sampled_from(["rescale"] * 4 + ["replace"] * 2 + ["remove", "move", "nest"])):
            case "rescale":
                place[last] = rescaled(value, draw(st.sampled_from(FACTORS)))
            case "replace":
                place[last] = copy.deepcopy(draw(hostile))
            case "remove":
                del place[last]
            case "move" if isinstance(place, dict):
                place[draw(st.sampled_from(KEYS))] = place.pop(last)
            case "move":
                place.append(copy.deepcopy(value))
            case "nest":
                place[last] = draw(st.sampled_from([[value], {last: value}, [value, value]]))
        if not list(places(content)):
            break
    return content


def rescaled(value, factor):
    """A value with its number larger or smaller, as far as it has one."""
    try:
        if isinstance(value, str):
            number, _, units = value.partition(" ")
            return f"{factor * float(number):g} {units}"
        return round(factor * value) if isinstance(value, int) else factor * value
    except (TypeError, ValueError, OverflowError):
        return value


# What mistaken text looks like, beyond what a YAML library would write

LAUGHS = "a0: &a0 [x, x]\n" + "".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12)
)
FRAGMENTS = [
    *(
        "\t",
        "\ufeff",
        "\0",
        "'",
        '"',
        "{",
        "[",
        "]",
        ": ",
        "- ",
        "#",
        "&a ",
        "*a",
        "? ",
        "|\n",
        "%",
    ),
    *(
        "---\n",
        "...\n",
        "<<: *a\n",
        "<<: {seed: 1}\n",
        "!!python/object/apply:os.getcwd []",
        "!!str ",
    ),
    *("!!int ''", "!!float ''", "!!bool maybe", "!!timestamp x", "!!set {a, b}", "!!binary é"),
    *("? !!set {a}\n: 1\n", "name: again\n", "=: 1\n", "yes", "2018-11-09", "0x" + "f" * 6000),
    *("9" * 5000, "1:" * 2000 + "1.0", "[" * 3000, "- " * 3000, "{a: " * 500, "&a [*a]", LAUGHS),
    *("__use_yte__: true\n", "?for x in range(9):\n", "1e400", "\x85", "\u2028", "é", "x" * 50_000),
]


@st.composite
def spoilt(draw, texts):
    """Bytes of one of some texts, cut off, with bytes changed or fragments put in."""
    content = draw(st.sampled_from(texts))
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(content)))
        kinds = ["harmless"] * 3 + ["fragment", "flip", "flip", "cut", "encode", "drop"]
        match draw(st.sampled_from(kinds)):
            case "harmless":
                content = content.replace(b"\n", b"\r\n# \xc2\xb5\n", draw(st.integers(0, 3)))
            case "fragment":
                at = content.rfind(b"\n", 0, at) + 1 if draw(st.booleans()) else at
                content = content[:at] + draw(st.sampled_from(FRAGMENTS)).encode() + content[at:]
            case "flip" if content:
                at = min(at, len(content) - 1)
                content = content[:at] + bytes([draw(st.integers(0, 255))]) + content[at + 1 :]
            case "cut":
                content = (
                    content[: len(content) - at // 40] if draw(st.booleans()) else content[:at]
                )
            case "encode":
                codec = draw(st.sampled_from(["utf-16", "utf-8-sig", "latin-1", "utf-8-sig"]))
                content = content.decode(errors="replace").encode(codec, errors="replace")
            case "drop":
                content = content[:at] + content[at + draw(st.integers(0, 60)) :]
    return content


# Studies

STUDIES = [CONFIG / name for name in ("smoke.yaml", "paper.yaml", "slip.yaml")]
STUDY_CONTENTS = [yaml.safe_load(path.read_text("utf-8")) for path in STUDIES]


def use(study):
    """All that the workflow asks of a study before the first job."""
    assert study.trace_points
    assert len(study.batches) <= 10_000
    assert study.batch(study.batches[-1])[-1] == study.realisations - 1
    spec = study.line_spec
    assert max(spec.points) <= 2**24
    assert len(study.rig_realisations) >= study.rig.pairs
    for stage in STAGES:
        json.dumps([study.stage_inputs(stage), study.origin(stage)], allow_nan=False)
    study.model_dump_json()


def study_is_valid(path, content):
    path.write_bytes(content)
    study = attempt(load_study, path)
    if study is not None:
        with in_time():
            use(study)
    return study is not None


def written(content):
    return yaml.safe_dump(content).encode()


def test_a_mistaken_study_is_valid_or_told_in_one_line(tmp_path):
    check = partial(study_is_valid, tmp_path / "study.yaml")
    fuzz(mistaken(STUDY_CONTENTS).map(written), 900, check)


def test_a_spoilt_study_is_valid_or_told_in_one_line(tmp_path):
    check = partial(study_is_valid, tmp_path / "study.yaml")
    fuzz(spoilt([STUDIES[0].read_bytes()]), 500, check)


# Lubricant records

RECORDS = sorted(SHIPPED_FOLDER.glob("*.yaml"))
RECORD_CONTENTS = [yaml.safe_load(path.read_text("utf-8")) for path in RECORDS]
TABLE = b"""# our rheometer
temperature [degC], kinematic_viscosity [mm^2/s]
40, 335
60, 140.5
100, 38.3
"""


def record_is_valid(path, content):
    path.write_bytes(content)
    record = attempt(load_record, path)
    if record is None:
        return False
    with in_time(), contextlib.suppress(LubeError):
        check_temperatures(record, [20.0, 40.0])
    assert record.pressure_viscosity.definition_text and record.law_used
    json.dumps(record.model_dump(mode="json"), allow_nan=False)
    return True


def test_a_mistaken_record_is_valid_or_told_in_one_line(tmp_path):
    check = partial(record_is_valid, tmp_path / "oil.yaml")
    fuzz(mistaken(RECORD_CONTENTS).map(written), 400, check)


def test_a_spoilt_record_is_valid_or_told_in_one_line(tmp_path):
    check = partial(record_is_valid, tmp_path / "oil.yaml")
    fuzz(spoilt([path.read_bytes() for path in RECORDS]), 200, check)


def test_a_spoilt_table_of_viscosities_is_read_or_told_in_one_line(tmp_path):
    content = copy.deepcopy(RECORD_CONTENTS[0])
    content["viscosity"] = {"source": "assumed: fuzz", "csv": "table.csv"}
    path = tmp_path / "oil.yaml"
    path.write_bytes(written(content))

    def is_read(table):
        (tmp_path / "table.csv").write_bytes(table)
        return attempt(lambda _: load_record(path), tmp_path / "table.csv") is not None

    fuzz(spoilt([TABLE, TABLE.replace(b".", b",").replace(b", ", b";")]), 200, is_read)


# Lists of measurements

LIST = b"""file, probability, force [N], speed [rpm], temperature [K], lubricant, gain, offset [V]
run.csv,    , 800, 100, 40, oil, 10, 3
       , 0.5, 800, 100, 50, oil, ,
"./run.csv",, 8e2, 600/7, 60, "oil", -1/3, 0
"""
LIST_CONTENT = [
    {"file": "run.csv", "force": "800 N", "speed": "100 rpm", "temperature": "40 degC"},
    {
        "probability": 0.5,
        "lower": "1/3",
        "force": "1 kN",
        "speed": "2 turn/s",
        "temperature": "320 K",
    },
    {"file": "run.csv", "sampling_interval": "10 us", "force": "800 N", "speed": "90 rpm"}
    | {
        "temperature": "40 degC",
        "lubricant": "oil",
        "slide_to_roll_ratio": 0,
        "origin": "measured",
        "channel": "U",
        "unit": "mV",
        "gain": 10,
        "offset": "3 mV",
        "temperature_tolerance": "1 degC",
        "pair": "A",
    },
]


def list_is_read(path, content):
    """Whether all of a list is read; a row that is not is told in a line of its own."""
    path.write_bytes(content)
    found = attempt(read_manifest, path)
    for line in [] if found is None else found.refused:
        check_line(line)
        assert line.startswith(path.name)
    return found is not None and not found.refused


@pytest.mark.parametrize("suffix", ["csv", "yaml"])
def test_a_spoilt_list_of_measurements_is_read_or_told_in_one_line(tmp_path, suffix):
    (tmp_path / "run.csv").write_text("t [s], U [V]\n0, 1\n1, 2\n")
    path = tmp_path / f"list.{suffix}"
    text = LIST if suffix == "csv" else written(LIST_CONTENT)
    fuzz(spoilt([text]), 150, partial(list_is_read, path))


def test_a_mistaken_list_of_measurements_is_read_or_told_in_one_line(tmp_path):
    (tmp_path / "run.csv").write_text("t [s], U [V]\n0, 1\n1, 2\n")
    cases = mistaken([{"list": LIST_CONTENT}]).map(lambda content: written(content.get("list")))
    fuzz(cases, 150, partial(list_is_read, tmp_path / "list.yaml"))


# Measurements

SAMPLES = 400


def netcdf_bytes(folder):
    path = folder / "whole.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", SAMPLES)
        variable = file.createVariable("voltage", "f8", ("time",), fletcher32=True, zlib=True)
        variable.setncatts({"units": "mV", "sampling_interval": "10 us"})
        variable[:] = np.sin(np.arange(SAMPLES))
    return path.read_bytes()


def tdms_bytes(folder):
    path = folder / "whole.tdms"
    told = {"wf_increment": 1e-5, "unit_string": "V"}
    with TdmsWriter(path) as file:
        for part in np.array_split(np.sin(np.arange(SAMPLES)), 2):
            file.write_segment([ChannelObject("rig", "U", part, told)])
    return path.read_bytes()


def csv_bytes(_):
    rows = "".join(f"{1e-5 * n:.5f},{math.sin(n):.6f}\n" for n in range(SAMPLES))
    return f"# rig\ntime [s],voltage [V]\n{rows}".encode()


@pytest.mark.parametrize(
    ("suffix", "whole", "examples"),
    [("csv", csv_bytes, 200), ("nc", netcdf_bytes, 150), ("tdms", tdms_bytes, 150)],
)
def test_a_spoilt_measurement_is_read_or_told_in_one_line(tmp_path, suffix, whole, examples):
    path = tmp_path / f"run.{suffix}"

    def is_read(content):
        path.write_bytes(content)
        return (
            attempt(lambda path: sum(p.size for p in open_recording(path).pieces()), path)
            is not None
        )

    fuzz(spoilt([whole(tmp_path)]), examples, is_read)
