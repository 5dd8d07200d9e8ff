# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Your own law: five lines, its verdicts in three
#
# **Aims.** Write a pair law as a formula; get force, energy, Jacobian, integration and verdicts from it; know what a
# formula may lack, and what that costs. Then add a law of another kind in one file, its theorem in a second and its
# proof in a third.
#
# ## A law in five lines
#
# A double well: two agents repel each other within $d$, attract each other beyond it, and end smoothly at $r$.

# %%
from pathlib import Path

import numpy as np
import sympy as sp

import flockana as fl
from flockana import plots
from flockana.course import grade

# %%
s, d, r, k = sp.symbols("s d r k")
well = fl.pair_law(
    k * (s**2 - d**2) ** 2 * (r**2 - s**2) ** 2,
    adjacency=(1 - s / r) ** 2,
    range=3.0,
    length=2.0,
    parameters={"k": 0.01},
)
law = fl.Algorithm1(well)

# %% [markdown]
# `s` is the distance, `r` and `d` are range and length; every other name is a parameter. sympy derived the force, the
# stiffness and the slope of the adjacency, and numba compiled them, as fast as a law written by hand.

# %%
figure, ax = plots.subplots(size=(6, 3.2))
length = np.linspace(0.0, 3.4, 300)
ax.plot(length, well.force(length), label="force")
ax.plot(length, well.energy_at(length), label="potential")
ax.axhline(0.0, color="0.8", zorder=0)
ax.set(xlabel="distance (length)", ylabel="length/time², length²/time²")
_ = ax.legend()

# %% [markdown]
# ## Its verdicts in three

# %%
q0 = np.random.default_rng(0).uniform(0.0, 5.0, (12, 2))
run = fl.simulate(law, q0, 0.0 * q0, (0.0, 5.0))
print(fl.verify("energy", run))

# %% [markdown]
# The identity behind that verdict is derived, for every number of agents: from one generic pair.

# %%
law.derivation()

# %% [markdown]
# ## What a formula may lack
#
# Every formula is taken, and what is missing is said. A theorem that needs it then claims nothing.

# %%
for potential in ("1/s + s", "(s - 1)**2*s**2", "Piecewise((s**2, s < 1), (s, True))", "s**2/(r - s)"):
    print(f"{potential:38}", fl.pair_law(potential, adjacency=0, range=3.0, length=1.0).faults)

# %%
cut = fl.Algorithm1(fl.pair_law("(s - 1)**2*s**2", adjacency=0, range=3.0, length=1.0))
print(fl.verify("energy", fl.simulate(cut, q0, 0.0 * q0, (0.0, 1.0))))

# %% [markdown]
# ## A law without a potential
#
# Not every law is a sum over a potential. That of Cucker and Smale (*IEEE TAC* 52(5), 2007) has none:
#
# $$u_i = \sum_j a_{ij}(p_j - p_i), \qquad a_{ij} = \frac{g}{n}\,\bigl(1 + \|q_j - q_i\|^2\bigr)^{-\beta}.$$
#
# The three files of this example are in `own_law/`, beside this notebook. In the library's repository they would go to
# `flockana/laws/`, `flockana/theorems/` and `proofs/`, where they are found by themselves.

# %%
from own_law.law import CuckerSmale

print(Path("own_law/law.py").read_text())

# %% [markdown]
# `flow` returns $u$ and, in closed form, the rate of what `hamiltonian` returns. That is a promise, and every run
# checks it: the rate is integrated beside the state.

# %%
rng = np.random.default_rng(0)
q0, p0 = rng.normal(0.0, 2.0, (30, 2)), rng.normal(0.0, 1.0, (30, 2))
run = fl.simulate(CuckerSmale(strength=1.0, decay=0.4), q0, p0, (0.0, 20.0))
print(run)
print(f"the balance closes to {abs(run.energy_residual).max() / run.energy()[0]:.1e} of K(0)")

