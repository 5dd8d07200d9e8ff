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
# **Aims.** Derive the energy identity of Algorithm 1 line by line, watch it hold along a run, prove what Theorem 1
# really gives, and see what energy does not give: cohesion.
#
# ## A scene
#
# A predator shoots through a school of fish. For seconds the school is in pieces, each fish darting its own way; a
# moment later there is one school again, or there are two. **Which of the two will it be, if each fish only keeps
# its distance from its neighbours and swims as they swim?** The law of this lecture is just that: a force that keeps
# the distance, and friction between neighbours. It has a beautiful energy, which always falls. And yet the answer
# will be: nothing in the law decides it.
#
# ## Two fish on a line
#
# Let two agents on a line have the distance $y = q_2 - q_1 > 0$. Agent 2 feels $c_1^\alpha\phi_\alpha$ times
# $n_{21} = -y/\sqrt{1+\varepsilon y^2}$, agent 1 the opposite; friction pulls each velocity to the other. Subtract
# the two equations of motion:
#
# $$\ddot y = -2c_1^\alpha\,\phi_\alpha(\|y\|_\sigma)\,\frac{y}{\sqrt{1+\varepsilon y^2}} -
#   2c_2^\alpha\,a_{12}\,\dot y .$$
#
# This is a mass in a potential with friction. The inner derivative of $\|y\|_\sigma$ is $y/\sqrt{1+\varepsilon y^2}$
# and $\psi_\alpha' = \phi_\alpha$ (lecture 01), so the potential of the moving pair changes at the rate
# $\tfrac{d}{dt}\psi_\alpha(\|y\|_\sigma) = \phi_\alpha(\|y\|_\sigma)\,\tfrac{y}{\sqrt{1+\varepsilon y^2}}\,\dot y$.
# Multiply the equation by $\tfrac12\dot y$; its first term is then $-c_1^\alpha$ times this rate, and
#
# $$\frac{d}{dt}\Bigl[c_1^\alpha\psi_\alpha(\|y\|_\sigma) + \tfrac14\dot y^2\Bigr] = -c_2^\alpha\,a_{12}\,\dot y^2
#   \le 0 .$$
#
# The bracket is the energy $H$ of the pair. Why $\tfrac14$? With the centre at rest each agent moves at half the
# relative speed, so their kinetic energy is $2\cdot\tfrac12(\tfrac12\dot y)^2 = \tfrac14\dot y^2$. Without friction $H$
# is constant, so a motion runs along a level curve of it. If the energy is below
# $c_1^\alpha\psi_\alpha(r_\alpha)$, the height of the rim, the pair swings for ever; if it is above, the pair gets out
# of range, feels nothing any more, and never comes back.
#
# <details><summary>With numbers</summary>
#
# *With numbers.* Let $c_1^\alpha = 1$. The rim is $\psi_\alpha(r_\alpha) = 0.736$ high. A pair
# at rest 6.6 apart has the energy 0.635, below the rim, and stays together. At rest 6.5 apart it has 0.967, above the
# rim: without friction it parts. Only 0.1 of a length lies between the two fates, because the potential is steep where
# agents are too close, and its rim is low.
#
# </details>

# %%
import numpy as np

import flockana as fl
from flockana import plots, symbolic
from flockana.course import Prediction, figures, grade

law = fl.Algorithm1(gains=fl.Gains(c1_alpha=1.0, c2_alpha=1.5))
figure, axes = plots.subplots(1, 2, size=(11, 3.8))
figures.three_orbits(law.alpha, ax=axes[0])
couple = fl.simulate(law, [[0.0], [6.6]], [[0.0], [0.0]], (0.0, 30.0), t_eval=np.linspace(0.0, 30.0, 1500))
distance, rate = np.diff(couple.q, axis=1)[:, 0], np.diff(couple.p, axis=1)[:, 0]
x, v = np.linspace(6.2, 8.6, 200), np.linspace(-2.5, 2.5, 200)
_ = plots.phase_portrait(
    distance,
    rate,
    energy=(x, v, law.alpha.psi_alpha(law.alpha.sigma_norm(x)) + v[:, None] ** 2 / 4),
    separatrix=law.alpha.psi_alpha(law.alpha.r_alpha),
    labels=("distance of the pair (length)", "its rate (length/time)"),
    ax=axes[1],
)

