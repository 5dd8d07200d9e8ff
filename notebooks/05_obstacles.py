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
# **Aims.** Steer a flock around obstacles with β-agents; derive where they are and how they move; prove the energy
# balance of Theorem 6; tell a saddle from a trap; measure how close a flock comes between the samples too.
#
# ## A scene
#
# A convoy of robots drives through a hall; in the middle stands a pillar. The robots do not know the hall's plan.
# Each sees the nearest point of an obstacle, and nothing else. The convoy parts, flows around the pillar, and closes
# behind it. Another day the obstacle is a U-shaped shelf, open towards the convoy, and most of the robots stand in
# it until the batteries are empty. **Which guarantee does the law give, and why did it not help the second time?**
#
# ## One robot and a wall on a line
#
# A robot on a line at the distance $y > 0$ from a wall, driven towards it by a constant force, is to stop before it
# hits. Let an imaginary partner stand on the wall, at the point nearest to the robot, at rest: a *β-agent*. It
# repels the robot while $y$ is below a distance $d'$, and brakes it by friction between the two. The robot's energy
# is its kinetic energy, plus the potential of the repulsion, plus that of the drive; the wall does no work, because
# the β-agent does not move along the line; friction dissipates. So the robot comes to rest where drive and repulsion
# balance. In formulas, with the potential $c_1^\beta\psi_\beta$ of the repulsion, a friction $b \ge 0$ that ends at
# $d'$ too, and the drive $c_1^\gamma$:
#
# $$\ddot y = -c_1^\beta\frac{d\psi_\beta}{dy} - c_2^\beta b\,\dot y - c_1^\gamma, \qquad
#   \frac{d}{dt}\Bigl[\tfrac12\dot y^2 + c_1^\beta\psi_\beta + c_1^\gamma y\Bigr] = -c_2^\beta b\,\dot y^2 \le 0 ,$$
#
# the second equation being the first times $\dot y$. That is all of this lecture, apart from two questions that a line
# does not pose: how does the β-agent move when the robot moves *along* the wall, and what if the balance is not where
# we want it?
#
# ## β-agents
#
# Algorithm 3 (Olfati-Saber 2006, section VII) gives agent $i$ a β-agent on every obstacle $k$ in reach: at the
# obstacle's point $\hat q_{ik}$ closest to the agent, with the velocity $\hat p_{ik}$ that this point has because
# the agent moves.
#
# **A wall** through the point $y$ with the unit normal $e$. With the projection $P = I - ee^\top$ along the wall,
# $\hat q_{ik} = Pq_i + (I-P)y$. Differentiate: $\hat p_{ik} = Pp_i$.
#
# **A sphere** with centre $y$ and radius $R_k$. Let $e = (q_i-y)/\|q_i-y\|$ be the direction to the agent,
# $P = I - ee^\top$ and $\mu = R_k/\|q_i-y\|$. The closest point is $\hat q_{ik} = y + R_ke$, and its velocity is
# $\hat p_{ik} = \mu Pp_i$.
#
# <details><summary>In three lines</summary>
#
# $$\begin{aligned}
# \dot e &= \frac{p_i}{\|q_i-y\|} - \frac{(q_i-y)\,\langle q_i-y, p_i\rangle}{\|q_i-y\|^3} && \text{quotient rule} \\
# &= \frac{1}{\|q_i-y\|}\,(I - ee^\top)\,p_i && \text{pull out the distance} \\
# \hat p_{ik} &= R_k\dot e = \mu Pp_i . && \hat q_{ik} = y + R_ke
# \end{aligned}$$
#
# </details>
#
# So on a sphere the β-agent keeps the tangential part of the velocity, reduced by $\mu \le 1$, as a shadow does that
# is nearer to the lamp.

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import Prediction, figures, grade

figure, axes = plots.subplots(1, 2, size=(10, 4))
_ = figures.projections(axes=axes)

