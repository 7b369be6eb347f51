"""A table of duty points: each as by itself, and the weighted whole."""

import numpy as np
import pandas as pd
import pint
import pytest

import lube
from lube import LubeError, Rollers
from lube.calculator import bands
from lube.calculator.bands import Assumptions
from lube.calculator.choices import Choices

RUNS = {"realisations": 8, "seed": 2}
POINTS = {
    "force [N]": [400.0, 1600.0, 100.0],
    "speed [rpm]": [100.0, 60.0, 100.0],
    "temperature [degC]": [60.0, 80.0, 80.0],
    "share": [3.0, 1.0, 0.0],
}


def test_each_point_is_as_by_itself_and_the_whole_is_weighted(rollers, oil):
    found = lube.duty(POINTS, rollers, oil, **RUNS)
    for number in range(3):
        units = {"force": "N", "speed": "rpm", "temperature": "degC"}
        point = {name: (POINTS[f"{name} [{unit}]"][number], unit) for name, unit in units.items()}
        alone = lube.contact_probability(rollers, oil, **point, **RUNS)
        here = found.isel(point=number)
        for name in (
            "film_thickness",
            "breakthrough_probability",
            "breakthrough_probability_upper",
        ):
            np.testing.assert_array_equal(here[name], alone[name])
    mean = found["breakthrough_probability_mean"].values
    np.testing.assert_allclose(found["whole_probability"], 0.75 * mean[0] + 0.25 * mean[1])
    np.testing.assert_allclose(found["share"], [0.75, 0.25, 0.0])
    assert found["whole_probability_lower"] < found["whole_probability"]
    assert found["whole_probability"] < found["whole_probability_upper"]


def test_the_whole_of_one_point_is_that_point(rollers, oil):
    one = {name: values[:1] for name, values in POINTS.items()}
    found = lube.duty(one, rollers, oil, **RUNS)
    for ending in ("_lower", "_upper"):
        expected = found[f"breakthrough_probability{ending}"].item()
        assert found[f"whole_probability{ending}"].item() == pytest.approx(expected, rel=1e-12)


def test_time_that_is_left_out_is_remarked(rollers, oil):
    point = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}
    remarks = lube.duty(point | {"share": "70 %"}, rollers, oil, realisations=1).attrs["remarks"]
    assert "share: got 0.7 together, and the rest of the time is left out" in remarks
    whole = lube.duty(point, rollers, oil, realisations=1, seed=3).attrs
    assert "share: " not in whole["remarks"] and whole["seed"] == 3


def test_a_point_of_no_time_does_not_count_even_if_its_film_is_not_known(rollers, oil):
    """The film of so slow a speed is not computed."""
    slow = POINTS | {"speed [rpm]": [100.0, 60.0, 1e-5]}
    found = lube.duty(slow, rollers, oil, film_formula="computed", **RUNS)
    assert np.isnan(found["film_thickness"]).values.tolist() == [False, False, True]
    assert "film: unknown at 1 of 3 operating points" in found.attrs["remarks"]
    for name in ("whole_probability", "whole_tail_probability_upper", "whole_tail_rate"):
        assert found[name] > 0.0


def test_a_dict_of_single_values_is_one_point(rollers, oil):
    one = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}
    found, same = (lube.duty(each, rollers, oil, **RUNS) for each in (one, [one]))
    assert found.identical(same)


def test_lists_and_arrays_of_quantities_keep_their_units(rollers, oil):
    of = pint.UnitRegistry().Quantity
    levels = {"force": ([0.4, 1.6], "kN"), "temperature": ([60, 80], "degC")}
    arrays = {name: of(*level) for name, level in levels.items()} | {"speed": of([100, 60], "rpm")}
    lists = {name: list(array) for name, array in arrays.items()}
    mixed = lists | {"force": [of(0.4, "kN"), "1600 N"]}
    for points in (arrays, lists, levels | {"speed": (100, "rpm")}, mixed):
        found = lube.duty(points, rollers, oil, **RUNS)
        assert found["force"].values.tolist() == [400.0, 1600.0]
        assert found["temperature"].values.tolist() == [60.0, 80.0]


