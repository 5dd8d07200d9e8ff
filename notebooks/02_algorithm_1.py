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
# # Algorithm 1: energy, and why flocks fragment
#
# **Aims.** Derive the energy identity of Algorithm 1, watch it hold along a run, and see what it does not give:
# cohesion.
#
# Algorithm 1 of Olfati-Saber (2006, section IV) is a gradient term and a consensus term,
#
# $$\begin{gathered}
#   u_i = c_1^\alpha \sum_{j\in N_i} \phi_\alpha(\|q_j-q_i\|_\sigma)\,n_{ij}
#   + c_2^\alpha \sum_{j\in N_i} a_{ij}(q)(p_j-p_i) \\[1ex]
#   \quad\Longleftrightarrow\quad \dot p = -c_1^\alpha\nabla V(q) - c_2^\alpha \hat L(q)\,p.
# \end{gathered}$$
#
# Here $n_{ij} = (q_j-q_i)/\sqrt{1+\varepsilon\|q_j-q_i\|^2}$ and $a_{ij} = \rho_h(\|q_j-q_i\|_\sigma/r_\alpha)$. The
# *collective potential* counts each pair once, those out of range too, of which each costs $\psi_\alpha(r_\alpha)$:
#
# $$V(q) = \tfrac12\sum_i\sum_{j\ne i}\psi_\alpha(\|q_j-q_i\|_\sigma), \qquad
#   \nabla_{q_i}V = -\sum_{j\in N_i}\phi_\alpha(\|q_j-q_i\|_\sigma)\,n_{ij} .$$
#
# $L = \Delta(A) - A$ is the Laplacian of the weights $A = [a_{ij}]$, $\hat L = L\otimes I_m$, and $p^\top\hat Lp =
# \tfrac12\sum_{i,j}a_{ij}\|p_j-p_i\|^2 \ge 0$ (lecture 00a).
#
# ## The energy identity, derived
#
# $V$ and $u$ are sums over pairs, so one generic pair is enough for every $n$:

# %%
import numpy as np

import flockana as fl
from flockana import plots, symbolic
from flockana.course import grade

identity = symbolic.algorithm1_identity(m=2)
print("residual of dH/dt + c2 pᵀL̂p:", identity.residual)
identity

# %% [markdown]
# So $H = c_1^\alpha V + \tfrac12\sum\|p_i\|^2$ falls. With $\sum\|p_i\|^2$ in the place of its half, as a set of
# lecture slides prints it, a term without sign remains (erratum E1), and at some states this $H$ rises:

# %%
print(symbolic.e1_identity(m=2).residual)
print(fl.verify("E1"))

# %% [markdown]
# ## A run of forty agents
#
# Nothing in Algorithm 1 calls a stray agent back. The paper shows it in its Fig. 12:

# %%
run = fl.scenario("paper-fragmentation").run()
figure, axes = plots.subplots(1, 2, size=(10, 4.5))
plots.snapshot(run, time=0.0, ax=axes[0], bar=False)
_ = plots.snapshot(run, ax=axes[1])

# %%
figure, axes = plots.subplots(1, 3, size=(12, 3))
plots.energy(run, ax=axes[0])
plots.energy_residual(run, ax=axes[1])
_ = plots.components(run, ax=axes[2])

# %% [markdown]
# The energy falls to a constant, and its balance closes to nine digits. The number of components falls too, but not to
# one: energy decay says nothing about connectivity.
#
# ## Theorem 1
#
# Let $x_i = q_i - q_c$ and $v_i = p_i - p_c$ be positions and velocities in the frame of the centre of mass, and $H(x,
# v) = c_1^\alpha V(x) + \tfrac12\sum\|v_i\|^2$. A group is *cohesive* if one ball about its centre holds it at all
# times, and a *flock* while its net is connected.
#
# > **Theorem 1** (Olfati-Saber 2006). Let $\Omega = \{(x, v) : H(x, v) \le H_0\}$ be such that every solution of
# > Algorithm 1 that starts in it is a cohesive flock for all times. Then (i) almost every solution that starts in
# > $\Omega$ converges to an equilibrium $(x^*, 0)$ where $x^*$ is an α-lattice; (ii) all agents asymptotically move
# > with the same velocity; (iii) if $H_0 < c^* = c_1^\alpha\psi_\alpha(0)$, no two agents ever collide.
#
# The proof is LaSalle's: cohesion makes $\Omega$ compact, $\dot H = 0$ forces equal velocities on a connected net.
# Claim (i) is false as printed (erratum E3, lecture 07): minima of $V$ need not be lattices.

