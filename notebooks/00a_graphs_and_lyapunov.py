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
# **Aims.** Know the Laplacian of a net and what its eigenvalues say; solve the consensus equation; state the theorems
# of Lyapunov and LaSalle with their hypotheses, apply them, and see what happens where a hypothesis is missing. All
# later lectures rest on these tools.
#
# ## The net and its Laplacian
#
# Agents $1, \dots, n$ at $q_i \in \mathbb R^m$ are *neighbours* if they are nearer than $r$. The links $\{i, j\}$
# between neighbours form the *net*, an undirected graph. With a weight $a_{ij} = a_{ji} > 0$ for each link and $a_{ij}
# = 0$ elsewhere, the *Laplacian* is
#
# $$L = \Delta(A) - A, \qquad L_{ii} = \sum_j a_{ij}, \qquad L_{ij} = -a_{ij} \quad (i \ne j).$$
#
# Each row sums to 0, so $L\mathbf 1 = 0$. Collecting the terms of each pair gives the quadratic form
#
# $$z^\top L z = \tfrac12 \sum_{i,j} a_{ij}\,(z_j - z_i)^2 \ge 0 .$$
#
# So $L$ is positive semidefinite, and $Lz = 0$ exactly if $z$ is constant on each *component*, a largest set of agents
# that are linked by paths. **The multiplicity of the eigenvalue 0 is the number of components.** The eigenvalues are $0
# = \lambda_1 \le \lambda_2 \le \dots \le \lambda_n$; $\lambda_2 > 0$ if and only if the net is connected. For vectors
# in $\mathbb R^m$ one writes $\hat L = L \otimes I_m$.

# %%
import numpy as np
from scipy.linalg import expm

import flockana as fl
from flockana import plots
from flockana.course import grade

nets = {
    "path": [(k, k + 1) for k in range(5)],
    "ring": [(k, (k + 1) % 6) for k in range(6)],
    "complete": [(i, j) for j in range(6) for i in range(j)],
    "two triangles": [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5)],
}
laplacians = {name: fl.laplacian(6, np.array(links)).toarray() for name, links in nets.items()}
for name, L in laplacians.items():
    print(f"{name:>14}: eigenvalues {np.linalg.eigvalsh(L).round(3) + 0.0}")

# %% [markdown]
# ## Consensus
#
# Let each agent move a number $x_i$ towards those of its neighbours: $\dot x_i = \sum_j a_{ij}(x_j - x_i)$, that is
#
# $$\dot x = -Lx, \qquad x(t) = e^{-Lt} x(0).$$
#
# Because $\mathbf 1^\top L = 0$ the mean $\bar x$ stays. Let $x_\perp = x - \bar x\mathbf 1$ be the disagreement, which
# is orthogonal to $\mathbf 1$. On a connected net the smallest eigenvalue of $L$ on such vectors is $\lambda_2$, so
#
# $$\tfrac{d}{dt}\tfrac12\|x_\perp\|^2 = -x_\perp^\top Lx_\perp \le -\lambda_2\|x_\perp\|^2
#   \quad\Longrightarrow\quad \|x_\perp(t)\| \le e^{-\lambda_2 t}\|x_\perp(0)\| .$$
#
# A better connected net agrees faster; a net with two components agrees within each of them only.

# %%
start = np.array([4.0, -1.0, 0.5, 2.0, -3.0, 1.0])
t = np.linspace(0.0, 6.0, 200)
figure, axes = plots.subplots(1, 4, size=(13, 3.0))
for ax, (name, L) in zip(axes, laplacians.items(), strict=True):
    ax.plot(t, [expm(-L * s) @ start for s in t])
    ax.axhline(start.mean(), color="black", linestyle=":", linewidth=0.8)
    ax.set(title=name, xlabel="$t$", ylabel="$x_i$")

# %% [markdown]
# In a flock the numbers are velocities, $\dot p = -\hat L(q)\,p$ plus other forces, and the net changes as the agents
# move. Then eigenvalues of one matrix prove nothing, and one needs a function that falls along every solution.
#
# ## Lyapunov
#
# Let $\dot x = f(x)$ with $f$ locally Lipschitz and $f(x^*) = 0$, and let $W$ be continuously differentiable with
# $\dot W(x) = \nabla W(x)^\top f(x)$.
#
# > **Theorem (Lyapunov).** If near $x^*$ the function $W - W(x^*)$ is positive except at $x^*$ and $\dot W \le 0$, then
# > $x^*$ is *stable*: solutions that start near enough stay as near as one likes. If also $\dot W < 0$ except at $x^*$,
# > then $x^*$ is *asymptotically stable*: they converge to it.
#
# Energies of mechanical systems fall only while something moves: $\dot W = 0$ on the whole set of states at rest, and
# the second half of the theorem does not apply. That gap is closed by
#
# > **Theorem (LaSalle's invariance principle).** Let $\Omega$ be *compact* and *positively invariant*: a solution that
# > starts in $\Omega$ stays in it. Let $\dot W \le 0$ on $\Omega$. Then every solution that starts in $\Omega$
# > approaches the largest invariant subset of $\{x \in \Omega : \dot W(x) = 0\}$.
#
# A level set $\{W \le W_0\}$ is positively invariant where $\dot W \le 0$. What has to be shown is that it is
# *bounded*.
#
# **A damped mass.** $\ddot x = -x - k\dot x$, $k > 0$, has the energy $H = \tfrac12(x^2 + v^2)$, with $\dot H = -kv^2$.
# The sets $\{H \le H_0\}$ are discs, hence compact. $\dot H = 0$ means $v = 0$; a solution stays in that set only if
# $\dot v = -x = 0$ too. So the largest invariant subset is the origin, and every solution converges to it.

