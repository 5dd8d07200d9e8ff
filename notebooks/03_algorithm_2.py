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
# # Algorithm 2: cohesion, and the γ-agent as a linear system
#
# **Aims.** See what the γ-agent adds: a bound on the size of the flock, and a centre of mass that is a linear filter.
# Explain a figure of a course project by a transfer function.
#
# Algorithm 2 of Olfati-Saber (2006, section V) adds to Algorithm 1 the pull of a γ-agent with position $q_r$ and
# velocity $p_r$ on each agent:
#
# $$u_i = u_i^\alpha - c_1^\gamma (q_i - q_r) - c_2^\gamma (p_i - p_r).$$
#
# ## Two systems in one
#
# Let $q_c$, $p_c$ be the mean position and velocity, $x_i = q_i - q_c$ and $v_i = p_i - p_c$. Then the shape $(x, v)$
# moves as if the γ-agent rested at its centre, and the centre as if it had no neighbours:

# %%
import numpy as np

import flockana as fl
from flockana import plots, symbolic
from flockana.course import grade
from flockana.equilibria.collapse import relaxed
from flockana.stability.tracking import response_ratio, tracking
from flockana.stability.translational import CentreOfMass, predicted_gain

split = symbolic.derive_split(m=2)
print("exact:", split.holds)
split

# %% [markdown]
# ## The shape: energy, hence cohesion
#
# The shape dissipates
#
# $$\begin{gathered}
#   H_\lambda = c_1^\alpha V(x) + \tfrac{\lambda}{2}\sum\|x_i\|^2 + \tfrac12\sum\|v_i\|^2, \\[1ex]
#   \lambda = c_1^\gamma, \qquad \dot H_\lambda = -c_2^\alpha\, v^\top \hat L v - c_2^\gamma \sum\|v_i\|^2 \le 0 .
# \end{gathered}$$
#
# All three terms are non-negative, and one agent at distance $R$ from the centre costs $\tfrac{\lambda}{2}R^2$. So
# $R(t) \le \sqrt{2H_\lambda(t)/c_1^\gamma} \le \sqrt{2H_\lambda(0)/c_1^\gamma}$: no flock of Algorithm 2 with
# $c_1^\gamma > 0$ fragments without end. That is Theorem 3(i) with its constant. The whole theorem, with $V$ as in
# lecture 02, $J(x) = \tfrac12\sum\|x_i\|^2$, $K(v) = \tfrac12\sum\|v_i\|^2$ and $U_\lambda = c_1^\alpha V + \lambda J$:
#
# > **Theorem 3** (Olfati-Saber 2006). Apply Algorithm 2 with $c_1^\gamma, c_2^\gamma > 0$, and let $K(v(0))$ and
# > $J(x(0))$ be finite. Then (i) the group is cohesive for all $t \ge 0$; (ii) almost every solution converges to an
# > equilibrium $(x_\lambda^*, 0)$ where $x_\lambda^*$ is a local minimum of $U_\lambda$; (iii) all agents
# > asymptotically move with the same velocity; (iv) if $H_\lambda(0) < (k+1)\,c^*$ with $c^* =
# > c_1^\alpha\psi_\alpha(0)$, at most $k$ distinct pairs of agents can collide, and none if $k = 0$.
#
# Claim (iv) is false as printed for $k \ge 1$ (erratum E13, lecture 07): it bounds the pairs that coincide at one
# instant.

# %%
flock = fl.scenario("paper-flocking").run()
bound = np.sqrt(2.0 * flock.energy() / flock.law.gains.c1_gamma)
figure, axes = plots.subplots(1, 3, size=(13, 3.6))
plots.snapshot(flock, ax=axes[0], bar=False)
plots.measure(flock, "cohesion_radius", ax=axes[1])
axes[1].plot(flock.t, bound, "k:", label="bound √(2H_λ(t)/c1γ)")
axes[1].set(yscale="log", ylim=(30.0, 2000.0))
axes[1].legend()
plots.energy(flock, ax=axes[2])
print(fl.verify("os-3", flock).claim("i").detail)

# %% [markdown]
# The bound is far above $R$ because most of $H_\lambda$ is $c_1^\alpha V$, which sums over all pairs out of range too.

# %%
flock.player(height=560)