# %% [markdown]
# **Figure 2.1.** Left: a pair without friction, with energies of 0.5, 1 and 1.6 times the rim's. The level curve at
# the rim's height, the *separatrix*, divides the motions that stay from those that leave. Right: a pair with
# friction that starts at rest 6.6 apart, inside the separatrix; its energy falls, so it stays inside and spirals
# into the well.
#
# So for two agents all is decided: friction can only help, and a pair that starts inside the separatrix flocks. For
# more agents the same energy still falls. Let us see what survives.
#
# ## The law, and its potential
#
# Algorithm 1 of Olfati-Saber (2006, section IV) is the sum over the neighbours of both terms,
#
# $$u_i = c_1^\alpha \sum_{j\in N_i} \phi_\alpha(\|q_j-q_i\|_\sigma)\,n_{ij} + c_2^\alpha \sum_{j\in N_i}
#   a_{ij}(q)(p_j-p_i),$$
#
# with $n_{ij} = (q_j-q_i)/\sqrt{1+\varepsilon\|q_j-q_i\|^2}$ and $a_{ij} = \rho_h(\|q_j-q_i\|_\sigma/r_\alpha)$ of
# lecture 01. The *collective potential* counts each pair once, those out of range too,
#
# $$V(q) = \tfrac12\sum_i\sum_{j\ne i}\psi_\alpha(\|q_j-q_i\|_\sigma) .$$
#
# Its gradient with respect to $q_i$: of all pairs only those that contain $i$ depend on $q_i$, each counted once,
# and each contributes $-\phi_\alpha n_{ij}$ by (iv) of lecture 01's theorem, so
#
# $$\nabla_{q_i}V = -\sum_{j\in N_i}\phi_\alpha(\|q_j-q_i\|_\sigma)\,n_{ij} .$$
#
# With $L = \Delta(A) - A$, the Laplacian of the weights $A = [a_{ij}]$, and $\hat L = L\otimes I_m$, the whole law
# reads
#
# $$\dot q = p, \qquad \dot p = -c_1^\alpha\nabla V(q) - c_2^\alpha \hat L(q)\,p :$$
#
# a gradient descent with friction between neighbours.
#
# ## The energy identity
#
# > **Theorem (energy).** Along every solution of Algorithm 1 the energy
# > $H = c_1^\alpha V(q) + \tfrac12\sum_i\|p_i\|^2$ changes at the rate $\dot H = -c_2^\alpha\,p^\top\hat
# > L(q)\,p = -\tfrac12c_2^\alpha\sum_{i,j}a_{ij}\|p_j-p_i\|^2 \le 0$.
#
# *Proof.*
#
# $$\begin{aligned}
# \dot H &= c_1^\alpha\sum_i\langle\nabla_{q_i}V, \dot q_i\rangle + \sum_i\langle p_i, \dot p_i\rangle &&
#   \text{chain rule} \\
# &= c_1^\alpha\langle\nabla V, p\rangle + \langle p, -c_1^\alpha\nabla V - c_2^\alpha\hat Lp\rangle && \text{insert
#   the law} \\
# &= -c_2^\alpha\,p^\top\hat Lp && \text{the gradient cancels} \\
# &= -\tfrac12c_2^\alpha\sum_{i,j}a_{ij}\|p_j-p_i\|^2 \le 0 . && \text{quadratic form of lecture 00a} \quad\square
# \end{aligned}$$
#
# The library derives the same by computer algebra. $V$ and $u$ are sums over pairs, so one generic pair is enough
# for every $n$:

# %%
identity = symbolic.algorithm1_identity(m=2)
print("residual of dH/dt + c2 pᵀL̂p:", identity.residual)
identity

# %% [markdown]
# The factor ½ of the kinetic energy is needed for the gradient to cancel. A set of lecture slides prints
# $\sum\|p_i\|^2$ without it; then a term without sign remains (erratum E1), and at some states that "energy" rises.
# A wrong factor in a printed formula is found in a minute by such a check:

# %%
print(symbolic.e1_identity(m=2).residual)
print(fl.verify("E1").status)

# %% [markdown]
# > **Theorem (momentum).** Under Algorithm 1 the mean velocity $p_c = \tfrac1n\sum_ip_i$ is constant.
#
# *Proof.* In $\sum_iu_i$ every pair appears twice, as $(i,j)$ and $(j,i)$. As $n_{ji} = -n_{ij}$ and
# $a_{ji} = a_{ij}$, its two terms cancel. So $\dot p_c = 0$. $\square$
#
# <details><summary>With numbers</summary>
#
# **Both with numbers.** Three agents in a row, 7 apart, all weights of linked pairs 0.1793 (lecture 01), $c_2^\alpha =
# 2\sqrt{30} = 10.95$, with the velocities $1$, $0$, $-1$ along the row. The outer two are 14 apart and not linked. Then
# $\dot H = -10.95\cdot0.1793\,\bigl[(1-0)^2 + (0+1)^2\bigr] = -3.93$: friction takes 3.93 units of energy in a unit of
# time. At the distance 7 no pair exerts a force, so the inputs are friction only: $u_1 = 10.95\cdot0.1793\,(0 - 1) =
# -1.96$, $u_2 = 10.95\cdot0.1793\,(1 - 1) = 0$, $u_3 = +1.96$. Their sum is 0, as the theorem on momentum says, and
# $\sum p_iu_i = -3.93$, as the energy says. Note agent 2: its neighbours pull it in both directions, and
# it feels nothing.
#
# </details>
#
# So the centre $q_c = \tfrac1n\sum_iq_i$ moves uniformly, and nothing is lost by riding with it: put
# $x_i = q_i - q_c$ and $v_i = p_i - p_c$. Distances are the same, $V(x) = V(q)$. The kinetic energy splits:
#
# $$\begin{aligned}
# \tfrac12\sum_i\|p_i\|^2 &= \tfrac12\sum_i\|v_i + p_c\|^2 && \text{definition of } v_i \\
# &= \tfrac12\sum_i\|v_i\|^2 + \langle\sum_iv_i, p_c\rangle + \tfrac n2\|p_c\|^2 &&
#   \text{multiply out} \\
# &= \tfrac12\sum_i\|v_i\|^2 + \tfrac n2\|p_c\|^2 . && \sum_iv_i = 0
# \end{aligned}$$
#
# The last term is constant. So $H(x,v) = c_1^\alpha V(x) + \tfrac12\sum\|v_i\|^2$ falls at the same rate,
# $\dot H = -c_2^\alpha\,v^\top\hat L v$.
#
# ## A run of forty agents
#
# Nothing in Algorithm 1 calls a stray agent back. The paper shows it in its Fig. 12: forty agents at random places,

# %%
run = fl.scenario("paper-fragmentation").run()

# %% tags=["predict"]
guess = ...
Prediction(
    "The forty agents start in 35 pieces. In how many are they at t = 40?",
    guess,
    len(set(fl.components(run.n, fl.links(run.q[-1], 8.4)))),
)

# %%
figure, axes = plots.subplots(1, 3, size=(13, 4.2))
for ax, time in zip(axes, (0.0, 40.0, 40.0), strict=True):
    plots.snapshot(run, time=time, ax=ax, bar=False)
