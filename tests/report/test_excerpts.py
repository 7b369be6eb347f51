"""What the report takes from the README is there."""

import pytest
from studies import ROOT

from lube.report.excerpts import excerpts

README = (ROOT / "README.md").read_text("utf-8")


@pytest.mark.parametrize(
    ("part", "words", "rows"),
    [
        ("assumptions", "viscosity of Mobilgear SHC XMP 320", 15),
        ("files", "<code>contact.nc</code>", 10),
        ("limits", "Lyashenko", 0),
        ("pipeline", "──► film", 0),
    ],
)
def test_the_readme_is_where_the_words_stand(part, words, rows):
    html = excerpts(README)[part]
    assert words in html
    assert html.count("<tr>") >= rows
    assert "|" not in html.replace("| ", "") or part == "pipeline"
