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
# # Bearing-distance flocking, and a theorem that is false as stated
#
# **Aims.** Run a law that knows only bearings and distances. Then read its theorem, refute it with a counterexample,
# and see what can be saved.
#
# ## A scene
#
# Underwater there is no GPS. A glider hears from which direction its neighbour's sound comes, and from its echo how
# far away it is; nobody can tell it where it *is*. Fish manage with less. **Can a flock keep together with bearings
# and distances only, and does the theorem that says so hold?** The first half of the question is about information:
# which terms of a law can be computed from what is sensed? The second is a lesson in reading a proof: this one
# computes eigenvalues, all in the left half-plane, and concludes something false.

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import Prediction, figures, grade
from flockana.measures.perception import edge_vectors
from flockana.sources.jond_2025 import MinimalFlocking, ZoneFlocking
from flockana.stability import linearise
from flockana.symbolic import bearing_distance, spanning_trees

figure, ax = plots.subplots(size=(6.4, 3.6))
radii = {"repulsion $z_r$": 1.5, "conflict $z_c$": 3.0, "attraction $z_a$": 5.0, "surveillance $z_s$": 6.0}
_ = figures.zones(radii, ax=ax)

# %% [markdown]
# **Figure 8.1.** The zones of one agent (dot), with the radii of the paper's second experiment. Flockmates in the
# two inner discs repel, those outside the innermost one and within $z_a$ attract and align; aliens, the paper's
# word for intruders, repel anywhere within $z_s$.
#
# ## One glider behind another
#
# Glider 1 perceives glider 0 and wants to be $d$ away from it; glider 0 perceives nobody and drifts on. With
# $x = q_0 - q_1$ and a spring of the strength $w_0$, the error of the length behaves like a damped oscillator: if
# $\|x\| > d$ the spring pulls, if $\|x\| < d$ it pushes. The *direction* of $x$ is free: nothing in the law says
# whether 1 swims to the left or to the right of 0. So the goal is no point but a sphere of positions, and a theorem
# that promises $x \to 0$ has confused the error with the thing itself. Keep this picture; the rest is the same with
# more gliders.
#
# Jond (2025; `fl.cite(fl.scenario("zone-51"))`) surrounds each agent with zones of radii $0 < z_r \le z_c <
# z_a < z_s$: flockmates up to $z_c$ repel, those between $z_r$ and $z_a$ attract and align, intruders up to $z_s$
# repel. The law is a map from step to step,
#
# $$u_i = u_i^{lc} + u_i^{la} + u_i^{ls} + u_i^{ss} + u_i^{oa} + u_i^{ga}, \qquad
#   p_i \leftarrow p_i + \Delta t\, u_i, \qquad q_i \leftarrow q_i + \Delta t\, p_i ,$$
#
# with cohesion, alignment, separation (local and strategic), obstacle avoidance and global speed. With $d_{ij} =
# \|q_j-q_i\|$, the bearing $\hat b_{ij} = (q_j-q_i)/d_{ij}$, the sets $\mathcal R_i = \{j \ne i : d_{ij} \le
# z_c\}$, $\mathcal A_i = \{j \ne i : z_r < d_{ij} \le z_a\}$ and the intruders, which the paper calls aliens, $\mathcal
# S_i = \{k : 0 < d_{ik} \le z_s\}$, and weights $w$ whose sum over the set is
# $\bar w$:
#
# $$\begin{gathered}
#   u_i^{lc} = \frac1{\bar w^{lc}}\sum_{\mathcal A_i} w_{ij}^{lc}\,(q_j - q_i), \quad
#   u_i^{la} = \frac1{\bar w^{la}}\sum_{\mathcal A_i} w_{ij}^{la}\,(p_j - p_i), \\[1ex]
#   u_i^{ls} = \sum_{\mathcal R_i} w_{ij}^{ls}\,(d_{ij}-z_c)\,\hat b_{ij},
# \end{gathered}$$
#
# $$\begin{gathered}
#   u_i^{ss} = \sum_{\mathcal S_i} w_{ik}^{ss}\,(d_{ik}-z_s)\,\hat b_{ik}, \quad
#   u_i^{oa} = \sum_e w_i^{oa}\min(0,\, d_{ie}-z_c)\,\hat b_{ie}, \\[1ex]
#   u_i^{ga} = w_i^{ga}\Bigl(v^d\frac{p_i}{\|p_i\|} - p_i\Bigr),
# \end{gathered}$$
#
# where $e$ runs over the closest points of the obstacles that the agent's zone meets, $v^d$ is the desired speed, and a
# sum over an empty set is 0. As in all lectures $q$ is a position and $p$ a velocity; the paper writes $p$ and
# $v$, and the radii without $z$, as `ZoneFlocking` does.
#
# <details><summary>The law read with numbers</summary>
#
# **Read it with numbers.** Take the radii $z_r = 1.5$, $z_c = 3$, $z_a = 5$, the weight 5 for separation and for the
# global speed, $v^d = 3$, and three agents:
#
# | agent | position | velocity | seen by agent 0 at | zones of agent 0 |
# |---|---|---|---|---|
# | 0 | $(0, 0)$ | $(1, 0)$ | – | – |
# | 1 | $(2, 0)$ | $(0, 1)$ | distance 2, bearing $(1, 0)$ | conflict and attraction |
# | 2 | $(0, 4)$ | $(0, 0)$ | distance 4, bearing $(0, 1)$ | attraction |
#
# With equal weights the first two terms are plain means. So agent 0 has
#
# $$\begin{aligned}
# u_0^{lc} &= \tfrac12\bigl[(2, 0) + (0, 4)\bigr] = (1, 2) && \text{towards the middle of the two} \\
# u_0^{la} &= \tfrac12\bigl[(-1, 1) + (-1, 0)\bigr] = (-1, \tfrac12) && \text{towards their mean velocity} \\
# u_0^{ls} &= 5\,(2 - 3)\,(1, 0) = (-5, 0) && \text{away from agent 1} \\
# u_0^{ga} &= 5\,\bigl(3\,(1, 0) - (1, 0)\bigr) = (10, 0) && \text{faster, straight on}
# \end{aligned}$$
#
# and the sum is $(5, 2.5)$. Two things to notice. *Equal weights cancel*: whether the weight of cohesion is 0.75 or
# 7.5, a mean is a mean (erratum J10). The paper's weights 0.75 and 0.25 do nothing; the library's default has gains in
# front of the means instead. *The loudest term wins*: global speed and separation shout, cohesion whispers, and then
# the sum, 5.6 long, is cut off at the machine's limit $u^{\max} = 2$.
#
# </details>

