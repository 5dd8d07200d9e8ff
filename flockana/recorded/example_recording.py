"""Synthetic example recording, made by `tools/make_recording.py`: noise, gaps and an identity switch."""

from pathlib import Path

from flockana.recorded.recording import Recording
from flockana.recorded.recording_reader import read_recording

NOISE = 0.05
EXAMPLE_FILE = Path(__file__).parent / "data" / "synthetic.csv"


def example_recording() -> Recording:
    """Return fourteen tracked agents over six time units: noise of 0.05, gaps, and a switch of two identities."""
    return read_recording(EXAMPLE_FILE, sd=NOISE)