# %%
mass = fl.Algorithm2(gains=fl.Gains(c1_gamma=1.0, c2_gamma=0.3), target=fl.StaticTarget((0.0,)))
run = fl.simulate(mass, [[2.0]], [[0.0]], (0.0, 25.0), t_eval=np.linspace(0.0, 25.0, 800))
x = np.linspace(-2.2, 2.2, 120)
H = 0.5 * (x**2 + x[:, None] ** 2)
_ = plots.phase_portrait(run.q[:, 0, 0], run.p[:, 0, 0], energy=(x, x, H), labels=("$x$ (length)", "$v$ (length/time)"))

# %% [markdown]
# **What compactness is for.** Two agents repel each other with the potential $1/x$, $x > 0$ their distance, and damping
# acts while they are near, at the rate $e^{-x}$: $\ddot x = 1/x^2 - e^{-x}\dot x$. Again $H = \tfrac12 v^2 + 1/x$
# falls, $\dot H = -e^{-x}v^2 \le 0$. But the set $\{H \le H_0\}$ reaches to $x = \infty$: it is not compact. LaSalle
# says nothing, and the agents part for ever. This is what happens to flocks that fragment (lecture 02), and why
# cohesion has to be shown first (lecture 03).

# %%
from scipy.integrate import solve_ivp

parting = solve_ivp(lambda t, y: [y[1], y[0] ** -2 - np.exp(-y[0]) * y[1]], (0.0, 40.0), [0.5, 0.0], rtol=1e-9)
figure, axes = plots.subplots(1, 2, size=(9, 3.0))
axes[0].plot(parting.t, 0.5 * parting.y[1] ** 2 + 1.0 / parting.y[0])
axes[0].set(xlabel="$t$", ylabel="$H$", ylim=(0.0, 2.1))
axes[1].plot(parting.t, parting.y[0])
_ = axes[1].set(xlabel="$t$", ylabel="$x$")

# %% tags=["facts"]
assert parting.y[0, -1] > 20.0
assert np.all(np.diff(parting.y[0]) > 0.0)
assert np.abs(np.linalg.eigvalsh(laplacians["two triangles"])[:3]).max() > 1.0  # two zeros, not three
assert np.abs(np.linalg.eigvalsh(laplacians["two triangles"])[:2]).max() < 1e-12

# %% [markdown]
# ## Summary
#
# - $z^\top Lz = \tfrac12\sum_{i,j} a_{ij}(z_j - z_i)^2$; the eigenvalue 0 counts the components, $\lambda_2$ is the
#   rate of agreement.
# - An energy that falls gives convergence by LaSalle only on a *compact* invariant set, and then to the largest
#   invariant set on which it no longer falls, which need not be a point.
# - For flocks the hard part is compactness, that is cohesion.

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
# **3.** ★★ (2 points, derivation) Five agents on a complete net with unit weights: after what time has the disagreement
# surely shrunk to a thousandth, by the bound above? (Four significant digits.)

# %% tags=["answer"]
time = ...

# %% tags=["solution"]
time = np.log(1000.0) / 5.0  # λ_2 = n on the complete net

# %% tags=["check"]
grade(time, 1.38155106, digits=4, hint="first find the eigenvalues of L = nI − 𝟏𝟏ᵀ")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, design) Design: for the damped mass $\ddot x = -x - k\dot x$, what is the least $k$ for which
# every solution decays at the rate 0.8 at least, that is like $e^{-0.8t}$? (Exactly.)

# %% tags=["answer"]
damping = ...

# %% tags=["solution"]
damping = 1.6  # complex poles have the real part −k/2

# %% tags=["check"]
grade(damping, 1.6, hint="look at the real part of the poles while they are complex")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, derivation) An agent on a line has the potential $\arctan(x)^2$ and the damping $-\dot x$. For
# which $H_0$ is $\{\tfrac12 v^2 + \arctan(x)^2 \le H_0\}$ compact? Give the least upper bound of these $H_0$, to four
# significant digits.

# %% tags=["answer"]
bound = ...

# %% tags=["solution"]
bound = (np.pi / 2.0) ** 2  # the height of the potential at infinity

# %% tags=["check"]
grade(bound, 2.46740110, digits=4, hint="how much energy does it take to get infinitely far?")

# %% [markdown] tags=["exercise"]
# **6.** ★★★ (3 points, words) In your own words, at least 30 of them: let $W \ge 0$ be continuously differentiable,
# $\dot W \le 0$, and let all solutions be bounded. Must every solution converge to a *point*? Give a reason or a
# counterexample. (A text; the check counts words, and your lecturer reads it.)

# %% tags=["answer"]
argument = ...

# %% tags=["solution"]
argument = """No. Take the undamped mass with W = (x² + v²)/2: W is constant along solutions, so its derivative is zero
everywhere, and all solutions are bounded, but they go round circles for ever. LaSalle only promises convergence to the
largest invariant set on which W no longer falls; here that is the whole level set."""
# Rubric, a point each:
# no; a counterexample with all three hypotheses checked; what LaSalle's principle promises
# instead.

# %% tags=["check"]
grade(argument, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")

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
