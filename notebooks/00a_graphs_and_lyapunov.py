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
# # Graphs, agreement, Lyapunov and LaSalle
#
# **Aims.** Know the Laplacian of a net and what its eigenvalues say; solve the consensus equation; prove convergence
# with the theorems of Lyapunov, LaSalle and Barbalat, and see what happens where a hypothesis of theirs is missing.
# All later lectures rest on these tools.
#
# ## A scene
#
# Six robots drive in a convoy through a warehouse. Each measures the speed of the robots that it can see and
# corrects its own towards theirs. Nobody knows the mean of all six, and nobody can see everyone. **Will the convoy
# agree on one speed, on which, and how fast?** The answer depends on one matrix, made of nothing but who sees whom.
# The second half of the lecture asks what to do when that matrix changes while the robots drive, because they drive:
# then eigenvalues prove nothing, and energy has to do the work.
#
# ## Two robots
#
# Let two robots have the speeds $x_1$ and $x_2$, and let each correct its own in proportion to the difference, with
# a weight $a_{12} > 0$:
#
# $$\dot x_1 = a_{12}(x_2 - x_1), \qquad \dot x_2 = a_{12}(x_1 - x_2).$$
#
# Add the two lines: the sum $x_1 + x_2$ is constant. Subtract them: the difference $y = x_2 - x_1$ obeys
# $\dot y = -2a_{12}\,y$, so $y(t) = e^{-2a_{12}t}y(0)$. Hence both tend to the mean of their starts, and the
# difference falls at the rate $2a_{12}$. Everything that follows is this computation for $n$ robots: something is
# conserved, and the rest decays at a rate that the net decides.
#
# ## The net and its Laplacian
#
# Agents $1, \dots, n$ at $q_i \in \mathbb R^m$ are *neighbours* if they are nearer than $r$. The links $\{i, j\}$
# between neighbours form the *net*, an undirected graph. Give each link a weight $a_{ij} = a_{ji} > 0$, and put
# $a_{ij} = 0$ elsewhere and $a_{ii} = 0$. The *Laplacian* of the net is the matrix
#
# $$L = \Delta(A) - A, \qquad L_{ii} = \sum_j a_{ij}, \qquad L_{ij} = -a_{ij} \quad (i \ne j),$$
#
# where $\Delta(A)$ holds the sums of the rows of $A = [a_{ij}]$ on its diagonal. For the two robots it is
# $a_{12}\begin{pmatrix}1 & -1\\ -1 & 1\end{pmatrix}$. Each row sums to 0, so $L\mathbf 1 = 0$: the vector of equal
# numbers is an eigenvector for the eigenvalue 0.
#
# > **Theorem (quadratic form).** For every $z \in \mathbb R^n$ one has
# > $z^\top L z = \tfrac12 \sum_{i,j} a_{ij}\,(z_j - z_i)^2 \ge 0$.
#
# *Proof.* By the definition of $L$,
#
# $$\begin{aligned}
# z^\top L z &= \sum_i z_i \sum_j a_{ij}(z_i - z_j) && \text{row } i \text{ of } Lz \\
# &= \sum_{i,j} a_{ij}\,(z_i^2 - z_i z_j) && \text{multiply out} \\
# &= \tfrac12\sum_{i,j} a_{ij}\,(z_i^2 - z_iz_j) + \tfrac12\sum_{i,j} a_{ij}\,(z_j^2 - z_iz_j) && \text{exchange the
#   names } i, j \text{ in one half; } a_{ij} = a_{ji} \\
# &= \tfrac12\sum_{i,j} a_{ij}\,(z_i - z_j)^2 . && \square
# \end{aligned}$$
#
# > **Theorem (kernel).** The multiplicity of the eigenvalue 0 of $L$ is the number of components of the net, that is
# > of largest sets of agents that are linked by paths.
#
# *Proof.* If $Lz = 0$, then $z^\top Lz = 0$, so every term of the sum is 0: $z_i = z_j$ for linked agents, hence
# along every path, hence on each component. Conversely a vector that is constant on components has $Lz = 0$, because
# row $i$ compares $z_i$ with neighbours in the same component only. These vectors form a space with one dimension
# for each component. Because $L$ is symmetric, that dimension is the multiplicity. $\square$
#
# So the eigenvalues are $0 = \lambda_1 \le \lambda_2 \le \dots \le \lambda_n$, and $\lambda_2 > 0$ if and only if
# the net is connected. The number $\lambda_2$ is called the *algebraic connectivity*. For vectors in $\mathbb R^m$
# one writes $\hat L = L \otimes I_m$, the same matrix applied to each coordinate.

