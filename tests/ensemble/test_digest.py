import sys

import pytest

from flockana.ensemble import digest as digests
from flockana.ensemble.digest import cached_digest, digest_of_sources

SOURCES = {"a.py": b"x = 1  # one\n", "b.json": b"{}"}


@pytest.fixture
def parsed(monkeypatch):
    """How often sources were digested."""
    calls = []

    def counted(sources):
        calls.append(sources)
        return digest_of_sources(sources)

    monkeypatch.setattr(digests, "digest_of_sources", counted)
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    return calls


def test_the_same_files_are_digested_once(tmp_path, parsed):
    for _ in range(3):
        assert cached_digest(SOURCES, tmp_path) == digest_of_sources(SOURCES)
    assert len(parsed) == 1
    assert [path.suffix for path in tmp_path.iterdir()] == [".txt"]


@pytest.mark.parametrize(
    "other",
    [
        {**SOURCES, "a.py": b"x = 2  # one\n"},
        {**SOURCES, "b.json": b"[]"},
        {"c.py": SOURCES["a.py"], "b.json": b"{}"},
        {**SOURCES, "c.py": b""},
        {"a.py": b"x = 1  # one\n\0b.json\x002\0{}"[:13], "b.json": b"{} "},
    ],
)
def test_other_files_are_digested_anew(tmp_path, parsed, other):
    first = cached_digest(SOURCES, tmp_path)
    assert cached_digest(other, tmp_path) == digest_of_sources(other) != first
    assert len(parsed) == 2


def test_files_that_differ_in_a_comment_have_one_digest_kept_twice(tmp_path, parsed):
    other = {**SOURCES, "a.py": b"x = 1  # eins\n"}
    assert cached_digest(SOURCES, tmp_path) == cached_digest(other, tmp_path)
    assert (len(parsed), len(list(tmp_path.iterdir()))) == (2, 2)


def test_what_is_kept_broken_is_not_believed(tmp_path, parsed):
    whole = cached_digest(SOURCES, tmp_path)
    (kept,) = tmp_path.iterdir()
    for broken in (b"", b"0123", b"\xff" * 16, b"0" * 17):
        kept.write_bytes(broken)
        assert cached_digest(SOURCES, tmp_path) == whole
    assert len(parsed) == 5


def test_where_nothing_may_be_written_nothing_is(tmp_path, parsed, monkeypatch):
    assert cached_digest(SOURCES, tmp_path / "missing") == digest_of_sources(SOURCES)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert cached_digest(SOURCES, tmp_path) == digest_of_sources(SOURCES)
    assert list(tmp_path.iterdir()) == []
    assert len(parsed) == 2