labels = np.array(fl.components(run.n, fl.links(run.q[-1], 8.4)))
group = run.q[-1, labels == np.bincount(labels).argmax()]
axes[2].set_aspect("equal", adjustable="box")
_ = axes[2].set(xlim=group[:, 0].mean() + np.array([-20.0, 20.0]), ylim=group[:, 1].mean() + np.array([-20.0, 20.0]))

# %% [markdown]
# **Figure 2.2.** The start, $t = 40$, and the largest component then, enlarged. Inside each component the distances are
# near 7 and the velocities alike; the components drift apart.

# %%
figure, axes = plots.subplots(1, 3, size=(12, 3))
plots.energy(run, ax=axes[0])
plots.energy_residual(run, ax=axes[1])
_ = plots.components(run, ax=axes[2])

# %% tags=["facts"]
pieces = [len(set(fl.components(run.n, fl.links(run.q[k], 8.4)))) for k in (0, -1)]
assert pieces == [35, 24]
assert abs(run.energy_residual).max() / run.energy()[0] < 2e-9
assert symbolic.algorithm1_identity(m=2).residual == 0
row, speeds = np.array([[0.0], [7.0], [14.0]]), np.array([[1.0], [0.0], [-1.0]])
inputs = fl.Algorithm1().acceleration(0.0, row, speeds)
assert [f"{each:.2f}" for each in inputs[[0, 2], 0]] == ["-1.96", "1.96"]
assert abs(inputs[1, 0]) < 1e-12
assert f"{float(np.sum(inputs * speeds)):.2f}" == "-3.93"
assert couple.energy()[0] < law.alpha.psi_alpha(law.alpha.r_alpha)  # inside the separatrix
heights = [law.alpha.r_alpha, law.alpha.sigma_norm(6.6), law.alpha.sigma_norm(6.5)]
assert [f"{float(law.alpha.psi_alpha(z)):.3f}" for z in heights] == ["0.736", "0.635", "0.967"]
stiffer = fl.Algorithm1(gains=fl.Gains(c1_alpha=100.0, c2_alpha=15.0))
faster = fl.simulate(stiffer, [[0.0], [6.6]], [[0.0], [0.0]], (0.0, 3.0), t_eval=couple.t / 10.0)
assert abs(faster.q - couple.q).max() < 1e-5
parted = run.n * (run.n - 1) // 2 - len(fl.links(run.q[-1], 8.4))
rims = parted * run.law.gains.c1_alpha * float(run.law.alpha.psi_alpha(run.law.alpha.r_alpha))
assert f"{parted} {rims:.0f} {run.energy()[-1]:.0f}" == "762 16823 17052"

