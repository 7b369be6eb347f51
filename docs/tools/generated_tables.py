"""Rewrite the generated tables of the documentation between their markers.

``python docs/tools/generated_tables.py docs/*.md``
"""

import re
import sys
from pathlib import Path

from lube.report.key_tables import table


def with_tables(text: str) -> str:
    """Rewrite the tables of a text.

    Parameters
    ----------
    text : str
        Markdown with pairs of lines ``<!-- table: NAME -->`` and ``<!-- end -->``.

    Returns
    -------
    str
        The text with the present tables between the markers.
    """
    return re.sub(
        r"(<!-- table: (\w+) -->\n).*?(?=<!-- end -->)",
        lambda match: f"{match[1]}{table(match[2])}\n",
        text,
        flags=re.DOTALL,
    )


if __name__ == "__main__":
    for name in sys.argv[1:]:
        page = Path(name)
        page.write_text(with_tables(page.read_text(encoding="utf-8")), encoding="utf-8")
