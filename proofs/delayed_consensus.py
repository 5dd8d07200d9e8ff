"""Olfati-Saber and Murray: x' = −L x(t − τ) agrees if and only if τ < π/(2 λ_n), L symmetric of a connected net."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import sympy as sp
import z3

from flockana.sources.olfati_saber_murray_2004.theorems.delayed_consensus import root_enclosure
from proofs.proof import Proof, Step
from proofs.smt import implication, impossible

_SIDES = (Fraction(1, 2), Fraction(99, 100), Fraction(101, 100), Fraction(2))


def _modes() -> Iterator[Step]:
    n = 4
    weights = {(i, j): sp.Symbol(f"a{i}{j}", positive=True) for j in range(n) for i in range(j)}
    matrix = sp.zeros(n)
    for (i, j), a in weights.items():
        matrix[i, i], matrix[j, j] = matrix[i, i] + a, matrix[j, j] + a
        matrix[i, j] = matrix[j, i] = -a
    yield Step(
        "L is symmetric, so that x = Σ x_k v_k in its eigenvectors splits the system into x_k' = -λ_k x_k(t - τ); "
        "λ = 0 belongs to (1, ..., 1) alone, as the net is connected, and that part rests (checked: Lᵀ = L and 1ᵀL = 0 "
        "of four agents with any weights; the sums over more are alike)",
        matrix == matrix.T and all(sp.expand(sum(matrix[:, k])) == 0 for k in range(n)),
        r"\dot x_k = -\lambda_k x_k(t - \tau)",
    )


def _crossings() -> Iterator[Step]:
    rate, omega, c, s = z3.Reals("rate omega c s")
    axis = (rate > 0, omega > 0, c * c + s * s == 1, rate * c == 0, omega == rate * s)
    yield implication(
        "a root jω, ω > 0, of s + λ e^(-sτ) has 0 = λ cos ωτ and ω = λ sin ωτ: so ω = λ, cos ωτ = 0 and sin ωτ = 1, "
        "which is λτ = π/2 + 2πk, and λτ = π/2 first",
        z3.And(omega == rate, c == 0, s == 1),
        *axis,
        latex=r"j\omega + \lambda e^{-j\omega\tau} = 0 \iff \omega = \lambda,\ \lambda\tau = \tfrac\pi2 + 2\pi k",
    )
    yield impossible("no root is 0: λ e⁰ > 0", rate > 0, rate == 0)
    lam, tau, w = sp.symbols("lambda tau omega", positive=True)
    root = sp.Symbol("s")
    equation = root + lam * sp.exp(-root * tau)
    slope = -sp.diff(equation, tau) / sp.diff(equation, root)
    at_root = sp.simplify(slope.subs(lam * sp.exp(-root * tau), -root).subs(lam, -root * sp.exp(root * tau)))
    speed = sp.simplify(sp.re(sp.expand_complex(at_root.subs(root, sp.I * w))))
    yield Step(
        "as τ grows a root on the axis moves to the right: Re ds/dτ = ω²/(1 + ω²τ²) > 0",
        sp.simplify(speed - w**2 / (1 + w**2 * tau**2)) == 0,
        r"\operatorname{Re} \frac{ds}{d\tau} = \frac{\omega^2}{1 + \omega^2\tau^2}",
        f"Re ds/dτ = {speed}",
    )
    size, rate_2, late = z3.Reals("size rate_2 late")
    yield implication(
        "no root comes from afar: one with Re s >= 0 has |s| = λ |e^(-sτ)| <= λ",
        size <= rate_2,
        *(rate_2 > 0, late > 0, late <= 1, size == rate_2 * late),
    )
    yield Step(
        "without delay the root is -λ < 0, so for λτ < π/2 all roots lie to the left, and from λτ = π/2 on one pair "
        "does not, as none returns (roots move continuously with τ, and on the axis only to the right)",
        sp.solve(equation.subs(tau, 0), root) == [-lam],
    )


def _largest() -> Iterator[Step]:
    one, top, delay, quarter = z3.Reals("one top delay quarter")
    yield implication(
        "so all modes decay if and only if λ_n does: λ_k τ <= λ_n τ < π/2",
        one * delay < quarter,
        *(one > 0, one <= top, delay >= 0, top * delay < quarter),
        latex=r"\tau < \frac{\pi}{2\lambda_n}",
    )


def _roots() -> Iterator[Step]:
    for share in _SIDES:
        root = root_enclosure(share)
        side = root.real < 0 if share < 1 else root.real > 0
        yield Step(
            f"at λτ = {share} π/2 the root W(-λτ)/τ is {'left' if share < 1 else 'right'} of the axis",
            True if side else None,
            evidence=f"s/λ in {root}",
        )


def _steps() -> Iterator[Step]:
    yield from _modes()
    yield from _crossings()
    yield from _largest()
    yield from _roots()


PROOF = Proof(
    id="delayed-consensus",
    title="Consensus bears a delay below π/(2 λ_n), and none above",
    statement=(
        "x' = -L x(t - τ) tends to the average of its start, whatever that is, if and only if τ < π/(2 λ_n); at "
        "π/(2 λ_n) it has the roots ±jλ_n, and beyond it one with Re s > 0."
    ),
    hypotheses="L symmetric, of a fixed connected net with positive weights; one constant delay τ >= 0 for all",
    rigour="interval",
    steps=_steps,
    size=11,
    theorems=("delayed-consensus",),
)