# %% [markdown]
# **Figure 5.1.** An agent $q_i$ with velocity $p_i$ (circle) and its β-agent $\hat q_{ik}$ with velocity
# $\hat p_{ik}$ (diamond), on a sphere and on a wall (grey). On the wall the β-agent keeps the whole velocity along
# it; on the sphere it is slower.
#
# <details><summary>With numbers</summary>
#
# A sphere of radius 3 about the origin, an agent at $(0, 5)$ with the velocity $(2, -1)$. Then
# $e = (0, 1)$ and $\mu = \tfrac35$; $P$ keeps the first component, so $Pp_i = (2, 0)$, and the β-agent sits at $(0, 3)$
# with the velocity $(1.2, 0)$. Friction between the two pulls the agent's velocity along
# $\hat p_{ik} - p_i = (-0.8, 1)$: a little against its motion along the sphere, and fully against its motion
# towards it. Its power is $\langle p_i, \hat p_{ik} - p_i\rangle = -1.6 - 1 = -2.6$, a loss.
#
# </details>
#
# With $d_\beta = \|d'\|_\sigma$, $\sigma_1(z) = z/\sqrt{1+\|z\|^2}$ for numbers and vectors, and the bump of lecture
# 01, the β-agents repel, and brake, within the distance $d'$:
#
# $$\phi_\beta(z) = \rho_h(z/d_\beta)\,(\sigma_1(z-d_\beta)-1) \le 0, \qquad b_{ik} = \rho_h(\|\hat
#   q_{ik}-q_i\|_\sigma/d_\beta), \qquad \hat n_{ik} = \frac{\hat q_{ik}-q_i}{\sqrt{1+\varepsilon\|\hat
#   q_{ik}-q_i\|^2}},$$
#
# $$u_i^\beta = c_1^\beta\sum_k \phi_\beta(\|\hat q_{ik}-q_i\|_\sigma)\,\hat n_{ik} + c_2^\beta\sum_k b_{ik}(\hat
#   p_{ik}-p_i), \qquad u_i^\gamma = -c_1^\gamma\,\sigma_1(q_i-q_r) - c_2^\gamma(p_i-p_r),$$
#
# and $u_i = u_i^\alpha + u_i^\beta + u_i^\gamma$, where $u_i^\alpha$ is Algorithm 1. The potential of the repulsion is
# $\psi_\beta(z) = \int_{d_\beta}^z\phi_\beta \ge 0$: it is 0 from $d_\beta$ on, and $\psi_\beta(0)$ is the height of
# the wall. Because of $\sigma_1$ the pull
# of a distant γ-agent is bounded by $c_1^\gamma$; and because $\sigma_1$ is not linear, the split of lecture 03 does
# not hold here.
#
# ## How strong must the wall be?
#
# Before a flock, one agent. It is pushed against a wall by a distant γ-agent, with the force $c_1^\gamma$ at most.
# Where does it stop, and can it break through? Both are energy and balance on a line.
#
# **Where it rests.** At rest the repulsion balances the pull:
# $c_1^\beta|\phi_\beta(\|y\|_\sigma)|\,y/\sqrt{1+\varepsilon y^2} = c_1^\gamma$, if the target is far. The left side
# is 0 at $d'$, rises as $y$ falls, has a maximum, and falls to 0 at the wall, because $\hat n_{ik}$ vanishes there
# like $n_{ij}$. So for a weak pull there are two solutions, the outer one stable, and for a pull above the maximum
# there is none: the agent is driven through.
#
# **Whether it gets through on the way.** With the energy $\tfrac12p^2$ at the distance $d'$ and a constant pull
# $c_1^\gamma$, an agent reaches the wall only if $\tfrac12p^2 + c_1^\gamma d' \ge c_1^\beta\psi_\beta(0)$: kinetic
# energy and the work of the pull must pay for the whole wall. Friction only helps.
#
# <details><summary>By hand</summary>
#
# With the numbers of the flock below, $c_1^\beta = 1500$, $d' = 4.2$, and a pull of 12: $\psi_\beta(0) = 11.93$, so the
# wall is $1500\cdot11.93 = 17898$ high; the pull pays $12\cdot4.2 = 50$ of it; what is left, 17848, needs the speed
# $\sqrt{2\cdot17848} = 189$.
#
# </details>

# %%
beta = fl.BetaInteraction(d=4.2, r=5.04, eps=0.1, h=0.9)
y = np.linspace(0.0, 4.2, 421)
wall_force = 1500.0 * -beta.phi_beta((np.sqrt(1.0 + 0.1 * y**2) - 1.0) / 0.1) * y / np.sqrt(1.0 + 0.1 * y**2)
figure, ax = plots.subplots(size=(6, 3.4))
ax.plot(y, wall_force, label="repulsion")
ax.axhline(12.0, color="black", linestyle=":", label="pull of 12")
ax.set(xlabel="distance from the wall (length)", ylabel="force (length/time²)", yscale="log", ylim=(1.0, 1e4))
_ = ax.legend()
outer = y[np.flatnonzero(wall_force >= 12.0)[-1]]
through = np.sqrt(2.0 * (1500.0 * float(beta.psi_beta(0.0)) - 12.0 * 4.2))
print(f"strongest repulsion {wall_force.max():.0f}, rests at {outer:.2f}, breaks through from speed {through:.0f} on")

