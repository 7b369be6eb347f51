"""Notebooks as a user writes them: words, a cell of parameters, code."""

import nbformat
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

PARAMETERS = 'oil = "../results/paper/film.nc"\nspeed = 100\nfigure = None'
DRAW = """\
import matplotlib.pyplot as plt
from lube import plots
from lube.storage import netcdf
canvas, axes = plt.subplots()
line = axes.plot([{}, speed])
plots.save_figure(canvas, figure, netcdf.load(oil, "film"))
"""


def write_notebook(path, *codes, words="# Film", parameters=PARAMETERS, tag="parameters", of=()):
    """Write a notebook with a tag of its parameters and further tags of its words; return it."""
    cells = [
        new_markdown_cell(words, metadata={"tags": list(of)}),
        new_code_cell(parameters, metadata={"tags": [tag]}),
        *map(new_code_cell, codes),
    ]
    nbformat.write(new_notebook(cells=cells), path)
    return path