# %% [markdown]
# ## The centre: a filter of second order
#
# $\ddot q_c = -c_1^\gamma (q_c - q_r) - c_2^\gamma (\dot q_c - p_r)$, exactly, with $\omega_n = \sqrt{c_1^\gamma}$ and
# $\zeta = c_2^\gamma/(2\sqrt{c_1^\gamma})$. From $q_r$ to $q_c$ the transfer function is

# %%
symbolic.transfer_function()

# %% [markdown]
# if $p_r = \dot q_r$. If the γ-agent says $p_r = k_v\,\dot q_r$ instead, the zero moves:

# %%
import sympy

symbolic.transfer_function(sympy.Symbol("k_v"))

# %% [markdown]
# ## Two cases of a project
#
# A course project (`fl.cite(fl.scenario("msn-case1"))`) asks for four simulations of 100 agents; assignment A1 sets
# them all. Here are two. **A target at rest, no damping** ($c_2^\gamma = 0$): the flock swings through the target, as
# $\zeta = 0$ says.

# %%
case2 = fl.scenario("msn-case2").run()
figure, axes = plots.subplots(1, 3, size=(13, 3.6))
plots.trajectories(case2, ax=axes[0])
plots.speeds(case2, ax=axes[1])
plots.centre_path(case2, ax=axes[2])
period = tracking(case2).quantity("period")
print(f"period: {period.predicted:.4f} predicted, {period.measured:.4f} measured")

# %% [markdown]
# **A target on a circle.** The flock follows, on a smaller circle:

# %%
case4 = fl.scenario("msn-case4").run()
figure, axes = plots.subplots(1, 3, size=(13, 3.6))
plots.snapshot(case4, ax=axes[0], bar=False)
plots.trajectories(case4, ax=axes[1])
plots.centre_path(case4, ax=axes[2])

# %% [markdown]
# ## Why is the circle smaller?
#
# The project saw that, and laid the sine of its case 3 to the turning of the γ-agent, and the circle of case 4 to a
# start inside it and to the speed. The filter knows better (errata E12 and E15). The project moves its γ-agent by
# iterations of 0.009 time units, but the $p_r$ that it hands over is *per iteration*: $k_v = 0.009$.

# %%
gains, circle = case4.law.gains, case4.law.target.target
omega = 2 * np.pi * circle.frequency
for k_v in (0.009, 1.0):
    print(f"p_r = {k_v:5} dq_r/dt: predicted ratio {predicted_gain(gains, omega, factor=k_v):.3f}")
true = fl.simulate(fl.Algorithm2(case4.law.alpha, gains, circle), case4.q[0], case4.p[0], case4.t[[0, -1]])
print(f"measured: {response_ratio(case4)[0]:.3f}, and {response_ratio(true)[0]:.3f} with the true p_r")
print(tracking(case4))

# %% [markdown]
# With the true $p_r$ the flock's circle is *larger* than the γ-agent's. The Bode plot shows both, and $\omega$:

# %%
frequencies = np.geomspace(0.3, 100.0, 200)
responses = {f"p_r = {k_v:g} dq_r/dt": CentreOfMass(gains, k_v).frequency_response(frequencies) for k_v in (0.009, 1.0)}
axes = plots.bode(responses, marks={"case 4": omega})

# %% [markdown]
# ## Too strong a pull
#
# The same $\lambda$ that holds the flock together presses on every link. Beyond a ratio $c_1^\gamma/c_1^\alpha$ that
# falls with $n$, some agents share one place, in a strict local minimum of $U_\lambda$ (erratum E11): Theorem 3
# promises no lattice. Move the ratio, and watch nineteen agents; a number beside an agent counts those in its place:

# %%
from flockana.course.frames import slider

alpha = fl.AlphaInteraction()
ratios = (0.05, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.6, 2.0, 3.0)
settled = {ratio: relaxed(alpha, 19, ratio) for ratio in ratios}


def at_rest(ax, ratio):
    found = settled[ratio]
    title = f"{found.kind}, closest pair {fl.min_distance(found.q):.3g}"
    plots.configuration(found.q, d=alpha.d, r=alpha.r, ax=ax, bar=False, title=title)
    ax.set(xlim=(-18.0, 18.0), ylim=(-18.0, 18.0))