# %% [markdown]
# **Figure 5.2.** The repulsion of a wall over the distance, with the gains of this lecture, and a pull of 12. They
# balance at 4.19 and once more at 0.004, close to the wall, where the balance is unstable.
#
# With $c_1^\beta = 1500$ the strongest repulsion, 6564, is 547 times the pull, and an agent would need a speed of 189
# to break through. That is the reason for the large gain, and its price is a stiff equation. For 37 agents the energies
# add up, and the same bound, applied to the whole flock, says nothing any more.
#
# ## A flock around a pillar

# %%
law = fl.Algorithm3(
    gains=fl.Gains(c1_gamma=12.0, c2_gamma=2.0),
    target=fl.LinearTarget((0.0, 0.0), (5.0, 0.0)),
    obstacles=(fl.Sphere((60.0, 0.0), 10.0), fl.Wall((0.0, -25.0), (0.0, 1.0))),
)
start = fl.lattice.hexagonal_patch(3, 7.0)
run = fl.simulate(law, start, np.tile([5.0, 0.0], (len(start), 1)), (0.0, 50.0))
figure, axes = plots.subplots(1, 3, size=(13, 4))
for ax, t in zip(axes, (8.0, 20.3, 50.0), strict=True):
    plots.snapshot(run, time=t, ax=ax, bar=False)
run.player(height=520)

# %% [markdown]
# **Figure 5.3.** Thirty-seven agents pass a sphere beside a wall; the γ-agent flies through the sphere. The flock
# splits about $t = 20$, and rejoins.
#
# How close did anyone come to an obstacle? Samples alone could miss the moment. The library bounds the distance
# along the whole path between the samples: `reached` was attained, and `lower` is certainly not undercut.

# %%
least = run.clearance()
print(f"agent {least.agent} at obstacle {least.obstacle}, t = {least.time:.2f}: {least.reached:.3f}, ", end="")
print(f"and no agent ever closer than {least.lower:.3f}")
figure, axes = plots.subplots(1, 2, size=(10, 3.2))
plots.clearances(run, ax=axes[0])
_ = plots.components(run, ax=axes[1])

