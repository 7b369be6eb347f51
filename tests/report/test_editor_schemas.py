"""JSON Schemas for editors: as the models, true for all shipped files, and not for mistakes."""

import copy

import pytest
import yaml
from editor_schemas import written
from editors import complaints
from studies import CONFIG, PAPER_CONTENT, REMOVED, with_value

from lube.errors import LubeError
from lube.study.lubricant_record import SHIPPED_FOLDER
from lube.study.schema_files import KINDS, schema_file, schema_line
from lube.study.text_files import read_yaml

SHIPPED = [("study", path) for path in sorted(CONFIG.glob("*.yaml"))]
SHIPPED += [("lubricant", path) for path in sorted(SHIPPED_FOLDER.glob("*.yaml"))]
OIL = read_yaml(SHIPPED_FOLDER / "mobilgear-shc-xmp-320.yaml", LubeError)
ROW = {"file": "run.csv", "force": "800 N", "speed": "100 1/min", "temperature": "40,5 degC"}


@pytest.mark.parametrize("kind", KINDS)
def test_the_files_follow_from_the_models(kind):
    assert schema_file(kind).read_text(encoding="utf-8") == written(kind), (
        "run python docs/tools/editor_schemas.py"
    )


@pytest.mark.parametrize(("kind", "path"), SHIPPED, ids=lambda one: getattr(one, "stem", one))
def test_shipped_files_name_their_schema_and_fit_it(kind, path):
    assert path.read_text(encoding="utf-8").splitlines()[0] == schema_line(kind, path)
    assert not complaints(kind, read_yaml(path, LubeError))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("rollers.first.radius", "2 inch"),
        ("rollers.first.radius", "3 mm*Pa/Pa"),
        ("rollers.first.poisson_ratio", "3/10"),
        ("operating_grid.speed", {"values": ["600/7", 1e2], "units": "1/min"}),
        ("experiment", {"manifest": None}),
        ("rig", REMOVED),
        ("roughness.shortest_wavelength", "3 um"),
        ("lubricants", ["n-dodecane", "../my oil.yaml"]),
        ("about.date", 20261121),
    ],
)
def test_what_may_be_written_is_accepted(key, value):
    assert not complaints("study", with_value(PAPER_CONTENT, key, value))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("rollers.first.radius", 50),
        ("rollers.first.radius", "50"),
        ("rollers.first.radius", "50.5"),
        ("rollers.first.radius", "0,3 mm"),
        ("rollers.first.radius", "-50 mm"),
        ("rollers.first.radius", "5.0e1 GPa"),
        ("rollers.first.young_modulus", "210 kN"),
        ("rollers.first.poisson_ratio", 0.6),
        ("rollers.first.poisson_ratio", "0,3"),
        ("operating_grid.force", [100, 200]),
        ("operating_grid.force", {"values": [100], "units": "rpm"}),
        ("operating_grid.force", {"values": [0], "units": "N"}),
        ("roughness.longest_wavelength", "contact width"),
        ("roughness.shortest_wavelength", 10),
        ("realisations", 1.5),
        ("film_formulas", ["pan-hamrok"]),
        ("lubricants", ["mobilgear"]),
        ("name", "My study"),
        ("colour", "red"),
    ],
)
def test_mistakes_are_marked_where_they_are(key, value):
    content = with_value(PAPER_CONTENT, key, value)
    (where,) = complaints("study", content)
    assert where.startswith(key) or (where, key) == ("", "colour")


@pytest.mark.parametrize("key", ["name", "seed", "rollers.first", "rollers.first.radius", "traces"])
def test_what_is_required_of_a_whole_study_is_not_of_one_based_on_another(key):
    content = with_value(PAPER_CONTENT, key, REMOVED)
    assert complaints("study", content)
    assert bool(complaints("study", content | {"based_on": "paper.yaml"})) is (key == "name")


def test_a_study_based_on_another_is_still_checked():
    content = {"based_on": "paper.yaml", "name": "mine", "traces": [{"force": "8 N"}]}
    assert complaints("study", content) == ["traces.0", "traces.0"]
    content = {"based_on": "paper.yaml", "name": "mine", "rollers": {"fist": {}}}
    assert complaints("study", content) == ["rollers"]


def test_a_lubricant_needs_sources_but_no_conductivity():
    oil = copy.deepcopy(OIL)
    del oil["thermal_conductivity"]
    assert not complaints("lubricant", oil)
    del oil["viscosity"]["source"]
    assert complaints("lubricant", oil) == ["viscosity"]
    oil = with_value(OIL, "viscosity.points.1.temperature", "40 mm")
    assert complaints("lubricant", oil) == ["viscosity.points.1.temperature"]


def test_a_manifest_has_decimal_commas_and_empty_cells():
    assert not complaints("manifest", [ROW | {"gain": "1,5", "offset": None, "lubricant": None}])
    assert complaints("manifest", [ROW | {"force": "800"}]) == ["0.force"]
    del (row := dict(ROW))["file"]
    assert complaints("manifest", [row]) == ["0"]


def fields(schema):
    """All leaves of a schema, by their keys."""
    for name, one in schema.get("properties", {}).items():
        inner = one.get("items", one)
        if "properties" in inner and "values" not in inner["properties"]:
            yield from ((f"{name}.{below}", leaf) for below, leaf in fields(inner))
        else:
            yield name, one


def test_every_key_is_described_and_every_quantity_has_its_unit_and_an_example():
    study = yaml.safe_load(written("study"))
    schemas = study["else"], study["then"], yaml.safe_load(written("lubricant"))
    schemas += (yaml.safe_load(written("manifest"))["items"],)
    for schema in schemas:
        for name, leaf in fields(schema):
            assert leaf.get("description"), name
            if "pattern" in leaf and "quantity" in leaf.get("title", ""):
                assert leaf["examples"], name
