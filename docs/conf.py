"""Sphinx configuration: ``sphinx-build -W docs build/docs`` makes the site, without a network."""

from contextlib import suppress
from pathlib import Path

import nbformat
from docutils.nodes import SkipChildren, SkipNode
from docutils.writers.html5_polyglot import HTMLTranslator

import lube
from lube.pipeline.figure_list import FURTHER
from lube.report.markdown import title_and_text

project = "lube"
author = copyright = "The authors of lube"
version = release = lube.__version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx_design",
]
# README.md is the start page on GitHub; index.md includes it.
exclude_patterns = ["README.md", "paper"]
nitpicky = True
# Docstrings name modules and functions of the inside, which have no page.
nitpick_ignore_regex = [("py:obj", r"lube\.schema|lube\.\w+\..+")]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3

# Types, shapes and units stand in the docstrings.
autodoc_typehints = "none"
autodoc_default_options = {"exclude-members": "model_config"}
autodoc_member_order = "bysource"
autosummary_generate = False
default_role = "autolink"
numpydoc_show_class_members = False

html_theme = "furo"
html_title = f"lube {release}"
html_math_renderer = "mathml"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False

PARAMETERS = {"parameters", "injected-parameters"}
RESULTS = Path("../results")
STUDIES = ("paper", "slip", "smoke")
"""The study that shows a figure in the gallery is the first of these that has it."""


def setup(app):
    """Add the gallery, and formulas as MathML, which browsers show without a network."""
    app.add_html_math_renderer("mathml", (_mathml, None), (_mathml, None))
    app.connect("env-get-outdated", lambda *_: ["gallery"])
    app.connect("source-read", _fill_gallery)


def _mathml(translator, node):
    translator.math_output, translator.math_options = "mathml", ""
    is_block = node.tagname == "math_block"
    translator.body.append('<div class="math">' if is_block else "")
    with suppress(SkipChildren):
        HTMLTranslator.visit_math(translator, node)
    translator.body.append("</div>" if is_block else "")
    raise SkipNode


def _fill_gallery(app, page, source):
    if page == "gallery":
        source[0] += "\n\n".join(_chapters(app.srcdir / RESULTS))


def _chapters(results):
    """Write every chapter of the gallery, from the executed notebooks, in Markdown."""
    shown = {}
    for study in STUDIES:
        for path in sorted(results.glob(f"{study}/notebooks/*.ipynb")):
            if (results / study / "figures" / f"{path.stem}.png").exists():
                shown.setdefault(path.stem, (study, nbformat.read(path, as_version=4).cells))
    chapters = {}
    for name, (study, cells) in sorted(shown.items()):
        tags = [*cells[0].metadata.get("tags", ()), f"chapter-{FURTHER}"]
        chapter = next(tag for tag in tags if tag.startswith("chapter-"))
        chapters.setdefault(chapter, []).append(_figure(name, study, cells))
    for chapter, figures in chapters.items():
        heading = chapter.removeprefix("chapter-").replace("-", " ").capitalize()
        yield "\n\n".join([f"## {heading}", *figures])


def _figure(name, study, cells):
    title, caption = title_and_text(cells[0].source)
    image = RESULTS / study / "figures" / f"{name}.png"
    blocks = [f"### {title}", f"![{title}]({image.as_posix()})", caption]
    blocks.append(f"````{{dropdown}} Notebook {name} of the study {study}")
    for cell in cells:
        if cell.cell_type == "code" and not PARAMETERS & {*cell.metadata.get("tags", ())}:
            blocks.append(f"```python\n{cell.source}\n```")
            printed = [out.text for out in cell.outputs if out.output_type == "stream"]
            blocks += [f"```text\n{text.rstrip()}\n```" for text in printed]
    return "\n\n".join([*blocks, "````"])