# %% [markdown]
# ## The theorem
#
# > **Theorem.** Let $p_c$ be the mean velocity and $K = \tfrac12\sum\|p_i - p_c\|^2$, and let no two agents of a
# > solution be farther apart than $B$ while $0 \le t \le t_1$. Then $K(t) \le K(0)\,e^{-2g(1+B^2)^{-\beta}t}$ for those
# > $t$.
#
# For then every weight is at least $(g/n)(1+B^2)^{-\beta}$, and so
#
# $$\dot K = -\tfrac12\sum_{i,j} a_{ij}\|p_j-p_i\|^2 \le -2g\,(1+B^2)^{-\beta} K .$$

# %%
from own_law.theorem import THEOREM

print(fl.verify(THEOREM, run))

K, t = run.energy(), run.t
rate = fl.verify(THEOREM, run).claim("decay").stated
figure, ax = plots.subplots(size=(6, 3.2))
ax.semilogy(t, K, label="K, velocity mismatch")
ax.semilogy(t, K[0] * np.exp(-rate * t), label="the theorem's bound")
ax.set(xlabel="t (time)", ylabel="K (length²/time²)")
_ = ax.legend()

# %% [markdown]
# A verdict on a run is `numeric`: it says what this run did. For all runs there is the proof.
#
# ## The proof

# %%
from own_law.proof import PROOF

for step in PROOF.steps():
    print("✓" if step.holds else "✗", step.text)

# %% [markdown]
# ## Summary
#
# - From the formula of a pair potential force, energy, Jacobian and compiled code follow, and what the formula lacks is
#   said.
# - A law of another kind states its energy and the rate of it, and every run checks that promise.
# - A verdict is about a run; a proof is about all of them.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, reading) Morse's potential $\psi(s) = e^{-2(s-1)} - 2e^{-(s-1)}$ holds two agents at 1. Give it as
# a formula with range 4 and no adjacency. How many things does it lack? (A whole number.)

# %% tags=["answer"]
lacking = ...

# %% tags=["solution"]
morse = fl.pair_law("exp(-2*(s - 1)) - 2*exp(-(s - 1))", adjacency=0, range=4.0, length=1.0)
lacking = len(morse.faults)

# %% tags=["check"]
grade(lacking, 2, hint="look at the force at both ends of the range: morse.faults")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, derivation) How stiff is a link of the double well at its length $d$? That is the slope of the
# force there, by hand or by `sympy`, exactly.

# %% tags=["answer"]
stiffness = ...

# %% tags=["solution"]
psi = k * (s**2 - d**2) ** 2 * (r**2 - s**2) ** 2
stiffness = float(sp.diff(psi, s, 2).subs({s: 2, d: 2, r: 3, k: sp.Rational(1, 100)}))

# %% tags=["check"]
grade(stiffness, 8.0, hint="only one of the two squares vanishes at d")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, experiment) Leave out the factor ½ in the rate that `flow` returns. What is the largest energy
# residual then, relative to $K(0)$? (Derive a class from `CuckerSmale` and override `flow`.) To the nearest integer.

# %% tags=["answer"]
residual = ...


# %% tags=["solution"]
class Wrong(CuckerSmale):
    def flow(self, t, q, p):
        u, rate = super().flow(t, q, p)
        return u, 2 * rate


wrong = fl.simulate(Wrong(), q0, p0, (0.0, 20.0))
residual = round(abs(wrong.energy_residual).max() / wrong.energy()[0])

# %% tags=["check"]
grade(residual, 1, hint="what is left of the balance when the integral is doubled?")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, design) Write a pair potential as a formula in `s`, a text, that holds two agents at the distance
# 1, has the range 3, needs no adjacency, and lacks nothing: `fl.pair_law(formula, adjacency=0, range=3.0,
# length=1.0).faults` is empty.

# %% tags=["answer"]
formula = ...

# %% tags=["solution"]
formula = "(s**2 - 1)**2*(9 - s**2)**3"
print(fl.pair_law(formula, adjacency=0, range=3.0, length=1.0).faults)

# %% tags=["check"]
grade(
    formula,
    lambda text: not fl.pair_law(text, adjacency=0, range=3.0, length=1.0).faults,
    form="word",
    hint="what must force and stiffness do at both ends of the range, and at the length?",
)

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, derivation) For $\beta > \tfrac12$ a flock may disperse: $B$ grows without bound, the rate that
# the theorem guarantees falls to 0, and it promises nothing. Take two agents on a line, 1 apart, leaving each other at
# relative speed $w$, with $g = 1$, $\beta = 1$. The relative velocity obeys $\dot w = -w/(1+x^2)$, hence $w(t) = w(0) -
# \arctan x(t) + \arctan 1$. Above which $w(0)$ do they never match velocities? (Four significant digits.)

