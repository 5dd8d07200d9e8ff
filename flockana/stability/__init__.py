"""Linearised stability: Jacobians, modes, transfer functions, margins, norms and the design of gains."""

from flockana.stability.linearise import Linearisation, linearise
from flockana.stability.modes import Mode
from flockana.stability.motion import mode_motion
from flockana.stability.slowest import SlowModes, slowest_modes

__all__ = ["Linearisation", "Mode", "SlowModes", "linearise", "mode_motion", "slowest_modes"]
