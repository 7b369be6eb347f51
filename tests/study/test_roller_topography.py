"""A roller with a measured surface: its spectrum, its lines, and what is refused."""

import json
import os
import shutil
from functools import partial

import numpy as np
import pytest
import xarray as xr
import yaml
from example_surface import rolled_off_surface
from refusals import one_line
from studies import CONFIG, PAPER

from lube.errors import LubeError
from lube.study.study import load_study
from lube.study.uncertainty import check_uncertainty
from lube.surfaces.rare_contact import check_stands_for_surface
from lube.surfaces.spectra import spectrum_moments
from lube.surfaces.synthetic import draw_realisation

refusal = partial(one_line, LubeError, load_study)
RADIUS = 5e-3
TURN = 2 * np.pi * RADIUS
BAND = {"longest_wavelength": "200 um", "shortest_wavelength": "6.25 um"}
SPACING = 1.5e-6


def profile(length, seed=1, roll_off=80e-6):
    """A rough profile that closes."""
    points = round(length / SPACING)
    waves = np.maximum(np.arange(points // 2 + 1) * roll_off / length, 1.0) ** -1.3
    waves[0] = 0.0
    noise = np.random.default_rng(seed).standard_normal((waves.size, 2)) @ [1.0, 1.0j]
    heights = np.fft.irfft(waves * noise, points)
    return 0.2e-6 * heights / np.std(heights)


def write_csv(path, heights):
    position = 1e3 * SPACING * np.arange(heights.size)
    rows = np.column_stack([position, 1e6 * heights])
    header = "position [mm],height [um]"
    np.savetxt(path, rows, "%.9g", ",", header=header, comments="")


@pytest.fixture
def study_file(tmp_path):
    """Write a study of small rollers with topographies, and return its file."""
    shutil.copy(CONFIG / "surfaces/example.x3p", tmp_path)
    # Of an odd number of bytes: one reader takes any file of 2, 8, 18, ... bytes for a map.
    (tmp_path / "notes.txt").write_text("measured on a Monday.", encoding="utf-8")
    write_csv(tmp_path / "turn.csv", profile(TURN))
    write_csv(tmp_path / "scan.csv", profile(6e-3)[:2600] + np.linspace(0, 5e-6, 2600))

    def write(first, second=None, roughness=BAND, **content):
        rollers = {"length": "2 mm"}
        for name, topography in (("first", first), ("second", second or first)):
            rollers[name] = {"radius": f"{RADIUS} m", "roughness": roughness}
            rollers[name] |= {"topography": topography} if "file" in topography else topography
        study = {
            "based_on": os.path.relpath(PAPER, tmp_path),
            "name": "mine",
            "rollers": rollers,
            "roughness": {"points": 20_000, "shortest_wavelength": "6.25 um"},
            "operating_grid": {"force": {"values": [40, 80], "units": "N"}},
            "traces": [{"force": "80 N", "speed": "100 rpm", "temperature": "40 degC"}],
        }
        path = tmp_path / "study.yaml"
        path.write_text(yaml.safe_dump(study | content), encoding="utf-8")
        return path

    return write


MAP = {"file": "example.x3p", "texture": "isotropic", "holes": "interpolate"}
SCAN = {"file": "scan.csv", "texture": "along rolling"}


def test_a_line_drawn_from_a_map_has_the_rms_height_and_slope_that_the_map_was_made_with(
    study_file,
):
    study = load_study(study_file(MAP))
    spec = study.line_spec
    lines = draw_realisation(spec, 1, 0)
    for roller, line in enumerate(lines):
        assert np.std(line) * spec.height_step == pytest.approx(spec.rms_height[roller], rel=1e-6)
    # The surface it was made from, again with its waves in the band only.
    points, length = 256, 400e-6
    surface = rolled_off_surface(points, length, 0.8, 50e-6, 0.2e-6, np.random.default_rng(25178))
    waves = np.fft.fft2(surface)
    q = np.hypot(*np.meshgrid(*[2 * np.pi * np.fft.fftfreq(points, length / points)] * 2))
    inside = (q >= spec.q_min) & (q <= spec.q_max)
    in_band = np.std(np.fft.ifft2(waves * inside).real)
    assert spec.rms_height[0] == pytest.approx(in_band, rel=0.05)  # one map's windowed spectrum
    slopes = np.sqrt(np.sum(np.abs(waves * inside) ** 2 * q**2)) / points**2
    # The line of an isotropic surface has its rms slope, that of both directions together.
    found = spectrum_moments(spec, 0)["rms_slope"]
    assert found == pytest.approx(slopes, rel=0.05)


def test_with_a_filter_the_drawn_rms_height_is_the_measured_one_to_one_percent(study_file):
    settings = {"file": "turn.csv", "texture": "along rolling", "long_cutoff": "0.1 mm"}
    band = {"longest_wavelength": "2 mm", "shortest_wavelength": "6.25 um"}
    study = load_study(study_file(settings, roughness=band))
    measured = study.topographies["first"]._measured
    assert measured.name.endswith("turn.csv")
    from lube.study.topography_lines import prepared

    heights = prepared(study.topographies["first"]).heights
    line = draw_realisation(study.line_spec, 1, 0)[0] * study.line_spec.height_step
    assert np.std(line) == pytest.approx(np.std(heights), rel=0.01)


def test_the_film_uses_the_rms_height_of_the_lines(study_file):
    study = load_study(study_file(MAP, {"rms_roughness": "0.1 um"}))
    first, second = study.line_spec.rms_height
    assert second == 0.1e-6
    assert study.rough_rollers.composite_rms_roughness == pytest.approx(np.hypot(first, second))
    assert study.rough_rollers.first.topography is None


def test_a_profile_that_is_the_line_is_the_same_in_every_realisation(study_file):
    closed = {"file": "turn.csv", "texture": "along rolling", "use": "closed line"}
    study = load_study(study_file(closed, MAP))
    spec = study.line_spec
    (one, other), (again, another) = (draw_realisation(spec, 1, number) for number in (0, 1))
    assert np.array_equal(one, again)
    assert not np.array_equal(other, another)
    places = np.arange(spec.points[0]) / spec.points[0]
    heights = profile(TURN)
    expected = np.interp(places, np.arange(heights.size) / heights.size, heights, period=1.0)
    # The mean is removed; waves shorter than four measured points are left out.
    assert np.std(one * spec.height_step - expected) < 0.1 * np.std(expected)
    assert spectrum_moments(spec, 0)["rms_height"] == pytest.approx(np.std(one) * spec.height_step)


def test_two_measured_lines_are_one_pair(study_file):
    line = SCAN | {"use": "repeated line"}
    one = {"realisations": 1, "kept_realisations": [0]}
    study = load_study(study_file(line, **one))
    assert study.line_spec.is_one_pair
    line = np.frombuffer(study.line_spec.lines[0].heights, np.int32)
    repeats = 9  # of 3.9 mm less 2 %, around 31.4 mm
    correlation = np.fft.irfft(np.abs(np.fft.rfft(line.astype(float))) ** 2)
    assert correlation[round(line.size / repeats)] == pytest.approx(correlation[0], rel=1e-2)
    assert "realisations: got 64, need 1: both lines are measured" in refusal(
        study_file(SCAN | {"use": "repeated line"})
    )


def test_a_topography_of_both_rollers_is_read_and_resampled_once(study_file):
    line, one = SCAN | {"use": "repeated line"}, {"realisations": 1, "kept_realisations": [0]}
    study = load_study(study_file(line, **one))
    first, second = study.topographies.values()
    assert first._measured is second._measured
    assert len({id(each.heights) for each in study.line_spec.lines}) == 1


def test_no_isotropic_surface_belongs_to_profiles_along_rolling(study_file):
    check_stands_for_surface(load_study(study_file(MAP)).line_spec)
    with pytest.raises(LubeError, match="need an isotropic one or one with a lay"):
        check_stands_for_surface(load_study(study_file(SCAN)).line_spec)
    with pytest.raises(LubeError, match="got a measured line, need lines drawn"):
        check_stands_for_surface(
            load_study(study_file(SCAN | {"use": "repeated line"}, MAP)).line_spec
        )


def test_rollers_with_the_same_oblique_ridges_cross_in_contact(study_file, tmp_path):
    """Their maps are seen from opposite sides, as palms that are laid on one another."""
    points, ridges = 280, np.radians(30.0)
    q = np.fft.fftfreq(points, 1.0 / points)
    along = q[:, None] * np.cos(ridges) + q * np.sin(ridges)
    across = q * np.cos(ridges) - q[:, None] * np.sin(ridges)
    height = np.maximum(np.hypot(across, 4.0 * along), 8.0) ** -1.8
    noise = np.random.default_rng(1).standard_normal((points, points))
    surface = 1e-7 * np.fft.ifft2(height * np.fft.fft2(noise)).real / height.std()
    axes = {name: (name, 1.5 * np.arange(points), {"units": "um"}) for name in ("x", "y")}
    found = xr.Dataset({"height": (("x", "y"), surface, {"units": "m"})}, axes)
    found.to_netcdf(tmp_path / "ridges.nc")
    ridged = {"file": "ridges.nc", "texture": "lay"}
    study = load_study(study_file(ridged, contact_model=["surface"]))
    first, second = study.line_spec.lines
    assert first.lay_angle == pytest.approx(30.0, abs=2.0)
    assert second.lay_angle == pytest.approx(-first.lay_angle)
    assert second.lay_ratio == first.lay_ratio


def test_what_was_read_of_a_map_is_plain_data_and_spares_the_jobs_reading_it(study_file):
    path = study_file(MAP)
    study = load_study(path)
    arguments = json.loads(json.dumps(study.readings))
    os.replace(path.with_name("example.x3p"), path.with_name("gone.x3p"))
    assert load_study(path, **arguments).line_spec == study.line_spec
    # Few enough digits to be the same on every machine.
    for values in study.line_spec.lines[0].spectrum:
        assert all(value == float(f"{value:.6g}") for value in values)
    assert "example.x3p: no such file" in refusal(path)


def test_a_study_without_topographies_has_no_surface(study_file):
    assert "surface" not in load_study(PAPER).datasets
    assert "surface" in load_study(study_file(MAP)).datasets


def test_paths_start_from_the_file_that_names_them(study_file, tmp_path):
    study_file(MAP)
    above = tmp_path / "above"
    above.mkdir()
    content = {"based_on": "../study.yaml", "name": "based"}
    (above / "based.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    found = load_study(above / "based.yaml").topographies["first"].file
    assert os.path.samefile(found, tmp_path / "example.x3p")


def test_an_rms_height_takes_the_place_of_a_topography_of_the_base(study_file, tmp_path):
    study_file(MAP)
    rollers = {"first": {"rms_roughness": "0.3 um"}}
    content = {"based_on": "study.yaml", "name": "based", "rollers": rollers}
    (tmp_path / "based.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    study = load_study(tmp_path / "based.yaml")
    assert study.line_spec.rms_height[0] == 0.3e-6
    assert list(study.topographies) == ["second"]


SHORT = {"longest_wavelength": "200 um", "shortest_wavelength": "4 um"}
REFUSED = {
    "no file": (
        MAP | {"file": "none.x3p"},
        BAND,
        "none.x3p: no such file, need a measured profile",
    ),
    "unreadable": (MAP | {"file": "notes.txt"}, BAND, "cannot be read as a topography: no known"),
    "unknown key": (MAP | {"hole": "refuse"}, BAND, "did you mean 'holes'?"),
    "no texture": ({"file": "scan.csv"}, BAND, "topography.texture: missing"),
    "holes": (MAP | {"holes": "refuse"}, BAND, "example.x3p: got holes, 0.07% of the points, need"),
    "too coarse": (MAP, SHORT, "down to 6.25 µm, need waves down to 4 µm, the shortest"),
    "too short": (MAP, {"shortest_wavelength": "7 um", "longest_wavelength": "0.3 mm"}, "half the"),
    "not closed": (SCAN | {"use": "closed line"}, BAND, "got a profile of 3.9 mm, need the circ"),
    "a map as line": (
        MAP | {"texture": "along rolling", "use": "repeated line"},
        BAND,
        "got a map, need a profile to use it directly",
    ),
    "isotropic line": (
        SCAN | {"texture": "isotropic", "use": "repeated line"},
        BAND,
        "texture: got 'isotropic', need 'along rolling' for a profile that is the line",
    ),
    "no unit": (MAP | {"long_cutoff": 0.08}, BAND, "topography.long_cutoff: got 0.08, need a numb"),
    "no length": (
        MAP | {"long_cutoff": "80 kg"},
        BAND,
        "topography.long_cutoff: wrong dimension or unit 'kg', need a unit of the kind",
    ),
    "negative": (
        MAP | {"long_cutoff": "-80 um"},
        BAND,
        "topography.long_cutoff: got -80 um, need a value above 0",
    ),
    "two roughnesses": (MAP, BAND | {"hurst_exponent": 0.8}, "roughness.hurst_exponent: got 0.8"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_used_is_refused_in_one_line(study_file, case):
    topography, roughness, needed = REFUSED[case]
    message = refusal(study_file(topography, roughness=roughness))
    assert "rollers.first" in message
    assert needed in message


@pytest.mark.parametrize("name", ["longest_wavelength", "shortest_wavelength"])
def test_a_measured_spectrum_has_no_other_band(study_file, name):
    """Its height follows from its band."""
    ranges = {"hurst_exponent": None, "longest_wavelength": None, "shortest_wavelength": None}
    ranges[name] = {"range": "-10 % to 0 %", "source": "assumed"}
    study = load_study(study_file(MAP, uncertainty=ranges))
    with pytest.raises(LubeError, match=f"{name}: got a range for lines whose spectrum and height"):
        check_uncertainty(study)


def test_a_profile_shorter_than_the_contact_is_refused(study_file, tmp_path):
    write_csv(tmp_path / "short.csv", profile(6e-3)[:100])
    short = {"file": "short.csv", "texture": "along rolling", "use": "repeated line"}
    forces = {"force": {"values": [8000], "units": "N"}}
    trace = [{"force": "8000 N", "speed": "100 rpm", "temperature": "40 degC"}]
    path = study_file(
        short, realisations=1, kept_realisations=[0], operating_grid=forces, traces=trace
    )
    assert "short.csv: got a profile of 0.15 mm, need one longer than the contact" in refusal(path)


def test_a_topography_beside_another_roughness_is_refused(study_file):
    path = study_file(MAP)
    content = yaml.safe_load(path.read_text())
    content["rollers"]["first"]["rms_roughness"] = "0.2 um"
    path.write_text(yaml.safe_dump(content))
    assert "topography: got one together with rms_roughness, need one of the two" in refusal(path)


def test_two_measured_surfaces_need_no_hurst_exponent_and_one_does(study_file):
    missing = {"points": 20_000, "shortest_wavelength": "6.25 um", "hurst_exponent": None}
    path = study_file(MAP)
    content = yaml.safe_load(path.read_text("utf-8")) | {"roughness": missing}
    path.write_text(yaml.safe_dump(content), encoding="utf-8")
    assert load_study(path).line_spec.lines[0].hurst_exponent is None
    content["rollers"]["second"] = {"topography": None, "rms_roughness": "0.2 um"}
    path.write_text(yaml.safe_dump(content), encoding="utf-8")
    expected = "roughness.hurst_exponent: missing, need it for the second roller"
    assert expected in refusal(path)


def test_cutoffs_beside_a_topography_are_refused(study_file):
    own = BAND | {"long_cutoff": "0.8 mm"}
    message = refusal(study_file(MAP, roughness=own))
    assert "roughness.long_cutoff: got 0.8 mm together with a topography" in message
