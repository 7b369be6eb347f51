"""What the report takes from the README is there."""

from pathlib import Path

import pytest

from lube.excerpts import excerpts

README = (Path(__file__).parents[1] / "README.md").read_text("utf-8")


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
