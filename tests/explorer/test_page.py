"""The explorer in a real browser: what a reader chooses, what the page then says and draws."""

import itertools
import re
import shutil

import numpy as np
import pytest
import xarray as xr
from bokeh.models import ColumnDataSource, LogAxis
from studies import OIL

from lube.explorer.content import CHOICES, SHOWN, page_content, page_name
from lube.explorer.figures import COLUMNS, draw
from lube.explorer.page import explorer_page
from lube.schema import POINT_DIMS, model_dependent
from lube.storage.netcdf import load

EXPLORED = ("lubricant", "film", "contact", "tail", "master", "trace", "comparison")
FLAGS = ("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run")
FLAGS += ("--disable-background-networking", "--disable-component-update", "--disable-sync")
BAND = "waves 800 µm to 3.14 µm"


@pytest.fixture(scope="module")
def explored(files, with_assumptions):
    """The datasets that the page is made of; at one point no contact, and at one a lot."""
    datasets = {kind: load(files / f"{kind}.nc", kind).load() for kind in EXPLORED}
    for name, none, much in (
        ("contact breakthrough_probability_mean", 0.0, 0.41234),
        ("contact breakthrough_probability_lower", 0.0, 0.4),
        ("contact breakthrough_probability_upper", 2e-7, 0.43),
        ("tail breakthrough_probability", 1.234e-15, 0.42345),
        ("tail breakthrough_probability_lower", 1.2e-15, 0.41),
        ("tail breakthrough_probability_upper", 1.3e-15, 0.44),
        ("tail breakthrough_rate", 1e-9 / 3.6, 1e3),
        ("tail breakthrough_rate_lower", 0.9e-9 / 3.6, 0.9e3),
        ("tail breakthrough_rate_upper", 1.1e-9 / 3.6, 1.1e3),
    ):
        kind, variable = name.split()
        datasets[kind][variable].loc[{"temperature": 40.0}] = none
        datasets[kind][variable].loc[{"temperature": 80.0}] = much
    return with_assumptions(datasets)


@pytest.fixture(scope="module")
def counted(explored):
    """The same without importance sampling, as where heights are not Gaussian."""
    tail = xr.full_like(explored["tail"], np.nan).assign_attrs(remarks="roughness: not Gaussian")
    return explored | {"tail": tail}


