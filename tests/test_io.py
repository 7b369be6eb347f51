"""NetCDF in and out: whole, exact, the same bytes, or refused in one line that names the file."""

import hashlib
import json
import shutil

import cf_units
import netCDF4
import numpy as np
import pytest
import xarray as xr
from compliance_checker.runner import CheckSuite, ComplianceChecker

from lube.comparison import compare
from lube.contact import contact_map, contact_statistics
from lube.ensemble import gather, gather_map
from lube.errors import DataError
from lube.experiment import simulated_experiment
from lube.film import film_table
from lube.gauge import gauge_records
from lube.io import load, opened, save
from lube.lubricant import lubricant_table
from lube.provenance import global_attributes
from lube.rig_records import rig_records
from lube.roughness import roughness_batch, roughness_lines
from lube.schema import COORDINATES, FILES, check, label
from lube.seals import LENGTH
from lube.trace import contact_trace

KINDS = list(FILES)
FINAL_KINDS = [kind for kind in KINDS if not kind.endswith("_batch")]


def load_as_jobs_do(path, kind, study=None):
    """Batches of lines stay whole steps, everything else is in its unit."""
    with opened(path, kind, study, raw=kind == "roughness_batch") as dataset:
        return dataset.load()


def measured_times(kind):
    """Times as `snakemake benchmark` saves them, none like another."""
    rng = np.random.default_rng(1)
    variables = {
        name: (row.dims, rng.uniform(1.0, 1e6, (2,) * len(row.dims)).astype(row.kind + "8"))
        for name, row in FILES[kind].items()
    }
    dims = {dim for row in FILES[kind].values() for dim in row.dims}
    coords = {dim: np.arange(2).astype(COORDINATES[dim].kind + "8") for dim in sorted(dims)}
    return label(xr.Dataset(variables, coords), kind)


@pytest.fixture(scope="module")
def datasets(study, make_spec):
    """One dataset of every kind, by the stages themselves, on a coarse grid."""
    grid, layer = study.operating_grid, study.boundary_layer
    # Rollers of two sizes, so that the shorter line is padded.
    spec = make_spec(12_000, second_radius=0.04)
    oil = lubricant_table(study.lubricants, grid.temperature)
    film = film_table(oil, study.rollers, grid.force, grid.speed, study.film_formulas)
    lines = roughness_lines(spec, study.seed, [0, 1])
    batch = roughness_batch(spec, study.seed, [0, 1])
    run = contact_statistics(batch, film, layer, study.slips)
    rig_lines = roughness_batch(spec, study.seed, study.rig_realisations[:1])
    mapped = contact_map(batch, film, layer, 5, 3)
    points = [point | {"slide_to_roll_ratio": 0.0} for point in study.trace_points]
    contact, master = gather([run], film), gather_map([mapped])
    experiment = simulated_experiment(rig_lines, film, study)
    return {
        "lubricant": oil,
        "film": film,
        "roughness": lines,
        "roughness_batch": batch,
        "contact_batch": run,
        "contact": contact,
        "master_batch": mapped,
        "master": master,
        "trace": contact_trace(lines, film, points, layer, study.resistivity),
        "experiment": experiment,
        "rig": rig_records(rig_lines, film, study),
        "comparison": compare(contact, experiment),
        "gauge": gauge_records(master, film, contact, experiment),
        "speed": measured_times("speed"),
        "reading": measured_times("reading"),
    }


@pytest.fixture(scope="module")
def files(datasets, study, tmp_path_factory):
    """The same, saved."""
    folder = tmp_path_factory.mktemp("files")
    for kind, dataset in datasets.items():
        save(dataset, folder / f"{kind}.nc", kind, study)
    return folder


def refusal(path, kind):
    with pytest.raises(DataError) as caught:
        load_as_jobs_do(path, kind)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message


def bytes_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


# Round trips


