"""When the boundary layer on a segment breaks."""

import math

from lube.kernels.compiler import inlined


def layer_factor(reduced_modulus, critical_thickness, shear_strength, spacing, height_step):
    """Gather Eq. 6 and its constants into the one factor that decides on break-up.

    With D = n dx and F = E* dx S q (n points, overlaps that sum to S steps of q), the
    remaining film h_l = (pi tau0 / 12) D^3 / F falls below h_c exactly where
    n^3 < factor * S, with factor = 12 E* q h_c / (pi tau0 dx^2).

    Parameters
    ----------
    reduced_modulus : float
        E*, Pa.
    critical_thickness : float
        Critical thickness h_c of the boundary layer, m.
    shear_strength : float
        Limiting shear stress tau0 of the layer, Pa.
    spacing : float
        Distance dx of neighbouring points, m.
    height_step : float
        Height q that one integer step stands for, m.

    Returns
    -------
    float
        The factor, per step of overlap.
    """
    strength = math.pi * shear_strength * spacing**2
    return 12.0 * reduced_modulus * height_step * critical_thickness / strength


@inlined
def layer_breaks(points, overlap, factor):
    """Tell whether the layer on a segment breaks, h_l < h_c (paper, Eq. 6).

    Parameters
    ----------
    points : int
        Number n of points in contact.
    overlap : int
        Sum of their overlaps, in height steps.
    factor : float
        From `layer_factor`.

    Returns
    -------
    bool
        True where the layer breaks.
    """
    return float(points) * points * points < factor * overlap