# %%
import numpy as np
from scipy.linalg import expm

import flockana as fl
from flockana import plots
from flockana.course import Prediction, figures, grade

nets = {
    "path": [(k, k + 1) for k in range(5)],
    "ring": [(k, (k + 1) % 6) for k in range(6)],
    "complete": [(i, j) for j in range(6) for i in range(j)],
    "two triangles": [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5)],
}
laplacians = {name: fl.laplacian(6, np.array(links)).toarray() for name, links in nets.items()}
figure, axes = plots.subplots(1, 4, size=(12, 3.1))
for ax, (name, L) in zip(axes, laplacians.items(), strict=True):
    figures.net(6, nets[name], title=f"{name}: λ2 = {abs(np.linalg.eigvalsh(L)[1]):.3f}", ax=ax)
for name, L in laplacians.items():
    print(f"{name:>14}: eigenvalues {np.linalg.eigvalsh(L).round(3) + 0.0}")

# %% [markdown]
# **Figure 0a.1.** Four nets of six agents, with unit weights. The more links, the larger is $\lambda_2$; the two
# triangles have two components, hence two eigenvalues 0, hence $\lambda_2 = 0$.
#
# <details><summary>One of them by hand</summary>
#
# On the ring try a wave that closes after six steps, $z_k = \cos(60°k)$. Row $k$ of $Lz$ is
#
# $$2\cos(60°k) - \cos(60°(k-1)) - \cos(60°(k+1)) = (2 - 2\cos60°)\cos(60°k),$$
#
# by the formula for the sum of two cosines. So the wave is an eigenvector, with the eigenvalue $2 - 2\cos60° = 1$.
# Shorter waves, with 120° and 180° in the place of 60°, give 3 and 4: *the smoother a vector, the smaller its
# eigenvalue*, and $\lambda_2$ belongs to the smoothest one that is not constant.
#
# </details>
#
# ## Consensus
#
# Let each robot correct its speed towards those that it sees: $\dot x_i = \sum_j a_{ij}(x_j - x_i)$, that is
#
# $$\dot x = -Lx, \qquad x(t) = e^{-Lt} x(0).$$
#
# > **Theorem (consensus).** On a fixed connected net the mean $\bar x = \tfrac1n\sum_i x_i$ is constant, and the
# > disagreement $x_\perp = x - \bar x\mathbf 1$ satisfies $\|x_\perp(t)\| \le e^{-\lambda_2 t}\|x_\perp(0)\|$.
#
# *Proof.* A line a step:
#
# 1. $\mathbf 1^\top L = (L\mathbf 1)^\top = 0$, so $\tfrac{d}{dt}\mathbf 1^\top x = -\mathbf 1^\top Lx = 0$: the
#    mean stays.
# 2. $\dot x_\perp = -Lx = -Lx_\perp$, because $L\mathbf 1 = 0$; and $x_\perp$ is orthogonal to $\mathbf 1$.
# 3. Write $x_\perp = \sum_{k\ge2} z_k\nu_k$ in orthonormal eigenvectors $\nu_k$ of $L$. The first,
#    $\mathbf 1/\sqrt n$, is missing by step 2. So $x_\perp^\top Lx_\perp = \sum_{k\ge2}\lambda_kz_k^2 \ge
#    \lambda_2\sum_{k\ge2}z_k^2 = \lambda_2\|x_\perp\|^2$.
# 4. $\tfrac{d}{dt}\tfrac12\|x_\perp\|^2 = x_\perp^\top\dot x_\perp = -x_\perp^\top Lx_\perp
#    \le -\lambda_2\|x_\perp\|^2$.
# 5. Multiply by $2e^{2\lambda_2t}$: $\tfrac{d}{dt}\bigl(e^{2\lambda_2 t}\|x_\perp\|^2\bigr) \le 0$. So this product
#    never exceeds its value at 0, which is the claim. $\square$
#
# The convoy agrees on the mean of its initial speeds, without anyone having computed it. For two robots $\lambda_2 =
# 2a_{12}$: the rate that we found by hand.

# %% tags=["predict"]
guess = ...
Prediction(
    "One more link closes the path of six to a ring. How many times as fast does it then agree?",
    guess,
    np.divide(*(np.linalg.eigvalsh(laplacians[name])[1] for name in ("ring", "path"))),
)

