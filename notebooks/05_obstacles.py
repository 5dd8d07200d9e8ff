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
# # Obstacles: split, rejoin, and Theorem 6
#
# **Aims.** Steer a flock around obstacles with β-agents, measure how close it comes between the samples too, and see
# which hypothesis makes the energy fall.
#
# Algorithm 3 (Olfati-Saber 2006, section VII) adds to each agent a β-agent on every obstacle in range: the closest
# point $\hat q_{ik}$, moving with the velocity $\hat p_{ik}$ that the agent's own motion gives it. For a sphere with
# centre $y$ and radius $R$,
#
# $$\mu = \frac{R}{\|q_i - y\|},\quad a = \frac{q_i-y}{\|q_i-y\|},\quad P = I - aa^\top,\qquad
#   \hat q_{ik} = \mu q_i + (1-\mu) y,\quad \hat p_{ik} = \mu P p_i .$$

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import grade

law = fl.Algorithm3(
    gains=fl.Gains(c1_gamma=12.0, c2_gamma=2.0),
    target=fl.LinearTarget((0.0, 0.0), (5.0, 0.0)),
    obstacles=(fl.Sphere((60.0, 0.0), 10.0), fl.Wall((0.0, -25.0), (0.0, 1.0))),
)
start = fl.lattice.hexagonal_patch(3, 7.0)
run = fl.simulate(law, start, np.tile([5.0, 0.0], (len(start), 1)), (0.0, 50.0))

figure, axes = plots.subplots(1, 3, size=(13, 4))
for ax, t in zip(axes, (8.0, 24.0, 50.0), strict=True):
    plots.snapshot(run, time=t, ax=ax, bar=False)

# %% [markdown]
# The flock splits and rejoins. How close did anyone come to an obstacle? Samples alone could miss the moment, so the
# library bounds the distance along the whole path:

# %%
least = run.clearance()
print(f"agent {least.agent} at obstacle {least.obstacle}, t = {least.time:.2f}: {least.reached:.3f}, ", end="")
print(f"and nobody ever closer than {least.lower:.3f}")
figure, axes = plots.subplots(1, 2, size=(10, 3.2))
plots.clearances(run, ax=axes[0])
_ = plots.components(run, ax=axes[1])

# %% [markdown]
# ## Theorem 6
#
# With a static γ-agent at $q_d$ that reports the velocity $p_d$, the energy
# $H = V_\alpha + V_\beta + V_\gamma + T$ changes at
#
# $$\dot H = -c_2^\alpha\, p^\top \hat L p + c_2^\beta \sum_{i,k} b_{ik}\langle p_i, \hat p_{ik} - p_i\rangle
#   - c_2^\gamma \bigl(2T - n \langle p_c, p_d\rangle\bigr), \qquad T = \tfrac12 \sum \|p_i\|^2 .$$
#
# The first two terms never feed energy in; the third does not as long as $\tfrac n2\langle p_c, p_d\rangle \le T$. With
# $p_d = 0$ that is trivial.

# %%
trapped = fl.scenario("paper-trapped").run()
print(fl.verify("os-6", trapped))
figure, axes = plots.subplots(1, 3, size=(13, 3.6))
plots.snapshot(trapped, ax=axes[0], bar=False)
plots.energy(trapped, ax=axes[1])
_ = plots.energy_residual(trapped, ax=axes[2])

# %% [markdown]
# Nothing in the theorem says that the flock *arrives*: the obstacle holds some agents back for good. They are at rest,
# so the energy no longer changes, which is all that the theorem speaks of. A moving γ-agent feeds energy in, and the
# theorem is vacuous:

# %%
print(fl.verify("os-6", run).status)
figure, ax = plots.subplots(size=(6, 3))
_ = plots.energy(run, ax=ax)

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point) An agent moves past a sphere of radius 2 at the origin: it is at $(4, 0)$ with velocity $(0, 3)$.
# How fast is its β-agent? (Exactly.)

# %% tags=["answer"]
speed = ...

# %% tags=["solution"]
speed = 2 / 4 * 3  # μ P p, and P p = p here

# %% tags=["check"]
grade(speed, 1.5, hint="which part of the velocity does P keep?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points) Let `run` start with twice the velocity of the γ-agent (10 along x). What is the least clearance
# that it reaches, to three significant digits?

# %% tags=["answer"]
reached = ...

# %% tags=["solution"]
fast = fl.simulate(law, start, np.tile([10.0, 0.0], (len(start), 1)), (0.0, 50.0))
reached = fast.clearance().reached

# %% tags=["check"]
grade(reached, 4.12186, digits=3, hint="run it with another p0, and ask that run for its clearance")

# %% [markdown] tags=["exercise"]
# **3.** ★★★ (3 points) A γ-agent that stays at the origin reports $p_d = (1, 0)$. One agent is at rest at the origin;
# $c_1^\gamma = 1$, $c_2^\gamma = 2$, no obstacle. Put $p = 0$ into $\dot H$: it is 0, and the condition $\tfrac
# n2\langle p_c, p_d\rangle \le T$ holds, with equality. Does the energy stay? Compute $\ddot H$ at this instant,
# exactly. (Then run it, and read what `os-6` says and why.)

# %% tags=["answer"]
curvature = ...

# %% tags=["solution"]
lone = fl.Algorithm3(gains=fl.Gains(c1_gamma=1.0, c2_gamma=2.0), target=fl.StaticTarget((0.0, 0.0), p=(1.0, 0.0)))
pushed = fl.simulate(lone, [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 3.0))
print(fl.verify("os-6", pushed))
# dH/dt = −c2γ (‖p‖² − ⟨p, p_d⟩), and p grows from 0 at the rate u = c2γ p_d: H rises, and the condition fails at once
curvature = 2.0 * 2.0 * 1.0

# %% tags=["facts"]
assert fl.verify("os-6", pushed).status == "vacuous"
assert fl.verify("os-6", run).status == "vacuous"
first = fl.simulate(lone, [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 1e-3)).energy()[-1]
assert abs(2.0 * first / 1e-3**2 - curvature) < 0.02 * curvature  # H rises as ½ Ḧ t²

# %% tags=["check"]
grade(curvature, 4.0, hint="differentiate the third term of dH/dt; at rest only the part linear in p counts")
