"""The explorer's page: controls and figures by Bokeh, in this package's template.

The page holds everything, Bokeh's JavaScript included, so it needs neither server nor network.
What happens when a control moves is in ``templates/explorer.mjs``.
"""

import json
from pathlib import Path

import xarray as xr
from bokeh import models
from bokeh.document import Document
from bokeh.resources import Resources
from bokeh.themes import Theme

from lube.explorer.content import CHOICES, MODEL, page_content
from lube.explorer.figures import COLUMNS, TINTS, draw
from lube.pipeline.stamps import stamp
from lube.report.pages import render

_TEMPLATES = Path(__file__).parent / "templates"
_NAMES = {
    "lubricant": "Oil",
    "film_formula": "Film formula",
    "force": "Force",
    "speed": "Speed",
    "temperature": "Temperature",
    "slide_to_roll_ratio": "Slide-to-roll ratio",
    MODEL: "Contact of",
}
"""Names of the choices on the page."""


def explorer_page(datasets: dict[str, xr.Dataset], band: str, is_heated: bool = False) -> str:
    """Make the explorer of a study.

    Parameters
    ----------
    datasets : dict of str to xarray.Dataset
        As for `lube.explorer.content.page_content`, as loaded.
    band : str
        `Study.band` of the study.
    is_heated : bool, optional
        Whether heating at the inlet thins the study's films.

    Returns
    -------
    str
        HTML that needs no other file. The same datasets give the same page.

    Raises
    ------
    DataError
        As from `lube.pipeline.stamps.stamp`.
    """
    content = page_content(datasets) | {"band": band, "is_heated": is_heated}
    controls = _controls(content["levels"], content["traces"][0]["at"])
    sources = {
        name: models.ColumnDataSource({column: [] for column in columns}, name=name)
        for name, columns in COLUMNS.items()
    }
    figures = draw(content, datasets, sources)
    document = _document(controls, sources, figures)
    # As `bokeh.embed.components` does, but with names instead of random numbers.
    places = {model.id: model.name for model in document.roots}
    items = [{"docid": "explorer", "roots": places, "root_ids": list(places)}]
    return render(
        "explorer.html",
        package="lube.explorer",
        controls=controls,
        sources=sources,
        figures=figures,
        title=datasets["film"].attrs["title"].rpartition(", ")[0],
        content=content,
        names=_NAMES,
        tints=TINTS,
        json={
            "content": _script(content),
            "models": _script({"explorer": document.to_json(deferred=False)}),
            "items": _script(items),
        },
        bokeh=Resources(mode="inline", components=["bokeh", "bokeh-widgets"]).render(),
        stamp=stamp(list(datasets.values())),
    )


def _controls(levels, start):
    """Make a control for each choice with several levels, and one for the abscissa."""
    controls = {}
    sheet = models.InlineStyleSheet(css=(_TEMPLATES / "controls.css").read_text(encoding="utf-8"))
    common = {"stylesheets": [sheet], "sizing_mode": "stretch_width", "margin": (4, 0, 8, 0)}
    for name, level in levels.items():
        names = level["names"]
        if len(names) == 1:
            continue
        options = {"title": _NAMES[name], "value": names[start[name]], **common}
        if name in ("lubricant", "film_formula", MODEL):
            controls[name] = models.Select(options=names, **options)
        else:
            controls[name] = models.CategoricalSlider(categories=names, **options)
    several = [name for name in CHOICES[2:] if name in controls]
    if several:
        first = several.index("temperature") if "temperature" in several else 0
        controls["along"] = models.RadioButtonGroup(
            labels=[_NAMES[name] for name in several], active=first, tags=several, **common
        )
    return controls


def _document(controls, sources, figures):
    """Bokeh's document of controls and figures, which answer each other by ``explorer.mjs``."""
    react = models.CustomJS.from_file(
        _TEMPLATES / "explorer.mjs", controls=controls, sources=sources, figures=figures
    )
    for name, control in controls.items():
        control.js_on_change("active" if name == "along" else "value", react)
    for name in ("along", "grid", "force"):
        sources[name].selected.js_on_change("indices", react)
    places = {f"control-{name}": control for name, control in controls.items()}
    places |= {f"figure-{name}": plot for name, plot in figures.items()}
    document = Document(theme=Theme(filename=_TEMPLATES / "theme.yaml"))
    document.js_on_event("document_ready", react)
    with document.models.freeze():  # otherwise Bokeh counts all models again for every root
        for place, model in places.items():
            model.name = place
            document.add_root(model)
    return document


def _script(value):
    """JSON that cannot end the script element around it."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
