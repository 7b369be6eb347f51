"""Speed of reading and evaluating recordings, compared with other readers of the same files.

    snakemake benchmark                                            # measures, saves and draws
    python benchmarks/bench_reading.py [STUDY [READING.NC]]  # measures and prints

Each reader runs in its own process, whose peak memory is recorded, and the readers take turns; a
time is the shortest of several runs, with the files in the system's cache. The binary recording is
16-bit integers with a scale, as from a converter: NetCDF in compressed chunks (deflate, level 1),
TDMS in segments of a million samples. It is read on one core; the CSV recording, of time and
voltage, on all cores that a reader can use.
"""

import multiprocessing
import os
import resource
import shutil
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np
import pandas
import pyarrow
import pyarrow.csv
import xarray as xr
from nptdms import ChannelObject, TdmsWriter

from lube.errors import DataError
from lube.recordings.reader import open_recording
from lube.rig.contact_share import ContactShare
from lube.schema import label
from lube.storage.netcdf import save
from lube.study.study import load_study

SAMPLES, ROWS = 10**8, 10**7
SMOKE_SAMPLES, SMOKE_ROWS = 10**6, 10**5
PIECE = 10**6

STEP = 1e-4
"""Volts of one step of the converter."""

INTERVAL = 1e-5
LIMITS = (0.1, 0.2, 0.3, 0.4, 0.5)
TURNS = 3

BYTES_PER_SAMPLE, BYTES_PER_ROW = 4, 25
"""Space needed on disk, rounded up: two bytes in each binary file, and a line of text."""


def record(samples):
    """Voltage with random contacts, int16, in pieces."""
    rng = np.random.default_rng(1)
    for first in range(0, samples, PIECE):
        count = min(PIECE, samples - first)
        contacts = np.repeat(rng.random(-(-count // 50)) < 0.1, 50)[:count]
        volts = np.where(contacts, 0.05, 1.0) + 0.1 * rng.standard_normal(count)
        yield np.rint(volts / STEP).astype(np.int16)


def write_netcdf(path, samples):
    """Write the recording as a scaled variable."""
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", samples)
        packed = {"zlib": True, "complevel": 1, "shuffle": True, "chunksizes": (PIECE,)}
        voltage = file.createVariable("voltage", "i2", ("time",), **packed)
        voltage.setncatts({"units": "V", "scale_factor": STEP, "sampling_interval": "10 us"})
        voltage.set_auto_maskandscale(False)
        for number, piece in enumerate(record(samples)):
            voltage[number * PIECE : number * PIECE + piece.size] = piece


def write_tdms(path, samples):
    """Write the recording as a scaled channel."""
    properties = {
        "wf_increment": INTERVAL,
        "NI_UnitDescription": "V",
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 1,
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": STEP,
        "NI_Scale[0]_Linear_Y_Intercept": 0.0,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
    }
    with TdmsWriter(path) as file:
        for piece in record(samples):
            file.write_segment([ChannelObject("rig", "voltage", piece, properties=properties)])


def write_csv(path, rows):
    """Write the recording as a table of time and voltage."""
    names = ["time [s]", "voltage [V]"]
    schema = pyarrow.schema([(name, pyarrow.float64()) for name in names])
    with pyarrow.csv.CSVWriter(path, schema) as file:
        for number, piece in enumerate(record(rows)):
            times = np.round((number * PIECE + np.arange(piece.size)) * INTERVAL, 5)
            file.write_table(pyarrow.table([times, np.round(piece * STEP, 4)], schema=schema))


def evaluate(path):
    """Read and evaluate a recording as the study does."""
    share = ContactShare(LIMITS)
    for piece in open_recording(path).pieces():
        share.add(piece)


def in_memory(path):
    """Evaluate an array in memory, as a notebook would."""
    values = np.concatenate(list(open_recording(path).pieces()))
    return lambda: [np.count_nonzero(values < limit) for limit in LIMITS]


RECORD_WAYS = {
    "NetCDF, streamed": ("record.nc", lambda path: partial(evaluate, path)),
    "TDMS, streamed": ("record.tdms", lambda path: partial(evaluate, path)),
    "NumPy, array in memory": ("record.tdms", in_memory),
}
TABLE_WAYS = {
    "streamed and evaluated": ("record.csv", lambda path: partial(evaluate, path)),
    "PyArrow, whole file": ("record.csv", lambda path: partial(pyarrow.csv.read_csv, path)),
    "pandas, whole file": ("record.csv", lambda path: partial(pandas.read_csv, path)),
}
WAYS = RECORD_WAYS | TABLE_WAYS


def peak_memory():
    """Peak memory of this process so far, bytes."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def run_way(name, folder):
    """Run one reader in this process; return its time (s) and the peak memory (bytes)."""
    if name in RECORD_WAYS:
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    file, prepare = WAYS[name]
    side = prepare(folder / file)
    side()  # kernels are loaded, the file is in the cache
    begin = time.perf_counter()
    side()
    return time.perf_counter() - begin, peak_memory()


def alone(work, *arguments):
    """Call a function in its own process."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(work, *arguments).result()


def measure_ways(names, folder, turns):
    """Shortest time and largest memory of each reader; they take turns."""
    measured = np.array([[alone(run_way, name, folder) for name in names] for _ in range(turns)])
    times, memories = measured[..., 0].min(axis=0), measured[..., 1].max(axis=0)
    for name, seconds, memory in zip(names, times, memories, strict=True):
        print(f"{name:<24s} {seconds:7.3f} s, at most {memory / 2**20:5.0f} MiB", flush=True)
    return times, memories


def measure(samples, rows, turns, folder):
    """Measure everything, as the ``reading`` file of `lube.schema`."""
    need = samples * BYTES_PER_SAMPLE + rows * BYTES_PER_ROW
    if shutil.disk_usage(folder).free < need:
        raise DataError(f"{folder}: need {need / 2**20:.0f} MiB free on its disk")
    bare_memory = alone(peak_memory)
    # A new process begins with the peak memory of the one that started it.
    alone(write_netcdf, folder / "record.nc", samples)
    alone(write_tdms, folder / "record.tdms", samples)
    alone(write_csv, folder / "record.csv", rows)
    print(f"{samples:g} samples, {len(LIMITS)} thresholds, one core:")
    record_times, record_memories = measure_ways(list(RECORD_WAYS), folder, turns)
    print(f"CSV of {rows:g} rows:")
    table_times, table_memories = measure_ways(list(TABLE_WAYS), folder, turns)
    dataset = xr.Dataset(
        {
            "record_samples": samples,
            "record_time": ("record_reader", record_times),
            "record_memory": ("record_reader", record_memories),
            "table_rows": rows,
            "table_time": ("table_reader", table_times),
            "table_memory": ("table_reader", table_memories),
            "bare_memory": float(bare_memory),
            "thresholds": len(LIMITS),
        },
        coords={"record_reader": list(RECORD_WAYS), "table_reader": list(TABLE_WAYS)},
    )
    return label(dataset, "reading")


if __name__ == "__main__":
    study_file, *output = sys.argv[1:] or ["workflow/config/paper.yaml"]
    the_study = load_study(study_file)
    toy = the_study.name == "smoke"
    sizes = (SMOKE_SAMPLES, SMOKE_ROWS, 1) if toy else (SAMPLES, ROWS, TURNS)
    beside = Path(output[0]).parent if output else None
    with tempfile.TemporaryDirectory(dir=beside) as scratch:
        reading = measure(*sizes, Path(scratch))
    if output:
        save(reading, output[0], "reading", the_study)
