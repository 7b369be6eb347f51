"""Reading measured topographies: every kind of file, and files that cannot be used."""

from pathlib import Path

import numpy as np
import pytest
import SurfaceTopography
import xarray as xr
from example_surface import example_heights, write_example

from lube.errors import DataError
from lube.study.topography_files import read_topography
from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.surface_statistics import Waves, height_distribution, hurst_exponent, roll_off
from lube.surfaces.topography import Preparation, prepare

EXAMPLE = Path(__file__).parents[2] / "workflow" / "config" / "surfaces" / "example.x3p"
HEIGHTS = 1e-7 * np.random.default_rng(1).normal(size=(70, 80))


def written_csv(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def test_csv_with_units_and_holes(tmp_path):
    text = "# stylus\nposition [mm]; height [µm]\n0; 0.5\n0.001; \n0.002; nan\n0.003; -0.25\n"
    found = read_topography(written_csv(tmp_path / "p.csv", text))
    np.testing.assert_allclose(found.heights, [5e-7, np.nan, np.nan, -2.5e-7])
    assert found.spacing == pytest.approx((1e-6,))


@pytest.mark.parametrize("shape", [(70,), (70, 80)])
def test_netcdf_with_units(tmp_path, shape):
    heights = HEIGHTS[:, 0].copy() if len(shape) == 1 else HEIGHTS.copy()
    heights[3] = np.nan
    names = ("x", "y")[: len(shape)]
    axes = {
        name: (name, 0.5 * np.arange(points), {"units": "um"})
        for name, points in zip(names, shape, strict=True)
    }
    surface = xr.Dataset({"height": (names, 1e9 * heights, {"units": "nm"})}, axes)
    surface.to_netcdf(tmp_path / "p.nc")
    found = read_topography(tmp_path / "p.nc")
    np.testing.assert_allclose(found.heights, heights, rtol=1e-12)
    assert found.spacing == pytest.approx((5e-7,) * len(shape))


def test_the_first_direction_of_a_netcdf_map_is_x(tmp_path):
    axes = {
        "x": ("x", np.arange(70.0), {"units": "um"}),
        "y": ("y", 2.0 * np.arange(80), {"units": "um"}),
    }
    surface = xr.Dataset({"height": (("x", "y"), HEIGHTS, {"units": "m"})}, axes)
    surface.transpose("y", "x").to_netcdf(tmp_path / "rows.nc")
    found = read_topography(tmp_path / "rows.nc")
    np.testing.assert_array_equal(found.heights, HEIGHTS)
    assert found.spacing == pytest.approx((1e-6, 2e-6))


def test_csv_with_decimal_commas(tmp_path):
    text = "position [mm];height [um]\n0,000;0,5\n0,001;-0,25\n"
    found = read_topography(written_csv(tmp_path / "p.csv", text))
    assert found.spacing == pytest.approx((1e-6,))
    assert found.heights.tolist() == pytest.approx([0.5e-6, -0.25e-6])


@pytest.mark.filterwarnings("ignore:Cannot close a netcdf_file:RuntimeWarning")
@pytest.mark.parametrize(
    ("suffix", "write"),
    [("x3p", "to_x3p"), ("nc", "to_netcdf"), ("gwy", "to_gwy"), ("dat", "to_x3p")],
)
def test_instruments_formats_with_holes(tmp_path, suffix, write):
    masked = np.ma.masked_array(1e6 * HEIGHTS, np.zeros(HEIGHTS.shape, bool))
    masked[5, 7] = np.ma.masked
    surface = SurfaceTopography.Topography(masked, (35.0, 20.0), unit="µm")
    path = tmp_path / f"map.{suffix}"
    getattr(surface, write)(str(path))
    found = read_topography(path)
    assert found.spacing == pytest.approx((5e-7, 2.5e-7))
    assert np.argwhere(np.isnan(found.heights)).tolist() == [[5, 7]]
    expected = HEIGHTS.copy()
    expected[5, 7] = np.nan
    np.testing.assert_allclose(found.heights, expected, rtol=1e-6)


def test_an_instruments_resolution_is_kept(tmp_path):
    info = {"instrument": {"parameters": {"resolution": {"value": 1.5, "unit": "µm"}}}}
    surface = SurfaceTopography.Topography(1e6 * HEIGHTS, (35.0, 20.0), unit="µm", info=info)
    surface.to_netcdf(str(tmp_path / "map.nc"))
    assert read_topography(tmp_path / "map.nc").resolution == pytest.approx(1.5e-6)


def test_the_example_is_what_it_says_and_is_made_again(tmp_path):
    write_example(tmp_path / "again.x3p")
    assert (tmp_path / "again.x3p").read_bytes() == EXAMPLE.read_bytes()
    assert EXAMPLE.stat().st_size < 500_000
    found = read_topography(EXAMPLE)
    np.testing.assert_allclose(found.heights, example_heights(), atol=1e-10)
    settings = Preparation("isotropic", holes="interpolate")
    surface = prepare(found, settings)
    spectrum = line_spectrum(surface, settings)
    for fit, truth in (
        (hurst_exponent(spectrum, Waves(4e-5, 7e-6)), 0.8),
        (roll_off(spectrum, Waves(4e-4, 7e-6)), 5e-5),
        (height_distribution(surface.heights)["rms_height"], 2e-7),
    ):
        assert fit.lower <= truth <= fit.upper


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("position,height\n0,1\n", r"line 1: got 'position,height', need the columns"),
        ("position [mm],height [s]\n0,1\n1,2\n", "wrong dimension or unit 's'"),
        ("position [mm],height [um]\n0,1\n1,x\n", "line 3: got 'x', need a finite number"),
        ("position [mm];height [um]\n0,0;0,1\n0,1;0.2", "line 3: got '0.2' in a file with decimal"),
        ("position [mm],height [um]\n0,1,2\n", "line 2: got 3 values, need one for each of 2"),
        ("position [mm],height [um]\n0,1\n", "got 1 positions, need two or more"),
        ("position [mm],height [um]\n0,1\n1,1\n3,1\n", "off an even grid"),
        ("position [mm],height [um]\n2,1\n1,1\n0,1\n", "off an even grid"),
    ],
)
def test_csv_files_that_cannot_be_used(tmp_path, text, message):
    path = written_csv(tmp_path / "p.csv", text)
    with pytest.raises(DataError, match=message) as error:
        read_topography(path)
    assert str(error.value).startswith(f"{path}: ") and "\n" not in str(error.value)


