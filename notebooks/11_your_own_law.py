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
# ## A scene
#
# You have an idea: fish might attract each other with a force that grows up to some distance and then fades. By
# tonight you want to know whether such a school keeps together, by tomorrow whether that can be proved. **How far is
# it from an idea to a law with a verdict, and from a verdict to a theorem?** Five lines, three lines, and an
# evening. This lecture is a workshop: it ends with a law, a theorem and a proof of your own.
#
# ## What makes a pair law
#
# A pair law needs a potential $\psi$ of the distance, and the weight $a_{ij}$ of the friction. From the potential
# everything else follows by differentiating, once for the force, twice for the stiffness:
#
# $$u_i = \sum_{j \ne i}\psi'(\|q_j-q_i\|)\,\frac{q_j-q_i}{\|q_j-q_i\|} + \sum_{j\ne i}a_{ij}\,(p_j - p_i),
#   \qquad a_{ij} = a_{ji} .$$
#
# Here $\psi' > 0$ attracts: the force on $i$ points towards $j$. What can be proved of *every* such law, whatever the
# formula?
#
# > **Theorem (energy of a pair law).** Let $\psi$ be differentiable, with $\psi'(0) = 0$, and let $a_{ij} \ge 0$. Then
# > $H = \sum_{i<j}\psi(\|q_j-q_i\|) + \tfrac12\sum_i\|p_i\|^2$ never rises, and the mean velocity $p_c$ is constant.
#
# *Proof.* Let $f_{ij}$ be the force of $j$ on $i$. It is opposite to $f_{ji}$.
#
# $$\begin{aligned}
# \dot H &= \sum_{i<j}\psi'\,\frac{\langle q_j-q_i,\, p_j-p_i\rangle}{\|q_j-q_i\|} + \sum_i\langle p_i, u_i\rangle &&
#   \text{chain rule} \\
# &= \sum_{i<j}\langle f_{ij},\, p_j - p_i\rangle + \sum_{i<j}\langle f_{ij},\, p_i - p_j\rangle +
#   \sum_{i<j}a_{ij}\langle p_i - p_j,\, p_j - p_i\rangle && \text{sum over pairs} \\
# &= -\sum_{i<j}a_{ij}\|p_j-p_i\|^2 \le 0 . && \text{the first two cancel}
# \end{aligned}$$
#
# And $\sum_iu_i = 0$, because every pair contributes two opposite vectors. $\square$
#
# The proof looks at *one generic pair*; $n$ does not appear. That is why a computer can do it for all $n$ (see below).
# Now read it as a contract, as in lecture 07. Each property of the formula is used in one place:
#
# | property | used for | without it |
# |---|---|---|
# | $\psi'(0) = 0$ | a force where two agents meet | coincidence must be excluded |
# | $\psi'$ without a jump | solutions in the usual sense | Filippov (lecture 09) |
# | $\psi' = 0$ at the range | the chain rule when a neighbour arrives | the energy jumps or the force does |
# | $a_{ij} \ge 0$ | the sign in the last line | friction may drive |
# | $a_{ij} = a_{ji}$ | cancelling in pairs | momentum is not conserved |
#
# A formula may lack any of them, and then a theorem that used it claims nothing. The library looks for each, and says
# which is missing.
#
# ## A law in five lines
#
# Two agents are to repel each other nearer than $d$, to attract each other from $d$ to $r$, and to feel nothing beyond,
# without a jump at $r$. So let the potential have the derivative $\psi'$ below. To integrate it, put $z = r^2 - \|q_j -
# q_i\|^2$ for the square that is left to the range, and $z_d = r^2 - d^2$ for its value at $d$ (with the strength `k`
# of the code left out):
#
# $$\psi' = x\,(x^2 - d^2)\,(r^2 - x^2)^2, \qquad \psi = \tfrac12\Bigl(\tfrac14 z^4 - \tfrac13 z_dz^3 +
#   \tfrac1{12} z_d^4\Bigr), \qquad x = \|q_j - q_i\| .$$
#
# <details><summary>The integral, and numbers</summary>
#
# $$\begin{aligned}
# \psi' &= x\,(x^2 - d^2)\,(r^2 - x^2)^2 && x = \|q_j - q_i\| \\
# \psi &= \int x\,(x^2 - d^2)\,(r^2-x^2)^2\,dx = -\tfrac12\int(z_d - z)\,z^2\,dz && z = r^2 - x^2,\ dz = -2x\,dx \\
# &= \tfrac12\Bigl(\tfrac14 z^4 - \tfrac13 z_dz^3\Bigr) + \text{constant} && x^2 - d^2 = z_d - z \\
# &= \tfrac12\Bigl(\tfrac14 z^4 - \tfrac13 z_dz^3 + \tfrac1{12} z_d^4\Bigr) && \text{so that it is 0 at } z = z_d
# \end{aligned}$$
#
# At $r$, where $z = 0$, it is $z_d^4/24$. With $d = 2$, $r = 3$ and the strength 0.01 of the code, by hand: at the
# distance 1 the slope is $\psi' = 0.01\cdot1\cdot(1-4)\cdot8^2 = -1.92$, a push; at 2.5 it is
# $0.01\cdot2.5\cdot2.25\cdot2.75^2 = 0.425$, a pull; at 2.9 it is $0.01\cdot2.9\cdot4.41\cdot0.59^2 = 0.045$, nearly
# nothing. To pull a pair out of range costs $0.01\cdot5^4/24 = 0.26$; to press it from $d$ to 0 costs the difference of
# the potentials there, 2.39, nine times as much. Compare with the flock's potential in lecture 01, a hard wall with a
# soft leash: where the pull has to fade at the range, it is easily so.
#
# </details>
#
# Why each factor? $x$ makes the force vanish
# where agents meet; $x^2 - d^2$ changes its sign at $d$ and *nowhere else*; the square of $r^2 - x^2$ makes force and
# stiffness vanish at $r$. A first power would do for the force and leave a corner in it, which costs an integrator its
# accuracy.
#
# A warning from experience. An earlier version of this very lecture had another formula, whose force repelled again
# near the range. No run showed it, because no run went there. Always draw the force over the *whole* range, and count
# how often it changes its sign.

