"""Linearised stability: Jacobians, modes, transfer functions, margins, norms and the design of gains."""

from flockana.stability.blocks import Blocks, blocks, law_blocks
from flockana.stability.decay import decay_table, linear_range
from flockana.stability.delay import (
    DelayMargin,
    delay_margin,
    delay_system,
    rightmost_roots,
    scalar_margin,
)
from flockana.stability.delayed_run import DelayedRun, simulate_delayed
from flockana.stability.design import GainDesign, design_gains, gain_problem
from flockana.stability.linearise import Linearisation, linearise
from flockana.stability.modes import Mode
from flockana.stability.motion import mode_motion
from flockana.stability.norms import disturbance_system, h2_norm, hinf_norm, norms_against_size
from flockana.stability.slowest import SlowModes, slowest_modes
from flockana.stability.sweeps import centre_locus, gain_sweep, margin_sweep
from flockana.stability.tracking import response_ratio, steady_error, tracking
from flockana.stability.translational import CentreOfMass, predicted_gain

__all__ = [
    "Blocks",
    "CentreOfMass",
    "DelayMargin",
    "DelayedRun",
    "GainDesign",
    "Linearisation",
    "Mode",
    "SlowModes",
    "blocks",
    "centre_locus",
    "decay_table",
    "delay_margin",
    "delay_system",
    "design_gains",
    "disturbance_system",
    "gain_problem",
    "gain_sweep",
    "h2_norm",
    "hinf_norm",
    "law_blocks",
    "linear_range",
    "linearise",
    "margin_sweep",
    "mode_motion",
    "norms_against_size",
    "predicted_gain",
    "response_ratio",
    "rightmost_roots",
    "scalar_margin",
    "simulate_delayed",
    "slowest_modes",
    "steady_error",
    "tracking",
]
