"""No files, no names, and files that would do something: they are told, or read and no more."""

import os
import sys

import pytest
import yaml
from pydantic import TypeAdapter, ValidationError
from refusals import attempt, check_line
from studies import SMOKE

from lube.recordings.manifest import read_manifest
from lube.recordings.reader import open_recording
from lube.study.field_types import Slug
from lube.study.lubricant_record import SHIPPED_FOLDER, load_record, read_viscosity_csv
from lube.study.resolve import resolved_content
from lube.study.study import load_study

OIL = SHIPPED_FOLDER / "mobilgear-shc-xmp-320.yaml"

READERS = [
    (load_study, ".yaml"),
    (load_record, ".yaml"),
    (read_viscosity_csv, ".csv"),
    (read_manifest, ".yaml"),
    (read_manifest, ".csv"),
    (open_recording, ".csv"),
    (open_recording, ".nc"),
    (open_recording, ".tdms"),
]

# Each makes something at a path that is no file a person wrote.
STRANGE = {
    "pipe": os.mkfifo,
    "folder": os.mkdir,
    "endless device": lambda path: os.symlink("/dev/zero", path),
    "empty device": lambda path: os.symlink("/dev/null", path),
    "terminal": lambda path: os.symlink("/dev/tty", path),
    "link to itself": lambda path: os.symlink(path.name, path),
    "link to nothing": lambda path: os.symlink("nowhere", path),
    "nothing": lambda path: None,
    "sparse terabyte": lambda path: (path.touch(), os.truncate(path, 2**40)),
    "binary": lambda path: path.write_bytes(bytes(range(256)) * 10),
    "empty": lambda path: path.touch(),
}
NAMES = ["a\0b", "a\nb", "\ud800", "x" * 300, "x/" * 3000 + "x", "", ".", "..", "/", "\x1b[2J"]
NAMES += ["/dev/zero", "/dev/stdin", "/proc/self/mem", "../../../../../../etc/passwd", "con", "~"]


@pytest.mark.parametrize("make", STRANGE.values(), ids=STRANGE)
@pytest.mark.parametrize(("read", "suffix"), READERS)
def test_what_is_no_file_of_its_kind_is_refused_at_once(tmp_path, read, suffix, make):
    path = tmp_path / f"strange{suffix}"
    make(path)
    assert attempt(read, path) is None


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is locked to the super-user")
@pytest.mark.parametrize(("read", "suffix"), READERS)
def test_a_file_that_may_not_be_read_is_told(tmp_path, read, suffix):
    path = tmp_path / f"locked{suffix}"
    path.write_text("time [s], voltage [V]\n")
    path.chmod(0)
    assert attempt(read, path) is None


@pytest.mark.parametrize("name", NAMES, ids=ascii)
@pytest.mark.parametrize(("read", "suffix"), READERS)
def test_a_name_that_no_file_has_is_told(tmp_path, read, suffix, name):
    assert attempt(read, tmp_path / f"{name}strange{suffix}") is None


# Files that a file names


def written(path, content):
    path.write_text(yaml.safe_dump(content), encoding="utf-8")
    return path


def named_by(folder, way, name):
    """A study, record or list that names another file, and what reads it."""
    study = resolved_content(SMOKE)
    record = yaml.safe_load(OIL.read_text("utf-8"))
    row = {"file": name, "force": "1 N", "speed": "1 rpm", "temperature": "40 degC"}
    record["viscosity"] = {"source": "assumed: strange", "csv": name}
    contents = {
        "lubricants": (load_study, study | {"lubricants": [name]}),
        "manifest": (load_study, study | {"experiment": {"manifest": name}}),
        "csv": (load_record, record),
        "file": (read_manifest, [row]),
    }
    read, content = contents[way]
    return read, written(folder / f"{way}-names.yaml", content)


@pytest.mark.parametrize("way", ["lubricants", "manifest", "csv", "file"])
@pytest.mark.parametrize("name", NAMES, ids=ascii)
def test_a_named_file_is_found_or_told(tmp_path, way, name):
    for suffix in ("", ".yaml", ".csv"):
        read, path = named_by(tmp_path, way, name + suffix)
        found = attempt(read, path, named=tmp_path)
        for line in getattr(found, "refused", ()):
            check_line(line)