# %%
import warnings
from pathlib import Path

import numpy as np
import sympy as sp

import flockana as fl
from flockana import plots
from flockana.course import Prediction, grade, is_own

warnings.simplefilter("ignore", fl.PairLawWarning)  # we look at faults ourselves here: law.faults

# %%
s, d, r, k = sp.symbols("s d r k")
well = fl.pair_law(
    k / 2 * ((r**2 - s**2) ** 4 / 4 - (r**2 - d**2) * (r**2 - s**2) ** 3 / 3 + (r**2 - d**2) ** 4 / 12),
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
ax.plot(length, -well.force(length), label="dψ/ds: negative repels")
ax.plot(length, well.energy(length), label="potential")
ax.axhline(0.0, color="0.8", zorder=0)
ax.set(xlabel="distance (length)", ylabel="length/time², length²/time²")
_ = ax.legend()

# %% [markdown]
# **Figure 11.1.** Force and potential of the law. The force repels below 2, attracts up to 3, and ends there without
# a jump or a corner.
#
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
# Every formula is taken, and what is missing is said. A theorem that needs it then claims nothing. Take a pencil: what
# does each of these four lack, on the range from 0 to 3?

# %%
potentials = ("1/s + s", "(s - 1)**2*s**2", "Piecewise((s**2, s < 1), (s, True))", "s**2/(r - s)")
print(*potentials, sep="\n")

# %% tags=["predict"]
guess = ...
Prediction(
    "How many things do the four lack together, at 0, at the range 3 and between?",
    guess,
    sum(len(fl.pair_law(potential, adjacency=0, range=3.0, length=1.0).faults) for potential in potentials),
)

# %%
for potential in potentials:
    print(f"{potential:38}", fl.pair_law(potential, adjacency=0, range=3.0, length=1.0).faults)

# %% [markdown]
# <details><summary>What each of them means</summary>
#
# The first has a pole where agents meet: they never do, which is a virtue, but theorems on coincident agents say
# nothing then. The second looks harmless, a well at 1, and its force at 3 is far from 0: when a third agent strays out
# of range, a large force is switched off at once. The third has the slope 2 on one side of 1 and the slope 1 on the
# other. The last has a pole *at the range*: to leave would take infinite energy, so links never break, which is exactly
# what some theorems of lecture 12 want.
#
# </details>
#
# A fault for one theorem is the hypothesis of another.

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
# Read it with the formula beside it. `q[None] - q[:, None]` is the table of all differences $q_j - q_i$, and `s2` that
# of their squared lengths; so `a` holds all weights $a_{ij}$ at once, and `slip` all $p_j - p_i$. `einsum` adds up
# $\sum_ja_{ij}(p_j - p_i)$ for each $i$. There is no loop and no case: the pair $i = j$ contributes 0 by itself.
# `frozen=True` and the checks of `__post_init__` see to it that a law, once made, is a fixed point of reference; a
# verdict about a law that changes under one's hands would mean nothing.
#
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
#
# (Exercise 9 asks for the steps.) In the file `own_law/theorem.py` this is a function `check` of a run. It takes $B$ as
# the largest distance that occurred, *between* the samples too, computes the bound, and hands over `bound - K`, a
# number for each instant that must be positive. Each number in it is an enclosure, so rounding and the error of the
# integrator come along by themselves, and the verdict says *inconclusive* where they are larger than the margin.
#
# <details><summary>Two agents</summary>
#
# Check the theorem with two agents on a line, at the distance $x$ with the relative velocity
# $v$. Then $K = \tfrac12\bigl((\tfrac12v)^2 + (\tfrac12v)^2\bigr) = \tfrac14v^2$, each weight is $\tfrac
# g2(1+x^2)^{-\beta}$, and $\dot v = -2\cdot\tfrac g2(1+x^2)^{-\beta}v$. So $\dot K = \tfrac12v\dot v = -\tfrac
# g2(1+x^2)^{-\beta}v^2 = -2g(1+x^2)^{-\beta}K$: for two agents the inequality is an equality, and cannot be improved.
#
# </details>

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
# **Figure 11.2.** The mismatch of thirty agents and the bound of the theorem, which is true and not sharp: it takes
# the weight at the largest distance for all pairs.
#
# A verdict on a run is `numeric`: it says what this run did. For all runs there is the proof.
#
# ## But who keeps the distances bounded?
#
# The theorem has a hypothesis about the *solution*: distances at most $B$. Nobody can deliver that before the run. A
# good theorem asks for something about the start only. For weights that fall slowly enough it can be had, and the proof
# is a gem.
#
# Let $y = \sqrt{2J} = \bigl(\sum\|q_i - q_c\|^2\bigr)^{1/2}$ be the size of the flock in space and $z = \sqrt{2K}$ its
# size in velocities.
#
# > **Theorem** (Cucker and Smale 2007; the proof is that of Ha and Liu 2009). If $\beta \le \tfrac12$, every solution
# > flocks: there is a $y^*$, which depends on $y(0)$ and $z(0)$ only, with $y \le y^*$ at all times and
# > $K(t) \le K(0)\,e^{-2g(1+2y^{*2})^{-\beta}t}$.
#
# *Proof.*
#
# 1. *Space follows velocity.* $y\dot y = \sum\langle q_i - q_c,\, p_i - p_c\rangle \le y\,z$ by Cauchy and Schwarz, so
#    $\dot y \le z$.
# 2. *All distances are below* $\sqrt2\,y$, because $\|e - f\|^2 \le 2\|e\|^2 + 2\|f\|^2$.
# 3. *Velocity decays.* At each instant the inequality above holds with $B = \sqrt2\,y$. With $K = \tfrac12z^2$ it says
#    that $\dot z \le -g\,(1+2y^2)^{-\beta}z$.
# 4. *A function that falls.* Let $W = z + g\int_0^y(1+2x^2)^{-\beta}dx$. Then
#
# $$\dot W = \dot z + g\,(1+2y^2)^{-\beta}\,\dot y \le -g\,(1+2y^2)^{-\beta}z + g\,(1+2y^2)^{-\beta}z = 0 .$$
#
# 5. So $g\int_{y(0)}^{y(t)}(1+2x^2)^{-\beta}dx \le z(0)$ at all times. For $\beta \le \tfrac12$ the integrand falls no
#    faster than $1/x$, and the integral up to infinity diverges. So there is a $y^*$ at which it reaches $z(0)$, and
#    $y$ cannot pass it.
# 6. Put $B = \sqrt2\,y^*$ into the first theorem. $\square$
#
# What a use of a function that falls! It is no energy: it adds a velocity to an integral over space. It says: *a flock
# that spreads pays for it in velocity*, and if the price of spreading to infinity is infinite, it does not.
#
# For $\beta > \tfrac12$ the price is finite, and a flock that is fast enough can pay it. Step 5 still works for slow
# ones, with $z(0) < g\int_{y(0)}^\infty(1+2x^2)^{-\beta}dx$. Exercise 5 computes the price for two agents.

# %%
from scipy.integrate import quad
from scipy.optimize import brentq


def price(flock, beta):
    """Size in space, size in velocities, and W, at every sample."""
    away = flock.q - flock.q.mean(axis=1, keepdims=True)
    slip = flock.p - flock.p.mean(axis=1, keepdims=True)
    y, z = np.sqrt((away**2).sum(axis=(1, 2))), np.sqrt((slip**2).sum(axis=(1, 2)))
    return y, z, z + np.array([quad(lambda x: (1.0 + 2.0 * x**2) ** -beta, 0.0, each)[0] for each in y])


y, z, W = price(run, 0.4)
most = brentq(lambda end: quad(lambda x: (1.0 + 2.0 * x**2) ** -0.4, y[0], end)[0] - z[0], y[0], 1e6)
print(f"size in space: {y[0]:.1f} at the start, {y.max():.1f} at most in the run, y* = {most:.0f} by the theorem")
fast = fl.simulate(CuckerSmale(strength=1.0, decay=1.0), q0, 6.0 * p0, (0.0, 20.0))
figure, axes = plots.subplots(1, 2, size=(11, 3.4))
for ax, flock, beta in zip(axes, (run, fast), (0.4, 1.0), strict=True):
    size, mismatch, falling = price(flock, beta)
    ax.plot(flock.t, mismatch, label="z, mismatch")
    ax.plot(flock.t, falling - mismatch, label="price of the size y")
    ax.plot(flock.t, falling, label="W, the sum: it falls")
    ax.set(xlabel="t (time)", ylabel="velocity (length/time)", title=f"β = {beta:g}")
    ax.legend()

# %% tags=["facts"]
pushes = [-float(well.force(x)) for x in (1.0, 2.5, 2.9)]
assert [f"{each:.3f}" for each in pushes] == ["-1.920", "0.425", "0.045"]
costs = [float(well.energy(x) - well.energy(2.0)) for x in (3.0, 0.0)]
assert [f"{each:.2f}" for each in costs] == ["0.26", "2.39"]
assert np.diff(W).max() < 0.0
assert y.max() < most
assert price(fast, 1.0)[1][-1] > 0.8 * price(fast, 1.0)[1][0]

# %% [markdown]
# **Figure 11.3.** Thirty agents under two decays of the weights. Left, $\beta = 0.4$: the mismatch is used up and the
# size settles. Right, $\beta = 1$, at six times the velocities: the price of going to infinity is below the velocity
# that they have, they pay it, and leave each other with most of their mismatch. In both cases $W$ falls.
#
# The bound on the size is 25 times what happened, since step 2 treats every pair as if it were the widest. A theorem
# for all starts is generous to each.
#
# ## The proof

# %%
from own_law.proof import PROOF

for step in PROOF.steps():
    print("✓" if step.holds else "✗", step.text)

# %% [markdown]
# ## How to find a theorem for your own law
#
# The capstone asks for one. A way that works in an evening:
#
# 1. *Two agents, on paper.* One distance, one relative velocity. What falls, what is conserved, where does it rest?
#    Most laws show their character here.
# 2. *Guess a function that falls.* Try the energy first, then the mismatch $K$, then the largest of something. Compute
#    its rate for one generic pair. If a term without a sign is left over, ask what would cancel it, as the integral in
#    $W$ does above.
# 3. *Try to kill it.* Run ten starts, then `fl.falsify` (lecture 10). Most guesses die here, and that is cheap.
# 4. *Write the statement with all hypotheses*, also the silly ones: weights not negative, no two agents in one place, a
#    solution that exists.
# 5. *Prove it, a line a step*, and mark in the margin which hypothesis each line uses. A hypothesis that is never used
#    can go. A line that uses one that you have not written down shows what is missing.
# 6. *Check the identity by computer*, and say for which $n$ and which dimension it was checked.
#
# What students get wrong: they start with step 6. A computer confirms what one has understood; it seldom understands in
# one's place.
#
# ## What surprised, and what a proof by computer does not say
#
# That a function which is no energy proves that a flock stays together is the surprise of this lecture. In lectures 02
# and 03 a potential did it.
#
# A symbolic proof of an identity for one generic pair is a proof for all $n$, *because* the
# energy is a sum over pairs; for a law that is no such sum, like a normalised mean, the same computation for $n = 3$
# proves the case $n = 3$. Say which of the two you have. And the rate that `flow` returns is a promise of yours: the
# residual tests it along runs, the proof tests it for all.
#
# ## Questions that come up
#
# *Why may I differentiate a distance, which has a corner at 0?* Only under the hypothesis $\psi'(0) = 0$,
# which removes the corner. In the proof of Cucker and Smale's theorem $y\dot y \le yz$ is divided by $y$, which is
# allowed while $y > 0$; if $y = 0$ all agents are in one place, and the bound on distances is trivial then.
#
# *Is $y^*$ something that happens?* No, it is a promise that nothing worse happens.
#
# *My theorem is proved, and the verdict on my run says "inconclusive". Which of the two is wrong?* Neither. A verdict
# on a run compares numbers that have errors. If the bound and the run differ by less than those errors, as for two
# agents here, where the inequality is an equality, no run can tell. Integrate more tightly, or state the bound with a
# small factor to spare, and say so. The proof does not depend on it.
#
# *My law has no potential and no averaging. Is there a theorem?* Perhaps; begin with two agents on a line, and look for
# what falls.
#
# ## Summary
#
# - From the formula of a pair potential force, energy, Jacobian and compiled code follow, and what the formula lacks is
#   said.
# - A law of another kind states its energy and the rate of it, and every run checks that promise.
# - For $\beta \le \tfrac12$ Cucker and Smale's flock stays together, because spreading costs velocity.
# - A verdict is about a run; a proof is about all of them.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, reading) Morse's potential `exp(-2*(s - 1)) - 2*exp(-(s - 1))` holds two agents at 1. Give it as
# a formula with range 4 and no adjacency. How many things does it lack? (A whole number.)

# %% tags=["answer"]
lacking = ...

# %% tags=["solution"]
morse = fl.pair_law("exp(-2*(s - 1)) - 2*exp(-(s - 1))", adjacency=0, range=4.0, length=1.0)
lacking = len(morse.faults)

# %% tags=["check"]
grade(lacking, 2, hint="look at the force at both ends of the range: morse.faults")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, derivation) By hand or by `sympy`, for `well`: (a) how stiff is a link at its length $d$, that is
# the slope of the force there? (b) How much energy does it take to pull a pair at rest to 2.5? Give the list, each to
# four significant digits.

