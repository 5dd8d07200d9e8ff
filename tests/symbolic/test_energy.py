"""The energy identities as theorems of the algebra, the split, erratum E1, and mutants that must not pass."""

import math

import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic import GAINS, ConcreteFlock, derive_split, energy, generic_pair, sigma_norms, sums_over_pairs
from flockana.symbolic.algorithm3_energy import theorem6_identity
from flockana.symbolic.energy import algorithm1_identity, structural_identity
from flockana.symbolic.errata import e1_counterexample, e1_identity
from flockana.symbolic.obstacles import derive_envelope
from flockana.symbolic.potentials import derive_psi_alpha

DIMENSIONS = pytest.mark.parametrize("m", [1, 2, 3])


@DIMENSIONS
def test_identities_hold_for_generic_n(m: int) -> None:
    for identity in (algorithm1_identity(m), structural_identity(m)):
        assert identity.residual == 0
        assert identity.rate == identity.claimed
        assert identity.rate.has(sums_over_pairs.N)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["algorithm1", "algorithm2"])
@pytest.mark.parametrize(("n", "m"), [(1, 2), (2, 1), (2, 3), (3, 2), (4, 1), (5, 1)])
def test_lifting_agrees_with_the_flock_written_out(law: str, n: int, m: int) -> None:
    """Generic sums at n agents against H and -c2 p^T L p formed from all agents and the Laplacian matrix."""
    flock = ConcreteFlock(law, n, m)
    identity = algorithm1_identity(m) if law == "algorithm1" else structural_identity(m)
    assert sp.expand(flock.expand(identity.energy) - flock.energy) == 0
    assert sp.expand(flock.expand(identity.rate) - flock.claimed) == 0


@pytest.mark.parametrize("factor", [1, sp.Rational(1, 3), 0])
def test_a_wrong_kinetic_factor_leaves_a_residual(factor: sp.Expr) -> None:
    assert not algorithm1_identity(2, kinetic_factor=sp.sympify(factor)).holds


def test_a_wrong_lambda_leaves_exactly_its_excess() -> None:
    excess = sp.Symbol("mu", positive=True)
    identity = structural_identity(1, lambda_=GAINS.c1_gamma + excess)
    x, v = sums_over_pairs.X[sums_over_pairs.I_, 1], sums_over_pairs.V[sums_over_pairs.I_, 1]
    assert sp.expand(identity.residual - sums_over_pairs.over_agents(excess * x * v)) == 0


def _one_sided(q_i, p_i, q_j, p_j, *, gains=GAINS):  # type: ignore[no-untyped-def]
    return (
        generic_pair.pair_force(q_i, p_i, q_j, p_j, gains=gains) + gains.c2_alpha * generic_pair.ADJACENCY(q_i[0]) * p_j
    )


def _doubled(q_i, p_i, q_j, p_j, *, gains=GAINS):  # type: ignore[no-untyped-def]
    return 2 * generic_pair.pair_force(q_i, p_i, q_j, p_j, gains=gains)


@pytest.mark.parametrize("mutant", [_one_sided, _doubled])
def test_a_wrong_force_leaves_a_residual(mutant: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(energy, "pair_force", mutant)
    assert not algorithm1_identity(2).holds
    assert not structural_identity(2).holds
    assert not derive_split(2).holds


@DIMENSIONS
def test_algorithm_2_splits(m: int) -> None:
    derivation = derive_split(m)
    assert derivation.holds
    assert len(derivation.residuals) == 4 * m
    own, translational = derivation.result
    frame = {symbol for name in ("q_c", "p_c", "q_r", "p_r") for symbol in generic_pair.vector(name, m)}
    assert not own.free_symbols & frame
    assert translational.free_symbols <= frame | {GAINS.c1_gamma, GAINS.c2_gamma}
    assert sp.hessian(sum(translational), sorted(frame, key=str)).is_zero_matrix


@DIMENSIONS
def test_e1_leaves_exactly_minus_the_rate_of_v_and_the_dissipation(m: int) -> None:
    i, j = sums_over_pairs.I_, sums_over_pairs.J_
    z = sums_over_pairs.Z[i, j]
    relative = [
        (sums_over_pairs.Q[i, k] - sums_over_pairs.Q[j, k], sums_over_pairs.P[i, k] - sums_over_pairs.P[j, k])
        for k in range(1, m + 1)
    ]
    v_rate = GAINS.c1_alpha * generic_pair.PHI(z) / (1 + sigma_norms.EPS * z) * sp.Add(*(y * w for y, w in relative))
    dissipated = GAINS.c2_alpha * generic_pair.ADJACENCY(z) * sp.Add(*(w**2 for _, w in relative))
    identity = e1_identity(m)
    assert identity.residual == sums_over_pairs.over_pairs(-v_rate) + sums_over_pairs.over_pairs(-dissipated)
    assert sp.expand(identity.rate - identity.claimed - identity.residual) == 0
    assert identity.steps[-1].equation == identity.residual


def test_the_printed_hamiltonian_rises_at_a_rational_state() -> None:
    """By hand: -dV/dt - 2 c2 w^2 with w = 1/5 at distance 2, where the bump is 1 and phi_alpha repels."""
    found = e1_counterexample()
    assert all(number.is_Rational for number in (*found.q, *found.p, found.alpha.eps, found.alpha.h, found.alpha.r))
    z, d_alpha = (math.sqrt(1.4) - 1) / 0.1, (math.sqrt(5.9) - 1) / 0.1
    v_rate = 5 * (z - d_alpha) / math.hypot(1, z - d_alpha) * 2 / math.sqrt(1.4) * 0.2
    assert float(found.rate) == pytest.approx(-v_rate - 2 * 0.04, rel=1e-14)
    assert found.rate.is_positive
    assert found.true_rate == -sp.Rational(1, 25)


@pytest.mark.parametrize("m", [0, 4, 2.5, "2"])
def test_a_bad_dimension_is_named(m: object) -> None:
    for derive in (algorithm1_identity, structural_identity, derive_split, e1_identity):
        with pytest.raises(ArgumentError, match=f"m = {m!r}: expected a dimension of 1, 2 or 3"):
            derive(m)  # type: ignore[operator]


def test_everything_prints_as_latex() -> None:
    identities = algorithm1_identity(2), structural_identity(3), e1_identity(1), derive_split(2), theorem6_identity(2)
    results = (*identities, derive_psi_alpha(), derive_envelope("sphere"), ConcreteFlock("algorithm2", 2, 1))
    for result in results:
        text = result.latex()
        assert text.isascii()
        assert text.count("{") == text.count("}")
        assert text.count("$") % 2 == 0
        assert text.startswith("\\begin{aligned}\n& \\textbf{")
        assert text.endswith("\\end{aligned}")
        assert result._repr_latex_() == f"$${text}$$"
    cases = derive_psi_alpha().latex()
    assert r"\text{if } h r_{\alpha} \geq d_{\alpha} \wedge z \leq h r_{\alpha}" in cases
    assert r"\text{if } z \leq h r_{\alpha} \wedge h r_{\alpha} < d_{\alpha}" in cases
