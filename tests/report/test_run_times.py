"""Run times in the report, and the page that holds them."""

import pytest

from lube.report.pages import render
from lube.report.run_times import run_times

HEAD = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"


@pytest.fixture
def measured(tmp_path):
    """Write what Snakemake measures of a job, and return the file's name."""

    def write(name, seconds, memory):
        path = tmp_path / f"{name}.tsv"
        path.write_text(f"{HEAD}{seconds}\t0:00:01\t{memory}\t1\t1\t1\t0\t0\t50\t1\n")
        return str(path)

    return write


def test_times_are_added_up_by_steps_and_the_longest_job_is_named(measured):
    jobs = {
        "film": [measured("film", 1.5, 150.2)],
        "contact, in batches": [measured("contact_0", 100.0, 270), measured("contact_8", 50, 900)],
    }
    html = run_times(jobs)
    assert "<strong>3 jobs</strong> took <strong>2 min 32 s</strong>" in html
    assert "<strong>contact_0</strong> with 1 min 40 s" in html
    assert "900 MB, was used by <strong>contact_8</strong>" in html
    step = next(line for line in html.splitlines() if "in batches" in line)
    assert "<td>2</td><td>2 min 30 s</td>" in step and "width: 99.0%" in step
    names = [line for line in html.splitlines() if line.startswith("<tr><td><code>")]
    assert [name.split("code>")[1][:-2] for name in names] == ["contact_0", "contact_8", "film"]
    assert "2 h 5 min" in run_times({"contact": [measured("contact", 7530.0, 1)]})


def test_short_and_missing_jobs(measured):
    html = run_times({"film": [measured("film", 0.05, "NA")], "trace": ["nowhere.tsv"]})
    assert "too short to measure" in html and "trace" not in html
    assert "No job" in run_times({"trace": ["nowhere.tsv"]})


def test_a_page_holds_its_style_and_escapes_its_title():
    page = render("page.html", title="a < b", body="<p>text</p>")
    assert page.startswith("<!doctype html>") and "<p>text</p>" in page
    assert page.count("a &lt; b") == 2 and page.count("font-size") > 3