# %% tags=["answer"]
stiffness = ...

# %% tags=["solution"]
force = k * s * (s**2 - d**2) * (r**2 - s**2) ** 2
numbers = {d: 2, r: 3, k: sp.Rational(1, 100)}
work = sp.integrate(force.subs(numbers), (s, 2, sp.Rational(5, 2)))
stiffness = [float(sp.diff(force, s).subs({s: 2} | numbers)), float(work)]

# %% tags=["check"]
grade(stiffness, [2.0, 0.158598633], digits=4, hint="product rule: one factor of the force vanishes at d")

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
# **4.** ★★ (2 points, design) Write a pair potential as a formula in `s`, a text, whose force repels nearer than 1,
# attracts from there to the range 3, and which lacks nothing: `fl.pair_law(formula, adjacency=0, range=3.0,
# length=1.0).faults` is empty.

# %% tags=["answer"]
formula = ...

# %% tags=["solution"]
formula = "(9 - s**2)**4/4 - 8*(9 - s**2)**3/3"  # the derivative is 2 s (s² − 1)(9 − s²)²
print(fl.pair_law(formula, adjacency=0, range=3.0, length=1.0).faults)

# %% tags=["check"]
grade(
    formula,
    lambda text: next(
        not law.faults
        and len(law.facts.zeros) == 1
        and (law.force(np.linspace(0.01, 0.99, 5000)) > 0).all()
        and (law.force(np.linspace(1.01, 2.99, 5000)) < 0).all()
        for law in [fl.pair_law(text, adjacency=0, range=3.0, length=1.0)]
    ),
    form="formula",
    hint="what must force and stiffness do at both ends of the range, and at the length?",
)

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, derivation) For $\beta > \tfrac12$ a flock may disperse: $B$ grows without bound, the rate that
# the theorem guarantees falls to 0, and it promises nothing. Take two agents on a line, 1 apart, leaving each other at
# relative speed $v$, with $g = 1$, $\beta = 1$. The relative velocity obeys $\dot v = -v/(1+x^2)$, hence $v(t) = v(0) -
# \arctan x(t) + \arctan 1$. Above which $v(0)$ do they never match velocities? (Four significant digits.)