def garbage(path):
    path.write_bytes(np.random.default_rng(1).bytes(20_001))


def square_garbage(path):
    """Any square number of 16-bit integers passes for a satellite's map of the Earth."""
    path.write_bytes(np.random.default_rng(1).bytes(20_000))


def truncated(path):
    path.write_bytes(EXAMPLE.read_bytes()[:50_000])


def unitless_text(path):
    np.savetxt(path, HEIGHTS)


def unitless_netcdf(path):
    xr.Dataset({"height": ("x", HEIGHTS[0])}, {"x": np.arange(80.0)}).to_netcdf(path)


def three_dimensions(path):
    xr.Dataset({"height": (("x", "y", "z"), np.zeros((2, 2, 2)))}).to_netcdf(path)


def other_netcdf(path):
    xr.Dataset({"voltage": ("time", HEIGHTS[0])}).to_netcdf(path)


@pytest.mark.parametrize(
    ("name", "write", "message"),
    [
        ("a.x3p", garbage, "cannot be read as a topography"),
        ("a.sur", square_garbage, "without unit or lengths, need both"),
        ("b.x3p", truncated, "cannot be read as a topography"),
        ("c.asc", unitless_text, "without unit or lengths, need both"),
        ("d.nc", unitless_netcdf, "got no unit"),
        ("e.nc", three_dimensions, "need it over one or two coordinates"),
        ("f.nc", other_netcdf, "cannot be read as a topography|without unit"),
        ("g.sur", lambda path: None, "no such file"),
    ],
)
def test_files_that_cannot_be_used(tmp_path, name, write, message):
    write(tmp_path / name)
    with pytest.raises(DataError, match=message) as error:
        read_topography(tmp_path / name)
    assert str(error.value).startswith(str(tmp_path / name)) and "\n" not in str(error.value)