# %% [markdown]
# **Figure 5.4.** Least distance from each obstacle, and the number of components, over time.
#
# ## Theorem 6
#
# Let the γ-agent be static at $q_r = q_d$ and report the velocity $p_r = p_d$. Put
#
# $$V_\alpha = c_1^\alpha V, \qquad V_\beta = c_1^\beta\sum_{i,k}\psi_\beta(\|\hat q_{ik}-q_i\|_\sigma), \qquad
#   V_\gamma = c_1^\gamma\sum_i\bigl(\sqrt{1+\|q_i-q_d\|^2}-1\bigr),$$
#
# $T = \tfrac12\sum_i\|p_i\|^2$ and $H = V_\alpha + V_\beta + V_\gamma + T$.
#
# Its rate will be
#
# $$\dot H = -c_2^\alpha\, p^\top \hat L p + c_2^\beta \sum_{i,k} b_{ik}\langle p_i, \hat p_{ik} - p_i\rangle
#   - c_2^\gamma \bigl(2T - n \langle p_c, p_d\rangle\bigr) .$$
#
# > **Theorem 6** (Olfati-Saber 2006). Apply Algorithm 3 with a static γ-agent. Then $\dot H$ is as displayed, and if
# > $\tfrac n2\langle p_c(t), p_d\rangle \le T(t)$ for all $t \ge t_0$, then $\dot H \le 0$ for all $t \ge t_0$.
#
# *Proof.* Three lemmas, then a sum.
#
# **1. The repulsion is a gradient.** Let $y_{ik} = \|\hat q_{ik} - q_i\|$ be the distance from the obstacle. Moving
# the agent along the surface does not change it, moving it away by a length changes it by that length, so its
# gradient is the unit vector from $\hat q_{ik}$ to $q_i$. Hence
#
# $$\begin{aligned}
# \nabla_{q_i}\psi_\beta(\|\hat q_{ik}-q_i\|_\sigma) &= \phi_\beta\cdot\frac{y_{ik}}{\sqrt{1+\varepsilon
#   y_{ik}^2}}\cdot\frac{q_i-\hat q_{ik}}{y_{ik}} && \text{chain rule} \\
# &= -\phi_\beta\,\hat n_{ik} . && \text{definition of } \hat n_{ik}
# \end{aligned}$$
#
# So the first sum of $u_i^\beta$ is $-\nabla_{q_i}V_\beta$, although $\hat q_{ik}$ moves with the agent.
#
# **2. The pull is a gradient.** $\nabla_{q_i}\sqrt{1+\|q_i-q_d\|^2} = \sigma_1(q_i-q_d)$, so the first term of
# $u_i^\gamma$ is $-\nabla_{q_i}V_\gamma$.
#
# **3. Braking never drives.** $\langle p_i, \hat p_{ik} - p_i\rangle \le 0$. At a wall $\hat p - p = -(I-P)p$, and
# the product is $-\langle e, p\rangle^2$. At a sphere split $p$ into its tangential part $Pp$ and the rest: the
# product is $\mu\|Pp\|^2 - \|Pp\|^2 - \langle e,p\rangle^2 \le 0$, because $\mu \le 1$ outside.
#
# **4. The sum.** With $\nabla = \nabla(V_\alpha + V_\beta + V_\gamma)$,
#
# $$\begin{aligned}
# \dot H &= \langle\nabla, p\rangle + \sum_i\langle p_i, u_i\rangle && \text{chain rule; the γ-agent is static} \\
# &= -c_2^\alpha p^\top\hat Lp + c_2^\beta\sum_{i,k}b_{ik}\langle p_i,\hat p_{ik}-p_i\rangle -
#   c_2^\gamma\sum_i\langle p_i, p_i - p_d\rangle && \text{gradients cancel by 1, 2} \\
# &= \dots - c_2^\gamma\bigl(2T - n\langle p_c, p_d\rangle\bigr) . && \sum_i\langle p_i,p_d\rangle = n\langle
#   p_c,p_d\rangle
# \end{aligned}$$
#
# The first term is $\le 0$ by the quadratic form, the second by 3, the third by the condition. $\square$
#
# With $p_d = 0$ the condition is trivial. Otherwise, for a flock that flies as one, *its velocity must lie outside the
# ball that has the segment from 0 to $p_d$ as a diameter*: the condition fails while the flock is slower, roughly, than
# the γ-agent says it should be. Then the γ-agent does work on it.
#
# <details><summary>Why a ball</summary>
#
# Split $T = \tfrac n2\|p_c\|^2 + K$ with the
# mismatch $K = \tfrac12\sum\|p_i - p_c\|^2$, as in lecture 02. Then
#
# $$\begin{aligned}
# \tfrac n2\langle p_c, p_d\rangle \le T
#   &\iff \|p_c\|^2 - \langle p_c, p_d\rangle + \tfrac2nK \ge 0 && \text{divide by } \tfrac n2 \\
# &\iff \bigl\|p_c - \tfrac12p_d\bigr\|^2 \ge \tfrac14\|p_d\|^2 - \tfrac2nK . && \text{complete the square}
# \end{aligned}$$
#
# For a flock that flies as one, $K = 0$. Take $p_d = (5, 0)$ and 37 agents with the common velocity $(2, 1)$, on a
# lattice away from all obstacles. The square on the left is $(-0.5)^2 + 1^2 = 1.25 < 6.25$, so the condition fails, and
# with $c_2^\gamma = 2$ the energy *rises* at the rate $-2\cdot(37\cdot5 - 37\cdot10) = 370$.
#
# </details>
#
# Note also the words *for all $t \ge t_0$*: they ask about the whole future, and one instant at which the condition
# holds proves nothing (exercise 3).
#
# ## The U-shaped obstacle

# %%
trapped = fl.scenario("paper-trapped").run()

# %% tags=["predict"]
guess = ...
Prediction(
    "Forty agents, a target at rest behind the U, and an energy that falls as Theorem 6 says: how many arrive?",
    guess,
    int(np.sum(trapped.q[-1, :, 0] > 100.0)),
)

# %%
print(fl.verify("os-6", trapped).status, "- arrived:", int(np.sum(trapped.q[-1, :, 0] > 100.0)), "of", trapped.n)
figure, axes = plots.subplots(1, 3, size=(13, 3.6))
plots.snapshot(trapped, ax=axes[0], bar=False)
plots.energy(trapped, ax=axes[1])
_ = plots.energy_residual(trapped, ax=axes[2])

# %% [markdown]
# **Figure 5.5.** Forty agents and a target at rest behind a U. Two arrive; 38 stay in the U for good. The energy
# falls, as the theorem says, and then it is constant, as the theorem allows.
#
# Theorem 6 is verified, and the mission has failed. There is no contradiction. $\dot H \le 0$ says where the energy
# goes, not where the agents go. By LaSalle's argument they come to rest at critical points of
# $V_\alpha + V_\beta + V_\gamma$, of which the target is one.
#
# ## Saddle or trap?
#
# Is every rest behind an obstacle a trap? Take one agent, a sphere of radius 10 at the origin, and a target at
# $(-60, 0)$. Behind the sphere, on the axis, pull and repulsion act along one line in opposite directions, so
# somewhere they cancel. Look at the curvature of the potential there, that is at minus the derivative of the force:

# %%
from scipy.optimize import brentq

pillar = fl.Algorithm3(
    gains=fl.Gains(c1_gamma=1.0, c2_gamma=2.0),
    target=fl.StaticTarget((-60.0, 0.0)),
    obstacles=(fl.Sphere((0.0, 0.0), 10.0),),
)
cup = fl.Algorithm3(gains=trapped.law.gains, target=trapped.law.target, obstacles=trapped.law.obstacles)


def curvatures(law, q):
    """Eigenvalues of minus the derivative of the force with respect to the position."""
    slope = -np.asarray(law.jacobian(0.0, [q], [[0.0, 0.0]]))[2:, :2]
    return np.linalg.eigvalsh((slope + slope.T) / 2.0)


behind = brentq(lambda x: pillar.acceleration(0.0, [[x, 0.0]], [[0.0, 0.0]])[0, 0], 10.5, 16.0, xtol=1e-13)
inside = fl.simulate(cup, [[20.0, 1.0]], [[0.0, 0.0]], (0.0, 300.0)).q[-1, 0]
print(f"behind the sphere, at {behind:.4f}: curvatures {curvatures(pillar, [behind, 0.0]).round(3)}")
print(f"in the U, at {inside.round(3)}: curvatures {curvatures(cup, inside).round(3)}")
past = fl.simulate(pillar, [[30.0, 0.1]], [[0.0, 0.0]], (0.0, 400.0))
print(f"an agent that starts 0.1 off the axis passes the sphere at t = {past.t[np.argmax(past.q[:, 0, 0] < 0.0)]:.0f}")

# %% tags=["facts"]
assert wall_force.max() > 100.0 * 12.0
assert f"{outer:.2f} {through:.0f} {wall_force.max():.0f} {wall_force.max() / 12.0:.0f}" == "4.19 189 6564 547"
tip = (np.sqrt(1.0 + 0.1 * 0.004**2) - 1.0) / 0.1
assert abs(1500.0 * -float(beta.phi_beta(tip)) * 0.004 - 12.0) < 0.1
assert f"{float(beta.psi_beta(0.0)):.2f} {1500.0 * float(beta.psi_beta(0.0)):.0f}" == "11.93 17898"
assert np.allclose(curvatures(pillar, [behind, 0.0]), [-0.057, 742.0], rtol=0.01)
assert curvatures(cup, inside)[0] > 0.1
assert np.linalg.norm(past.q[-1, 0] - [-60.0, 0.0]) < 1e-6
assert np.linalg.norm(trapped.p[-1], axis=1).max() < 1e-4
assert int(np.sum(trapped.q[-1, :, 0] > 100.0)) == 2
for lucky in np.flatnonzero(trapped.q[-1, :, 0] > 100.0):  # they arrive without the flock, too
    single = fl.simulate(cup, trapped.q[0, [lucky]], trapped.p[0, [lucky]], (0.0, 100.0))
    assert np.linalg.norm(single.q[-1, 0] - [120.0, 0.0]) < 1e-3
assert fl.verify("os-6", trapped).status == "verified"
pieces = [len(set(fl.components(run.n, fl.links(q, 8.4)))) for q in run.q]
assert max(pieces) == 3
assert pieces[-1] == 1