# %%
hunted = fl.scenario("zone-52").run()
hunted.window(0.0, 32.0).animate(seconds=4, fps=8)

# %% [markdown]
# Triangles are the zones in which an agent reacts to obstacles, the cross is an alien that hunts within the tinted
# area. The directed zones let a flock through a gap that the conventional method, a buffer around the whole obstacle,
# closes:

# %%
figure, axes = plots.subplots(1, 3, size=(13, 4.2))
for ax, case, t in zip(axes, ("zone-gap", "zone-gap", "zone-gap-buffer"), (4.0, 10.0, 10.0), strict=True):
    plots.snapshot(fl.scenario(case).run(), time=t, ax=ax, velocities=False)

# %% [markdown]
# **Figure 8.2.** Five agents enter the gap between an obstacle and the wall (left, $t = 4$) and leave it (middle,
# $t = 10$). With a buffer around the whole obstacle (dashed circle) the same agents turn back (right, $t = 10$).
#
# ## Two forms, and where they part
#
# What can be computed from bearings and distances? Start from the definition of a bearing and differentiate.
#
# $$\begin{aligned}
# q_j - q_i &= d_{ij}\,\hat b_{ij} && \text{definition of the bearing} \\
# p_j - p_i &= \dot d_{ij}\,\hat b_{ij} + d_{ij}\,\tfrac{d}{dt}\hat b_{ij} && \text{product rule; (13) of the paper} \\
# 0 &= \tfrac{d}{dt}\|\hat b_{ij}\|^2 = 2\,\langle\hat b_{ij}, \tfrac{d}{dt}\hat b_{ij}\rangle && \text{it has
#   length 1} \\
# \|p_j - p_i\|^2 &= \dot d_{ij}^{\,2} + d_{ij}^2\,\|\tfrac{d}{dt}\hat b_{ij}\|^2 && \text{so the parts are at right
#   angles}
# \end{aligned}$$
#
# The last line is how radar sees the world: a Doppler shift gives $\dot d_{ij}$, a turning antenna the rate of the
# bearing, and the farther away the target, the faster it moves for the same rate of the bearing. Positions and
# velocities of *others relative to oneself* can be had in this way; a position or a velocity of *oneself* cannot,
# because it would change if everybody moved together, and no bearing and no distance would. So go through the law term
# by term. Cohesion, alignment and separation contain $q_j - q_i$, $p_j - p_i$, $d_{ij}$ and $\hat b_{ij}$ only. Global
# speed contains $p_i$. Each of the first three has a form without positions:

