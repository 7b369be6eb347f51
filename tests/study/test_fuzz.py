"""Careless input: every file is read, or refused in one line, and soon.

Mistaken studies, lubricant records, manifests and measured records are made from correct ones. By
default there are few cases, the same in every run; `pytest -m slow` tries many new ones.
"""

import contextlib
import copy
import json
import math
from collections import Counter
from datetime import timedelta
from functools import partial, reduce
from operator import getitem

import pytest
import written_recordings
import yaml
from editors import check_schema
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from refusals import attempt, check_line
from studies import CONFIG, SMOKE
from written_recordings import write_csv, write_netcdf, write_tdms

from lube.errors import LubeError
from lube.recordings.manifest import read_manifest
from lube.recordings.reader import open_recording
from lube.study.lubricant_record import SHIPPED_FOLDER, load_record
from lube.study.resolve import resolved_content, resolved_text
from lube.study.study import load_study
from lube.study.text_files import read_yaml
from lube.study.viscosity_points import read_viscosity_csv

FEW, MANY = 40, 1000

cases = pytest.mark.parametrize(
    "examples", [FEW, pytest.param(MANY, marks=pytest.mark.slow)], ids=["few", "many"]
)


def fuzz(mistakes, examples, check, path):
    """Check a file with so many contents, of which some must be read and some refused."""
    tally = Counter()

    @settings(
        max_examples=examples,
        derandomize=examples == FEW,
        deadline=timedelta(minutes=1),
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(mistakes)
    def run(content):
        path.write_bytes(content)
        tally[check(path)] += 1

    run()
    assert set(tally) == {True, False}


# What mistaken files hold

NUMBERS = [0, -1, 2, 10**12, 2**64, 10**30, 0.5, 1e-320, 1e308, -0.0, math.nan, math.inf]
NUMBERS += ["1e400", "1e3", "0x10", "1_000", "٣", "1:30", "1.0e+5", "600/7", "1/0", "600/0.7"]
TEXTS = ["", " ", "yes", "null", "~", "-", "a\nb", "１０ mm", "{wildcard}", "../../x", "1+1"]
KEYS = ["name", "seed", "viscosity", "force", "colour", 3, None, "a\nb"]
UNITS = ["mm", "m", "N", "GPa", "degC", "K", "rpm", "ohm", "Hz", "s", "V"]
UNITS += ["parsec", "", "dBm", "nm/N", "delta_degC", "m^", "(m"]
OTHERS = [[], {}, [[]], [None], {"values": [], "units": "N"}, {"a": {"b": {"c": [1]}}}]
OTHERS += [{"values": [1e-300, 1e300], "units": "N"}, None, True, False, list(range(3000))]
FACTORS = [1, 1, 1, 1.01, 0.9, 2, 2, 0.5, 10, 1e6, 1e-6, 1e40, 1e-40, -1, 0]

words = st.text(st.characters(codec="utf-8", exclude_categories=["C"]), max_size=20)
careless = st.one_of(
    st.sampled_from(NUMBERS + TEXTS + OTHERS),
    st.builds("{} {}".format, st.sampled_from(NUMBERS), st.sampled_from(UNITS)),
    words | st.integers() | st.floats(),
    st.lists(st.none() | st.integers(), max_size=3),
    st.dictionaries(words, st.none() | st.integers(), max_size=3),
)


def keys_of(content, path=()):
    """Keys of all values of nested mappings and lists, as tuples."""
    if path:
        yield path
    children = enumerate(content) if isinstance(content, list) else ()
    for key, value in content.items() if isinstance(content, dict) else children:
        yield from keys_of(value, (*path, key))


@st.composite
def mistaken(draw, contents):
    """YAML of one of some contents with up to three changes, some of which do no harm."""
    content = copy.deepcopy(draw(st.sampled_from(contents)))
    for _ in range(draw(st.integers(1, 3))):
        *path, last = draw(st.sampled_from(list(keys_of(content))))
        section = reduce(getitem, path, content)
        value = section[last]
        match draw(st.sampled_from(["rescale"] * 4 + ["replace"] * 2 + ["rename", "nest"])):
            case "rescale":
                section[last] = rescaled(value, draw(st.sampled_from(FACTORS)))
            case "replace":
                section[last] = copy.deepcopy(draw(careless))
            case "rename" if isinstance(section, dict):
                section[draw(st.sampled_from(KEYS))] = section.pop(last)
            case _:
                section[last] = draw(st.sampled_from([[value], {last: value}, [value, value]]))
    return yaml.safe_dump(content).encode()


def rescaled(value, factor):
    """A value with its number larger or smaller, as far as it has one."""
    try:
        if isinstance(value, str):
            number, _, units = value.partition(" ")
            return f"{factor * float(number):g} {units}"
        return round(factor * value) if isinstance(value, int) else factor * value
    except (TypeError, ValueError, OverflowError):
        return value


FRAGMENTS = ["\t", "\ufeff", "'", '"', *"{[]#%", ": ", "- ", "&a ", "*a", "? ", "|\n"]
FRAGMENTS += ["---\n", "...\n", "<<: *a\n", "<<: {seed: 1}\n", "!!str ", "!!int ''", "!!binary é"]
FRAGMENTS += ["!!python/object/apply:os.getcwd []", "? !!set {a}\n: 1\n", "name: again\n", "=: 1\n"]
FRAGMENTS += ["yes", "2018-11-09", "2018-02-30", "1e400", "\x85", "é", ";", ",", "based_on: x\n"]


@st.composite
def spoilt(draw, texts):
    """Bytes of one of some texts, cut off, with bytes changed or fragments put in."""
    content = draw(st.sampled_from(texts))
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(content)))
        match draw(st.sampled_from(["harmless"] * 3 + ["fragment", "flip", "cut", "encode"])):
            case "harmless":
                content = content.replace(b"\n", b"\r\n# \xc2\xb5\n", draw(st.integers(0, 3)))
            case "fragment":
                content = content[:at] + draw(st.sampled_from(FRAGMENTS)).encode() + content[at:]
            case "flip":
                content = content[:at] + bytes([draw(st.integers(0, 255))]) + content[at + 1 :]
            case "cut":
                content = content[:at] + content[at + draw(st.sampled_from([1, 60, 10**6])) :]
            case "encode":
                codec = draw(st.sampled_from(["utf-16", "latin-1", "utf-8-sig"]))
                content = content.decode(errors="replace").encode(codec, errors="replace")
    return content


