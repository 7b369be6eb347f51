"""What electrical meters read, on a small study."""

import numpy as np
import pytest
import scipy
from made import made, on_few_surfaces
from studies import CONFIG

from lube.contact.window_films import window_films
from lube.contact.windows import study_windows
from lube.grid.levels import rolling
from lube.grid.operating_points import at_slip, levels_at, operating_points
from lube.physics.electrical import film_capacitance, mean_inverse_gap
from lube.rig.simulator import simulated_revolutions
from lube.stages.electrical import make
from lube.study.rig_settings import OWN_RIG
from lube.study.study import load_study


@pytest.fixture(scope="module")
def study():
    own = load_study(CONFIG / "smoke.yaml")
    roughness = own.roughness.model_copy(update={"points": 300_000})
    return own.model_copy(update={"roughness": roughness, "realisations": 2})


@pytest.fixture(scope="module")
def files(study):
    return made(study, ("lubricant", "film", "contact", "electrical"))


@pytest.fixture(scope="module")
def found(files):
    return files["electrical"]


def test_a_fast_rig_reads_the_share_that_is_true(found):
    seen = found.true_contact_share > 0.01
    read = found.read_contact_share.sel(rig="threshold-counter", reading="threshold")
    assert seen.any()
    np.testing.assert_allclose(read.where(seen), found.true_contact_share.where(seen), rtol=0.02)


def extra_delay(charging, filtering):
    """Time to half of the voltage through both time constants, less that through the filter."""

    def missing(time):
        both = charging * np.exp(-time / charging) - filtering * np.exp(-time / filtering)
        return both / (charging - filtering) - 0.5

    return scipy.optimize.brentq(missing, 0.0, 20.0 * filtering) - filtering * np.log(2.0)


def test_a_slow_circuit_reads_longer_contact_the_more_capacitance_it_charges(found, study):
    """After a contact 10 kohm charge the open gap: contact seems longer by some R C ln 2."""
    read = found.read_contact_share.sel(rig="mtm-ecr-10-kohm", reading="adaptive threshold")
    often = found.true_contact_share > 0.05
    longer = (read - found.true_contact_share).where(often)
    slip = rolling(study.slips)
    film = at_slip(made(study, ("lubricant", "film"))["film"], slip).isel(film_formula=0)
    # Of the gaps wider than the layer, by summing over a Gaussian gap.
    gaps = np.linspace(study.boundary_layer.critical_thickness, 4e-6, 400_000)
    rms, oil = np.hypot(*study.line_spec.rms_height), study.rig.oil_permittivity
    density = np.exp(-0.5 * ((gaps - film.film_thickness.values.ravel()[:, None]) / rms) ** 2)
    inverse = (density / gaps).sum(axis=1) / density.sum(axis=1)
    plates = film_capacitance(1.0, film.contact_half_width, study.rollers.length, oil)
    capacitance = film.film_thickness.copy(data=inverse.reshape(film.film_thickness.shape)) * plates
    capacitance = capacitance + found.surrounding_capacitance
    points = operating_points(film, slip)
    one = study.model_copy(update={"rig": study.rig.model_copy(update={"revolutions": 1})})
    for _, number, turn in simulated_revolutions(one, points):
        at = levels_at(points, number)
        names = ("lubricant", "temperature", "speed", "force")
        at = {name: at[name] for name in names}
        if not often.sel(at):
            continue
        open_again = np.count_nonzero((turn.contact[:-1] > 0) & (turn.contact[1:] == 0))
        delay = extra_delay(1e4 * capacitance.sel(at).item(), 0.5 / np.pi / study.rig.bandwidth)
        expected = open_again * delay / (turn.contact.size * turn.time_step)
        # Some contacts follow before the capacitance is charged.
        assert 0.3 * expected < longer.sel(at).item() < 1.25 * expected
    assert often.any()


def test_contact_and_discharges_together_take_no_more_than_all_the_time(found, files):
    contact = files["contact"].geometric_contact_probability_mean.isel(film_formula=0)
    contact = contact.sel(slide_to_roll_ratio=0.0).transpose(*found.film_thickness.dims)
    assert (found.discharge_probability + contact < 1.02).all()


def test_a_rough_contact_has_more_capacitance_than_plates_and_reads_a_thinner_film(found):
    assert (found.capacitance > found.plate_capacitance).all()
    ratio = found.plate_capacitance / found.capacitance
    np.testing.assert_allclose(found.capacitance_film, ratio * found.film_thickness, rtol=1e-5)


def test_flat_films_have_the_mean_of_one_over_a_gaussian_gap(found, study):
    rms = np.hypot(*study.line_spec.rms_height)
    layer = study.boundary_layer.critical_thickness
    expected = 1.0 / mean_inverse_gap(found.film_thickness.values, rms, layer)
    np.testing.assert_allclose(found.capacitance_film, expected, rtol=1e-4)