# %% [markdown]
# **Figure 2.3.** The energy falls to a constant, its balance closes to nine digits, and the number of components
# falls too, but not to one. The first picture alone would have suggested success.
#
# ## Theorem 1
#
# A group is *cohesive* if one ball about its centre holds it at all times; it is a *flock* while its net is
# connected. An *α-lattice* is a configuration in which every agent is exactly $d$ away from each of its neighbours
# (lecture 04). A *critical point* of $V$ is an $x$ with $\nabla V(x) = 0$: all pair forces on each agent balance.
# *Almost every* start means every start outside a set of measure zero, which a start drawn at random does not hit.
#
# > **Theorem 1** (Olfati-Saber 2006, as lecture slides on it print it; the paper itself was not looked up). Let
# > $\Omega = \{(x, v) : H(x, v) \le H_0\}$ be such that every solution of Algorithm 1 that starts in it is a cohesive
# > flock for all times. Then (i) almost every solution that starts in $\Omega$ converges to an equilibrium $(x^*, 0)$
# > where $x^*$ is an α-lattice; (ii) all agents asymptotically move with the same velocity; (iii) if
# > $H_0 < c^* = c_1^\alpha\psi_\alpha(0)$, no two agents ever collide.
#
# *Proof of (ii), of (iii), and of what is true of (i).* Let a solution start in $\Omega$.
#
# 1. It stays in $\Omega$, because $H$ does not rise.
# 2. Its positions $x$ stay in a ball, because the flock is cohesive. Its velocities satisfy
#    $\tfrac12\sum\|v_i\|^2 \le H_0$, because $V \ge 0$. So it stays in a compact set.
# 3. By LaSalle's theorem it approaches an invariant set $\Lambda$ on which $\dot H = 0$. The states of $\Lambda$ are
#    limits of states in $\Omega$, which is closed, so they lie in $\Omega$, and by hypothesis they have connected
#    nets.
# 4. On $\Lambda$: $v^\top\hat Lv = 0$ and the net is connected, so all $v_i$ are equal (lecture 00a); their sum is
#    0, so $v = 0$. That is (ii).
# 5. $\Lambda$ is invariant and $v = 0$ on it at all times, so $\dot v = -c_1^\alpha\nabla V = 0$. The solution
#    approaches the *critical points* of $V$.
# 6. Suppose two agents coincide at some time. Their pair alone costs $c_1^\alpha\psi_\alpha(0) = c^*$, and all other
#    terms of $H$ are non-negative, so $H \ge c^*$ at that time. But $H \le H_0 < c^*$: a contradiction, and (iii).
#    $\square$
#
# Step 5 gives critical points, not α-lattices. A critical point that is no local minimum is reached by exceptional
# solutions only (lecture 03 says which part of this is proved, and how). But a local minimum of $V$ need not be a
# lattice, and claim (i) is false as printed: erratum E3, lecture 07.
#
# Where does connectedness enter? In step 4, to conclude $v = 0$; and it gives step 2 too, because in a connected net
# of $n$ agents no two are farther apart than $(n-1)r$. **The whole weight of the proof rests on the hypothesis**,
# and the hypothesis is the very thing that a user wants to know. Ask it of our run:

# %%
print(fl.verify("energy", run).status)
print(fl.verify("os-1", run))

# %% [markdown]
# Theorem 1 is *vacuous* here, and the verdict says why: its hypothesis is that every solution that starts in the
# level set is a cohesive flock, and this run is not one.
#
# ## Which step fails without the hypothesis?
#
# Step 2. A level set of $H$ is not bounded: put two agents 10 apart and at rest, then 100, then $10^6$; the energy
# is $c_1^\alpha\psi_\alpha(r_\alpha)$ each time. A pair out of range costs a constant, so distance costs nothing.
# Two components that are out of each other's range and drift apart have a constant energy and conserved momenta, and
# no term in the law brings them together. The energy identity is true, the energy falls, and it does not matter.
# Lecture 03 adds one term, and everything changes.
#
# ## Which flocks Theorem 1 is about
#
# No run shows what all solutions do, but energy does.
#
# > **Proposition.** If $H(0) < (n-1)\,c_1^\alpha\,\psi_\alpha(r_\alpha)$, the net is connected at all times, and no
# > agent is ever farther than $(n-1)r$ from another.
#
# *Proof.*
#
# 1. Suppose that at some time the net is in two parts, of $k$ and $n-k$ agents, with no link between them. All
#    $k(n-k)$ pairs across are out of range.
# 2. $k(n-k) - (n-1) = (k-1)(n-k-1) \ge 0$ for $1 \le k \le n-1$: multiply out. So there are at least $n-1$ such pairs.
# 3. Each of them costs $c_1^\alpha\psi_\alpha(r_\alpha)$, and all other terms of $H$ are non-negative, so
#    $H \ge (n-1)c_1^\alpha\psi_\alpha(r_\alpha) > H(0)$ at that time. But $H$ does not rise.
# 4. In a connected net a chain of at most $n-1$ links, each shorter than $r$, joins any two agents. $\square$
#
# Under this condition the hypothesis of Theorem 1 is *met*, and (ii) is a theorem about that start. How much energy is
# left for motion, once the best lattice of $n$ agents has its own?

