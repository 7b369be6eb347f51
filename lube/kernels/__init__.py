"""Compiled kernels on plain arrays of whole numbers, without labels or files.

Heights, film thicknesses and overlaps are integers: multiples of one *height step* (a picometre
in the paper's study). Positions are grid points, and time is counted in time steps. A sum of
integers does not depend on its order, so a fast method can equal the literal scan to the last
bit.
"""