# %% [markdown]
# <details><summary>Times</summary>
#
# The theorem bounds the time in which the disagreement shrinks to a hundredth, $\ln(100)/\lambda_2$: on the complete
# net $4.6/6 = 0.77$ time units, on the ring 4.6, and on the path, with $\lambda_2 = 0.268$, 17.2.
#
# </details>

# %%
start = np.array([4.0, -1.0, 0.5, 2.0, -3.0, 1.0])
t = np.linspace(0.0, 6.0, 200)
figure, axes = plots.subplots(1, 4, size=(13, 3.0))
for ax, (name, L) in zip(axes, laplacians.items(), strict=True):
    ax.plot(t, [expm(-L * s) @ start for s in t])
    ax.axhline(start.mean(), color="black", linestyle=":", linewidth=0.8)
    ax.set(title=name, xlabel="time", ylabel="speed of a robot")

# %% [markdown]
# **Figure 0a.2.** The same six speeds on the four nets of Figure 0a.1; the mean is dotted. The complete net has
# agreed at 1, the path has not at 6. The two triangles agree within each of them, on two different speeds, for ever.
#
# Now let the range grow. Twelve robots at random places see each other within $r$; move $r$ and watch $\lambda_2$.

# %%
from flockana.course.picture_slider import slider

places = np.random.default_rng(4).uniform(0.0, 10.0, (12, 2))


def with_range(ax, reach):
    pairs = fl.links(places, reach)
    second = abs(np.linalg.eigvalsh(fl.laplacian(12, pairs).toarray())[1])
    for i, j in pairs:
        ax.plot(*places[[i, j]].T, color="0.6", linestyle="-", linewidth=1.0)
    ax.plot(*places.T, "o", color="black", linestyle="none")
    ax.set(xlim=(-0.5, 10.5), ylim=(-0.5, 10.5), aspect="equal", title=f"λ2 = {second:.3f}", xlabel="x (length)")


slider(with_range, np.arange(1.0, 8.1, 0.5), name="r", title="the net of twelve robots", size=(4.2, 4.4))

