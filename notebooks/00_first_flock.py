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
# # A first flock in five minutes
#
# **Aims.** Run a published simulation, see how far its numbers can be trusted, and ask a theorem about it.
#
# Each agent is a double integrator, $\dot q_i = p_i$, $\dot p_i = u_i$. Olfati-Saber's Algorithm 2 steers it by its
# neighbours within a range $r$ and by a γ-agent $(q_r, p_r)$ (*IEEE TAC* 51(3), 2006):
#
# $$\begin{gathered}
#   u_i = c_1^\alpha \sum_{j \in N_i} \phi_\alpha(\|q_j - q_i\|_\sigma)\, n_{ij}
#   + c_2^\alpha \sum_{j \in N_i} a_{ij}(q)\,(p_j - p_i) \\[1ex]
#   - c_1^\gamma (q_i - q_r) - c_2^\gamma (p_i - p_r).
# \end{gathered}$$
#
# Here $N_i$ holds all $j \ne i$ with $\|q_j - q_i\| < r$, $n_{ij} = (q_j - q_i)/\sqrt{1 + \varepsilon\|q_j - q_i\|^2}$
# points from $i$ to $j$, and the weight $a_{ij} = \rho_h(\|q_j - q_i\|_\sigma/r_\alpha)$ falls smoothly from 1 to 0 at
# the range. The first sum pushes neighbours nearer than $d$ apart and draws those farther than $d$ together; the second
# brings velocities together. Lecture 01 builds $\phi_\alpha$, the bump $\rho_h$ and the σ-norm from scratch.

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import grade

case = fl.scenario("paper-flocking")
print(case.title)
print(case.source)

# %% [markdown]
# ## Run it
#
# The integrator carries $\int \dot H\,dt$ beside the state. What is left of $H(t) - H(0) - \int_0^t \dot H\,dt$ is the
# error that it made.

# %%
run = case.run()
print(f"{run.n} agents, {run.stats['steps']} steps in {run.stats['seconds']:.1f} s")
print(f"energy falls from {run.energy()[0]:.4g} to {run.energy()[-1]:.4g}")
print(f"the balance is off by {abs(run.energy_residual).max():.1g} at most")

# %%
figure, axes = plots.subplots(1, 2, size=(11, 5))
plots.snapshot(run, time=run.t[0], ax=axes[0])
_ = plots.snapshot(run, time=run.t[-1], ax=axes[1])

# %% [markdown]
# ## Ask a theorem
#
# Theorem 3 promises cohesion, a local minimum of $U_\lambda = c_1^\alpha V + \lambda J$ with $\lambda = c_1^\gamma$ as
# the limit, matched velocities, and few collisions. ($V$ sums the pairs' potentials, $J = \tfrac12\sum\|q_i-q_c\|^2$;
# lectures 1 and 3 build them.) A verdict lists its hypotheses first: one that fails makes a claim *vacuous*, not true.

# %%
print(fl.verify("os-3", run))

# %% [markdown]
# ## Summary
#
# - A run carries its own error: what is left of the energy balance.
# - A theorem is asked about a run by name; its hypotheses come first, and one that fails makes its claims vacuous.
# - Errata of published claims are asked in the same way.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, reading) Run the scenario `collapse` and ask erratum E11 about it. What is the status of the
# verdict?

# %% tags=["answer"]
collapse_status = ...

# %% tags=["solution"]
collapse = fl.scenario("collapse").run()
collapse_status = fl.verify("E11", collapse).status
_ = plots.snapshot(collapse)
# %% tags=["check"]
grade(collapse_status, "refuted", hint="fl.verify(name, run).status, one word")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, program) Theorem 1 (`os-1`) assumes a flock that stays one. A run of `paper-fragmentation` breaks
# that at $t = 0$ already: its relative connectivity $C = (n - \text{number of components})/(n-1)$ is 0.13 there. (The
# verdict names the instant at which $C$ is least, not the first at which it is below 1.) Write a function
# `connectivity(q, r)` that computes $C$ from positions of shape (n, 2), $n \ge 2$, without the library. A component is
# a largest set of agents that are linked by paths; two agents are linked if they are nearer than $r$.

# %% tags=["answer"]
connectivity = ...


