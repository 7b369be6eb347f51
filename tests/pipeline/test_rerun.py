"""What a change reruns: exactly what depends on it, by Snakemake's own plan.

Which files a script depends on is tested in test_sources.py, which values a stage depends on in
tests/study/test_study.py.
"""

import json
import os
import re

import pytest
from repository import SMOKE, figures_of, products_of
from studies import SMOKE_DATASETS

from lube.schema import forerunners
from lube.study.study import load_study

BATCHES = {f"batches/{stage}_{first}.nc" for stage in ("contact", "master") for first in (0, 2)}


def after(repository, *changed):
    """Datasets of the changed stages and of those that follow, with the figures that use them."""
    made = {kind for kind in SMOKE_DATASETS if {kind, *forerunners(kind)} & set(changed)}
    return {f"{kind}.nc" for kind in made} | figures_of(repository, *made)


def test_changed_modules_rerun_the_jobs_that_import_them_and_what_follows(spare):
    spare.append("lube/stages/trace.py", "# changed")
    spare.append("lube/stages/gauge.py", "# changed")
    spare.append("lube/study/study.py", "# changed")  # which works by its values alone
    spare.append("lube/study/lubricants/n-dodecane.yaml", "# not of this study")
    change_record(spare, "title: ", "title: New ")
    assert spare.planned() == after(spare, "trace", "gauge")


def test_a_changed_lubricant_record_reruns_what_follows(spare):
    change_record(spare, "335 mm^2/s", "336 mm^2/s")
    assert spare.planned() == after(spare, "lubricant") | BATCHES


def change_record(repository, old, new):
    """Change a text in the record of the study's lubricant."""
    record = repository / "lube/study/lubricants/mobilgear-shc-xmp-320.yaml"
    text = record.read_text(encoding="utf-8")
    assert old in text
    record.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.parametrize(
    ("changes", "stages", "batches"),
    [
        ({"rig__noise": "30 uV", "realisations": 6}, ("experiment", "rig", "contact", "master"),
         {"batches/contact_4.nc", "batches/master_4.nc"}),
        ({"seed": 1},
         ("roughness", "contact", "tail", "height_distribution", "master", "trace", "experiment"),
         BATCHES),
    ],
    ids=["rig and realisations", "seed"],
)  # fmt: skip
def test_a_changed_value_reruns_the_stages_that_use_it_and_what_follows(
    spare, changes, stages, batches
):
    assert spare.planned(spare.with_values(**changes)) == after(spare, *stages) | batches


# Notebooks


def change_notebook(repository, figure, change):
    """Change a notebook, as Jupyter would write it."""
    path = repository / f"notebooks/{figure}.ipynb"
    notebook = json.loads(path.read_text("utf-8"))
    change(notebook, [cell for cell in notebook["cells"] if cell["cell_type"] == "code"][-1])
    path.write_text(json.dumps(notebook, indent=1), encoding="utf-8")


def test_unchanged_contents_and_saved_outputs_rerun_nothing_and_a_changed_cell_its_figure(spare):
    def save_outputs(notebook, cell):
        cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["done\n"]}]
        cell["execution_count"] = 7
        notebook["metadata"]["language_info"]["version"] = "3.99"

    def change_cell(notebook, cell):
        cell["source"] = ["# changed\n", *cell["source"]]

    *_, saved, changed = spare.notebooks
    change_notebook(spare, saved, save_outputs)
    change_notebook(spare, changed, change_cell)
    # `spare` is a copy at another path. Snakemake goes by the times of scripts, which stay.
    for folder in ("lube", "notebooks", "workflow/rules", "workflow/config"):
        for path in (spare / folder).rglob("*.*"):
            os.utime(path)
    assert spare.planned(spare.with_values()) == products_of(changed)


# Which study


def test_bare_snakemake_is_the_papers_study(spare):
    announced = spare.run("--dry-run", study=None)
    assert "results/paper" in announced and "results/smoke" not in announced
    assert re.search(r"^batch +4$", announced, re.MULTILINE)


def test_values_on_the_command_line_make_a_study_of_their_own(spare):
    changes = ("--config", "name=mine", "seed=3", "rig={revolutions: 3}")
    said = spare.run("resolved_study", "--cores", "1", *changes)
    assert "Study: results/mine/study.yaml" in said
    mine, smoke = (load_study(spare / name) for name in ("results/mine/study.yaml", SMOKE))
    assert (mine.name, mine.seed, mine.rig.revolutions) == ("mine", 3, 3)
    changed = {"name": True, "about": True, "seed": True, "rig": {"revolutions"}}
    assert mine.model_dump(exclude=changed) == smoke.model_dump(exclude=changed)
