"""Oils made of numbers are those of a lubricant record."""

import pickle

import numpy as np
import pint
import pytest
from studies import OIL

from lube import LubeError, Oil
from lube.stages import load_record

TWO = {"40 degC": "335 mm^2/s", "100 degC": "38.3 mm^2/s"}


def test_an_oil_of_numbers_is_that_of_a_record():
    record, given = Oil(OIL), Oil(viscosity=TWO, density="860 kg/m^3", base="polyalphaolefin")
    temperatures = ["40 degC", "57 degC", "100 degC"]
    one, other = record.properties(temperatures), given.properties(temperatures)
    for name in ("dynamic_viscosity", "density", "pressure_viscosity_coefficient"):
        np.testing.assert_array_equal(one[name], other[name])
    assert record.record == load_record(OIL)


@pytest.mark.parametrize("name", ["PAO", "pao", "Polyalphaolefin"])
def test_a_base_oil_may_be_abbreviated_in_any_case(name):
    assert Oil(viscosity=TWO, base=name).record.pressure_viscosity.gold_base == "polyalphaolefin"


def test_a_temperature_range_extends_the_law_of_the_viscosity():
    law = Oil(viscosity=TWO, temperature_range=["20 degC", "120 degC"])
    assert repr(law).endswith("valid from 20 to 120 degC>")
    wide = law.properties(["60 degC", "110 degC"])["dynamic_viscosity"]
    assert wide[0] == Oil(viscosity=TWO).properties("60 degC")["dynamic_viscosity"]
    assert 0.0 < wide[1] < wide[0]
    shipped = Oil(OIL, temperature_range=([20.0, 120.0], "degC"))
    assert shipped.properties("110 degC")["dynamic_viscosity"] > 0.0


def test_an_oil_of_a_table_of_dynamic_viscosities(tmp_path):
    path = tmp_path / "oil.csv"
    path.write_text("temperature [degC], dynamic_viscosity [mPa*s]\n40, 100\n80, 20\n")
    of_table = Oil(viscosity=path, pressure_viscosity="18 1/GPa").properties("40 degC")
    of_numbers = Oil(viscosity={"40 degC": "100 mPa*s", "80 degC": "20 cP"}).properties("40 degC")
    assert of_table["dynamic_viscosity"].item() == pytest.approx(100.0, rel=1e-12)
    assert of_table["pressure_viscosity_coefficient"].item() == pytest.approx(18.0)
    assert of_numbers["dynamic_viscosity"].item() == pytest.approx(100.0, rel=1e-12)


def test_quantities_are_texts_pairs_or_of_pint():
    unit = pint.UnitRegistry()
    texts = Oil(viscosity=TWO, density="890 kg/m^3", pressure_viscosity="18 1/GPa")
    viscosity = {"40 degC": (335.0, "mm^2/s"), "100 degC": 38.3 * unit.mm**2 / unit.s}
    others = Oil(viscosity=viscosity, density=(890, "kg/m^3"), pressure_viscosity=18 / unit.GPa)
    for name in ("dynamic_viscosity", "density", "pressure_viscosity_coefficient"):
        one, other = (each.properties("60 degC")[name].item() for each in (texts, others))
        assert other == pytest.approx(one, rel=1e-12)


def test_it_shows_itself_and_travels_between_processes():
    oil = Oil(OIL)
    assert repr(oil) == "<Oil: Mobilgear SHC XMP 320, valid from 40 to 100 degC>"
    assert pickle.loads(pickle.dumps(oil)).record == oil.record


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Oil(viscosity="missing.csv"), "missing.csv: cannot be read: No such file"),
        (lambda: Oil("mobilgear-shc-xmp-32"), "Oil: name: got 'mobilgear-shc-xmp-32', need one of"),
        (
            lambda: Oil(),
            "Oil: got neither, need either the name of a lubricant record or",
        ),
        (lambda: Oil(OIL, viscosity=TWO), "Oil: got both"),
        (lambda: Oil(OIL, base="ester"), "Oil: base: got 'ester' together with a"),
        (
            lambda: Oil(viscosity={"40 degC": "30 mm^2/s", "100 degC": "300 mm^2/s"}),
            "Oil: viscosity: got 300 mm2/s at 100 degC",
        ),
        (lambda: Oil(viscosity={"40 degC": "30 mm^2/s"}), "got fewer than two temperatures"),
        (
            lambda: Oil(viscosity={"40 degC": "30", "80 degC": "9 mm^2/s"}),
            "got '30', need a number",
        ),
        (lambda: Oil(viscosity="30 mm^2/s"), "got '30 mm^2/s', need viscosities by temperature"),
        (lambda: Oil(viscosity=30.0), "viscosity: got 30.0, need viscosities by temperature"),
        (
            lambda: Oil(viscosity=TWO, base="PAO", pressure_viscosity="18 1/GPa"),
            "Oil: base: got 'PAO' together with pressure_viscosity, which it would give, need",
        ),
        (
            lambda: Oil(viscosity=TWO, thermal_conductivity="140 W/m/K"),
            "Oil: thermal_conductivity.value: got 140 W/m/K, need a value above 0 and at most 1 W",
        ),
        (lambda: Oil(viscosity=TWO, base="olive"), "Oil: base: got 'olive', need one of mineral"),
        (lambda: Oil(viscosity=TWO, base=["PAO"]), "Oil: base: got ['PAO'], need one of mineral"),
        (lambda: Oil(OIL, temp_range=1), "Oil: temp_range: unknown argument, did you mean"),
        (
            lambda: Oil(OIL, temperature_range=["120 degC", "20 degC"]),
            "Oil: temperature_range: got 120 to 20 degC, need the lowest first",
        ),
        (
            lambda: Oil(OIL, temperature_range="120 degC"),
            "Oil: temperature_range: got '120 degC', need the lowest and the highest",
        ),
        (
            lambda: Oil(OIL, temperature_range=120),
            "temperature_range: got 120, need a number with its unit",
        ),
        (
            lambda: Oil(OIL).properties("110 degC"),
            f"{OIL}: got 110 degC, need 40 to 100 degC, or a wider temperature_range of the oil",
        ),
        (lambda: Oil(OIL).properties("20 degC"), f"{OIL}: got 20 degC, need 40 to 100 degC"),
    ],
)
def test_a_mistake_is_one_line(make, message):
    with pytest.raises(LubeError) as error:
        make()
    assert message in str(error.value)
