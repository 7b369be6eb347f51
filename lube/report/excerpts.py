"""What the report takes from the README: words that stand there stand nowhere else."""

from lube.report.markdown import section, to_html

ASSUMPTIONS = "What the paper leaves open"
LIMITS = "Honest limits"
FILES = "What you get"
ARCHITECTURE = "How it is built"

_LEAD = (
    "<p>The paper does not print all that a calculation needs. This is what it leaves open and "
    "what stands there instead. The numbers are those of the paper's study; the last column "
    "says where a study changes them, and the page Configuration has this study's.</p>"
)


def excerpts(readme):
    """Parts of the README that the report shows.

    Parameters
    ----------
    readme : str
        The README.

    Returns
    -------
    dict
        HTML of ``assumptions``, what the paper leaves open and what this study filled in; of
        ``limits``, what the study cannot say; of ``files``, what is in which file; and of
        ``pipeline``, a drawing of how the stages follow from one another.
    """
    _, _, table = section(readme, FILES).partition("\n\n")
    _, _, drawing = section(readme, ARCHITECTURE).partition("```")
    return {
        "assumptions": f"{_LEAD}\n{to_html(section(readme, ASSUMPTIONS))}",
        "limits": to_html(section(readme, LIMITS)),
        "files": to_html(table.partition("\n\n")[0]),
        "pipeline": to_html(f"```{drawing.partition('```')[0]}```"),
    }
