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
# # Equilibria and linearised stability
#
# **Aims.** Find the equilibrium that a flock settles in, linearise about it, and read poles, modes, delay margin and
# the value of a gain off the linear system, having checked first that it tells the truth.
#
# In the frame of the centre of mass Algorithm 2 is $\dot x = v$, $\dot v = -\nabla U_\lambda(x) - (c_2^\gamma I +
# c_2^\alpha \hat L(x))v$ with $U_\lambda = c_1^\alpha V + \lambda J$, $\lambda = c_1^\gamma$. Near a minimum $x^*$ of
# $U_\lambda$, where $v = 0$, and with $z = x - x^*$ small,
#
# $$\ddot z + \underbrace{(c_2^\gamma I + c_2^\alpha \hat L)}_{D}\,\dot z
#   + \underbrace{\nabla^2 U_\lambda(x^*)}_{S}\,z = 0, \qquad (s^2 I + s D + S)\,\nu = 0 .$$
#
# $D$ is the damping, $S$ the stiffness, $s$ a pole and $\nu$ its mode. ($\lambda$ stays $c_1^\gamma$; $K$ stays the
# velocity mismatch $\tfrac12\sum\|v_i\|^2$.)

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots, stability
from flockana.course import grade

law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
rest = fl.find_equilibrium(law, lattice.hexagonal_patch(2, 7.0))
print(f"{rest.kind}, residual {rest.residual:.1e} of the force scale")
print(f"its links are off d by {lattice.strain(rest.q, 7.0, 8.4):.1%} at most")

# %% [markdown]
# `find_equilibrium` minimises $U_\lambda$ with CasADi and IPOPT. The hexagon of 19 is a minimum, a little smaller
# than the lattice: the γ-agent compresses it.
#
# ## Poles and modes

# %%
flock = fl.linearise(law, rest)
print("zero modes:", [mode.name for mode in flock.zero_modes], " semisimple:", flock.semisimple)
print(f"slowest decay rate {flock.decay_rate:.4f}; of the structure alone {flock.structural_decay_rate:.4f}")
for mode in flock.modes[:6]:
    print(plots.mode_title(mode))
_ = plots.pole_map(flock.eigenvalues)

# %% [markdown]
# The rotation about the γ-agent costs nothing, so the equilibrium is *semi-stable*: what converges is the shape, and
# the flock ends somewhere on a circle of equilibria. The four slowest modes are the centre of mass, critically damped
# by our choice $c_2^\gamma = 2\sqrt{c_1^\gamma}$. Then the structure begins:

# %%
shapes = [mode for mode in flock.modes if "translation" not in mode.name][:3]
figure, axes = plots.subplots(1, 3, size=(13, 4.2))
pairs = lattice.links(rest.q, law.alpha.r)
for ax, mode in zip(axes, shapes, strict=True):
    plots.mode_shape(rest.q, pairs, mode.shape, ax=ax, title=plots.mode_title(mode))

# %% [markdown]
# The slowest of them in motion, much enlarged:

# %%
stability.mode_motion(flock, shapes[0]).player(height=520)

# %% [markdown]
# ## Does it tell the truth?
#
# Push the flock along its slowest structural mode by $10^{-4}$ and let the *nonlinear* law act. The mismatch
# $\tilde K = K/n$ must fall at twice the mode's decay rate, as it is quadratic in the velocities.

# %%
slow = shapes[0]
push = 1e-4 * slow.shape.real
run = fl.simulate(law, rest.q + push, np.zeros_like(push), (0.0, 4.0), rtol=1e-12, atol=1e-14)
K = run.metrics()["normalised_velocity_mismatch"].values
peaks = [k for k in range(1, len(K) - 1) if K[k - 1] < K[k] > K[k + 1] and run.t[k] > 0.2]
measured = -0.5 * np.polyfit(run.t[peaks], np.log(K[peaks]), 1)[0]
print(f"predicted {slow.decay_rate:.4f}, measured {measured:.4f}")

# %% [markdown]
# ## A control engineer's objects
#
# Everything is a `control.StateSpace`, with named signals.

# %%
centre = flock.translational
print(centre.poles())
system = stability.CentreOfMass(law.gains)
omega = np.logspace(-1.5, 1.5, 200)
_ = plots.bode({"q_r to q_c, p_r = dq_r/dt": system.frequency_response(omega)})

# %% [markdown]
# How much delay in *all* interactions does the flock survive? The characteristic equation
# $\det(s^2 I + (sD + S)e^{-s\tau}) = 0$ has infinitely many roots; a Chebyshev discretisation finds the rightmost.

# %%
margin = stability.delay_margin(stability.delay_system(law, rest.q))
print(margin)
for share in (0.9, 1.1):
    root = stability.rightmost_roots(stability.delay_system(law, rest.q), share * margin.delay)[0]
    print(f"at {share:.1f} of the margin the rightmost root is {root:.3f}")