TAIL = [f"{name}{end}" for name in ("probability", "rate") for end in ("", "_lower", "_upper")]


def test_contact_of_each_point_is_known_at_any_rarity(rollers, oil):
    cold = POINTS | {"temperature [degC]": [40.0, 80.0, 80.0], "speed [rpm]": [500.0, 60.0, 100.0]}
    found = lube.duty(cold, rollers, oil, **RUNS)
    assert found["breakthrough_probability_mean"][0] == 0.0
    alone = lube.contact_probability(rollers, oil, "400 N", "500 rpm", "40 degC", **RUNS)
    for name in TAIL:
        here = found[f"tail_breakthrough_{name}"]
        np.testing.assert_array_equal(here[0], alone[f"tail_breakthrough_{name}"])
    assert 0.0 < found["tail_breakthrough_probability"][0] < 1e-6
    assert "importance sampling" not in found.attrs["remarks"]


def test_the_whole_is_sampled_on_each_pair_of_lines(rollers, oil):
    found = lube.duty(POINTS, rollers, oil, **RUNS)
    share = found["share"]
    for name in ("probability", "rate"):
        each, whole = found[f"tail_breakthrough_{name}"], found[f"whole_tail_{name}"]
        assert whole.item() == pytest.approx((each * share).sum().item(), rel=1e-12)
        assert whole.attrs["units"] == each.attrs["units"]
        # Errors of points add up at most, as the lines are the same.
        widths = found[f"tail_breakthrough_{name}_upper"] - found[f"tail_breakthrough_{name}_lower"]
        width = found[f"whole_tail_{name}_upper"] - found[f"whole_tail_{name}_lower"]
        assert 0.0 < width <= (widths * share).sum() * (1.0 + 1e-9)
    twice = {name: [values[0]] * 2 for name, values in POINTS.items()}
    both = lube.duty(twice, rollers, oil, **RUNS)
    for name in TAIL:
        of_point = both[f"tail_breakthrough_{name}"][0].item()
        assert both[f"whole_tail_{name}"].item() == pytest.approx(of_point, rel=1e-12)


def test_rates_are_those_of_the_points_own_slip(rollers, oil):
    table = {
        "force [N]": [400.0],
        "temperature [degC]": [60.0],
        "surface_speed [m/s]": [0.6],
        "second_surface_speed [m/s]": [0.4],
    }
    found = lube.duty(table, rollers, oil, **RUNS)
    point = {"force": "400 N", "speed": "0.5 m/s", "temperature": "60 degC"}
    slipping = lube.contact_probability(rollers, oil, **point, slide_to_roll_ratio=0.4, **RUNS)
    rate = slipping["tail_breakthrough_rate"].item()
    assert found["tail_breakthrough_rate"].item() == pytest.approx(rate, rel=1e-9)
    rolling = lube.contact_probability(rollers, oil, **point, **RUNS)
    assert rate > rolling["tail_breakthrough_rate"].item()


def test_the_surface_is_weighted_as_the_line_is(rollers, oil):
    one = {name: values[:2] for name, values in POINTS.items()}
    found = lube.duty(one, rollers, oil, contact_model="surface", film_shape="computed", seed=2)
    for end in ("", "_lower", "_upper"):
        of_points = found[f"surface_breakthrough_probability{end}"].values
        whole = found[f"whole_surface_probability{end}"].item()
        assert whole == pytest.approx(0.75 * of_points[0] + 0.25 * of_points[1])
    rates = found["surface_breakthrough_rate"].values
    assert found["whole_surface_rate"] == pytest.approx(0.75 * rates[0] + 0.25 * rates[1])
    assert found["whole_surface_rate"].attrs["units"] == "h-1"
    for end in ("lower", "upper"):
        of_points = found[f"surface_breakthrough_probability_pair_{end}"].values
        whole = found[f"whole_surface_probability_pair_{end}"].item()
        assert whole == pytest.approx(0.75 * of_points[0] + 0.25 * of_points[1])
    assert (found["surface_load_share"] > 0.0).all()
    assert found["whole_surface_probability"] > 0.1 and "whole_probability" not in found


