"""What a change makes again: exactly what depends on it, by dry runs."""

import json
import os
import re

import pytest
from repository import SMOKE, figures_of, products_of

CONTACT_BATCHES = {"batches/contact_0.nc", "batches/contact_2.nc"}
MASTER_BATCHES = {"batches/master_0.nc", "batches/master_2.nc"}
LINE_BATCHES = {"batches/roughness_0.nc", "batches/roughness_2.nc"}
BATCHES = CONTACT_BATCHES | MASTER_BATCHES | LINE_BATCHES


def made(repository, *datasets, batches=()):
    """The named datasets, what follows from them, the batches, and the figures that use them.

    What makes contact.nc anew makes master.nc: both need the lines, which are temporary, and
    Snakemake makes again whatever uses a file that it makes again. What concerns both contact
    and trace, films, lines or layer, concerns the simulated rig as well.
    """
    made = set(datasets)
    if {"contact", "trace"} <= made:
        made |= {"rig", "experiment"}
    if "contact" in made:
        made |= {"master", "comparison", "gauge"}
    if "experiment" in made:
        made |= {"comparison"}
    if "comparison" in made:
        made |= {"gauge"}
    files = {f"{name}.nc" for name in made}
    return files | set(batches) | figures_of(repository, *made)


def everything(repository):
    names = ("lubricant", "film", "roughness", "contact", "trace")
    return made(repository, *names, batches=BATCHES)


# Nothing changed


def test_touching_every_source_without_changing_it_makes_nothing(spare):
    # Scripts are left out: Snakemake goes by their times, and by contents elsewhere.
    for folder in ("lube", "notebooks", "workflow/rules", "workflow/config"):
        for path in (spare / folder).rglob("*.*"):
            os.utime(path)
    assert spare.planned() == set()


def test_the_same_study_under_another_file_name_makes_nothing(spare):
    assert spare.planned(spare.with_values()) == set()


def test_a_moved_repository_makes_nothing(spare):
    # `spare` itself is a copy in another place.
    assert "Nothing to be done" in spare.run()


def test_the_plan_is_what_a_dry_run_announces(spare):
    study = spare.with_values(kept_realisations=[0, 1])
    announced = spare.run("--dry-run", study=study)
    counted = dict(re.findall(r"^(\w+) +(\d+)$", announced.split("Job stats")[1], re.MULTILINE))
    planned = spare.planned(study)
    figures = {name for name in planned if name.startswith("notebooks/")}
    assert int(counted.get("trace", 0)) == 1
    assert int(counted.get("figure", 0)) == len(figures)
    # The lines, the trace, both jobs of the report's pages, and `all`.
    assert int(counted["total"]) == len(figures) + 5


# A module of lube, a script, a record


@pytest.mark.parametrize(
    ("module", "datasets", "batches"),
    [
        ("lubricant", ("lubricant", "film", "contact", "trace"), BATCHES),
        ("film", ("film", "contact", "trace"), BATCHES),
        ("formulas", ("film", "contact", "trace"), BATCHES),
        ("regimes", ("film", "contact", "trace"), BATCHES),
        ("viscosity", ("lubricant", "film", "contact", "trace"), BATCHES),
        ("roughness", ("roughness", "contact", "trace"), BATCHES),
        ("kernels/synthesis", ("roughness", "contact", "trace"), BATCHES),
        ("contact", ("contact",), BATCHES),
        ("kernels/layer", ("contact", "trace"), BATCHES),
        ("ensemble", ("contact",), ()),
        ("trace", ("trace",), ()),
        ("resistance", ("trace", "rig", "experiment"), ()),
        ("kernels/circuit", ("rig", "experiment"), ()),
        ("rig", ("rig", "experiment"), ()),
        ("evaluation", ("rig", "experiment"), ()),
        ("experiment", ("experiment",), ()),
        ("rig_records", ("rig",), ()),
        ("manifest", ("experiment",), ()),
        ("folding", ("experiment",), ()),
        ("one_pair", ("experiment",), ()),
        ("at_records", ("comparison",), ()),
        ("comparison", ("comparison",), ()),
        ("curves", ("gauge",), ()),
        ("gauge", ("gauge",), ()),
        ("plots", (), ()),
        ("reference", (), ()),
    ],
)
def test_a_module_makes_what_imports_it_and_what_follows(spare, module, datasets, batches):
    spare.append(f"lube/{module}.py", "# changed")
    planned = spare.planned()
    expected = made(spare, *datasets, batches=batches)
    importing = figures_importing(spare, module)
    assert expected | importing == planned


def figures_importing(repository, module):
    """Files of the figures whose notebooks import a module by itself, and not through others."""
    name = module.replace("/", ".")
    pattern = rf"from lube\.{name} import|from lube import [^\n]*\b{name}\b|import lube\.{name}\b"
    found = set()
    for figure in repository.notebooks:
        text = (repository / f"notebooks/{figure}.ipynb").read_text("utf-8")
        if re.search(pattern, text):
            found |= products_of(figure)
    return found


@pytest.mark.parametrize("module", ["io", "jobs"])
def test_what_all_jobs_import_makes_all_datasets(spare, module):
    spare.append(f"lube/{module}.py", "# changed")
    assert spare.planned() == everything(spare)


def test_how_a_study_is_read_makes_nothing_while_its_values_stay(spare):
    spare.append("lube/study/study.py", "# changed")
    assert spare.planned() == set()


def test_the_execution_of_notebooks_makes_all_figures_and_no_dataset(spare):
    spare.append("lube/workflow/notebooks.py", "# changed")
    planned = spare.planned()
    assert planned == {name for figure in spare.notebooks for name in products_of(figure)}


