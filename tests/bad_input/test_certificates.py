import copy
import json

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import FileError
from flockana.base.integrity_seals import with_digest
from flockana.certified.certificate_check import RejectedError, check_data
from tests.bad_input.test_fuzz import flipped, shortened

WEIRD = (None, True, -1, 1.5, "", "nan", "1e999999", "0x1p4000", "1/0", [], {}, "9" * 1000, {"__class__": "x"})


@pytest.fixture(scope="module", params=["basin", "tube"])
def certificate(request, tmp_path_factory):
    path, law = tmp_path_factory.mktemp("certified") / "pair.json", fl.Algorithm1()
    if request.param == "basin":
        fl.write_certificate(fl.certify([[0.0], [7.0]], law=law), path)
    else:
        fl.write_tube_certificate(fl.enclose(law, [[0.0], [7.0]], [[10.0], [-10.0]], (0.0, 0.0009765625)), path)
    return path.read_bytes()


def test_a_damaged_certificate_is_refused_or_rejected(tmp_path, certificate):
    path, outcomes = tmp_path / "it.json", []
    for content in (*flipped(certificate, 300), *shortened(certificate, 60)):
        path.write_bytes(content)
        with pytest.raises((FileError, RejectedError)) as told:
            fl.check_certificate(path)
        outcomes.append(told.type)
    assert set(outcomes) == {FileError, RejectedError}


def places(value, path=()):
    """Every place of the data, long lists by their first two entries."""
    if path:
        yield path
    if isinstance(value, dict | list):
        entries = value.items() if isinstance(value, dict) else list(enumerate(value))[:2]
        for key, inner in entries:
            yield from places(inner, (*path, key))


def test_one_that_was_sealed_again_is_rejected(certificate):
    """Its digest fits: what is not as it must be is seen by what it says. No text here is a number that would do."""
    data = json.loads(certificate)
    at = [path for path in places(data) if path[0] not in ("digest", "made_with")]
    rng = np.random.default_rng(0)
    for k, path in enumerate(at):
        changed = copy.deepcopy({key: value for key, value in data.items() if key != "digest"})
        inner = changed
        for key in path[:-1]:
            inner = inner[key]
        turned = np.roll(np.arange(len(WEIRD)), k + int(rng.integers(len(WEIRD))))
        inner[path[-1]] = next(WEIRD[j] for j in turned if WEIRD[j] != inner[path[-1]])
        try:
            check_data(with_digest(changed))
        except RejectedError:
            continue
        pytest.fail(f"{path}: {inner[path[-1]]!r} is believed")
