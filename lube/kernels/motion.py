"""Positions of the moving surfaces, in grid points."""

import numpy as np

from lube.kernels.compiler import kernel


@kernel
def surface_position(step: int, speed_ratio: float) -> int:
    r"""Count the grid points by which a surface has advanced at a time step.

    Parameters
    ----------
    step : int
        Time step :math:`t`.
    speed_ratio : float
        Surface speed over that of the faster surface, :math:`v_i / \max(v_1, v_2)`.

    Returns
    -------
    int
        Position of the window's centre on the surface, not wrapped around the circumference:

        .. math:: s_i(t) = \left\lfloor t \frac{v_i}{\max(v_1, v_2)} + \frac12 \right\rfloor

    Examples
    --------
    >>> [surface_position(step, 0.5) for step in range(6)]
    [0, 1, 1, 2, 2, 3]
    """
    return int(np.floor(step * speed_ratio + 0.5))