def test_a_script_makes_its_own_stage_and_what_follows(spare):
    spare.append("workflow/scripts/trace.py", "# changed")
    assert spare.planned() == made(spare, "trace")


def test_a_lubricants_record_makes_what_follows_from_it(spare):
    spare.append("lube/study/lubricants/mobilgear-shc-xmp-320.yaml", "# changed")
    assert spare.planned() == made(spare, "lubricant", "film", "contact", "trace", batches=BATCHES)


def test_another_lubricants_record_makes_nothing(spare):
    spare.append("lube/study/lubricants/n-dodecane.yaml", "# changed")
    assert spare.planned() == set()


# A notebook


@pytest.fixture
def edit_notebook(spare):
    """Change a notebook, as Jupyter would write it, and return its figure's name."""

    def edit(change):
        figure = spare.notebooks[-1]
        path = spare / f"notebooks/{figure}.ipynb"
        notebook = json.loads(path.read_text("utf-8"))
        change(notebook)
        path.write_text(json.dumps(notebook, indent=1), encoding="utf-8")
        return figure

    return edit


def last_of(notebook, kind):
    return [cell for cell in notebook["cells"] if cell["cell_type"] == kind][-1]


@pytest.mark.parametrize("kind", ["code", "markdown"])
def test_a_changed_cell_makes_that_figure_alone(spare, edit_notebook, kind):
    def change(notebook):
        cell = last_of(notebook, kind)
        cell["source"] = ["# changed\n", *cell["source"]]

    figure = edit_notebook(change)
    assert spare.planned() == products_of(figure)


def test_saving_outputs_counts_and_metadata_makes_nothing(spare, edit_notebook):
    def change(notebook):
        cell = last_of(notebook, "code")
        cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["done\n"]}]
        cell["execution_count"] = 7
        cell["metadata"]["collapsed"] = True
        notebook["metadata"]["language_info"]["version"] = "3.99"

    edit_notebook(change)
    assert spare.planned() == set()


def test_a_new_notebook_makes_its_own_figure(spare):
    text = (spare / f"notebooks/{spare.notebooks[0]}.ipynb").read_text("utf-8")
    (spare / "notebooks/fig99_mine.ipynb").write_text(text, encoding="utf-8")
    assert spare.planned() == products_of("fig99_mine")


def test_a_public_name_of_the_package_is_followed_to_its_module(spare, edit_notebook):
    def change(notebook):
        last_of(notebook, "code")["source"] = ["from lube import gather\n", "%matplotlib inline\n"]

    figure = edit_notebook(change)
    spare.run("--touch")
    assert spare.planned() == set()
    spare.append("lube/stages/ensemble.py", "# changed")
    assert products_of(figure) <= spare.planned()


# A value of the study


@pytest.mark.parametrize(
    ("changes", "datasets", "batches"),
    [
        ({"resistivity": "0.3 uohm*m"}, ("trace", "rig", "experiment"), ()),
        ({"rig__noise": "30 uV"}, ("rig", "experiment"), ()),
        ({"rig__drift": 0.1}, ("rig", "experiment"), ()),
        ({"experiment__debounce": "1 ms"}, ("rig", "experiment"), ()),
        ({"traces": [{"force": "800 N", "speed": "100 rpm", "temperature": "40 degC"}]},
         ("trace", "rig"), ()),
        ({"boundary_layer__critical_thickness": "6 nm"}, ("contact", "trace"), BATCHES),
        ({"boundary_layer__shear_strength": "2 MPa"}, ("contact", "trace"), BATCHES),
        ({"seed": 1}, ("roughness", "contact", "trace"), BATCHES),
        ({"roughness__hurst_exponent": 0.8}, ("roughness", "contact", "trace"), BATCHES),
        ({"operating_grid__slide_to_roll_ratio": [0, 0.2]}, ("contact", "trace"), BATCHES),
        ({"revolutions": 2}, ("contact",), BATCHES),
        ({"kept_realisations": [0, 1]}, ("roughness", "trace"), ()),
        ({"film_formulas": ["paper"]}, ("film", "contact", "trace"), BATCHES),
        ({"rollers__length": "12 mm"},
         ("film", "roughness", "contact", "trace"), BATCHES),
        ({"operating_grid__temperature": {"values": [40, 60, 80], "units": "degC"}},
         ("lubricant", "film", "contact", "trace"), BATCHES),
        ({"roughness__shortest_wavelength": "12 points"},
         ("roughness", "contact", "trace"), BATCHES),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)  # fmt: skip
def test_a_value_makes_what_depends_on_it(spare, changes, datasets, batches):
    study = spare.with_values(**changes)
    assert spare.planned(study) == made(spare, *datasets, batches=batches)


def test_more_realisations_make_the_new_ones_only(spare):
    study = spare.with_values(realisations=6)
    new = {f"batches/{stage}_4.nc" for stage in ("contact", "master", "roughness")}
    assert spare.planned(study) == made(spare, "contact", batches=new)


def test_fewer_realisations_only_gather_anew(spare):
    assert spare.planned(spare.with_values(realisations=2)) == made(spare, "contact")


def test_another_batch_size_leaves_the_kept_lines_and_the_trace(spare):
    planned = spare.planned(spare.with_values(batch_size=4))
    whole = {f"batches/{stage}_0.nc" for stage in ("contact", "master", "roughness")}
    assert planned == made(spare, "contact", batches=whole)


def test_comments_and_order_of_the_study_file_make_nothing(spare):
    spare.append(SMOKE, "# changed")
    assert spare.planned() == set()


# The paper's study


def test_bare_snakemake_is_the_papers_study(spare):
    announced = spare.run("--dry-run", study=None)
    assert "results/paper/contact.nc" in announced
    assert "results/smoke" not in announced
    assert re.search(r"^contact_batch +8$", announced, re.MULTILINE)
