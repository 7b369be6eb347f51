"""The explorer: one page on which a reader chooses among a study's operating points."""

from collections.abc import Collection

EXPLORED = "lubricant film contact tail master trace surface_trace comparison sensitivity".split()
"""Datasets that the page shows."""


def explored(study, made: Collection[str] = ()) -> list[str]:
    """Datasets that the page of a study shows.

    Parameters
    ----------
    study : lube.study.study.Study
        The study. Traces of surfaces are shown if it asks for contact of surfaces.
    made : collection of str, optional
        Datasets made on request only that there are.
    """
    shown = [kind for kind in EXPLORED if study.has(kind)]
    shown = [kind for kind in shown if kind != "sensitivity" or kind in made]
    return [kind for kind in shown if study.has_surfaces or kind != "surface_trace"]
