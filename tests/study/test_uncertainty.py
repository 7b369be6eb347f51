import pytest
import yaml
from repository import ROOT

from lube.errors import LubeError
from lube.study.study import load_study
from lube.study.uncertainty import check_uncertainty

PAPER = ROOT / "workflow/config/paper.yaml"
SOURCE = {"source": "assumed"}
NORMAL = {"distribution": "normal"} | SOURCE


def with_section(tmp_path, **section):
    content = {"based_on": str(PAPER), "name": "mine"} | section
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(content), encoding="utf-8")
    return path


def test_the_papers_study_has_a_range_with_a_source_for_everything_it_leaves_open():
    factors = load_study(PAPER).uncertainty.factors()
    assert {factor.group for factor in factors} == {
        "oil",
        "conditions",
        "surface",
        "layer",
        "film",
        "contact model",
    }
    assert len(factors) >= 12
    assert all(factor.given.source for factor in factors)
    check_uncertainty(load_study(PAPER))


@pytest.mark.parametrize(
    ("written", "expected", "in_words"),
    [
        ("+- 10 %", (-0.1, 0.1), "-10 % to 10 %"),
        ("-20% to 40%", (-0.2, 0.4), "-20 % to 40 %"),
        ("1e1 % to 1/2 %", None, None),
        ("5 % to 12.5 %", (0.05, 0.125), "5 % to 12.5 %"),
    ],
)
def test_ranges_are_read_in_percent(tmp_path, written, expected, in_words):
    path = with_section(tmp_path, uncertainty={"force": {"range": written} | SOURCE})
    if expected is None:
        with pytest.raises(LubeError, match="need the lower end first"):
            load_study(path)
        return
    given = load_study(path).uncertainty.force
    assert given.range == pytest.approx(expected)
    assert given.in_words == in_words


def test_ranges_are_read_in_their_units(tmp_path):
    section = {"temperature": {"range": "-1 K to 2 K"}, "hurst_exponent": {"range": "0.5 to 0.9"}}
    path = with_section(tmp_path, uncertainty={key: one | SOURCE for key, one in section.items()})
    uncertain = load_study(path).uncertainty
    assert uncertain.temperature.range == (-1.0, 2.0)
    assert uncertain.temperature.in_words == "-1 K to 2 K"
    assert uncertain.hurst_exponent.range == (0.5, 0.9)


@pytest.mark.parametrize(
    ("key", "given", "said"),
    [
        ("force", {"range": "2 % to -2 %"} | SOURCE, "got '2 % to -2 %', need the lower end first"),
        ("force", {"range": "+- 2"} | SOURCE, "such as '1 %'"),
        ("force", {"range": "+- -5 %"} | SOURCE, "got '+- -5 %', need a range such as +- 10 %"),
        ("force", {"range": "2 %"} | SOURCE, "got '2 %', need a range such as"),
        ("force", {"range": "-120 % to 0 %"} | SOURCE, "above -100 and at most 1000 %"),
        ("hurst_exponent", {"range": "0.5 to 1.5"} | SOURCE, "need a value above 0 and below 1"),
        (
            "kurtosis",
            {"range": "2 to 3"} | SOURCE,
            "need a value at least 3",
        ),
        ("hurst_exponent", {"range": "+- 0.1"} | SOURCE, "need a range such as 0.6 to 0.8"),
        ("temperature", {"range": "+- 2 %"} | SOURCE, "temperature.range: wrong dimension or unit"),
        ("skew", {"range": "+- 2 %"} | SOURCE, "uncertainty.skew: unknown key"),
        (
            "critical_thickness",
            {"range": "-80 % to 0 %"} | NORMAL,
            "critical_thickness.distribution: normal: got -100, need a value above -100 %",
        ),
        (
            "hurst_exponent",
            {"range": "0.5 to 0.95"} | NORMAL,
            "distribution: normal: got 1.0625, need a value above 0 and below 1",
        ),
        ("bias_voltage", {"range": "+- 2 %"} | SOURCE, "uncertainty.bias_voltage: unknown key"),
        ("film_shape", {"choices": ["flat"]} | SOURCE, "need 2 or more entries"),
        ("film_shape", {"choices": ["flat", "round"]} | SOURCE, "got 'round'"),
        ("film_shape", {"choices": ["flat", "flat"]} | SOURCE, "got flat repeatedly"),
        ("film_formula", {"choices": ["paper", "papper"]} | SOURCE, "did you mean 'paper'"),
    ],
)
def test_a_range_that_cannot_be_read_is_refused_in_one_line(tmp_path, key, given, said):
    with pytest.raises(LubeError) as refused:
        load_study(with_section(tmp_path, uncertainty={key: given}))
    assert said in str(refused.value) and "\n" not in str(refused.value)


