"""Studies as unlike as users' are, small enough for a test, and their datasets."""

import numpy as np
import yaml
from made import made, on_few_surfaces, with_few_passages
from studies import CONFIG, PAPER_CONTENT

from lube.grid.operating_points import operating_points
from lube.rig.simulator import simulated_revolutions
from lube.stages.film import film_table
from lube.storage.netcdf import save
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study


def _small(name, **changes):
    """The paper's study on coarse lines, whose layer is weak: as many segments break as do in the
    paper's. Changes replace whole sections."""
    # Direct runs for the paper's ranges take minutes.
    content = PAPER_CONTENT | {"name": name, "realisations": 8, "batch_size": 8}
    content["uncertainty"] = None
    content["roughness"] = content["roughness"] | {"points": 40_000}
    content["boundary_layer"] = content["boundary_layer"] | {"shear_strength": "0.2 MPa"}
    content["rig"] = content["rig"] | {"sampling_rate": "20 kHz", "revolutions": 3}
    return content | changes


def _grid(force, speed, temperature, slide_to_roll_ratio=(0,)):
    return {
        "force": {"values": list(force), "units": "N"},
        "speed": {"values": list(speed), "units": "rpm"},
        "temperature": {"values": list(temperature), "units": "degC"},
        "slide_to_roll_ratio": list(slide_to_roll_ratio),
    }


def _trace(force, speed, temperature, **more):
    levels = {"force": f"{force} N", "speed": f"{speed} rpm", "temperature": f"{temperature} degC"}
    return levels | more


_SILICON_NITRIDE = {
    "radius": "20 mm",
    "young_modulus": "310 GPa",
    "poisson_ratio": 0.27,
    "ra_roughness": "0.04 um",
    "roughness": {
        "hurst_exponent": 0.8,
        "longest_wavelength": "0.15 mm",
        "roll_off_wavelength": "0.1 mm",
        "skewness": -1,
        "kurtosis": 5,
    },
}

_HONED = {"roughness": {"lay_ratio": 2, "lay_angle": "-60 deg"}}
_STEEL = {"young_modulus": "210 GPa", "poisson_ratio": 0.3}
_EXAMPLE = str(CONFIG / "surfaces/example.x3p")
_MAP = {"file": _EXAMPLE, "texture": "isotropic", "holes": "interpolate"}
_BAND = {"longest_wavelength": "200 um"}
_SCAN = {"file": "scan.csv", "texture": "along rolling", "use": "repeated line"}