# %% tags=["answer"]
escape = ...

# %% tags=["solution"]
escape = np.pi / 2 - np.arctan(1.0)

# %% tags=["check"]
grade(escape, 0.78539816, digits=4, hint="v must not reach 0 as x → ∞")

# %% [markdown] tags=["exercise"]
# **6.** ★★★ (3 points, design) Capstone: write a law of your own, its theorem and its proof, after the three files in
# `own_law/` (in cells, or in files beside this notebook). Any law will do that you can prove something about; try the
# linear consensus $u_i = \frac gn\sum_j (p_j - p_i)$, and how fast its $K$ falls. Hand in the list `[theorem, run,
# proof]`, with an `id` of your own; the check verifies the theorem on the run and the steps of the proof, refuses the
# law, the theorem and the proof of this lecture and those of the library, and your lecturer reads them.

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
    lambda parts: (
        parts[0].id not in (*fl.theorems(), "cucker-smale")
        and is_own(parts[0].check, type(parts[1].law), type(parts[1].law).flow, parts[2].steps)
        and fl.verify(parts[0], parts[1]).status == "verified"
        and [step.holds for step in parts[2].steps()] == [True] * max(1, len(list(parts[2].steps())))
    ),
    form="list",
    hint="theorem, law and proof are to be your own; fl.verify(theorem, run) must be verified, and each step hold",
)

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, words) Defend your capstone: state your theorem with all hypotheses, say where the proof uses
# each of them, and give a law or a start for which the conclusion fails because one of them does. Answer in your own
# words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Linear consensus with a positive strength g on the complete net: the mismatch K falls like exp(-2 g t). The proof
# uses that every agent hears every other with the same weight, which gives the identity of the mean, and that g is
# positive, which makes the rate negative. If g is negative K grows. If the net has two components the velocities
# agree within each of them only, and K tends to a positive number.
#
# **Rubric, a point each:** a complete statement; the place of each hypothesis in the proof; a counterexample where
# one of them fails.