# %%
print("both forms agree:", bearing_distance.derive_equivalence().holds)
rng = np.random.default_rng(0)
q, p = rng.uniform(0.0, 10.0, (10, 2)), rng.uniform(0.0, 1.0, (10, 2))
by_position, by_bearing = (ZoneFlocking(form=form).behaviours(q, p) for form in ("position", "bearing"))
for name in by_position:
    print(f"{name:>10}: {np.abs(by_position[name] - by_bearing[name]).max():.1e}")

# %% [markdown]
# They agree as long as the agent knows its own velocity, which the global speed term needs. No bearing contains it;
# the paper estimates it by (17), which adds up the inputs but forgets the global term itself. After one step the
# estimate is off by

# %%
bearing_distance.estimate_gap()

# %% [markdown]
# and it never recovers (erratum J8):

# %%
start = fl.scenario("zone-51")
estimated = fl.simulate(ZoneFlocking(own_velocity="estimated"), start.q0, start.p0, (0.0, 20.0))
off = np.linalg.norm(estimated.extra["estimate"] - estimated.p, axis=2).mean(axis=1)
print(f"mean error of the estimate after 1, 5 and 20 s: {off[10]:.2f}, {off[50]:.2f}, {off[200]:.2f} m/s")

# %% [markdown]
# ## A bound that is a drag
#
# To keep $\|p\| \le v^{\max} = 4$ the paper sets $p \leftarrow v^{\max}\tanh(\|p\|/v^{\max})\, p/\|p\|$ in *every* step
# (10). That shortens a velocity of 3, far from the bound, too (erratum J7): $4\tanh\tfrac34 = 2.54$. A smooth bound
# that is applied once is harmless; applied ten times a second it is a brake. How strong? Let an agent fly straight on
# with full thrust $u^{\max} = 2$, step $\Delta t = 0.1$. Its speed $v$ goes from step to step by
#
# $$v \leftarrow v^{\max}\tanh\frac{v + \Delta t\,u^{\max}}{v^{\max}} .$$
#
# A speed that lasts is a fixed point. With $z = v + \Delta t\,u^{\max}$ and $\tanh x = x - \tfrac13x^3 + \dots$,
#
# $$\begin{aligned}
# z - \Delta t\,u^{\max} &= v^{\max}\tanh(z/v^{\max}) && \text{fixed point} \\
# &\approx z - \frac{z^3}{3(v^{\max})^2} && \text{Taylor} \\
# z &\approx \bigl(3(v^{\max})^2\,\Delta t\,u^{\max}\bigr)^{1/3} = 9.6^{1/3} = 2.13, && \text{numbers}
# \end{aligned}$$
#
# so $v \approx 1.93$; exactly it is 2.008. Now read the formula, not the number: the speed that lasts falls with the
# *step*, like $\Delta t^{1/3}$. **The more carefully one simulates the printed law, the slower its flock flies.** With
# $\Delta t \to 0$ nothing moves at all. A law whose behaviour depends on the step of its simulation is not a law of
# motion but a property of a program.