# %%
alpha, gain = fl.AlphaInteraction(), fl.Gains().c1_alpha
print(" n  V of the best lattice  limit  speed left (length/time)")
for n in range(2, 8):
    V = gain * alpha.potential_energy(fl.lattice.hexagonal_spiral(n, alpha.d))
    limit = gain * (n - 1) * alpha.far_potential
    speed = f"{np.sqrt(2.0 * (limit - V) / n):.2f}" if limit > V else "none: energy does not decide"
    print(f"{n:2d}  {V:21.2f}  {limit:5.1f}  {speed}")

triangle = alpha.d * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
print(fl.verify("os-1", law=fl.Algorithm1(), q0=1.01 * triangle, p0=[[1, 0], [0, 1], [-1, -1]], t_span=(0.0, 2.0)))

# %% [markdown]
# The table can be had by counting. In a lattice only pairs without a link cost anything. Five agents have 10 pairs, the
# best lattice in the plane links 7 of them, 3 are left, and 3 is less than $n - 1 = 4$. Six have 15 pairs and 9 links:
# 6 are left, and 6 is not less than 5. A row of three has 1 pair left, of 2; a row of four has 3, of 3. So Theorem 1 is
# certainly about slow lattices of up to five agents in the plane, and of three on a line. Of larger flocks the
# hypothesis can be unmet, as for the forty agents above, or open. Claim (i) needs a certificate of its own, which a run
# as short as this one does not give.
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
own = fl.Algorithm1(morse, fl.Gains(c1_alpha=1.0, c2_alpha=1.0))
print(fl.verify("any-potential", law=own, q0=triangle, p0=[[1, 0], [0, 1], [-1, -1]], t_span=(0.0, 2.0)))

# %% [markdown]
# ## A student project's two films
#
# A course project (see `fl.cite(fl.scenario("notebook-algorithm1"))`) animates 27 agents under Algorithm 1 and 35
# under Algorithm 2, which adds a γ-agent. The first:

# %%
film = fl.scenario("notebook-algorithm1").run()
film.player(height=560)

# %% [markdown]
# In the second the agents take on the γ-agent's velocity, but leave its place (the cross), and the flock splits.
# Neither is an error of the film: the project sets $c_1^\gamma = 0$, so the place of the γ-agent is not in the law
# at all, and nothing holds the flock together.

# %%
left = fl.scenario("notebook-algorithm2").run()
left.player(height=560)

# %% tags=["facts"]
assert left.law.gains.c1_gamma == 0.0
assert left.metrics().connectivity[-1] < 1.0  # it splits

# %% [markdown]
# ## An experiment: the same six agents, three starts
#
# How does one find out what decides between one school and two? Change one thing at a time. Six agents stand in a
# ring of radius 7, so that neighbours are 7 apart, and start at rest; then with random velocities of length 5; then
# of length 20.

# %%
angle = 2.0 * np.pi * np.arange(6) / 6.0
ring = 7.0 * np.column_stack([np.cos(angle), np.sin(angle)])
turn = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, 6)
heading = np.column_stack([np.cos(turn), np.sin(turn)])
for speed in (0.0, 5.0, 20.0):
    tried = fl.simulate(fl.Algorithm1(), ring, speed * heading, (0.0, 40.0))
    parts = len(set(fl.components(6, fl.links(tried.q[-1], 8.4))))
    apart = np.linalg.norm(tried.p[-1] - tried.p[-1].mean(axis=0), axis=1).max()
    print(f"speed {speed}: energy {tried.energy()[0]:7.2f}, ends in {parts} part(s), velocities differ by {apart:.1e}")

# %% tags=["facts"]
outcome = []
for speed in (0.0, 5.0, 20.0):
    tried = fl.simulate(fl.Algorithm1(), ring, speed * heading, (0.0, 40.0))
    outcome.append(len(set(fl.components(6, fl.links(tried.q[-1], 8.4)))))