@pytest.mark.usefixtures("few_pairs")
def test_what_the_oil_does_to_the_lines_depends_on_the_slip_of_each_point(rollers, oil):
    speeds = {"surface_speed [m/s]": [0.5, 0.7], "second_surface_speed [m/s]": [0.5, 0.3]}
    points = speeds | {"force [N]": [400.0, 400.0], "temperature [degC]": [60.0, 60.0]}
    choices = {"film_shape": "computed", "roughness_deformation": "computed", "realisations": 1}
    found = lube.duty(points, rollers, oil, **choices)["tail_breakthrough_probability"].values
    point = {"speed": "0.5 m/s", "force": "400 N", "temperature": "60 degC"}
    alone = lube.contact_probability(rollers, oil, **point, **choices, slide_to_roll_ratio=0.8)
    # Interpolated between other wavelengths.
    expected = alone["tail_breakthrough_probability"].item()
    assert found[1] == pytest.approx(expected, rel=2e-3)
    assert abs(np.log(found[0] / found[1])) > 0.02


def test_heights_that_are_not_gaussian_are_counted_only(oil):
    worn = Rollers(
        "50 mm", "0.2 um", points=50_000, shortest_wavelength="60 um", skewness=-1.0, kurtosis=5.0
    )
    found = lube.duty(POINTS, worn, oil, realisations=1)
    assert np.isnan(found["tail_breakthrough_probability"]).all()
    assert np.isnan(found["whole_tail_rate"]) and not np.isnan(found["whole_probability"])
    assert found.attrs["remarks"].startswith("contact is counted in realisations, not")


def test_what_is_unlikely_to_be_meant_at_a_point_is_remarked(oil):
    rough = Rollers("50 mm", "3 um", points=50_000, shortest_wavelength="60 um")
    remarks = lube.duty(POINTS, rough, oil, realisations=1).attrs["remarks"]
    assert "load share: at 3 of 3 operating points" in remarks
    assert "at 3 more than all of it" in remarks


def test_columns_of_labels_are_kept(rollers, oil, tmp_path):
    names = ["run-up", "2nd gear", "stage 3"]
    pd.DataFrame({"phase": names} | POINTS).to_csv(tmp_path / "duty.csv", index=False)
    for table in ({"phase": names} | POINTS, tmp_path / "duty.csv"):
        found = lube.duty(table, rollers, oil, realisations=1)
        assert found["phase"].values.tolist() == names
        assert found.table()["phase"].tolist() == names
        assert found["whole_probability"] > 0.0


def test_tables_of_every_kind_are_the_same(rollers, oil, tmp_path):
    frame = pd.DataFrame(POINTS)
    frame.to_csv(tmp_path / "duty.csv", index=False)
    rows = [
        {"force": f"{f} N", "speed": f"{n} rpm", "temperature": f"{t} degC", "share": f"{s} %"}
        for f, n, t, s in frame.values
    ]
    expected = lube.duty(POINTS, rollers, oil, **RUNS)
    for table in (frame, tmp_path / "duty.csv", rows):
        found = lube.duty(table, rollers, oil, **RUNS)
        np.testing.assert_allclose(found["whole_probability"], expected["whole_probability"])


def test_points_have_their_own_radii_and_surface_speeds(rollers, oil):
    """The film is that of rollers of these radii."""
    table = {
        "force [N]": [400.0, 400.0],
        "temperature [degC]": [60.0, 60.0],
        "radius [mm]": [50.0, 20.0],
        "second_radius [mm]": [50.0, 40.0],
        "surface_speed [m/s]": [0.6, 0.6],
        "second_surface_speed [m/s]": [0.6, 0.2],
    }
    found = lube.duty(table, rollers, oil, **RUNS)
    for number, (radius, second, speed) in enumerate([(50, 50, 0.6), (20, 40, 0.4)]):
        own = Rollers(f"{radius} mm", "0.2 um", second={"radius": f"{second} mm"})
        expected = lube.film(own, oil, "400 N", f"{speed} m/s", "60 degC")
        for name in ("film_thickness", "contact_half_width", "hertz_pressure"):
            np.testing.assert_allclose(found[name][number], expected[name], rtol=1e-12)
    np.testing.assert_allclose(found["radius"], table["radius [mm]"])
    assert all("units" in variable.attrs for variable in found.variables.values())
    assert found["radius"].attrs["units"] == "mm"