# %% [markdown]
# ## When the net changes
#
# In a flock the numbers are velocities, $\dot p = -\hat L(q)\,p$ plus other forces, and the net $\hat L(q)$ changes
# as the agents move. Can one not argue with $\lambda_2$ at each instant? Here, yes, for consensus alone: step 4
# holds with the $L$ of the instant. But a flock also has position forces, and then a system may have all its
# eigenvalues in the left half-plane at every instant and grow all the same. An example of Markus and Yamabe:
#
# $$\dot x = \begin{pmatrix} -1 + \tfrac32\cos^2t & 1 - \tfrac32\sin t\cos t \\ -1 - \tfrac32\sin t\cos t &
#   -1 + \tfrac32\sin^2t\end{pmatrix}x .$$
#
# At each instant the trace is $-\tfrac12$ and the determinant is $\tfrac12$, so the eigenvalues are
# $\tfrac14(-1 \pm i\sqrt7)$, always the same, on the left. But $x = e^{t/2}(\cos t, -\sin t)$ is a solution, and it
# grows. Insert it; the first row of the matrix times $(\cos t, -\sin t)$ is
#
# $$\begin{aligned}
# &{-\cos t} + \tfrac32\cos^3t - \sin t + \tfrac32\sin^2t\cos t && \text{multiply out} \\
# &= -\cos t - \sin t + \tfrac32\cos t\,(\cos^2t + \sin^2t) = \tfrac12\cos t - \sin t , && \text{collect}
# \end{aligned}$$
#
# and that is the derivative of $e^{t/2}\cos t$, over $e^{t/2}$. (The second row gives $-\cos t - \tfrac12\sin t$ in
# the same way.) How can that be? Take axes that turn with the time, $(\cos t, -\sin t)$ and $(\sin t, \cos t)$. In
# them the state has the coordinates $y_1$, $y_2$ with $\dot y_1 = \tfrac12y_1$ and $\dot y_2 = -y_2$: one grows, one
# decays, for ever. The eigenvalues of the instant belong to axes that stand still, in which no solution stays. Whoever
# computes them has left out the turning. One needs a function that falls along every solution.
#
# ## Lyapunov
#
# Let $\dot x = f(x)$ with $f$ locally Lipschitz, so that solutions exist and are unique, and let $f(x^*) = 0$. For a
# continuously differentiable $W$ put $\dot W(x) = \nabla W(x)^\top f(x)$: the rate of $W$ along the solution through
# $x$.
#
# > **Theorem (Lyapunov).** If near $x^*$ the function $W - W(x^*)$ is positive except at $x^*$, and $\dot W \le 0$,
# > then $x^*$ is *stable*: for every ball about $x^*$ there is a smaller one from which solutions never leave the
# > first. If also $\dot W < 0$ except at $x^*$, then solutions from the smaller ball converge to $x^*$.
#
# *Proof.*
#
# 1. Take a ball about $x^*$ that is small enough for the hypotheses. On its sphere, a compact set, the continuous
#    function $W - W(x^*)$ has a minimum $e$, and $e > 0$.
# 2. $W$ is continuous at $x^*$, so a smaller ball has $W - W(x^*) < e$ throughout.
# 3. A solution from there has $W - W(x^*) < e$ at all later times, because $\dot W \le 0$. To leave the first ball
#    it would have to cross the sphere, where $W - W(x^*) \ge e$. So it never does. That is stability.
# 4. For convergence, take $\Omega$, the states of the closed first ball with $W \le W(x(0))$. It is compact, and
#    solutions that start in it stay in it: they stay in the ball by 3, and $W$ does not rise. If $\dot W < 0$ off
#    $x^*$, the theorem of LaSalle below, applied to $\Omega$, leaves $x^*$ as the only limit. $\square$
#
# ## LaSalle
#
# Friction acts on velocities only: at a state with $v = 0$ nothing is dissipated, though the spring may be
# stretched. So for mechanical systems $\dot W < 0$ fails on a whole set, and the theorem that one uses is this one.
# A set is *positively invariant* if solutions that start in it stay in it; *invariant* if they have also been in it
# at all times before.
#
# > **Theorem (LaSalle).** Let $\Omega$ be compact and positively invariant, and let $\dot W \le 0$ on $\Omega$. Then
# > every solution that starts in $\Omega$ approaches the largest invariant subset of
# > $\{x \in \Omega : \dot W(x) = 0\}$.
#
# *Proof.* Let $x(t)$ start in $\Omega$.
#
# 1. $W(x(t))$ does not rise, and it is bounded below, as $W$ is continuous on a compact set. So it has a limit
#    $W_\infty$.
# 2. Let $\Lambda$ be the set of limits of $x(t_k)$ over all sequences $t_k \to \infty$. As $x(t)$ stays in a compact
#    set, $\Lambda$ is not empty, it is compact, and $x(t)$ approaches it: otherwise a sequence would keep a distance
#    from $\Lambda$, and would have a limit point by compactness, which lies in $\Lambda$.
# 3. $\Lambda$ is invariant: if $x(t_k) \to y$, then $x(t_k + t)$ tends to the solution through $y$ at time $t$, by
#    continuous dependence on the start, for positive and negative $t$.
# 4. On $\Lambda$ one has $W = W_\infty$, by continuity. So $W$ is constant along the solutions in $\Lambda$, and
#    $\dot W = 0$ on $\Lambda$.
# 5. $\Lambda$ is an invariant subset of $\{\dot W = 0\}$, so it lies in the largest one. $\square$
#
# Compactness is used in steps 1 and 2, and nowhere is it said where it comes from. An easy way to have it: a set
# $\{W \le W_0\}$ is positively invariant if $\dot W \le 0$, and closed; what remains to be shown is that it is
# *bounded*.
#
# **A damped mass.** $\ddot x = -c_1^\gamma x - c_2^\gamma\dot x$ has the energy
# $H = \tfrac12(v^2 + c_1^\gamma x^2)$, $v = \dot x$, with
# $\dot H = v\dot v + c_1^\gamma xv = -c_2^\gamma v^2 \le 0$. The sets $\{H \le H_0\}$ are discs or ellipses, hence
# compact. $\dot H = 0$ means $v = 0$, and a solution stays in that set only if $\dot v = -c_1^\gamma x = 0$ too. So
# the largest invariant subset is the origin, and every solution converges to it. (This mass is one agent that
# follows a γ-agent at rest, so the library can run it.)

# %%
mass = fl.Algorithm2(gains=fl.Gains(c1_gamma=1.0, c2_gamma=0.3), target=fl.StaticTarget((0.0,)))
run = fl.simulate(mass, [[2.0]], [[0.0]], (0.0, 25.0), t_eval=np.linspace(0.0, 25.0, 800))
x = np.linspace(-2.2, 2.2, 120)
H = 0.5 * (x**2 + x[:, None] ** 2)
_ = plots.phase_portrait(run.q[:, 0, 0], run.p[:, 0, 0], energy=(x, x, H), labels=("x (length)", "v (length/time)"))

