"""The smoke study as a whole: everything made, nothing made twice, the same bytes always."""

import json
import re

import pytest
from figure_checks import draw
from repository import FEW, ROOT, SMOKE, figures_in, products_of
from studies import SMOKE_DATASETS

from lube.inference.study_shares import over_grid
from lube.schema import STAGES, check
from lube.storage.netcdf import load
from lube.study.study import load_study


def test_all_datasets_figures_notebooks_and_the_explorer_are_made_and_nothing_unfinished_is_left(
    smoke,
):
    expected = {f"{kind}.nc" for kind in SMOKE_DATASETS}
    expected |= {name for figure in smoke.notebooks for name in products_of(figure)}
    expected.add("explorer.html")
    assert smoke.notebooks
    assert set(smoke.products()) == expected
    assert not list(smoke.results.rglob("*.part"))


def test_every_dataset_fits_the_schema_and_says_what_it_was_made_from(smoke):
    study = load_study(smoke / SMOKE)
    for kind in SMOKE_DATASETS:
        attributes = check(load(smoke.results / f"{kind}.nc", kind), kind).attrs
        assert attributes["study"] == "smoke"
        assert attributes["source"].startswith("simulation by lube ")
        assert set(json.loads(attributes["config"])) == {*study.forerunners(kind), kind}
        read = {f"{name}.nc" for name in STAGES[kind].inputs}
        made_from = set(json.loads(attributes["inputs_sha256"]))
        assert {name for name in made_from if name.endswith(".nc")} == read


def warnings_in(notebook):
    cells = json.loads(notebook.read_text("utf-8"))["cells"]
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    return ["".join(one["text"]) for one in outputs if one.get("name") == "stderr"]