# %% tags=["solution"]
def by_labels(q, r):
    q = np.asarray(q, dtype=float)
    linked = np.linalg.norm(q[:, None] - q, axis=2) < r
    label = np.arange(len(q))
    for _ in q:  # every agent takes the least label in its neighbourhood, until labels fill the components
        label = np.where(linked, label, len(q)).min(axis=1)
    return (len(q) - len(set(label.tolist()))) / (len(q) - 1)


connectivity = by_labels
fragments = fl.scenario("paper-fragmentation").run()
print(fl.verify("os-1", fragments))
print(connectivity(fragments.q[0], fragments.law.alpha.r), float(fragments.metrics().connectivity[0]))

# %% tags=["check"]
grade(
    connectivity,
    lambda f: np.allclose(
        [f(np.array([[0.0, 0.0], [3.0, 4.0], [x, 0.0], [x + 4.0, 0.0], [9.0, 9.0]]), 5.0) for x in (2.0, 4.0, 7.0)]
        + [f(np.array([[2.0 * k, 0.0] for k in (0, 3, 1, 4, 2, 5)]), 2.5)],
        [0.75, 0.75, 0.25, 1.0],
        atol=1e-12,
    ),
    form="function",
    hint="try three agents in a row by hand, of which the outer two are out of range; and two exactly r apart",
)

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, experiment) scipy would have integrated with `rtol=1e-3` and `atol=1e-6`, had we not asked for
# better. Start seven agents at rest in a hexagon that is 1.1 times too large, `1.1 * fl.lattice.hexagonal_patch(1,
# 7.0)`, under `fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))`, for 10 time units. What is the largest energy
# residual at those tolerances, to two significant digits? (Compare it with the one at the library's own tolerances.)

# %% tags=["answer"]
residual = ...

# %% tags=["solution"]
law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
wide = 1.1 * fl.lattice.hexagonal_patch(1, 7.0)
loose = fl.simulate(law, wide, 0.0 * wide, (0.0, 10.0), rtol=1e-3, atol=1e-6)
tight = fl.simulate(law, wide, 0.0 * wide, (0.0, 10.0))
residual = abs(loose.energy_residual).max()
print(f"{residual:.3g}, and {abs(tight.energy_residual).max():.3g} at the library's tolerances")

# %% tags=["check"]
grade(residual, 0.0033461, digits=2, hint="fl.simulate takes rtol and atol; the residual has two signs")

# %% [markdown] tags=["exercise"]
# **4.** ★ (1 point, derivation) One agent without neighbours is at $(3, 0)$ with the velocity $(0, 2)$; the γ-agent
# rests at the origin, $c_1^\gamma = 1$, $c_2^\gamma = 2$. How large is $\|u\|$, exactly?

# %% tags=["answer"]
push = ...

# %% tags=["solution"]
push = float(np.hypot(-3.0, -2.0 * 2.0))

# %% tags=["check"]
grade(push, 5.0, hint="write down both components of u")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, counterexample) Counterexample hunt: is $d$ the only distance at which two agents exert no force
# on each other? Give positions of two agents in the plane, an array of shape (2, 2), that are not 7 apart and feel no
# force under Algorithm 1 with $d = 7$, $r = 8.4$.

# %% tags=["answer"]
pair = ...

# %% tags=["solution"]
pair = [[0.0, 0.0], [9.0, 0.0]]  # out of range; two agents in one place would do as well, as n_ij = 0

# %% tags=["check"]
grade(
    pair,
    lambda x: np.shape(x) == (2, 2) and (np.linalg.norm(np.subtract(*x)) >= 8.4 or np.array_equal(*x)),
    form="list",
    hint="look at what the sum runs over",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A verdict of a theorem about a run reads *vacuous*. One student says: the theorem is false
# for this law. Another says: the theorem holds for this run. What is wrong with each, and what has been learnt? In your
# own words, at least 30 of them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
meaning = ...

# %% tags=["solution"]
meaning = """The theorem is an implication, and its hypothesis does not hold in this run. So the run says nothing
against the theorem and nothing for it: the conclusion may hold or fail here. What has been learnt is that this
theorem cannot be used to predict this run, and which hypothesis keeps it from that."""
# Rubric, a point each:
# an implication whose hypothesis fails is neither refuted nor confirmed; what is learnt is
# which hypothesis fails, or that another theorem is needed.

# %% tags=["check"]
grade(meaning, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