# %% [markdown]
# **Figure 0a.3.** The damped mass with $c_1^\gamma = 1$, $c_2^\gamma = 0.3$. Thin lines are level sets of $H$: the
# solution crosses them inwards, except where $v = 0$, where it is tangent to one.
#
# **What compactness is for.** Two agents repel each other with the potential $1/x$, $x > 0$ their distance, and
# damping acts while they are near, at the rate $e^{-x}$: $\ddot x = 1/x^2 - e^{-x}\dot x$. Again
# $H = \tfrac12 v^2 + 1/x$ falls, $\dot H = -e^{-x}v^2 \le 0$. But the set $\{H \le H_0\}$ reaches to $x = \infty$:
# it is not compact. LaSalle says nothing, and the agents part for ever. This is what happens to flocks that fragment
# (lecture 02), and why cohesion has to be shown first (lecture 03).

# %%
from scipy.integrate import solve_ivp

parting = solve_ivp(lambda t, y: [y[1], y[0] ** -2 - np.exp(-y[0]) * y[1]], (0.0, 40.0), [0.5, 0.0], rtol=1e-9)
figure, axes = plots.subplots(1, 2, size=(9, 3.0))
axes[0].plot(parting.t, 0.5 * parting.y[1] ** 2 + 1.0 / parting.y[0])
axes[0].set(xlabel="time", ylabel="H (energy)", ylim=(0.0, 2.1))
axes[1].plot(parting.t, parting.y[0])
_ = axes[1].set(xlabel="time", ylabel="x (length)")

# %% tags=["facts"]
assert parting.y[0, -1] > 20.0
assert np.all(np.diff(parting.y[0]) > 0.0)
assert np.abs(np.linalg.eigvalsh(laplacians["two triangles"])[:3]).max() > 1.0  # two zeros, not three
assert np.abs(np.linalg.eigvalsh(laplacians["two triangles"])[:2]).max() < 1e-12
assert np.allclose(np.linalg.eigvalsh(laplacians["ring"]), [0.0, 1.0, 1.0, 3.0, 3.0, 4.0])
assert np.allclose(np.linalg.eigvalsh(laplacians["complete"])[1:], 6.0)
waits = [np.log(100.0) / np.linalg.eigvalsh(laplacians[name])[1] for name in ("complete", "ring", "path")]
assert [f"{wait:.2g}" for wait in waits] == ["0.77", "4.6", "17"]
assert f"{waits[2]:.1f} {waits[2] / waits[1]:.1f}" == "17.2 3.7"


def markus_yamabe(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[-1.0 + 1.5 * c * c, 1.0 - 1.5 * s * c], [-1.0 - 1.5 * s * c, -1.0 + 1.5 * s * s]])


for instant in (0.0, 0.7, 2.0):
    c, s = np.cos(instant), np.sin(instant)
    assert np.allclose(np.linalg.eigvals(markus_yamabe(instant)).real, -0.25)
    assert np.allclose(markus_yamabe(instant) @ [c, -s], [0.5 * c - s, -0.5 * s - c])
spread = {name: np.ptp(expm(-L) @ start) for name, L in laplacians.items()}
assert spread["complete"] < 0.02 < spread["ring"]
assert np.ptp(expm(-6.0 * laplacians["path"]) @ start) > 0.3

