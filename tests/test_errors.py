"""Errors are one line for any content of a file."""

from lube.errors import LONGEST_VALUE, LubeError, StudyError, right_one, shown


def test_what_does_not_print_is_replaced_by_its_escape():
    for message, line in [
        ("x.yaml: name: got 'Ω', need text", "x.yaml: name: got 'Ω', need text"),
        ("two\nlines\r\n", r"two\nlines\r\n"),
        ("\x1b[31mred\x07", r"\x1b[31mred\x07"),
        ("turned \u202e round \u2028", r"turned \u202e round \u2028"),
    ]:
        assert str(StudyError(message)) == line
        assert str(LubeError(str(StudyError(message)))) == line


def test_a_small_value_is_shown_as_python_writes_it_and_a_large_one_is_cut_off():
    for value in [3, 2.5, True, None, "mm", [1, 2], {"a": 1}, (0, "x")]:
        assert shown(value) == repr(value)
    for value in ["x" * 10**6, list(range(10**4)), {"a": "µ" * 999}]:
        assert len(shown(value)) == LONGEST_VALUE
        assert shown(value).endswith("...")


def test_a_name_of_the_same_words_in_another_order_is_the_one_that_was_meant():
    names = ["rms_roughness", "ra_roughness", "roughness"]
    assert right_one("roughness_ra", names) == "did you mean 'ra_roughness'?"
    assert right_one("Roughness-RMS", names) == "did you mean 'rms_roughness'?"
    assert right_one("roughnes", names) == "did you mean 'roughness'?"
