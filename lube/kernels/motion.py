"""How far the surfaces have moved."""

import numpy as np

from lube.kernels.compiler import kernel


@kernel
def surface_position(step, speed_ratio):
    """Points that a surface has advanced at a time step, not wrapped around the circumference.

    Parameters
    ----------
    step : int
        Time step t.
    speed_ratio : float
        Surface speed over the faster surface's, v_i / max(v1, v2).

    Returns
    -------
    int
        floor(t v_i / max(v1, v2) + 1/2): the point in the middle of the window.
    """
    return int(np.floor(step * speed_ratio + 0.5))