# %% [markdown]
# Behind the sphere one curvature is negative: a **saddle**. By the lemma of lecture 03 it has an unstable pole, and an
# agent that starts the least bit off the axis slides around the sphere and arrives. It takes its time. But for the
# β-agent's friction, which is next to nothing at this distance, the pole solves $s^2 + 2s - 0.057 = 0$, so $s = 0.028$,
# and a displacement grows tenfold in $\ln10/0.028 = 82$ time units. In the U both curvatures are positive: a **local
# minimum**, which attracts all states near it, and from which no small disturbance frees an agent.
#
# Is the U to blame, because it is not convex? The curvature *across* the line of the two forces can be had by hand.
#
# > **Proposition (saddle or trap).** Let one agent in the plane rest at the distance $y$ from an obstacle that lies
# > between it and a static γ-agent at the distance $z$, with $p_d = 0$. Let $R_k$ be the radius of curvature of the
# > obstacle where the agent is nearest to it. Across the line of the forces the potential has the curvature
# >
# > $$\frac{c_1^\gamma}{\sqrt{1+z^2}}\Bigl(1 - \frac{z}{R_k+y}\Bigr) .$$
#
# *Proof.*
#
# 1. Let a potential depend only on the distance from a point, $f(z)$. A small step $q_\perp$ across changes the
#    distance to $\sqrt{z^2+q_\perp^2} = z + \tfrac{1}{2z}q_\perp^2 + \dots$, hence the potential by
#    $\tfrac12\tfrac{f'(z)}{z}q_\perp^2 + \dots$. So its curvature across is $f'(z)/z$.
# 2. The pull has $f(z) = c_1^\gamma\sqrt{1+z^2}$ and $f'(z) = c_1^\gamma z/\sqrt{1+z^2}$: its share is
#    $c_1^\gamma/\sqrt{1+z^2}$.
# 3. The repulsion depends on the distance from the obstacle, so near the agent on that from the centre of curvature,
#    which is $R_k + y$. At rest its slope balances that of the pull, so it is $-c_1^\gamma z/\sqrt{1+z^2}$. By 1 its
#    share is this over $R_k + y$. $\square$
#
# The pull holds the agent on the axis, because straying sideways leads away from the target; a round obstacle sheds it,
# because straying sideways leads away from the obstacle. The obstacle wins exactly if $R_k + y < z$: if it is *more
# curved than the circle about the target through the agent*. Check: behind the sphere $R_k + y = 14.197$ and $z =
# 74.197$, so the curvature is $0.01348\cdot(1 - 5.226) = -0.0570$, as computed. A sphere before the target always
# sheds. But a *flat* face has $R_k = \infty$ and traps, at the outer balance, although it is convex. The back of our U
# is flat; its arms only keep agents from sliding past. A bar alone will do:

# %%
bar = fl.scenario("paper-trapped-convex").law
flat = fl.Algorithm3(gains=bar.gains, target=bar.target, obstacles=bar.obstacles)
before = brentq(lambda x: flat.acceleration(0.0, [[x, 0.0]], [[0.0, 0.0]])[0, 0], 50.0, 54.5, xtol=1e-13)
by_hand = bar.gains.c1_gamma / np.sqrt(1.0 + (120.0 - before) ** 2)
print(f"before the bar, at {before:.4f}: curvatures {curvatures(flat, [before, 0.0]).round(4)}, by hand {by_hand:.4f}")

# %% tags=["facts"]
assert abs(curvatures(flat, [before, 0.0])[0] / by_hand - 1.0) < 1e-3
reach, height = behind + 60.0, behind
assert f"{height:.3f} {reach:.3f} {reach / height:.3f}" == "14.197 74.197 5.226"
assert f"{1.0 / np.hypot(1.0, reach):.5f} {(1.0 - reach / height) / np.hypot(1.0, reach):.4f}" == "0.01348 -0.0570"
assert f"{curvatures(pillar, [behind, 0.0])[0]:.4f}" == "-0.0570"
pole = np.linalg.eigvals(np.asarray(pillar.jacobian(0.0, [[behind, 0.0]], [[0.0, 0.0]]))).real.max()
assert f"{np.sqrt(1.057) - 1.0:.3f}" == f"{pole:.3f}"
assert f"{pole:.3f} {np.log(10.0) / pole:.0f}" == "0.028 82"
slow = fl.Algorithm3(gains=law.gains, target=fl.StaticTarget((0.0, 0.0), p=(5.0, 0.0)))
brief = fl.simulate(slow, start, np.tile([2.0, 1.0], (len(start), 1)), (0.0, 1e-3))
lattice_rate = (brief.energy()[-1] - brief.energy()[0]) / 1e-3
assert abs(lattice_rate - 370.0) < 1.0

# %% [markdown]
# Khatib's potential fields of 1986 have the same disease, and it is a theorem: among smooth potentials whose critical
# points are all nondegenerate (Morse functions), that grow towards the rim and rise towards each obstacle, those with
# one minimum have a saddle for each obstacle at least, if it is a disc in the plane.
#
# What can be done about traps? Three answers are in use, and each gives something up.
#
# - *Plan.* Compute a way around with a map, and let the γ-agent follow it. Then the law only has to keep the flock
#   together, and Theorem 6 is vacuous, because the target moves. Somebody must have the map.
# - *Choose another potential.* Rimon and Koditschek (1992) construct *navigation functions*, whose only minimum is
#   the target, for obstacles that are balls. One then has saddles, which almost no start meets. The construction
#   needs all obstacles in advance, and its gradients are very small in places and very large in others.
# - *Disturb.* Noise frees an agent from a saddle at once and from a shallow minimum sooner or later. From the
#   minimum in the U, with curvatures 0.18 and 2600, it would take very long.
#
# For a flock there is a fourth possibility: *neighbours push*. An agent that would be trapped alone can be shoved
# out by those behind it. It did not happen here: the two that arrived started beside the U, and they arrive alone,
# too. Do not credit the flock with what a single agent does.
#
# ## A moving target