def test_the_resistance_of_a_closed_contact_has_the_range_of_the_resistivity(found, files, study):
    assert study.resistivity_range == (-0.2, 1.0)
    for name, factor in (("lower", 0.8), ("upper", 2.0)):
        expected = factor * found.closed_resistance
        np.testing.assert_allclose(found[f"closed_resistance_{name}"], expected, rtol=1e-5)
    inputs = {name: files[name] for name in ("film", "contact")}
    unknown = make(study.model_copy(update={"uncertainty": None}), inputs)
    np.testing.assert_array_equal(unknown.closed_resistance, found.closed_resistance)
    assert unknown.closed_resistance_lower.isnull().all()


def test_more_volts_discharge_through_thicker_films(found, study):
    volts = {name: study.rig.like(name).bias_voltage for name in found.rig.values[1:]}
    assert volts["impedance-bridge"] > volts["mtm-ecr"]
    more = found.discharge_probability.sel(rig="impedance-bridge")
    assert (more > found.discharge_probability.sel(rig="mtm-ecr")).all()
    assert (found.discharge_probability.min() >= 0.0).all()


def test_contact_that_is_rare_is_a_capacitor(found):
    own = found.impedance_phase.sel(rig="study")
    assert ((own <= 0.0) & (own >= -90.0)).all()
    # The rarer contact is, the more of a capacitor it is.
    order = np.argsort(found.true_contact_share.values.ravel())
    assert own.values.ravel()[order[0]] < -60.0 < -30.0 < own.values.ravel()[order[-1]]


def test_the_gap_of_a_computed_shape_is_its_film_and_that_of_an_answered_line_has_its_rms(study):
    levels = {"force": (800.0,), "speed": (100.0,), "temperature": (40.0,)}
    grid = study.operating_grid.model_copy(update=levels | {"slide_to_roll_ratio": (0.0,)})
    choices = {"film_shape": "computed", "roughness_deformation": "computed"}
    shaped = study.model_copy(update=choices | {"operating_grid": grid})
    film = at_slip(made(shaped, ("lubricant", "film"))["film"], 0.0).isel(film_formula=0)
    spec = shaped.line_spec
    windows = study_windows(shaped, film)
    for point, gap in enumerate(windows.gaps(spec)):
        thickness, rms = gap
        half = windows.half_windows[point]
        assert thickness.shape == rms.shape == (2 * half + 1,)
        whole = window_films(film, spec)[point]
        here = slice(whole.before - half, whole.before + half + 1)
        np.testing.assert_array_equal(thickness, whole.film[here] * spec.height_step)
        own = np.hypot(*spec.rms_height)
        # The oil takes most from the long waves in the middle of the contact.
        assert 0.2 < rms[half] / own < 1.05


def test_measured_voltages_are_those_of_the_simulated_rig(found, study):
    assert found.rig_source.sel(rig="study") == "the study"
    assert "PCS" in found.rig_source.sel(rig="mtm-ecr").item()
    assert OWN_RIG in found.rig.values


# A rig whose rollers have surfaces


@pytest.fixture(scope="module")
def of_surfaces(study):
    # On a coarser grid, with so weak a layer that it breaks there.
    changes = {
        "rig": study.rig.model_copy(update={"contact_model": "surface"}),
        "contact_model": ("line", "surface"),
        "roughness": study.roughness.model_copy(update={"points": 60_000}),
        "boundary_layer": study.boundary_layer.model_copy(update={"shear_strength": 1e4}),
    }
    kinds = ("lubricant", "film", "contact", "areal", "experiment", "surface_records")
    with on_few_surfaces():
        return made(study.model_copy(update=changes), (*kinds, "comparison", "electrical"))


def test_surfaces_touch_more_often_than_lines_and_are_read_as_they_touch(of_surfaces):
    surfaces, experiment = of_surfaces["electrical"], of_surfaces["experiment"]
    lines = of_surfaces["contact"].breakthrough_probability_mean
    lines = lines.isel(film_formula=0, slide_to_roll_ratio=0)
    assert (surfaces.true_contact_share >= lines).all()
    own, of_records = surfaces.true_contact_share.values, experiment.true_contact_share.values
    np.testing.assert_allclose(own.ravel(), of_records)
    seen = surfaces.true_contact_share > 0.01
    read = surfaces.read_contact_share.sel(rig="threshold-counter", reading="threshold")
    np.testing.assert_allclose(read, surfaces.true_contact_share, rtol=0.02, atol=1e-3)
    areal = of_surfaces["areal"].isel(film_formula=0, slide_to_roll_ratio=0)
    ratio = areal.breakdown_ratio.where(areal.breakdown_ratio > 1e-9)
    np.testing.assert_allclose(np.log(surfaces.breakdown_ratio / ratio).mean(), 0.0, atol=0.1)
    resistance = surfaces.closed_resistance.where(seen)
    assert resistance.min() > 1e-4 and resistance.max() < 1.0
    assert ((surfaces.discharge_probability >= 0.0) & (surfaces.discharge_probability <= 1.0)).all()


def test_the_surface_explains_the_records_of_surfaces_and_the_line_does_not(of_surfaces):
    comparison = of_surfaces["comparison"].isel(film_formula=0)
    within = comparison.within_prediction.mean("record")
    assert within.sel(contact_model="surface") >= 0.8 > within.sel(contact_model="line")
