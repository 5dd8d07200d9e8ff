"""What the mathematics page prints: sections of formulas and of derivations, each by the function that has it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from flockana import symbolic
from flockana.symbolic import (
    algorithm3_energy,
    dead_zone,
    energy_balances,
    errata,
    linearisation,
    obstacles,
    spanning_trees,
    translational_dynamics,
)
from flockana.symbolic import bearing_distance as zone
from flockana.symbolic.generic_pair import own_force, vector

Made = Callable[[], Any]
_Z, _S = sp.Symbol("z", nonnegative=True), sp.Symbol("s", real=True)
_TREE = ((0, 1), (0, 2), (1, 3))  # a root with two followers, one of which is followed


def _pair() -> tuple[sp.Matrix, ...]:
    return tuple(vector(name, 2) for name in ("q_i", "q_j", "p_i", "p_j"))


def _agent() -> tuple[sp.Matrix, ...]:
    return tuple(vector(name, 2) for name in ("q_i", "p_i", "q_r", "p_r"))


def _beta(kind: str, row: int) -> sp.Matrix:
    q, p, y, a = (vector(name, 2) for name in ("q_i", "p_i", "y_k", "a_k"))
    if kind == "wall":
        return obstacles.wall_beta(q, p, y, a)[row]
    return obstacles.sphere_beta(q, p, y, obstacles.RADIUS)[row]


FORMULAS: dict[str, tuple[tuple[str, str, Made], ...]] = {
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
    "Potentials": (
        (r"\int \phi_\alpha", "alpha_antiderivative", lambda: symbolic.alpha_antiderivative(_Z)),
        (r"\psi_\alpha(z)", "psi_alpha", lambda: symbolic.psi_alpha(_Z)),
        (r"\psi_\beta(z)", "psi_beta", lambda: symbolic.psi_beta(_Z)),
        (r"c_1^\alpha \psi_\alpha", "pair_potential", lambda: symbolic.pair_potential(*_pair()[:2])),
    ),
    "Forces": (
        (r"f_{ij}", "pair_force", lambda: symbolic.pair_force(*_pair())),
        (r"f_i^\gamma", "pair.own_force", lambda: own_force(*_agent())),
        (
            r"f_i^\gamma \text{ of Algorithm 3}",
            "algorithm3_energy.gamma_force",
            lambda: algorithm3_energy.gamma_force(*_agent()),
        ),
    ),
    "Obstacles": (
        (r"\hat q_{i,k} \text{ of a wall}", "obstacles.wall_beta", lambda: _beta("wall", 0)),
        (r"\hat p_{i,k} \text{ of a wall}", "obstacles.wall_beta", lambda: _beta("wall", 1)),
        (r"\hat q_{i,k} \text{ of a sphere}", "obstacles.sphere_beta", lambda: _beta("sphere", 0)),
        (r"\hat p_{i,k} \text{ of a sphere}", "obstacles.sphere_beta", lambda: _beta("sphere", 1)),
        (
            r"\langle p, \hat p - p\rangle \text{ at a wall, its terms}",
            "obstacles.derive_braking",
            lambda: sp.Tuple(*obstacles.derive_braking("wall").terms),
        ),
        (
            r"\langle p, \hat p - p\rangle \text{ at a sphere, its terms}",
            "obstacles.derive_braking",
            lambda: sp.Tuple(*obstacles.derive_braking("sphere").terms),
        ),
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
        (
            r"\mathrm{d}|G|^2/\mathrm{d}(\omega^2)",
            "translational_dynamics.gain_slope",
            translational_dynamics.gain_slope,
        ),
        (
            r"\text{it falls if } 0 <",
            "translational_dynamics.falling_condition",
            translational_dynamics.falling_condition,
        ),
    ),
    "Dead zone (Li, Yuan, Liu)": (
        (r"F^-(\rho)", "dead_zone.repulsion", dead_zone.repulsion),
        (r"F^+(\rho)", "dead_zone.attraction", dead_zone.attraction),
        (r"\text{direction}", "dead_zone.direction", dead_zone.direction),
        (r"\text{action}", "dead_zone.action", dead_zone.action),
        ("F(\\rho)", "dead_zone.force", dead_zone.force),
        (r"\int F^-", "dead_zone.repulsive_primitive", dead_zone.repulsive_primitive),
        (r"\int F^+", "dead_zone.attractive_primitive", dead_zone.attractive_primitive),
        ("\\psi(\\rho)", "dead_zone.potential", dead_zone.potential),
        (
            r"\text{limits of } F \text{ left and right of its jumps}",
            "dead_zone.jumps",
            lambda: sp.Tuple(
                *(sp.Eq(sp.Symbol(name), sp.Tuple(*ends), evaluate=False) for name, ends in dead_zone.jumps().items())
            ),
        ),
    ),
    "Bearing and distance (Jond)": (
        (r"d_{ij}", "bearing_distance.bearing", lambda: zone.bearing()[0]),
        (r"b_{ij}", "bearing_distance.bearing", lambda: zone.bearing()[1]),
        (r"\dot d_{ij}", "bearing_distance.bearing", lambda: sp.simplify(zone.bearing()[2])),
        *(
            (
                rf"\text{{{name}, from positions}}",
                "bearing_distance.position_form",
                lambda n=name: zone.position_form()[n],
            )
            for name in ("cohesion", "alignment", "separation")
        ),
        (r"v(t+\delta) - \hat v(t+\delta)", "bearing_distance.estimate_gap", zone.estimate_gap),
        (r"\mathrm{sat}", "bearing_distance.saturation", zone.saturation),
        (r"\text{stand-off}", "bearing_distance.stand_off", zone.stand_off),
        (r"\text{distance at rest}", "bearing_distance.rest_distance", zone.rest_distance),
        (r"\text{altitude}", "bearing_distance.altitude", zone.altitude),
        (r"M \text{ of an informed pair}", "bearing_distance.informed_pair", lambda: zone.informed_pair()[0]),
        (r"\det(\lambda I - M)", "bearing_distance.informed_pair", lambda: zone.informed_pair()[1]),
    ),
    "Spanning trees": (
        (r"D", "spanning_trees.incidence_matrix", lambda: spanning_trees.incidence_matrix(_TREE)),
        (r"B", "spanning_trees.receiver_matrix", lambda: spanning_trees.receiver_matrix(_TREE)),
        (
            r"\text{frozen eigenvalues}",
            "spanning_trees.frozen_eigenvalues",
            lambda: sp.Tuple(*spanning_trees.frozen_eigenvalues(sp.Symbol("r", positive=True))),
        ),
    ),
}
DERIVATIONS: dict[str, tuple[tuple[str, Made], ...]] = {
    "Potentials and splitting": (
        ("derive_psi_alpha", symbolic.derive_psi_alpha),
        ("derive_psi_beta", symbolic.derive_psi_beta),
        ("derive_split", symbolic.derive_split),
        ("errata.reynolds_form", errata.reynolds_form),
    ),
    "Energy along the flow": (
        ("algorithm1_identity", symbolic.algorithm1_identity),
        ("structural_identity", symbolic.structural_identity),
        ("e1_identity", symbolic.e1_identity),
        ("energy_balances.matching_identity", energy_balances.matching_identity),
        ("energy_balances.given_frame_identity", energy_balances.given_frame_identity),
        ("energy_balances.moving_frame_identity", energy_balances.moving_frame_identity),
        ("energy_balances.copies_balance", energy_balances.copies_balance),
        ("energy_balances.copies_part", energy_balances.copies_part),
    ),
    "Obstacles and Theorem 6": (
        ('obstacles.derive_envelope("wall")', lambda: obstacles.derive_envelope("wall")),
        ('obstacles.derive_envelope("sphere")', lambda: obstacles.derive_envelope("sphere")),
        ("algorithm3_energy.theorem6_identity", algorithm3_energy.theorem6_identity),
        ("algorithm3_energy.e2_identity", algorithm3_energy.e2_identity),
    ),
    "Jacobians": (
        ("linearisation.derive_pair_jacobian", linearisation.derive_pair_jacobian),
        ("linearisation.derive_agent_jacobian", linearisation.derive_agent_jacobian),
        ('linearisation.derive_obstacle_jacobian("wall")', lambda: linearisation.derive_obstacle_jacobian("wall")),
        ('linearisation.derive_obstacle_jacobian("sphere")', lambda: linearisation.derive_obstacle_jacobian("sphere")),
    ),
    "Zones and dead zone": (
        ("bearing_distance.derive_equivalence", zone.derive_equivalence),
        ("dead_zone.derive_potential", dead_zone.derive_potential),
        ("dead_zone.saturated_energy_identity", dead_zone.saturated_energy_identity),
        ("energy_balances.led_energy_identity", energy_balances.led_energy_identity),
    ),
    "Trees": (
        ("spanning_trees.stacked_form", lambda: spanning_trees.stacked_form(_TREE)),
        ("spanning_trees.tree_characteristic", lambda: spanning_trees.tree_characteristic(_TREE)),
        ("spanning_trees.symmetric_part", lambda: spanning_trees.symmetric_part(2)),
        ("spanning_trees.spacing_spectrum", lambda: spanning_trees.spacing_spectrum(2)),
    ),
}