# %%
print(f"3 becomes {bearing_distance.saturation(3, bound=4).evalf(4)} in one step")
print(f"no speed above {bearing_distance.fastest_under_drag(0.1, 2, 4, digits=5)} lasts; desired are 3")
printed = fl.scenario("zone-51-printed").run()
clipped = start.run()
figure, axes = plots.subplots(1, 3, size=(15, 3.6))
v = np.linspace(0.0, 3.4, 200)
axes[0].plot(v, v, label="the same speed again")
axes[0].plot(v, 4.0 * np.tanh((v + 0.2) / 4.0), label="after one step of full thrust")
speed, path = 3.2, []
for _ in range(12):
    after = 4.0 * np.tanh((speed + 0.2) / 4.0)
    path += [(speed, speed), (speed, after)]
    speed = after
axes[0].plot(*np.array(path).T, linewidth=0.9, label="from 3.2")
axes[0].set(xlabel="speed (m/s)", ylabel="speed one step later (m/s)", xlim=(1.2, 3.4), ylim=(1.2, 3.4))
axes[0].legend()
for ax, run, title in zip(axes[1:], (printed, clipped), ("as printed", "as recommended: a plain clip"), strict=True):
    plots.zone_speeds(run, ax=ax)
    ax.set(xlabel="t (s)", ylabel="speed (m/s)")
    ax.annotate(title, (0.97, 0.12), xycoords="axes fraction", ha="right")

# %% tags=["facts"]
assert abs(4.0 * np.tanh(0.75) - 2.54) < 0.005
assert abs(9.6 ** (1 / 3) - 2.125) < 0.001
assert abs(float(bearing_distance.fastest_under_drag(0.1, 2, 4)) - 2.008) < 0.0005
assert float(bearing_distance.fastest_under_drag(0.001, 2, 4)) < 0.6
three = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 4.0]]), np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
terms = {name: value[0] for name, value in ZoneFlocking().behaviours(*three).items()}
assert np.allclose(terms["cohesion"] / 0.25, [1.0, 2.0])  # the library's gains in front of the means
assert np.allclose(terms["alignment"] / 8.0, [-1.0, 0.5])
assert np.allclose(terms["separation"], [-5.0, 0.0])
assert np.allclose(terms["speed"], [10.0, 0.0])

# %% [markdown]
# **Figure 8.3.** Left: the speed after a step over the speed before, and the steps from 3.2; they end where the curves
# cross, at 2.008. Middle and right: speeds of ten agents. As printed they end at 2, though 3 is desired and the bound
# is 4; with a plain clip they end at 3.
#
# ## The theorem
#
# For its analysis the paper reduces the law to springs and alignment along the edges of a perception graph
# (`MinimalFlocking`). A graph is a *spanning tree*, more precisely a rooted out-tree, if every agent but one, the
# root, perceives exactly one other, and following who is perceived leads from everybody to the root. A matrix is
# *Hurwitz* if all its eigenvalues have negative real part. With $x_e = q_j - q_i$ on edge $e = (j, i)$, by which $i$
# perceives $j$, and a desired length $d$:
#
# > **Theorem 1** (as printed, in our words). If the graph is a spanning tree, then $x \to 0$ and $\dot x \to 0$ from
# > any initial condition, because the matrix $A_{cl}$ of the edge dynamics is Hurwitz.
#
# Here is a tree that never changes, at the start and at the end:

# %%
tree = fl.scenario("zone-tree").run()

# %% tags=["predict"]
guess = ...
Prediction(
    "Every edge is to be 2 long; the theorem says x → 0. How long is the shortest edge at t = 100?",
    guess,
    float(np.linalg.norm(edge_vectors(tree.q[-1], tree.law.edges), axis=1).min()),
)