def test_the_oil_begins_at_one_distance_before_points_of_any_radius(rollers, oil):
    table = {"force [N]": [400.0, 400.0], "temperature [degC]": [60.0, 60.0]}
    table |= {"entrainment_speed [m/s]": [0.5, 0.5], "radius [mm]": [50.0, 20.0]}
    starved = {"film_formula": "computed", "inlet_meniscus": "0.3 mm"}
    found = lube.duty(table, rollers, oil, **starved, **RUNS)
    for number, radius in enumerate(table["radius [mm]"]):
        own = Rollers(f"{radius} mm", "0.2 um", second={"radius": "50 mm"})
        expected = lube.film(own, oil, "400 N", "0.5 m/s", "60 degC", **starved)
        for name in ("film_thickness", "starvation_factor"):
            np.testing.assert_allclose(found[name][number], expected[name], rtol=2e-6)
    assert (found["starvation_factor"] < 0.99).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"forse [N]": [1.0] * 3}, "points: unknown column 'forse [N]', did you mean 'force'?"),
        ({"shares": ["90 %", "5 %", "5 %"]}, "unknown column 'shares', did you mean 'share'?"),
        ({"Radii": ["50 mm", "5 mm", "5 mm"]}, "points: unknown column 'Radii', need one of"),
        ({"weight": ["90 %", "5 %", "5 %"]}, "points: unknown column 'weight', need one of"),
        ({"radius": ["a", "b", "c"]}, "points: radius: got 'a', need a number with its unit"),
        ({"note": ["a", "b", np.nan]}, "points: note: missing in row 3, need it in every row"),
        ({"radius": [None, "50 mm", "50 mm"]}, "points: radius: missing in row 1, need it in"),
        ({"share": [1.0, -1.0, 1.0]}, "points: share: got -1, need a value at least 0"),
        (
            {"share": ["1 %", "1 %", 0.7]},
            "share: got 0.7, need a number with its unit, such as '50 %'",
        ),
        ({"share": [0.0] * 3}, "points: share: got 0 at all points, need a share above 0"),
        (
            {"speed [rpm]": None},
            "points: got no speed, need one kind of speed: speed, entrainment_",
        ),
        ({"surface_speed [m/s]": [1.0] * 3}, "points: got speed and surface_speed, need one"),
        ({"force [N]": None}, "points: no column 'force', need one, as 'force [N]'"),
        ({"force [N]": [1.0, np.nan, 1.0]}, "points: force [N]: missing in row 2, need it in"),
        ({"force [m]": [1.0] * 3, "force [N]": None}, "points: force: wrong dimension or unit 'm'"),
        ({"force [kN]": [1.0] * 3}, "points: got the column 'force' twice, need it once"),
        ({name: [] for name in POINTS}, "points: got no rows, need one for each duty point"),
        (
            {"lubricant": ["a", "b", "c"]},
            "points: got the column 'lubricant', which the answer has",
        ),
        ({"temperature [degC]": [60.0, 60.0, 20.0]}, "got 20 degC, need 40 to 100 degC"),
    ],
)
def test_a_mistake_is_one_line(rollers, oil, change, message):
    table = {name: values for name, values in (POINTS | change).items() if values is not None}
    with pytest.raises(LubeError) as error:
        lube.duty(table, rollers, oil)
    assert message in str(error.value)


def test_a_file_that_is_not_there_is_one_line(rollers, oil):
    with pytest.raises(LubeError, match=r"nowhere\.csv: cannot be read: No such file"):
        lube.duty("nowhere.csv", rollers, oil)


ENDS = ("lower", "upper")
KELVIN = {"temperature": {"range": "+- 2 K", "source": "thermocouple"}}


