"""The files of a figure."""


def products(figure: str) -> list[str]:
    """List the files of a figure: its pictures and its executed notebook.

    Parameters
    ----------
    figure : str
        Its name, such as ``fig02_film``.

    Returns
    -------
    list of str
        Paths below the folder of a study's results, or below an archive.

    Examples
    --------
    >>> products("fig02_film")
    ['figures/fig02_film.png', 'figures/fig02_film.pdf', 'notebooks/fig02_film.ipynb']
    """
    return [f"figures/{figure}.png", f"figures/{figure}.pdf", f"notebooks/{figure}.ipynb"]


def origin(figure: str) -> str:
    """Path of the file that states the origin of a figure, below the same folder."""
    return f"figures/{figure}.json"
