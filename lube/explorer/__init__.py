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
    asked = {"sensitivity": "sensitivity" in made, "surface_trace": study.has_surfaces}
    return [kind for kind in EXPLORED if study.has(kind) and asked.get(kind, True)]
