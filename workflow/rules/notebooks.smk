# What the figures' notebooks depend on, read from their cells before any job.
def notebook_cells(figure):
    """Cells of a figure's notebook, reduced to what decides on it; outputs do not."""
    path = Path(f"notebooks/{figure}.ipynb")
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        return [
            {
                "type": cell["cell_type"],
                "source": "".join(cell["source"]),
                "tags": cell.get("metadata", {}).get("tags", []),
            }
            for cell in cells
        ]
    except (ValueError, KeyError, TypeError):
        raise LubeError(f"{path}: not a Jupyter notebook, damaged or foreign") from None


def python_of(cell, figure):
    """Python of a code cell, without the lines that only Jupyter understands."""
    lines = cell["source"].splitlines()
    code = "\n".join(line for line in lines if not line.lstrip().startswith(("%", "!")))
    try:
        ast.parse(code)
    except SyntaxError as error:
        came = repr((error.text or "").strip())
        raise LubeError(f"notebooks/{figure}.ipynb: got {came}, which is not Python") from None
    return code


def figure_datasets(figure):
    """Datasets that a notebook names in its parameters cell, such as `film = "..."`."""
    cells = [cell for cell in notebook_cells(figure) if "parameters" in cell["tags"]]
    if not cells:
        raise LubeError(f"notebooks/{figure}.ipynb: no cell is tagged 'parameters', need one")
    assigned = [
        target.id
        for node in ast.parse(python_of(cells[0], figure)).body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    ]
    return [result(f"{name}.nc") for name in assigned if name in (*DATASETS, *MEASURED)]


def wanted(figure):
    """Whether a figure has something to show: a tag `several-force` asks for several forces."""
    tags = [tag for cell in notebook_cells(figure) for tag in cell["tags"]]
    needed = [tag.removeprefix("several-") for tag in tags if tag.startswith("several-")]
    levels = STUDY.operating_grid.model_dump()
    return all(len(levels.get(name, ())) > 1 for name in needed)


def figure_sources(figure):
    """Files of the lube package that a figure depends on, by its notebook or its script."""
    cells = [cell for cell in notebook_cells(figure) if cell["type"] == "code"]
    code = "\n".join(python_of(cell, figure) for cell in cells)
    return sorted({*sources(code), *script_sources("figure")})


with told_in_one_line():
    FIGURES = sorted(path.stem for path in Path("notebooks").glob("*.ipynb") if wanted(path.stem))
    FIGURE_DATASETS = {figure: figure_datasets(figure) for figure in FIGURES}
    FIGURE_SOURCES = {figure: figure_sources(figure) for figure in FIGURES}
    FIGURE_CELLS = {figure: digest(notebook_cells(figure)) for figure in FIGURES}
    # Figures of measured times are made when asked for.
    TIMINGS = [
        figure
        for figure in FIGURES
        if not {Path(path).stem for path in FIGURE_DATASETS[figure]}.isdisjoint(MEASURED)
    ]
    ARCHIVED = [figure for figure in FIGURES if figure not in TIMINGS]


def products(figures):
    """Files made of some figures: pictures and executed notebooks."""
    for figure in figures:
        yield from (result(f"figures/{figure}.{suffix}") for suffix in ("png", "pdf"))
        yield result(f"notebooks/{figure}.ipynb")
