"""A test that hangs fails in time and takes no other with it, in compiled code too, with and without xdist."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.programs import posix

pytestmark = posix
CONFIGURATION = Path(__file__).parents[1] / "pyproject.toml"
HANGING = """
import signal, time
from pathlib import Path

def test_hangs():
    {}
    time.sleep(3600.0)

def test_after():
    Path("after").touch()
"""


def outcome(folder, body, *options):
    """What pytest says of a test that hangs, by our configuration but with shorter limits."""
    (folder / "test_hanging.py").write_text(HANGING.format(body))
    command = [sys.executable, "-m", "pytest", "-c", CONFIGURATION, "--rootdir", folder, "-p", "no:cacheprovider"]
    limits = ["-o", "timeout=2", "-o", "faulthandler_timeout=5"]
    return subprocess.run([*command, *limits, *options, folder], capture_output=True, text=True, cwd=folder)


@pytest.mark.parametrize("options", [["-p", "no:xdist"], ["-n", "1"]], ids=["alone", "xdist"])
@pytest.mark.parametrize("hears", [True, False])  # as in compiled code, where the signal is not heard
def test_a_test_that_hangs_fails_or_ends_its_process(hears, options, tmp_path):
    done = outcome(
        tmp_path, "pass" if hears else "signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})", *options
    )
    said, words = (done.stdout, "test_hangs - Failed: Timeout (>2.0s)") if hears else (done.stderr, "in test_hangs")
    assert done.returncode == 1
    assert words in said
    assert (tmp_path / "after").exists() == (hears or "-n" in options)  # xdist starts another process for the rest


def test_no_mark_gives_more_time_than_the_process_has(pytestconfig, request):
    longest = float(pytestconfig.getini("faulthandler_timeout"))
    limits = [float(pytestconfig.getini("timeout"))]
    limits += [mark.args[0] for item in request.session.items for mark in item.iter_markers("timeout")]
    assert 0.0 < max(limits) < longest
    assert pytestconfig.getini("faulthandler_exit_on_timeout")