# %% [markdown]
# And what does a stronger damping $c_2^\gamma$ buy? Of the structure, ever more decay; of the centre of mass, less
# beyond critical damping, $c_2^\gamma = 2\sqrt{c_1^\gamma}$, which is one of the points. (A sweep over $c_1^\gamma$
# follows the equilibrium, which moves.)

# %%
sweep = stability.gain_sweep(
    law, rest.q, "c2_gamma", np.linspace(0.2, 4.0, 20) * 2.0 * np.sqrt(law.gains.c1_gamma), follow=False
)
_ = plots.gain_sweep(sweep)

# %% tags=["facts"]
best_drawn = sweep.values[int(np.argmin(sweep.abscissa))]
assert abs(best_drawn - 2.0 * np.sqrt(law.gains.c1_gamma)) < 1e-12

# %% [markdown]
# ## Summary
#
# - Near a minimum of $U_\lambda$ a flock is a mechanical system $s^2I + sD + S$; rotations and translations that
#   nothing holds give zero modes.
# - A linearisation is checked against the nonlinear law before it is used.
# - Poles, delay margin and gain sweeps follow from it.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) Linearise Algorithm 1, $c_2^\alpha > 0$, at an infinitesimally rigid α-lattice in
# *space*, at rest. How often does the first-order system of positions and velocities have the eigenvalue 0, counted
# with its algebraic multiplicity? (Translations lie in the kernels of both $S$ and $D$, rotations in that of $S$ only.
# A whole number.)

# %% tags=["answer"]
zeros = ...

# %% tags=["solution"]
zeros = 2 * 3 + 3  # a translation gives a chain of two vectors: it may drift; a rotation is damped and gives one
drifting = fl.linearise(fl.Algorithm1(), lattice.hexagonal_patch(2, 7.0)).drifting
print("in the plane these drift:", drifting)

# %% tags=["check"]
grade(zeros, 9, hint="put x = ξ + tη into the linear equation: for which ξ and η does it solve it?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, derivation) Two agents under Algorithm 1, 7 apart, at rest. The only shape is the distance. What
# is its damping ratio, to three significant digits? (By `linearise`, or from $\phi_\alpha'(d_\alpha)$ and $a_{ij}$ at
# $d$ by hand.)

# %% tags=["answer"]
damping_ratio = ...

# %% tags=["solution"]
pair = fl.linearise(fl.Algorithm1(), [[0.0], [7.0]])
damping_ratio = pair.modes[0].damping_ratio

# %% tags=["check"]
grade(damping_ratio, 0.09291926, digits=3, hint="there is one mode")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, derivation) For which $c_2^\gamma$ does the centre of mass return fastest, with $c_1^\gamma = 1.1$
# as it is? (Four significant digits.)

# %% tags=["answer"]
best = ...

# %% tags=["solution"]
best = 2 * np.sqrt(1.1)

# %% tags=["check"]
grade(best, 2.0976177, digits=4, hint="where do two real poles meet?")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, reading) `linearise` refuses a state that is no equilibrium. Try the *exact* hexagon of 19 under
# `law`: what does it name, relative to the forces of the law? Give it to two significant digits. (Read the message of
# the error.)

# %% tags=["answer"]
residual = ...

# %% tags=["solution"]
try:
    fl.linearise(law, lattice.hexagonal_patch(2, 7.0))
except fl.errors.ArgumentError as error:
    print(error)
residual = fl.linearise(law, lattice.hexagonal_patch(2, 7.0), allow_residual=True).residual

# %% tags=["check"]
grade(residual, 0.04442693, digits=2, hint="the error says it, relative to the forces")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, design) Design: one agent follows a γ-agent at rest with $c_1^\gamma = 1$, $c_2^\gamma = 2$, and
# everything that it hears is late by $\tau$: $s^2 + (2s + 1)e^{-s\tau} = 0$. What is the delay margin, to four
# significant digits? (At the margin $s = i\omega$: compare moduli first, then phases.)

# %% tags=["answer"]
delay = ...

# %% tags=["solution"]
omega_c = np.sqrt((4.0 + np.sqrt(20.0)) / 2.0)  # ω⁴ = 1 + 4ω²
delay = np.arctan(2.0 * omega_c) / omega_c

# %% tags=["check"]
grade(delay, 0.647409203, digits=4, hint="two real equations, for ω and for τ")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) The linearised flock has eigenvalues 0, and yet we say that its shape converges. Why is
# that no contradiction, and what does it mean for the place in which a flock ends? In your own words, at least 30 of
# them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
zero_modes = ...

# %% tags=["solution"]
zero_modes = """The zero eigenvalues belong to rotations about the target: they move along the set of equilibria, on
which the energy is constant, and do not change any distance. Across that set all eigenvalues have negative real
part, so distances converge. Which equilibrium of the set is reached depends on the start and on any disturbance;
the orientation is not controlled."""
# Rubric, a point each:
# the zero modes are tangent to a set of equilibria of one shape; the orientation reached
# depends on the start.

# %% tags=["check"]
grade(zero_modes, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