assert outcome[0] == outcome[1] == 1
assert outcome[2] > 1
rim = gain * alpha.far_potential
assert f"{rim:.2f} {gain * alpha.potential_energy(ring):.1f} {9.0 * rim:.1f}" == "22.08 198.7 198.7"

# %% [markdown]
# The ring survives a speed of 5 and breaks at 20. How the energies come about: a ring of six with the side 7 has 15
# pairs, 6 of them linked at the distance $d$, where they cost nothing, and 9 out of range, which cost 22.08 each,
# together 198.7. The kinetic energy is $6\cdot\tfrac12\cdot5^2 = 75$, or $6\cdot\tfrac12\cdot20^2 = 1200$. To cut it in
# two costs two links, that is two rims of $c_1^\alpha\psi_\alpha(r_\alpha) = 22$ each; the kinetic energy at 5 is 75,
# more than that, and yet the ring holds: friction was faster than the agents. So energy gives a condition that is
# *sufficient* for staying together, as above, and far from necessary. Theorems of this kind, with a hypothesis that can
# be checked before the run, are the right way to repair Theorem 1 (see also Tanner, Jadbabaie and Pappas; lecture 12).
# They are modest: they protect small flocks with small energies, and say nothing about the forty agents of Figure 2.2.
#
# What the experiment does not show is where the boundary lies. Three runs are no statistics; lecture 10 does that
# properly.
#
# ## Questions that come up
#
# *The energy falls and is bounded below, so it converges. Why do the velocities not agree then?* The rate of loss
# contains linked pairs only. It is 0 as soon as velocities agree *within* each component, however much they differ
# between components. Two components that drift apart lose no energy by it, and keep their two velocities.
#
# *Where does the energy of a pair go when it parts?* It stays in $H$. A pair that climbs out of its well keeps
# $c_1^\alpha\psi_\alpha(r_\alpha)$ as potential energy, although the two never meet again. At the end of the run of
# forty agents $H = 17052$, and 16823 of it belong to the 762 pairs that are out of range.
#
# *Can components that have parted meet again?* Yes. While they are out of range their centres move uniformly
# (exercise 8), so they meet if their courses cross at the right time. Nothing in the law makes them.
#
# *Would a larger $c_1^\alpha$ hold the flock together? It raises the rim.* Not if the flock starts at rest. Measure
# time in units of $1/\sqrt{c_1^\alpha}$: the law becomes $\ddot q = -\nabla V - (c_2^\alpha/\sqrt{c_1^\alpha})\hat
# L\dot q$. Force and rim grow alike, and what counts is $c_2^\alpha/\sqrt{c_1^\alpha}$. So a larger $c_1^\alpha$ alone
# makes the friction relatively *weaker*. The pair of Figure 2.1 with $c_1^\alpha = 100$ and $c_2^\alpha = 15$ moves
# along the same path, ten times as fast.
#
# *Is Theorem 1 wrong?* (ii) and (iii) are proved above. (i) is false as printed. But the more important defect is
# another one: for most flocks nobody can tell whether the theorem applies.
#
# ## What surprised, and what the theorem does not say
#
# Theorem 1 has a short, correct proof (of (ii) and (iii)), and its hypothesis can be checked before the run only for
# small, slow flocks; for others one can but hope. It does not say that a flock that starts connected stays so
# (exercise 6). It does not say how fast velocities match. And (iii) says nothing of a start with much energy, in
# which collisions may well never happen.
#
# ## Summary
#
# - Algorithm 1 is a gradient descent with damping between neighbours, and
#   $\dot H = -c_2^\alpha p^\top\hat Lp \le 0$; its momentum is constant.
# - Cohesion and connectedness give compactness and $v = 0$ in LaSalle's principle; without them groups fragment.
# - Theorem 1 assumes what would have to be shown, so it is vacuous where a run fragments.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, reading) In how many components is `run` at $t = 10$? (A whole number.)

