"""Markdown of notebooks and README as HTML for the report.

What their authors use is known: headings, paragraphs, lists, tables, code, bold and italic,
links, and mathematics between dollars, which becomes MathML. Anything else is shown as it
was typed.
"""

import re
from html import escape, unescape

from lube.report.pages import html_table

_BULLET = re.compile(r"(?:[-*+]|\d+[.)])\s+")
_HEADING = re.compile(r"(#{1,6})\s+(.*?)\s*#*$")
_RULE = re.compile(r"\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)*\|?")

# Code and mathematics come first: inside them nothing else has a meaning.
_INLINE = re.compile(
    r"(?P<ticks>`+)(?P<code>.+?)(?P=ticks)"
    r"|\\(?P<plain>[\\`*_{}\[\]()#+.!|$<>-])"
    r"|\$(?P<math>[^\s$](?:[^$]*[^\s$\\])?)\$(?!\d)"
    r"|!?\[(?P<label>[^\]]*)\]\((?P<target>[^)\s]+)\)"
    r"|\*\*(?P<bold>\S(?:.*?\S)?)\*\*"
    r"|(?<![\w*])\*(?P<italic>[^\s*](?:[^*]*[^\s*])?)\*(?!\w)",
    re.DOTALL,
)


def to_html(text):
    """Turn Markdown into HTML.

    Parameters
    ----------
    text : str
        Markdown.

    Returns
    -------
    str
        HTML of its blocks, one after the other. Links of the text that lead to a file beside
        it keep their words only, for the report travels alone.
    """
    return "\n".join(_blocks(text.splitlines()))


def title_and_text(text):
    """Part a text from the heading that it begins with.

    Parameters
    ----------
    text : str
        Markdown.

    Returns
    -------
    title : str
        The heading's words, as Markdown; empty if the text begins with none.
    text : str
        What follows.
    """
    first, _, rest = text.strip().partition("\n")
    heading = _HEADING.fullmatch(first.strip())
    return (heading[2], rest.strip()) if heading else ("", text.strip())


def section(text, heading):
    """Find what stands below a heading, down to the next one of its level or above.

    Parameters
    ----------
    text : str
        Markdown.
    heading : str
        Words of the heading.

    Returns
    -------
    str
        Markdown; empty if there is no such heading.
    """
    level, found = 0, []
    for line, in_code in _with_fences(text.splitlines()):
        match = None if in_code else _HEADING.fullmatch(line)
        if level and match and len(match[1]) <= level:
            break
        if level:
            found.append(line)
        elif match and match[2] == heading:
            level = len(match[1])
    return "\n".join(found).strip()


def inline(text):
    """Turn the words of one paragraph, cell or heading into HTML.

    Parameters
    ----------
    text : str
        Markdown without blocks.

    Returns
    -------
    str
        HTML.
    """
    parts, end = [], 0
    for match in _INLINE.finditer(text):
        parts += [escape(text[end : match.start()], quote=False), _marked(match)]
        end = match.end()
    return "".join([*parts, escape(text[end:], quote=False)])


def plain(text):
    """Take the marks out of the words of a heading.

    Parameters
    ----------
    text : str
        Markdown without blocks.

    Returns
    -------
    str
        Words alone.
    """
    return unescape(re.sub(r"<[^<>]*>", "", inline(text)))


def escaped(text):
    """Write words so that Markdown shows them as they are.

    Parameters
    ----------
    text : str
        One line of anybody's words.

    Returns
    -------
    str
        Markdown that starts a line, with a backslash before whatever would be a mark.
    """
    text = re.sub(r"[\\`*<\[\]|~#$]|(?<![^\W_])_|_(?![^\W_])|&(?=#?\w+;)", r"\\\g<0>", text)
    return re.sub(r"^(\d+(?=[.)])|(?=[+>-]))", r"\1\\", text)


def _marked(match):
    """HTML of one piece of marked text."""
    kind = match.lastgroup
    if match["code"] is not None:
        return f"<code>{escape(match['code'].strip(), quote=False)}</code>"
    if kind == "plain":
        return escape(match["plain"], quote=False)
    if kind == "math":
        return _mathml(match["math"])
    if kind == "target":
        words = inline(match["label"])
        if not match["target"].startswith(("https://", "http://", "mailto:")):
            return words
        return f'<a href="{escape(match["target"])}">{words}</a>'
    tag = "strong" if kind == "bold" else "em"
    return f"<{tag}>{inline(match[kind])}</{tag}>"