# %% [markdown]
# **Figure 0a.4.** Two agents that repel each other. Their energy falls to a constant, as every energy with
# $\dot H \le 0$ and $H \ge 0$ does; their distance grows without bound.
#
# ## A convoy of springs: the pattern of later proofs
#
# Here is an example in which everything can be done, and whose proof is the model of those for flocks. Let $n$ robots
# on a line be joined, along the links of a fixed connected net, by springs and dampers of the strengths $a_{ij}$:
#
# $$\dot q = p, \qquad \dot p = -Lq - Lp .$$
#
# > **Theorem (convoy).** All positions come together, all velocities too, and the common velocity is the mean of the
# > velocities at the start.
#
# *Proof.* Six steps, which have the same names in every later proof.
#
# 1. *What is conserved.* $\mathbf 1^\top L = 0$, so the mean velocity $p_c$ is constant, and the mean position $q_c$
#    moves uniformly. So positions need not stay bounded: it is useless to look for a compact set of states $(q, p)$.
# 2. *The frame.* Ride with the mean: $x_i = q_i - q_c$ and $v_i = p_i - p_c$. As $L\mathbf 1 = 0$, the equation is the
#    same, $\dot x = v$, $\dot v = -Lx - Lv$, and now $\sum_ix_i = \sum_iv_i = 0$.
# 3. *The energy.* Let $W = \tfrac12x^\top Lx + \tfrac12v^\top v$, springs and motion. Then
#
# $$\begin{aligned}
# \dot W &= v^\top Lx + v^\top(-Lx - Lv) && \text{chain rule; } L \text{ is symmetric} \\
# &= -v^\top Lv \le 0 . && \text{the springs cancel}
# \end{aligned}$$
#
# 4. *Compactness.* $x$ is orthogonal to $\mathbf 1$, so $x^\top Lx \ge \lambda_2\|x\|^2$, and $\lambda_2 > 0$. So on
#    $\{W \le W(0)\}$ one has $\|x\|^2 \le 2W(0)/\lambda_2$ and $\|v\|^2 \le 2W(0)$: closed and bounded.
# 5. *Where nothing is lost.* $\dot W = 0$ means $v^\top Lv = 0$, so all $v_i$ are equal, because the net is connected.
#    Their sum is 0, so $v = 0$.
# 6. *Invariance.* A solution that stays there has $v = 0$ at all times, hence $0 = \dot v = -Lx$, hence equal $x_i$, of
#    sum 0. Only $x = v = 0$ is left, and LaSalle's theorem says that every solution tends to it. $\square$
#
# The net is used twice, in steps 4 and 5. In a flock the springs end at the range: then step 4 is what breaks under
# Algorithm 1 (lecture 02) and what the γ-agent repairs (lecture 03).
#
# How fast? Along an eigenvector of $\lambda_k$ the equation is $\ddot y + \lambda_k\dot y + \lambda_ky = 0$. For
# $\lambda_k < 4$ its poles are complex, with the real part $-\tfrac12\lambda_k$. So on the path of six, with
# $\lambda_2 = 0.268$, the slowest mode decays at the rate $0.134$, half of that of consensus; it overshoots, which
# consensus does not. On the complete net all $\lambda_k = 6 > 4$: two real poles, $-1.27$ and $-4.73$, although
# consensus has the rate 6. A well connected net damps so strongly that its springs creep.

# %%
path = laplacians["path"]
flow = np.block([[np.zeros((6, 6)), np.eye(6)], [-path, -path]])
away, wait = start - start.mean(), np.linspace(0.0, 40.0, 400)
disagree = {
    "springs and dampers": [np.linalg.norm((expm(flow * s) @ [*away, *np.zeros(6)])[:6]) for s in wait],
    "consensus": [np.linalg.norm(expm(-path * s) @ away) for s in wait],
}
figure, ax = plots.subplots(size=(6.5, 3.2))
for name, curve in disagree.items():
    ax.semilogy(wait, curve, label=name)
ax.semilogy(wait, np.linalg.norm(away) * np.exp(-0.134 * wait), label="a multiple of exp(−0.134 t)")
ax.set(xlabel="time", ylabel="disagreement (length)", ylim=(1e-3, 10.0))
_ = ax.legend()

# %% tags=["facts"]
poles = np.linalg.eigvals(flow)
moving = poles[np.abs(poles) > 1e-6]
assert f"{-moving.real.max():.3f}" == "0.134"
full = np.roots([1.0, 6.0, 6.0])
assert sorted(f"{each:.2f}" for each in full) == ["-1.27", "-4.73"]
assert disagree["springs and dampers"][-1] > 10.0 * disagree["consensus"][-1]
assert np.all(disagree["springs and dampers"] < 1.01 * np.linalg.norm(away) * np.exp(-0.134 * wait))
turning = np.array([[np.cos(0.7), np.sin(0.7)], [-np.sin(0.7), np.cos(0.7)]])  # its columns are the axes
spin = np.array([[-np.sin(0.7), np.cos(0.7)], [-np.cos(0.7), -np.sin(0.7)]])  # and these their derivatives
assert np.allclose(turning.T @ (markus_yamabe(0.7) @ turning - spin), np.diag([0.5, -1.0]))