def assumed(found, name="assumed_breakthrough_probability"):
    return np.stack([found[f"{name}_{end}"].values for end in ENDS])


def test_one_pair_of_the_whole_is_that_of_a_single_point(rollers, oil):
    one = {name: values[:1] for name, values in POINTS.items()}
    found = lube.duty(one, rollers, oil, **RUNS)
    for end in ENDS:
        of_point = found[f"breakthrough_probability_pair_{end}"].item()
        assert found[f"whole_probability_pair_{end}"].item() == pytest.approx(of_point, rel=1e-12)
    cycle = lube.duty(POINTS, rollers, oil, **RUNS)
    assert cycle["whole_probability_pair_lower"] < cycle["whole_probability_lower"]
    assert cycle["whole_probability_pair_upper"] > cycle["whole_probability_upper"]
    label = cycle["whole_probability_pair_upper"].attrs["long_name"]
    assert label == "breakthrough probability of the whole duty cycle, of one pair"


@pytest.mark.usefixtures("few_samples")
def test_assumptions_at_each_point_are_as_by_itself(rollers, oil):
    one = {name: values[:1] for name, values in POINTS.items()}
    found = lube.duty(one, rollers, oil, **RUNS, bands=True)
    point = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}
    alone = lube.contact_probability(rollers, oil, **point, **RUNS, bands=True)
    np.testing.assert_array_equal(assumed(found)[:, 0], assumed(alone))
    whole = assumed(found, "whole_assumed_probability")
    np.testing.assert_allclose(whole, assumed(alone), rtol=1e-12)
    assert "whole_assumed_probability_lower" not in found.table()
    without = lube.duty(one, rollers, oil, **RUNS)
    assert without.equals(found.drop_vars([name for name in found if "assumed" in name]))


@pytest.mark.usefixtures("few_samples")
def test_all_points_of_a_cycle_share_the_assumptions(rollers, oil):
    """Compared with the cycle of each sample, written out."""
    table = POINTS | {"speed [rpm]": [100.0, 20.0, 100.0], "share": [1.0, 1.0, 1.0]}
    table = table | {"temperature [degC]": [50.0, 90.0, 60.0]}
    found = lube.duty(table, rollers, oil, **RUNS, bands=KELVIN)
    assumptions = Assumptions(KELVIN, rollers, oil, Choices(), RUNS["seed"])
    cycle = np.zeros(32)
    for force, speed, level in zip(*list(table.values())[:3], strict=True):
        point = {"force": force, "speed": speed, "temperature": level}
        cycle += assumptions.probabilities(point).values / 3.0
    expected = np.quantile(cycle, [0.05, 0.95])
    whole = assumed(found, "whole_assumed_probability")
    # The oil is interpolated between other temperatures.
    np.testing.assert_allclose(whole, expected, rtol=1e-5)


@pytest.mark.usefixtures("few_samples")
def test_assumptions_hold_for_the_radii_of_each_point(rollers, oil):
    """The same contact of other radii; and other rollers with the same lines."""
    given = {"force [N]": [400.0, 400.0], "temperature [degC]": [60.0, 60.0]}
    given |= {"entrainment_speed [m/s]": [0.5, 0.5], "second_radius [mm]": [50.0, 200.0 / 3.0]}
    found = lube.duty(given | {"radius [mm]": [50.0, 40.0]}, rollers, oil, **RUNS, bands=True)
    limits = assumed(found)
    np.testing.assert_allclose(limits[:, 0], limits[:, 1], rtol=1e-6)
    small = lube.duty(given | {"radius [mm]": [50.0, 20.0]}, rollers, oil, **RUNS, bands=True)
    assert (np.abs(np.log(assumed(small)[:, 1] / limits[:, 0])) > 0.1).all()