def _mathml(tex):
    """MathML of a formula, or the formula as typed if it is not understood."""
    from docutils.utils.math.latex2mathml import tex2mathml

    try:
        return re.sub(r">\s+<", "><", tex2mathml(tex))
    except Exception:  # docutils fails in many ways at what it does not know
        return f"<code>{escape(tex, quote=False)}</code>"


def _with_fences(lines):
    """Each line, and whether it belongs to a block of code between fences."""
    fence = ""
    for line in lines:
        mark = re.match(r"\s*(```|~~~)", line)
        yield line, bool(fence or mark)
        if mark and mark[1] == (fence or mark[1]):
            fence = "" if fence else mark[1]


def _blocks(lines):
    """HTML of each block of some lines."""
    lines = list(lines)
    while lines:
        take = _BLOCKS[_kind(lines)]
        html, lines = take(lines)
        if html:
            yield html


def _kind(lines):
    """Name the kind of block that begins with the first of some lines."""
    first = lines[0]
    if not first.strip() or first.lstrip().startswith("<!--"):
        return "nothing"
    if re.match(r"\s*(```|~~~)", first):
        return "code"
    if _HEADING.fullmatch(first):
        return "heading"
    if _BULLET.match(first.lstrip()):
        return "list"
    if "|" in first and len(lines) > 1 and _RULE.fullmatch(lines[1].strip()):
        return "table"
    return "paragraph"


def _nothing(lines):
    return "", lines[1:]


def _code(lines):
    fence = lines[0].strip()[:3]
    body = lines[1:]
    ends = [number for number, line in enumerate(body) if line.strip().startswith(fence)]
    end = ends[0] if ends else len(body)
    return f"<pre>{escape(chr(10).join(body[:end]), quote=False)}</pre>", body[end + 1 :]


def _heading(lines):
    marks, words = _HEADING.fullmatch(lines[0]).groups()
    level = len(marks)
    return f"<h{level}>{inline(words)}</h{level}>", lines[1:]


def _paragraph(lines):
    end = 1
    while end < len(lines) and _kind(lines[end:]) == "paragraph":
        end += 1
    return f"<p>{inline(' '.join(line.strip() for line in lines[:end]))}</p>", lines[end:]


def _table(lines):
    end = 2
    while end < len(lines) and "|" in lines[end]:
        end += 1
    head, rows = _cells(lines[0]), [_cells(line) for line in lines[2:end]]
    return html_table(head, rows), lines[end:]


def _cells(line):
    inner = line.strip().removeprefix("|").removesuffix("|")
    return [inline(cell.strip()) for cell in re.split(r"(?<!\\)\|", inner)]


def _list(lines):
    """Take items with what is indented below them; a list may stand in an item."""
    indent = len(lines[0]) - len(lines[0].lstrip())
    numbered = lines[0].lstrip()[0].isdigit()
    items, end = [], 0
    while end < len(lines):
        line = lines[end]
        depth = len(line) - len(line.lstrip())
        if line.strip() and depth <= indent:
            bullet = _BULLET.match(line.lstrip())
            if bullet and line.lstrip()[0].isdigit() == numbered:
                width = depth + bullet.end()
                items.append([line[width:]])
            elif not lines[end - 1].strip() or _kind(lines[end:]) != "paragraph":
                break
            else:
                items[-1].append(line.strip())
        else:
            items[-1].append(line[width:] if not line[:width].strip() else line.strip())
        end += 1
    tag = "ol" if numbered else "ul"
    html = "\n".join(f"<li>{_item(item)}</li>" for item in items)
    return f"<{tag}>\n{html}\n</{tag}>", lines[end:]


def _item(lines):
    """HTML of an item; a single paragraph needs no tag of its own."""
    blocks = list(_blocks(lines))
    blocks[:1] = [re.sub(r"^<p>(.*)</p>$", r"\1", block, flags=re.DOTALL) for block in blocks[:1]]
    return "\n".join(blocks)


_BLOCKS = {
    "nothing": _nothing,
    "code": _code,
    "heading": _heading,
    "list": _list,
    "table": _table,
    "paragraph": _paragraph,
}
