"""Fields of the YAML files: SI inside, units outside, mistakes told in one line."""

from typing import Annotated

import pytest
from pydantic import Field, StrictInt, ValidationError, create_model

from lube.errors import LubeError, RecordError, StudyError
from lube.study.field_types import (
    Length,
    Pressure,
    Resistivity,
    Slug,
    StrictModel,
    bounded,
    collected,
    levels,
    pure_number,
    quantity,
    read_yaml,
    validate,
)


def value_of(field, written):
    """What a model keeps of one written value."""
    model = create_model("Model", __base__=StrictModel, field=(field, ...))
    return validate(model, {"field": written}, "file.yaml", StudyError).field


Count = Annotated[StrictInt, Field(ge=0, le=10)]


def refusal(field, written):
    with pytest.raises(StudyError) as caught:
        value_of(field, written)
    message = str(caught.value)
    assert message.startswith("file.yaml: field")
    assert "\n" not in message
    return message


@pytest.mark.parametrize(
    ("field", "written", "kept"),
    [
        (Length, "50 mm", 0.05),
        (Pressure, "210 GPa", 210e9),
        (quantity("degC", above=-273.15), "313.15 K", 40.0),
        (Resistivity, "0.2 uohm*m", 0.2e-6),
        (quantity("N", least=0.0), "0 N", 0.0),
        (pure_number(below=1.0), 0.7, 0.7),
        (pure_number(), "600/7", 600.0 / 7.0),
        (pure_number(other_than=0.0), "-1/10", -0.1),
    ],
)
def test_a_field_keeps_the_number_in_its_own_unit(field, written, kept):
    assert value_of(field, written) == pytest.approx(kept, rel=1e-14)


@pytest.mark.parametrize("zero", [0, 0.0, "-0.0", "0/7"])
def test_a_number_may_have_to_be_other_than_zero(zero):
    assert "need a value other than 0" in refusal(pure_number(other_than=0.0), zero)


@pytest.mark.parametrize("field", [Length, Pressure, Resistivity])
@pytest.mark.parametrize("number", ["0", "-1"])
def test_lengths_pressures_and_resistivities_are_positive(field, number):
    units = {Length: "mm", Pressure: "GPa", Resistivity: "uohm*m"}[field]
    assert "need a value above 0" in refusal(field, f"{number} {units}")


def test_no_temperature_is_as_cold_as_absolute_zero():
    assert "need a value above -273.15 degC" in refusal(quantity("degC", above=-273.15), "0 K")


@pytest.mark.parametrize(
    ("limits", "inside", "outside"),
    [
        ({"above": 0.0}, 1e-300, 0.0),
        ({"below": 1.0}, 0.999, 1.0),
        ({"least": 0.0}, 0.0, -1e-300),
        ({"most": 0.5}, 0.5, 0.5000001),
    ],
)
def test_limits_that_may_be_touched_and_that_may_not(limits, inside, outside):
    assert bounded(inside, None, **limits) == inside
    with pytest.raises(LubeError, match="need a value"):
        bounded(outside, None, **limits)


def test_a_refused_number_is_told_with_all_its_limits_and_its_unit():
    with pytest.raises(LubeError) as caught:
        bounded(3.0, "mm", above=0.0, most=2.0)
    assert str(caught.value) == "got 3, need a value above 0 and at most 2 mm"


def test_levels_are_kept_in_order_and_in_their_own_unit():
    field = levels("degC", above=-273.15)
    assert value_of(field, {"values": [313.15, "353.15"], "units": "K"}) == pytest.approx((40, 80))
    assert value_of(levels(None), [0, 0.1]) == (0.0, 0.1)


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ({"values": [], "units": "N"}, "need values and their unit"),
        ({"values": [1, 1], "units": "N"}, "got 1 after 1, need rising levels"),
        ({"values": [2, 1], "units": "N"}, "got 1 after 2, need rising levels"),
        ({"values": [0, 1], "units": "N"}, "need a value above 0"),
        ({"values": [1, float("nan")], "units": "N"}, "need a finite number"),
        ({"values": [1, "two"], "units": "N"}, "got 'two', need a number"),
        ({"values": [1], "units": "mm"}, "need a unit of the kind 'N'"),
        ({"values": [1], "units": 7}, "got units 7"),
        ({"values": [1]}, "need values and their unit"),
        ({"values": [1], "units": "N", "more": 1}, "need values and their unit"),
        ({"values": 1, "units": "N"}, "need values and their unit"),
        ([1, 2], "need values and their unit"),
        ("1 N", "need values and their unit"),
    ],
)
def test_levels_are_refused(written, told):
    assert told in refusal(levels("N", above=0.0), written)


def test_an_unknown_key_is_refused_by_name():
    model = create_model("Model", __base__=StrictModel, field=(Length, ...))
    with pytest.raises(StudyError) as caught:
        validate(model, {"field": "1 m", "colour": 1}, "file.yaml", StudyError)
    assert str(caught.value) == "file.yaml: colour: unknown key"


def test_a_key_on_two_lines_is_told_on_one():
    model = create_model("Model", __base__=StrictModel)
    with pytest.raises(StudyError) as caught:
        validate(model, {"two\nlines": 1}, "file.yaml", StudyError)
    assert str(caught.value) == "file.yaml: two lines: unknown key"


