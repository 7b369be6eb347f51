"""The explorer: one page on which a reader chooses among a study's operating points."""

EXPLORED = "lubricant film contact tail master trace surface_trace comparison".split()
"""Datasets that the page shows."""


def explored(study) -> list[str]:
    """Datasets that the page of a study shows.

    Parameters
    ----------
    study : lube.study.study.Study
        The study. Traces of surfaces are shown if it asks for contact of surfaces.
    """
    shown = [kind for kind in EXPLORED if study.has(kind)]
    return [kind for kind in shown if study.has_surfaces or kind != "surface_trace"]