# %% [markdown]
# **Figure 0a.5.** Six robots on a path, from the six numbers of Figure 0a.2 as positions, at rest. With springs and
# dampers the disagreement follows, in swings, a curve that falls at the rate 0.134; consensus falls at twice that rate.
#
# ## Barbalat
#
# LaSalle's theorem needs $\dot x = f(x)$ without explicit time. A flock that follows a moving target has a
# right-hand side that depends on $t$. Then one has less to work with: an energy that falls, hence an integral that
# is finite.
#
# > **Theorem (Barbalat's lemma).** Let $f$ be uniformly continuous on $[0, \infty)$, and let $\int_0^t f$ have a
# > finite limit as $t \to \infty$. Then $f(t) \to 0$.
#
# *Proof.* Suppose not. Then there are $e > 0$ and times $t_k \to \infty$ with $|f(t_k)| \ge e$. By uniform
# continuity there is one $t_1 > 0$ with $|f(t) - f(t_k)| \le e/2$ for $|t - t_k| \le t_1$, the same for all $k$. So
# on $[t_k, t_k + t_1]$ the function $f$ keeps its sign and $|f| \ge e/2$, and
# $\bigl|\int_{t_k}^{t_k+t_1} f\bigr| \ge et_1/2$ for every $k$. But these integrals tend to 0, because $\int_0^t f$
# converges. $\square$
#
# **How it is used.** Let $W \ge 0$ fall along a solution, $\dot W = -f(t)$ with $f \ge 0$. Then
# $\int_0^tf = W(0) - W(t)$ has a limit. If $\dot f$ is bounded, then $f$ is uniformly continuous, and $f \to 0$:
# what dissipates dies out. What does *not* follow is that $W$ tends to 0, or that the state has a limit. Uniform
# continuity is no detail: a function with ever narrower peaks of height 1 has a finite integral and no limit.
#
# ## Questions that come up
#
# *What if $a_{ij} \ne a_{ji}$: I see you, and you do not see me?* Then $\mathbf 1^\top L \ne 0$ in general, and the
# mean is not conserved. If there is one robot whose speed reaches all others, directly or through others, all still
# agree, but on a weighted mean (lecture 12). The quadratic form, and with it most proofs of this course, needs
# symmetry.
#
# *How does one find a $W$?* In mechanics it is nearly always potential plus kinetic energy, seen from the frame in
# which the motion is to die out. If it falls by friction, one has a $W$. If not, one looks for the term that does work
# and asks who pays for it.
#
# *Stable, convergent: is that not the same?* No. A marble in a bowl without friction is stable at the bottom and never
# converges. And there are systems all of whose solutions converge to a point, after first making a long excursion from
# however near they start: convergent, and not stable. Lyapunov's theorem gives both, LaSalle's only convergence.
#
# ## What surprised, and what the theorems do not say
#
# A better connected net agrees faster, but $\lambda_2$ is about the slowest of all starts: some starts agree much
# faster. A falling energy does not mean convergence: without compactness the state may run away while its energy
# tends to a limit. And LaSalle's theorem gives convergence to a *set*; if that set is a circle of equilibria, the
# solution may in principle creep along it. Lecture 13 has to deal with just that.
#
# ## Summary
#
# - $z^\top Lz = \tfrac12\sum_{i,j} a_{ij}(z_j - z_i)^2$; the eigenvalue 0 counts the components, $\lambda_2$ is the
#   rate of agreement.
# - An energy that falls gives convergence by LaSalle only on a *compact* invariant set, and then to the largest
#   invariant set on which it no longer falls, which need not be a point.
# - With a moving target Barbalat's lemma takes LaSalle's place: it shows that what dissipates dies out.
# - A proof for a flock has six steps: what is conserved, the frame, the energy, compactness, where nothing is lost,
#   invariance. The hard one is compactness, that is cohesion.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) Compute $\lambda_2$ of the path of three agents with unit weights by hand, exactly.

# %% tags=["answer"]
lambda_2 = ...

# %% tags=["solution"]
lambda_2 = 1.0  # L = [[1, −1, 0], [−1, 2, −1], [0, −1, 1]] has the eigenvectors (1, 1, 1), (1, 0, −1), (1, −2, 1)

# %% tags=["check"]
grade(lambda_2, 1.0, hint="an eigenvector is odd under turning the path around")

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, derivation) A net of 12 agents has three components. What is the rank of its Laplacian? (A whole
# number.)

# %% tags=["answer"]
rank = ...

# %% tags=["solution"]
rank = 12 - 3

# %% tags=["check"]
grade(rank, 9, hint="what is the dimension of the kernel?")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, derivation) Five agents are linked by a complete net with unit weights. (a) What is
# $\lambda_2$? (b) After what time has the disagreement surely shrunk to a thousandth, by the theorem? (c) And after
# what time if all weights are doubled? Give the list of the three numbers, each to four significant digits.

# %% tags=["answer"]
agreement = ...

# %% tags=["solution"]
agreement = [5.0, np.log(1000.0) / 5.0, np.log(1000.0) / 10.0]  # λ_2 = n on the complete net

