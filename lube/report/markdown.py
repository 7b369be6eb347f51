"""Markdown of notebooks and documentation pages as HTML, with formulas as MathML.

Browsers show MathML without a network. A formula that cannot be converted is shown as typed.
"""

import functools
import re
from html import escape, unescape

_HEADING = re.compile(r"#{1,6}\s+(.*?)\s*#*")
_LOCAL_LINK = re.compile(r'<a href="(?!https://|http://|mailto:)[^>]*>(.*?)</a>', re.DOTALL)


def to_html(text: str) -> str:
    """Turn Markdown into HTML.

    Parameters
    ----------
    text : str
        CommonMark with tables, and formulas between dollars.

    Returns
    -------
    str
        HTML. Raw HTML in the text is escaped. A link to a file becomes plain text, because the
        report is passed on without the files around it.

    Examples
    --------
    >>> to_html("of **all** points")
    '<p>of <strong>all</strong> points</p>'
    """
    return _LOCAL_LINK.sub(r"\1", _parser().render(text)).strip()


def inline(text: str) -> str:
    """Turn Markdown without blocks, such as a heading or a table's cell, into HTML.

    Parameters
    ----------
    text : str
        Markdown.

    Returns
    -------
    str
        HTML without a surrounding paragraph.
    """
    return _LOCAL_LINK.sub(r"\1", _parser().renderInline(text))


def plain(text: str) -> str:
    """Remove the markup from a heading.

    Parameters
    ----------
    text : str
        Markdown without blocks.

    Returns
    -------
    str
        Its words.

    Examples
    --------
    >>> plain("The *film* in `film.nc`")
    'The film in film.nc'
    """
    return unescape(re.sub(r"<[^<>]*>", "", inline(text)))


def title_and_text(text: str) -> tuple[str, str]:
    """Split a text into the heading that it begins with and the rest.

    Parameters
    ----------
    text : str
        Markdown.

    Returns
    -------
    title : str
        Words of the heading, as Markdown; empty if the text begins with none.
    rest : str
        What follows the heading.
    """
    first, _, rest = text.strip().partition("\n")
    heading = _HEADING.fullmatch(first.strip())
    return (heading[1], rest.strip()) if heading else ("", text.strip())


def escaped(text: str) -> str:
    r"""Escape a line of plain words, so that Markdown shows it unchanged.

    Parameters
    ----------
    text : str
        One line.

    Returns
    -------
    str
        Markdown that starts a line, with a backslash before each character that has a meaning.

    Examples
    --------
    >>> print(escaped("run_1*"))
    run_1\*
    """
    text = re.sub(r"[\\`*<\[\]|~#$]|(?<![^\W_])_|_(?![^\W_])|&(?=#?\w+;)", r"\\\g<0>", text)
    return re.sub(r"^(\d+(?=[.)])|(?=[+>-]))", r"\1\\", text)


@functools.cache
def _parser():
    # Imported on first use: Snakemake's start needs this module, often without any Markdown.
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    return parser.use(dollarmath_plugin, allow_space=False, allow_digits=False, renderer=_mathml)


def _mathml(tex, options):
    """MathML of a formula; the formula as typed where docutils does not know a command."""
    from docutils.utils.math.latex2mathml import tex2mathml

    try:
        mathml = tex2mathml(tex, as_block=options["display_mode"])
    except Exception:  # docutils raises many kinds
        return f"<code>{escape(tex, quote=False)}</code>"
    return re.sub(r">\s+<", "><", mathml)