slider(at_rest, ratios, name="c1γ/c1α", title="nineteen agents at rest", size=(4.6, 4.6), start=2)

# %% tags=["facts"]
places = len(np.unique(np.round(settled[3.0].q, 4), axis=0))
assert 1 < places < 19  # some share a place, not all


# %% [markdown]
# ## Summary
#
# - Algorithm 2 splits exactly into a shape, which dissipates $H_\lambda$, and a centre of mass, which is a linear
#   filter of second order.
# - $J$ in the energy bounds the size of the flock: cohesion holds with a constant.
# - What the γ-agent tells as its velocity moves the zero of the filter; that explains circles that are too small or too
#   large.
# - Too strong a pull squeezes agents together.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) Case 4 has $c_1^\gamma = 70$. Which $c_2^\gamma$ makes the centre of mass critically
# damped ($\zeta = 1$)? (Four significant digits.)

# %% tags=["answer"]
c2_gamma = ...

# %% tags=["solution"]
c2_gamma = 2 * np.sqrt(70)

# %% tags=["check"]
grade(c2_gamma, 16.733201, digits=4, hint="compare the characteristic polynomial with (s + ω_n)²")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, design) For which $k_v$ between 0 and 1 would the flock of case 4 follow on a circle of exactly
# the right size? (Four significant digits.)

# %% tags=["answer"]
k_v = ...

# %% tags=["solution"]
from scipy.optimize import brentq

k_v = brentq(lambda k: predicted_gain(gains, omega, factor=k) - 1.0, 0.0, 1.0)

# %% tags=["check"]
grade(k_v, 0.7372359, digits=4, hint="predicted_gain has what you need; so has the transfer function, by hand")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, derivation) A γ-agent on a straight line says $p_r = 0$ while it moves at speed 3. How far behind
# does the centre stay, with $c_1^\gamma = 1.1$ and $c_2^\gamma = 2\sqrt{1.1}$? (Set $\ddot q_c = 0$; four significant
# digits.)

# %% tags=["answer"]
lag = ...

# %% tags=["solution"]
lag = 2 * np.sqrt(1.1) * 3 / 1.1

# %% tags=["check"]
grade(lag, 5.7207755, digits=4, hint="which two forces on the centre balance?")

# %% [markdown] tags=["exercise"]
# **4.** ★ (1 point, reading) Do seven agents coincide at $c_1^\gamma/c_1^\alpha = 3$, where nineteen do? Relax them,
# and answer `True` or `False`.

# %% tags=["answer"]
coincide = ...

# %% tags=["solution"]
coincide = bool(fl.min_distance(relaxed(alpha, 7, 3.0).q) < 1e-6)

# %% tags=["check"]
grade(coincide, False, hint="fl.min_distance(relaxed(alpha, 7, 3.0).q)")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, design) Design: choose $c_1^\gamma$ and $c_2^\gamma$, neither above 5, such that the centre of
# mass returns like $e^{-2t}$ or faster from every start. Give the list $[c_1^\gamma, c_2^\gamma]$.

# %% tags=["answer"]
gains = ...

# %% tags=["solution"]
gains = [4.8, 4.2]  # poles of s² + c2γ s + c1γ; with s = z − 2: c2γ ≥ 4 and c1γ ≥ 2 c2γ − 4

# %% tags=["check"]
grade(
    gains,
    lambda g: len(g) == 2 and max(g) <= 5.0 and np.roots([1.0, g[1], g[0]]).real.max() <= -2.0 + 1e-6,
    form="list",
    hint="where are the poles? two of them",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A report explains a circle of the flock that is smaller than its target's by the place
# where the flock started. Why can no start explain the radius in the long run, and what can? In your own words, at
# least 30 of them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
explanation = ...

# %% tags=["solution"]
explanation = """The centre of mass obeys a stable linear equation of second order that is driven by the target.
Whatever comes from the start is a solution of the homogeneous equation and dies out like its poles, so after a
while only the response to the target is left. Its size is the modulus of the transfer function at the target's
frequency, which depends on the gains, the frequency, and the velocity that the target tells."""
# Rubric, a point each:
# the part due to the start decays with the poles; what remains is the modulus of the transfer
# function at the target's frequency.

# %% tags=["check"]
grade(explanation, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