# %%
print(fl.verify("os-6", run).status)
figure, ax = plots.subplots(size=(6, 3))
_ = plots.energy(run, ax=ax)

# %% [markdown]
# **Figure 5.6.** The energy of the flock that follows a *moving* γ-agent. It rises and falls: the γ-agent does work
# on the flock, and Theorem 6, which supposes a static one, is vacuous.
#
# ## Questions that come up
#
# *Is a β-agent a device?* No. An agent that measures the nearest point of an obstacle, and knows its own velocity, can
# compute it: $P$ needs the direction to that point, and $\mu$ the radius of curvature.
#
# *What if two points of an obstacle are equally near, as in a corner of the U?* Then a single β-agent would jump from
# one to the other, and the force with it. The U here is made of three bars, each convex and with a β-agent of its own.
# To a convex set the nearest point is unique and moves continuously, so the push is continuous. The *velocity* of the
# β-agent is not: where the flat side of a bar meets its round end it jumps, and the braking with it. Outside spheres
# and walls the law is Lipschitz; outside bars it is not, and theorems that ask for that do not apply as they stand.
#
# *Why is the pull bounded here, when lecture 03 made use of its growth?* Because of the walls. A spring to a target
# that is 1000 away pulls with $1000\,c_1^\gamma$, and no wall of finite height withstands that. $V_\gamma$ still grows
# without bound, so cohesion about a *static* target survives (exercise 9).
#
# *The flock split at the pillar. Did it fail?* That depends on the task. Every agent passed, none came near the pillar,
# and at the end there is one net. What failed for a while is connectedness, which Theorem 6 does not mention.
#
# ## What surprised, and what the theorem does not say
#
# The braking term makes the energy fall although the β-agents move: a moving partner could drive, and projection is
# what forbids it. The theorem promises neither arrival, nor a way around, nor that nobody hits the obstacle: the
# repulsion is finite. What excludes hitting is an energy argument like that on collisions,
# $H(0) < c_1^\beta\psi_\beta(0)$, and it is soon vacuous; the clearance of *this* run is measured instead.
#
# ## Summary
#
# - β-agents are projections of the agent on the obstacle; they repel and brake, and never drive.
# - Theorem 6 bounds the energy only: it promises neither arrival nor a way around. Its condition must hold at all
#   later times.
# - A rest behind an obstacle is a saddle, which disturbances undo, or a local minimum, which they do not. An obstacle
#   that is flatter than the circle about the target through the agent traps it, convex or not.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) An agent moves past a sphere of radius 2 at the origin: it is at $(4, 0)$ with
# velocity $(1, 3)$. (a) How fast is its β-agent? (b) Compute $\langle p, \hat p - p\rangle$. (c) At which rate does
# the distance from the sphere change? Give the list, exactly.

# %% tags=["answer"]
shadow = ...

# %% tags=["solution"]
shadow = [2 / 4 * 3, (2 / 4 * 3) * 3 - (1 + 9), 1.0]

# %% tags=["check"]
grade(shadow, [1.5, -5.5, 1.0], hint="which part of the velocity does P keep?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, experiment) Let `run` start with twice the velocity of the γ-agent (10 along x). What is the
# least clearance that it reaches, to three significant digits?

# %% tags=["answer"]
reached = ...

# %% tags=["solution"]
fast = fl.simulate(law, start, np.tile([10.0, 0.0], (len(start), 1)), (0.0, 50.0))
reached = fast.clearance().reached

# %% tags=["check"]
grade(reached, 4.12186, digits=3, hint="run it with another p0, and ask that run for its clearance")

# %% [markdown] tags=["exercise"]
# **3.** ★★★ (3 points, derivation) A γ-agent that stays at the origin reports $p_d = (1, 0)$. One agent is at rest
# at the origin; $c_1^\gamma = 1$, $c_2^\gamma = 2$, no obstacle. Put $p = 0$ into $\dot H$: it is 0, and the
# condition $\tfrac n2\langle p_c, p_d\rangle \le T$ holds, with equality. Does the energy stay? Compute $\ddot H$ at
# this instant, exactly. (Then run it, and read what `os-6` says and why.)

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

# %% [markdown] tags=["exercise"]
# **4.** ★ (1 point, derivation) An agent moves with the velocity $(3, 4)$ near a wall with the normal $(0, 1)$.
# Compute $\langle p, \hat p - p\rangle$, the power that its braking draws, exactly.

# %% tags=["answer"]
work = ...

# %% tags=["solution"]
work = -(4.0**2)  # Pp = (3, 0), so p̂ − p = (0, −4)

# %% tags=["check"]
grade(work, -16.0, hint="split the velocity along and across the wall")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, derivation) The pull of Algorithm 3 is bounded by $c_1^\gamma$. At what distance from the
# γ-agent is it at 99 % of that bound? (Four significant digits.)

