"""Compiled kernels on plain arrays, SI units or integers; no labels, no files.

Heights, film thicknesses and overlaps are integers here: multiples of one tiny height step
(a picometre in the paper's study). Sums of integers do not depend on their order, which is
what lets a fast method equal the literal scan to the last bit.
"""
