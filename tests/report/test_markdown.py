"""Markdown of notebooks and documentation, as the report shows it."""

import json
import re
from html import unescape

from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt
from studies import ROOT

from lube.report.markdown import escaped, inline, plain, title_and_text, to_html


def test_formulas_between_dollars_become_mathml():
    for tex, piece in {
        "h_0": "<msub><mi>h</mi><mn>0</mn></msub>",
        r"1/\sqrt{R}": "<msqrt><mi>R</mi></msqrt>",
        r"E^*\Delta x": "Δ",
        r"C_{1D} \propto q^{-2H-1}": "∝",
    }.items():
        html = inline(f"so ${tex}$ (Eq. 6)")
        assert piece in html and "<math" in html and html.endswith("</span> (Eq. 6)")
        assert "$" not in html and "\\" not in html
    assert 'display="block"' in to_html("$$\nh_0\n$$")
    assert inline("costs $5 and $6") == "costs $5 and $6"


def test_a_formula_that_is_not_understood_is_shown_as_typed():
    assert r"<code>\nonsense{x&lt;y}</code>" in inline(r"$\nonsense{x<y}$")


def test_links_to_files_keep_their_words_only():
    assert inline("[the *record*](lube/x.yaml)") == "the <em>record</em>"
    assert inline("[paper](https://a.org/)") == '<a href="https://a.org/">paper</a>'


def test_tables_and_raw_html():
    html = to_html("| a | `b` |\n| --- | --- |\n| 1 | <b>2</b> |")
    assert "<th><code>b</code></th>" in html and "<td>&lt;b&gt;2&lt;/b&gt;</td>" in html


def test_a_title_is_split_from_its_text():
    assert title_and_text("# The *title*\n\ntext\n") == ("The *title*", "text")
    assert title_and_text("text alone") == ("", "text alone")
    assert title_and_text("") == ("", "")
    assert plain("The *title* of `a<b` & more") == "The title of a<b & more"


def test_the_notebooks_own_texts_leave_no_mark_behind():
    for path in (ROOT / "notebooks").glob("*.ipynb"):
        for cell in json.loads(path.read_text("utf-8"))["cells"]:
            if cell["cell_type"] == "markdown":
                html = re.sub("<(code|pre)>.*?</\\1>", "", to_html("".join(cell["source"])))
                assert not [mark for mark in ("**", "`", "$", "](", "\\") if mark in html], path


@given(st.text("ab1 \\`*_<>[]()#&;~|$+-.!=:é", max_size=20).map(str.strip).filter(bool))
def test_escaped_words_are_shown_as_they_are(words):
    html = MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(escaped(words))
    assert html.startswith("<p>") and html.endswith("</p>\n")
    assert unescape(html[3:-5]) == words
