"""The mathematics page: every formula printed from `flockana.symbolic`, so that it is what the code has."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from flockana import symbolic
from flockana.symbolic import bearing_distance, dead_zone
from tools.site.words import table

_Z, _S = sp.Symbol("z", nonnegative=True), sp.Symbol("s", real=True)
FORMULAS: dict[str, tuple[tuple[str, str, Callable[[], Any]], ...]] = {
    "Norms": (
        (r"\|z\|_\sigma", "sigma_norm", lambda: symbolic.sigma_norm(_Z)),
        (r"\nabla\|z\|_\sigma", "sigma_norm_gradient", lambda: symbolic.sigma_norm_gradient(_Z)),
        (r"\sigma_1(s)", "sigma_1", lambda: symbolic.sigma_1(_S)),
    ),
    "Bump, action and adjacency": (
        (r"\rho_h(z)", "bump", lambda: symbolic.bump(_Z)),
        (r"\phi(s)", "phi", lambda: symbolic.phi(_S)),
        (r"\phi_\alpha(z)", "phi_alpha", lambda: symbolic.phi_alpha(_Z)),
        (r"a(z)", "adjacency", lambda: symbolic.adjacency(_Z)),
        (r"\phi_\beta(z)", "phi_beta", lambda: symbolic.phi_beta(_Z)),
    ),
    "Energies": (
        ("c_1^\\alpha V", "collective_potential", symbolic.collective_potential),
        ("H", "hamiltonian", symbolic.hamiltonian),
        (r"c_1^\alpha U_\lambda", "structural_potential", symbolic.structural_potential),
        (r"H_\lambda", "structural_hamiltonian", symbolic.structural_hamiltonian),
    ),
    "Centre of mass": (
        (r"\omega_0", "natural_frequency", symbolic.natural_frequency),
        (r"\zeta", "damping_ratio", symbolic.damping_ratio),
        ("G(s)", "transfer_function", symbolic.transfer_function),
        (r"|G(i\omega)|", "frequency_gain", symbolic.frequency_gain),
    ),
    "Dead zone (Li, Yuan, Liu)": (
        ("F(\\rho)", "dead_zone.force", dead_zone.force),
        ("\\psi(\\rho)", "dead_zone.potential", dead_zone.potential),
    ),
    "Bearing and distance (Jond)": (
        (r"\mathrm{sat}(x)\,/\,x", "bearing_distance.saturation", bearing_distance.saturation),
        (r"\text{rest distance}", "bearing_distance.rest_distance", bearing_distance.rest_distance),
        (r"\text{altitude}", "bearing_distance.altitude", bearing_distance.altitude),
    ),
}
DERIVATIONS: tuple[tuple[str, Callable[[], Any]], ...] = (
    ("derive_psi_alpha", symbolic.derive_psi_alpha),
    ("derive_psi_beta", symbolic.derive_psi_beta),
    ("algorithm1_identity", symbolic.algorithm1_identity),
    ("derive_split", symbolic.derive_split),
    ("structural_identity", symbolic.structural_identity),
    ("e1_identity", symbolic.e1_identity),
    ("dead_zone.derive_potential", dead_zone.derive_potential),
)
NOTATION = (
    ("$n$, $m$", "agents, dimension", "`n`, `m`"),
    ("$q_i$, $p_i$, $u_i$", "position, velocity, input of agent $i$", "`q`, `p`, `u`, arrays of shape (n, m)"),
    ("$d$, $r$", "spacing wanted, range", "`d`, `r` (length)"),
    (r"$\epsilon$, $h$", "of the σ-norm; where the bump begins to fall", "`eps`, `h`"),
    ("$a$, $b$, $c$", "of the uneven sigmoid φ", "`a`, `b`"),
    (r"$c_1^\alpha, c_2^\alpha$", "gains of pair force and consensus", "`c1_alpha`, `c2_alpha`"),
    (r"$c_1^\beta, c_2^\beta$", "gains of obstacles", "`c1_beta`, `c2_beta`"),
    (r"$c_1^\gamma, c_2^\gamma$", "gains of the γ-agent", "`c1_gamma`, `c2_gamma`"),
    ("$q_r$, $p_r$", "position and velocity of the γ-agent", "`target`"),
    (r"$x_i$, $v_i$", "position and velocity in the frame of the centre of mass", ""),
    (
        "$V$, $J$, $K$",
        "potential of the pairs, moment of inertia, velocity mismatch",
        "`energy`, `inertia`, `velocity_mismatch`",
    ),
    ("$c^*$", "ψ_α(0), the energy of one coincident pair", "`c_star`"),
    (r"$\lambda$", r"$c_1^\gamma$ in $U_\lambda$; elsewhere an eigenvalue", ""),
    (r"$\tilde E$, $\tilde K$", "deviation energy over $d^2$, mismatch over $n$", "`normalised_deviation_energy`, …"),
    ("$C$, $R$", "connectivity, cohesion radius", "`connectivity`, `cohesion_radius`"),
)
_OPENING = """\
# Mathematics

Nothing on this page but the notation table is typed: each formula is printed by the function of `flockana.symbolic`
that stands beside it, and tests hold the compiled kernels against the same functions.
"""


def page() -> str:
    """The page as Markdown."""
    parts = [_OPENING, "## Notation", table(("symbol", "what", "in the code"), NOTATION)]
    for title, formulas in FORMULAS.items():
        parts.append(f"## {title}")
        parts += [f"`{name}`:\n\n$$\n{left} = {sp.latex(make())}\n$$" for left, name, make in formulas]
    parts.append("## Derivations")
    for name, make in DERIVATIONS:
        derived = make()
        holds = "the residual, computed, is 0" if derived.holds else "the residual, computed, is **not** 0: it is false"
        parts += [f"### `{name}`", f"As computed: {holds}.", f"$$\n{derived.latex()}\n$$"]
    return "\n\n".join(parts) + "\n"
