"""`lube new`: studies that can be run at once; nothing is overwritten, nothing left behind."""

import os

import pytest
from editors import complaints
from studies import PAPER_CONTENT

from lube import Oil, Rollers, contact_probability
from lube.cli import main
from lube.errors import LubeError
from lube.recordings.manifest import read_manifest
from lube.stages import (
    contact_statistics,
    film_table,
    lubricant_table,
    roughness_lines,
    with_intervals,
)
from lube.study.resolve import resolved_content
from lube.study.study import load_study
from lube.study.text_files import read_yaml


@pytest.fixture
def new(tmp_path, monkeypatch, capsys):
    """Call ``lube new`` in an empty folder; its exit status and what it said."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        code = main(["new", *arguments])
        return code, "".join(capsys.readouterr())

    return call


def test_without_options_it_is_the_papers_study_with_waves_up_to_the_usual_cutoff(new):
    assert new("mine.yaml") == (0, "Written: mine.yaml\nNext: lube check mine.yaml\n")
    own = {"name": "mine", "about": {"title": "mine", "creators": [], "date": None}}
    waves = {"longest_wavelength": "0.8 mm", "shortest_wavelength": "3.1416 um"}
    own["roughness"] = PAPER_CONTENT["roughness"] | waves
    own["film_formulas"] = sorted(
        set(PAPER_CONTENT["film_formulas"]) - {"paper"}, key=PAPER_CONTENT["film_formulas"].index
    )
    longest = {"range": "-50 % to 0 %", "source": "assumed"}
    own["uncertainty"] = PAPER_CONTENT["uncertainty"] | {"longest_wavelength": longest}
    content = resolved_content("mine.yaml")
    assert content | {"name": "mine"} == PAPER_CONTENT | own
    assert load_study("mine.yaml").band == "waves 800 µm to 3.14 µm"


def test_it_has_the_numbers_of_the_rollers_of_a_notebook_to_the_last_bit(new):
    options = ("--radius", "2 1.5 mm", "--roughness", "0.1 um", "--force", "5 9 N")
    new("mine.yaml", *options, "--speed", "100 rpm", "--temperature", "60 degC")
    study = load_study("mine.yaml")
    rollers = Rollers("2 mm", "0.1 um", second={"radius": "1.5 mm"})
    assert rollers.lines == study.line_spec
    assert (rollers.pair, rollers.layer) == (study.rollers, study.boundary_layer)
    oil = lubricant_table(study.lubricants, [60.0])
    film = film_table(oil, study.rough_rollers, [5.0, 9.0], [100.0], ["moes"])
    lines = roughness_lines(study.line_spec, study.seed, range(4))
    contact = with_intervals(contact_statistics(lines, film, study.boundary_layer), film)
    found = contact_probability(
        rollers, Oil(study.lubricants[0].name), force=["5 N", "9 N"], speed="100 rpm",
        temperature="60 degC", film_formula="moes", realisations=4, seed=study.seed,
    )  # fmt: skip
    wanted = contact["breakthrough_probability_mean"].squeeze().values
    assert found["breakthrough_probability_mean"].values.tolist() == wanted.tolist()
    assert 0.0 < wanted[0] < wanted[1]


def test_with_all_options_each_value_arrives_in_its_place(new, tmp_path):
    (tmp_path / "rig").touch()
    code, said = new(
        "studies/mine.yaml",
        "--radius",
        "50",
        "30",
        "mm",
        "--roughness",
        "0.3 um",
        "--force",
        "400",
        "800",
        "N",
        "--speed",
        "1.5,",
        "2",
        "Hz",
        "--temperature",
        "320 340 K",
        "--oil",
        "n-dodecane",
        "--realisations",
        "8",
        "--records",
        "rig/records.csv",
    )
    assert code == 2 and "rig/records.csv: cannot be written" in said
    assert not list(tmp_path.glob("**/*.*"))
    (tmp_path / "rig").unlink()
    arguments = "studies/mine.yaml --radius 50 30 mm --roughness 0.3 um --force 400 800 N --speed"
    arguments += " 1.5, 2 Hz --temperature 320 340 K --oil n-dodecane --realisations 8 --records"
    code, said = new(*arguments.split(), "rig/records.csv")
    assert said == (
        "Written: studies/mine.yaml\nWritten: rig/records.csv\nNext: lube check studies/mine.yaml\n"
    )
    study = load_study("studies/mine.yaml")
    assert (study.rollers.first.radius, study.rollers.second.radius) == (0.05, 0.03)
    assert study.rollers.first.rms_roughness == study.rollers.second.rms_roughness == 3e-7
    assert study.roughness.points == 1_000_000
    assert study.operating_grid.force == (400.0, 800.0)
    assert study.operating_grid.speed == pytest.approx((90.0, 120.0))
    assert study.operating_grid.temperature == pytest.approx((46.85, 66.85))
    assert study.trace_points[0]["force"] == 800.0
    assert study.trace_points[0]["speed"] == pytest.approx(90.0)
    assert [oil.name for oil in study.lubricants] == ["n-dodecane"]
    assert study.realisations == 8
    assert os.path.samefile(study.experiment.manifest, "rig/records.csv")
    assert read_manifest("rig/records.csv").entries == ()
    assert not complaints("study", read_yaml("studies/mine.yaml", LubeError))


def test_another_radius_keeps_the_spacing_of_the_grid(new):
    new("small.yaml", "--radius", "15 mm")
    study = load_study("small.yaml")
    assert study.roughness.points == 300_000
    assert study.line_spec.spacing == pytest.approx(3.14159e-7, rel=1e-5)


def test_nothing_is_overwritten_and_nothing_left_of_what_is_refused(new, tmp_path):
    new("mine.yaml")
    (tmp_path / "records.csv").write_text("file\n")
    before = {path: path.read_text() for path in tmp_path.iterdir()}
    for arguments, expected in (
        (["mine.yaml"], "mine.yaml: exists already, need a new name"),
        (["mine.txt"], "got mine.txt, need the name of a .yaml file"),
        (["My study.yaml"], "name: got 'My study', need lower-case letters"),
        (["a.yaml", "--force", "100"], "--force: got '100', need numbers with a unit"),
        (
            ["a.yaml", "--radius", "12,5 mm"],
            "--radius: got '12,5 mm', need numbers with a unit, and spaces",
        ),
        (["a.yaml", "--force", "1", "2", "mm"], "--force: wrong dimension or unit 'mm'"),
        (["a.yaml", "--radius", "1 2 3 mm"], "--radius: got '1 2 3 mm', need one number, or one"),
        (["a.yaml", "--force", "200 100 N"], "need rising levels"),
        (["a.yaml", "--temperature", "-10 0 degC"], "got -10 degC, need 40 to 100 degC"),
        (["a.yaml", "--realisations", "0"], "realisations: got 0, need at least 1"),
        (["a.yaml", "--oil", "water"], "got 'water', need one of base-oil"),
        (["a.yaml", "--oil", "my oil.yaml"], "my oil.yaml: cannot be read"),
    ):
        code, said = new(*arguments)
        assert code == 2
        assert said.startswith("Error: ") and expected in said and said.count("\n") == 1
    assert new("b.yaml", "--records", "records.csv")[0] == 0
    (tmp_path / "b.yaml").unlink()
    assert {path: path.read_text() for path in tmp_path.iterdir()} == before
