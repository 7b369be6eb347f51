"""The examples of the documentation run and print what it says; its site is complete."""

import contextlib
import io
import re
import subprocess
import sys
from doctest import NORMALIZE_WHITESPACE, OutputChecker

import pytest
import xarray as xr
from markdown_it import MarkdownIt
from studies import PAPER, ROOT

from lube.lazy import homes
from lube.physics.pressure_viscosity import roelands_slope
from lube.stages import film_table, load_study, lubricant_table

USES = """
import lube
import pint

rollers, oil = lube.Rollers("50 mm", "0.2 um"), lube.Oil("mobilgear-shc-xmp-320")
force, rest = pint.UnitRegistry().Quantity(800.0, "N"), ("0.5 m/s", "60 degC")
lube.required_film(rollers, force)
lube.trace(rollers, oil, (800, "N"), *rest)
lube.film(rollers, oil, ([400, 800], "N"), *rest)
lube.film(rollers, oil, 800.0, *rest)  # type: ignore[arg-type]
lube.trace(rollers, oil, ["400 N"], *rest)  # type: ignore[arg-type]
lube.trace(rollers, oil, "400 N", *rest, film_shape="round")  # type: ignore[arg-type]
lube.duty("day.csv", rollers, oil, contact_model=["strip"])  # type: ignore[list-item]
lube.plan(rollers, oil, "400 N", *rest, rig="mtm")  # type: ignore[arg-type]
"""
"""What the types allow; mypy must find a mistake in each line that it should ignore."""
PAGES = [ROOT / "README.md", *sorted(ROOT.glob("docs/*.md"))]


def code_blocks(page):
    """Language and content of every block of code, in order."""
    tokens = MarkdownIt().parse(page.read_text(encoding="utf-8"))
    return [(token.info, token.content) for token in tokens if token.type == "fence"]


def pages_with(language, slow=()):
    """Parametrise a test by the pages with code in a language; some of them take long."""
    pages = [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] if page.stem in slow else [])
        for page in PAGES
        if language in dict(code_blocks(page))
    ]
    return pytest.mark.parametrize("page", pages)


@pytest.fixture
def folder(smoke, tmp_path, monkeypatch):
    """A folder like the reader's: the studies, an oil, and results of three studies."""
    for name in ("workflow", "lube"):
        (tmp_path / name).symlink_to(smoke / name)
    for block in (content for _, content in code_blocks(ROOT / "docs/oil.md")):
        if name := re.match(r"# ([\w-]+\.(yaml|csv))\n", block):
            (tmp_path / name[1]).write_text(block, encoding="utf-8")
    results = tmp_path / "results"
    (results / "paper").mkdir(parents=True)
    for name in ("smoke", "my-study"):
        (results / name).symlink_to(smoke.results)
    with xr.open_dataset(smoke.results / "contact.nc") as contact:  # the paper's has no slip
        contact.isel(slide_to_roll_ratio=[0]).to_netcdf(results / "paper/contact.nc")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pages_with("python", slow=("python",))
def test_examples_run_and_print_what_follows_them(page, folder):
    names, printed = {}, ""
    for language, content in code_blocks(page):
        if language == "python":
            with contextlib.redirect_stdout(io.StringIO()) as output:
                exec(content, names)
            printed = output.getvalue()
        elif language == "text":
            assert OutputChecker().check_output(content, printed, NORMALIZE_WHITESPACE), printed


def test_examples_have_the_types_that_the_package_promises(tmp_path):
    for page in PAGES:
        blocks = [content for language, content in code_blocks(page) if language == "python"]
        if blocks:
            (tmp_path / f"{page.stem.replace('-', '_')}.py").write_text("\n".join(blocks), "utf-8")
    (tmp_path / "uses.py").write_text(USES, "utf-8")
    command = [sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", tmp_path]
    command += ["--no-incremental", "--warn-unused-ignores"]
    checked = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert checked.returncode == 0, checked.stdout


@pages_with("yaml")
def test_studies_are_valid(page, folder):
    for language, content in code_blocks(page):
        if language == "yaml" and content.startswith("based_on:"):
            (folder / "my-study.yaml").write_text(content, encoding="utf-8")
            load_study(folder / "my-study.yaml")


def test_every_shipped_study_is_listed():
    page = (ROOT / "docs/studies.md").read_text(encoding="utf-8")
    for path in (ROOT / "workflow/config").glob("*.yaml"):
        assert f"| `{path.name}` |" in page


def test_the_site_is_built_without_warnings_and_shows_everything(smoke, tmp_path):
    command = [sys.executable, "-m", "sphinx", "-qW", "--keep-going", smoke / "docs", tmp_path]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    pages = {
        path.relative_to(tmp_path).as_posix(): path.read_text(encoding="utf-8")
        for path in tmp_path.rglob("*.html")
    }
    for name, text in pages.items():  # scripts, styles and pictures come without a network
        assert not re.search(r'(src|<link [^>]*href)="(https?:)?//', text), name
    assert "<math" in pages["theory.html"] and "$" not in pages["theory.html"]
    for figure in smoke.notebooks:
        assert f"{figure}.png" in pages["gallery.html"]
    documented = "".join(text for name, text in pages.items() if name.startswith("api/"))
    for package in ("lube", "lube.stages"):
        for name in homes(package):
            assert f'id="{package}.{name}"' in documented, f"put {name} into docs/api/"


def test_both_films_of_golds_coefficient_are_those_of_the_code():
    text = (ROOT / "docs/limits.md").read_text(encoding="utf-8")
    study = load_study(PAPER)
    points = re.findall(
        r"^  \| (\d+) N, (\d+) r/min, (\d+) °C \| ([\d.]+) and ([\d.]+) µm"
        r" \| ([\d.]+) and ([\d.]+) µm",
        text,
        re.MULTILINE,
    )
    assert len(points) == 3
    for force, speed, temperature, *stated in points:
        oil = lubricant_table(study.lubricants, [float(temperature)])
        slope = oil["pressure_viscosity_coefficient"].copy()
        viscosity = oil["dynamic_viscosity"].item()
        secant = slope.copy(data=[[roelands_slope(slope.item(), viscosity, "secant", 200e6)]])
        if temperature == "40":
            pair = f"{1e9 * secant.item():.1f} 1/GPa for {1e9 * slope.item():.1f} at 40 °C"
            assert pair in text
        found = []
        for coefficient in (slope, secant):
            table = oil.assign(pressure_viscosity_coefficient=coefficient)
            point = [float(force)], [float(speed)], ["paper", "computed"]
            films = film_table(table, study.rough_rollers, *point)["film_thickness"]
            found += [f"{1e6 * film:.3f}" for film in films.values.ravel()]
        assert found == stated, (force, speed, temperature)


def test_the_times_of_the_readmes_commands_are_ranges():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    times = re.findall(r"(\w+ \w+ \w+) minutes", text)
    assert len(times) == 2
    assert all(re.fullmatch(r"\w+ to \w+", time) for time in times), times


def test_the_number_of_the_surface_is_that_of_areal_nc_with_its_command():
    text = " ".join((ROOT / "docs/measurements.md").read_text(encoding="utf-8").split())
    assert re.search(
        r"[\d.]+ \(95 % interval [\d.]+ to [\d.]+\) by importance sampling "
        r"\(`areal.nc` of the paper's study, by `snakemake areal_contact`\)",
        text,
    )
