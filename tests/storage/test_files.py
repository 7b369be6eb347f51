"""A file is written whole or not at all."""

import os
import subprocess
import sys

import pytest

from lube.errors import DataError
from lube.storage.files import check_writable, written_whole


@pytest.fixture
def old(tmp_path):
    """A file from an earlier run, in a folder made for it."""
    path = tmp_path / "folder" / "results.txt"
    with written_whole(path) as part:
        part.write_text("old")
    return path


def only_holds(path, text):
    return path.read_text() == text and list(path.parent.iterdir()) == [path]


def test_a_new_file_replaces_the_old_one_when_it_is_complete(old):
    assert only_holds(old, "old")
    with written_whole(old) as part:
        part.write_text("new")
        assert old.read_text() == "old"
    assert only_holds(old, "new")


def test_a_failed_write_is_explained_and_leaves_the_old_file(old):
    for error in (OSError(28, "No space left on device"), RuntimeError("No HDF")):
        expected = r"results.txt: cannot be written: No .* MiB are free on its disk"
        with pytest.raises(DataError, match=expected), written_whole(old) as part:
            part.write_text("half")
            raise error
        assert only_holds(old, "old")


def test_other_errors_pass_unchanged_and_leave_the_old_file(old):
    with pytest.raises(ValueError, match="ours"), written_whole(old) as part:
        part.write_text("half")
        raise ValueError("ours")
    assert only_holds(old, "old")


def test_a_path_below_a_file_is_refused(old):
    with pytest.raises(DataError, match="cannot be written"), written_whole(old / "below") as part:
        part.write_text("new")


def test_a_folder_that_is_not_writable_is_refused(tmp_path, disk):
    check_writable(tmp_path / "not" / "made" / "yet")
    disk(tmp_path, "ro")
    expected = f"results: cannot be written: the folder {tmp_path} is not writable"
    with pytest.raises(DataError, match=expected):
        check_writable(tmp_path / "results")
    expected = "results: cannot be written: Read-only file system"
    with pytest.raises(DataError, match=expected), written_whole(tmp_path / "results"):
        pass


def test_a_killed_process_leaves_the_old_file_and_the_next_write_removes_its_rest(old):
    code = (
        "import os, signal, sys; from lube.storage.files import written_whole\n"
        "with written_whole(sys.argv[1]) as part:\n"
        "    part.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)"
    )
    subprocess.run([sys.executable, "-c", code, old], env=os.environ, check=False)
    assert old.read_text() == "old"
    assert len(list(old.parent.iterdir())) == 2
    with written_whole(old) as part:
        part.write_text("new")
    assert only_holds(old, "new")
