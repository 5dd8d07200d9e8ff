import os
import sys

import pytest

from flockana.cli import matplotlib_folder

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere matplotlib chooses otherwise")


@pytest.fixture
def prepared(monkeypatch, tmp_path):
    """What matplotlib's folder is with such a home."""
    monkeypatch.setattr(matplotlib_folder.tempfile, "gettempdir", lambda: str(tmp_path))

    def prepare(folder, **environment):
        for name in ("MPLCONFIGDIR", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"):
            monkeypatch.setenv(name, "")  # so that it is restored
            monkeypatch.delenv(name)
        for name, value in {"HOME": str(folder), **environment}.items():
            monkeypatch.setenv(name, value)
        matplotlib_folder.prepare_home()
        return os.environ.get("MPLCONFIGDIR")

    return prepare


@pytest.fixture
def no_home(tmp_path):
    """A home that nobody can make, root neither."""
    file = tmp_path / "file"
    file.touch()
    return file / "home"


def test_a_home_that_cannot_be_made_is_replaced_by_a_private_folder(prepared, tmp_path, no_home):
    folder = tmp_path / f"flockana-matplotlib-{os.getuid()}"
    for _ in range(2):  # the second time it is there
        assert prepared(no_home) == str(folder)
    assert folder.stat().st_mode & 0o777 == 0o700
    folder.chmod(0o777)
    assert prepared(no_home) is None


def test_a_home_that_can_be_written_and_a_users_choice_stay(prepared, tmp_path, no_home):
    good = tmp_path / "good"
    assert prepared(good) is None
    assert prepared(no_home, XDG_CONFIG_HOME=str(good), XDG_CACHE_HOME=str(good)) is None
    assert prepared(no_home, XDG_CONFIG_HOME=str(good)) is not None
    assert prepared(no_home, MPLCONFIGDIR="chosen") == "chosen"
    assert not good.exists()