# %%
figure, axes = plots.subplots(1, 2, size=(11, 4))
plots.snapshot(tree, time=0.0, ax=axes[0], velocities=False, bar=False)
plots.snapshot(tree, ax=axes[1], velocities=False)
for ax, places in zip(axes, tree.q[[0, -1]], strict=True):
    ax.plot(*places[0], "s", color="black", markersize=9)

# %% [markdown]
# **Figure 8.4.** A tree of eight agents at the start and at $t = 100$. An arrow leads from the root (square) outwards;
# colour shows how far an edge is from its desired length. At the end every edge is right, and none is 0.

# %%
verdict = fl.verify("zone-1-printed", tree)
print(verdict)

# %% [markdown]
# The counterexample is in the verdict: agents at rest, every edge at its desired length. Check it by hand:

# %%
rest = np.array(verdict.claim("equilibrium").witness["q"])
force = tree.law.acceleration(0.0, rest, np.zeros_like(rest))
lengths = np.linalg.norm(edge_vectors(rest, tree.law.edges), axis=1)
print(f"edges {lengths.min():.3f} to {lengths.max():.3f} long, largest force {np.abs(force).max():.0e}")

# %% [markdown]
# $x = 0$ is not even desirable: it means that all agents collide. Where did the proof go wrong? An edge whose parent
# moves uniformly feels a spring and a damper,
#
# $$\ddot x = -w\,x - \dot x, \qquad w = w_0\Bigl(1 - \frac{d}{\|x\|}\Bigr) .$$
#
# If $w$ were a number, $x = e^{st}\nu$ would solve this for $s^2 + s + w = 0$. The printed proof does just that. It
# writes all edges as $\dot z = A_{cl}\,z$, where the factors $w$ of the moment stand *in the matrix*, computes its
# eigenvalues, and takes them for those of a linear system. But $w$ depends on $x$: it moves when the edge moves. Look
# at what the frozen matrix says for three lengths (erratum J2):

# %%
for ratio in (2.0, 1.0, 0.5):
    first, second = (complex(root) for root in spanning_trees.frozen_eigenvalues(ratio))
    print(f"|x| = {ratio:g} d: eigenvalues {first:.3f} and {second:.3f}")

# %% [markdown]
# Hurwitz where edges are too long, singular where they are right, unstable where they are too short. (The product of
# the two roots is $w$ and their sum $-1$. So both are on the left exactly if $w > 0$.) The middle line is the oddest.
# At the right length $w = 0$, so the frozen edge has no spring at all, though a real edge, stretched a little, is
# pulled back: the frozen matrix is wrong even *at* the equilibrium, because freezing $w$ throws away how $w$ changes.
# And $A_{cl}$ depends on the state: eigenvalues of a frozen matrix prove nothing about a trajectory.
#
# ## A swing that is pumped
#
# Is that last sentence a pedant's? Here is a system whose matrix is Hurwitz at every instant and whose solutions grow
# without bound. A swing with friction, $\ddot x + 0.2\,\dot x + kx = 0$, and a child that changes the stiffness
# between $k = 1$ and $k = 4$. For both values the eigenvalues have the real part $-0.1$. The child keeps $k = 4$ while
# the swing moves inwards, and $k = 1$ while it moves outwards:
#
# - inwards from rest at $x_0$, without friction: $\tfrac12v^2 = \tfrac12\cdot4x_0^2$, so it passes the middle with
#   $v = 2x_0$;
# - outwards with $k = 1$: $\tfrac12x_1^2 = \tfrac12v^2$, so it gets to $x_1 = 2x_0$.
#
# A factor of 2 in every half swing. Friction takes away some of it:

# %%
from scipy.linalg import expm

inward, outward = (np.array([[0.0, 1.0], [-k, -0.2]]) for k in (4.0, 1.0))
half_swing = expm(outward * np.pi / 2.0) @ expm(inward * np.pi / 4.0)
print("real parts of all eigenvalues:", [np.linalg.eigvals(each).real.round(3).tolist() for each in (inward, outward)])
print(f"factor of a half swing with these times: {max(abs(np.linalg.eigvals(half_swing))):.3f}")
state, t, swing = np.array([1.0, 0.0]), 0.0, []
for _ in range(1600):
    matrix = inward if state[0] * state[1] <= 0.0 and state[0] != 0.0 else outward
    swing.append((t, state[0]))
    state, t = expm(matrix * 0.01) @ state, t + 0.01
