"""Records of equilibria: verified when they are read, and refused when they are not what they say."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, DeadZoneFlocking, find_equilibrium
from flockana.base.errors import FileError
from flockana.base.integrity_seals import sealed
from flockana.equilibria.equilibrium_files import read_equilibrium, smallest_strained, write_equilibrium
from flockana.lattice import hexagonal_patch

LAW = Algorithm1()


def test_it_is_written_down_and_read_again(tmp_path):
    found = find_equilibrium(DeadZoneFlocking(), hexagonal_patch(1, 3.5))
    write_equilibrium(found, tmp_path / "seven.json")
    again = read_equilibrium(tmp_path / "seven.json")
    assert (again.law, again.strain(), again.kind) == (found.law, found.strain(), "minimum")


def test_the_recorded_minimum_is_strained_by_the_kernels_alone():
    """Nothing of the solver: forces vanish, links are not d, and differences of the force give a positive Hessian."""
    found = smallest_strained()
    q, alpha = found.q, LAW.alpha
    assert np.abs(LAW.acceleration(0.0, q, 0.0 * q)).max() < 1e-9
    lengths = np.linalg.norm(q[found.links[:, 1]] - q[found.links[:, 0]], axis=1)
    assert (len(q), len(lengths)) == (13, 24)
    assert (lengths.min(), lengths.max()) == pytest.approx((6.848808, 7.116341), abs=1e-6)
    assert np.linalg.norm(q[:, None] - q[None], axis=2)[np.triu_indices(13, 1)].min() > 6.0
    step, columns = 1e-5, []
    for k in range(q.size):
        nudge = np.zeros(q.size)
        nudge[k] = step
        nudge = nudge.reshape(q.shape)
        columns.append(
            (LAW.acceleration(0.0, q - nudge, 0 * q) - LAW.acceleration(0.0, q + nudge, 0 * q)).ravel() / (2 * step)
        )
    eigenvalues = np.linalg.eigvalsh(0.5 * (np.array(columns) + np.array(columns).T))
    assert np.abs(eigenvalues[:3]).max() < 1e-4
    assert eigenvalues[3] == pytest.approx(39.342, abs=1e-2)
    assert alpha.d == 7.0


def test_a_record_is_verified_when_read(tmp_path):
    path = tmp_path / "found.json"
    write_equilibrium(smallest_strained(), path)
    again = read_equilibrium(path)
    np.testing.assert_allclose(again.q, smallest_strained().q, atol=1e-12)
    data = json.loads(path.read_text())
    for change, message in (
        ({"kind": "saddle"}, "claims kind"),
        (
            {"q": (again.q + 0.1 * np.eye(*again.q.shape)).tolist()},
            "its positions are none of its law; the file is damaged or was edited: take it",
        ),
        ({"hessian_eigenvalues": [1.0] * 23}, "Hessian eigenvalues"),
        ({"energy": 1.0}, "claims an energy of 1.0, .* is computed; the file is damaged"),
        ({"format": "other"}, "its format is 'other'"),
    ):
        path.write_text(json.dumps(data | change))
        with pytest.raises(FileError, match=message) as told:
            read_equilibrium(path)
        assert "max_iter" not in str(told.value)  # the solver's advice
    path.write_text(json.dumps({key: data[key] for key in data if key != "q"}))
    with pytest.raises(FileError, match="it lacks 'q'; the file is damaged or was edited"):
        read_equilibrium(path)
    with pytest.raises(FileError, match="cannot write"):
        write_equilibrium(again, tmp_path / "no" / "such.json")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{}", "holds no equilibrium: expected JSON of the format 'flockana equilibrium 1', as 'flockana equilibrium "),
        ("[]", "holds no equilibrium: expected JSON of the format 'flockana equilibrium 1'"),
        ("3", "holds no equilibrium: expected JSON of the format 'flockana equilibrium 1'"),
        ("x", "holds no equilibrium: it is no JSON (Expecting value: line 1 column 1 (char 0)); expected JSON of the "),
        ('{"format": []}', "its format is []; expected JSON of the format 'flockana equilibrium 1'"),
    ],
)
def test_what_is_no_record_says_what_is_expected(tmp_path, text, message):
    (tmp_path / "obj.json").write_text(text)
    with pytest.raises(FileError, match=re.escape(message)):
        read_equilibrium(tmp_path / "obj.json")


def test_a_lattice_without_energy_reads_back(tmp_path):
    """A bond of length d has the energy 0, to rounding: relative to itself no other machine would agree."""
    bond = find_equilibrium(LAW, [[0.0], [6.9]])
    assert abs(bond.energy) < 1e-12
    for energy in (0.0, 1e-13, -1e-28):
        write_equilibrium(sealed(replace(bond, energy=energy)), tmp_path / "bond.json")
        assert read_equilibrium(tmp_path / "bond.json").kind == "minimum"
    write_equilibrium(sealed(replace(bond, energy=1.0)), tmp_path / "bond.json")
    with pytest.raises(FileError, match="claims an energy"):
        read_equilibrium(tmp_path / "bond.json")
