import numpy as np
import pytest

from flockana.base.errors import FileError
from flockana.base.integrity_seals import checksum, digest, with_digest, without_digest
from tests.refused import refused

DATA = {"a": [1.0, -0.0, 1e-300], "b": {"c": None, "d": "e"}, "f": float("nan")}


@pytest.mark.parametrize(
    "change", [{"a": [1.0, 0.0, 1e-300]}, {"a": [1, -0.0, 1e-300]}, {"b": {}}, {"g": 1}, {"digest": "0"}, {"f": None}]
)
def test_every_change_is_seen(change):
    assert str(without_digest(with_digest(DATA))) == str(DATA)
    with pytest.raises(FileError, match="its digest is not that of its contents"):
        without_digest(with_digest(DATA) | change)


test_a_file_whose_digest_was_taken_out_or_that_holds_more_is_refused = refused(
    (lambda: without_digest(DATA), "it has no digest, which every file is written with", FileError),
    (
        lambda: without_digest(with_digest(DATA), keys=["a", "b"]),
        "it holds f: expected a, b and digest, nothing else",
        FileError,
    ),
)


def test_the_order_of_names_does_not_matter_and_that_of_items_does():
    assert digest({"a": 1, "b": 2}) == digest({"b": 2, "a": 1})
    assert digest([1, 2]) != digest([2, 1])


@pytest.mark.parametrize(
    "other",
    [
        np.arange(6.0).reshape(3, 2),
        np.arange(6),
        np.nextafter(np.arange(6.0), 9.0),
        np.array(["0", "1", "2", "3", "4", "5"]),
        np.arange(6.0)[::-1],
    ],
)
def test_a_checksum_tells_shapes_kinds_and_bits_apart(other):
    assert checksum(other) != checksum(np.arange(6.0))


def test_how_an_array_is_stored_does_not_matter():
    values = np.arange(12.0).reshape(3, 4)
    same = (np.asfortranarray(values), np.repeat(values, 2, axis=0)[::2], values.astype(">f8"), values.tolist())
    assert {checksum(one) for one in same} == {checksum(values)}
    assert checksum(np.array(["x"], dtype=object)) == checksum(np.array(["x"]))