figure, ax = plots.subplots(size=(6.5, 3.0))
_ = ax.plot(*np.array(swing).T), ax.set(xlabel="t (time)", ylabel="x (length)")

# %% tags=["facts"]
assert abs(max(abs(np.linalg.eigvals(half_swing))) - 1.586) < 5e-4
fall = (np.pi - np.arctan(np.sqrt(3.99) / 0.1)) / np.sqrt(3.99)  # from rest to the middle
rise = np.arctan(np.sqrt(0.99) / 0.1) / np.sqrt(0.99)  # from the middle to rest
switched = expm(outward * rise) @ expm(inward * fall) @ [1.0, 0.0]
assert abs(abs(switched[0]) - 1.591) < 5e-4
assert abs(switched[1]) < 1e-12
assert np.abs(np.array(swing)[-300:, 1]).max() > 10.0

# %% [markdown]
# **Figure 8.5.** A swing with friction whose stiffness is 4 while it moves inwards and 1 while it moves outwards. At
# every instant its matrix is Hurwitz; from one turning point to the next it grows by the factor 1.591. (With the times
# $\pi/4$ and $\pi/2$ of the swing without friction, as in the code, the factor is 1.586.)
#
# The stiffness here depends on the *state*, as that of the flock does: it is exactly the printed argument's case. So
# "Hurwitz at every state" proves nothing, and for the flock it is not even true.
#
# ## What is true
#
# > **Corrected.** On a frozen rooted out-tree the equilibria are $\|x_e\| = d$, $\dot x = 0$: a product of
# > spheres of dimension $(n-1)(m-1)$. At each of them that many eigenvalues vanish, because bearings are free; the
# > others lie in the open left half-plane, so length and velocity errors near the spheres decay exponentially.
#
# *Proof.*
#
# 1. *Equilibria.* Let all velocities be equal. The force on agent $i$ comes from its one parent, along the edge, with
#    the size $w_0\bigl|\|x_e\| - d\bigr|$. It vanishes exactly if $\|x_e\| = d$. Each of the $n - 1$ edges may point
#    anywhere on a sphere of dimension $m - 1$, independently of the others, because a tree has no closed path.
# 2. *Order.* Number the agents so that each comes after its parent. The edge $x_e = q_j - q_i$ between agent $i$ and
#    its parent $j$ obeys $\ddot x_e = u_j - u_i$. The input $u_i$ depends on this edge, and $u_j$ on the edge between
#    $j$ and its own parent, nearer to the root.
# 3. *Triangle.* So the matrix of the linearised edges, ordered from the root outwards, is block triangular. Its
#    eigenvalues are those of the diagonal blocks.
# 4. *One block.* A diagonal block is the linearisation of one edge whose parent does not accelerate,
#    $\ddot x = -w_0(1 - d/\|x\|)x - \dot x$. Exercise 8 finds its eigenvalues: the roots of $s^2 + s + w_0$ along the
#    edge, and across it 0 and $-1$, each $m - 1$ times.
# 5. *Count.* Zeros: $(n-1)(m-1)$, as many as the set of equilibria has dimensions. So along the set nothing happens to
#    first order, and all eigenvalues across it are in the open left half-plane. Such a set is called *normally
#    hyperbolic*. That nearby solutions approach it exponentially, each towards one of its points, is the theorem of
#    Fenichel on such sets. $\square$
#
# Compare the two proofs. Both compute eigenvalues. The printed one takes those of a matrix that depends on the state
# and reads them as if it were constant. This one linearises *at equilibria*, where the matrix is the derivative of the
# right-hand side, and claims something of their neighbourhood only.

# %%
print(fl.verify("zone-1-corrected", tree))
spanning_trees.spacing_spectrum(2).result