# %% tags=["answer"]
escape = ...

# %% tags=["solution"]
escape = np.pi / 2 - np.arctan(1.0)

# %% tags=["check"]
grade(escape, 0.78539816, digits=4, hint="w must not reach 0 as x → ∞")

# %% [markdown] tags=["exercise"]
# **6.** ★★★ (3 points, design) Capstone: write a law of your own, its theorem and its proof, after the three files in
# `own_law/` (in cells, or in files beside this notebook). Any law will do that you can prove something about; try the
# linear consensus $u_i = \frac sn\sum_j (p_j - p_i)$, and how fast its $K$ falls. Hand in the list `[THEOREM, run,
# PROOF]`; the check verifies the theorem on the run and the steps of the proof, and your lecturer reads them.

# %% tags=["answer"]
capstone = ...

# %% tags=["solution"]
from dataclasses import dataclass

from flockana.theorems import Theorem
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import law_is
from proofs.proof import Proof, Step


@dataclass(frozen=True)
class LinearConsensus(fl.Law):
    strength: float = 1.0

    def flow(self, t, q, p):
        v = p - p.mean(axis=0)
        return -self.strength * v, -self.strength * float(np.sum(v**2))

    def hamiltonian(self, t, q, p):
        return 0.5 * float(np.sum((p - p.mean(axis=0)) ** 2))


def decays(seen, tolerances):
    bound = seen.energy[0] * np.exp(-2.0 * seen.law.strength * (seen.t - seen.t[0]))
    return [], [judged("decay", 1.001 * bound - seen.energy, detail="K stays below its bound")]


def proof_steps():
    strength, v = sp.Symbol("g", positive=True), sp.symbols("v1:4", real=True)
    mean = sum(v) / 3
    identity = sum(w - v[0] for w in v) / 3 - (mean - v[0])
    yield Step("(1/n) Σ_j (p_j − p_i) = p_c − p_i", sp.expand(identity) == 0)
    K = sum((w - mean) ** 2 for w in v) / 2
    rate = sum(sp.diff(K, w) * strength * (mean - w) for w in v)
    yield Step("dK/dt = −2 g K", sp.expand(rate + 2 * strength * K) == 0)


own_theorem = Theorem(
    id="linear-consensus",
    title="The mismatch of linear consensus falls at the rate 2g",
    statement="K(t) = K(0) exp(−2 g t).",
    source="ours",
    kind="trajectory",
    check=decays,
    references=(),
    law=law_is("linear consensus", LinearConsensus),
    claims=("decay",),
)
own_proof = Proof("linear-consensus", "K(t) = K(0) exp(−2 g t), n = 3, m = 1", "g > 0", "symbolic", proof_steps)
capstone = [own_theorem, fl.simulate(LinearConsensus(), q0, p0, (0.0, 2.0)), own_proof]

# %% tags=["check"]
grade(
    capstone,
    lambda parts: fl.verify(parts[0], parts[1]).status == "verified" and all(s.holds for s in parts[2].steps()),
    form="list",
    hint="fl.verify(THEOREM, run) must be verified, and every step of the proof hold",
)

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, words) Defend your capstone: state your theorem with all hypotheses, say where the proof uses
# each of them, and give a law or a start for which the conclusion fails because one of them does. In your own words, at
# least 30 of them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
defence = ...

# %% tags=["solution"]
defence = """Linear consensus with a positive strength g on the complete net: the mismatch K falls like exp(-2 g t). The
proof uses that every agent hears every other with the same weight, which gives the identity of the mean, and
that g is positive, which makes the rate negative. If g is negative K grows. If the net has two components the
velocities agree within each of them only, and K tends to a positive number."""
# Rubric, a point each:
# a complete statement; the place of each hypothesis in the proof; a counterexample where one
# of them fails.

# %% tags=["check"]
grade(defence, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
