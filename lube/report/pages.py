"""HTML and Markdown from the templates in the folders ``templates``."""

import functools
import math

import numpy as np

from lube.report.markdown import escaped, inline
from lube.study.uncertainty import spoken
from lube.units import with_unit


def render(template: str, package: str = "lube.report", **values: object) -> str:
    """Fill a template.

    Parameters
    ----------
    template : str
        File name in the folder ``templates``. Values are escaped in those that end with
        ``.html``.
    package : str, optional
        Package that the folder lies in.
    **values
        Values of the names in the template.

    Returns
    -------
    str
        The filled template.
    """
    return _environment(package).get_template(template).render(values)


def rounded(number: float) -> float:
    """Round to three significant digits.

    Parameters
    ----------
    number : float
        Any number.

    Returns
    -------
    float
        The rounded number.

    Examples
    --------
    >>> rounded(600 / 7)
    85.7
    """
    return float(f"{float(number):.3g}")


def percent(share: float) -> str:
    """Print a share as a percentage with three significant digits.

    Parameters
    ----------
    share : float
        Share, 0 to 1, or NaN.

    Returns
    -------
    str
        Such as ``1.25 %``; a dash for NaN.

    Examples
    --------
    >>> percent(9.934e-07), percent(1.65e-39)
    ('0.0000993 %', '1.65e-37 %')
    """
    share = float(share)
    if not math.isfinite(share):
        return "–"
    if 0.0 < share < 1e-8:
        return f"{100.0 * share:.3g} %"
    digits = np.format_float_positional(100.0 * share, precision=3, fractional=False, trim="-")
    return f"{digits} %"


def ends(values: np.ndarray) -> list[float]:
    """Return the least and the greatest of some values; nothing if there are none.

    Parameters
    ----------
    values : numpy.ndarray or xarray.DataArray
        The values.

    Returns
    -------
    list of float
        Both.

    Examples
    --------
    >>> ends(np.array([3.0, 1.0, 2.0]))
    [1.0, 3.0]
    """
    return [values.min().item(), values.max().item()] if values.size else []


def count(number: float, noun: str) -> str:
    """Print a number and a noun.

    Parameters
    ----------
    number : float
        How many.
    noun : str
        In the singular; the plural is formed with s.

    Returns
    -------
    str
        Such as ``1 record`` or ``8 records``.
    """
    return f"{number:g} {noun}{'' if number == 1 else 's'}"


@functools.cache
def _environment(package):
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
    from markupsafe import Markup

    options = {"undefined": StrictUndefined, "trim_blocks": True, "lstrip_blocks": True}
    escape = select_autoescape(["html"])
    environment = Environment(loader=PackageLoader(package), autoescape=escape, **options)
    filters = {each.__name__: each for each in (count, ends, escaped, percent, rounded, spoken)}
    filters |= {"inline": lambda text: Markup(inline(text)), "unit": with_unit}
    environment.filters |= filters
    return environment
