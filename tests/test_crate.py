"""The catalogue of an archive, under its own validator."""

import json

from crates import issues_of

from lube.crate import crate_metadata


def test_the_catalogue_is_valid_under_its_own_validator(attributed_study, tmp_path):
    texts = {"README.md": "read", "data/film.nc": "film", "code/lube/film.py": "pass"}
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
