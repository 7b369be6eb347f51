"""The catalogue of an archive, under its own validator."""

import json

from crates import issues_of

from lube.archive.crate import crate_metadata
from lube.study.metadata import About

ORCID = "0000-0002-1825-0097"


def test_the_catalogue_is_valid_under_its_own_validator(attributed_study, tmp_path):
    texts = {"README.md": "read", "data/film.nc": "film", "code/lube/stages/film.py": "pass"}
    for name, text in texts.items():
        (tmp_path / "crate" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "crate" / name).write_text(text)
    catalogue = crate_metadata(attributed_study, {name: len(text) for name, text in texts.items()})
    (tmp_path / "crate/ro-crate-metadata.json").write_text(catalogue)
    assert issues_of(tmp_path / "crate", tmp_path) == []
    listed = {entity["@id"]: entity for entity in json.loads(catalogue)["@graph"]}
    assert listed["data/film.nc"]["contentSize"] == "4"
    assert listed["data/film.nc"]["encodingFormat"] == "application/netcdf"
    assert {"README.md", "data/", "code/"} <= set(listed)
    (tmp_path / "crate/data/film.nc").unlink()
    assert any("data/film.nc" in issue for issue in issues_of(tmp_path / "crate", tmp_path))


def test_the_same_study_has_the_same_catalogue(attributed_study):
    sizes = {"README.md": 1, "data/film.nc": 2}
    backwards = dict(reversed(sizes.items()))
    assert crate_metadata(attributed_study, sizes) == crate_metadata(attributed_study, backwards)


def test_makers_of_one_institution_share_it_and_it_makes_the_archive_public(study):
    creators = [{"name": "A, B", "affiliation": "TU Berlin"}, {"name": "C", "orcid": ORCID}]
    creators += [{"name": "D", "affiliation": "TU Berlin"}]
    study = study.model_copy(update={"about": About.model_validate({"creators": creators})})
    catalogue = json.loads(crate_metadata(study, {"README.md": 1}))
    listed = {entity["@id"]: entity for entity in catalogue["@graph"]}
    assert listed["#institution-TU%20Berlin"] == {
        "@id": "#institution-TU%20Berlin",
        "@type": "Organization",
        "name": "TU Berlin",
    }
    makers = ["#creator-1", f"https://orcid.org/{ORCID}", "#creator-3"]
    assert [maker["@id"] for maker in listed["./"]["creator"]] == makers
    for maker in (listed["./"]["publisher"], listed["#creator-3"]["affiliation"]):
        assert maker == {"@id": "#institution-TU%20Berlin"}


def test_an_institution_is_not_taken_for_a_person(study):
    creators = [{"name": "A", "affiliation": "creator-2"}, {"name": "B"}]
    study = study.model_copy(update={"about": About.model_validate({"creators": creators})})
    listed = {each["@id"]: each for each in json.loads(crate_metadata(study, {}))["@graph"]}
    assert listed[listed["#creator-1"]["affiliation"]["@id"]]["@type"] == "Organization"
    assert listed["#creator-2"]["name"] == "B"


def test_a_maker_of_no_institution_makes_the_archive_public(study):
    study = study.model_copy(update={"about": About(creators=[{"name": "A"}])})
    root = json.loads(crate_metadata(study, {"README.md": 1}))["@graph"][0]
    assert root["publisher"] == root["creator"] == {"@id": "#creator-1"}
