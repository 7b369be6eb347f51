"""The catalogue of an archive, checked by the validator of RO-Crate."""

import json

import pytest
from crates import issues_of

from lube.archive.crate import crate_metadata
from lube.study.metadata import About

ORCID = "0000-0002-1825-0097"


@pytest.mark.slow
def test_the_catalogue_passes_the_validator(attributed_study, tmp_path):
    texts = {"README.md": "read", "data/film.nc": "film", "code/lube/stages/film.py": "pass"}
    for name, text in texts.items():
        (tmp_path / "crate" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "crate" / name).write_text(text)
    sizes = {name: len(text) for name, text in texts.items()}
    catalogue = crate_metadata(attributed_study, sizes)
    assert catalogue == crate_metadata(attributed_study, dict(reversed(sizes.items())))
    (tmp_path / "crate/ro-crate-metadata.json").write_text(catalogue)
    assert issues_of(tmp_path / "crate", tmp_path) == []
    listed = {entity["@id"]: entity for entity in json.loads(catalogue)["@graph"]}
    assert listed["data/film.nc"]["contentSize"] == "4"
    assert listed["data/film.nc"]["encodingFormat"] == "application/netcdf"
    assert listed["data/"]["hasPart"] == {"@id": "data/film.nc"}
    assert {"README.md", "code/"} <= set(listed)
    (tmp_path / "crate/data/film.nc").unlink()
    assert any("data/film.nc" in issue for issue in issues_of(tmp_path / "crate", tmp_path))


def entities(study, creators):
    study = study.model_copy(update={"about": About.model_validate({"creators": creators})})
    graph = json.loads(crate_metadata(study, {"README.md": 1}))["@graph"]
    return {entity["@id"]: entity for entity in graph}


def test_creators_of_one_institution_share_it_and_it_is_the_publisher(study):
    creators = [{"name": "A, B", "affiliation": "TU Berlin"}, {"name": "C", "orcid": ORCID}]
    listed = entities(study, [*creators, {"name": "D", "affiliation": "TU Berlin"}])
    institution = {"@id": "#institution-TU%20Berlin"}
    assert listed[institution["@id"]] == {
        **institution,
        "@type": "Organization",
        "name": "TU Berlin",
    }
    names = ["#creator-1", f"https://orcid.org/{ORCID}", "#creator-3"]
    assert [creator["@id"] for creator in listed["./"]["creator"]] == names
    assert listed["./"]["publisher"] == listed["#creator-3"]["affiliation"] == institution


def test_a_creator_without_institution_is_the_publisher(study):
    root = entities(study, [{"name": "A"}])["./"]
    assert root["publisher"] == root["creator"] == {"@id": "#creator-1"}