@pytest.fixture(scope="module")
def page_file(explored, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "explorer.html"
    path.write_text(explorer_page(explored, BAND), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def counted_file(counted, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "counted.html"
    path.write_text(explorer_page(counted, BAND), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser():
    """Chromium, or a reason why not."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs the package playwright")
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        pytest.skip("needs Chromium")
    with sync_api.sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=program, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def visit(browser):
    """Open a page, and afterwards check that it had no error and used no network."""
    opened, wrong = [], []

    def open_page(path, address="", **device):
        context = browser.new_context(**device)
        opened.append(context)
        page = context.new_page()
        page.on(
            "console",
            lambda said: wrong.append(said.text) if said.type in ("error", "warning") else None,
        )
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on(
            "request", lambda one: wrong.append(one.url) if one.url.startswith("http") else None
        )
        page.goto(f"{path.as_uri()}{address}")
        page.wait_for_function("document.getElementById('probability').textContent !== ''")
        return page

    yield open_page
    for context in opened:
        context.close()
    assert wrong == []


# What the page says


def rounded(number):
    """A number as a reader meets it, with three digits."""
    return f"{float(f'{number:.3g}'):g}"


def percent(share):
    return f"{rounded(100.0 * share.item())}\u00a0%"


def choose(page, name, index):
    """Move a control, as a hand does: a slider by its keys."""
    if name == "film_formula":
        page.locator(f"#control-{name} select").select_option(index=index)
    else:
        page.locator(f"#control-{name} .noUi-handle").press("End" if index else "Home")


def said(page):
    """All that the page says of the chosen point."""
    return page.evaluate(
        """() => ({
            ...Object.fromEntries(["probability", "interval", "film", "lambda", "regime", "valid"]
                .map((id) => [id, document.getElementById(id).textContent])),
            digits: Object.fromEntries([...document.querySelectorAll("#digits tr")]
                .map((row) => [...row.cells].map((cell) => cell.textContent))),
        })"""
    )


def test_every_control_moves_and_every_number_is_the_datasets(visit, explored, page_file):
    page = visit(page_file)
    film, contact = explored["film"], explored["contact"]
    variables = {
        page_name(kind, name): explored[kind][name]
        for kind, names in SHOWN.items()
        for name in names
    }
    several = [name for name in CHOICES if contact.sizes[name] > 1]
    assert several == ["film_formula", "force", "speed", "temperature", "slide_to_roll_ratio"]
    before = {}
    for indices in list(itertools.product(range(2), repeat=len(several)))[::3]:
        place = dict(zip(several, indices, strict=True))
        for name, index in place.items() - before.items():
            choose(page, name, index)
        before = place
        words = said(page)
        for name, array in variables.items():
            here = {dim: place.get(dim, 0) for dim in array.dims}
            value, digits = array.isel(here).item(), words["digits"][name]
            if isinstance(value, bool):
                value = str(value).lower()
            assert float(digits) == value if isinstance(value, float) else digits == str(value)
        at = {name: contact[name].values[place.get(name, 0)] for name in CHOICES}
        here = film.sel({name: level for name, level in at.items() if name in film.dims})
        assert words["film"] == f"{rounded(1e6 * here['film_thickness'].item())}\u00a0µm"
        assert words["lambda"] == rounded(here["lambda_ratio"].item())
        assert ("within" if here["in_validity_range"] else "outside") in words["valid"]
        meaning = film["regime"].attrs["flag_meanings"].split()[here["regime"].item()]
        assert words["regime"] == meaning.replace("_", ", ")
        if place["temperature"]:
            assert words["probability"] == "42.3\u00a0%"
            assert words["interval"] == "of the time; 95 % interval 41\u00a0% to 44\u00a0%"
            often = "3.6 × 10⁶ breakthroughs per hour (3.24 × 10⁶ to 3.96 × 10⁶)"
        else:
            assert words["probability"] == "1.23 × 10⁻¹³\u00a0%"
            interval = "1.2 × 10⁻¹³\u00a0% to 1.3 × 10⁻¹³\u00a0%"
            assert words["interval"] == f"of the time; 95 % interval {interval}"
            often = "1 × 10⁻⁶ breakthroughs per hour (9 × 10⁻⁷ to 1.1 × 10⁻⁶)"
        assert page.inner_text("#rate") == f"{often}, on average over pairs of rollers"
        # The assumptions are of the first film formula and in pure rolling.
        is_assumed = at["slide_to_roll_ratio"] == 0.0 and not place["film_formula"]
        bands = [
            f"{words}: {percent(here[f'{name}_lower'])} to {percent(here[f'{name}_upper'])}"
            for words, name, here in (
                ("one pair, 95 %", "breakthrough_probability_pair", contact.sel(at)),
                (
                    "assumptions, 5 to 95 % of means",
                    "breakthrough_probability",
                    explored["sensitivity"].sel({dim: at[dim] for dim in POINT_DIMS}),
                ),
            )
        ]
        assert page.inner_text("#bands") == "; ".join(bands if is_assumed else bands[:1])


def test_a_probability_of_zero_is_drawn_by_its_upper_limit(visit, explored, tmp_path):
    tail = explored["tail"].copy(deep=True)
    for end, value in (("", 0.0), ("_lower", 0.0), ("_upper", 0.02)):
        tail[f"breakthrough_probability{end}"][:] = value
    path = tmp_path / "zero.html"
    path.write_text(explorer_page(explored | {"tail": tail}, BAND), encoding="utf-8")
    page = visit(path)
    assert drawn(page, "chosen")["limit"] == [0.02] and drawn(page, "chosen")["mean"] == [None]
    assert "no contact seen" in page.inner_text(".key")
    assert said(page)["interval"] == "of the time; 95 % interval 0\u00a0% to 2\u00a0%"


def test_without_importance_sampling_the_realisations_are_counted(visit, counted_file):
    page = visit(counted_file, "#temperature=80")
    assert said(page)["probability"] == "41.2\u00a0%"
    assert said(page)["interval"] == "of the time; 95 % interval 40\u00a0% to 43\u00a0%"
    assert drawn(page, "along")["limit"] == [2e-7, None]
    choose(page, "temperature", 0)
    assert said(page)["probability"] == "<\u00a02 × 10⁻⁵\u00a0%"
    assert said(page)["interval"] == "of the time: no contact was seen; 95 % upper limit"
    assert page.locator("#rate").count() == 0
    assert "no contact seen" in page.inner_text(".key")


@pytest.mark.parametrize(
    ("is_heated", "words"), [(False, "heating, not applied"), (True, "heating")]
)
def test_the_values_say_whether_heating_thins_the_film(visit, explored, tmp_path, is_heated, words):
    """Where the oil deforms the roughness, an unheated film has the slide-to-roll ratio, too."""
    film = explored["film"]
    stored = film["film_thickness"].broadcast_like(film["slide_to_roll_ratio"])
    film = film.assign(film_thickness=stored.assign_attrs(film["film_thickness"].attrs))
    path = tmp_path / "explorer.html"
    path.write_text(explorer_page(explored | {"film": film}, BAND, is_heated), encoding="utf-8")
    assert f"Film reduction by inlet shear {words}\t" in visit(path).inner_text("#values")


def test_beside_importance_sampling_the_count_is_among_the_values(visit, page_file):
    page = visit(page_file, "#temperature=80")
    table = page.inner_text("#values")
    assert "counted in the realisations\t41.2\u00a0% (40\u00a0% to 43\u00a0%)" in table
    assert "no contact seen" not in page.inner_text(".key")
    page.locator("summary").click()
    assert page.inner_text("#python").endswith("point.breakthrough_probability")


def drawn(page, source):
    """Points that a figure draws."""
    return page.evaluate(
        """(name) => {
            const columns = Object.entries(Bokeh.documents[0].get_model_by_name(name).data);
            const plain = (one) => (Number.isNaN(one) ? null : one);
            return Object.fromEntries(columns.map(([key, values]) => [key, values.map(plain)]));
        }""",
        source,
    )


def test_the_figures_draw_the_chosen_point_where_the_datasets_have_it(visit, explored, page_file):
    page = visit(page_file, "#force=1600&temperature=80&film_formula=pan-hamrock")
    at = {"lubricant": OIL, "film_formula": "pan-hamrock", "force": 1600.0, "temperature": 80.0}
    here = explored["film"].sel(at).isel(speed=1)
    chosen = drawn(page, "chosen")
    for name, expected in {
        "lambda": here["lambda_ratio"].item(),
        "M": here["moes_load"].item(),
        "L": here["moes_material"].item(),
        "width": 2e6 * here["contact_half_width"].item(),
        "film": 1e6 * here["film_thickness"].item(),
        "mean": 0.42345,
        "x": 80.0,
    }.items():
        assert chosen[name] == [expected]
    along = drawn(page, "along")
    assert along["x"] == [40.0, 80.0]
    assert along["limit"] == [None, None] and along["mean"] == [1.234e-15, 0.42345]
    assert len(drawn(page, "grid")["x"]) == 8 and len(drawn(page, "force")["x"]) == 4


def test_a_touched_point_is_chosen_and_the_address_keeps_it(visit, page_file):
    page = visit(page_file, "#force=800&temperature=40")
    assert "temperature=40" in page.url
    pixel = page.evaluate(
        """() => {
            const figure = Bokeh.documents[0].get_model_by_name("figure-film");
            const view = Bokeh.index.find_one(figure);
            const {x_scale, y_scale} = view.frame;
            const {x, film} = Bokeh.documents[0].get_model_by_name("along").data;
            const box = view.el.getBoundingClientRect();
            return [box.x + x_scale.compute(x[1]), box.y + y_scale.compute(film[1])];
        }"""
    )
    page.mouse.click(*pixel)
    page.wait_for_function("location.hash.includes('temperature=80')")
    assert said(page)["probability"] == "42.3\u00a0%"
    again = visit(page_file, f"#{page.url.partition('#')[2]}")
    assert said(again) == said(page)


def test_a_trace_is_drawn_where_one_was_kept_and_found_from_elsewhere(visit, explored, page_file):
    page = visit(page_file, "#speed=85.71428571428571")
    assert not page.locator("#traces").is_visible()
    page.get_by_role("button", name="1600 N, 100 r/min, 80 °C").click()
    assert page.locator("#traces").is_visible()
    trace = explored["trace"].isel(operating_point=1)
    length = 1e6 * trace["contact_length"].values
    for part in ("whole", "close"):
        assert max(drawn(page, part)["length"]) == pytest.approx(length.max(), rel=1e-15)
    share = 100 * (length > 0).mean()
    assert f"in contact {rounded(share)}\u00a0% of this" in page.inner_text("#trace-text")
    assert page.inner_text("#trace-text").endswith("and around the peak in every step.")


def test_of_an_insulator_the_trace_is_drawn_without_a_resistance(visit, explored, tmp_path):
    resistance = explored["trace"]["contact_resistance"]
    trace = explored["trace"].assign(contact_resistance=xr.full_like(resistance, np.nan))
    study = {kind: each for kind, each in explored.items() if kind != "comparison"}
    path = tmp_path / "insulator.html"
    path.write_text(explorer_page(study | {"trace": trace}, BAND), encoding="utf-8")
    page = visit(path)
    for part in ("whole", "close"):
        longest = 1e6 * trace["contact_length"].isel(operating_point=0).values.max()
        assert max(drawn(page, part)["length"]) == pytest.approx(longest, rel=1e-15)
    assert page.locator("#figure-close_length canvas").count() > 0
    assert page.locator("[id$=_resistance]").count() == 0
    assert "resistance" not in page.inner_text("body").lower()


def test_of_rollers_without_a_line_the_page_shows_contacts_along_the_rollers(
    visit, explored, files, tmp_path
):
    traces = load(files / "surface_trace.nc", "surface_trace").load()
    study = {kind: explored[kind] for kind in ("lubricant", "film")}
    study |= {"tail": explored["tail"].expand_dims(contact_model=["surface"])}
    path = tmp_path / "surfaces.html"
    path.write_text(explorer_page(study | {"surface_trace": traces}, BAND), encoding="utf-8")
    page = visit(path)
    point = traces.isel(operating_point=0)
    touching, lengths = point["contacts"].values, 1e6 * point["contact_length"].values
    words = f"at {rounded(touching.mean())} places at once on average, and "
    words += f"{percent(np.mean(lengths > 0.0))} of this time a boundary layer is broken"
    assert words in page.inner_text("body")
    np.testing.assert_allclose(drawn(page, "whole")["length"], lengths, rtol=1e-15)
    assert not page.locator("#close-up").is_visible()
    assert "Contact of: surface" in page.inner_text("body")
    assert "realisation" not in page.inner_text("body")


def test_records_near_the_point_are_told_with_their_intervals(visit, explored, page_file):
    page = visit(page_file, "#force=1600&temperature=80")
    comparison = explored["comparison"].isel(film_formula=0)
    near = (comparison["force_level"] == 1600.0) & (comparison["temperature_level"] == 80.0)
    near &= (comparison["speed_level"] == 100.0) & (comparison["slide_to_roll_ratio"] == 0.0)
    record = comparison.isel(record=near.values.argmax())
    text = page.inner_text("#records")
    assert text.startswith(f"Simulated record {record['record'].item()}: in contact ")
    share = rounded(100 * record["measured_share"].item())
    assert f"in contact {share}\u00a0% of the time" in text


def test_a_record_is_told_with_what_the_chosen_contact_model_predicts(visit, explored, tmp_path):
    models = xr.DataArray(["line", "surface"], dims="contact_model", name="contact_model")
    study = explored | {"tail": xr.concat([explored["tail"]] * 2, models, data_vars="minimal")}
    by_line, names = explored["comparison"], model_dependent("comparison")
    limits = {f"predicted_share_{end}": 0.9 for end in ("lower", "upper")}
    by_surface = by_line.assign(
        {name: xr.full_like(by_line[name], limits[name]) for name in limits}
    )
    by_both = xr.concat([by_line[names], by_surface[names]], models)
    by_both = by_line.drop_vars(names).merge(by_both)
    of_lines, of_rollers = {"line": "lines: "}, {"surface": "rollers: 90\u00a0% to 90\u00a0%"}
    for comparison, expected in (
        (by_both, of_lines | of_rollers),
        (by_line, {"surface": "lines: "}),
    ):
        path = tmp_path / "both.html"
        page = explorer_page(study | {"comparison": comparison}, BAND)
        path.write_text(page, encoding="utf-8")
        for model, predicted in expected.items():
            page = visit(path, f"#force=1600&temperature=80&contact_model={model}")
            assert f"predicted for one pair of {predicted}" in page.inner_text("#records")


# How it looks


def test_a_phone_shows_it_without_sideways_scrolling_in_legible_letters(visit, page_file):
    phone = {"viewport": {"width": 375, "height": 667}, "is_mobile": True, "has_touch": True}
    page = visit(page_file, **phone)
    page.locator("summary").click()
    assert page.evaluate("document.documentElement.scrollWidth") <= 375
    sizes = page.evaluate(
        """[...document.querySelectorAll("body *")]
            .filter((one) => one.checkVisibility() && one.textContent.trim())
            .map((one) => parseFloat(getComputedStyle(one).fontSize))"""
    )
    assert min(sizes) >= 13.0
    handle = page.locator("#control-force .noUi-handle").bounding_box()
    assert min(handle["width"], handle["height"]) >= 24.0
    for canvas in page.locator(".bk-Canvas").all():
        box = canvas.bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= 375


# Other studies


TITLE = "My <b>rollers</b> & oil </script>"


def one_point(explored):
    """A study with a single operating point, without a record, with marks in its title."""
    at = {name: explored["trace"][name].values[0] for name in CHOICES}
    picked = dict(explored)
    for kind in ("lubricant", "film", "contact", "tail"):
        dims = explored[kind].dims
        picked[kind] = explored[kind].sel({name: [at[name]] for name in CHOICES if name in dims})
    picked["trace"] = explored["trace"].isel(operating_point=[0])
    picked["master"] = explored["master"].isel(contact_width=[0])
    picked["comparison"] = explored["comparison"].isel(record=[])
    picked["film"].attrs["title"] = f"{TITLE}, film"
    return picked


def two_oils(explored):
    """A study with a second oil, whose films are twice as thick."""
    picked = dict(explored)
    for kind in ("lubricant", "film", "contact", "tail"):
        second = explored[kind].assign_coords(lubricant=["second"])
        if kind == "film":
            second["film_thickness"] = 2.0 * second["film_thickness"]
        both = [explored[kind], second]
        picked[kind] = xr.concat(both, "lubricant", data_vars="minimal", compat="equals")
    return picked


def test_a_study_of_one_point_has_no_control_and_no_map(visit, explored, tmp_path):
    path = tmp_path / "one.html"
    path.write_text(explorer_page(one_point(explored), BAND), encoding="utf-8")
    page = visit(path)
    assert page.inner_text("h1") == TITLE
    assert page.locator("[id^=control-]").count() == 0
    assert page.locator(".fixed").all_inner_texts() == [
        "Oil: mobilgear-shc-xmp-320",
        "Film formula: paper",
        "Force: 800 N",
        "Speed: 100 r/min",
        "Temperature: 40 °C",
    ]
    assert page.locator("#figure-map").count() == 0
    assert "record" not in page.inner_text(".key")
    assert said(page)["probability"] == "1.23 × 10⁻¹³\u00a0%"


def test_of_several_oils_one_is_chosen(visit, explored, tmp_path):
    path = tmp_path / "two.html"
    path.write_text(explorer_page(two_oils(explored), BAND), encoding="utf-8")
    page = visit(path)
    before = float(said(page)["digits"]["film_thickness"])
    page.locator("#control-lubricant select").select_option("second")
    assert float(said(page)["digits"]["film_thickness"]) == 2.0 * before


def test_every_logarithmic_axis_has_labels_and_no_share_above_one(explored, counted):
    for study in (explored, counted, one_point(explored)):
        sources = {name: ColumnDataSource() for name in COLUMNS}
        for plot in draw(page_content(study), study, sources).values():
            for axis, span in ((plot.xaxis[0], plot.x_range), (plot.yaxis[0], plot.y_range)):
                if isinstance(axis, LogAxis):
                    assert len(axis.ticker.ticks) >= 2
                    assert span.start <= min(axis.ticker.ticks)
                    assert max(axis.ticker.ticks) <= span.end
                    if "probability" in axis.axis_label:
                        assert max(axis.ticker.ticks) == 1.0
                        assert axis.major_label_overrides[1.0] == "100 %"
                        names = axis.major_label_overrides.values()
                        assert len(set(names)) == len(names) <= 10


def test_the_page_is_small_stamped_and_complete(explored, page_file):
    text = page_file.read_text("utf-8")
    assert len(text) < 5e6
    commit = explored["contact"].attrs["code_commit"][:10]
    assert re.search(rf"<footer>study smoke · config [0-9a-f]{{10}} · commit {commit}", text)
    assert not re.search(r"""<(script|img|link)[^>]+(src|href)=["']?http""", text)
