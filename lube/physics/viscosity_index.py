"""Viscosity index of an oil by ASTM D2270.

Kinematic viscosities are in mm2/s, not in SI units, because the standard's constants hold for
mm2/s only. Callers convert.
"""

from pathlib import Path

import numpy as np

from lube.errors import RangeError

# The standard's quadratic fits to its table of reference oils: L = a Y^2 + b Y + c and
# H = d Y^2 + e Y + f, where Y is the viscosity at 100 degC. Each row holds up to the Y of the next
# one; the last row is an equation in the standard's text.
_TABLE = Path(__file__).with_name("reference_oils.csv")
_REFERENCE_OILS = np.loadtxt(_TABLE, delimiter=",", skiprows=1)


def reference_oils(viscosity_100: float) -> tuple[float, float]:
    """Viscosities at 40 degC of the reference oils of VI 0 and VI 100 (ASTM D2270).

    Parameters
    ----------
    viscosity_100 : float
        Kinematic viscosity of the reference oils at 100 degC, 2 mm2/s or more.

    Returns
    -------
    tuple of float
        L of the oil of viscosity index 0 and H of the oil of viscosity index 100, mm2/s, by the
        standard's quadratic fits, which agree with its table within 0.2 %.

    Raises
    ------
    RangeError
        Below 2 mm2/s, where the viscosity index is not defined.

    Examples
    --------
    >>> low, high = reference_oils(10.0)
    >>> f"{low:.1f}", f"{high:.2f}"
    ('147.7', '82.87')
    """
    if not viscosity_100 >= 2.0:
        raise RangeError(
            f"got {viscosity_100:g} mm2/s at 100 degC, the viscosity index needs 2 mm2/s or more"
        )
    row = np.searchsorted(_REFERENCE_OILS[:, 0], viscosity_100, side="right") - 1
    of_low, of_high = _REFERENCE_OILS[row, 1:].reshape(2, 3)
    return float(np.polyval(of_low, viscosity_100)), float(np.polyval(of_high, viscosity_100))


def viscosity_index(viscosity_40: float, viscosity_100: float) -> float:
    r"""Viscosity index by ASTM D2270, procedure A up to 100 and procedure B above.

    .. math::

        VI = 100 \frac{L - Y_{40}}{L - H} \quad (Y_{40} \ge H), \qquad
        VI = 100 + \frac{10^N - 1}{0.00715}, \;
        N = \frac{\ln(H / Y_{40})}{\ln Y_{100}} \quad (Y_{40} < H)

    Parameters
    ----------
    viscosity_40, viscosity_100 : float
        Kinematic viscosities :math:`Y_{40}` and :math:`Y_{100}` at 40 and at 100 degC, mm2/s.

    Returns
    -------
    float
        Viscosity index, not rounded to the whole number that the standard reports.

    Raises
    ------
    RangeError
        Below 2 mm2/s at 100 degC.

    Examples
    --------
    >>> f"{viscosity_index(335.0, 38.3):.1f}"
    '164.4'
    """
    low, high = reference_oils(viscosity_100)
    if viscosity_40 >= high:
        return 100.0 * (low - viscosity_40) / (low - high)
    exponent = float(np.log(high / viscosity_40) / np.log(viscosity_100))
    return (10.0**exponent - 1.0) / 0.00715 + 100.0


def viscosity_at_100(viscosity_40: float, index: float) -> float:
    """Kinematic viscosity at 100 degC of an oil with a viscosity index, by ASTM D2270.

    Parameters
    ----------
    viscosity_40 : float
        Kinematic viscosity at 40 degC, mm2/s.
    index : float
        Viscosity index.

    Returns
    -------
    float
        Kinematic viscosity at 100 degC with this index, found by bisection, mm2/s.

    Raises
    ------
    RangeError
        If no viscosity from 2 mm2/s to that at 40 degC has this index.

    Examples
    --------
    >>> f"{viscosity_at_100(335.0, 164.4):.1f}"
    '38.3'
    """
    low, high = 2.0, viscosity_40
    if not low < high or not viscosity_index(viscosity_40, low) <= index:
        raise RangeError(
            f"got a viscosity index of {index:g} at {viscosity_40:g} mm2/s at 40 degC, the index "
            "needs 2 mm2/s or more at 100 degC"
        )
    for _ in range(60):
        middle = 0.5 * (low + high)
        if viscosity_index(viscosity_40, middle) < index:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