@pytest.mark.parametrize("way", ["lubricants", "manifest", "csv", "file"])
@pytest.mark.parametrize("kind", [kind for kind in STRANGE if kind not in ("binary", "empty")])
def test_a_named_file_that_is_none_is_told(tmp_path, way, kind):
    STRANGE[kind](tmp_path / "strange.yaml")
    read, path = named_by(tmp_path, way, "strange.yaml")
    found = attempt(read, path, named=tmp_path)
    if kind == "sparse terabyte" and way in ("manifest", "file"):
        assert found is not None  # it is looked into later, as in the tests above
    else:
        assert found is None or len(found.refused) == 1


# Nothing is executed


TAGS = [
    "!!python/object/apply:os.system ['touch {canary}']",
    "!!python/object/new:os.system ['touch {canary}']",
    "!!python/object/apply:subprocess.check_output [[touch, '{canary}']]",
    "!!python/object:pathlib.Path {{}}",
    "!!python/name:os.system",
    "!!python/module:antigravity",
    "!<tag:yaml.org,2002:python/object/apply:os.system> ['touch {canary}']",
    "?__import__('os').system('touch {canary}')",
    "__import__('os').system('touch {canary}')",
    "$(touch {canary})",
]


@pytest.mark.parametrize("tag", TAGS)
@pytest.mark.parametrize(
    "place", ["name: {}", "seed: {}", "{}: 1", "? {}\n: 1", "x: &a {}", "- {}"]
)
def test_no_file_is_executed(tmp_path, tag, place):
    canary = tmp_path / "canary"
    value = tag.format(canary=canary)
    path = tmp_path / "evil.yaml"
    modules = set(sys.modules)
    for start in ("", "__use_yte__: true\n__definitions__: [import antigravity]\n"):
        path.write_text(start + place.format(value) + "\n", encoding="utf-8")
        for read in (load_study, load_record):
            assert attempt(read, path) is None
        listed = attempt(read_manifest, path)
        assert listed is None or not listed.entries
    assert not canary.exists()
    assert "antigravity" not in set(sys.modules) - modules


# Nothing is written elsewhere

SLUGS = ["", ".", "..", "../x", "a/b", "/a", "a\\b", "a\n", "a\0", "A", "é", "ａ", "a.", ".a", "-a"]
SLUGS += ["a b", "~", "$HOME", "CON", "a" * 64, "a\u2215b", "a:b", "{a}", "*", "\ud800", "а"]


@pytest.mark.parametrize("name", SLUGS, ids=ascii)
def test_a_study_or_lubricant_has_a_name_fit_for_a_folder(tmp_path, name):
    with pytest.raises(ValidationError):
        TypeAdapter(Slug).validate_python(name)
    oil = yaml.safe_load(OIL.read_text("utf-8"))
    for read, content in ((load_study, resolved_content(SMOKE)), (load_record, oil)):
        assert attempt(read, written(tmp_path / "named.yaml", content | {"name": name})) is None


@pytest.mark.parametrize("name", ["a", "0", "a-b_c", "a" * 63])
def test_results_of_a_study_lie_in_a_folder_of_their_own(tmp_path, name):
    content = resolved_content(SMOKE)
    study = load_study(written(tmp_path / "named.yaml", content | {"name": name}))
    results = tmp_path / "results"
    assert (results / study.name).resolve().parent == results.resolve()


@pytest.mark.parametrize("way", ["lubricants", "manifest", "csv", "file"])
def test_files_are_read_and_none_is_made(tmp_path, way):
    folder = tmp_path / "below"
    folder.mkdir()
    for name in ("../made.yaml", str(tmp_path / "made.csv"), "made.csv", "sub/made.yaml"):
        read, path = named_by(folder, way, name)
        attempt(read, path, named=folder)
        assert [*tmp_path.iterdir(), *folder.iterdir()] == [folder, path]