# %% tags=["check"]
grade(agreement, [5.0, 1.38155106, 0.69077553], digits=4, hint="first find the eigenvalues of L = nI − 𝟏𝟏ᵀ")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, design) Design: for the damped mass with $c_1^\gamma = 1$, what is the least $c_2^\gamma$ for
# which every solution decays at the rate 0.8 at least, that is like $e^{-0.8t}$? (Exactly.)

# %% tags=["answer"]
damping = ...

# %% tags=["solution"]
damping = 1.6  # complex poles have the real part −c2γ/2

# %% tags=["check"]
grade(damping, 1.6, hint="look at the real part of the poles while they are complex")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, derivation) An agent on a line has the potential $\arctan(x)^2$ and the damping $-\dot x$. For
# which $H_0$ is $\{\tfrac12 v^2 + \arctan(x)^2 \le H_0\}$ compact? Give the least upper bound of these $H_0$, to
# four significant digits.

# %% tags=["answer"]
bound = ...

# %% tags=["solution"]
bound = (np.pi / 2.0) ** 2  # the height of the potential at infinity

# %% tags=["check"]
grade(bound, 2.46740110, digits=4, hint="how much energy does it take to get infinitely far?")

# %% [markdown] tags=["exercise"]
# **6.** ★★★ (3 points, words) Let $W \ge 0$ be continuously differentiable, $\dot W \le 0$, and let all solutions be
# bounded. Must every solution converge to a *point*? Give a reason or a counterexample. Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# No. Take the undamped mass with $W = \tfrac12(x^2 + v^2)$: $W$ is constant along solutions, so its derivative is
# zero everywhere, and all solutions are bounded, but they go round circles for ever. LaSalle only promises
# convergence to the largest invariant set on which $W$ no longer falls; here that is the whole level set.
#
# **Rubric, a point each:** no; a counterexample with all three hypotheses checked; what LaSalle's principle promises
# instead.

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, design) Five agents may have four links of unit weight. Which four make consensus as fast as
# four can, that is, $\lambda_2$ as large as possible? Give a list of pairs of numbers from 0 to 4.

# %% tags=["answer"]
fastest_net = ...

# %% tags=["solution"]
fastest_net = [(0, 1), (0, 2), (0, 3), (0, 4)]  # a tree with λ_2 = 1; in every other tree λ_2 is smaller

# %% tags=["check"]
grade(
    fastest_net,
    lambda net: len(net) == 4 and np.linalg.eigvalsh(fl.laplacian(5, np.array(net)).toarray())[1] > 1.0 - 1e-9,
    form="list",
    hint="four links that connect five agents form a tree; there are three kinds of them",
)

# %% [markdown] tags=["exercise"]
# **8.** ★ (1 point, player) Move the slider of the twelve robots. What is the least range on it at which the net is
# connected? (Its values are multiples of 0.5; exactly.)

# %% tags=["answer"]
least_range = ...

# %% tags=["solution"]
least_range = next(
    float(reach)
    for reach in np.arange(1.0, 8.1, 0.5)
    if np.linalg.eigvalsh(fl.laplacian(12, fl.links(places, reach)).toarray())[1] > 1e-9
)
print(least_range)

# %% tags=["check"]
grade(least_range, 4.0, hint="connected means λ2 > 0")

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, proof) Prove that a further link, or a larger weight, never lowers $\lambda_2$. (Use that
# $\lambda_2$ is the minimum of $z^\top Lz$ over unit vectors $z$ orthogonal to $\mathbf 1$.) Give an example in
# which a further link leaves $\lambda_2$ as it is.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Let $L'$ be the Laplacian with the further weight $e > 0$ between $i$ and $j$. By the quadratic form
# $z^\top L'z = z^\top Lz + e\,(z_j - z_i)^2 \ge z^\top Lz$ for every $z$. Let $z$ be a unit vector orthogonal to
# $\mathbf 1$ at which the minimum for $L'$ is taken, so $\lambda_2' = z^\top L'z \ge z^\top Lz \ge \lambda_2$, as
# $z$ is admitted for $L$ too. Example: the star of four agents with unit weights has $\lambda_2 = 1$, with
# eigenvectors $z$ that are 0 at the centre and sum to 0 over the three leaves, a space of dimension two. Linking two
# leaves raises the form of every such $z$ except those with $z_i = z_j$ at these leaves, and one such vector is
# left, $(1, 1, -2)$ on the leaves: $\lambda_2$ is still 1.
#
# **Rubric, a point each:** the forms differ by a square; the minimising vector of the larger form is used in the
# smaller one; an example with its eigenvector.