STUDIES = {
    "paper": _small("paper"),
    "ceramic": _small(
        "ceramic",
        rollers=PAPER_CONTENT["rollers"] | {"second": _SILICON_NITRIDE},
        lubricants=["n-dodecane", "mobilgear-shc-xmp-320"],
        film_formulas=["moes", "dowson-higginson-minimum"],
        operating_grid=_grid([50, 150, 500], [1500, 2900.5, 6000, 12000], [40, 65, 100]),
        traces=[
            _trace(500, 1500, 100, lubricant="mobilgear-shc-xmp-320"),
            _trace(500, 1500, 100, lubricant="n-dodecane"),
        ],
    ),
    # As strong a layer as the paper's, on lines too coarse for it: almost no breakthrough is seen.
    "two-levels": _small(
        "two-levels",
        realisations=4,
        boundary_layer=PAPER_CONTENT["boundary_layer"],
        film_formulas=["paper", "pan-hamrock"],
        operating_grid=_grid([800, 1600], ["600/7", 100], [40, 80], [0, 0.1]),
    ),
    "slip": _small(
        "slip",
        film_formulas=["paper"],
        operating_grid=_grid(
            [400, 1600], [100], [60, 80], [-1, -0.1, 0, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 2]
        ),
        traces=[_trace(1600, 100, 80, slide_to_roll_ratio=0.1)],
    ),
    "measured": _small(
        "measured",
        contact_model=["line", "surface"],
        film_formulas=["paper", "moes"],
        operating_grid=_grid([200, 800, 1600], [100, 200], [50, 65, 80]),
        traces=[_trace(800, 100, 65), _trace(1600, 100, 80)],
        experiment=PAPER_CONTENT["experiment"] | {"manifest": "records.csv"},
    ),
    "shaped": _small(
        "shaped",
        film_shape="computed",
        film_formulas=["paper", "computed", "dowson-higginson-minimum"],
        operating_grid=_grid([400, 1600], [100, 200], [50, 65, 80], [0, 0.1]),
        traces=[_trace(400, 100, 65), _trace(1600, 100, 80)],
    ),
    # Unequal rollers, so that records have several alignments.
    "flattened": _small(
        "flattened",
        film_shape="computed",
        roughness_deformation="venner-1997",
        rollers=PAPER_CONTENT["rollers"] | {"second": _SILICON_NITRIDE | {"roughness": _BAND}},
        film_formulas=["computed"],
        operating_grid=_grid([200, 800], [600], [50, 80, 95]),
        traces=[_trace(800, 600, 95)],
    ),
    # The complete answer: computed film, its shape, and the roughness that it answers.
    "answered": _small(
        "answered",
        film_shape="computed",
        roughness_deformation="computed",
        rollers=PAPER_CONTENT["rollers"]
        | {"second": _STEEL | {"radius": "40 mm", "rms_roughness": "0.15 um"}},
        contact_model=["line", "surface"],
        film_formulas=["computed", "paper"],
        operating_grid=_grid([400, 1600], [100], [60, 80], [0, 1]),
        traces=[_trace(1600, 100, 80, slide_to_roll_ratio=1)],
    ),
    # A film that is thinner with slip, and at the greater force because the oil begins so near, and
    # thicker because asperities carry a share of the load.
    "corrections": _small(
        "corrections",
        film_formulas=["paper", "dowson-higginson-minimum"],
        contact_model=["surface"],
        inlet_shear_heating="zhu-cheng-1988",
        inlet_meniscus="0.4 mm",
        load_sharing="iterated",
        operating_grid=_grid([400, 1600], [100, 200], [60, 80], [0, 1]),
        traces=[_trace(1600, 100, 80, slide_to_roll_ratio=1)],
    ),
    # A ground roller, whose ridges run along rolling, on a honed one, under shaped films that both
    # surfaces answer: no line stands for them.
    "ground": _small(
        "ground",
        contact_model=["surface"],
        film_shape="computed",
        roughness_deformation="computed",
        film_formulas=["paper"],
        rollers=PAPER_CONTENT["rollers"]
        | {"second": _STEEL | {"radius": "40 mm", "rms_roughness": "0.15 um"} | _HONED},
        roughness=PAPER_CONTENT["roughness"]
        | {"points": 40_000, "lay_ratio": 4, "lay_angle": "0 deg"},
        operating_grid=_grid([400, 1600], [100], [60, 80], [0, 1]),
        traces=[_trace(1600, 100, 80, slide_to_roll_ratio=1)],
        experiment=PAPER_CONTENT["experiment"] | {"manifest": "records.csv"},
    ),
    # So fast that at the greater force, 40 degC, the heating is beyond its formula's range.
    "unknown": _small(
        "unknown",
        film_shape="computed",
        film_formulas=["paper", "computed"],
        inlet_shear_heating="zhu-cheng-1988",
        operating_grid=_grid([800, 1600], [100, 60_000], [40, 80], [0, 1]),
        traces=[
            _trace(1600, 60_000, 40, slide_to_roll_ratio=1),
            _trace(1600, 60_000, 80, slide_to_roll_ratio=1),
        ],
    ),
    # Rougher rollers at a lambda ratio of 0.02 to 2.4, which touch most of the time. At the
    # smallest force asperities would carry more than the load, at the largest merged segments hold.
    "frequent": _small(
        "frequent",
        realisations=16,
        rollers={
            name: value | {"rms_roughness": "0.3 um"} if isinstance(value, dict) else value
            for name, value in PAPER_CONTENT["rollers"].items()
        },
        boundary_layer=PAPER_CONTENT["boundary_layer"] | {"shear_strength": "0.1 MPa"},
        film_formulas=["pan-hamrock", "paper"],
        operating_grid=_grid([50, 200, 1600], [1, 5, 50], [40, 60, 90], [0, 0.1, 1]),
        traces=[_trace(1600, 5, 90), _trace(200, 5, 40)],
    ),
    # Lines drawn from the spectrum of a map, against a profile that is the line.
    "topographies": _small(
        "topographies",
        film_formulas=["paper"],
        rollers={
            "length": "5 mm",
            "first": _STEEL | {"radius": "8 mm", "topography": _MAP, "roughness": _BAND},
            "second": _STEEL | {"radius": "6 mm", "topography": _SCAN},
        },
        roughness=PAPER_CONTENT["roughness"] | {"points": 40_000, "shortest_wavelength": "7 um"},
        operating_grid=_grid([60, 120], [600, 2000], [50, 80]),
        traces=[_trace(120, 600, 80)],
    ),
    # A ground insulator on steel: no rig, and no isotropic surface.
    "insulator": _small(
        "insulator",
        film_formulas=["paper", "moes"],
        resistivity="insulator",
        rollers={
            "length": "5 mm",
            "first": _SILICON_NITRIDE | {"radius": "8 mm"},
            "second": _STEEL
            | {"radius": "8 mm", "topography": _MAP | {"texture": "along rolling"}}
            | {"roughness": _BAND},
        },
        roughness=PAPER_CONTENT["roughness"] | {"points": 40_000, "shortest_wavelength": "7 um"},
        operating_grid=_grid([60, 120], [600, 2000], [50, 80]),
        traces=[_trace(120, 600, 80)],
    ),
}