# %% [markdown] tags=["exercise"]
# **8.** ★ (1 point, player) Show `run.player()` for the run of Cucker and Smale's law, and watch the size of the
# group. How many times as large as at the start is the largest distance of two agents at the end? (Two significant
# digits.)

# %% tags=["answer"]
spread = ...

# %% tags=["solution"]
run.player()
print(fl.diameter(run.q[0]), fl.diameter(run.q[-1]))
spread = fl.diameter(run.q[-1]) / fl.diameter(run.q[0])

# %% tags=["check"]
grade(spread, 2.60816, digits=2, hint="velocities agree in the end, but until then the agents part; fl.diameter")

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, proof) Prove the theorem of this lecture from its last displayed line: derive the identity
# $\dot K = -\tfrac12\sum_{i,j}a_{ij}\|p_j-p_i\|^2$, then the inequality (use $\sum_{i,j}\|p_j-p_i\|^2 = 4nK$), then
# the exponential bound.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The mean velocity is constant, because $a_{ij} = a_{ji}$. So $\dot K = \sum_i\langle p_i - p_c, u_i\rangle =
# \sum_{i,j}a_{ij}\langle p_i, p_j - p_i\rangle$, as $\sum_iu_i = 0$; exchange $i$ and $j$ in one half:
# $-\tfrac12\sum_{i,j}a_{ij}\|p_j-p_i\|^2$. Each weight is at least $(g/n)(1+B^2)^{-\beta}$, and
# $\sum_{i,j}\|p_j-p_i\|^2 = 2n\sum_i\|p_i-p_c\|^2 = 4nK$, since $\sum_i(p_i - p_c) = 0$. So $\dot K
# \le -\tfrac12\cdot\tfrac gn(1+B^2)^{-\beta}\cdot4nK = -2g(1+B^2)^{-\beta}K$. Multiply by $e^{2g(1+B^2)^{-\beta}t}$:
# the product does not rise, which is the bound.
#
# **Rubric, a point each:** the identity by exchanging names; the double sum and the bound of the weights; the
# integrating factor.