# %% [markdown]
# (The output writes `μ` for the strength $w_0$ of the spring.) Linearised in the coordinates of the agents the law
# has two more zero modes, the translations. The root feels no force at all: its velocity is undamped, and the other
# agents adopt it.

# %%
found = linearise(tree.law, rest)
n, m = rest.shape
print(f"{len(found.zero_modes)} zero modes = {m} translations + (n - 1)(m - 1) = {(n - 1) * (m - 1)}")
print("with velocities that persist:", ", ".join(found.drifting), "(the plot counts these eigenvalues twice)")
figure, ax = plots.subplots(size=(5, 3.6))
_ = plots.pole_map(found.eigenvalues, ax=ax)

# %% [markdown]
# **Figure 8.6.** Poles at rest: a pair with damping ratio one half, for every edge the same, $-1$ for directions,
# and eleven zeros.
#
# ## What surprised, and what the corrected theorem does not say
#
# The printed proof contains a true computation: the eigenvalues are right. What is false is the step from
# eigenvalues of a matrix that *depends on the state* to the behaviour of solutions: the swing of Figure 8.5 has
# such eigenvalues, and grows. The correction replaces *from any initial condition* by *near the equilibria*, and the
# point by a set. It does not say that agents that are not joined by an edge keep a distance: two branches of the
# tree may cross. It does not say what happens if the graph changes, as a perception graph does when agents move. And
# it says nothing of starts far from the spheres.
#
# Here is a way to remember it. A student asks: "Does the tree flock?" Three answers, all true. *Lengths*: yes, near
# the spheres, exponentially. *Velocities*: yes, they agree with the root's, which nobody controls. *Shape*: no, every
# bearing stays where the start has put it.
#
# ## Questions that come up
#
# *Why are the eigenvalues of the printed proof right and its conclusion wrong?* They answer a question about a system
# that is not ours: one whose matrix stays as it is now. Ours changes with every motion.
#
# *Is a zero eigenvalue not a sign of instability?* Not if it belongs to a set of equilibria: a displacement along the
# set stays, neither growing nor falling. A zero that belongs to nothing of the kind is another matter, and asks for
# terms of higher order.
#
# *Would the swing grow if the child pumped at random?* Not in general. The change has to follow the motion, as a law's
# does, because it depends on the state.
#
# ## Summary
#
# - Bearings and distances suffice for all terms but the global speed.
# - A bound that acts at every speed is a drag.
# - Eigenvalues of a matrix that depends on the state prove nothing about a trajectory; the corrected theorem speaks of
#   a neighbourhood of a set of equilibria.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, experiment) Halve the step to $\Delta t = 0.05$. Which speed can the printed bound (10) not exceed
# for long now? (Four significant digits.)

# %% tags=["answer"]
fastest = ...

# %% tags=["solution"]
fastest = float(bearing_distance.fastest_under_drag(0.05, 2, 4))

# %% tags=["check"]
grade(fastest, 1.62779186, digits=4, hint="the speed at which one step gains as much as the bound takes")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, derivation) Two agents on a line: 1 perceives 0 and wants to be 1 away, both at rest, $w_0 = 1$.
# What is the acceleration of agent 1 along the line from 0 to 1 if they are (a) 0.5, (b) 1, (c) 2 apart? Give the
# list, exactly.

# %% tags=["answer"]
push = ...

# %% tags=["solution"]
pair = MinimalFlocking(edges=[(0, 1)], spacing=1.0)
push = [float(pair.acceleration(0.0, [[0.0], [far]], [[0.0], [0.0]])[1, 0]) for far in (0.5, 1.0, 2.0)]

# %% tags=["check"]
grade(push, [0.5, 0.0, -1.0], hint="a spring that is too short pushes: mind the sign")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, experiment) How many zero modes, translations included, has the same law on a tree of 5 agents in
# space? Count them with `linearise`, with all edges at their desired lengths. (A whole number.)

# %% tags=["answer"]
count = ...