def test_there_is_a_dataset_of_every_kind(datasets):
    assert set(datasets) == set(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_saved_is_loaded_with_its_labels(datasets, files, kind):
    loaded = load_as_jobs_do(files / f"{kind}.nc", kind)
    for name in {"in_validity_range", "intervals_overlap"} & set(loaded):
        loaded[name] = loaded[name].astype(bool)  # NetCDF has no truth values
    xr.testing.assert_equal(loaded, datasets[kind])
    for name, array in datasets[kind].variables.items():
        assert loaded[name].attrs["long_name"] == array.attrs["long_name"]
        assert loaded[name].attrs.get("units") == array.attrs.get("units")
    for name, value in datasets[kind].attrs.items():
        np.testing.assert_array_equal(loaded.attrs[name], value)


def test_heights_are_exact_after_packing_and_padding_stays_missing(datasets, files):
    heights = datasets["roughness"]["height"].values
    loaded = load(files / "roughness.nc", "roughness")["height"].values
    assert loaded.dtype == np.float64
    assert np.isnan(heights).any()
    np.testing.assert_array_equal(loaded, heights)
    with netCDF4.Dataset(files / "roughness.nc") as raw:
        assert raw["height"].dtype == np.int32


def test_packed_heights_are_whole_steps_of_the_batch(datasets, files):
    steps = load(files / "roughness.nc", "roughness")["height"].values
    expected = datasets["roughness_batch"]["height"].values
    present = ~np.isnan(steps)
    step = datasets["roughness"].attrs["height_step"]
    np.testing.assert_array_equal(np.rint(steps[present] / step), expected[present])


def test_a_batch_is_left_as_whole_steps(datasets, files):
    with opened(files / "roughness_batch.nc", "roughness_batch") as dataset:
        loaded = dataset.load()
    assert loaded["height"].dtype == np.int32
    np.testing.assert_array_equal(loaded["height"], datasets["roughness_batch"]["height"])


def test_a_loaded_dataset_does_not_hang_on_its_file(files, tmp_path):
    path = shutil.copy(files / "film.nc", tmp_path / "film.nc")
    film = load(path, "film")
    path.unlink()
    assert np.isfinite(film["film_thickness"].values).all()


# What a stranger sees who opens a file


@pytest.mark.parametrize("kind", FINAL_KINDS)
def test_xarray_alone_gives_metres_and_labels(datasets, files, kind):
    with xr.open_dataset(files / f"{kind}.nc") as opened:
        check(opened, kind)
        for name, array in opened.variables.items():
            if array.dtype.kind == "f":
                assert array.attrs["units"]
                np.testing.assert_array_equal(array.values, datasets[kind][name].values)


def test_an_operating_point_is_selected_by_the_values_people_say(files, study):
    point = {"force": 800, "speed": 100, "temperature": 40}
    with xr.open_dataset(files / "contact.nc") as contact:
        chosen = contact["breakthrough_probability_mean"].sel(point)
        assert chosen.sizes["film_formula"] == len(study.film_formulas)
        assert chosen.notnull().all()


@pytest.mark.parametrize("kind", KINDS)
def test_files_say_where_they_come_from(files, study, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        assert raw.data_model == "NETCDF4"
        for name, value in global_attributes(study, kind).items():
            assert raw.getncattr(name) == value


@pytest.fixture(scope="module")
def checker():
    """The compliance checker, its conventions loaded."""
    CheckSuite.load_all_available_checkers()
    return ComplianceChecker


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("convention", "asked", "allowed"),
    [
        # CF's own `time` counts from a date; that of a trace begins with the revolution.
        (
            "cf:1.11",
            "all_priorities",
            {"Coordinate variable 'time' should have standard_name='time', found: 'None'"},
        ),
        # There is no standard name for anything that a lubrication study finds.
        ("acdd:1.3", "high_priorities", {"standard_name"}),
    ],
)
def test_files_keep_the_conventions(files, checker, tmp_path, kind, convention, asked, allowed):
    report = tmp_path / "report.json"
    _, broke = checker.run_checker(
        str(files / f"{kind}.nc"),
        [convention],
        verbose=0,
        criteria="strict",
        output_filename=str(report),
        output_format="json",
    )
    assert not broke
    found = json.loads(report.read_text(encoding="utf-8"))[convention]
    assert {message for result in found[asked] for message in result["msgs"]} <= allowed


@pytest.mark.parametrize("kind", KINDS)
def test_every_number_has_a_unit_that_udunits_knows_and_every_variable_a_long_name(files, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        for array in raw.variables.values():
            assert array.long_name
            assert hasattr(array, "units") == (array.dtype.kind != "S")
            if hasattr(array, "units"):
                assert not cf_units.Unit(array.units).is_unknown()


@pytest.mark.parametrize("kind", KINDS)
def test_no_coordinate_has_a_fill_value_and_heights_alone_have_one(files, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        filled = {name for name, array in raw.variables.items() if "_FillValue" in array.ncattrs()}
    assert filled == ({"height"} if kind == "roughness" else set())


@pytest.mark.parametrize("kind", KINDS)
def test_every_array_is_checksummed_and_numbers_are_compressed(files, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        for array in raw.variables.values():
            filters = array.filters()
            assert filters["fletcher32"] == (array.ndim > 0)
            if array.ndim and array.dtype.kind != "S":
                assert filters["zlib"] and filters["shuffle"]
                assert filters["complevel"] == 4
                assert array.chunking() != "contiguous"


def test_a_file_for_minutes_is_checksummed_but_not_compressed(datasets, study, tmp_path):
    save(datasets["roughness_batch"], tmp_path / "b.nc", "roughness_batch", study, compress=False)
    with netCDF4.Dataset(tmp_path / "b.nc") as raw:
        filters = raw["height"].filters()
    assert filters["fletcher32"] and not filters["zlib"]


# The same bytes, and whole or not at all


@pytest.mark.parametrize("kind", KINDS)
def test_two_saves_are_the_same_bytes(datasets, files, study, tmp_path, kind):
    save(datasets[kind], tmp_path / "again.nc", kind, study)
    assert bytes_of(tmp_path / "again.nc") == bytes_of(files / f"{kind}.nc")


@pytest.mark.parametrize("kind", KINDS)
def test_loading_and_saving_again_keeps_the_values(files, study, tmp_path, kind):
    first = load_as_jobs_do(files / f"{kind}.nc", kind)
    save(first, tmp_path / "again.nc", kind, study)
    xr.testing.assert_identical(load_as_jobs_do(tmp_path / "again.nc", kind), first)


@pytest.mark.parametrize("kind", KINDS)
def test_files_of_the_study_are_taken_and_of_other_values_refused(files, study, kind):
    load_as_jobs_do(files / f"{kind}.nc", kind, study)
    seed = study.model_copy(update={"seed": 1})
    message = r"belongs to other values than this study's: .*seed is 20181109, need 1; take it"
    if "seed" in study.stage_inputs(kind.removesuffix("_batch")):
        with pytest.raises(DataError, match=f"{kind}.nc: {message}"):
            load_as_jobs_do(files / f"{kind}.nc", kind, seed)


def test_a_dataset_that_does_not_fit_its_kind_leaves_the_old_file(datasets, files, study, tmp_path):
    path = shutil.copy(files / "film.nc", tmp_path / "film.nc")
    before = bytes_of(path)
    with pytest.raises(DataError, match="film_thickness"):
        save(datasets["film"].drop_vars("film_thickness"), path, "film", study)
    assert bytes_of(path) == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("moment", ["os.replace", "xarray.Dataset.to_netcdf"])
def test_a_save_that_fails_midway_leaves_the_old_file_and_no_rest(
    datasets, files, study, tmp_path, monkeypatch, moment
):
    path = shutil.copy(files / "film.nc", tmp_path / "film.nc")
    before = bytes_of(path)

    def fail(*arguments, **options):
        raise OSError("No space left on device")

    monkeypatch.setattr(moment, fail)
    with pytest.raises(DataError, match=r"film.nc: cannot be written: No space left.*MiB are free"):
        save(datasets["film"], path, "film", study)
    assert bytes_of(path) == before
    assert list(tmp_path.iterdir()) == [path]


def test_saving_makes_the_folder_it_needs(datasets, study, tmp_path):
    save(datasets["film"], tmp_path / "new" / "folder" / "film.nc", "film", study)
    load(tmp_path / "new" / "folder" / "film.nc", "film")


# What is refused


def test_a_missing_file_is_named(tmp_path):
    assert "no such file, need a film dataset" in refusal(tmp_path / "film.nc", "film")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("part", [0.0, 0.01, 0.5, 0.99])
def test_a_truncated_file_is_named(files, tmp_path, kind, part):
    whole = (files / f"{kind}.nc").read_bytes()
    path = tmp_path / f"{kind}.nc"
    path.write_bytes(whole[: int(part * len(whole))])
    assert "not a whole NetCDF file" in refusal(path, kind)


@pytest.mark.parametrize(
    "content", [b"", b"force,speed\n800,100\n", b"CDF\x01 and nonsense", b"\x89HDF\r\n\x1a\n" * 100]
)
def test_what_is_no_netcdf_is_named(tmp_path, content):
    path = tmp_path / "film.nc"
    path.write_bytes(content)
    assert "not a whole NetCDF file" in refusal(path, "film")


def test_a_folder_is_no_file(tmp_path):
    assert "no such file" in refusal(tmp_path, "film")


def test_a_foreign_netcdf_is_refused(tmp_path):
    path = tmp_path / "film.nc"
    xr.Dataset({"sea_surface_temperature": ("time", [1.0, 2.0])}).to_netcdf(path)
    assert "not a film file" in refusal(path, "film")


def test_a_netcdf_with_a_time_nobody_can_read_is_refused(tmp_path):
    path = tmp_path / "film.nc"
    time = ("time", [0.0, 1.0], {"units": "days since the flood"})
    xr.Dataset(coords={"time": time}).to_netcdf(path)
    assert "not a" in refusal(path, "film")


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_of_another_kind_is_refused(files, kind):
    other = "film" if kind != "film" else "trace"
    assert f"not a {other} file" in refusal(files / f"{kind}.nc", other)


@pytest.mark.parametrize("kind", KINDS)
def test_one_flipped_bit_inside_the_data_is_noticed(datasets, study, tmp_path, kind):
    path = tmp_path / f"{kind}.nc"
    save(datasets[kind], path, kind, study, compress=False)
    whole = bytearray(path.read_bytes())
    whole[place_of_largest_array(path, whole)] ^= 1
    path.write_bytes(whole)
    assert "damaged" in refusal(path, kind)


def place_of_largest_array(path, whole):
    """Where in an uncompressed file the last bytes of the largest array's first line lie."""
    with netCDF4.Dataset(path) as raw:
        raw.set_auto_maskandscale(False)
        arrays = [array[:] for array in raw.variables.values() if array.dtype is not str]
    stored = max(arrays, key=np.size)
    whole_chunk = stored.size <= 2**18  # larger arrays are stored line by line
    line = (stored if whole_chunk else stored.reshape(-1, stored.shape[-1])[0]).tobytes()
    assert whole.count(line) == 1
    return whole.index(line) + len(line) - 1


def test_one_flipped_bit_inside_compressed_data_is_noticed(files, tmp_path):
    whole = bytearray((files / "roughness.nc").read_bytes())
    whole[len(whole) // 2] ^= 1  # heights are nearly all of this file
    path = tmp_path / "roughness.nc"
    path.write_bytes(whole)
    assert "damaged" in refusal(path, "roughness")


# Nothing but what was saved


def spread(size, count, seed):
    """Places all over a file: at its beginning, in its midst, and a few in its seal."""
    midst = np.random.default_rng(seed).integers(0, size - LENGTH, count).tolist()
    return {*range(20), *midst, *range(size - LENGTH - 2, size, 30)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_flipped_bit_anywhere_is_told_or_harmless(datasets, files, tmp_path, kind):
    """Data, header, index of chunks, texts, unused space: HDF5 protects only some of them."""
    whole = (files / f"{kind}.nc").read_bytes()
    path = tmp_path / f"{kind}.nc"
    expected = load_as_jobs_do(files / f"{kind}.nc", kind)
    for place in spread(len(whole), 100, seed=len(kind)):
        flipped = bytearray(whole)
        flipped[place] ^= 1 << (place % 8)
        path.write_bytes(flipped)
        try:
            loaded = load_as_jobs_do(path, kind)
        except DataError as error:
            assert str(error).startswith(f"{path}: not a whole NetCDF file, damaged")
        else:
            assert place >= len(whole) - LENGTH  # in the seal itself
            xr.testing.assert_identical(loaded, expected)


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_cut_anywhere_is_told_or_whole(files, tmp_path, kind):
    whole = (files / f"{kind}.nc").read_bytes()
    path = tmp_path / f"{kind}.nc"
    expected = load_as_jobs_do(files / f"{kind}.nc", kind)
    for length in spread(len(whole), 20, seed=len(kind)):
        path.write_bytes(whole[:length])
        try:
            loaded = load_as_jobs_do(path, kind)
        except DataError as error:
            assert str(error).startswith(f"{path}: not a whole NetCDF file, truncated")
            assert "\n" not in str(error)
        else:
            assert length >= len(whole) - LENGTH  # only the seal is cut
            xr.testing.assert_identical(loaded, expected)


def test_a_file_without_a_seal_is_taken_with_a_warning(datasets, files, tmp_path, caplog):
    path = tmp_path / "film.nc"
    path.write_bytes((files / "film.nc").read_bytes()[:-LENGTH])
    thickness = load(path, "film")["film_thickness"]
    xr.testing.assert_equal(thickness, datasets["film"]["film_thickness"])
    assert caplog.messages == [f"{path}: has no seal, so nobody knows if it is undamaged"]


@pytest.mark.parametrize("kind", ["film", "roughness_batch"])
def test_on_a_disk_of_any_size_a_file_is_whole_or_not_there(datasets, study, tmp_path, disk, kind):
    """The library may run out of space anywhere in the file, at the last also while it closes."""
    path = tmp_path / "small" / f"{kind}.nc"
    path.parent.mkdir()
    saved = {}
    for size in range(4, 400, 18):
        disk(path.parent, f"size={size}k")
        try:
            save(datasets[kind], path, kind, study, compress=kind == "film")
        except DataError as error:
            assert str(error).startswith(f"{path}: cannot be written: ")
            assert "MiB are free on its disk" in str(error)
            assert not list(path.parent.iterdir())
        saved[size] = path.exists() and bool(load_as_jobs_do(path, kind))
    assert list(saved.values()) == sorted(saved.values())
    assert not saved[4] and saved[382]
