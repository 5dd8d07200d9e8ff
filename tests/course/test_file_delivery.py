import pytest

from flockana.base.errors import FileError
from flockana.course.file_delivery import deliver


def test_files_that_are_the_same_are_left_as_they_are(tmp_path):
    first = deliver(tmp_path / "new", {"a.txt": b"a", "b/c.txt": b"c"})
    before = [path.stat().st_mtime_ns for path in first]
    assert deliver(tmp_path / "new", {"a.txt": b"a", "b/c.txt": b"c"}) == first
    assert [path.stat().st_mtime_ns for path in first] == before
    assert [path.read_bytes() for path in first] == [b"a", b"c"]


@pytest.mark.parametrize("obstacle", ["text", "folder", "link"])
def test_what_differs_is_told_before_anything_is_written(tmp_path, obstacle):
    there = tmp_path / "b.txt"
    if obstacle == "text":
        there.write_text("mine")
    elif obstacle == "folder":
        there.mkdir()
    else:
        there.symlink_to("nowhere")
    with pytest.raises(FileError, match=r"b\.txt exists with other content.*; choose another folder, or move it away"):
        deliver(tmp_path, {"a.txt": b"a", "b.txt": b"b"})
    assert [path.name for path in tmp_path.iterdir()] == ["b.txt"]


def test_a_file_in_the_way_of_a_folder_is_told(tmp_path):
    (tmp_path / "b").write_text("mine")
    with pytest.raises(FileError, match=r"cannot write all of the course to .*; choose another folder"):
        deliver(tmp_path, {"b/c.txt": b"c"})
    assert (tmp_path / "b").read_text() == "mine"