# %% tags=["answer"]
far = ...

# %% tags=["solution"]
far = 0.99 / np.sqrt(1.0 - 0.99**2)

# %% tags=["check"]
grade(far, 7.01792, digits=4, hint="invert σ₁")

# %% [markdown] tags=["exercise"]
# **6.** ★★★ (3 points, counterexample) Theorem 6 does not promise arrival. Find a *trap*: a position at which one
# agent under the law `cup` rests for ever though it is farther than 30 from the target at $(120, 0)$, and to which
# it returns after a small disturbance. Give a list of two numbers, with a force below $10^{-6}$ and two positive
# curvatures.

# %% tags=["answer"]
trap = ...

# %% tags=["solution"]
from scipy.optimize import least_squares

settled = fl.simulate(cup, [[20.0, 1.0]], [[0.0, 0.0]], (0.0, 300.0)).q[-1, 0]
trap = least_squares(lambda q: cup.acceleration(0.0, [q], [[0.0, 0.0]])[0], settled, xtol=1e-15, ftol=1e-15).x.tolist()
print(trap, curvatures(cup, trap))

# %% tags=["check"]
grade(
    trap,
    lambda q: (
        len(q) == 2
        and np.hypot(q[0] - 120.0, q[1]) > 30.0
        and next(
            np.linalg.norm(law.acceleration(0.0, [q], [[0.0, 0.0]])) < 1e-6
            and np.linalg.eigvals(np.asarray(law.jacobian(0.0, [q], [[0.0, 0.0]]))).real.max() < -1e-6
            for world in [fl.scenario("paper-trapped").law]
            for law in [fl.Algorithm3(gains=world.gains, target=world.target, obstacles=world.obstacles)]
        )
    ),
    form="list",
    hint="let an agent run into the U, and polish the place where it comes to rest; beware of saddles",
)

# %% [markdown] tags=["exercise"]
# **7.** ★★ (2 points, words) An engineer runs Algorithm 3, sees some agents stuck behind an obstacle, and calls
# Theorem 6 false. Is it? What does the theorem say about these agents, and what would have to be proved to exclude
# them? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# It is not: the theorem says that the energy does not rise, and agents at rest behind an obstacle have constant
# energy. They sit at a critical point of the total potential, where the pull and the repulsion cancel. To exclude
# them one would have to show that the potential has no local minimum other than the goal, which this one has.
#
# **Rubric, a point each:** the theorem bounds the energy only, and is met at rest; one must exclude other minima of
# the total potential.

# %% [markdown] tags=["exercise"]
# **8.** ★ (1 point, player) Drag the player of the flock at the pillar. Into how many groups, linked by lines, does
# the flock split at most? (A whole number.)

# %% tags=["answer"]
most_groups = ...

# %% tags=["solution"]
most_groups = max(len(set(fl.components(run.n, fl.links(q, 8.4)))) for q in run.q)

# %% tags=["check"]
grade(most_groups, 3, hint="look around t = 20")

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, proof) Let $p_d = 0$, and let every obstacle be a sphere or a wall, and let every agent stay
# outside. Prove that every solution of Algorithm 3 approaches states at rest at which $\nabla(V_\alpha + V_\beta +
# V_\gamma) = 0$. Where do you use $c_2^\gamma > 0$, and where that $V_\gamma$ grows without bound?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# By Theorem 6 $\dot H \le -2c_2^\gamma T \le 0$. The set $\{H \le H(0)\}$ is closed and positively invariant. All
# potentials are non-negative, so $T \le H(0)$ bounds the velocities, and $V_\gamma \le H(0)$ bounds the distances
# from $q_d$, because $\sqrt{1+\|q_i-q_d\|^2}$ grows without bound. So the set is compact. The law has no explicit
# time, as the γ-agent is static, and outside spheres and walls it is Lipschitz (outside bars it is not, see the
# questions: there the theorem as stated does not apply). So LaSalle's theorem applies: the solution
# approaches an invariant set with $\dot H = 0$, hence with $T = 0$, because $c_2^\gamma > 0$. There $p = 0$ at all
# times, so $\dot p = 0$, and with $p = \hat p = 0$ the law leaves $\nabla(V_\alpha+V_\beta+V_\gamma) = 0$.
#
# **Rubric, a point each:** compactness from $V_\gamma$ and $T$; LaSalle with $\dot H = 0$ only at rest, by
# $c_2^\gamma > 0$; by invariance the gradient vanishes.
