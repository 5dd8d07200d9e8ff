"""The command line as tests of its commands call it."""

from tests.cli.conftest import call, offer, refused

__all__ = ["call", "offer", "refused"]