@pytest.mark.usefixtures("few_samples")
def test_assumptions_hold_for_the_slip_of_each_point(rollers, oil, monkeypatch):
    monkeypatch.setitem(bands.SAMPLES, "line", 2)
    speeds = {"surface_speed [m/s]": [0.5, 0.9], "second_surface_speed [m/s]": [0.5, 0.1]}
    points = speeds | {"force [N]": [400.0, 400.0], "temperature [degC]": [60.0, 60.0]}
    choices = {"film_shape": "computed", "roughness_deformation": "computed", "realisations": 1}
    found = assumed(lube.duty(points, rollers, oil, **choices, bands=True))
    point = {"force": "400 N", "speed": "0.5 m/s", "temperature": "60 degC"}
    slipping = choices | {"slide_to_roll_ratio": 1.6, "bands": True}
    alone = assumed(lube.contact_probability(rollers, oil, **point, **slipping))
    np.testing.assert_allclose(found[:, 1], alone, rtol=2e-3)
    assert np.abs(np.log(found[:, 0] / alone)).max() > 0.01


@pytest.mark.usefixtures("few_pairs")
def test_what_the_oil_does_to_the_lines_depends_on_the_radii_of_each_point(rollers, oil):
    """The same contact of other radii."""
    given = {"force [N]": [400.0] * 3, "temperature [degC]": [60.0] * 3}
    given |= {"entrainment_speed [m/s]": [0.5] * 3}
    radii = {"radius [mm]": [50.0, 40.0, 20.0], "second_radius [mm]": [50.0, 200.0 / 3.0, 50.0]}
    choices = {"film_shape": "computed", "roughness_deformation": "computed", "realisations": 1}
    found = lube.duty(given | radii, rollers, oil, **choices)["tail_breakthrough_probability"]
    first, same, other = found.values
    assert first == pytest.approx(same, rel=1e-6)
    assert first != pytest.approx(other, rel=0.1)


def test_the_whole_is_unknown_where_the_film_is_at_any_point(rollers):
    points = {"40 degC": "3 mPa*s", "100 degC": "0.6 mPa*s"}
    thin = lube.Oil(viscosity=points, pressure_viscosity="18 1/GPa")
    table = {"force [N]": [3000.0, 400.0], "temperature [degC]": [40.0, 40.0]}
    table["entrainment_speed [m/s]"] = [0.001, 0.3]
    found = lube.duty(table, rollers, thin, film_formula="computed", **RUNS)
    known = found["breakthrough_probability_mean"].notnull().values
    assert known.tolist() == [False, True]
    assert np.isnan(found["whole_probability"]) and np.isnan(found["whole_tail_probability"])


def test_numbers_of_files_may_have_decimal_commas(rollers, oil, tmp_path):
    rows = "force [N],speed [rpm],temperature,radius [mm],gear", "400,100,60.5 degC,12.5,2nd"
    path = tmp_path / "duty.csv"
    path.write_text("\n".join(rows))
    expected = lube.duty(path, rollers, oil, **RUNS)
    assert expected["gear"].item() == "2nd"
    for delimiter, decimal in ((";", ","), ("\t", ","), (";", ".")):
        written = [row.replace(",", delimiter).replace(".", decimal) for row in rows]
        path.write_text("\n".join(written))
        assert lube.duty(path, rollers, oil, **RUNS).identical(expected)
    path.write_text("# a comment\n\n" + "\n".join(rows).replace("60.5 degC", '"60,5 degC"'))
    with pytest.raises(LubeError, match=r"line 4: got '12\.5' in a file with decimal commas"):
        lube.duty(path, rollers, oil, **RUNS)
    path.write_text(path.read_text().replace("12.5", '"12,5"'))
    assert lube.duty(path, rollers, oil, **RUNS).identical(expected)
    path.write_text("\n".join(rows).removesuffix(",2nd"))
    with pytest.raises(LubeError, match=r"line 2: got 4 values, need one for each of 5 columns"):
        lube.duty(path, rollers, oil, **RUNS)


def test_a_column_of_numbers_is_never_taken_for_labels(rollers, oil):
    for values, hint in ((["12,5"] * 3, ", with decimal points"), (["-"] * 3, "")):
        with pytest.raises(LubeError) as caught:
            lube.duty(POINTS | {"radius [mm]": values}, rollers, oil, **RUNS)
        message = f"points: radius: got {values}, need numbers and their unit{hint}"
        assert str(caught.value) == message
