"""Files are there whole or not at all, whatever happens while they are written."""

import os
import subprocess
import sys

import pytest

from lube.errors import DataError
from lube.storage.files import check_writable, cut_within_a_line, scratch_beside, written_whole


@pytest.fixture
def old(tmp_path):
    """A file from an earlier run."""
    path = tmp_path / "folder" / "results.txt"
    with written_whole(path) as part:
        part.write_text("old")
    return path


def only_holds(path, text):
    return path.read_text() == text and list(path.parent.iterdir()) == [path]


def test_the_folder_is_made_and_the_file_is_there_alone(old):
    assert only_holds(old, "old")


def test_a_new_file_takes_the_old_ones_place_at_the_end(old):
    with written_whole(old) as part:
        part.write_text("new")
        assert old.read_text() == "old"
    assert only_holds(old, "new")


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), RuntimeError("HDF")])
def test_a_failed_write_is_told_and_leaves_the_old_file(old, error):
    told = r"cannot be written: (No space|HDF).* MiB are free"
    with pytest.raises(DataError, match=told), written_whole(old) as part:
        part.write_text("half")
        raise error
    assert only_holds(old, "old")


def test_other_errors_pass_and_leave_the_old_file(old):
    with pytest.raises(ValueError, match="ours"), written_whole(old) as part:
        part.write_text("half")
        raise ValueError("ours")
    assert only_holds(old, "old")


def test_a_writer_that_writes_nothing_is_an_error(old):
    with pytest.raises(DataError, match="No such file"), written_whole(old):
        pass
    assert only_holds(old, "old")


def test_a_folder_that_cannot_be_written_is_told_before(tmp_path, disk):
    check_writable(tmp_path / "not" / "made" / "yet")
    disk(tmp_path, "ro")
    told = f"results: cannot be written: the folder {tmp_path} is not writable"
    with pytest.raises(DataError, match=told):
        check_writable(tmp_path / "results")
    with pytest.raises(DataError, match=told), written_whole(tmp_path / "results"):
        pass


def test_a_folder_that_is_a_file_is_told(old):
    with pytest.raises(DataError, match="cannot be written"), written_whole(old / "below") as part:
        part.write_text("new")


def test_a_killed_writer_leaves_the_old_file(old):
    code = (
        "import os, signal, sys; from lube.storage.files import written_whole\n"
        "with written_whole(sys.argv[1]) as part:\n"
        "    part.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)"
    )
    killed = subprocess.run([sys.executable, "-c", code, old], env=os.environ, check=False)
    assert killed.returncode != 0
    assert old.read_text() == "old"


def test_a_killed_worker_leaves_a_folder_that_the_next_one_takes_away(tmp_path):
    code = (
        "import os, signal, sys; from lube.storage.files import scratch_beside\n"
        "with scratch_beside(sys.argv[1]) as part:\n"
        "    (part / 'half').write_text('half'); os.kill(os.getpid(), signal.SIGKILL)"
    )
    killed = subprocess.run([sys.executable, "-c", code, tmp_path / "archive"], check=False)
    assert killed.returncode != 0
    assert len(list(tmp_path.iterdir())) == 1
    with scratch_beside(tmp_path / "archive") as part:
        assert list(tmp_path.iterdir()) == [part]
    assert not list(tmp_path.iterdir())


# Killed writers, and two at once

WRITE_AND_WAIT = """\
import sys
from lube.storage.files import check_writable, cut_within_a_line, scratch_beside, written_whole
with written_whole(sys.argv[1]) as part:
    part.write_text("half")
    print(flush=True)
    sys.stdin.read()
    part.write_text("its own")
"""


@pytest.fixture
def writer(old):
    """Another process that has written half of the same file; it ends when its input does."""
    process = subprocess.Popen(
        [sys.executable, "-c", WRITE_AND_WAIT, old],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    process.stdout.readline()
    yield process
    process.kill()
    process.communicate()


def test_of_two_that_write_at_once_each_gives_a_whole_file(old, writer):
    with written_whole(old) as part:
        part.write_text("new")
    assert old.read_text() == "new"
    assert len(list(old.parent.glob("*.part"))) == 1
    writer.communicate()
    assert writer.returncode == 0
    assert only_holds(old, "its own")


def test_two_in_one_process_do_not_meet_either(old):
    with written_whole(old) as first, written_whole(old) as second:
        first.write_text("first")
        second.write_text("second")
    assert only_holds(old, "first")


def test_what_a_killed_writer_leaves_is_cleared_by_the_next_in_its_folder(old, writer):
    writer.kill()
    writer.wait()
    assert old.read_text() == "old"
    assert len(list(old.parent.glob("*.part"))) == 1
    with written_whole(old.with_name("another")) as part:
        part.write_text("new")
    assert sorted(path.name for path in old.parent.iterdir()) == ["another", old.name]


def test_leftovers_of_other_machines_stay(old):
    foreign = old.with_name("results.txt.0a1b2c3d.1@elsewhere-1.part")
    foreign.write_text("half")
    with written_whole(old) as part:
        part.write_text("new")
    assert foreign.exists()


@pytest.mark.parametrize(
    ("name", "content", "cut"),
    [
        ("study.yaml", b"seed: 12", True),
        ("study.yaml", b"seed: 123\n", False),
        ("study.yml", b"", False),
        ("record.CSV", b"t [s],U [V]\r\n0,1.5", True),
        ("record.csv", b"t [s],U [V]\r\n0,1.5\r\n", False),
        ("record.tdms", b"TDSm", False),
    ],
)
def test_a_text_cut_within_a_line_is_noticed(tmp_path, name, content, cut):
    (tmp_path / name).write_bytes(content)
    assert cut_within_a_line(tmp_path / name) is cut
