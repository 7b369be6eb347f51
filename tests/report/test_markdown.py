"""Markdown of notebooks and README, as the report shows it."""

import json
from html import unescape
from html.parser import HTMLParser

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt
from studies import ROOT

from lube.report.markdown import escaped, inline, plain, section, title_and_text, to_html

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
TEXTS = [(ROOT / "README.md").read_text("utf-8")] + [
    "".join(cell["source"])
    for path in NOTEBOOKS
    for cell in json.loads(path.read_text("utf-8"))["cells"]
    if cell["cell_type"] == "markdown"
]


@pytest.mark.parametrize(
    ("markdown", "html"),
    [
        ("as *it* is", "as <em>it</em> is"),
        ("**(a), (b)** how", "<strong>(a), (b)</strong> how"),
        ("**the `code`**", "<strong>the <code>code</code></strong>"),
        ("`a*b*c` and ``a`b``", "<code>a*b*c</code> and <code>a`b</code>"),
        ("`results/<name>`", "<code>results/&lt;name&gt;</code>"),
        ("a < b & c > d", "a &lt; b &amp; c &gt; d"),
        ("2 * 3 * 4, snake_case_name", "2 * 3 * 4, snake_case_name"),
        (r"\*not\* bold", "*not* bold"),
        ("costs $5 and $6", "costs $5 and $6"),
        ("[paper](https://a.org/b?c=1&d=2)", '<a href="https://a.org/b?c=1&amp;d=2">paper</a>'),
        ("[the *record*](lube/x.yaml)", "the <em>record</em>"),
        ("![a picture](workflow/docs/x.png)", "a picture"),
    ],
)
def test_marks_within_a_paragraph(markdown, html):
    assert inline(markdown) == html


@pytest.mark.parametrize(
    ("tex", "pieces"),
    [
        ("h_0", ["<msub><mi>h</mi><mn>0</mn></msub>"]),
        (r"1/\sqrt{R}", ["<msqrt><mi>R</mi></msqrt>"]),
        (r"E^*\Delta x", ["<msup>", "Δ"]),
        (r"C_{1D} \propto q^{-2H-1}", ["∝", "<mo>−</mo>"]),
    ],
)
def test_mathematics_becomes_mathml(tex, pieces):
    html = inline(f"so ${tex}$ (Eq. 6)")
    assert html.startswith("so <math") and html.endswith("</math> (Eq. 6)")
    assert all(piece in html for piece in pieces)
    assert "$" not in html and "\\" not in html


def test_a_formula_that_is_not_understood_is_shown_as_typed():
    assert inline(r"$\nonsense{x<y}$") == r"<code>\nonsense{x&lt;y}</code>"


@pytest.mark.parametrize(
    ("markdown", "html"),
    [
        ("one\ntwo\n\nthree", "<p>one two</p>\n<p>three</p>"),
        ("## A `b`", "<h2>A <code>b</code></h2>"),
        ("- a\n  more\n- b", "<ul>\n<li>a more</li>\n<li>b</li>\n</ul>"),
        ("1. a\n2. b", "<ol>\n<li>a</li>\n<li>b</li>\n</ol>"),
        ("so:\n- a\n\nend", "<p>so:</p>\n<ul>\n<li>a</li>\n</ul>\n<p>end</p>"),
        ("- a\n  - b", "<ul>\n<li>a\n<ul>\n<li>b</li>\n</ul></li>\n</ul>"),
        ("- a\n\n  b", "<ul>\n<li>a\n<p>b</p></li>\n</ul>"),
        ("```python\n# a < b\n\nc\n```\nd", "<pre># a &lt; b\n\nc</pre>\n<p>d</p>"),
        ("```\nnever closed", "<pre>never closed</pre>"),
        ("<!-- table: x -->\na", "<p>a</p>"),
        ("", ""),
    ],
)
def test_blocks(markdown, html):
    assert to_html(markdown) == html


def test_a_table_keeps_its_cells():
    html = to_html("| a | `b` |\n| --- | :-: |\n| 1 \\| 2 | |\nafter")
    assert "<tr><th>a</th><th><code>b</code></th></tr>" in html
    assert "<tr><td>1 | 2</td><td></td></tr>" in html
    assert html.endswith("<p>after</p>")


def test_a_title_is_parted_from_its_text():
    assert title_and_text("# The *title*\n\ntext\n") == ("The *title*", "text")
    assert title_and_text("text alone") == ("", "text alone")
    assert title_and_text("") == ("", "")
    assert plain("The *title* of `a<b` & more") == "The title of a<b & more"


def test_a_section_ends_with_the_next_of_its_level():
    text = "# A\n\n## B\nb\n### C\nc\n```\n## no heading\n```\n## D\nd"
    assert section(text, "B") == "b\n### C\nc\n```\n## no heading\n```"
    assert section(text, "D") == "d"
    assert section(text, "E") == ""


class _Balance(HTMLParser):
    """Follow the tags of some HTML, all of which must be closed in order."""

    def __init__(self):
        super().__init__()
        self.open, self.words = [], []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if not {"code", "pre"} & set(self.open):
            self.words.append(data)


def words_of(html):
    parser = _Balance()
    parser.feed(html)
    parser.close()
    assert parser.open == []
    return "".join(parser.words)


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: text.splitlines()[0])
def test_the_studys_own_texts_leave_no_mark_behind(text):
    words = words_of(to_html(text))
    for mark in ("**", "`", "$", "](", "\\", "---"):
        assert mark not in words


@given(st.text(alphabet="ab `*$|-#\\[]()<>&1.\n_", max_size=60))
def test_any_text_is_turned_into_closed_tags(text):
    words_of(to_html(text))


@given(st.text("ab1 \\`*_<>[]()#&;~|$+-.!=:é", max_size=20).map(str.strip).filter(bool))
def test_escaped_words_are_shown_as_they_are(words):
    html = MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(escaped(words))
    assert html.startswith("<p>") and html.endswith("</p>\n")
    assert unescape(html[3:-5]) == words
