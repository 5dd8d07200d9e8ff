"""Files of each kind, written by flockana of commit a74c204d before modules were moved, still load."""

import json
from pathlib import Path

import pytest

from flockana import Algorithm2, SineTarget, Trajectory, ZoneFlocking, check_certificate
from flockana.base.errors import FileError
from flockana.base.integrity_seals import is_sealed
from flockana.equilibria.equilibrium_files import read_equilibrium
from flockana.falsify import Counterexample

WRITTEN = Path(__file__).parent / "written"


def test_runs_load_as_evidence():
    run = Trajectory.load(WRITTEN / "run.nc")
    assert is_sealed(run)
    assert run.law == Algorithm2(target=SineTarget((0.0, 0.0), (1.0, 0.0), 2.0, 0.1))
    run = Trajectory.load(WRITTEN / "run_zone.nc")
    assert is_sealed(run)
    assert isinstance(run.law, ZoneFlocking)
    assert run.law.world.aliens


def test_a_law_changed_in_an_old_file_is_still_seen(tmp_path):
    import xarray

    with xarray.open_dataset(WRITTEN / "run.nc", engine="h5netcdf") as opened:
        data = opened.load()
    assert "seal" in data.attrs
    assert data.attrs["format_version"] == 1
    data.attrs["law"] = data.attrs["law"].replace("7.0", "7.5")
    data.to_netcdf(tmp_path / "changed.nc", engine="h5netcdf")
    with pytest.raises(FileError, match="is damaged: law not as saved"):
        Trajectory.load(tmp_path / "changed.nc")


def test_an_equilibrium_a_counterexample_and_certificates_load():
    assert read_equilibrium(WRITTEN / "equilibrium.json").kind == "minimum"
    assert Counterexample.load(WRITTEN / "counterexample.json").claim == "twice"
    for name in ("certificate.json", "tube_certificate.json"):
        assert check_certificate(WRITTEN / name)
        assert json.loads((WRITTEN / name).read_text())["digest"]