_STATED = """force [N],speed [rpm],temperature [degC],slide_to_roll_ratio,probability,lower,upper
400,100,60,0,0.02,0.01,0.03
1600,100,60,0,0.12,0.10,0.14
900,100,70,0,0.15,0.08,0.21
1600,100,80,1,0.31,0.26,0.37
"""


def write_study(content, folder):
    """Write a study and the files that it names, and return its path."""
    folder.mkdir()
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump(content), encoding="utf-8")
    _write_scan(folder / _SCAN["file"])
    manifest = content["experiment"].get("manifest")
    if manifest:
        (folder / manifest).touch()  # a study must name a file that exists
        study = load_study(path)
        if study.line_spec.follows_rolling:
            _write_records(study, folder / manifest)
        else:  # the simulated rig runs with lines
            (folder / manifest).write_text(_STATED, encoding="utf-8")
    return path


def write_datasets(content, folder):
    """Calculate a study as the workflow does, and save its datasets."""
    study = load_study(write_study(content, folder))
    with on_few_surfaces(), with_few_passages():
        datasets = made(study)
    for kind, dataset in datasets.items():
        save(dataset, folder / f"{kind}.nc", kind, study)


def _write_scan(path):
    """Write a profile of 3 mm as if it were measured."""
    position = np.arange(0.0, 3.0, 2e-3)  # mm
    waves = np.random.default_rng(1).standard_normal((60, 2))
    phases = 2.0 * np.pi * np.outer(position / 3.0, np.arange(5, 65) * 1.3)
    heights = 0.03 * (np.cos(phases) @ waves[:, 0] + np.sin(phases) @ waves[:, 1])
    columns = np.column_stack([position, heights + position])
    header = "position [mm],height [um]"
    np.savetxt(path, columns, "%.8g", ",", header=header, comments="")


def _write_records(study, manifest):
    """Write records of the simulated rig as if they were measured, some beside the levels."""
    oil = lubricant_table(study.lubricants, [50.0, 63.2, 65.0, 80.0])
    forces, speeds = [203.0, 800.0, 1203.0, 1600.0], [100.0, 200.0]
    film = film_table(oil, study.rollers, forces, speeds, ["paper"])
    points = operating_points(film.isel(film_formula=0), 0.0)
    voltages = {}
    for _, number, revolution in simulated_revolutions(study, points):
        voltages.setdefault(number, []).append(revolution.voltage(study.rig))
    rows = ["file,force [N],speed [rpm],temperature [degC]"]
    for number, parts in voltages.items():
        name = f"measurement-of-november-by-bench-two-{number:02d}.csv"
        voltage = np.concatenate(parts)
        times = np.arange(voltage.size) / study.rig.sampling_rate
        columns = np.column_stack([times, 1e3 * voltage])
        header = "time [s],voltage [mV]"
        np.savetxt(manifest.with_name(name), columns, "%.8g", ",", header=header, comments="")
        conditions = (
            str(points[level][number].item()) for level in ("force", "speed", "temperature")
        )
        rows.append(",".join([name, *conditions]))
    manifest.write_text("\n".join(rows), encoding="utf-8")
