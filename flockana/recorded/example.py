"""The synthetic recording that is shipped, made by `tools/make_recording.py`: noise, gaps and an identity switch."""

from importlib.resources import as_file, files

from flockana.recorded.read import read_recording
from flockana.recorded.recording import Recording

NOISE = 0.05


def example_recording() -> Recording:
    """Return fourteen tracked agents over six time units: noise of 0.05, gaps, and a switch of two names."""
    with as_file(files("flockana.recorded") / "data" / "synthetic.csv") as path:
        return read_recording(path, sd=NOISE)