def test_a_range_needs_a_source(tmp_path):
    content = yaml.safe_load(PAPER.read_text("utf-8"))
    del content["uncertainty"]["force"]["source"]
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(content), encoding="utf-8")
    with pytest.raises(LubeError, match=r"uncertainty\.force\.source: missing"):
        load_study(path)


@pytest.mark.parametrize(
    ("section", "said"),
    [
        ({"uncertainty": {"temperature": {"range": "+- 9 K"} | SOURCE}}, "got 31 degC, need 35"),
        ({"uncertainty": {"temperature": {"range": "+- 4 K"} | NORMAL}}, "got 34 degC, need 35"),
        (
            {"uncertainty": {"shortest_wavelength": {"range": "-90 % to 0 %"} | SOURCE}},
            "shortest_wavelength.range: got down to 0.314 µm, need two points",
        ),
        (
            {"uncertainty": {"longest_wavelength": {"range": "-99.5 % to 0 %"} | SOURCE}},
            "shortest_wavelength.range: got up to 6.28 µm, need less than the longest",
        ),
        (
            {"uncertainty": {"shortest_wavelength": {"range": "-60 % to 0 %"} | SOURCE}},
            "contact_model: surface: roughness: got a shortest wavelength",
        ),
        (
            {
                "lubricants": ["n-dodecane"],
                "uncertainty": {
                    "pressure_viscosity_definition": {
                        "choices": ["slope-at-atmospheric", "secant"],
                    }
                    | SOURCE
                },
            },
            "but n-dodecane states the definition of its coefficient",
        ),
        (
            {
                "uncertainty": {
                    "force": {"range": "-99.9999 % to 0 %"} | SOURCE,
                    "young_modulus": None,
                }
            },
            "force.range: the contact at 0.0001 N is 0.105 µm wide, need at least two grid",
        ),
        (
            {
                "inlet_meniscus": "0.22 mm",
                "uncertainty": {"force": {"range": "+- 50 %"} | SOURCE, "young_modulus": None},
            },
            "the half-width of the contact at 2400 N (force.range)",
        ),
        (
            {
                "inlet_meniscus": "0.22 mm",
                "uncertainty": {"force": None, "young_modulus": {"range": "-50 % to 0 %"} | SOURCE},
            },
            "the half-width of the contact at 3200 N (young_modulus.range)",
        ),
        (
            {
                "rollers": {"length": "1.215 mm"},
                "contact_model": ["surface"],
            },
            "force.range, young_modulus.range, longest_wavelength.range, "
            "shortest_wavelength.range: contact_model: surface: rollers.length: got 0.001215 m",
        ),
        ({"load_sharing": "iterated"}, "load_sharing: got iterated, need none: probabilities of"),
        (
            {
                "resistivity": "insulator",
                "uncertainty": {"resistivity": {"range": "+- 50 %"} | SOURCE},
            },
            "resistivity: got a range for an insulator, need none",
        ),
    ],
)
def test_ranges_for_which_the_model_has_no_answer_are_refused(tmp_path, section, said):
    study = load_study(with_section(tmp_path, **section))  # which other stages can use
    with pytest.raises(LubeError) as refused:
        check_uncertainty(study)
    assert said in str(refused.value) and "\n" not in str(refused.value)