def test_a_missing_key_is_told_and_further_mistakes_are_counted():
    model = create_model("Model", __base__=StrictModel, one=(Length, ...), two=(Length, ...))
    with pytest.raises(RecordError) as caught:
        validate(model, {}, "file.yaml", RecordError)
    assert str(caught.value) == "file.yaml: one: missing, and it has no default (and 1 more)"


def test_models_are_frozen():
    model = create_model("Model", __base__=StrictModel, field=(Length, ...))
    checked = validate(model, {"field": "1 m"}, "file.yaml", StudyError)
    with pytest.raises(ValidationError, match="frozen"):
        checked.field = 2.0


def test_an_error_about_a_key_is_one_that_pydantic_collects():
    with pytest.raises(ValueError, match=r"^colour: too blue$"), collected("colour"):
        raise LubeError("too blue")


@pytest.fixture
def write(tmp_path):
    def write_file(content):
        path = tmp_path / "file.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write_file


def test_yaml_is_read_as_plain_values(write):
    assert read_yaml(write("a: {b: [1, x]}"), StudyError) == {"a": {"b": [1, "x"]}}


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("a: 1\nb: 2\na: 3\n", "line 3: key 'a' is repeated"),
        ("a:\n  b: 1\n  b: 1\n", "line 3: key 'b' is repeated"),
        ("[a, b]: 1\n", "line 1: a key must be a word"),
        ("a: [1\n", "not valid YAML at line 2"),
        ("a: !!python/object/apply:os.getcwd []\n", "not valid YAML"),
        ("- a\n- b\n", "need a mapping of keys to values, got list"),
        ("", "need a mapping of keys to values, got NoneType"),
        (b"\xff\xfe\x00", "it is not UTF-8 text"),
        ("a: " + "[" * 5000, "not valid YAML"),
        ("a: \t- b", "at line 1: found character '\\t' that cannot start any token"),
        ("? !!set {a}\n: 1\n", "line 1: a key must be a word"),
        ("a: {b: 1}\n<<: {c: 2}\n", "line 2: got '<<', need the keys written out"),
        ("a: &a {b: 1}\nc:\n  <<: [*a, *a]\n", "line 3: got '<<', need the keys"),
        ("a: *b\n", "at line 1: found undefined alias 'b'"),
        ("a: !!int ''\n", "line 1: got '"),
        ("a: !!float ''\n", "line 1: got '"),
        ("a: !!bool maybe\n", "line 1: got 'maybe', not valid as the day, number or other"),
        ("a: !!timestamp soon\n", "line 1: got '"),
        ("b: 1\na: 2018-02-30\n", "line 2: got '2018-02-30', not valid as the day, number"),
        ("a: " + "9" * 5000 + "\n", "line 1: got '"),
        ("a: " + "1:" * 3000 + "1.5\n", "line 1: got '"),
        ("a: " + "x" * 2**18, "need a file of 262144 bytes at most"),
    ],
    ids=lambda value: ascii(value)[:30],
)
def test_a_file_that_is_no_mapping_is_refused_in_one_line(write, content, told):
    path = write(content)
    with pytest.raises(StudyError) as caught:
        read_yaml(path, StudyError)
    assert str(caught.value).startswith(f"{path}: ")
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        *("0x" + "f" * 6000, "[" + "1, " * 9999 + "1]", "{" + "x" * 999 + ": 1}", "2018-11-09"),
        *("!!binary /w==", "&a [*a]", "{a: &a {b: *a}}", '"\\ud800"', '"\\0\\e[2J\\u202e"', ".nan"),
    ],
    ids=lambda text: text[:20],
)
@pytest.mark.parametrize("field", [Length, Slug, levels("N"), levels(None), pure_number(), Count])
def test_whatever_stands_for_a_value_is_told_in_one_short_line(write, field, text):
    content = read_yaml(write(f"field: {text}"), StudyError)["field"]
    message = refusal(field, content)
    assert message.isprintable()
    assert len(message) < 300


def test_laughs_that_no_memory_holds_are_told_in_one_line(write):
    laughs = [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 30)]
    content = read_yaml(write("\n".join(["a0: &a0 ha", *laughs])), StudyError)
    for field in (Length, Slug, levels("N"), levels(None), tuple[int, ...]):
        assert len(refusal(field, content["a29"])) < 300
        assert len(refusal(field, content)) < 300


@pytest.mark.parametrize("number", [1e-31, -1e31, 1e300])
def test_magnitudes_that_nothing_has_are_refused(number):
    needed = "need a magnitude from 1e-30 to 1e+30"
    assert needed in refusal(quantity("N"), f"{number} N")
    assert needed in refusal(pure_number(), number)
    assert needed in refusal(levels("N"), {"values": [number], "units": "N"})
    assert value_of(quantity("N"), "0 N") == 0.0


def test_levels_have_an_end():
    assert "got 1001 levels, need 1000 at most" in refusal(levels(None), list(range(1001)))


def test_a_key_that_is_no_text_is_unknown():
    model = create_model("Model", __base__=StrictModel)
    for key in (3, None, True, 2.5):
        with pytest.raises(StudyError, match="unknown key"):
            validate(model, {key: 1}, "file.yaml", StudyError)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(RecordError, match=r"absent\.yaml: cannot be read: No such file"):
        read_yaml(tmp_path / "absent.yaml", RecordError)


def test_a_folder_is_not_read(tmp_path):
    with pytest.raises(RecordError, match="cannot be read"):
        read_yaml(tmp_path, RecordError)