# Studies, lubricant records, manifests

STUDIES = [resolved_content(CONFIG / f"{name}.yaml") for name in ("smoke", "paper", "slip")]
SHIPPED = sorted(SHIPPED_FOLDER.glob("*.yaml"))
RECORDS = [yaml.safe_load(path.read_text("utf-8")) for path in SHIPPED]
TABLE = b"""# our rheometer
temperature [degC], kinematic_viscosity [mm^2/s]
40, 335
60, 140.5
100, 38.3
"""
LIST = b"""file, probability, force [N], speed [rpm], temperature [K], lubricant, gain, offset [V]
run.csv,    , 800, 100, 40, oil, 10, 3
       , 0.5, 800, 100, 50, oil, ,
"./run.csv",, 8e2, 600/7, 60, "oil", -1/3, 0
"""
POINT = {"force": "800 N", "speed": "90 rpm", "temperature": "40 degC"}
ROWS = [
    {"file": "run.csv"} | POINT,
    {"probability": 0.5, "lower": "1/3"} | POINT | {"force": "1 kN", "speed": "2 turn/s"},
    {"file": "run.csv", "sampling_interval": "10 us", "lubricant": "oil", "origin": "measured"}
    | {"channel": "U", "unit": "mV", "gain": 10, "offset": "3 mV", "pair": "A"}
    | {"slide_to_roll_ratio": 0, "temperature_tolerance": "1 degC"}
    | POINT,
]


def study_is_valid(path):
    """Whether a study is read; what the workflow asks of it before the first job is plain data."""
    study = attempt(load_study, path)
    if study is not None:
        check_schema("study", read_yaml(path, LubeError))
        assert study.batch(study.batches[-1])[-1] == study.realisations - 1
        assert study.trace_points and study.line_spec and study.rig_realisations
        json.dumps(study.origin("gauge"), allow_nan=False)
    return study is not None


def record_is_valid(path):
    record = attempt(load_record, path)
    if record is None:
        return False
    check_schema("lubricant", read_yaml(path, LubeError))
    with contextlib.suppress(LubeError):
        record.check_temperatures([20.0, 40.0])
    assert record.pressure_viscosity.definition_text and record.law_used
    json.dumps(record.model_dump(mode="json"), allow_nan=False)
    return True


def manifest_is_read(path):
    """Whether all of a manifest is read; a row that is not is reported in a line of its own."""
    (path.parent / "run.csv").write_text("t [s], U [V]\n0, 1\n1, 2\n")
    found = attempt(read_manifest, path)
    for line in [] if found is None else found.refused:
        check_line(line)
        assert line.startswith(path.name)
    accepted = found is not None and not found.refused
    if accepted and path.suffix == ".yaml":
        check_schema("manifest", read_yaml(path, LubeError, list))
    return accepted


def is_read(read):
    return lambda path: attempt(read, path) is not None


CSV_TABLES = [TABLE, TABLE.replace(b".", b",").replace(b", ", b";")]
FILES = [
    ("study.yaml", mistaken(STUDIES), study_is_valid),
    ("study.yaml", spoilt([resolved_text(SMOKE).encode()]), study_is_valid),
    ("oil.yaml", mistaken(RECORDS), record_is_valid),
    ("oil.yaml", spoilt([path.read_bytes() for path in SHIPPED]), record_is_valid),
    ("viscosity.csv", spoilt(CSV_TABLES), is_read(read_viscosity_csv)),
    ("list.yaml", mistaken([ROWS]), manifest_is_read),
    ("list.csv", spoilt([LIST]), manifest_is_read),
]


@cases
@pytest.mark.parametrize(("name", "mistakes", "check"), FILES)
def test_a_mistaken_file_is_read_or_refused_in_one_line(tmp_path, examples, name, mistakes, check):
    fuzz(mistakes, examples, check, tmp_path / name)


# Measured records

TIMES, VOLTS = written_recordings.TIMES[:400], written_recordings.VOLTS[:400]
WRITERS = {
    "csv": partial(write_csv, columns=[TIMES, VOLTS], header="time [s],voltage [V]"),
    "nc": partial(write_netcdf, values=VOLTS, times=None, sampling_interval="20 us"),
    "tdms": partial(write_tdms, values=VOLTS, segments=2, wf_increment=2e-5, unit_string="V"),
}


@cases
@pytest.mark.parametrize("kind", WRITERS)
def test_a_spoilt_record_is_read_or_refused_in_one_line(tmp_path, examples, kind):
    check = is_read(lambda path: sum(piece.size for piece in open_recording(path).pieces()))
    whole = WRITERS[kind](tmp_path / f"whole.{kind}").read_bytes()
    fuzz(spoilt([whole]), examples, check, tmp_path / f"run.{kind}")
