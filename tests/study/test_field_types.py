"""Fields of the YAML files: SI inside, units outside, mistakes reported in one line."""

from typing import Annotated

import pytest
from pydantic import BeforeValidator, Field, create_model

from lube.errors import LubeError, RecordError, StudyError
from lube.study.field_types import (
    Length,
    Slug,
    StrictModel,
    bounded,
    levels,
    quantity,
    validate,
)

NAN = float("nan")


def model_of(**fields):
    return create_model("Model", __base__=StrictModel, **fields)


def value_of(field, written):
    """What a model keeps of one written value."""
    kind = Annotated[object, field] if isinstance(field, BeforeValidator) else field
    model = model_of(field=(kind, ...))
    return validate(model, {"field": written}, "file.yaml", StudyError).field


def refusal(field, written):
    with pytest.raises(StudyError) as caught:
        value_of(field, written)
    message = str(caught.value)
    assert message.startswith("file.yaml: field")
    assert "\n" not in message
    return message


def test_a_field_keeps_the_number_in_its_own_unit():
    for field, written, kept in [
        (Length, "50 mm", 0.05),
        (quantity("Pa", above=0.0), "210 GPa", 210e9),
        (quantity("degC", above=-273.15), "313.15 K", 40.0),
        (quantity("ohm*m"), "0.2 uohm*m", 0.2e-6),
        (quantity("N", least=0.0), "0 N", 0.0),
        (quantity(None, below=1.0), 0.7, 0.7),
        (quantity(None), "600/7", 600.0 / 7.0),
        (quantity(None, other_than=0.0), "-1/10", -0.1),
    ]:
        assert value_of(field, written) == pytest.approx(kept, rel=1e-14)


def test_a_refused_number_is_shown_with_its_limits_and_unit():
    cold = refusal(quantity("degC", above=-273.15), "0 K")
    assert "got 0 K, need a value above -273.15 degC" in cold
    for zero in (0, 0.0, "-0.0", "0/7"):
        assert "need a value other than 0" in refusal(quantity(None, other_than=0.0), zero)
    message = refusal(quantity("mm", above=0.0, most=2.0), "3 mm")
    assert message == "file.yaml: field: got 3 mm, need a value above 0 and at most 2 mm"


def test_limits_that_may_be_reached_and_that_may_not():
    for limits, inside, outside in [
        ({"above": 0.0}, 1e-30, 0.0),
        ({"below": 1.0}, 0.999, 1.0),
        ({"least": 0.0}, 0.0, -1e-30),
        ({"most": 0.5}, 0.5, 0.5000001),
    ]:
        assert bounded(inside, None, **limits) == inside
        with pytest.raises(LubeError, match="need a value"):
            bounded(outside, None, **limits)


def test_a_magnitude_that_would_overflow_is_refused():
    for number in (1e-31, -1e31, 1e300):
        needed = "need a magnitude from 1e-30 to 1e+30"
        assert needed in refusal(quantity("N"), f"{number} N")
        assert needed in refusal(quantity(None), number)
        assert needed in refusal(levels("N"), {"values": [number], "units": "N"})


def test_levels_are_kept_in_order_and_in_their_own_unit():
    field = levels("degC", above=-273.15)
    assert value_of(field, {"values": [313.15, "353.15"], "units": "K"}) == pytest.approx((40, 80))
    assert value_of(levels(None), [0, 0.1]) == (0.0, 0.1)


def test_levels_are_refused():
    for written, needed in [
        ({"values": [], "units": "N"}, "need values and their unit"),
        ({"values": [1, 1], "units": "N"}, "got 1 N after 1 N, need rising levels"),
        ({"values": [0, 1], "units": "N"}, "need a value above 0"),
        ({"values": [1, "two"], "units": "N"}, "got 'two N', need a number with its unit"),
        ({"values": [1], "units": "mm"}, "need a unit of the kind 'N'"),
        ({"values": [1]}, "need values and their unit"),
        ({"values": [1], "units": "N", "more": 1}, "need values and their unit"),
        ([1, 2], "need values and their unit, such as {values: [1, 2], units: N}"),
    ]:
        assert needed in refusal(levels("N", above=0.0), written)
    for written in ([], 0, "0", {"values": [0], "units": "1"}):
        assert "need a list such as [0, 0.1]" in refusal(levels(None), written)


def test_a_value_of_another_kind_is_refused_in_one_short_line():
    values = [None, True, [1] * 9999, {"x" * 999: 1}, {"a": {"b": [1]}}, "a\nb", NAN, b"\xff"]
    for field in (Length, Slug, levels("N"), levels(None), quantity(None)):
        for value in values:
            message = refusal(field, value)
            assert message.isprintable()
            assert len(message) < 300


def test_a_misspelt_key_is_refused_with_the_nearest_right_one():
    inner = model_of(radius=(Length, ...), length=(Length, ...))
    model = model_of(first=(inner, ...), others=(tuple[inner, ...] | None, None))
    roller = {"radius": "1 m", "length": "1 m"}
    keys = "need one of radius, length; a text with a comma needs quotes"
    for content, line in [
        ({"frist": roller}, "frist: unknown key, did you mean 'first'? (and 1 more)"),
        (
            {"first": roller, "others": [roller, roller | {"lenght": 1}]},
            "others.1.lenght: unknown key, did you mean 'length'?",
        ),
        ({"first": roller | {"colour": None}}, f"first.colour: unknown key, {keys}"),
        ({"first": roller, 3: 1}, "3: unknown key, need one of first, others"),
    ]:
        with pytest.raises(StudyError) as caught:
            validate(model, content, "file.yaml", StudyError)
        assert str(caught.value) == f"file.yaml: {line}"


def test_a_list_of_one_mistaken_entry_is_one_mistake():
    several = Annotated[tuple[Slug, ...], Field(min_length=2)]
    assert "(and" not in refusal(several, ["good", "Bad"])
    assert "(and 1 more)" in refusal(several, ["Bad", "Worse"])
    assert refusal(several, ["good"]).endswith("got ['good'], need 2 or more entries")


def test_a_missing_key_is_named_and_further_mistakes_are_counted():
    with pytest.raises(RecordError) as caught:
        validate(model_of(one=(Length, ...), two=(Length, ...)), {}, "file.yaml", RecordError)
    assert str(caught.value) == "file.yaml: one: missing, and it has no default (and 1 more)"
