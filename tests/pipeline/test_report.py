"""The report of a study: one file that holds all figures with their words, and needs no other."""

import base64
import json
import re
import shutil
from html import unescape

import pytest

from lube.report.markdown import plain, title_and_text, to_html


@pytest.fixture(scope="module")
def report(published):
    """The report of the smoke study, as text."""
    return (published.results / "report.html").read_text("utf-8")


@pytest.fixture(scope="module")
def held(report):
    """The data within the report, by their names."""
    return {name: data(report, name) for name in ("workflow-desc", "results", "categories")}


def data(report, name):
    return json.loads(
        re.search(rf'<script id="{name}">\s*var \w+ = (.*);$', report, re.MULTILINE)[1]
    )


def first_cell(smoke, figure):
    cells = json.loads((smoke / f"notebooks/{figure}.ipynb").read_text("utf-8"))["cells"]
    return title_and_text("".join(cells[0]["source"]))


def page(held, name):
    uri = held["results"][f"results/smoke/report/{name}.html"]["data_uri"]
    return base64.b64decode(uri.split("base64,")[1]).decode("utf-8")


def test_the_report_needs_no_other_file_and_no_network(report, held):
    # What the libraries within could ask for stands in their own code.
    without_code = re.sub(r"(<script[^>]*>).*?</script>", r"\1</script>", report, flags=re.DOTALL)
    captions = [result["caption"] for result in held["results"].values()]
    pages = [page(held, name) for name in ("assumptions", "configuration", "run_times")]
    for shown in (without_code, held["workflow-desc"], *captions, *pages):
        assert not re.search(r"""<(?!a )\w+[^>]*\s(src|href)=(?!["']?data:)""", shown)
        assert not re.search(r"@import|url\((?!data:)", shown)
    assert "<script>" in without_code and "https" not in without_code
    assert len(report) < 20e6


def test_every_figure_is_in_its_chapter_as_png_and_pdf(smoke, held):
    chapters = {
        chapter: [path for paths in groups.values() for path in paths]
        for chapter, groups in held["categories"].items()
    }
    about = chapters.pop("About the study")
    assert len(about) == 3
    shown = [path for chapter in sorted(chapters) for path in chapters[chapter]]
    assert sorted(shown) == sorted(
        f"results/smoke/figures/{figure}.{suffix}"
        for figure in smoke.notebooks
        for suffix in ("png", "pdf")
    )
    assert sorted(chapters) == ["1 Oil and film", "2 Contact", "3 Simulation and rig"]
    for path in shown:
        data = base64.b64decode(held["results"][path]["data_uri"].split("base64,")[1])
        assert data == (smoke / path).read_bytes()


def test_every_figure_has_the_words_of_its_notebook(smoke, held):
    for figure in smoke.notebooks:
        title, text = first_cell(smoke, figure)
        assert len(text) > 100
        for suffix in ("png", "pdf"):
            result = held["results"][f"results/smoke/figures/{figure}.{suffix}"]
            assert result["labels"]["Shows"] == plain(title)
            assert to_html(text) in result["caption"]


def test_the_start_page_describes_the_study_and_leads_to_every_figure(smoke, held):
    start = held["workflow-desc"]
    assert "system-message" not in start and "{{" not in start
    for words in ("<strong>smoke</strong>", "Mobilgear", "seed 20181109", "lambda ratio",
                  "Lyashenko", "contact.nc", "results/smoke", "Assumptions"):  # fmt: skip
        assert words in start
    for figure in smoke.notebooks:
        assert f'resultPath: "results/smoke/figures/{figure}.png"' in start
        assert plain(first_cell(smoke, figure)[0]) in unescape(start)


def test_the_pages_show_configuration_assumptions_and_run_times(smoke, held):
    assert "first.young_modulus</code></td><td>210 GPa</td>" in page(held, "configuration")
    text = (smoke / "docs/assumptions.md").read_text("utf-8")
    model = text.partition("## In the paper's study")[0]
    cells = [row.split("|")[1].strip() for row in model.splitlines() if row.startswith("|")][2:]
    assert len(cells) > 8
    # Its steel is the paper's, its grid is not.
    assert "<td>steel</td>" in page(held, "assumptions")
    assert "125 points" not in page(held, "assumptions")
    for cell in cells:
        assert f"<td>{to_html(cell)[3:-4]}</td>" in page(held, "assumptions")
    times = page(held, "run_times")
    jobs = {path.stem for path in (smoke.results / "benchmarks").iterdir()}
    for job in jobs - {"pages", "times"}:
        assert f"<code>{job}</code>" in times


def test_the_documentation_makes_the_pages_and_nothing_else(spare):
    spare.append("docs/limits.md", "changed")
    planned = spare.all_planned()
    assert {name for name in planned if name.startswith("report/")} == {
        f"report/{name}.html"
        for name in ("facts", "findings", "limits", "files", "pipeline", "configuration",
                     "assumptions")
    }  # fmt: skip
    assert all(name.endswith(".html") for name in planned)


def test_on_a_narrow_screen_the_menu_is_a_bar_that_opens(report, tmp_path):
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs the package playwright")
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        pytest.skip("needs Chromium")
    (tmp_path / "report.html").write_text(report, encoding="utf-8")
    with sync_api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        shown = browser.new_page(viewport={"width": 400, "height": 800})
        shown.goto((tmp_path / "report.html").as_uri())
        menu, chapter = (
            shown.locator("#app > div > nav"),
            shown.get_by_role("link", name="2 Contact"),
        )
        chapter.wait_for(state="attached")
        shown.wait_for_function("document.querySelector('#app > div > nav').clientHeight < 40")
        assert shown.locator("h1.title").bounding_box()["width"] > 300
        menu.locator("> h1").hover()
        shown.wait_for_function("document.querySelector('#app > div > nav').clientHeight > 200")
        chapter.click()
        shown.get_by_role("cell", name="Breakthrough probability").first.wait_for()
        browser.close()
