"""The mathematics of flocking in sympy: scalar functions, potentials, energies, transfer functions.

One of three witnesses of every fact (a derivation here, a fast kernel, a test that holds them together),
this layer imports no kernel. Identities come out as computed residuals, for generic n from one generic pair
and one generic agent, and again written out for a concrete small flock. Every result prints as LaTeX, by
itself in a notebook.

Examples
--------
>>> from flockana import symbolic
>>> symbolic.algorithm1_identity(m=2).residual, symbolic.e1_identity(m=2).holds
(0, False)
"""

from __future__ import annotations

from flockana.symbolic.concrete import ConcreteFlock
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.energy import EnergyIdentity, algorithm1_identity, structural_identity
from flockana.symbolic.errata import RisingEnergy, e1_counterexample, e1_identity
from flockana.symbolic.functions import adjacency, bump, phi, phi_alpha, phi_beta
from flockana.symbolic.norms import sigma_1, sigma_norm, sigma_norm_gradient
from flockana.symbolic.numeric import NumericLaw, numeric_law
from flockana.symbolic.pair import pair_force, pair_potential
from flockana.symbolic.parameters import ALPHA, BETA, GAINS, AlphaSymbols, BetaSymbols, GainSymbols
from flockana.symbolic.potentials import (
    alpha_antiderivative,
    derive_psi_alpha,
    derive_psi_beta,
    psi_alpha,
    psi_beta,
)
from flockana.symbolic.split import derive_split
from flockana.symbolic.sums import (
    collective_potential,
    half_square,
    hamiltonian,
    structural_hamiltonian,
    structural_potential,
    write_out,
)
from flockana.symbolic.translational import (
    damping_ratio,
    frequency_gain,
    natural_frequency,
    transfer_function,
)

__all__ = [
    "ALPHA",
    "BETA",
    "GAINS",
    "AlphaSymbols",
    "BetaSymbols",
    "ConcreteFlock",
    "Derivation",
    "EnergyIdentity",
    "GainSymbols",
    "NumericLaw",
    "RisingEnergy",
    "Step",
    "adjacency",
    "algorithm1_identity",
    "alpha_antiderivative",
    "bump",
    "collective_potential",
    "damping_ratio",
    "derive_psi_alpha",
    "derive_psi_beta",
    "derive_split",
    "e1_counterexample",
    "e1_identity",
    "frequency_gain",
    "half_square",
    "hamiltonian",
    "natural_frequency",
    "numeric_law",
    "pair_force",
    "pair_potential",
    "phi",
    "phi_alpha",
    "phi_beta",
    "psi_alpha",
    "psi_beta",
    "sigma_1",
    "sigma_norm",
    "sigma_norm_gradient",
    "structural_hamiltonian",
    "structural_identity",
    "structural_potential",
    "transfer_function",
    "write_out",
]