# %% tags=["answer"]
components = ...

# %% tags=["solution"]
labels = fl.components(run.n, fl.links(run.q[np.searchsorted(run.t, 10.0)], run.law.alpha.r))
components = len(set(labels))

# %% tags=["check"]
grade(components, 26, hint="fl.components(n, links) labels every agent, fl.links(q, r) finds the links")

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
# **3.** ★ (1 point, experiment) What is the largest change of the momentum $\sum p_i$ in `run`, relative to
# $\sum \|p_i(0)\|$, to within $10^{-10}$? Why must it be so?

# %% tags=["answer"]
drift = ...

# %% tags=["solution"]
momentum = run.p.sum(axis=1)
drift = np.abs(momentum - momentum[0]).max() / np.linalg.norm(run.p[0], axis=1).sum()  # pairs push equally: 0, rounded

# %% tags=["check"]
grade(drift, 0.0, within=1e-10, hint="run.p has shape (T, n, m)")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) Two agents start at rest 6 apart, under `law` without its damping. (a) What is
# their energy? (b) At what relative speed do they move once they are out of range? (c) At what relative speed do
# they pass the distance 7? Give the list, each number to four significant digits.

# %% tags=["answer"]
parting = ...

# %% tags=["solution"]
high = psi(law.alpha.sigma_norm(6.0))
parting = [high, 2.0 * np.sqrt(high - psi(law.alpha.r_alpha)), 2.0 * np.sqrt(high)]
print(parting)

# %% tags=["check"]
grade(
    parting,
    [3.39440498, 3.2609838, 3.68478221],
    digits=4,
    hint="H is conserved; each agent has half the relative speed",
)

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, words) Which step of a proof of cohesion for Algorithm 1 by LaSalle's principle fails, and
# what in Algorithm 2 could repair it? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# $H$ falls, but its level sets are not bounded: a pair out of range costs a constant, however far apart it is, so
# agents can leave without more energy and the set is not compact. Algorithm 2 adds a pull that grows with the
# distance from the centre; then a level set bounds the size of the group.
#
# **Rubric, a point each:** level sets of $H$ are not bounded; because a pair out of range costs a constant; a pull
# that grows with the distance, as the γ-agent's.

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, counterexample) A classmate claims: under Algorithm 1 a group that starts at rest and
# connected stays connected. Give positions of a few agents in the plane, an array of shape (n, 2), $n \le 12$, that
# refute it: one component at the start, more than one after 20 time units under `fl.Algorithm1()`.

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

# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Watch the first of the two films to its end. Into how many groups, linked by lines, have
# the 27 agents formed? (A whole number.)

# %% tags=["answer"]
groups = ...

# %% tags=["solution"]
groups = len(set(fl.components(film.n, fl.links(film.q[-1], film.law.alpha.r))))

# %% tags=["check"]
grade(groups, 3, hint="a single agent without a line counts as a group")

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, proof) Two groups of agents are at all times farther apart than $r$. Prove that the energy of
# each group by itself does not rise and that the centre of each moves at constant velocity. Conclude from the
# initial state alone when two groups never meet again, if each stays within a ball of radius $R$ about its centre.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# No pair of agents from different groups is in range, so both sums in $u_i$ run over the own group only, and each
# group obeys Algorithm 1 by itself. The energy and momentum theorems apply to it. Let $\bar q$ and $\bar p$ be the
# difference of the two centres and of their velocities. The distance of the centres at time $t$ is
# $\|\bar q(0) + t\,\bar p\|$. If $\langle\bar q, \bar p\rangle \ge 0$, this never falls, and if
# $\|\bar q(0)\| > 2R + r$, no two agents of different groups are ever within $r$.
#
# **Rubric, a point each:** each group obeys the law alone, so both theorems apply; a sufficient condition on
# centres, velocities, $R$ and $r$.