# %%
print(fl.verify("energy", run))
print(fl.verify("os-1", run))

# %% [markdown]
# Theorem 1 is *vacuous* here, and it says why: its hypothesis is that every solution starting in a level set of $H$ is
# a cohesive flock, and this run is not a flock.
#
# ## Which flocks Theorem 1 is about
#
# No run shows what all solutions do, but energy does. If a net falls into parts of $k$ and $n - k$ agents, $k(n-k) \ge
# n - 1$ pairs are out of range, and each of them costs $\psi_\alpha(r_\alpha)$. So below
#
# $$H(0) < (n-1)\,c_1^\alpha\,\psi_\alpha(r_\alpha)$$
#
# no solution ever falls into parts: the hypothesis is *met*, and (ii) is a theorem about that start. How much energy is
# left for motion, once the best lattice of $n$ agents has its own?

# %%
alpha, gain = fl.AlphaInteraction(), fl.Gains().c1_alpha
print(" n  V of the best lattice  limit  speed left (length/time)")
for n in range(2, 8):
    V = gain * alpha.potential_energy(fl.lattice.hexagonal_spiral(n, alpha.d))
    limit = gain * (n - 1) * alpha.far_potential
    speed = f"{np.sqrt(2.0 * (limit - V) / n):.2f}" if limit > V else "none: the hypothesis is not met"
    print(f"{n:2d}  {V:21.2f}  {limit:5.1f}  {speed}")

triangle = alpha.d * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
print(fl.verify("os-1", law=fl.Algorithm1(), q0=1.01 * triangle, p0=[[1, 0], [0, 1], [-1, -1]], t_span=(0.0, 2.0)))

# %% [markdown]
# So Theorem 1 is certainly about lattices of up to five agents in the plane (three on a line, six in space: erratum E4)
# that move slowly. Of larger flocks the hypothesis can be unmet, as above, or open. Claim (i) needs a certificate of
# its own, which a run as short as this one does not give.
#
# Nothing in (ii) depends on the formula of $\psi_\alpha$. It takes a potential that is $C^1$, bounded below and
# constant beyond its range, and weights $a_{ij} > 0$ within it. `any-potential` says so of any formula, such as
# Morse's:

# %%
morse = fl.pair_law(
    "k*((1 - exp(-a*(s - d)))**2 - 1)*(1 - s**2/r**2)**2",
    adjacency="(1 - s/r)**2",
    range=14.0,
    length=7.0,
    parameters={"k": 30.0, "a": 0.5},
)
law = fl.Algorithm1(morse, fl.Gains(c1_alpha=1.0, c2_alpha=1.0))
print(fl.verify("any-potential", law=law, q0=triangle, p0=[[1, 0], [0, 1], [-1, -1]], t_span=(0.0, 2.0)))

# %% [markdown]
# ## Two agents, all there is to see
#
# Without damping a pair whose energy is below $\psi_\alpha(r_\alpha)$ circles the well for ever, and one with more
# escapes. The level curve of that energy, the *separatrix*, divides the two kinds of motion. With damping, as here, the
# energy falls, so a pair inside the separatrix stays inside and spirals into the well.

# %%
law = fl.Algorithm1(gains=fl.Gains(c1_alpha=1.0, c2_alpha=0.2))
pair = fl.simulate(law, [[0.0], [6.6]], [[0.0], [0.0]], (0.0, 60.0), t_eval=np.linspace(0.0, 60.0, 1500))
distance, rate = np.diff(pair.q, axis=1)[:, 0], np.diff(pair.p, axis=1)[:, 0]

x, v = np.linspace(6.2, 8.6, 200), np.linspace(-2.5, 2.5, 200)
H = law.alpha.psi_alpha(law.alpha.sigma_norm(x)) + v[:, None] ** 2 / 4
_ = plots.phase_portrait(
    distance,
    rate,
    energy=(x, v, H),
    separatrix=law.alpha.psi_alpha(law.alpha.r_alpha),
    labels=("distance of the pair (length)", "its rate (length/time)"),
)

# %% [markdown]
# ## A student project's two films
#
# A course project (see `fl.cite(fl.scenario("notebook-algorithm1"))`) animates 27 agents under Algorithm 1 and 35 under
# Algorithm 2, which adds a γ-agent (lecture 3). The first:

# %%
fl.scenario("notebook-algorithm1").run().player(height=560)

# %% [markdown]
# In the second the agents take on the γ-agent's velocity, but leave its place (the cross), and the flock splits.
# Neither is an error of the film: the project sets $c_1^\gamma = 0$, so the place of the γ-agent is not in the law at
# all, and nothing holds the flock together. Cohesion, in the next lecture, needs $c_1^\gamma > 0$.