# %% tags=["solution"]
chain = MinimalFlocking(edges=[(0, 1), (1, 2), (2, 3), (3, 4)], spacing=1.0)
corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 1, 1]], dtype=float)
count = len(linearise(chain, corners).zero_modes)

# %% tags=["check"]
grade(count, 11, hint="in space a bearing has two angles")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, reading) With the zones' own law in its letter (`zone-51-printed`), how close do two agents come
# in 20 s, at the steps? (Three significant digits.)

# %% tags=["answer"]
least = ...

# %% tags=["solution"]
least = float(printed.metrics().min_distance.min())

# %% tags=["check"]
grade(least, 0.07065939, digits=3, hint="the run's metrics hold the least distance at every step")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, derivation) Derive: the eigenvalues of an edge solve $s^2 + s + w = 0$ with $w = 1 -
# d/\|x\|$. Above which ratio $\|x\|/d$ are they complex, so that the edge's length swings? (Four significant
# digits.)

# %% tags=["answer"]
threshold = ...

# %% tags=["solution"]
threshold = 1.0 / (1.0 - 0.25)  # w > 1/4

# %% tags=["check"]
grade(threshold, 1.33333333, digits=4, hint="the sign of the discriminant")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) The matrix $A_{cl}$ is Hurwitz at every state along some trajectory. Does the trajectory
# therefore converge? Say why eigenvalues of a matrix that depends on the state do not decide that, and what the
# corrected theorem relies on instead. Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Not therefore. Eigenvalues decide the behaviour of a linear system with a constant matrix; with a matrix that
# changes along the trajectory, solutions can grow though every frozen matrix is Hurwitz, and here the matrix is not
# even the derivative of the right-hand side. The corrected theorem linearises at an equilibrium, where the derivative
# is constant, and claims convergence only near the set of equilibria.
#
# **Rubric, a point each:** frozen eigenvalues do not decide systems that vary; linearisation at an equilibrium holds
# in a neighbourhood only.


# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Show `tree.player()` and watch the end. How fast do the agents move there, all alike?
# (Three significant digits. Look at the root for the reason.)

# %% tags=["answer"]
end_speed = ...

# %% tags=["solution"]
tree.player()
print(np.linalg.norm(tree.p[-1], axis=1).round(3))  # all have the velocity of the root, which feels no force
end_speed = np.linalg.norm(tree.p[-1], axis=1).mean()

# %% tags=["check"]
grade(end_speed, 0.955949, digits=3, hint="tree.p[-1] holds the velocities at the end")

# %% [markdown] tags=["exercise"]
# **8.** ★★★ (3 points, proof) One edge whose parent moves uniformly: $\ddot x = -w_0(1 - d/\|x\|)\,x - \dot x$ in
# $\mathbb R^m$. Linearise at a state with $\|x\| = d$, $\dot x = 0$, and prove the corrected theorem for it: along
# $x$ the eigenvalues are the roots of $s^2 + s + w_0$, across it 0 and $-1$, each $m - 1$ times. Why does that prove
# nothing about $x = 0$?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Let $e = x/\|x\|$ and $\tilde x$ be a small displacement. To first order
# $\|x + \tilde x\| = d + \langle e, \tilde x\rangle$, so $1 - d/\|x+\tilde x\| = \langle e,\tilde x\rangle/d$, and
# the force is $-w_0\langle e,\tilde x\rangle e$, as the factor vanishes at $x$ itself. So
# $\ddot{\tilde x} = -w_0ee^\top\tilde x - \dot{\tilde x}$. Along $e$: $s^2 + s + w_0 = 0$. Across it: $s^2 + s = 0$,
# that is 0 and $-1$, in each of $m - 1$ directions. For $w_0 > 0$ the roots along $e$ have negative real part, and
# the zeros belong to turning the edge, along the sphere of equilibria. At $x = 0$ the force is not even defined, and
# the linearisation at $\|x\| = d$ says nothing about states far from it.
#
# **Rubric, a point each:** the linearised force is computed; both pairs of eigenvalues with their multiplicities; a
# linearisation is local, and the law is undefined at 0.