def test_notebooks_are_executed_without_warnings(smoke):
    for path in (smoke.results / "notebooks").iterdir():
        cells = json.loads(path.read_text("utf-8"))["cells"]
        assert all(cell["execution_count"] for cell in cells if cell["cell_type"] == "code")
        assert warnings_in(path) == []


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "figure", [name for name in figures_in(ROOT / "notebooks") if name not in FEW]
)
def test_every_other_figure_is_drawn_and_saved_without_warnings(figure, smoke, tmp_path):
    paths = {path.stem: path for path in smoke.results.glob("*.nc")}
    draw(ROOT / f"notebooks/{figure}.ipynb", paths, tmp_path / figure)
    assert (tmp_path / f"{figure}.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / f"{figure}.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.slow
def test_a_study_unlike_the_papers_goes_through_all_notebooks(spare):
    """Unequal rollers that slip, two oils, another formula, one level, one realisation, a film
    so thick that the first oil never lets them touch."""
    spare.take_notebooks()
    study = spare.with_values(
        name="unlike",
        realisations=1,
        kept_realisations=[0],
        rollers__second__radius="30 mm",
        lubricants=["mobilgear-shc-xmp-320", "n-dodecane"],
        film_formulas=["moes"],
        operating_grid__force={"values": [800], "units": "N"},
        operating_grid__speed={"values": [3000.5], "units": "rpm"},
        operating_grid__temperature={"values": [40], "units": "degC"},
        operating_grid__slide_to_roll_ratio=[-0.2],
        traces=[
            {"force": "800 N", "speed": "3000.5 rpm", "temperature": "40 degC", "lubricant": oil}
            for oil in ("mobilgear-shc-xmp-320", "n-dodecane")
        ],
    )
    spare.run(study=study)
    results = spare / "results/unlike"
    contact = load(results / "contact.nc", "contact")
    touching = contact["geometric_contact_probability_mean"].max("film_formula").squeeze()
    assert touching.sel(lubricant="mobilgear-shc-xmp-320") == 0.0
    assert touching.sel(lubricant="n-dodecane") > 0.5
    executed = list((results / "notebooks").iterdir())
    assert len(executed) >= len(spare.notebooks) - 1  # not the one about several slips
    for notebook in executed:
        assert warnings_in(notebook) == []


@pytest.mark.slow
def test_a_measured_surface_goes_through_the_workflow_and_its_archive(spare):
    spare.take_notebooks()
    surface = "workflow/config/surfaces/example.x3p"
    topography = {"file": surface, "texture": "isotropic", "holes": "interpolate"}
    band = {"longest_wavelength": "200 um", "shortest_wavelength": "8 um"}
    study = spare.with_values(
        name="scanned",
        rollers__first__rms_roughness=None,
        rollers__first__topography=topography,
        rollers__first__roughness=band,
        roughness__points=80_000,
        film_formulas=["paper"],
    )
    spare.run("archive", study=study)
    results = spare / "results/scanned"
    found = load(results / "surface.nc", "surface")
    assert found.hurst_exponent_lower < 0.8 < found.hurst_exponent_upper
    assert not found.remarks
    assert (results / "figures/fig23_surface.png").exists()
    assert (results / f"archive/scanned/study/{surface}").exists()
    assert "results/scanned/archive/scanned: nothing wrong" in spare.run("verify", study=study)


@pytest.mark.slow
def test_measured_records_replace_the_simulated_rig(spare):
    rows = [f"{1e-4 * number:.4f},{5 if number % 500 < 50 else 5e4}" for number in range(5000)]
    record = "\n".join(["time [s],resistance [ohm]", *rows])
    (spare / "run.csv").write_text(record, encoding="utf-8")
    manifest = (
        "file,force [N],speed [rpm],temperature [degC]\nrun.csv,800,100,40\nno.csv,1600,100,40"
    )
    (spare / "records.csv").write_text(manifest, encoding="utf-8")
    study = spare.with_values(experiment__manifest="records.csv")
    said = spare.run("results/smoke/comparison.nc", study=study)
    assert not re.search(r"^Job \d+: (Contact|Trace|Film)", said, re.MULTILINE)
    last = said.rstrip().splitlines()[-1]
    assert last.startswith("Refused: 1 of 2 records. records.csv: line 3: file: got 'no.csv'")
    experiment = load(spare.results / "experiment.nc", "experiment")
    compared = load(spare.results / "comparison.nc", "comparison")
    assert experiment.origin.item() == compared.origin.item() == "measured"
    assert compared.measured_share.values.tolist() == [0.1]
    assert compared.record.item() == "run.csv (records.csv: line 2)"
    point = {"slide_to_roll_ratio": 0.0, "force": 800, "speed": 100, "temperature": 40}
    assert over_grid(compared).measured_share.sel(point).item() == 0.1
    assert len(compared.missing.splitlines()) == 7
    spare.append("run.csv", "\n0.5,5")
    assert "experiment.nc" in spare.planned(study)  # the change of a record is noticed


def test_a_second_run_does_nothing(smoke):
    before = smoke.snapshot()
    assert "Nothing to be done" in smoke.run()
    assert smoke.snapshot() == before


def test_a_clone_runs_its_own_lube_and_not_the_installed_one(spare):
    spare.append("lube/pipeline/figure_list.py", "print('in this Snakefile')")
    spare.append("lube/stages/lubricant.py", "raise RuntimeError('in a job of this folder')")
    finished = spare.snakemake("results/smoke/lubricant.nc")
    assert "RuntimeError: in a job of this folder" in finished.stdout
    assert "in this Snakefile" in finished.stdout.partition("Building DAG of jobs")[0]


# What the terminal says


def test_each_job_says_in_words_what_is_made_and_nothing_alarms(smoke):
    said = (smoke / "said").read_text("utf-8")
    messages = re.findall(r"^Job \d+: (.*)$", said, re.MULTILINE)
    assert len(messages) == int(re.search(r"^total +(\d+)$", said, re.MULTILINE)[1])
    for message in messages:
        assert re.match(r"[A-Z][a-z ]+: \S+", message)
    assert len(set(messages)) == len(messages)
    assert not re.search(r"^(local)?rule \w+:$", said, re.MULTILINE)
    assert not re.search("error|warning|traceback|exception", said, re.IGNORECASE)
    assert [line for line in said.splitlines() if len(line) > 130] == []


def test_every_job_has_a_log_and_a_benchmark(smoke):
    logs = {path.stem for path in (smoke.results / "logs").iterdir()}
    benchmarks = {path.stem for path in (smoke.results / "benchmarks").iterdir()}
    assert {*SMOKE_DATASETS, "batch_0", "batch_2", "pages", "times"} <= logs == benchmarks
    for path in (smoke.results / "benchmarks").iterdir():
        header, values = path.read_text("utf-8").splitlines()
        assert header.startswith("s\th:m:s")
        assert float(values.split("\t")[0]) > 0.0
    progress = (smoke.results / "logs/batch_0.log").read_text("utf-8").splitlines()
    for number in (0, 1):
        assert any(line.startswith(f"realisation {number}") for line in progress)


@pytest.mark.slow
def test_benchmarks_are_measured_saved_and_drawn_when_asked_for(spare):
    spare.take_notebooks("bench*")
    before = spare.products()
    said = spare.run("benchmark")
    assert "reading.nc, with figures, in" in said
    speed = load(spare.results / "speed.nc", "speed")
    reading = load(spare.results / "reading.nc", "reading")
    for name, values in (*speed.data_vars.items(), *reading.data_vars.items()):
        assert (values > 0).all(), name
    assert speed.speedup.sel(slide_to_roll_ratio=0, least_lambda=0) > 1.0
    added = {name: now for name, now in spare.products().items() if before.get(name) != now}
    names = ("bench01_speed", "bench02_records", "bench03_coverage")
    figures = [product for name in names for product in products_of(name)]
    assert set(added) == {"speed.nc", "reading.nc", "coverage.nc", *figures}
    assert spare.planned() == set()