# %%
left = fl.scenario("notebook-algorithm2").run()
left.player(height=560)

# %% tags=["facts"]
assert left.law.gains.c1_gamma == 0.0
assert left.metrics().connectivity[-1] < 1.0  # it splits

# %% [markdown]
# ## Summary
#
# - Algorithm 1 is a gradient descent with damping between neighbours, and $\dot H = -c_2^\alpha p^\top\hat Lp \le 0$.
# - Without a bound on the size of the group LaSalle does not apply: groups fragment.
# - Theorem 1 assumes what would have to be shown, so it is vacuous where a run fragments.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, reading) In how many components does `run` end? (A whole number.)

# %% tags=["answer"]
components = ...

# %% tags=["solution"]
labels = fl.components(run.n, fl.links(run.q[-1], run.law.alpha.r))
components = len(set(labels))

# %% tags=["check"]
grade(components, 24, hint="fl.components(n, links) labels every agent, fl.links(q, r) finds the links")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, experiment) From which start at rest, closer than $d$, does the pair of `law` just escape if
# there is no damping? Give the distance to four significant digits. (At rest $H = \psi_\alpha$, and escape needs
# $\psi_\alpha(r_\alpha)$.)

# %% tags=["answer"]
start = ...

# %% tags=["solution"]
from scipy.optimize import brentq

psi = law.alpha.psi_alpha
start = brentq(lambda s: psi(law.alpha.sigma_norm(s)) - psi(law.alpha.r_alpha), 5.0, 7.0)

# %% tags=["check"]
grade(start, 6.567645, digits=4, hint="brentq; ψ_α takes a σ-norm, and escape is at r_α")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, experiment) The momentum $\sum p_i$ of Algorithm 1 is conserved, because each pair acts equally
# and oppositely. By how much does it change in `run`, relative to $\sum \|p_i(0)\|$? Is that above $10^{-10}$?

# %% tags=["answer"]
above = ...

# %% tags=["solution"]
momentum = run.p.sum(axis=1)
change = np.abs(momentum - momentum[0]).max() / np.linalg.norm(run.p[0], axis=1).sum()
print(f"{change:.1e}")
above = bool(change > 1e-10)

# %% tags=["check"]
grade(above, False, hint="run.p has shape (T, n, m)")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) Two agents start at rest 6 apart, under `law` without its damping. At what relative
# speed do they move once they are out of range? (Four significant digits.)

# %% tags=["answer"]
parting = ...

# %% tags=["solution"]
parting = 2.0 * np.sqrt(psi(law.alpha.sigma_norm(6.0)) - psi(law.alpha.r_alpha))  # ψ(6) = ψ(r_α) + w²/4

# %% tags=["check"]
grade(parting, 3.2609838, digits=4, hint="H is conserved; each agent has half the relative speed")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, words) In your own words, at least 30 of them: which step of a proof of cohesion for Algorithm 1
# by LaSalle's principle fails, and what in Algorithm 2 could repair it? (A text; the check counts words, and your
# lecturer reads it.)

# %% tags=["answer"]
gap = ...

# %% tags=["solution"]
gap = """H falls, but its level sets are not bounded: a pair out of range costs a constant, however far apart it is,
so agents can leave without more energy and the set is not compact. Algorithm 2 adds a pull that grows with
the distance from the centre; then a level set bounds the size of the group."""
# Rubric, a point each:
# level sets of H are not bounded; because a pair out of range costs a constant; a pull that
# grows with the distance, as the γ-agent's.

# %% tags=["check"]
grade(gap, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, counterexample) A classmate claims: under Algorithm 1 a group that starts at rest and connected
# stays connected. Give positions of a few agents in the plane, an array of shape (n, 2), $n \le 12$, that refute it:
# one component at the start, more than one after 20 time units under `fl.Algorithm1()`.

# %% tags=["answer"]
torn = ...

# %% tags=["solution"]
torn = [[0.0, 0.0], [1.0, 0.0]]  # pushed apart with more energy than the damping takes before they are out of range

# %% tags=["check"]
grade(
    torn,
    lambda q: (
        2 <= len(q) <= 12
        and set(fl.components(len(q), fl.links(np.array(q, float), 8.4))) == {0}
        and 1
        in fl.components(len(q), fl.links(fl.simulate(fl.Algorithm1(), q, np.zeros((len(q), 2)), (0, 20)).q[-1], 8.4))
    ),
    form="list",
    hint="at rest all energy is potential: where is there much of it?",
)
