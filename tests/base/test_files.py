import os

import pytest

from flockana.base.errors import FileError
from flockana.base.files import atomic_write, ensure_target, read_text_file
from tests.refused import refused


def write(target, text, *, error=None, **options):
    with atomic_write(target, **options) as partial:
        partial.write_text(text)
        if error is not None:
            raise error


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError, FileError])
def test_what_is_not_whole_is_removed_and_what_was_there_stays(error, tmp_path):
    target = tmp_path / "it.nc"
    target.write_text("before")
    with pytest.raises(error):
        write(target, "half", error=error("torn"))
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"it.nc": "before"}


def test_the_new_one_takes_the_place_of_the_old_one_at_the_end(tmp_path):
    target = tmp_path / "it.tar.gz"
    target.write_text("before")
    with atomic_write(target) as partial:
        partial.write_text("whole")
        assert target.read_text() == "before"
        assert (partial.parent, partial.suffix, partial.name[0]) == (tmp_path, ".gz", ".")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"it.tar.gz": "whole"}


def test_a_name_may_be_relative_and_without_suffix(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write("it", "whole")
    assert os.listdir() == ["it"]


@pytest.mark.parametrize("name", ["none/it.txt", "folder", "n" * 300])
def test_where_nothing_can_be_written_is_told_with_the_remedy(name, tmp_path):
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileError, match=r"cannot write '.*': .+; choose a shorter way$"):
        write(tmp_path / name, "whole", remedy="choose a shorter way")
    assert os.listdir(tmp_path) == ["folder"]


test_a_device_is_neither_read_nor_written = refused(
    (lambda: ensure_target(os.devnull), "it is no regular file; choose another file", FileError),
    (lambda: read_text_file(os.devnull), "it is no regular file; expected a file", FileError),
)


def test_a_missing_folder_is_named_where_the_writer_says_something_else(tmp_path):
    with (
        pytest.raises(FileError, match=r"there is no folder .*nowhere; choose"),
        atomic_write(tmp_path / "nowhere/a.mat"),
    ):
        raise OSError("Reader needs file name or open file-like object")
